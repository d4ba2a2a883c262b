//! Shadows and occlusion of a frame: what the pass `shadow` needs, and its relaunches.

use std::sync::Arc;

use super::choice::{Chosen, loop_trips};
use super::error::RenderError;
use super::evaluation::EvaluationCost;
use super::frame::Frame;
use super::resources::FrameResources;
use super::scene::SceneResources;
use crate::frame::copies_cost::walk_leaves;
use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::passes::Passes;
use crate::pipelines::shadow::ShadowKind;
use crate::recipe::Pass;
use crate::resources::hierarchy::{Obstacles, query_components};
use crate::resources::shadows::{SHADOW_PARTS, SceneQuery, ShadowSettings};
use isolith_field::standpoint::Standpoints;
use isolith_field::{Component, FlatScene, Warning};
use isolith_geometry::Camera;
use isolith_mesh::TriangleMesh;
use isolith_wgsl::{OpSet, Options};

/// Expected evaluations per pixel for a light, and for the cones of occlusion.
const LIGHT_EVALUATIONS: f64 = 6.0;
const OCCLUSION_EVALUATIONS: f64 = 16.0;
/// Most dispatches of a part before its unfinished cones are given up and reported.
const MOST_RELAUNCHES: u32 = 4_096;

/// Cost of one evaluation of a component by the evaluator that serves all components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryCost {
    /// Whether all components have tapes.
    pub by_tapes: bool,
    /// Upper bound of the loop iterations.
    pub iterations: u32,
    /// Mean number of leaves.
    pub leaves: f64,
}

impl QueryCost {
    /// The cost for a scene: by tapes if every component has them, else by the interpreter.
    pub fn of(flat: &FlatScene, chosen: &Chosen) -> Self {
        let loops = OpSet::of(flat).loops();
        let by_tapes = !chosen.trees.is_empty() && chosen.trees.iter().all(Option::is_some);
        let cost = |index: usize| {
            let component: &Component = &flat.components[index];
            let trips = loop_trips(flat, component);
            match &chosen.trees[index] {
                Some(tree) if by_tapes => EvaluationCost::of_tapes(component, tree, loops, trips),
                _ => EvaluationCost::of_entries(component, loops, trips),
            }
        };
        let costs: Vec<_> = (0..flat.components.len()).map(cost).collect();
        Self {
            by_tapes,
            iterations: costs.iter().map(|cost| cost.iterations).max().unwrap_or(1),
            leaves: costs.iter().map(|cost| cost.leaves).sum::<f64>() / costs.len().max(1) as f64,
        }
    }
}

/// The shadows of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowWork {
    settings: ShadowSettings,
    cost: QueryCost,
    /// Expected leaves for the copies that a cone passes.
    walk: f64,
    /// Lights beyond those with shadows.
    left: usize,
}

impl ShadowWork {
    /// The work for a scene with this many lights; `None` without shadows and occlusion. `bytes`: the largest buffer.
    pub fn of(flat: &FlatScene, chosen: &Chosen, lights: usize, size: [u32; 2], bytes: u64) -> Option<Self> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let settings = ShadowSettings::new(flat, lights, pixels, bytes);
        let left = if flat.environment.shadowing.shadows { lights - settings.lights as usize } else { 0 };
        let walk = flat.instancers.iter().map(walk_leaves).sum();
        settings.is_on().then(|| Self { settings, cost: QueryCost::of(flat, chosen), walk, left })
    }

    /// The same for a picture of something that moves: not every pixel has shares.
    pub fn sparse(mut self) -> Self {
        self.settings = self.settings.sparse();
        self
    }

    /// What pipelines it needs, with those of samples; `meshes`: whether there are some.
    pub fn pipelines(&self, flat: &FlatScene, meshes: bool) -> (ShadowKind, [bool; SHADOW_PARTS]) {
        let obstacles = Obstacles { meshes, copies: !flat.instancers.is_empty() };
        (ShadowKind::of(flat, self.cost.by_tapes, obstacles), self.settings.parts_of_still())
    }

    /// Expected leaves per pixel.
    pub fn per_pixel(&self) -> f64 {
        let lights = f64::from(self.settings.lights);
        let (occlusion, around) = if self.settings.cones > 0 { (OCCLUSION_EVALUATIONS, 1.0) } else { (0.0, 0.0) };
        let of_lights = self.cost.leaves * lights * LIGHT_EVALUATIONS + self.walk * lights;
        let of_cones = self.cost.leaves * occlusion + self.walk * around;
        let [spacing, of_cone, _] = self.settings.spacings().map(|side| f64::from(side * side));
        of_lights / spacing + of_cones / of_cone
    }

    /// Numbers of lights with and without shadows.
    pub fn lights(&self) -> [usize; 2] {
        [self.settings.lights as usize, self.left]
    }
}

