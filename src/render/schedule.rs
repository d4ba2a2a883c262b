//! Cuts a frame into dispatches that are short enough to be waited for, and learns how long they take.
//!
//! No dispatch may run long: it cannot be interrupted, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use glam::{DVec2, DVec3};

use super::uniforms::Work;
use crate::flat::{Component, FlatScene};
use crate::geometry::Camera;

/// Pixels along a side of a tile: a workgroup's.
pub const TILE: u32 = 8;
/// A dispatch is cut so that it is expected to take about this long; measured times scatter by a factor
/// of two or three around that, so it stays below 50 ms.
pub const DISPATCH_TARGET: Duration = Duration::from_millis(16);
/// Loop iterations that one invocation may do, with room below lavapipe's 65 535.
pub const MAX_ITERATIONS: u32 = 60_000;
/// Most steps of a ray through a component with bounds.
pub const MAX_STEPS: u32 = 4_096;
/// Most steps of a ray through a component without bounds, towards the horizon.
pub const MAX_STEPS_UNBOUNDED: u32 = 16_384;

/// Which pass a piece of work belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Clear the targets and draw the meshes.
    Mesh,
    /// March one component.
    Trace,
    /// Normals and materials.
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
    /// Expected effort, in evaluations of a leaf.
    pub effort: f64,
}

impl Piece {
    /// Workgroups along x and y.
    pub fn tiles(&self) -> [u32; 2] {
        [0, 1].map(|i| (self.work.end[i] - self.work.origin[i]).div_ceil(TILE))
    }
}

/// How fast the device is, learnt from what was measured.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    seconds_per_effort: f64,
}

impl Pace {
    /// A first guess.
    pub fn new(software: bool) -> Self {
        Self { seconds_per_effort: if software { 2e-8 } else { 2e-11 } }
    }

    /// Effort that is expected to take this long.
    pub fn effort_in(&self, time: Duration) -> f64 {
        time.as_secs_f64() / self.seconds_per_effort
    }

    /// Time that the effort is expected to take.
    pub fn time_for(&self, effort: f64) -> Duration {
        Duration::from_secs_f64((effort * self.seconds_per_effort).min(1e6))
    }

    /// Learns from a measurement. Slower than expected counts at once, faster bit by bit.
    pub fn learn(&mut self, effort: f64, took: Duration) {
        // Below a millisecond it is the submission that is measured, not the work.
        if effort <= 0.0 || took < Duration::from_millis(1) {
            return;
        }
        let seen = took.as_secs_f64() / effort;
        let share = if seen > self.seconds_per_effort { 0.6 } else { 0.15 };
        self.seconds_per_effort += (seen - self.seconds_per_effort) * share;
    }
}

/// All dispatches of a frame, in order.
pub fn plan(flat: &FlatScene, camera: &Camera, size: [u32; 2], pace: &Pace) -> Vec<Piece> {
    let whole = Rect { origin: [0, 0], end: size };
    let most = pace.effort_in(DISPATCH_TARGET);
    let mut pieces = vec![Piece { stage: Stage::Mesh, work: whole.work(0), effort: 0.0 }];
    for index in front_to_back(flat, camera) {
        let component = &flat.components[index];
        let Some(rect) = Rect::around(component, camera, size) else { continue };
        plan_trace(flat, index, rect, most, &mut pieces);
    }
    // A normal and a material take five evaluations of the component that was hit.
    let mean = flat.nodes.len() as f64 / flat.components.len().max(1) as f64;
    let largest = flat.components.iter().map(|c| c.count).max().unwrap_or(0);
    let surface = 5.0 * (mean + 0.1 * f64::from(largest)) + 1.0;
    let shade = 1.0 + flat.lights.len() as f64;
    for (stage, per_pixel) in [(Stage::Surface, surface), (Stage::Shade, shade)] {
        whole.cut(per_pixel, most, |rect| {
            pieces.push(Piece { stage, work: rect.work(0), effort: rect.pixels() * per_pixel });
        });
    }
    pieces
}

fn plan_trace(flat: &FlatScene, index: usize, rect: Rect, most: f64, pieces: &mut Vec<Piece>) {
    let component = &flat.components[index];
    let max_steps = if component.bounds.is_finite() { MAX_STEPS } else { MAX_STEPS_UNBOUNDED };
    // One iteration for each entry and one for each group that ends.
    let steps = (MAX_ITERATIONS / (2 * component.count + 1)).clamp(1, max_steps);
    let rounds = max_steps.div_ceil(steps);
    for round in 0..rounds {
        // Most rays have ended long before the last round; the others are few.
        let expected = if round == 0 { f64::from(steps.min(24)) } else { 0.3 };
        let per_pixel = f64::from(component.count) * expected;
        rect.cut(per_pixel, most, |rect| {
            let work =
                Work { max_steps: steps, round, last_round: u32::from(round + 1 == rounds), ..rect.work(index as u32) };
            pieces.push(Piece { stage: Stage::Trace, work, effort: rect.pixels() * per_pixel });
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

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Rect {
    origin: [u32; 2],
    end: [u32; 2],
}

impl Rect {
    /// The pixels that the component's bounds may cover; `None` where it is out of view.
    fn around(component: &Component, camera: &Camera, size: [u32; 2]) -> Option<Self> {
        let whole = Self { origin: [0, 0], end: size };
        if !component.bounds.is_finite() {
            return Some(whole);
        }
        let pixels = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let forward = camera.rotation * DVec3::NEG_Z;
        let mut behind = 0;
        for corner in component.bounds.translated(component.origin).corners() {
            if (corner - camera.position).dot(forward) < camera.near * 0.5 {
                behind += 1;
                continue;
            }
            if let Some((p, _)) = camera.project(corner, pixels) {
                low = low.min(p);
                high = high.max(p);
            }
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

    fn work(&self, component: u32) -> Work {
        Work { origin: self.origin, end: self.end, component, max_steps: 0, round: 0, last_round: 0 }
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
        for _ in 0..40 {
            pace.learn(1e6, Duration::from_millis(100));
        }
        let expected = pace.time_for(1e6).as_secs_f64();
        assert!((expected - 0.1).abs() < 0.01, "{expected}");
    }
}
