//! Cuts a frame into short dispatches.
//!
//! No dispatch may run long: the renderer cannot interrupt it, and some systems reset a device that is busy for
//! seconds. No invocation may loop too often: lavapipe ends every loop after 65 535 iterations.

use std::time::Duration;

use bytemuck::Zeroable as _;
use glam::UVec2;

use crate::frame::copies_cost::{COPIES_OF_A_RAY, CopyLimits, LEAST_RELAUNCHES, walk_leaves};
use crate::frame::cost_model::{Cost, CostModel};
use crate::frame::light_tiles::PixelLight;
use crate::frame::rect::{Rect, ScreenProjection, TILE};
use crate::recipe::{Extent, Pass};
use crate::renderer::evaluation::EvaluationCost;
use crate::resources::uniforms::DispatchParams;
use isolith_field::{Component, FlatScene};
use isolith_geometry::SampleView;
use isolith_scene::MarchResolution;

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
/// What a pixel costs that takes its depth from its neighbors, and the share of those between rays that get rays as well.
const RESOLUTION_EVALUATIONS: f64 = 0.5;
const RESOLUTION_EDGES: f64 = 0.3;

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

/// What a frame shows of a scene.
#[derive(Clone, Copy, Debug)]
pub struct PlannedView<'a> {
    /// The camera, moved for a sample.
    pub view: &'a SampleView,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What is traced.
    pub traced: TracedParts,
}

/// What is traced of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracedParts {
    /// Number of passes over components after which tracing ends, see [`FlatScene::component_passes`]; `None` for all.
    pub passes: Option<u32>,
    /// Whether settings of components cut them off by their distance from the eye.
    pub has_cut_offs: bool,
}

impl Default for TracedParts {
    fn default() -> Self {
        Self { passes: None, has_cut_offs: true }
    }
}

