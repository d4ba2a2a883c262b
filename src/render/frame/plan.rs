//! Cuts a frame into short dispatches.
//!
//! No dispatch may run long: the renderer cannot interrupt it, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use bytemuck::Zeroable as _;
use glam::{DVec2, DVec3, UVec2};

use crate::frame::copies_cost::{COPIES_OF_A_RAY, CopyLimits, LEAST_RELAUNCHES, walk_leaves};
use crate::frame::cost_model::{Cost, CostModel};
use crate::frame::light_tiles::PixelLight;
use crate::recipe::{Extent, Pass};
use crate::renderer::evaluation::EvaluationCost;
use crate::resources::uniforms::DispatchParams;
use isolith_field::{Component, FlatScene};
use isolith_geometry::{Camera, SampleView};

/// Side of a tile, in pixels: the area that a cone starts with.
pub const TILE: u32 = 8;
/// Subtiles along a side of a tile: the areas that cones are narrowed down to.
pub const SUBTILES: u32 = 2;
/// Expected time of one dispatch. Measured times scatter by a factor of two or three around it, so nearly all stay
/// below 50 ms.
pub const DISPATCH_TARGET: Duration = Duration::from_millis(16);
/// Limit of loop iterations of one invocation, with a margin below lavapipe's 65 535.
pub const MAX_ITERATIONS: u32 = 60_000;
/// Step limit of a ray through a component with bounds.
pub const MAX_STEPS: u32 = 4_096;
/// Step limit of a ray through a component without bounds, toward the horizon.
pub const MAX_STEPS_UNBOUNDED: u32 = 16_384;

/// Factors of the step limit for rays that have not ended: such rays are traced again with 8 times as many steps, then
/// with 64 times as many, before the renderer gives them up. Along the face of a box 1 km long a ray takes 80 000 small
/// steps.
pub const LONGER: [u32; 2] = [8, 64];

/// Pixel limit of one dispatch of a component, and so of the rays that it leaves unfinished.
const MOST_PIXELS: f64 = 1048576.0;
/// Steps of a ray in one dispatch over a component without bounds. Toward the horizon a ray may need thousands, which
/// took two seconds in a single dispatch.
pub const STEPS_UNBOUNDED: u32 = 512;

/// Most pixels of a part of the pass `shadow`: their states take 12 MiB.
pub const MOST_SHADOW_PIXELS: f64 = 262_144.0;

/// A dispatch of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dispatch {
    /// The pass that it belongs to.
    pub pass: Pass,
    /// Its parameters.
    pub params: DispatchParams,
    /// Expected cost.
    pub cost: Cost,
}

impl Dispatch {
    /// Number of tiles along x and y.
    pub fn tiles(&self) -> [u32; 2] {
        [0, 1].map(|i| (self.params.end[i] - self.params.origin[i]).div_ceil(TILE))
    }
}

/// All dispatches of a frame.
#[derive(Clone, Debug, Default)]
pub struct FramePlan {
    /// The dispatches, in order.
    pub dispatches: Vec<Dispatch>,
    /// Number of subtile lists that the cone passes write.
    pub lists: u32,
    /// Upper bound of the subtiles in all lists together.
    pub subtiles: u32,
    /// Upper bound of the tiles in the longest list.
    pub longest: u32,
}

/// Expected evaluations of a component per pixel of its silhouette, measured on the shipped scenes.
const CONE_EVALUATIONS: f64 = 0.2;
const TRACE_EVALUATIONS: f64 = 4.0;
const SURFACE_EVALUATIONS: f64 = 3.0;

/// Capacity of a device for one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    /// Dispatches.
    pub dispatches: usize,
    /// Subtiles in the lists of all components together.
    pub subtiles: u64,
}

impl Room {
    /// No limit.
    pub const UNLIMITED: Self = Self { dispatches: usize::MAX, subtiles: u64::MAX };
}

/// A frame exceeds the capacity of the device, mostly because of this component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TooMuch {
    /// Too many dispatches.
    Pieces {
        /// The component.
        component: usize,
    },
    /// The lists would hold too many subtiles.
    Subtiles {
        /// The component.
        component: usize,
        /// Number of subtiles that the lists would hold.
        subtiles: u64,
    },
}

