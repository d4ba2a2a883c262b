//! Triangles in units of the finest voxels, which of them is nearest, and the same in voxels of coarser levels.

use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;
/// Triangles of a leaf.
const LEAF: usize = 4;
/// Bits of a coordinate in the order of the triangles.
const ORDER_BITS: u32 = 21;

/// Triangles with a hierarchy; corners in voxels from the first sample.
///
/// The triangles lie along a curve that fills space (Morton, 1966), four by four in the leaves of a complete binary tree.
/// It takes a sort to build, and its boxes are found without pointers: the children of node i are 2 i and 2 i + 1.
#[derive(Debug, Default)]
pub(super) struct Facets {
    corners: Vec<[Vec3; 3]>,
    /// The triangle of the mesh; [`NONE`] for one that closes a hole.
    sources: Vec<u32>,
    /// The lowest and highest corners of the nodes; the first is unused.
    boxes: Vec<[Vec3; 2]>,
}

/// The box of nothing, from which everything is infinitely far away.
const NOTHING: [Vec3; 2] = [Vec3::INFINITY, Vec3::NEG_INFINITY];

impl Facets {
    /// Builds the hierarchy. Triangles without area are left out.
    pub fn new(mut triangles: Vec<([Vec3; 3], u32)>) -> Self {
        triangles.retain(|([a, b, c], _)| (*b - *a).cross(*c - *a).length_squared() > 0.0);
        let whole = triangles.iter().fold(NOTHING, |bounds, (corners, _)| joined(bounds, extent(corners)));
        let scale = ((1 << ORDER_BITS) - 1) as f32 / (whole[1] - whole[0]).max_element().max(f32::MIN_POSITIVE);
        triangles.par_sort_by_cached_key(|(corners, source)| {
            let [low, high] = extent(corners);
            (order((0.5 * (low + high) - whole[0]) * scale), *source)
        });
        let (corners, sources): (Vec<[Vec3; 3]>, Vec<_>) = triangles.into_iter().unzip();
        let leaves = corners.len().div_ceil(LEAF).next_power_of_two();
        let mut boxes = vec![NOTHING; if corners.is_empty() { 0 } else { 2 * leaves }];
        for (leaf, own) in corners.chunks(LEAF).enumerate() {
            boxes[leaves + leaf] = own.iter().fold(NOTHING, |bounds, corners| joined(bounds, extent(corners)));
        }
        for node in (1..boxes.len() / 2).rev() {
            boxes[node] = joined(boxes[2 * node], boxes[2 * node + 1]);
        }
        Self { corners, sources, boxes }
    }

    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The triangles of a node, if it is a leaf.
    fn leaf(&self, node: usize) -> Option<std::ops::Range<usize>> {
        let first = LEAF * node.checked_sub(self.boxes.len() / 2)?;
        Some(first.min(self.corners.len())..(first + LEAF).min(self.corners.len()))
    }

    /// The nearest of some triangles within the square root of `within`, and the square of its distance.
    fn nearest_of(&self, p: Vec3, within: f32, is_one: impl Fn(u32) -> bool) -> Option<(f32, u32)> {
        let (mut best, mut found) = (within, NONE);
        // Boxes are compared with a little less than their distance, since they are rounded in other ways.
        let away = |node: usize| {
            let [low, high] = self.boxes[node];
            0.999_99 * (low - p).max(p - high).max(Vec3::ZERO).length_squared()
        };
        // One more is open for each level.
        let mut open = [(0.0, 0); 2 * usize::BITS as usize];
        let mut count = 0;
        if !self.boxes.is_empty() {
            (open[0], count) = ((away(1), 1), 1);
        }
        while count > 0 {
            count -= 1;
            let (least, node) = open[count];
            if least > best {
                continue;
            }
            if let Some(triangles) = self.leaf(node) {
                for triangle in triangles.map(|triangle| triangle as u32) {
                    let squared = self.distance_squared(triangle, p);
                    if squared <= best && is_one(triangle) {
                        (best, found) = (squared, triangle);
                    }
                }
                continue;
            }
            let (left, right) = (2 * node, 2 * node + 1);
            let (to_left, to_right) = (away(left), away(right));
            let ordered = if to_left <= to_right {
                [(to_right, right), (to_left, left)]
            } else {
                [(to_left, left), (to_right, right)]
            };
            for (least, node) in ordered {
                if least <= best {
                    open[count] = (least, node);
                    count += 1;
                }
            }
        }
        (found != NONE).then_some((best, found))
    }

