//! The fold over a component's range of the subtree-extent array.

use std::ops::Range;

use glam::DVec3;

use super::{BlendParams, BlendResult, Dual, Real, op_join, shape_distance};
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

/// The field and its gradient at `p`. The gradient is exact where the field is smooth, one of the
/// one-sided ones on a ridge, and may vanish on an axis or at a center.
pub fn gradient(flat: &FlatScene, component: &Component, p: DVec3) -> (f64, DVec3) {
    let Dual { v, d } = fold(flat, component, entries(component), at(p));
    (v, d)
}

/// The field of one entry at `p`, which is relative to the space that the entry stands in.
pub fn entry_field(flat: &FlatScene, component: &Component, index: usize, p: DVec3) -> f64 {
    operand(flat, component, index, at(p))
}

/// What 32-bit numbers may make of the weight of an operand: by how much it may be off one half where both weigh the same.
pub const TIE: f64 = 16.0 * f32::EPSILON as f64;

/// What the surface near a point is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The field.
    pub distance: f64,
    /// Its gradient.
    pub gradient: DVec3,
    /// The leaf that outweighs the others at each blend: index into [`FlatScene::nodes`].
    pub leaf: u32,
    /// Whether at a blend another one weighs as much, within [`TIE`].
    pub tied: bool,
    /// The materials, by the weights of the blends.
    pub materials: Mixture,
    /// What they are, mixed.
    pub material: SurfaceMaterial,
}

/// The field at `p` with everything that the surface there needs.
pub fn surface(flat: &FlatScene, component: &Component, p: DVec3) -> SurfacePoint {
    let Surface { distance, leaf, tied, materials } = fold(flat, component, entries(component), at(p));
    let material = mixture_material(&materials, &flat.materials);
    SurfacePoint { distance: distance.v, gradient: distance.d, leaf, tied, materials, material }
}

fn entries(component: &Component) -> Range<usize> {
    component.first as usize..(component.first + component.count) as usize
}

/// The point that derivatives are taken for.
fn at<T: Real>(p: DVec3) -> [T; 3] {
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| T::coordinate(axis, 0.0, p))
}

/// What the fold carries along: a number, or more.
trait Operand: Copy {
    type Number: Real;
    fn leaf(flat: &FlatScene, index: usize, distance: Self::Number) -> Self;
    fn distance(&self) -> Self::Number;
    /// The same with another distance.
    fn with_distance(self, distance: Self::Number) -> Self;
    /// `self` and `operand` joined, with the result at hand.
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

/// Folds the siblings in `range`. Recursion is as deep as groups are nested after flattening, at most
/// [`crate::MAX_STACK`].
fn fold<O: Operand>(flat: &FlatScene, component: &Component, range: Range<usize>, p: [O::Number; 3]) -> O {
    let mut so_far: O = operand(flat, component, range.start, p);
    let mut at = range.start + flat.nodes[range.start].extent as usize;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            // Only says what may be skipped; the reference skips nothing.
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
        None => O::leaf(flat, index, leaf_distance(node, params, local)),
    }
}

/// The field at `p` of a modifier whose rows `params` begins with; `content` is the field of what it holds, in its space.
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
    // Where no copy is near, something must still say what the surface would be.
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

fn leaf_distance<T: Real>(node: &FlatNode, params: &[ParamRow], local: [T; 3]) -> T {
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    let mut parameters = [0.0; 8];
    for row in 0..kind.parameter_rows() {
        parameters[4 * row..4 * row + 4].copy_from_slice(&params[LEAF_ROWS + row].map(f64::from));
    }
    let data = leaf_payload(kind, params);
    shape_distance(kind, local, &parameters, &|row| data[row].map(f64::from)) * f64::from(params[0][1])
}