/// Plans a frame that fits the device. `evaluations` is parallel to the components; `light` is the work
/// for the light of a pixel.
///
/// # Errors
/// The frame would exceed `room`. The check precedes the first dispatch, since there may be millions.
pub fn plan(
    flat: &FlatScene,
    view: &SampleView,
    size: [u32; 2],
    evaluations: &[EvaluationCost],
    light: PixelLight,
    cost_model: &CostModel,
    room: Room,
) -> Result<FramePlan, TooMuch> {
    let whole = Rect { origin: [0, 0], end: size };
    let camera = &view.camera;
    let projection = ScreenProjection::new(view, size);
    let seen: Vec<(usize, Rect, Marching)> = front_to_back(flat, camera)
        .into_iter()
        .filter_map(|index| {
            let component = &flat.components[index];
            let rect = Rect::around(component, &projection, size)?;
            Some((index, rect, Marching::of(flat, component, evaluations[index], cost_model)))
        })
        .collect();
    let dispatches = |(_, rect, marching): &(usize, Rect, Marching)| marching.dispatches(rect);
    let PixelLight { tiled, shadows, .. } = light;
    let shading = light.of_shading();
    let most_shading = cost_model.cost_in(DISPATCH_TARGET, false);
    let most_shadows = most_shading.min(shadows * MOST_SHADOW_PIXELS);
    let shadow_parts = if shadows > 0.0 { 2 * whole.parts(shadows, most_shadows) } else { 0 };
    let single = 1 + [!flat.meshes.is_empty(), tiled].map(usize::from).iter().sum::<usize>();
    let others = single + whole.parts(shading, most_shading) + shadow_parts;
    if seen.iter().map(dispatches).fold(others, usize::saturating_add) > room.dispatches {
        let component = seen.iter().max_by_key(|one| dispatches(one)).map_or(0, |one| one.0);
        return Err(TooMuch::Pieces { component });
    }
    let subtiles = |one: &(usize, Rect, Marching)| u64::from(one.1.tiles() * SUBTILES * SUBTILES);
    let all: u64 = seen.iter().map(subtiles).sum();
    if all > room.subtiles {
        let component = seen.iter().max_by_key(|one| subtiles(one)).map_or(0, |one| one.0);
        return Err(TooMuch::Subtiles { component, subtiles: all });
    }
    let mut plan = FramePlan::default();
    let parts: Vec<Part> =
        seen.into_iter().flat_map(|(index, rect, marching)| plan.parts(index, rect, marching)).collect();
    // Passes over parts take turns: each part runs through all of them before the next part starts.
    for stages in Pass::ALL.chunk_by(|a, b| a.extent().is_of_parts() && b.extent().is_of_parts()) {
        match stages[0].extent() {
            Extent::Picture => plan.push(stages[0], whole.params(0), Cost::default()),
            Extent::Meshes if flat.meshes.is_empty() => {}
            Extent::Meshes => plan.push(stages[0], whole.params(0), Cost::new(false, whole.pixels() * 0.05)),
            Extent::Parts | Extent::Rounds | Extent::Hits => {
                parts.iter().for_each(|part| stages.iter().for_each(|pass| plan.part(*pass, part)));
            }
            Extent::Lit if !tiled => {}
            Extent::Lit => plan.push(stages[0], whole.params(0), Cost::new(false, whole.pixels() * light.of_tiles())),
            Extent::Shaded if shadows == 0.0 => {}
            Extent::Shaded => whole.cut(shadows, most_shadows, |rect| {
                for relaunch in [0, 1] {
                    let params = DispatchParams { relaunch, ..rect.params(0) };
                    // Few cones are left for the second one.
                    let share = if relaunch == 0 { 1.0 } else { 0.05 };
                    plan.push(stages[0], params, Cost::new(false, rect.pixels() * shadows * share));
                }
            }),
            Extent::Light => whole.cut(shading, most_shading, |rect| {
                plan.push(stages[0], rect.params(0), Cost::new(false, rect.pixels() * shading));
            }),
            // No dispatches of its own: the pass is recorded with the last dispatch of the frame.
            Extent::Finished => {}
        }
    }
    Ok(plan)
}