/// Plans a frame that fits the device. `evaluations` is parallel to the components; `light` is the work
/// for the light of a pixel.
///
/// # Errors
/// The frame would exceed `room`. The check precedes the first dispatch, since there may be millions.
pub fn plan(
    flat: &FlatScene,
    shown: PlannedView<'_>,
    evaluations: &[EvaluationCost],
    light: PixelLight,
    cost_model: &CostModel,
    room: Room,
) -> Result<FramePlan, TooMuch> {
    let PlannedView { view, size, .. } = shown;
    let whole = Rect { origin: [0, 0], end: size };
    let (projection, spacings) = (ScreenProjection::new(view, size), spacings(flat));
    let seen: Vec<(usize, Rect, Marching)> = traced(flat, shown)
        .into_iter()
        .filter_map(|index| {
            let component = &flat.components[index];
            let rect = Rect::around(component, &projection, size)?;
            let marching = Marching::of(flat, component, shown, evaluations[index], cost_model);
            Some((index, rect, marching.spaced(spacings.get(index).copied().unwrap_or(1))))
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
            Extent::Parts | Extent::Thinned | Extent::Rounds | Extent::Hits => {
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
    /// Number of successive dispatches after which no ray can be left.
    relaunches: u32,
    /// Cost of a pixel, and cost limit of one dispatch.
    per_pixel: f64,
    most: f64,
    /// Limits and precision, for all of its dispatches.
    params: DispatchParams,
}

impl Marching {
    fn of(
        flat: &FlatScene,
        component: &Component,
        shown: PlannedView<'_>,
        evaluation: EvaluationCost,
        cost_model: &CostModel,
    ) -> Self {
        let instancer = component.instanced.map(|of| &flat.instancers[of.instancer as usize]);
        let EvaluationCost { straight, iterations, leaves } = evaluation;
        let (max_steps, at_once) = if component.world_bounds().is_finite() {
            (MAX_STEPS, MAX_STEPS)
        } else {
            (MAX_STEPS_UNBOUNDED, STEPS_UNBOUNDED)
        };
        let limits = instancer.map(|of| CopyLimits::of(of, MAX_ITERATIONS));
        let (params, max_steps) = settings_of(component, shown, max_steps);
        let steps = (limits.map_or(MAX_ITERATIONS, |of| of.iterations) / iterations).clamp(1, at_once.min(max_steps));
        let walk = instancer.map_or(0.0, walk_leaves);
        let per_pixel = leaves * TRACE_EVALUATIONS * instancer.map_or(1.0, |_| COPIES_OF_A_RAY) + walk;
        let (cells, least) = limits.map_or((0, 1), |of| (of.cells, LEAST_RELAUNCHES));
        let most = cost_model.cost_in(DISPATCH_TARGET, straight).min(per_pixel * MOST_PIXELS);
        let relaunches = max_steps.div_ceil(steps).max(least);
        // All dispatches together take no more steps than the settings allow.
        let max_steps = if component.has_most_steps() { steps.min(max_steps.div_ceil(relaunches)) } else { steps };
        let params = DispatchParams { max_steps, max_cells: cells, ..params };
        Self { evaluation, relaunches, per_pixel, most, params }
    }

    /// The same with a ray for each `spacing` pixels along each axis.
    fn spaced(self, spacing: u32) -> Self {
        Self { params: DispatchParams { spacing, ..self.params }, ..self }
    }

    /// Number of dispatches of a component whose image lies within `rect`: for each part its cones, relaunches and
    /// surface. With fewer rays than pixels it has two rounds of relaunches, each after a pass that chooses rays.
    fn dispatches(&self, rect: &Rect) -> usize {
        let rounds = self.relaunches as usize;
        let rounds = if self.params.spacing > 1 { 2 * (rounds + 1) } else { rounds };
        rect.parts(self.per_pixel, self.most) * (rounds + 2)
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
            let Rect { origin, end } = rect;
            let (list, first_subtile) = (self.lists, self.subtiles);
            let component = index as u32;
            let params = DispatchParams { origin, end, component, list, first_subtile, ..marching.params };
            parts.push(Part { rect, marching, params });
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
        if pass.extent() == Extent::Thinned {
            // With the rays that it chooses.
            return;
        }
        if pass.extent() != Extent::Rounds {
            let evaluations = if pass.extent() == Extent::Hits { SURFACE_EVALUATIONS } else { CONE_EVALUATIONS };
            return self.push(pass, params, cost(evaluations));
        }
        // Most rays end long before the last relaunch.
        let later = Cost { dispatches: 0.0, ..cost(0.1) };
        let is_last = |relaunch: u32| u32::from(relaunch + 1 == relaunches);
        if params.spacing > 1 {
            let coarse = f64::from(params.spacing).powi(-2);
            for (round, share) in [(0, coarse), (1, RESOLUTION_EDGES)] {
                let chooses = DispatchParams { relaunch: round, ..params };
                self.push(Pass::Resolution, chooses, cost(RESOLUTION_EVALUATIONS));
                for relaunch in 0..relaunches {
                    // The rays of the first round that are left go on in the second one.
                    let last_relaunch = round * is_last(relaunch);
                    let params = DispatchParams { relaunch: relaunch + 1, last_relaunch, compacted: 1, ..params };
                    self.push(pass, params, if relaunch == 0 { cost(TRACE_EVALUATIONS * share) } else { later });
                }
            }
            return;
        }
        for relaunch in 0..relaunches {
            let (last_relaunch, compacted) = (is_last(relaunch), u32::from(relaunch > 0));
            let params = DispatchParams { relaunch, last_relaunch, compacted, ..params };
            self.push(pass, params, if relaunch == 0 { cost(TRACE_EVALUATIONS) } else { later });
        }
    }
}

/// The components that are traced, in order.
fn traced(flat: &FlatScene, PlannedView { view, traced, .. }: PlannedView<'_>) -> Vec<usize> {
    let eye = view.camera.position;
    match traced.passes {
        None => flat.tracing_order(eye),
        Some(count) => {
            let passes = flat.component_passes(eye).into_iter().take(count as usize);
            passes.flat_map(|pass| pass.components).collect()
        }
    }
}

/// Pixels from one ray to the next, of each component; empty if all pixels have rays. Whether a ray passes a surface tells
/// nothing about its neighbors, so what rays may pass has all of them.
fn spacings(flat: &FlatScene) -> Vec<u32> {
    if flat.components.iter().all(|component| component.march.resolution == MarchResolution::Full) {
        return Vec::new();
    }
    let veiled = flat.veiled();
    let is_veiled = |at: usize| veiled.get(at) == Some(&true);
    let of = |(at, one): (usize, &Component)| if is_veiled(at) { 1 } else { one.march.resolution.spacing() };
    flat.components.iter().enumerate().map(of).collect()
}

/// The settings of a component for its dispatches, and the most steps of a ray, without limits of its own `max_steps`.
fn settings_of(component: &Component, shown: PlannedView<'_>, max_steps: u32) -> (DispatchParams, u32) {
    let PlannedView { view: SampleView { camera, .. }, size, traced } = shown;
    let march = &component.march;
    let [of_copy, of_ray] = match (march.steps, component.instanced) {
        (0, _) => [u32::MAX, max_steps],
        (steps, Some(_)) => [steps, max_steps],
        (steps, None) => [u32::MAX, steps],
    };
    let [near, far] = if traced.has_cut_offs { [march.near, march.end()] } else { [0.0, f64::INFINITY] };
    let params = DispatchParams {
        near: camera.near.max(near) as f32,
        far: camera.far.min(far) as f32,
        footprint: (camera.footprint(f64::from(size[1])) / march.precision) as f32,
        copy_steps: of_copy,
        ..DispatchParams::zeroed()
    };
    (params, of_ray)
}

#[cfg(test)]
mod tests;
