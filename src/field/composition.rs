//! Composition of operands into folds.

use std::rc::Rc;

use glam::{DAffine3, DVec3};

use super::arrays::Join;
use super::lower_bound::{LowerBound, fold_bounds};
use super::operand::{Operand, Value};
use isolith_scene::{Blend, Node};

impl<'a> Operand<'a> {
    /// The first operand of a fold, which joins nothing. `node` and `outermost` say where it belongs.
    pub fn first(node: &'a Node, outermost: &'a Node, lower_bound: LowerBound, value: Value<'a>) -> Self {
        let LowerBound { bounds, cull_box, bound_slope, .. } = lower_bound;
        let (entries, depth) = match &value {
            Value::Leaf { .. } => (1, 0),
            Value::Fold(inner) | Value::Modified { content: inner, .. } => {
                let (entries, depth) = size_of_fold(inner);
                (entries.saturating_add(1), depth + 1)
            }
        };
        let (join, blend, detail) = (Join::First, Blend::HARD, [0.0; 2]);
        Self { node, outermost, join, blend, detail, bounds, cull_box, bound_slope, entries, depth, value }
    }
}

/// A fold as one operand, with the node of its first operand.
pub(super) fn group_of(fold: Vec<Operand<'_>>) -> Operand<'_> {
    let Operand { node, outermost, .. } = fold[0];
    Operand::first(node, outermost, fold_bounds(&fold), Value::Fold(Rc::new(fold)))
}

/// The number of entries of all operands, and the depth of the deepest.
pub(super) fn size_of_fold(fold: &[Operand<'_>]) -> (usize, u32) {
    let sum = |(entries, depth): (usize, u32), o: &Operand<'_>| (entries.saturating_add(o.entries), depth.max(o.depth));
    fold.iter().fold((0, 0), sum)
}

/// A fold that starts with `operand`; the fold of a group simply continues.
pub(super) fn begin_with(mut operand: Operand<'_>) -> Vec<Operand<'_>> {
    operand.join = Join::First;
    match operand.value {
        Value::Fold(fold) => {
            let mut fold = Rc::unwrap_or_clone(fold);
            match fold.first_mut() {
                // The fold is taken as it is: groups that come first in each other may be many.
                Some(first) if !matches!(first.value, Value::Fold(_)) => {
                    first.join = Join::First;
                    fold
                }
                _ => {
                    let mut operands = fold.into_iter();
                    let mut fold = operands.next().map_or(Vec::new(), begin_with);
                    fold.extend(operands);
                    fold
                }
            }
        }
        Value::Leaf { .. } | Value::Modified { .. } => vec![operand],
    }
}

/// Whether a fold is a hard union, so that its operands can be traced alone.
pub(super) fn is_plain(fold: &[Operand<'_>]) -> bool {
    fold[1..].iter().all(|o| o.join == Join::Union && o.blend.radius == 0.0)
}

/// The operands that can be traced alone: those of a hard union, else the operand itself.
pub(super) fn apart(operand: Operand<'_>) -> Vec<Operand<'_>> {
    match operand.value {
        Value::Fold(fold) if is_plain(&fold) => Rc::unwrap_or_clone(fold),
        _ => vec![operand],
    }
}

/// The union of operands; `None` if there are none.
pub(super) fn united<'a>(
    node: &'a Node,
    outermost: &'a Node,
    operands: Vec<Operand<'a>>,
    radius: f64,
) -> Option<Operand<'a>> {
    let blend = Blend { radius, ..Blend::HARD };
    let mut operands = operands.into_iter();
    let first = Operand { join: Join::First, ..operands.next()? };
    let mut fold = if radius == 0.0 { apart(first) } else { begin_with(first) };
    for operand in operands {
        join(&mut fold, Operand { join: Join::Union, blend, ..operand });
    }
    if fold.len() == 1 { fold.pop() } else { Some(Operand { node, outermost, ..group_of(fold) }) }
}

/// Transforms of the copies around Y; the first copy stands out along X.
pub(super) fn polar_copies(count: u32, radius: f64, mirrored: bool) -> Vec<DAffine3> {
    let out = DAffine3::from_translation(DVec3::X * radius);
    let copy = |i: u32| {
        let turn = DAffine3::from_rotation_y(-std::f64::consts::TAU * f64::from(i) / f64::from(count));
        let flip = if mirrored && i % 2 == 1 { DVec3::new(1.0, 1.0, -1.0) } else { DVec3::ONE };
        turn * out * DAffine3::from_scale(flip)
    };
    (0..count).map(copy).collect()
}

/// Appends an operand. A hard union inside a hard union is opened: min is associative.
pub(super) fn join<'a>(fold: &mut Vec<Operand<'a>>, operand: Operand<'a>) {
    let hard_union = |o: &Operand<'_>| o.join == Join::Union && o.blend.radius == 0.0;
    match operand.value {
        Value::Fold(ref inner) if hard_union(&operand) && inner[1..].iter().all(hard_union) => {
            let Value::Fold(inner) = operand.value else { unreachable!("matched above") };
            let inner = Rc::unwrap_or_clone(inner);
            fold.extend(inner.into_iter().map(|o| Operand { join: Join::Union, blend: Blend::HARD, ..o }));
        }
        _ => fold.push(operand),
    }
}