/// A part of a component's image, with its own list of subtiles.
#[derive(Clone, Copy, Debug)]
struct Part {
    rect: Rect,
    marching: Marching,
    /// Parameters that its dispatches share.
    params: DispatchParams,
}

/// How the march through a component is split into dispatches.
#[derive(Clone, Copy, Debug)]
struct Marching {
    evaluation: EvaluationCost,
    /// Steps of a ray in one dispatch.
    steps: u32,
    /// Number of successive dispatches after which no ray can be left.
    relaunches: u32,
    /// Cells of an instancer that a ray looks at in one dispatch.
    cells: u32,
    /// Cost of a pixel, and cost limit of one dispatch.
    per_pixel: f64,
    most: f64,
}

impl Marching {
    fn of(flat: &FlatScene, component: &Component, evaluation: EvaluationCost, cost_model: &CostModel) -> Self {
        let instancer = component.instanced.map(|of| &flat.instancers[of.instancer as usize]);
        let EvaluationCost { straight, iterations, leaves } = evaluation;
        let (max_steps, at_once) = if component.world_bounds().is_finite() {
            (MAX_STEPS, MAX_STEPS)
        } else {
            (MAX_STEPS_UNBOUNDED, STEPS_UNBOUNDED)
        };
        let limits = instancer.map(|of| CopyLimits::of(of, MAX_ITERATIONS));
        let steps = (limits.map_or(MAX_ITERATIONS, |of| of.iterations) / iterations).clamp(1, at_once);
        let walk = instancer.map_or(0.0, walk_leaves);
        let per_pixel = leaves * TRACE_EVALUATIONS * instancer.map_or(1.0, |_| COPIES_OF_A_RAY) + walk;
        let (cells, least) = limits.map_or((0, 1), |of| (of.cells, LEAST_RELAUNCHES));
        let most = cost_model.cost_in(DISPATCH_TARGET, straight).min(per_pixel * MOST_PIXELS);
        Self { evaluation, steps, relaunches: max_steps.div_ceil(steps).max(least), cells, per_pixel, most }
    }

    /// Number of dispatches of a component whose image lies within `rect`: for each part its cones, relaunches and
    /// surface.
    fn dispatches(&self, rect: &Rect) -> usize {
        rect.parts(self.per_pixel, self.most) * (self.relaunches as usize + 2)
    }
}

impl FramePlan {
    /// Cost of the whole frame.
    pub fn cost(&self) -> Cost {
        self.dispatches.iter().fold(Cost::default(), |sum, dispatch| sum + dispatch.cost)
    }

    /// Bounding rectangle of the pixels that these components may cover, if any: upper left pixel, first pixel outside.
    pub fn around(&self, is_meant: impl Fn(u32) -> bool) -> Option<[UVec2; 2]> {
        let meant = self.dispatches.iter().filter(|p| p.pass == Pass::Cone && is_meant(p.params.component));
        let rects = meant.map(|p| [p.params.origin, p.params.end].map(UVec2::from_array));
        rects.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// The dispatches that trace the selected components again, with `times` as many steps of each ray, and the surface
    /// and shade dispatches that follow.
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
        let shading = self.dispatches.iter().filter(|dispatch| dispatch.pass.is_of_light());
        dispatches.extend(surfaces.chain(shading).copied());
        dispatches
    }

    fn push(&mut self, pass: Pass, params: DispatchParams, cost: Cost) {
        self.dispatches.push(Dispatch { pass, params, cost });
    }

    /// The parts of a component's image within `rect`. Reserves space for their lists.
    fn parts(&mut self, index: usize, rect: Rect, marching: Marching) -> Vec<Part> {
        let mut parts = Vec::new();
        rect.cut(marching.per_pixel, marching.most, |rect| {
            let place = DispatchParams { list: self.lists, first_subtile: self.subtiles, ..rect.params(index as u32) };
            parts.push(Part {
                rect,
                marching,
                params: DispatchParams { max_steps: marching.steps, max_cells: marching.cells, ..place },
            });
            self.lists += 1;
            self.subtiles += rect.tiles() * SUBTILES * SUBTILES;
            self.longest = self.longest.max(rect.tiles());
        });
        parts
    }

