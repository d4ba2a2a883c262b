//! Cuts a frame into dispatches that are short enough to be waited for.
//!
//! No dispatch may run long: it cannot be interrupted, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use bytemuck::Zeroable as _;
use glam::{DVec2, DVec3, UVec2};

use crate::flat::{CellTree, Component, FlatScene};
use crate::geometry::Camera;
use crate::render::frame::cost_model::{Cost, CostModel};
use crate::render::resources::uniforms::DispatchParams;

/// Pixels along a side of a tile: what a cone begins with.
pub const TILE: u32 = 8;
/// Subtiles along a side of a tile: what cones are narrowed down to.
pub const SUBTILES: u32 = 2;
/// A dispatch is cut so that it is expected to take about this long; measured times scatter by a factor
/// of two or three around that, so nearly all stay below 50 ms.
pub const DISPATCH_TARGET: Duration = Duration::from_millis(16);
/// Loop iterations that one invocation may do, with room below lavapipe's 65 535.
pub const MAX_ITERATIONS: u32 = 60_000;
/// Most steps of a ray through a component with bounds.
pub const MAX_STEPS: u32 = 4_096;
/// Most steps of a ray through a component without bounds, toward the horizon.
pub const MAX_STEPS_UNBOUNDED: u32 = 16_384;

/// Where rays have not ended by then, they are traced again with so many times as many steps, and again, before they are given
/// up. Along the face of a box 1 km long a ray creeps in 80 000 steps.
pub const LONGER: [u32; 2] = [8, 64];

/// Most pixels of one dispatch of a component: as many rays may be left.
const MOST_PIXELS: f64 = 1048576.0;
/// Steps of a ray in one dispatch over a component without bounds: toward the horizon thousands may be
/// needed, which in one dispatch took two seconds.
pub const STEPS_UNBOUNDED: u32 = 512;

/// Which pass a dispatch belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Clear the targets and draw the meshes.
    Mesh,
    /// The farthest depth of each subtile after the meshes.
    Hiz,
    /// Find the subtiles that a component touches.
    Cone,
    /// March one component within these subtiles.
    Trace,
    /// Normals and materials of its hits.
    Surface,
    /// Light.
    Shade,
}

/// One dispatch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispatch {
    /// Its pass.
    pub pass: Pass,
    /// What it does.
    pub params: DispatchParams,
    /// Expected cost.
    pub cost: Cost,
}

impl Dispatch {
    /// Tiles along x and y.
    pub fn tiles(&self) -> [u32; 2] {
        [0, 1].map(|i| (self.params.end[i] - self.params.origin[i]).div_ceil(TILE))
    }
}

/// Loop iterations for each copy of an entry, about: a modifier's own loops (layers of noise, steps of a recursion).
const LOOPS_OF_COPIES: u32 = 2;

impl EvaluationCost {
    /// Of a component that is walked through, entry by entry, by code that holds `loops` besides; `loop_trips` is
    /// how many its own leaves take.
    pub fn of_entries(component: &Component, loops: u32, loop_trips: u32) -> Self {
        // For each entry an iteration, one for the choice of its shape, one for a group that ends. Of copies most are
        // out of reach.
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: false,
            iterations: ((4 + loops) * component.count + loop_trips + 2).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of straight-line code for a component: loops are only in modifiers, at most one for each entry, and in leaves;
    /// `loop_trips` as in [`EvaluationCost::of_entries`].
    pub fn of_straight_line(component: &Component, loop_trips: u32) -> Self {
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: true,
            iterations: (2 + component.count + loop_trips).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of a component with tapes.
    pub fn of_tapes(component: &Component, tree: &CellTree, loops: u32, loop_trips: u32) -> Self {
        // Two iterations find the cell.
        Self {
            straight: false,
            iterations: (4 + loops) * tree.longest() + loop_trips + 8,
            leaves: tree.mean_length() * leaves(component, loop_trips) / f64::from(component.count) + 2.0,
        }
    }
}

/// Entries of a component, the loops of its leaves counted in: a loop trip takes a part of what a leaf takes, and most loops
/// end early.
fn leaves(component: &Component, loop_trips: u32) -> f64 {
    f64::from(component.count) + f64::from(loop_trips) * LOOP_TRIP
}

/// Leaves that a loop trip counts as. With 0 single batches took 0.55 s in `fractals`, now 0.16; its stills take a tenth longer,
/// with 1 those of `drawn` took a third longer.
const LOOP_TRIP: f64 = 0.25;

/// All dispatches of a frame.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// In order.
    pub dispatches: Vec<Dispatch>,
    /// Lists of subtiles that the cone passes write.
    pub lists: u32,
    /// Subtiles in all lists together, if none is dropped.
    pub subtiles: u32,
    /// Tiles in the longest list, if none is dropped.
    pub longest: u32,
}

/// Expected evaluations of a component per pixel of its outline: measured on the shipped scenes.
const CONE_EVALUATIONS: f64 = 0.2;
const TRACE_EVALUATIONS: f64 = 4.0;
const SURFACE_EVALUATIONS: f64 = 3.0;

/// What evaluating a component means for its pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvaluationCost {
    /// Whether the pipeline is straight-line code.
    pub straight: bool,
    /// Most loop iterations of one evaluation.
    pub iterations: u32,
    /// Leaves that one evaluation visits, about.
    pub leaves: f64,
}

