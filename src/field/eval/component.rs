//! The fold over a component's range of the subtree-extent array.

use std::ops::Range;

use glam::DVec3;

use super::{BlendParams, BlendResult, Dual, Payload, Real, op_join, shape_distance};
use crate::mixture::{Mixture, SurfaceMaterial, mixture_joined, mixture_material, mixture_of};
use crate::modifier_table::{
    modifier_count, modifier_exists, modifier_point, modifier_scale, modifier_start, modifier_value,
};
use crate::{Component, FlatNode, FlatScene, LEAF_ROWS, MODIFIER_ROWS, ParamRow, leaf_payload};
use isolith_scene::{ModifierKind, ShapeKind};

/// The field at `p`, in meters; `p` is relative to the component's origin.
pub fn field(flat: &FlatScene, component: &Component, p: DVec3) -> f64 {
    fold(flat, component, entries(component), at(p))
}

/// The field and its gradient at `p`. The gradient is exact where the field is smooth. On a ridge it is one of the
/// one-sided gradients; on an axis or at a center it may vanish.
pub fn gradient(flat: &FlatScene, component: &Component, p: DVec3) -> (f64, DVec3) {
    let Dual { v, d } = fold(flat, component, entries(component), at(p));
    (v, d)
}

/// The field of one entry at `p`, which is relative to the space of the entry.
pub fn entry_field(flat: &FlatScene, component: &Component, index: usize, p: DVec3) -> f64 {
    operand(flat, component, index, at(p))
}

/// The field of one entry with its gradient at `p`, which is relative to the space of the entry.
pub fn entry_gradient(flat: &FlatScene, component: &Component, index: usize, p: DVec3) -> (f64, DVec3) {
    let Dual { v, d } = operand(flat, component, index, at(p));
    (v, d)
}

/// The result of the first operands of a fold, those in `range`, at `p`.
pub fn partial_field(flat: &FlatScene, component: &Component, range: Range<usize>, p: DVec3) -> f64 {
    fold(flat, component, range, at(p))
}

/// The point in the space of what an entry holds, of a modifier in its first copy; `None` for leaves and runs, which
/// hold nothing.
pub fn content_point(flat: &FlatScene, component: &Component, index: usize, p: DVec3) -> Option<DVec3> {
    let node = &flat.nodes[index];
    if node.is_leaf() || node.is_run() {
        return None;
    }
    let Some(placing) = component.placing(flat, index) else { return Some(p) };
    let local = placed(&placing, p.to_array());
    let rows = &flat.params[node.params as usize..][MODIFIER_ROWS..];
    node.modifier().map(|kind| modifier_point(kind, local, 0, rows).into())
}

/// The rounding of 32-bit numbers in the weight of an operand: the largest deviation from one half where both
/// operands weigh the same.
pub const TIE: f64 = 16.0 * f32::EPSILON as f64;

/// The surface near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The field.
    pub distance: f64,
    /// Its gradient.
    pub gradient: DVec3,
    /// The leaf with the largest weight at each blend: index into [`FlatScene::nodes`].
    pub leaf: u32,
    /// Whether another operand of a blend has the same weight, within [`TIE`].
    pub tied: bool,
    /// The materials, by the weights of the blends.
    pub materials: Mixture,
    /// The mixture of the materials.
    pub material: SurfaceMaterial,
}

/// The field at `p` with all properties of the surface there.
pub fn surface(flat: &FlatScene, component: &Component, p: DVec3) -> SurfacePoint {
    let Surface { distance, leaf, tied, materials } = fold(flat, component, entries(component), at(p));
    let material = mixture_material(&materials, &flat.materials);
    SurfacePoint { distance: distance.v, gradient: distance.d, leaf, tied, materials, material }
}

fn entries(component: &Component) -> Range<usize> {
    component.first as usize..(component.first + component.count) as usize
}

/// The point as the variable of differentiation.
fn at<T: Real>(p: DVec3) -> [T; 3] {
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| T::coordinate(axis, 0.0, p))
}

/// The value that the fold carries: a number, or more.
trait Operand: Copy {
    type Number: Real;
    fn leaf(flat: &FlatScene, index: usize, distance: Self::Number) -> Self;
    fn distance(&self) -> Self::Number;
    /// The same operand with another distance.
    fn with_distance(self, distance: Self::Number) -> Self;
    /// Joins `operand` to `self`, given the result of the blend.
    fn joined(self, operand: Self, result: BlendResult<Self::Number>) -> Self;
}

impl<T: Real> Operand for T {
    type Number = T;
    fn leaf(_: &FlatScene, _: usize, distance: T) -> Self {
        distance
    }
    fn distance(&self) -> T {
        *self
    }
    fn with_distance(self, distance: T) -> Self {
        distance
    }
    fn joined(self, _: Self, result: BlendResult<T>) -> Self {
        result.value
    }
}

#[derive(Clone, Copy)]
struct Surface {
    distance: Dual,
    leaf: u32,
    tied: bool,
    materials: Mixture,
}

