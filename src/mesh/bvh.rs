//! A bounding volume hierarchy over triangles: the nearest hit of a ray in logarithmic time.
//!
//! Built with the binned surface area heuristic (Wald, "On fast construction of SAH-based bounding volume hierarchies",
//! 2007). Boxes are f64, since triangles may stand too far away for f32 to tell them apart.

use glam::{DMat3, DVec3};

use isolith_geometry::{Aabb, Ray};

/// The corners of a triangle.
pub type Triangle = [DVec3; 3];

/// A node of the tree. The left child of an inner node follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhNode {
    /// Its box.
    pub bounds: Aabb,
    /// Inner: index of the right child. Leaf: start of its triangles in [`Bvh::triangles`].
    pub first: u32,
    /// Inner: 0. Leaf: number of triangles.
    pub count: u32,
}

/// The hierarchy.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// Depth first, with the root first; empty without triangles.
    pub nodes: Vec<BvhNode>,
    /// The triangles in the order of the leaves.
    pub triangles: Vec<u32>,
}

/// A subtree of at most this many triangles is a leaf.
const LEAF_TRIANGLES: usize = 4;
const BINS: usize = 16;
/// From this depth on a subtree is split by count, so that the depth is bounded: 2³² triangles add 32.
const MAX_SAH_DEPTH: u32 = 48;

impl Bvh {
    /// Builds the tree over triangles `0..count`.
    pub fn build(count: usize, corners: impl Fn(u32) -> Triangle) -> Self {
        let boxes: Vec<Aabb> = (0..count as u32).map(|t| Aabb::from_points(corners(t))).collect();
        let mut triangles: Vec<u32> = (0..count as u32).collect();
        let mut nodes = Vec::with_capacity(count);
        // Pending ranges, each with the inner node whose right child it becomes.
        let mut open = vec![(0..count, None::<usize>, 0)];
        while let Some((range, parent, depth)) = open.pop() {
            if range.is_empty() {
                continue;
            }
            let index = nodes.len();
            if let Some(parent) = parent {
                let parent: &mut BvhNode = &mut nodes[parent];
                parent.first = index as u32;
            }
            let own = &mut triangles[range.clone()];
            let bounds = own.iter().fold(Aabb::EMPTY, |b, t| b.union(&boxes[*t as usize]));
            let mut node = BvhNode { bounds, first: range.start as u32, count: range.len() as u32 };
            if range.len() > LEAF_TRIANGLES {
                node.count = 0;
                let middle = range.start + split(own, &boxes, depth);
                open.push((middle..range.end, Some(index), depth + 1));
                open.push((range.start..middle, None, depth + 1));
            }
            nodes.push(node);
        }
        Self { nodes, triangles }
    }

    /// The nearest hit with 0 ≤ t ≤ `max_t`: parameter, triangle, barycentric weights. Of equally near hits, that of
    /// the lowest triangle index. Only hits that `is_there` accepts count.
    pub fn hit(
        &self,
        ray: &Ray,
        max_t: f64,
        corners: impl Fn(u32) -> Triangle,
        is_there: impl Fn(u32, [f64; 3]) -> bool,
    ) -> Option<(f64, u32, [f64; 3])> {
        let mut best: Option<(f64, u32, [f64; 3])> = None;
        let mut open = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            open.push(0_usize);
        }
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            let limit = best.map_or(max_t, |(t, ..)| t);
            if entry(node, ray).is_none_or(|t| t > limit) {
                continue;
            }
            if node.count == 0 {
                let (left, right) = (index + 1, node.first as usize);
                let nearer_first = entry(&self.nodes[left], ray) <= entry(&self.nodes[right], ray);
                open.extend(if nearer_first { [right, left] } else { [left, right] });
                continue;
            }
            for &triangle in &self.triangles[node.first as usize..][..node.count as usize] {
                let limit = best.map_or(max_t, |(t, ..)| t);
                if let Some((t, weights)) = hit_triangle(ray, &corners(triangle))
                    && t <= limit
                    && best.is_none_or(|(best_t, best_triangle, _)| t < best_t || triangle < best_triangle)
                    && is_there(triangle, weights)
                {
                    best = Some((t, triangle, weights));
                }
            }
        }
        best
    }
}

