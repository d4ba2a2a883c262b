//! Triangles in units of voxels, and which of them is nearest.

use glam::{DVec3, Vec3};

use super::super::bvh::Bvh;
use isolith_geometry::Aabb;

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;

/// Triangles with a hierarchy; corners in voxels from the first sample.
#[derive(Debug, Default)]
pub(super) struct Facets {
    corners: Vec<[Vec3; 3]>,
    /// The triangle of the mesh; [`NONE`] for one that closes a hole.
    pub sources: Vec<u32>,
    bvh: Bvh,
}

impl Facets {
    /// Builds the hierarchy. Triangles without area are left out.
    pub fn new(mut triangles: Vec<([Vec3; 3], u32)>) -> Self {
        triangles.retain(|([a, b, c], _)| (*b - *a).cross(*c - *a).length_squared() > 0.0);
        let (corners, sources): (Vec<_>, Vec<_>) = triangles.into_iter().unzip();
        let bvh = Bvh::build(corners.len(), |t| corners[t as usize].map(|corner| corner.as_dvec3()));
        Self { corners, sources, bvh }
    }

    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The nearest triangle within the square root of `within`, and the square of its distance.
    pub fn nearest(&self, p: Vec3, within: f32) -> Option<(f32, u32)> {
        self.nearest_of(p, within, |_| true)
    }

    /// The same among some of the triangles.
    pub fn nearest_of(&self, p: Vec3, within: f32, is_one: impl Fn(u32) -> bool) -> Option<(f32, u32)> {
        let (mut best, mut found) = (within, NONE);
        let at = p.as_dvec3();
        // Boxes are compared with a little less than their distance, since they are rounded in other ways.
        let away = |index: usize| 0.999_99 * distance_squared(&self.bvh.nodes[index].bounds, at) as f32;
        let mut open = Vec::with_capacity(64);
        if !self.bvh.nodes.is_empty() {
            open.push((away(0), 0));
        }
        while let Some((least, index)) = open.pop() {
            if least > best {
                continue;
            }
            let node = &self.bvh.nodes[index];
            if node.count > 0 {
                for &triangle in &self.bvh.triangles[node.first as usize..][..node.count as usize] {
                    let squared = self.distance_squared(triangle, p);
                    if squared <= best && is_one(triangle) {
                        (best, found) = (squared, triangle);
                    }
                }
                continue;
            }
            let (left, right) = (index + 1, node.first as usize);
            let (to_left, to_right) = (away(left), away(right));
            let ordered = if to_left <= to_right {
                [(to_right, right), (to_left, left)]
            } else {
                [(to_left, left), (to_right, right)]
            };
            open.extend(ordered);
        }
        (found != NONE).then_some((best, found))
    }

    /// Calls `found` with all triangles whose boxes meet this one.
    pub fn within(&self, bounds: &Aabb, mut found: impl FnMut(u32)) {
        let meets = |other: &Aabb| !other.intersection(bounds).is_empty();
        let mut open = Vec::with_capacity(64);
        if !self.bvh.nodes.is_empty() {
            open.push(0);
        }
        while let Some(index) = open.pop() {
            let node = &self.bvh.nodes[index];
            if !meets(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                open.extend([index + 1, node.first as usize]);
            } else {
                self.bvh.triangles[node.first as usize..][..node.count as usize].iter().for_each(|t| found(*t));
            }
        }
    }

    /// The box of a triangle.
    pub fn extent(&self, triangle: u32) -> [Vec3; 2] {
        let [a, b, c] = self.corners[triangle as usize];
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// The square of the distance from a triangle.
    pub fn distance_squared(&self, triangle: u32, p: Vec3) -> f32 {
        p.distance_squared(self.point(triangle, self.weights(triangle, p)))
    }

    /// The barycentric weights of the point of a triangle that is nearest to `p`.
    pub fn weights(&self, triangle: u32, p: Vec3) -> [f32; 3] {
        nearest_weights(&self.corners[triangle as usize], p)
    }

    /// The point of a triangle with these weights.
    pub fn point(&self, triangle: u32, weights: [f32; 3]) -> Vec3 {
        let [a, b, c] = self.corners[triangle as usize];
        a * weights[0] + b * weights[1] + c * weights[2]
    }
}

fn distance_squared(bounds: &Aabb, p: DVec3) -> f64 {
    (bounds.min - p).max(p - bounds.max).max(DVec3::ZERO).length_squared()
}

/// Barycentric weights of the nearest point, by the region of the triangle that it lies in (Ericson, "Real-Time
/// Collision Detection", 2005, section 5.1.5).
fn nearest_weights([a, b, c]: &[Vec3; 3], p: Vec3) -> [f32; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = 1.0 / (va + vb + vc);
    let (v, w) = (vb * sum, vc * sum);
    [1.0 - v - w, v, w]
}
