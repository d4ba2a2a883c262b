//! Cuts a frame into dispatches that are short enough to be waited for.
//!
//! No dispatch may run long: it cannot be interrupted, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use bytemuck::Zeroable as _;
use glam::{DVec2, DVec3, UVec2};

use super::pace::{Effort, Pace};
use super::uniforms::Work;
use crate::flat::{CellTree, Component, FlatScene};
use crate::geometry::Camera;

/// Pixels along a side of a tile: what a cone begins with.
pub const TILE: u32 = 8;
/// Quads along a side of a tile: what cones are narrowed down to.
pub const QUADS: u32 = 2;
/// A dispatch is cut so that it is expected to take about this long; measured times scatter by a factor
/// of two or three around that, so nearly all stay below 50 ms.
pub const DISPATCH_TARGET: Duration = Duration::from_millis(16);
/// Loop iterations that one invocation may do, with room below lavapipe's 65 535.
pub const MAX_ITERATIONS: u32 = 60_000;
/// Most steps of a ray through a component with bounds.
pub const MAX_STEPS: u32 = 4_096;
/// Most steps of a ray through a component without bounds, towards the horizon.
pub const MAX_STEPS_UNBOUNDED: u32 = 16_384;

/// Where rays have not ended by then, they are traced again with so many times as many steps, and again, before they are given
/// up. Along the face of a box 1 km long a ray creeps in 80 000 steps.
pub const LONGER: [u32; 2] = [8, 64];

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
    /// The farthest depth of each quad after the meshes.
    Farthest,
    /// Find the quads that a component touches.
    Cone,
    /// March one component within these quads.
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
            leaves: leaves(component, rounds) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of straight-line code for a component: loops are only in modifiers, at most one for each entry, and in leaves;
    /// `rounds` as in [`Evaluation::of_entries`].
    pub fn of_straight(component: &Component, rounds: u32) -> Self {
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: true,
            iterations: (2 + component.count + rounds).saturating_mul(copies),
            leaves: leaves(component, rounds) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of a component with pruned lists.
    pub fn of_lists(component: &Component, tree: &CellTree, loops: u32, rounds: u32) -> Self {
        // Two iterations find the cell.
        Self {
            straight: false,
            iterations: (4 + loops) * tree.longest() + rounds + 8,
            leaves: tree.mean_length() * leaves(component, rounds) / f64::from(component.count) + 2.0,
        }
    }
}

/// Entries of a component, the loops of its leaves counted in: a round takes a part of what a leaf takes, and most loops
/// end early.
fn leaves(component: &Component, rounds: u32) -> f64 {
    f64::from(component.count) + f64::from(rounds) * ROUND
}

/// Leaves that a round counts as. With 0 single batches took 0.55 s in `fractals`, now 0.16; its stills take a tenth longer,
/// with 1 those of `drawn` took a third longer.
const ROUND: f64 = 0.25;

/// All dispatches of a frame.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// In order.
    pub pieces: Vec<Piece>,
    /// Lists of quads that the cone passes write.
    pub lists: u32,
    /// Quads in all lists together, if none is dropped.
    pub quads: u32,
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

/// A frame would have too many pieces, most of them for this component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLong {
    /// Which.
    pub component: usize,
}

/// Plans a frame of at most `most` pieces. `evaluations` stand beside the components.
///
/// # Errors
/// It would have more: known before any is made, since there may be millions.
pub fn plan(
    flat: &FlatScene,
    camera: &Camera,
    size: [u32; 2],
    evaluations: &[Evaluation],
    pace: &Pace,
    most: usize,
) -> Result<Plan, TooLong> {
    let whole = Rect { origin: [0, 0], end: size };
    let projection = Projection::new(camera, size);
    let seen: Vec<(usize, Rect, Marching)> = front_to_back(flat, camera)
        .into_iter()
        .filter_map(|index| {
            let component = &flat.components[index];
            let rect = Rect::around(component, &projection, size)?;
            Some((index, rect, Marching::of(component, evaluations[index], pace)))
        })
        .collect();
    let pieces = |(_, rect, marching): &(usize, Rect, Marching)| marching.pieces(rect);
    let shading = 0.3 + 0.2 * flat.lights.len() as f64;
    let most_shading = pace.effort_in(DISPATCH_TARGET, false);
    let others = 1 + usize::from(!flat.meshes.is_empty()) + whole.parts(shading, most_shading);
    if seen.iter().map(pieces).fold(others, usize::saturating_add) > most {
        let component = seen.iter().max_by_key(|one| pieces(one)).map_or(0, |one| one.0);
        return Err(TooLong { component });
    }
    let mut plan = Plan::default();
    plan.push(Stage::Mesh, whole.work(0), Effort::default());
    if !flat.meshes.is_empty() {
        plan.push(Stage::Farthest, whole.work(0), Effort::new(false, whole.pixels() * 0.05));
    }
    let mut surfaces = Vec::new();
    for (index, rect, marching) in seen {
        plan.component(index, rect, marching, &mut surfaces);
    }
    // The rays that are left stand behind how many they are; one list after the other uses the same place.
    let rays = plan.lists;
    plan.pieces.iter_mut().for_each(|piece| piece.work.rays = rays);
    surfaces.iter_mut().chain(&mut plan.pieces).for_each(|piece: &mut Piece| piece.work.hits = plan.quads);
    // Normals only of what is still seen when all components are there.
    plan.pieces.append(&mut surfaces);
    whole.cut(shading, most_shading, |rect| {
        plan.push(Stage::Shade, rect.work(0), Effort::new(false, rect.pixels() * shading));
    });
    Ok(plan)
}

