//! The stress cases: nodes by circumstances. Cases of one node stand together, so that its pipeline is built once.

use glam::DVec3;

use super::allowed::Allowed;
use super::node::{StressNode, StressPlacement, usual_blend};
use super::place::StressView;
use crate::scene::{
    Attached, Attachment, Blend, BlendKernel, Group, Limits, Modifier, ModifierKind, Operator, ParamValue, Shape,
    ShapeKind, limits,
};

/// A node to draw and the circumstances of the picture.
#[derive(Clone, Debug)]
pub struct StressCase {
    pub(super) node: StressNode,
    /// The difficulty as text.
    pub circumstance: String,
    pub(super) place: StressPlacement,
    pub(super) view: StressView,
}

impl StressCase {
    /// The name of the node.
    pub fn name(&self) -> String {
        self.node.name()
    }

    /// The allowance of the case.
    pub(super) fn allowed(&self) -> Allowed {
        match (&self.node, self.view) {
            (StressNode::Shape(Shape::Kleinian { .. }), _) => Allowed::DUST,
            (_, StressView::At(_)) => Allowed::FAR_CELL,
            (StressNode::Modified(Modifier::Elongate { length }), _) if length.contains(&limits::SIZE.hard[1]) => {
                Allowed::SLIVER
            }
            _ => Allowed::USUAL,
        }
    }
}

/// All cases.
pub fn cases() -> Vec<StressCase> {
    let mut all = Vec::new();
    for &kind in ShapeKind::ALL {
        shape(kind, &mut all);
    }
    for operator in Operator::ALL {
        let kernels = if operator.has_kernel() { BlendKernel::ALL.as_slice() } else { &BlendKernel::ALL[..1] };
        for &kernel in kernels {
            blend_cases(operator, kernel, &mut all);
        }
    }
    for &kind in ModifierKind::ALL {
        modifier(kind, &mut all);
    }
    all
}

/// Adds the node as it is, at extreme scales, far from the origin, and from difficult views.
fn everywhere(node: &StressNode, all: &mut Vec<StressCase>) {
    let scaled = |scale| StressPlacement { scale, ..StressPlacement::PLAIN };
    let far = StressPlacement { at: DVec3::new(6e5, -6e5, 5.3e5), ..StressPlacement::PLAIN };
    let circumstances = [
        ("plain", StressPlacement::PLAIN, StressView::Whole),
        ("scale 1e-4", scaled(1e-4), StressView::Whole),
        ("scale 1e4", scaled(1e4), StressView::Whole),
        ("1e6 from the origin", far, StressView::Whole),
        ("1e6 from the origin, grazing", far, StressView::Grazing),
        ("grazing", StressPlacement::PLAIN, StressView::Grazing),
        ("from inside", StressPlacement::PLAIN, StressView::Inside),
        ("from 1e-3", StressPlacement::PLAIN, StressView::Near),
    ];
    all.extend(circumstances.map(|(circumstance, place, view)| StressCase {
        node: node.clone(),
        circumstance: circumstance.into(),
        place,
        view,
    }));
}

fn plain(node: StressNode, circumstance: String) -> StressCase {
    StressCase { node, circumstance, place: StressPlacement::PLAIN, view: StressView::Whole }
}

/// Extreme values of a parameter with their names: 0, 1e-4 of `size`, and the limits.
fn extremes(limits: &Limits, size: f64) -> Vec<(&'static str, f64)> {
    let mut all = Vec::new();
    if limits.accept(0.0) {
        all.push(("0", 0.0));
        if limits.unit == "m" {
            all.push(("1e-4 of the size", 1e-4 * size));
        }
    }
    all.extend([("at its soft lower limit", limits.soft[0]), ("at its soft upper limit", limits.soft[1])]);
    all.extend([("at its lower limit", limits.hard[0]), ("at its upper limit", limits.hard[1])]);
    let mut kept: Vec<(&str, f64)> = Vec::new();
    for (name, number) in all {
        if kept.iter().all(|(_, before)| *before != number) {
            kept.push((name, number));
        }
    }
    kept
}

fn shape(kind: ShapeKind, all: &mut Vec<StressCase>) {
    let usual = kind.default_shape();
    everywhere(&StressNode::Shape(usual.clone()), all);
    let bounds = usual.bounds();
    let size = if bounds.is_finite() { bounds.half().max_element() } else { 1.0 };
    for (index, (param, value)) in kind.params().iter().zip(usual.values()).enumerate() {
        for (name, number) in extremes(&param.limits, size) {
            let changed = match value {
                ParamValue::Scalar(_) => vec![("", ParamValue::Scalar(number))],
                ParamValue::Vector(v) => along_axes(v.to_array(), number, |v| ParamValue::Vector(v.into())),
                // Only numbers have extremes.
                _ => continue,
            };
            for (axis, value) in changed {
                let mut shape = usual.clone();
                if shape.set_value(index, value) && shape != usual {
                    let circumstance = format!("{}{axis} {name}", param.name.replace('_', " "));
                    all.push(plain(StressNode::Shape(shape), circumstance));
                }
            }
        }
    }
}