    /// Adds the dispatches of a pass over a part.
    fn part(&mut self, pass: Pass, part: &Part) {
        let Marching { evaluation: EvaluationCost { straight, .. }, relaunches, per_pixel, .. } = part.marching;
        let leaves = per_pixel / TRACE_EVALUATIONS;
        let cost = |evaluations: f64| Cost::new(straight, part.rect.pixels() * leaves * evaluations);
        // The unfinished rays follow their count in the buffer; successive lists reuse the same place. Subtiles with
        // hits follow all other subtiles.
        let params = DispatchParams { rays: self.lists, hits: self.subtiles, ..part.params };
        if pass.extent() != Extent::Rounds {
            let evaluations = if pass.extent() == Extent::Hits { SURFACE_EVALUATIONS } else { CONE_EVALUATIONS };
            return self.push(pass, params, cost(evaluations));
        }
        for relaunch in 0..relaunches {
            let params = DispatchParams {
                relaunch,
                last_relaunch: u32::from(relaunch + 1 == relaunches),
                compacted: u32::from(relaunch > 0),
                ..params
            };
            // Most rays end long before the last relaunch.
            let later = Cost { dispatches: 0.0, ..cost(0.1) };
            self.push(pass, params, if relaunch == 0 { cost(TRACE_EVALUATIONS) } else { later });
        }
    }
}

/// Components ordered by their nearest points, so that hidden components come last.
fn front_to_back(flat: &FlatScene, camera: &Camera) -> Vec<usize> {
    let distance = |i: usize| {
        let c = &flat.components[i];
        c.world_bounds().distance(camera.position)
    };
    let mut order: Vec<(f64, usize)> = (0..flat.components.len()).map(|i| (distance(i), i)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, i)| i).collect()
}

/// Projection from the world to pixels.
struct ScreenProjection {
    eye: DVec3,
    forward: DVec3,
    /// Pixels to the right per meter at depth 1.
    right: DVec3,
    /// Pixels downward per meter at depth 1.
    down: DVec3,
    /// Center of the picture.
    center: DVec2,
    /// Depth along the view axis below which points are not visible. In a corner, the near limit along the ray is less
    /// along the axis.
    near: f64,
}

impl ScreenProjection {
    fn new(SampleView { camera, offset }: &SampleView, size: [u32; 2]) -> Self {
        let half = DVec2::new(f64::from(size[0]), f64::from(size[1])) * 0.5;
        let scale = half.y / camera.tan_half_fov();
        // A moved picture reaches farther from the view axis.
        let corner = (half + offset.abs()) / scale;
        Self {
            eye: camera.position,
            forward: camera.rotation * DVec3::NEG_Z,
            right: camera.rotation * DVec3::X * scale,
            down: camera.rotation * DVec3::NEG_Y * scale,
            center: half - *offset,
            near: (camera.near * 0.5 / (1.0 + corner.length_squared()).sqrt()).max(1e-12),
        }
    }
}

/// Margin around the image of a component, in pixels: half a pixel from a pixel's corner to its center, half for the
/// jitter of samples, and a sixteenth for rounding.
const MARGIN: f64 = 1.0625;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Rect {
    origin: [u32; 2],
    end: [u32; 2],
}

impl Rect {
    /// The pixels that the component's bounds may cover; `None` if it is out of view.
    fn around(component: &Component, projection: &ScreenProjection, size: [u32; 2]) -> Option<Self> {
        let whole = Self { origin: [0, 0], end: size };
        let bounds = component.world_bounds();
        if !bounds.is_finite() {
            return Some(whole);
        }
        let pixels = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut behind = 0;
        for corner in bounds.translated(-projection.eye).corners() {
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
            // A part of it lies beside or behind the eye, so its projection has no simple outline.
            _ => return Some(whole),
        }
        let low = (low - MARGIN).floor().max(DVec2::ZERO);
        let high = (high + MARGIN).ceil().min(pixels);
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

    /// Width and height of parts that cost at most `most`, but no less than one tile.
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

    /// Number of parts.
    fn parts(&self, per_pixel: f64, most: f64) -> usize {
        let part = self.part(per_pixel, most);
        [0, 1].map(|i| (self.end[i] - self.origin[i]).div_ceil(part[i]) as usize).iter().product()
    }

    /// Cuts the rectangle into parts, see [`Rect::part`].
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