/// How the rays through a component are cut into dispatches.
#[derive(Clone, Copy, Debug)]
struct Marching {
    evaluation: Evaluation,
    /// Steps of a ray in one dispatch.
    steps: u32,
    /// Dispatches one after the other, until no ray can be left.
    rounds: u32,
    /// Effort of a pixel, and most in one dispatch.
    per_pixel: f64,
    most: f64,
}

impl Marching {
    fn of(component: &Component, evaluation: Evaluation, pace: &Pace) -> Self {
        let Evaluation { straight, iterations, leaves } = evaluation;
        let (max_steps, at_once) =
            if component.bounds.is_finite() { (MAX_STEPS, MAX_STEPS) } else { (MAX_STEPS_UNBOUNDED, STEPS_UNBOUNDED) };
        let steps = (MAX_ITERATIONS / iterations).clamp(1, at_once);
        let per_pixel = leaves * TRACE_EVALUATIONS;
        let most = pace.effort_in(DISPATCH_TARGET, straight).min(per_pixel * MOST_PIXELS);
        Self { evaluation, steps, rounds: max_steps.div_ceil(steps), per_pixel, most }
    }

    /// How many pieces the component takes whose image is within `rect`: of each part its cones, its rounds, its surface.
    fn pieces(&self, rect: &Rect) -> usize {
        rect.parts(self.per_pixel, self.most) * (self.rounds as usize + 2)
    }
}

impl Plan {
    /// Effort of the whole frame.
    pub fn effort(&self) -> Effort {
        self.pieces.iter().fold(Effort::default(), |sum, piece| sum + piece.effort)
    }