/// The vector with one component replaced by `number`, for each axis, with the name of the axis.
fn along_axes<N: Copy, V>(usual: [N; 3], number: N, value: impl Fn([N; 3]) -> V) -> Vec<(&'static str, V)> {
    let replaced = |axis: usize| {
        let mut numbers = usual;
        numbers[axis] = number;
        value(numbers)
    };
    [(" x", 0), (" y", 1), (" z", 2)].map(|(name, axis)| (name, replaced(axis))).into()
}

fn blend_cases(operator: Operator, kernel: BlendKernel, all: &mut Vec<StressCase>) {
    let usual = Group::new(operator, usual_blend(kernel));
    // The circumstances exercise the same code for all kernels.
    if operator == Operator::Union || kernel == BlendKernel::ALL[0] {
        everywhere(&StressNode::Blend(usual), all);
    }
    let mut push = |group: Group, circumstance: String| all.push(plain(StressNode::Blend(group), circumstance));
    if operator.has_radius() {
        for (name, radius) in [("without a blend", 0.0), ("blend of 1e6", limits::BLEND_RADIUS.hard[1])] {
            push(Group { blend: Blend::new(kernel, radius), ..usual }, name.into());
        }
        if kernel.has_steps() && operator.has_steps() {
            for steps in limits::STEPS.hard {
                let blend = Blend { steps: steps as u32, ..usual.blend };
                push(Group { blend, ..usual }, format!("{steps} steps"));
            }
        }
    }
    if kernel != BlendKernel::ALL[0] {
        return;
    }
    for number in [0.0, 1e-4, 1e6] {
        if operator.has_width() {
            push(Group { width: number, ..usual }, format!("width {number:e}"));
        }
        if operator.has_depth() {
            push(Group { depth: number, ..usual }, format!("depth {number:e}"));
        }
    }
    if operator == Operator::Morph {
        for share in [0.0, 1.0] {
            push(Group { share, ..usual }, format!("share {share}"));
        }
    }
}

/// The modifier with an image of bumps if it needs an image.
fn with_image(mut modifier: Modifier) -> Modifier {
    const SIDE: u32 = 16;
    let rise = |x: u32| x * (SIDE - 1 - x);
    for (index, value) in modifier.values().into_iter().enumerate() {
        if let ParamValue::File(Attached::Heights(_)) = value {
            let bumps = Attachment::drawn("bumps.png", [SIDE; 2], |x, y| (rise(x) * rise(y) / 13) as u8);
            modifier.set_value(index, ParamValue::File(Attached::Heights(bumps)));
        }
    }
    modifier
}

fn modifier(kind: ModifierKind, all: &mut Vec<StressCase>) {
    let usual = with_image(kind.default_modifier());
    everywhere(&StressNode::Modified(usual.clone()), all);
    for (index, (param, value)) in kind.params().iter().zip(usual.values()).enumerate() {
        for (name, number) in extremes(&param.limits, 1.0) {
            let whole = number as u32;
            let changed = match value {
                ParamValue::Scalar(_) => vec![("", ParamValue::Scalar(number))],
                ParamValue::Vector(v) => along_axes(v.to_array(), number, |v| ParamValue::Vector(v.into())),
                ParamValue::Count(_) => vec![("", ParamValue::Count(whole))],
                ParamValue::Counts(counts) => along_axes(counts, whole, ParamValue::Counts),
                _ => continue,
            };
            for (axis, value) in changed {
                let mut changed_modifier = usual.clone();
                if changed_modifier.set_value(index, value) && changed_modifier != usual {
                    let circumstance = format!("{}{axis} {name}", param.name.replace('_', " "));
                    all.push(plain(StressNode::Modified(changed_modifier), circumstance));
                }
            }
        }
    }
    if let Modifier::Repeat { spacing, .. } = usual {
        const CELL: f64 = 1e4;
        for (name, axes) in [("a row", [0, 1, 1]), ("a grid", [0, 0, 0])] {
            let mut endless = usual.clone();
            endless.set_value(0, ParamValue::Counts(axes));
            let view = StressView::At(DVec3::from(spacing) * CELL * DVec3::from(axes.map(|n| f64::from(n == 0))));
            let case = plain(StressNode::Modified(endless), format!("cell 1e4 of {name} without end"));
            all.push(StressCase { view, ..case });
        }
    }
}