impl Bvh {
    /// Distance from `p` to the nearest triangle that `is_there` accepts, measured after `place`; `within` if there is
    /// none so near.
    pub fn distance(
        &self,
        p: DVec3,
        place: &DMat3,
        within: f64,
        corners: impl Fn(u32) -> Triangle,
        is_there: impl Fn(u32) -> bool,
    ) -> f64 {
        // The least length of a vector of length 1 after `place` (Gershgorin's circles of the squared inverse).
        let squared = place.inverse() * place.inverse().transpose();
        let sum = |i: usize| squared.row(i).abs().element_sum();
        let least = (1.0 - 1e-9) / sum(0).max(sum(1)).max(sum(2)).sqrt();
        let away = |index: usize| self.nodes[index].bounds.distance(p).max(0.0) * least;
        let mut best = within;
        let mut open = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            open.push(0_usize);
        }
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            if away(index) >= best {
                continue;
            }
            if node.count == 0 {
                let (left, right) = (index + 1, node.first as usize);
                open.extend(if away(left) <= away(right) { [right, left] } else { [left, right] });
                continue;
            }
            let own = &self.triangles[node.first as usize..][..node.count as usize];
            for &triangle in own.iter().filter(|triangle| is_there(**triangle)) {
                best = best.min(distance_to_triangle(&corners(triangle).map(|corner| *place * (corner - p))));
            }
        }
        best
    }
}

/// Distance of the origin from a triangle: to its plane if the origin is above the triangle, else to the nearest edge.
fn distance_to_triangle([a, b, c]: &Triangle) -> f64 {
    let normal = (b - a).cross(c - a);
    let edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share = (-from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (from + along * share).length()
    };
    let is_within = |from: DVec3, to: DVec3| normal.cross(to - from).dot(from) <= 0.0;
    let is_above = is_within(*a, *b) && is_within(*b, *c) && is_within(*c, *a);
    match normal.try_normalize() {
        Some(normal) if is_above => a.dot(normal).abs(),
        _ => edge(*a, *b).min(edge(*b, *c)).min(edge(*c, *a)),
    }
}

/// The intersection of the ray with the triangle, from either side: parameter and barycentric weights (Möller and
/// Trumbore, "Fast, minimum storage ray/triangle intersection", 1997).
pub fn hit_triangle(ray: &Ray, [a, b, c]: &Triangle) -> Option<(f64, [f64; 3])> {
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = ray.origin - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(ab);
    let v = ray.direction.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t.is_finite()).then_some((t, [1.0 - u - v, u, v]))
}

/// The parameter at which the ray enters the node's box. The box is widened by a few units in the last place, so that
/// rounding never loses a triangle that lies in one of its sides.
fn entry(node: &BvhNode, ray: &Ray) -> Option<f64> {
    let Aabb { min, max } = node.bounds;
    let slack = (min.abs().max(max.abs()).max_element() + ray.origin.abs().max_element()) * 1e-14;
    let (near, _) = Aabb::new(min - slack, max + slack).ray_interval(ray)?;
    Some(near * (1.0 - 1e-12))
}

/// Orders the triangles so that the first `n` go left, and returns `n`; neither side is empty.
fn split(triangles: &mut [u32], boxes: &[Aabb], depth: u32) -> usize {
    let center = |t: u32| boxes[t as usize].center();
    let centers = Aabb::from_points(triangles.iter().map(|t| center(*t)));
    let extent = centers.max - centers.min;
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
    let bin_of = |t: u32| (((center(t)[axis] - centers.min[axis]) / extent[axis] * BINS as f64) as usize).min(BINS - 1);
    if depth < MAX_SAH_DEPTH && extent[axis] > 0.0 {
        let border = best_border(triangles, boxes, bin_of);
        let mut left = 0;
        for i in 0..triangles.len() {
            if bin_of(triangles[i]) < border {
                triangles.swap(i, left);
                left += 1;
            }
        }
        if left > 0 && left < triangles.len() {
            return left;
        }
    }
    let middle = triangles.len() / 2;
    triangles.select_nth_unstable_by(middle, |a, b| center(*a)[axis].total_cmp(&center(*b)[axis]).then(a.cmp(b)));
    middle
}

/// The first bin of the right side, at the minimum of the sum of surface area times count.
fn best_border(triangles: &[u32], boxes: &[Aabb], bin_of: impl Fn(u32) -> usize) -> usize {
    let mut bins = [(Aabb::EMPTY, 0_usize); BINS];
    for &t in triangles {
        let bin = &mut bins[bin_of(t)];
        *bin = (bin.0.union(&boxes[t as usize]), bin.1 + 1);
    }
    let cost = |bins: &[(Aabb, usize)]| {
        let (bounds, count) = bins.iter().fold((Aabb::EMPTY, 0), |(b, n), bin| (b.union(&bin.0), n + bin.1));
        let size = bounds.max - bounds.min;
        if count == 0 { 0.0 } else { count as f64 * (size.x * size.y + size.y * size.z + size.z * size.x) }
    };
    (1..BINS)
        .min_by(|a, b| {
            let total = |border: usize| cost(&bins[..border]) + cost(&bins[border..]);
            total(*a).total_cmp(&total(*b))
        })
        .unwrap_or(BINS / 2)
}