    /// Around the pixels that these components may cover, if any: upper left, and the first outside.
    pub fn around(&self, is_meant: impl Fn(u32) -> bool) -> Option<[UVec2; 2]> {
        let meant = self.pieces.iter().filter(|p| p.stage == Stage::Cone && is_meant(p.work.component));
        let rects = meant.map(|p| [p.work.origin, p.work.end].map(UVec2::from_array));
        rects.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// The pieces that trace the components that are meant once more, by `times` as many steps of each ray, and what comes
    /// after that.
    pub fn again(&self, is_meant: impl Fn(u32) -> bool, times: u32) -> Vec<Piece> {
        let is_meant = |piece: &&Piece| is_meant(piece.work.component);
        let marches = self.pieces.iter().filter(|piece| matches!(piece.stage, Stage::Cone | Stage::Trace));
        let marches: Vec<Piece> = marches.filter(is_meant).copied().collect();
        let mut pieces = Vec::new();
        for of_list in marches.chunk_by(|a, b| a.work.list == b.work.list) {
            let first = of_list.iter().find(|piece| piece.stage == Stage::Trace).expect("cones are followed by rays");
            let rounds = (of_list.len() as u32 - 1) * times;
            pieces.push(of_list[0]);
            pieces.extend((0..rounds).map(|round| {
                let (last_round, packed) = (u32::from(round + 1 == rounds), u32::from(round > 0));
                let work = Work { round, last_round, packed, ..first.work };
                Piece { work, effort: if round == 0 { first.effort } else { Effort::default() }, ..*first }
            }));
        }
        let surfaces = self.pieces.iter().filter(|piece| piece.stage == Stage::Surface).filter(is_meant);
        let shading = self.pieces.iter().filter(|piece| piece.stage == Stage::Shade);
        pieces.extend(surfaces.chain(shading).copied());
        pieces
    }

    fn push(&mut self, stage: Stage, work: Work, effort: Effort) {
        self.pieces.push(Piece { stage, work, effort });
    }

    fn component(&mut self, index: usize, rect: Rect, marching: Marching, surfaces: &mut Vec<Piece>) {
        let Marching { evaluation: Evaluation { straight, leaves, .. }, steps, rounds, per_pixel, most } = marching;
        rect.cut(per_pixel, most, |rect| {
            let list = Work { max_steps: steps, list: self.lists, first_quad: self.quads, ..rect.work(index as u32) };
            let effort = |evaluations: f64| Effort::new(straight, rect.pixels() * leaves * evaluations);
            self.push(Stage::Cone, list, effort(CONE_EVALUATIONS));
            for round in 0..rounds {
                let last_round = u32::from(round + 1 == rounds);
                let work = Work { round, last_round, packed: u32::from(round > 0), ..list };
                // Most rays have ended long before the last round.
                let effort =
                    if round == 0 { effort(TRACE_EVALUATIONS) } else { Effort { dispatches: 0.0, ..effort(0.1) } };
                self.push(Stage::Trace, work, effort);
            }
            surfaces.push(Piece { stage: Stage::Surface, work: list, effort: effort(SURFACE_EVALUATIONS) });
            self.lists += 1;
            self.quads += rect.tiles() * QUADS * QUADS;
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
    /// What is nearer along the view axis has no place in the picture; in a corner the near limit is less along the axis.
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
            near: (camera.near * 0.5 * camera.corner_cosine(size)).max(1e-12),
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

    /// Width and height of the parts, of at most `most` effort, or of one tile.
    fn part(&self, per_pixel: f64, most: f64) -> [u32; 2] {
        let pixels = (most / per_pixel.max(1e-9)).max(f64::from(TILE * TILE));
        let width = self.end[0] - self.origin[0];
        let rows = ((pixels / f64::from(width)).min(1e9) as u32 / TILE * TILE).max(TILE);
        let columns = if f64::from(width * TILE) > pixels {
            ((pixels / f64::from(TILE)) as u32 / TILE * TILE).max(TILE)
        } else {
            width
        };
        [columns, rows]
    }

    /// How many parts there are.
    fn parts(&self, per_pixel: f64, most: f64) -> usize {
        let part = self.part(per_pixel, most);
        [0, 1].map(|i| (self.end[i] - self.origin[i]).div_ceil(part[i]) as usize).iter().product()
    }

    /// Cuts into parts, see [`Rect::part`].
    fn cut(&self, per_pixel: f64, most: f64, mut each: impl FnMut(Self)) {
        let [columns, rows] = self.part(per_pixel, most);
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
            let mut parts = 0;
            rect.cut(per_pixel, most, |r| {
                parts += 1;
                let limit = most.max(per_pixel * f64::from(TILE * TILE));
                assert!(r.pixels() * per_pixel <= limit, "{r:?}");
                for y in r.origin[1]..r.end[1] {
                    for x in r.origin[0]..r.end[0] {
                        covered[(y * 301 + x) as usize] += 1;
                    }
                }
            });
            assert_eq!(rect.parts(per_pixel, most), parts);
            for y in 0..177 {
                for x in 0..301 {
                    let inside = x >= 16 && y >= 8;
                    assert_eq!(covered[y * 301 + x], i32::from(inside));
                }
            }
        }
    }

    #[test]
    fn what_is_traced_again_has_more_rounds_of_the_components_that_are_meant() {
        let flat = crate::flat::flatten(&crate::gallery::random(32, 1), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let slow = Evaluation { straight: false, iterations: MAX_ITERATIONS / 2, leaves: 8.0 };
        let evaluations = vec![slow; flat.components.len()];
        let plan = plan(&flat, &camera, [64, 64], &evaluations, &Pace::new(true), usize::MAX).expect("room for all");
        let of = |pieces: &[Piece], stage: Stage| pieces.iter().filter(|piece| piece.stage == stage).count();
        let again = plan.again(|component| component == 2, 8);
        let meant: Vec<Piece> = plan.pieces.iter().filter(|piece| piece.work.component == 2).copied().collect();
        assert!(again.iter().all(|piece| piece.work.component == 2 || piece.stage == Stage::Shade));
        assert_eq!(of(&again, Stage::Shade), of(&plan.pieces, Stage::Shade));
        assert_eq!(of(&again, Stage::Surface), of(&meant, Stage::Surface));
        assert_eq!(of(&again, Stage::Cone), of(&meant, Stage::Cone));
        assert_eq!(of(&again, Stage::Trace), 8 * of(&meant, Stage::Trace));
        let mut last = again.iter().filter(|piece| piece.stage == Stage::Trace && piece.work.last_round == 1);
        let rounds = meant.iter().map(|piece| piece.work.round + 1).max().expect("it is seen");
        assert!(rounds > 1_000 && last.all(|piece| piece.work.round + 1 == 8 * rounds));
        assert!(again.iter().all(|piece| (piece.work.packed == 1) == (piece.work.round > 0)));
        assert!(plan.again(|_| false, 8).iter().all(|piece| piece.stage == Stage::Shade));
    }

    #[test]
    fn more_pieces_than_there_is_room_for_are_refused_with_the_component() {
        let flat = crate::flat::flatten(&crate::gallery::random(32, 1), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let cheap = Evaluation { straight: true, iterations: 10, leaves: 8.0 };
        // Of the third one few steps fit in a dispatch.
        let mut evaluations = vec![cheap; flat.components.len()];
        evaluations[2].iterations = MAX_ITERATIONS / 4;
        let planned = |most| plan(&flat, &camera, [640, 480], &evaluations, &Pace::new(true), most);
        let count = planned(usize::MAX).expect("room for all").pieces.len();
        assert!(count > 1_000, "{count}");
        assert_eq!(planned(count).expect("just enough room").pieces.len(), count);
        assert_eq!(planned(count - 1).expect_err("too many"), TooLong { component: 2 });
    }
}