/// A frame would have too many dispatches, most of them for this component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLong {
    /// Which.
    pub component: usize,
}

/// Plans a frame of at most `most` dispatches. `evaluations` stand beside the components.
///
/// # Errors
/// It would have more: known before any is made, since there may be millions.
pub fn plan(
    flat: &FlatScene,
    camera: &Camera,
    size: [u32; 2],
    evaluations: &[EvaluationCost],
    cost_model: &CostModel,
    most: usize,
) -> Result<FramePlan, TooLong> {
    let whole = Rect { origin: [0, 0], end: size };
    let projection = ScreenProjection::new(camera, size);
    let seen: Vec<(usize, Rect, Marching)> = front_to_back(flat, camera)
        .into_iter()
        .filter_map(|index| {
            let component = &flat.components[index];
            let rect = Rect::around(component, &projection, size)?;
            Some((index, rect, Marching::of(component, evaluations[index], cost_model)))
        })
        .collect();
    let dispatches = |(_, rect, marching): &(usize, Rect, Marching)| marching.dispatches(rect);
    let shading = 0.3 + 0.2 * flat.lights.len() as f64;
    let most_shading = cost_model.cost_in(DISPATCH_TARGET, false);
    let others = 1 + usize::from(!flat.meshes.is_empty()) + whole.parts(shading, most_shading);
    if seen.iter().map(dispatches).fold(others, usize::saturating_add) > most {
        let component = seen.iter().max_by_key(|one| dispatches(one)).map_or(0, |one| one.0);
        return Err(TooLong { component });
    }
    let mut plan = FramePlan::default();
    plan.push(Pass::Mesh, whole.params(0), Cost::default());
    if !flat.meshes.is_empty() {
        plan.push(Pass::Hiz, whole.params(0), Cost::new(false, whole.pixels() * 0.05));
    }
    let mut surfaces = Vec::new();
    for (index, rect, marching) in seen {
        plan.component(index, rect, marching, &mut surfaces);
    }
    // The rays that are left stand behind how many they are; one list after the other uses the same place.
    let rays = plan.lists;
    plan.dispatches.iter_mut().for_each(|dispatch| dispatch.params.rays = rays);
    surfaces
        .iter_mut()
        .chain(&mut plan.dispatches)
        .for_each(|dispatch: &mut Dispatch| dispatch.params.hits = plan.subtiles);
    // Normals only of what is still seen when all components are there.
    plan.dispatches.append(&mut surfaces);
    whole.cut(shading, most_shading, |rect| {
        plan.push(Pass::Shade, rect.params(0), Cost::new(false, rect.pixels() * shading));
    });
    Ok(plan)
}

/// How the rays through a component are cut into dispatches.
#[derive(Clone, Copy, Debug)]
struct Marching {
    evaluation: EvaluationCost,
    /// Steps of a ray in one dispatch.
    steps: u32,
    /// Dispatches one after the other, until no ray can be left.
    relaunches: u32,
    /// Cost of a pixel, and most in one dispatch.
    per_pixel: f64,
    most: f64,
}

impl Marching {
    fn of(component: &Component, evaluation: EvaluationCost, cost_model: &CostModel) -> Self {
        let EvaluationCost { straight, iterations, leaves } = evaluation;
        let (max_steps, at_once) =
            if component.bounds.is_finite() { (MAX_STEPS, MAX_STEPS) } else { (MAX_STEPS_UNBOUNDED, STEPS_UNBOUNDED) };
        let steps = (MAX_ITERATIONS / iterations).clamp(1, at_once);
        let per_pixel = leaves * TRACE_EVALUATIONS;
        let most = cost_model.cost_in(DISPATCH_TARGET, straight).min(per_pixel * MOST_PIXELS);
        Self { evaluation, steps, relaunches: max_steps.div_ceil(steps), per_pixel, most }
    }

    /// How many dispatches the component takes whose image is within `rect`: of each part its cones, its relaunches, its surface.
    fn dispatches(&self, rect: &Rect) -> usize {
        rect.parts(self.per_pixel, self.most) * (self.relaunches as usize + 2)
    }
}

