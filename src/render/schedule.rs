//! Cuts a frame into dispatches that are short enough to be waited for, and learns how long they take.
//!
//! No dispatch may run long: it cannot be interrupted, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use bytemuck::Zeroable as _;
use glam::{DVec2, DVec3};

use super::uniforms::Work;
use crate::flat::{CellTree, Component, FlatScene};
use crate::geometry::Camera;

/// Pixels along a side of a tile: a workgroup's.
pub const TILE: u32 = 8;
/// A dispatch is cut so that it is expected to take about this long; measured times scatter by a factor
/// of two or three around that, so nearly all stay below 50 ms.
pub const DISPATCH_TARGET: Duration = Duration::from_millis(16);
/// Loop iterations that one invocation may do, with room below lavapipe's 65 535.
pub const MAX_ITERATIONS: u32 = 60_000;
/// Most steps of a ray through a component with bounds.
pub const MAX_STEPS: u32 = 4_096;
/// Most steps of a ray through a component without bounds, towards the horizon.
pub const MAX_STEPS_UNBOUNDED: u32 = 16_384;

/// Most pixels of one piece of a component: as many rays may be left.
const MOST_PIXELS: f64 = 1048576.0;

/// Steps of a ray in one dispatch over a component without bounds: towards the horizon thousands may be
/// needed, which in one dispatch took two seconds.
pub const STEPS_UNBOUNDED: u32 = 512;

/// Which pass a piece of work belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Clear the targets and draw the meshes.
    Mesh,
    /// The farthest depth of each tile after the meshes.
    Farthest,
    /// Find the tiles that a component touches.
    Cone,
    /// March one component within these tiles.
    Trace,
    /// Normals and materials of its hits.
    Surface,
    /// Light.
    Shade,
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Its pass.
    pub stage: Stage,
    /// What it does.
    pub work: Work,
    /// Expected effort.
    pub effort: Effort,
}

impl Piece {
    /// Tiles along x and y.
    pub fn tiles(&self) -> [u32; 2] {
        [0, 1].map(|i| (self.work.end[i] - self.work.origin[i]).div_ceil(TILE))
    }
}

/// Effort, in evaluations of a leaf, by the kind of kernel that makes them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// By interpreted kernels, and everything else.
    pub interpreted: f64,
    /// By specialised kernels.
    pub specialised: f64,
}

impl Effort {
    fn new(specialised: bool, amount: f64) -> Self {
        if specialised {
            Self { specialised: amount, ..Self::default() }
        } else {
            Self { interpreted: amount, ..Self::default() }
        }
    }
}

impl std::ops::Add for Effort {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { interpreted: self.interpreted + other.interpreted, specialised: self.specialised + other.specialised }
    }
}

/// How fast the device is, learnt from what was measured.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    interpreted: f64,
    specialised: f64,
}

impl Pace {
    /// A first guess.
    pub fn new(software: bool) -> Self {
        if software {
            Self { interpreted: 4e-8, specialised: 2e-9 }
        } else {
            Self { interpreted: 5e-11, specialised: 1e-11 }
        }
    }

    /// Seconds that the effort is expected to take.
    pub fn seconds(&self, effort: Effort) -> f64 {
        effort.interpreted * self.interpreted + effort.specialised * self.specialised
    }

    /// Effort of one kind that is expected to take this long.
    fn effort_in(&self, time: Duration, specialised: bool) -> f64 {
        time.as_secs_f64() / if specialised { self.specialised } else { self.interpreted }
    }

    /// Learns from a measurement. Slower than expected counts at once, faster bit by bit.
    pub fn learn(&mut self, effort: Effort, took: Duration) {
        let expected = self.seconds(effort);
        // Below a millisecond it is the submission that is measured, not the work.
        if expected <= 0.0 || took < Duration::from_millis(1) {
            return;
        }
        let ratio = (took.as_secs_f64() / expected).clamp(0.05, 20.0);
        let gain = if ratio > 1.0 { 0.6 } else { 0.3 };
        let of_special = effort.specialised * self.specialised / expected;
        self.specialised *= 1.0 + (ratio - 1.0) * gain * of_special;
        self.interpreted *= 1.0 + (ratio - 1.0) * gain * (1.0 - of_special);
    }
}

/// Loop iterations for each copy of an entry, about: a modifier's own loops (layers of noise, steps of a recursion).
const LOOPS_OF_COPIES: u32 = 2;