/// A scene as a frame sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenScene<'a> {
    /// The scene.
    pub flat: &'a FlatScene,
    /// Its meshes.
    pub meshes: &'a [Option<Arc<TriangleMesh>>],
    /// The eye.
    pub camera: &'a Camera,
    /// Size of the picture.
    pub size: [u32; 2],
    /// The points that rows are relative to.
    pub standpoints: &'a Standpoints<'a>,
}

/// Uploads what the pass needs. Returns whether bind groups must be rebuilt.
///
/// # Errors
/// A shader file is missing.
pub fn upload(
    gpu: &Gpu,
    (passes, scene, resources): (&mut Passes, &SceneResources, &mut FrameResources),
    seen: SeenScene<'_>,
    (chosen, work): (&Chosen, Option<ShadowWork>),
    options: Options,
) -> Result<bool, RenderError> {
    let Some(ShadowWork { settings, cost, .. }) = work else { return Ok(resources.shadows.switch_off()) };
    let SeenScene { flat, meshes, camera, size, standpoints } = seen;
    let has_meshes = meshes.iter().any(Option::is_some);
    let obstacles = Obstacles { meshes: has_meshes, copies: !flat.instancers.is_empty() };
    let used = settings.parts_of_still();
    passes.shadow.prepare(&gpu.device, ShadowKind::of(flat, cost.by_tapes, obstacles), used, options)?;
    let mut components = query_components(flat, camera.position, &standpoints.all);
    if cost.by_tapes {
        for ((component, tree), at) in components.iter_mut().zip(&chosen.trees).zip(&standpoints.all) {
            if let Some((tree, place)) = tree.as_ref().and_then(|tree| Some((tree, scene.place(tree)?))) {
                *component = component.with_grid(tree, place, at);
            }
        }
    }
    let (origin, iterations) = (camera.position, cost.iterations);
    let instancers = scene.queried_instancers(flat);
    let query = SceneQuery { components, origin, iterations, meshes, has_meshes, instancers };
    Ok(resources.shadows.upload(gpu, flat, &query, settings, size))
}

/// Whether the dispatch `at` belongs to the pass. If so, sets the numbers of unfinished pixels and of evaluations to 0.
pub fn begin(gpu: &Gpu, resources: &mut FrameResources, frame: &Frame, at: usize) -> bool {
    let is_shadow = frame.plan.dispatches.get(at).is_some_and(|dispatch| dispatch.pass == Pass::Shadow);
    if is_shadow {
        resources.shadows.unfinished.reset(&gpu.device, &gpu.queue, bytemuck::bytes_of(&[0_u32; 2]));
    }
    is_shadow
}

/// After the dispatch `at` of the pass: repeats the second dispatch of the part until all of its pixels have ended.
///
/// # Errors
/// The device fails.
pub fn go_on(gpu: &Gpu, resources: &FrameResources, frame: &mut Frame, at: usize) -> Result<(), RenderError> {
    let counted = read_words(gpu, resources.shadows.unfinished.buffer(), 2)?;
    let unfinished = counted[0];
    frame.shadow_evaluations += u64::from(counted[1]);
    let is_first = frame.plan.dispatches[at].params.relaunch == 0;
    frame.shadow_relaunches = if is_first { 1 } else { frame.shadow_relaunches + 1 };
    if unfinished > 0 && frame.shadow_relaunches < MOST_RELAUNCHES {
        frame.next = if is_first { at + 1 } else { at };
        frame.measured = None;
    } else {
        frame.unfinished_shadows += unfinished;
        frame.next = if is_first { at + 2 } else { at + 1 };
    }
    Ok(())
}

impl Frame {
    /// Evaluations of fields for shadows and occlusion so far, if the pipelines count.
    pub fn shadow_evaluations(&self) -> u64 {
        self.shadow_evaluations
    }

    /// Warnings about shadows that are missing or not complete, and about copies of meshes that are not drawn.
    pub(super) fn other_warnings(&self, left_out: usize) -> Vec<Warning> {
        let [used, left] = self.shadowed_lights;
        let pixels = self.unfinished_shadows;
        let reasons = [
            (left_out > 0)
                .then(|| format!("{left_out} meshes cast no shadows: the device has no room for their triangles")),
            (pixels > 0).then(|| format!("the shadows of {pixels} pixels did not come to an end; they are too light")),
            (left > 0)
                .then(|| format!("the last {left} lights cast no shadows: a picture of this size has room for {used}")),
        ];
        let node = self.origins.first().copied();
        let warning = |reason| Some(Warning { node: node?, name: String::new(), reason });
        reasons.into_iter().flatten().filter_map(warning).chain(self.of_meshes.iter().cloned()).collect()
    }
}
