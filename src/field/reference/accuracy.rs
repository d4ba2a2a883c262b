//! The error of an image against the reference on the same rays.
//!
//! A pixel is wrong where it shows a hit and the reference a miss, or the reverse; where it shows another node than
//! the reference; or the same node at a depth that is off by more than a footprint. There are only two exceptions:
//!
//! - *Where two nodes meet*, rounding decides which one is visible: the depth is right within [`MEETING`] footprints,
//!   and either the reference shows that node in one of the eight pixels around, or both have the same weight in a
//!   blend, within [`TIE`](crate::eval::TIE).
//! - *Where the ray grazes*, rounding decides its hit: a ray turned by
//!   [`GRAZING_ANGLE`](super::tolerance::GRAZING_ANGLE), the resolution of 32-bit numbers, sees what the image shows.
//!   Such pixels are counted separately.
//!
//! A surface that faces the ray shows the same from every side: drawing a sheet of no thickness is wrong.

use super::image::{ReferenceImage, node_of};
use super::tolerance::{MEETING, WRONG_DEPTH};
use crate::{FlatScene, GBuffer};
use isolith_scene::NodeId;

/// The largest fraction of wrong pixels.
pub const MAX_WRONG_SHARE: f64 = 1e-4;
/// Largest error of the depth at the 99th percentile, in pixel footprints.
pub const MAX_DEPTH_P99: f64 = 0.05;
/// Largest median error of the normal, in degrees.
pub const MAX_NORMAL_P50: f64 = 0.1;

/// The verdict on a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It shows what the reference shows.
    Right,
    /// It differs, but a ray turned within rounding would show the same.
    Grazing,
    /// It shows a hit and the reference a miss, or the reverse.
    HitOrMiss,
    /// It shows another node.
    OtherNode,
    /// Its depth is off by more than a footprint.
    OffDepth,
    /// Its depth is NaN.
    NotANumber,
}

impl Verdict {
    /// Whether it is wrong.
    pub fn is_wrong(self) -> bool {
        !matches!(self, Self::Right | Self::Grazing)
    }
}

/// The errors of an image. Depth and normal are compared where both images have a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// Pixels in the image.
    pub pixels: usize,
    /// Wrong pixels of any kind, without those in `grazing`.
    pub wrong: usize,
    /// Wrong pixels where only one of the images has a hit, or where the depth is NaN.
    pub hit_miss_differs: usize,
    /// Wrong pixels that show another node.
    pub node_differs: usize,
    /// Wrong pixels that show the right node at a wrong depth.
    pub depth_differs: usize,
    /// Pixels that differ in one of these ways, but whose ray grazes.
    pub grazing: usize,
    /// Median error of the depth, in footprints of the pixel at the true depth.
    pub depth_p50: f64,
    /// The same, 99th percentile.
    pub depth_p99: f64,
    /// The same, maximum.
    pub depth_max: f64,
    /// Median angle between the normals, in degrees.
    pub normal_p50: f64,
    /// The same, 99th percentile.
    pub normal_p99: f64,
}

/// Maps a value in [`GBuffer::leaf`] to its node.
type Nodes<'a> = Option<&'a dyn Fn(u32) -> Option<NodeId>>;

impl Accuracy {
    /// The errors of an image of the arrays `shown` against the reference.
    pub fn against(measured: &GBuffer, shown: &FlatScene, reference: &ReferenceImage) -> Self {
        Self::of(measured, reference, &verdicts(measured, shown, reference))
    }

    /// The errors of an image without nodes.
    pub fn of_depths(measured: &GBuffer, reference: &ReferenceImage) -> Self {
        Self::of(measured, reference, &judge_all(measured, reference, None))
    }

    /// Summarizes the verdicts on all pixels.
    pub fn of(measured: &GBuffer, reference: &ReferenceImage, verdicts: &[Verdict]) -> Self {
        let count = |verdict: Verdict| verdicts.iter().filter(|found| **found == verdict).count();
        let mut found = Self {
            pixels: reference.buffers.depth.len(),
            wrong: verdicts.iter().filter(|verdict| verdict.is_wrong()).count(),
            hit_miss_differs: count(Verdict::HitOrMiss) + count(Verdict::NotANumber),
            node_differs: count(Verdict::OtherNode),
            depth_differs: count(Verdict::OffDepth),
            grazing: count(Verdict::Grazing),
            ..Self::default()
        };
        if !same_size(measured, reference) {
            return found;
        }
        let (mut depths, mut normals) = (Vec::new(), Vec::new());
        for i in 0..found.pixels {
            if measured.depth[i].is_finite() && reference.buffers.depth[i].is_finite() {
                depths.push(depth_error(measured, reference, i));
                normals.push(angle(measured.normal[i], reference.buffers.normal[i]).to_degrees());
            }
        }
        depths.sort_by(f64::total_cmp);
        normals.sort_by(f64::total_cmp);
        [found.depth_p50, found.depth_p99, found.depth_max] = [0.5, 0.99, 1.0].map(|q| quantile(&depths, q));
        [found.normal_p50, found.normal_p99] = [0.5, 0.99].map(|q| quantile(&normals, q));
        found
    }

