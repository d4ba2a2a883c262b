//! The fold over a component's range of the subtree-extent array.

use std::ops::Range;

use glam::DVec3;

use super::{Dual, Joined, Real, op_join, shape_distance};
use crate::flat::{Component, FlatMaterial, FlatNode, FlatScene, LEAF_ROWS, Row, leaf_data};
use crate::scene::ShapeKind;

/// The field at `p`, in metres; `p` is relative to the component's origin.
pub fn field(flat: &FlatScene, component: &Component, p: DVec3) -> f64 {
    fold(flat, entries(component), p)
}

/// The field and its gradient at `p`. The gradient is exact where the field is smooth, one of the
/// one-sided ones on a ridge, and may vanish on an axis or at a centre.
pub fn gradient(flat: &FlatScene, component: &Component, p: DVec3) -> (f64, DVec3) {
    let Dual { v, d } = fold(flat, entries(component), p);
    (v, d)
}

/// What the surface near a point is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The field.
    pub distance: f64,
    /// Its gradient.
    pub gradient: DVec3,
    /// The leaf that outweighs the others at each joint: index into [`FlatScene::nodes`].
    pub leaf: u32,
    /// The materials, mixed by the weights of the joints.
    pub material: SurfaceMaterial,
}

/// The field at `p` with everything that the surface there needs.
pub fn surface(flat: &FlatScene, component: &Component, p: DVec3) -> SurfacePoint {
    let Surface { distance, leaf, material } = fold(flat, entries(component), p);
    SurfacePoint { distance: distance.v, gradient: distance.d, leaf, material }
}

/// A mixture of materials; see [`FlatMaterial`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceMaterial {
    /// Linear diffuse reflectance.
    pub albedo: DVec3,
    /// Strength of the highlight.
    pub specular: f64,
    /// Linear emitted colour.
    pub emission: DVec3,
    /// Blinn-Phong exponent.
    pub shininess: f64,
}

impl SurfaceMaterial {
    fn mix(self, other: Self, weight: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * weight;
        Self {
            albedo: self.albedo.lerp(other.albedo, weight),
            specular: mix(self.specular, other.specular),
            emission: self.emission.lerp(other.emission, weight),
            shininess: mix(self.shininess, other.shininess),
        }
    }
}

impl From<&FlatMaterial> for SurfaceMaterial {
    fn from(m: &FlatMaterial) -> Self {
        let color = |c: [f32; 3]| DVec3::from(c.map(f64::from));
        Self {
            albedo: color(m.albedo),
            specular: m.specular.into(),
            emission: color(m.emission),
            shininess: m.shininess.into(),
        }
    }
}

fn entries(component: &Component) -> Range<usize> {
    component.first as usize..(component.first + component.count) as usize
}

/// What the fold carries along: a number, or more.
trait Operand: Copy {
    type Number: Real;
    fn leaf(flat: &FlatScene, index: usize, distance: Self::Number) -> Self;
    fn distance(&self) -> Self::Number;
    /// `self` and `operand` joined, with the result at hand.
    fn joined(self, operand: Self, result: Joined<Self::Number>) -> Self;
}

impl<T: Real> Operand for T {
    type Number = T;
    fn leaf(_: &FlatScene, _: usize, distance: T) -> Self {
        distance
    }
    fn distance(&self) -> T {
        *self
    }
    fn joined(self, _: Self, result: Joined<T>) -> Self {
        result.value
    }
}

#[derive(Clone, Copy)]
struct Surface {
    distance: Dual,
    leaf: u32,
    material: SurfaceMaterial,
}

impl Operand for Surface {
    type Number = Dual;
    fn leaf(flat: &FlatScene, index: usize, distance: Dual) -> Self {
        let material = &flat.materials[flat.nodes[index].material as usize];
        Self { distance, leaf: index as u32, material: material.into() }
    }
    fn distance(&self) -> Dual {
        self.distance
    }
    fn joined(self, operand: Self, result: Joined<Dual>) -> Self {
        Self {
            distance: result.value,
            leaf: if result.weight > 0.5 { operand.leaf } else { self.leaf },
            material: self.material.mix(operand.material, result.weight),
        }
    }
}

/// Folds the siblings in `range`. Recursion is as deep as groups are nested after flattening, at most
/// [`crate::flat::MAX_STACK`].
fn fold<O: Operand>(flat: &FlatScene, range: Range<usize>, p: DVec3) -> O {
    let mut so_far: O = operand(flat, range.start, p);
    let mut at = range.start + flat.nodes[range.start].extent as usize;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            // Only says what may be skipped; the truth skips nothing.
            at += 1;
            continue;
        }
        let next: O = operand(flat, at, p);
        let support = f64::from(flat.numbers[node.numbers as usize][0]);
        let result = op_join(node.join(), so_far.distance(), next.distance(), support, node.kernel());
        so_far = so_far.joined(next, result);
        at += node.extent as usize;
    }
    so_far
}

fn operand<O: Operand>(flat: &FlatScene, index: usize, p: DVec3) -> O {
    let node = &flat.nodes[index];
    if node.is_group() {
        fold(flat, index + 1..index + node.extent as usize, p)
    } else {
        O::leaf(flat, index, leaf_distance(node, &flat.numbers[node.numbers as usize..], p))
    }
}

fn leaf_distance<T: Real>(node: &FlatNode, numbers: &[Row], p: DVec3) -> T {
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    let local = [1, 2, 3].map(|i| {
        let [x, y, z, shift] = numbers[i].map(f64::from);
        T::coordinate(DVec3::new(x, y, z), shift, p)
    });
    let mut parameters = [0.0; 8];
    for row in 0..kind.rows() {
        parameters[4 * row..4 * row + 4].copy_from_slice(&numbers[LEAF_ROWS + row].map(f64::from));
    }
    let data = leaf_data(numbers);
    shape_distance(kind, local, &parameters, &|row| data[row].map(f64::from)) * f64::from(numbers[0][1])
}