impl Evaluation {
    /// Of a component that is walked through, entry by entry, by code that holds `loops` besides; `rounds` is
    /// how many its own leaves take.
    pub fn of_entries(component: &Component, loops: u32, rounds: u32) -> Self {
        // For each entry an iteration, one for the choice of its shape, one for a group that ends. Of copies most are
        // out of reach.
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: false,
            iterations: ((4 + loops) * component.count + rounds + 2).saturating_mul(copies),
            leaves: f64::from(component.count) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of straight-line code for a component: loops are only in modifiers, at most one for each entry, and in leaves;
    /// `rounds` as in [`Evaluation::of_entries`].
    pub fn of_straight(component: &Component, rounds: u32) -> Self {
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: true,
            iterations: (2 + component.count + rounds).saturating_mul(copies),
            leaves: f64::from(component.count) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of a component with pruned lists.
    pub fn of_lists(tree: &CellTree, loops: u32, rounds: u32) -> Self {
        // Two iterations find the cell.
        Self {
            straight: false,
            iterations: (4 + loops) * tree.longest() + rounds + 8,
            leaves: tree.mean_length() + 2.0,
        }
    }
}

/// All dispatches of a frame.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// In order.
    pub pieces: Vec<Piece>,
    /// Lists of tiles that the cone passes write.
    pub lists: u32,
    /// Tiles in all lists together, if none is dropped.
    pub tiles: u32,
    /// Tiles in the longest list, if none is dropped.
    pub longest: u32,
}

/// Expected evaluations of a component per pixel of its outline: measured on the shipped scenes.
const CONE_EVALUATIONS: f64 = 0.2;
const TRACE_EVALUATIONS: f64 = 4.0;
const SURFACE_EVALUATIONS: f64 = 3.0;

/// What evaluating a component means for its kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// Whether the kernel is straight-line code.
    pub straight: bool,
    /// Most loop iterations of one evaluation.
    pub iterations: u32,
    /// Leaves that one evaluation visits, about.
    pub leaves: f64,
}

/// Plans a frame. `evaluations` stand beside the components.
pub fn plan(flat: &FlatScene, camera: &Camera, size: [u32; 2], evaluations: &[Evaluation], pace: &Pace) -> Plan {
    let whole = Rect { origin: [0, 0], end: size };
    let mut plan = Plan::default();
    plan.push(Stage::Mesh, whole.work(0), Effort::default());
    if !flat.meshes.is_empty() {
        plan.push(Stage::Farthest, whole.work(0), Effort::new(false, whole.pixels() * 0.05));
    }
    let mut surfaces = Vec::new();
    let projection = Projection::new(camera, size);
    for index in front_to_back(flat, camera) {
        let Some(rect) = Rect::around(&flat.components[index], &projection, size) else { continue };
        plan.component(flat, index, rect, evaluations[index], pace, &mut surfaces);
    }
    // The rays that are left stand behind how many they are; one list after the other uses the same place.
    let rays = plan.lists;
    plan.pieces.iter_mut().for_each(|piece| piece.work.rays = rays);
    // Normals only of what is still seen when all components are there.
    plan.pieces.append(&mut surfaces);
    let per_pixel = 0.3 + 0.2 * flat.lights.len() as f64;
    whole.cut(per_pixel, pace.effort_in(DISPATCH_TARGET, false), |rect| {
        plan.push(Stage::Shade, rect.work(0), Effort::new(false, rect.pixels() * per_pixel));
    });
    plan
}

impl Plan {
    /// Effort of the whole frame.
    pub fn effort(&self) -> Effort {
        self.pieces.iter().fold(Effort::default(), |sum, piece| sum + piece.effort)
    }

    fn push(&mut self, stage: Stage, work: Work, effort: Effort) {
        self.pieces.push(Piece { stage, work, effort });
    }

    fn component(
        &mut self,
        flat: &FlatScene,
        index: usize,
        rect: Rect,
        evaluation: Evaluation,
        pace: &Pace,
        surfaces: &mut Vec<Piece>,
    ) {
        let component = &flat.components[index];
        let Evaluation { straight, iterations, leaves } = evaluation;
        let (max_steps, at_once) =
            if component.bounds.is_finite() { (MAX_STEPS, MAX_STEPS) } else { (MAX_STEPS_UNBOUNDED, STEPS_UNBOUNDED) };
        let steps = (MAX_ITERATIONS / iterations).clamp(1, at_once);
        let rounds = max_steps.div_ceil(steps);
        let per_pixel = leaves * TRACE_EVALUATIONS;
        let most = pace.effort_in(DISPATCH_TARGET, straight).min(per_pixel * MOST_PIXELS);
        rect.cut(per_pixel, most, |rect| {
            let list = Work { max_steps: steps, list: self.lists, first_tile: self.tiles, ..rect.work(index as u32) };
            let effort = |evaluations: f64| Effort::new(straight, rect.pixels() * leaves * evaluations);
            self.push(Stage::Cone, list, effort(CONE_EVALUATIONS));
            for round in 0..rounds {
                let last_round = u32::from(round + 1 == rounds);
                let work = Work { round, last_round, packed: u32::from(round > 0), ..list };
                // Most rays have ended long before the last round.
                self.push(Stage::Trace, work, effort(if round == 0 { TRACE_EVALUATIONS } else { 0.1 }));
            }
            surfaces.push(Piece { stage: Stage::Surface, work: list, effort: effort(SURFACE_EVALUATIONS) });
            self.lists += 1;
            self.tiles += rect.tiles();
            self.longest = self.longest.max(rect.tiles());
        });
    }
}

/// Components in the order of their nearest points, so that what is hidden is met last.
fn front_to_back(flat: &FlatScene, camera: &Camera) -> Vec<usize> {
    let distance = |i: usize| {
        let c = &flat.components[i];
        c.bounds.distance(camera.position - c.origin)
    };
    let mut order: Vec<(f64, usize)> = (0..flat.components.len()).map(|i| (distance(i), i)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, i)| i).collect()
}