impl Operand for Surface {
    type Number = Dual;
    fn leaf(flat: &FlatScene, index: usize, distance: Dual) -> Self {
        let materials = mixture_of(flat.nodes[index].material);
        Self { distance, leaf: index as u32, tied: false, materials }
    }
    fn distance(&self) -> Dual {
        self.distance
    }
    fn with_distance(self, distance: Dual) -> Self {
        Self { distance, ..self }
    }
    fn joined(self, operand: Self, result: BlendResult<Dual>) -> Self {
        let heavier = if result.weight > 0.5 { operand } else { self };
        Self {
            distance: result.value,
            leaf: heavier.leaf,
            tied: heavier.tied || (result.weight - 0.5).abs() <= TIE,
            materials: mixture_joined(self.materials, operand.materials, result.weight),
        }
    }
}

/// Folds the siblings in `range`. The recursion depth is the nesting of groups after flattening, at most
/// [`crate::MAX_STACK`].
fn fold<O: Operand>(flat: &FlatScene, component: &Component, range: Range<usize>, p: [O::Number; 3]) -> O {
    let mut so_far: O = operand(flat, component, range.start, p);
    let mut at = range.start + flat.nodes[range.start].extent as usize;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            // Runs only say what may be skipped; the CPU evaluator skips nothing.
            at += 1;
            continue;
        }
        let next: O = operand(flat, component, at, p);
        let blend_params = BlendParams::read(&flat.params[node.params as usize]);
        let result = op_join(node.join(), so_far.distance(), next.distance(), &blend_params, node.kernel());
        so_far = so_far.joined(next, result);
        at += node.extent as usize;
    }
    so_far
}

fn operand<O: Operand>(flat: &FlatScene, component: &Component, index: usize, p: [O::Number; 3]) -> O {
    let node = &flat.nodes[index];
    let params = &flat.params[node.params as usize..];
    let content = index + 1..index + node.extent as usize;
    let Some(placing) = component.placing(flat, index) else { return fold(flat, component, content, p) };
    let local = placed(&placing, p);
    match node.modifier() {
        Some(kind) => modified(kind, params, local, &|q| fold(flat, component, content.clone(), q)),
        None => O::leaf(flat, index, leaf_distance(flat, node, params, local)),
    }
}

/// The field at `p` of a modifier whose rows `params` begins with; `content` is the field of its content, in its
/// space.
pub fn modified_field(kind: ModifierKind, params: &[ParamRow], p: DVec3, content: &dyn Fn(DVec3) -> f64) -> f64 {
    modified(kind, params, placed(&params[3..6], p.to_array()), &|q| content(q.into()))
}

/// The content of a modifier, in as many copies as it evaluates; `local` is in its space.
fn modified<O: Operand>(
    kind: ModifierKind,
    params: &[ParamRow],
    local: [O::Number; 3],
    content: &dyn Fn([O::Number; 3]) -> O,
) -> O {
    let rows = &params[MODIFIER_ROWS..];
    let start = modifier_start(kind, local, rows);
    let mut nearest: Option<O> = None;
    for k in 0..modifier_count(kind, rows) {
        if !modifier_exists(kind, local, k, rows) {
            continue;
        }
        let copy = content(modifier_point(kind, local, k, rows));
        let copy = copy.with_distance(copy.distance() * modifier_scale(kind, k, rows));
        let is_nearer = |other: O| copy.distance().value() < other.distance().value();
        if nearest.is_none_or(is_nearer) {
            nearest = Some(copy);
        }
    }
    // Without a copy nearby the first one supplies the surface properties.
    let (carrier, found) = match nearest {
        Some(copy) => (copy, start.min(copy.distance())),
        None => (content(modifier_point(kind, local, 0, rows)), start),
    };
    carrier.with_distance(modifier_value(kind, found, local, rows) * f64::from(params[1][3]))
}

/// The point mapped by three rows.
fn placed<T: Real, N: Copy + Into<f64>>(rows: &[[N; 4]], p: [T; 3]) -> [T; 3] {
    std::array::from_fn(|i| {
        let [x, y, z, shift] = rows[i].map(N::into);
        p[0] * x + p[1] * y + p[2] * z + shift
    })
}

fn leaf_distance<T: Real>(flat: &FlatScene, node: &FlatNode, params: &[ParamRow], local: [T; 3]) -> T {
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    let mut parameters = [0.0; 8];
    for row in 0..kind.parameter_rows() {
        parameters[4 * row..4 * row + 4].copy_from_slice(&params[LEAF_ROWS + row].map(f64::from));
    }
    let data = LeafData { rows: leaf_payload(kind, params), flat };
    shape_distance(kind, local, &parameters, &data) * f64::from(params[0][1])
}

/// The payload of a leaf in the arrays.
struct LeafData<'a> {
    rows: &'a [ParamRow],
    flat: &'a FlatScene,
}

impl Payload for LeafData<'_> {
    fn row(&self, index: usize) -> [f64; 4] {
        self.rows[index].map(f64::from)
    }
    fn texel(&self, index: usize) -> [u32; 4] {
        self.flat.bricks.texel(index)
    }
}