    /// The fraction of wrong pixels.
    pub fn wrong_share(&self) -> f64 {
        self.wrong as f64 / self.pixels.max(1) as f64
    }

    /// The fraction of pixels that differ from the reference but whose ray grazes.
    pub fn grazing_share(&self) -> f64 {
        self.grazing as f64 / self.pixels.max(1) as f64
    }

    /// The exceeded limits, in words; empty if there are none.
    pub fn faults(&self) -> Vec<String> {
        let checks = [
            ("share of pixels that are wrong", self.wrong_share(), MAX_WRONG_SHARE),
            ("depth error, 99th percentile, in footprints", self.depth_p99, MAX_DEPTH_P99),
            ("normal error, median, in degrees", self.normal_p50, MAX_NORMAL_P50),
        ];
        // An error that is NaN is a fault too.
        let beyond = checks.into_iter().filter(|(_, value, limit)| value.is_nan() || value > limit);
        beyond.map(|(what, value, limit)| format!("{what}: {value}, allowed {limit}")).collect()
    }
}

/// The verdict on each pixel of an image of the arrays `shown`.
pub fn verdicts(measured: &GBuffer, shown: &FlatScene, reference: &ReferenceImage) -> Vec<Verdict> {
    judge_all(measured, reference, Some(&|code| node_of(shown, code)))
}

fn same_size(measured: &GBuffer, reference: &ReferenceImage) -> bool {
    (measured.width, measured.height) == (reference.buffers.width, reference.buffers.height)
}

/// Images of different sizes differ in every pixel.
fn judge_all(measured: &GBuffer, reference: &ReferenceImage, nodes: Nodes<'_>) -> Vec<Verdict> {
    let pixels = reference.buffers.depth.len();
    if !same_size(measured, reference) {
        return vec![Verdict::HitOrMiss; pixels];
    }
    (0..pixels).map(|i| judge(measured, reference, nodes, i)).collect()
}

/// The depth error in footprints of the pixel at the true depth.
fn depth_error(measured: &GBuffer, reference: &ReferenceImage, i: usize) -> f64 {
    let (m, t) = (f64::from(measured.depth[i]), f64::from(reference.buffers.depth[i]));
    (m - t).abs() / (reference.footprint * t)
}

fn judge(measured: &GBuffer, reference: &ReferenceImage, nodes: Nodes<'_>, i: usize) -> Verdict {
    let (m, t) = (measured.depth[i], reference.buffers.depth[i]);
    let node = nodes.map(|nodes| nodes(measured.leaf[i]));
    let found = match () {
        () if m.is_nan() => return Verdict::NotANumber,
        () if m.is_finite() != t.is_finite() => Verdict::HitOrMiss,
        () if !t.is_finite() => Verdict::Right,
        () if node.is_some_and(|node| node != reference.nodes[i] && !meets(measured, reference, node, i)) => {
            Verdict::OtherNode
        }
        () if depth_error(measured, reference, i) > WRONG_DEPTH => Verdict::OffDepth,
        () => Verdict::Right,
    };
    if found.is_wrong() && reference.may_show(i, m, node) { Verdict::Grazing } else { found }
}

/// Whether the shown node meets the true one in the pixel, see above.
fn meets(measured: &GBuffer, reference: &ReferenceImage, node: Option<NodeId>, i: usize) -> bool {
    let [width, height] = [measured.width, measured.height].map(i64::from);
    let [x, y] = [i as i64 % width, i as i64 / width];
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
    let mut inside = around.filter(|(x, y)| (0..width).contains(x) && (0..height).contains(y));
    let mut is_beside = || inside.any(|(x, y)| reference.nodes[(y * width + x) as usize] == node);
    depth_error(measured, reference, i) <= MEETING && (reference.tied[i] || is_beside())
}

/// The angle between two directions in radians, accurate for small angles, where the arc cosine is not. π if one of
/// them is not a direction.
fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|v| glam::Vec3::from(v).as_dvec3());
    let (sine, cosine) = (a.cross(b).length(), a.dot(b));
    if sine + cosine.abs() > 0.0 { sine.atan2(cosine) } else { std::f64::consts::PI }
}