/// From the world to pixels.
struct Projection {
    eye: DVec3,
    forward: DVec3,
    /// Pixels to the right per length at depth 1.
    right: DVec3,
    /// Pixels downwards per length at depth 1.
    down: DVec3,
    /// The middle of the picture.
    center: DVec2,
    /// What is nearer has no place in the picture.
    near: f64,
}

impl Projection {
    fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let center = DVec2::new(f64::from(size[0]), f64::from(size[1])) * 0.5;
        let scale = center.y / camera.tan_half_fov();
        Self {
            eye: camera.position,
            forward: camera.rotation * DVec3::NEG_Z,
            right: camera.rotation * DVec3::X * scale,
            down: camera.rotation * DVec3::NEG_Y * scale,
            center,
            near: (camera.near * 0.5).max(1e-12),
        }
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Rect {
    origin: [u32; 2],
    end: [u32; 2],
}

impl Rect {
    /// The pixels that the component's bounds may cover; `None` where it is out of view.
    fn around(component: &Component, projection: &Projection, size: [u32; 2]) -> Option<Self> {
        let whole = Self { origin: [0, 0], end: size };
        if !component.bounds.is_finite() {
            return Some(whole);
        }
        let pixels = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut behind = 0;
        for corner in component.bounds.translated(component.origin - projection.eye).corners() {
            let depth = corner.dot(projection.forward);
            if depth < projection.near {
                behind += 1;
                continue;
            }
            let p = projection.center + DVec2::new(corner.dot(projection.right), corner.dot(projection.down)) / depth;
            low = low.min(p);
            high = high.max(p);
        }
        match behind {
            8 => return None,
            0 => {}
            // Part of it is beside or behind the eye: its image has no simple outline.
            _ => return Some(whole),
        }
        // A pixel of room for rounding.
        let low = (low - 1.0).floor().max(DVec2::ZERO);
        let high = (high + 1.0).ceil().min(pixels);
        if low.cmpge(high).any() {
            return None;
        }
        let snap = |v: f64| (v as u32) / TILE * TILE;
        Some(Self { origin: [snap(low.x), snap(low.y)], end: [high.x as u32, high.y as u32] })
    }

    fn pixels(&self) -> f64 {
        f64::from(self.end[0] - self.origin[0]) * f64::from(self.end[1] - self.origin[1])
    }

    fn tiles(&self) -> u32 {
        [0, 1].map(|i| (self.end[i] - self.origin[i]).div_ceil(TILE)).iter().product()
    }

    fn work(&self, component: u32) -> Work {
        Work { origin: self.origin, end: self.end, component, ..Work::zeroed() }
    }

    /// Cuts into pieces of at most `most` effort, or of one tile.
    fn cut(&self, per_pixel: f64, most: f64, mut each: impl FnMut(Self)) {
        let pixels = (most / per_pixel.max(1e-9)).max(f64::from(TILE * TILE));
        let width = self.end[0] - self.origin[0];
        let rows = ((pixels / f64::from(width)).min(1e9) as u32 / TILE * TILE).max(TILE);
        let columns = if f64::from(width * TILE) > pixels {
            ((pixels / f64::from(TILE)) as u32 / TILE * TILE).max(TILE)
        } else {
            width
        };
        let mut y = self.origin[1];
        while y < self.end[1] {
            let bottom = y.saturating_add(rows).min(self.end[1]);
            let mut x = self.origin[0];
            while x < self.end[0] {
                let right = x.saturating_add(columns).min(self.end[0]);
                each(Self { origin: [x, y], end: [right, bottom] });
                x = right;
            }
            y = bottom;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_every_pixel_once_and_stay_small() {
        let rect = Rect { origin: [16, 8], end: [301, 177] };
        for (per_pixel, most) in [(1.0, 1e12), (1.0, 5000.0), (100.0, 5000.0), (1e9, 1.0)] {
            let mut covered = vec![0; 301 * 177];
            rect.cut(per_pixel, most, |r| {
                let limit = most.max(per_pixel * f64::from(TILE * TILE));
                assert!(r.pixels() * per_pixel <= limit, "{r:?}");
                for y in r.origin[1]..r.end[1] {
                    for x in r.origin[0]..r.end[0] {
                        covered[(y * 301 + x) as usize] += 1;
                    }
                }
            });
            for y in 0..177 {
                for x in 0..301 {
                    let inside = x >= 16 && y >= 8;
                    assert_eq!(covered[y * 301 + x], i32::from(inside));
                }
            }
        }
    }

    #[test]
    fn the_pace_follows_what_is_measured() {
        let mut pace = Pace::new(true);
        let effort = Effort { interpreted: 1e6, specialised: 1e7 };
        for _ in 0..60 {
            pace.learn(effort, Duration::from_millis(100));
        }
        let expected = pace.seconds(effort);
        assert!((expected - 0.1).abs() < 0.01, "{expected}");
    }
}