    /// Calls `found` with all triangles whose boxes meet this one.
    fn within(&self, low: Vec3, high: Vec3, mut found: impl FnMut(u32)) {
        let meets = |[least, most]: [Vec3; 2]| least.cmple(high).all() && most.cmpge(low).all();
        let mut open = Vec::with_capacity(64);
        if !self.boxes.is_empty() {
            open.push(1);
        }
        while let Some(node) = open.pop() {
            if !meets(self.boxes[node]) {
                continue;
            }
            match self.leaf(node) {
                Some(triangles) => {
                    let own = triangles.filter(|triangle| meets(extent(&self.corners[*triangle])));
                    own.for_each(|triangle| found(triangle as u32));
                }
                None => open.extend([2 * node, 2 * node + 1]),
            }
        }
    }

    /// The square of the distance from a triangle.
    fn distance_squared(&self, triangle: u32, p: Vec3) -> f32 {
        p.distance_squared(self.point(triangle, self.weights(triangle, p)))
    }

    /// The barycentric weights of the point of a triangle that is nearest to `p`.
    fn weights(&self, triangle: u32, p: Vec3) -> [f32; 3] {
        nearest_weights(&self.corners[triangle as usize], p)
    }

    /// The point of a triangle with these weights.
    fn point(&self, triangle: u32, weights: [f32; 3]) -> Vec3 {
        let [a, b, c] = self.corners[triangle as usize];
        a * weights[0] + b * weights[1] + c * weights[2]
    }
}

/// The same triangles in voxels of a coarser level.
#[derive(Clone, Copy, Debug)]
pub(super) struct LevelFacets<'a> {
    facets: &'a Facets,
    scale: LevelScale,
}

/// Where the voxels of a level lie among those of the finest one.
#[derive(Clone, Copy, Debug)]
pub(super) struct LevelScale {
    /// The size of a voxel.
    pub step: i32,
    /// The first sample.
    pub first: IVec3,
}

impl LevelScale {
    /// A sample of the finest level.
    pub fn sample(&self, own: [i32; 3]) -> [i32; 3] {
        (IVec3::from(own) * self.step + self.first).to_array()
    }

    fn finest(&self, p: Vec3) -> Vec3 {
        p * self.step as f32 + self.first.as_vec3()
    }

    fn own(self, p: Vec3) -> Vec3 {
        (p - self.first.as_vec3()) / self.step as f32
    }

    fn area(&self) -> f32 {
        (self.step * self.step) as f32
    }
}

impl<'a> LevelFacets<'a> {
    pub fn new(facets: &'a Facets, scale: LevelScale) -> Self {
        Self { facets, scale }
    }

    pub fn nearest(&self, p: Vec3, within: f32) -> Option<(f32, u32)> {
        self.nearest_of(p, within, |_| true)
    }

    pub fn nearest_of(&self, p: Vec3, within: f32, is_one: impl Fn(u32) -> bool) -> Option<(f32, u32)> {
        let area = self.scale.area();
        let found = self.facets.nearest_of(self.scale.finest(p), within * area, is_one);
        found.map(|(squared, triangle)| (squared / area, triangle))
    }

    pub fn within(&self, low: Vec3, high: Vec3, found: impl FnMut(u32)) {
        self.facets.within(self.scale.finest(low), self.scale.finest(high), found);
    }

    pub fn extent(&self, triangle: u32) -> [Vec3; 2] {
        extent(&self.facets.corners[triangle as usize]).map(|p| self.scale.own(p))
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.facets.corners[triangle as usize].map(|p| self.scale.own(p))
    }

    /// The triangle of the mesh; [`NONE`] for one that closes a hole.
    pub fn source(&self, triangle: u32) -> u32 {
        self.facets.sources[triangle as usize]
    }

    pub fn distance_squared(&self, triangle: u32, p: Vec3) -> f32 {
        let p = self.scale.finest(p);
        p.distance_squared(self.facets.point(triangle, self.facets.weights(triangle, p))) / self.scale.area()
    }

    /// The barycentric weights of the point of a triangle that is nearest to `p`, and this point.
    pub fn foot(&self, triangle: u32, p: Vec3) -> ([f32; 3], Vec3) {
        let weights = self.facets.weights(triangle, self.scale.finest(p));
        (weights, self.scale.own(self.facets.point(triangle, weights)))
    }
}

fn extent([a, b, c]: &[Vec3; 3]) -> [Vec3; 2] {
    [a.min(*b).min(*c), a.max(*b).max(*c)]
}

fn joined([low, high]: [Vec3; 2], other: [Vec3; 2]) -> [Vec3; 2] {
    [low.min(other[0]), high.max(other[1])]
}

/// The place of a point along the curve: the bits of its coordinates by turns.
fn order(p: Vec3) -> u64 {
    let spread = |v: f32| (0..ORDER_BITS).fold(0, |all, bit| all | (v as u64 >> bit & 1) << (3 * bit));
    spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2
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