/// The value that a fraction `q` of the sorted values does not exceed; 0 for an empty list.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::NO_LEAF;
    use crate::reference::image::Glimpse;

    const FOOTPRINT: f64 = 0.01;
    const BLOCK: u32 = 0;
    const FLOOR: u32 = 1;
    const WALL: u32 = 2;
    const WIRE: u32 = 3;

    /// Maps a value in the buffers to the node of an imagined scene.
    fn node(code: u32) -> Option<NodeId> {
        (code != NO_LEAF).then_some(NodeId(u64::from(code)))
    }

    fn reference_of(buffers: GBuffer) -> ReferenceImage {
        let nodes = buffers.leaf.iter().map(|code| node(*code)).collect();
        let (margin, tied) = (vec![1.0; buffers.depth.len()], vec![false; buffers.depth.len()]);
        ReferenceImage { buffers, margin, footprint: FOOTPRINT, nodes, tied, turned: HashMap::new() }
    }

    /// A 10 by 20 image: its upper half shows a block that faces the eye at distance 4.
    fn block() -> GBuffer {
        let hit = |i: usize| i < 100;
        GBuffer {
            width: 10,
            height: 20,
            depth: (0..200).map(|i| if hit(i) { 4.0 } else { f32::INFINITY }).collect(),
            leaf: (0..200).map(|i| if hit(i) { BLOCK } else { NO_LEAF }).collect(),
            normal: vec![[0.0, 0.0, 1.0]; 200],
            color: vec![[0; 4]; 200],
            radiance: Vec::new(),
        }
    }

    /// The same block before a wall at distance 9, with a pocket in the block, 0.6 deep, and a wire at distance 3
    /// that crosses the lower half.
    fn scene_before_a_wall() -> GBuffer {
        let mut all = block();
        let mut put = |i: usize, depth: f32, leaf: u32| (all.depth[i], all.leaf[i]) = (depth, leaf);
        (100..200).for_each(|i| put(i, 9.0, WALL));
        [33, 34, 43, 44].into_iter().for_each(|i| put(i, 4.6, FLOOR));
        (150..160).for_each(|i| put(i, 3.0, WIRE));
        all
    }

    fn measure(measured: &GBuffer, reference: &ReferenceImage) -> Accuracy {
        Accuracy::of(measured, reference, &judge_all(measured, reference, Some(&node)))
    }

    fn compare(change: impl Fn(&mut GBuffer)) -> Accuracy {
        let mut measured = block();
        change(&mut measured);
        measure(&measured, &reference_of(block()))
    }

    #[test]
    fn the_reference_itself_has_no_error() {
        let same = compare(|_| {});
        assert_eq!(same, Accuracy { pixels: 200, ..Accuracy::default() });
        assert!(same.faults().is_empty());
        let before_a_wall = reference_of(scene_before_a_wall());
        assert_eq!(measure(&scene_before_a_wall(), &before_a_wall).wrong, 0);
    }

    #[test]
    fn one_pixel_of_hit_or_miss_is_seen_and_refused() {
        for i in [0, 150] {
            let flipped = compare(|b| {
                (b.depth[i], b.leaf[i]) = if b.depth[i].is_finite() { (f32::INFINITY, NO_LEAF) } else { (4.0, BLOCK) };
            });
            assert_eq!((flipped.wrong, flipped.hit_miss_differs), (1, 1));
            assert_eq!(flipped.faults().len(), 1);
        }
    }

    #[test]
    fn a_pocket_drawn_closed_and_a_missing_wire_before_a_wall_are_refused() {
        let reference = reference_of(scene_before_a_wall());
        for is_known in [false, true] {
            // The node reveals it; where a face has the pocket's own node, the depth alone does.
            let mut closed = scene_before_a_wall();
            for i in [33, 34, 43, 44] {
                (closed.depth[i], closed.leaf[i]) = (4.0, if is_known { FLOOR } else { BLOCK });
            }
            let found = measure(&closed, &reference);
            let kinds = if is_known { (4, 0, 4) } else { (4, 4, 0) };
            assert_eq!((found.wrong, found.node_differs, found.depth_differs), kinds);
            assert_eq!(found.hit_miss_differs, 0);
            assert!(!found.faults().is_empty());
        }
        let mut cut = scene_before_a_wall();
        (150..160).for_each(|i| (cut.depth[i], cut.leaf[i]) = (9.0, WALL));
        let found = measure(&cut, &reference);
        assert_eq!((found.wrong, found.node_differs), (10, 10));
        assert!(!found.faults().is_empty());
        // A comparison without nodes detects it by the depth.
        assert_eq!(Accuracy::of(&cut, &reference, &judge_all(&cut, &reference, None)).depth_differs, 10);
    }

    #[test]
    fn another_node_is_right_only_where_both_meet() {
        let reference = reference_of(scene_before_a_wall());
        let shown = |i: usize, leaf: u32, away: f32| {
            let mut measured = scene_before_a_wall();
            measured.leaf[i] = leaf;
            measured.depth[i] += away;
            measure(&measured, &reference).node_differs
        };
        // Next to the pocket, and next to the wall.
        assert_eq!((shown(32, FLOOR, 0.0), shown(95, WALL, 0.001)), (0, 0));
        // At another depth, away from the pocket, and a node that is not nearby.
        assert_eq!((shown(32, FLOOR, 0.01), shown(30, FLOOR, 0.0), shown(32, WIRE, 0.0)), (1, 1, 1));
        // Two nodes of the same weight, at the same depth.
        let mut blended = reference_of(block());
        blended.tied[55] = true;
        let other = |i: usize, away: f32| {
            let mut measured = block();
            (measured.leaf[i], measured.depth[i]) = (WALL, 4.0 + away);
            measure(&measured, &blended).node_differs
        };
        assert_eq!((other(55, 0.0), other(55, 0.01), other(56, 0.0)), (0, 1, 1));
    }

    #[test]
    fn grazing_pixels_are_those_that_a_turned_ray_explains() {
        let miss = Glimpse { depth: f32::INFINITY, node: None };
        let hit = |depth: f32| Glimpse { depth, node: node(BLOCK) };
        let mut reference = reference_of(block());
        // Edges: from beside, the surface behind them is visible. The third pixel shows the same from all sides, as a
        // sheet does.
        reference.turned =
            HashMap::from([(7, vec![miss, hit(4.0)]), (9, vec![hit(4.0), hit(4.5)]), (11, vec![hit(4.0)])]);
        let judged = |i: usize, depth: f32| {
            let mut measured = block();
            (measured.depth[i], measured.leaf[i]) = (depth, if depth.is_finite() { BLOCK } else { NO_LEAF });
            judge(&measured, &reference, Some(&node), i)
        };
        assert_eq!([judged(7, f32::INFINITY), judged(9, 4.3)], [Verdict::Grazing; 2]);
        assert_eq!([judged(8, f32::INFINITY), judged(11, f32::INFINITY)], [Verdict::HitOrMiss; 2]);
        assert_eq!([judged(9, 4.7), judged(7, 4.3), judged(11, 4.3)], [Verdict::OffDepth; 3]);
        let mut measured = block();
        [7, 8].into_iter().for_each(|i| (measured.depth[i], measured.leaf[i]) = (f32::INFINITY, NO_LEAF));
        let found = measure(&measured, &reference);
        assert_eq!((found.wrong, found.grazing, found.grazing_share()), (1, 1, 0.005));
    }

    #[test]
    fn depth_is_measured_in_footprints() {
        let shifted = compare(|b| b.depth.iter_mut().for_each(|d| *d += 0.1 * 4.0 * 0.01));
        assert!((shifted.depth_p50 - 0.1).abs() < 1e-4 && (shifted.depth_max - 0.1).abs() < 1e-4, "{shifted:?}");
        assert_eq!((shifted.wrong, shifted.faults().len()), (0, 1));
        let one = compare(|b| b.depth[3] = 5.0);
        assert_eq!((one.depth_p50, one.depth_p99, one.wrong), (0.0, 0.0, 1));
        assert!((one.depth_max - 25.0).abs() < 1e-9);
    }

    #[test]
    fn normals_are_measured_in_degrees() {
        let tilt = |degrees: f32| {
            let (s, c) = degrees.to_radians().sin_cos();
            compare(move |b| b.normal.iter_mut().for_each(|n| *n = [s, 0.0, c]))
        };
        let slightly = tilt(0.02);
        assert!((slightly.normal_p50 - 0.02).abs() < 1e-5 && slightly.faults().is_empty(), "{slightly:?}");
        assert_eq!(tilt(0.2).faults().len(), 1);
        assert!(!compare(|b| b.normal.iter_mut().for_each(|n| *n = [0.0; 3])).faults().is_empty());
    }

    #[test]
    fn what_is_no_number_is_never_let_through() {
        assert_eq!(compare(|b| b.depth[0] = f32::NAN).hit_miss_differs, 1);
        assert_eq!(compare(|b| b.depth[199] = f32::NAN).hit_miss_differs, 1);
        assert!(!compare(|b| b.normal.iter_mut().for_each(|n| *n = [f32::NAN; 3])).faults().is_empty());
        let small = GBuffer { width: 20, height: 10, ..block() };
        assert_eq!(measure(&small, &reference_of(block())).wrong, 200);
    }
}