impl FramePlan {
    /// Cost of the whole frame.
    pub fn cost(&self) -> Cost {
        self.dispatches.iter().fold(Cost::default(), |sum, dispatch| sum + dispatch.cost)
    }

    /// Around the pixels that these components may cover, if any: upper left, and the first outside.
    pub fn around(&self, is_meant: impl Fn(u32) -> bool) -> Option<[UVec2; 2]> {
        let meant = self.dispatches.iter().filter(|p| p.pass == Pass::Cone && is_meant(p.params.component));
        let rects = meant.map(|p| [p.params.origin, p.params.end].map(UVec2::from_array));
        rects.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// The dispatches that trace the components that are meant once more, by `times` as many steps of each ray, and what comes
    /// after that.
    pub fn again(&self, is_meant: impl Fn(u32) -> bool, times: u32) -> Vec<Dispatch> {
        let is_meant = |dispatch: &&Dispatch| is_meant(dispatch.params.component);
        let marches = self.dispatches.iter().filter(|dispatch| matches!(dispatch.pass, Pass::Cone | Pass::Trace));
        let marches: Vec<Dispatch> = marches.filter(is_meant).copied().collect();
        let mut dispatches = Vec::new();
        for of_list in marches.chunk_by(|a, b| a.params.list == b.params.list) {
            let first =
                of_list.iter().find(|dispatch| dispatch.pass == Pass::Trace).expect("cones are followed by rays");
            let relaunches = (of_list.len() as u32 - 1) * times;
            dispatches.push(of_list[0]);
            dispatches.extend((0..relaunches).map(|relaunch| {
                let (last_relaunch, compacted) = (u32::from(relaunch + 1 == relaunches), u32::from(relaunch > 0));
                let params = DispatchParams { relaunch, last_relaunch, compacted, ..first.params };
                Dispatch { params, cost: if relaunch == 0 { first.cost } else { Cost::default() }, ..*first }
            }));
        }
        let surfaces = self.dispatches.iter().filter(|dispatch| dispatch.pass == Pass::Surface).filter(is_meant);
        let shading = self.dispatches.iter().filter(|dispatch| dispatch.pass == Pass::Shade);
        dispatches.extend(surfaces.chain(shading).copied());
        dispatches
    }

    fn push(&mut self, pass: Pass, params: DispatchParams, cost: Cost) {
        self.dispatches.push(Dispatch { pass, params, cost });
    }

    fn component(&mut self, index: usize, rect: Rect, marching: Marching, surfaces: &mut Vec<Dispatch>) {
        let Marching { evaluation: EvaluationCost { straight, leaves, .. }, steps, relaunches, per_pixel, most } =
            marching;
        rect.cut(per_pixel, most, |rect| {
            let list = DispatchParams {
                max_steps: steps,
                list: self.lists,
                first_subtile: self.subtiles,
                ..rect.params(index as u32)
            };
            let cost = |evaluations: f64| Cost::new(straight, rect.pixels() * leaves * evaluations);
            self.push(Pass::Cone, list, cost(CONE_EVALUATIONS));
            for relaunch in 0..relaunches {
                let last_relaunch = u32::from(relaunch + 1 == relaunches);
                let params = DispatchParams { relaunch, last_relaunch, compacted: u32::from(relaunch > 0), ..list };
                // Most rays have ended long before the last relaunch.
                let cost = if relaunch == 0 { cost(TRACE_EVALUATIONS) } else { Cost { dispatches: 0.0, ..cost(0.1) } };
                self.push(Pass::Trace, params, cost);
            }
            surfaces.push(Dispatch { pass: Pass::Surface, params: list, cost: cost(SURFACE_EVALUATIONS) });
            self.lists += 1;
            self.subtiles += rect.tiles() * SUBTILES * SUBTILES;
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
struct ScreenProjection {
    eye: DVec3,
    forward: DVec3,
    /// Pixels to the right per length at depth 1.
    right: DVec3,
    /// Pixels downward per length at depth 1.
    down: DVec3,
    /// The middle of the picture.
    center: DVec2,
    /// What is nearer along the view axis has no place in the picture; in a corner the near limit is less along the axis.
    near: f64,
}

impl ScreenProjection {
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
    fn around(component: &Component, projection: &ScreenProjection, size: [u32; 2]) -> Option<Self> {
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

    fn params(&self, component: u32) -> DispatchParams {
        DispatchParams { origin: self.origin, end: self.end, component, ..DispatchParams::zeroed() }
    }

    /// Width and height of the parts, of at most `most` cost, or of one tile.
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
mod tests;
