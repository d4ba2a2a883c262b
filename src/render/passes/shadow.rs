//! Pass `shadow`: soft shadows and occlusion, by cones against the whole scene. It runs only if the scene has them.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline};

use super::frame_pass::{Building, FramePass};
use crate::frame::rect::TILE;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::hierarchy::{HierarchyBuffers, Obstacles};
use crate::resources::layouts::*;
use crate::resources::mesh_rays::MeshRayBuffer;
use crate::resources::uniforms::{DispatchParams, UNIFORM_STRIDE};
use isolith_field::FlatScene;
use isolith_wgsl::{Evaluator, OpSet, Options, SCENE_COPIES, ShaderError, assemble_with};

bindings! {
    /// Group 2.
    ShadowBindings, "shadow targets", COMPUTE {
        depth: read_texture(false),
        normal: read_texture(false),
        lights: read_storage(),
        shares: write_storage(),
        states: write_storage(),
        unfinished: write_storage(),
        settings: uniform(false),
        dispatch: uniform(true),
    }
}

/// Pipelines for scenes with other operations that are kept.
const MOST_PIPELINES: usize = 4;

/// A pipeline for all scenes within a set of operations.
#[derive(Debug)]
struct ScenePipeline {
    ops: OpSet,
    by_tapes: bool,
    /// What casts shadows besides components.
    obstacles: Obstacles,
    /// Shadows, and occlusion; each is built when a scene first uses it.
    pipelines: [Option<ComputePipeline>; 2],
}

/// The layout of the hierarchy for what is met besides components.
fn layout_of(Obstacles { meshes, copies }: Obstacles) -> usize {
    usize::from(meshes) + 2 * usize::from(copies)
}

/// Entry points: shadows, and occlusion.
const ENTRY_POINTS: [&str; 2] = ["shadow", "shadow_occlusion"];

/// The pass.
#[derive(Debug)]
pub struct ShadowPass {
    layouts: Layouts,
    own: BindGroupLayout,
    /// By what is met besides components, see `layout_of`.
    hierarchies: [BindGroupLayout; 4],
    /// The one in use comes first.
    pipelines: Vec<ScenePipeline>,
}

impl ShadowPass {
    /// Chooses the pipelines for a scene, and builds what is missing. `by_tapes`: whether all components have
    /// tapes; `obstacles`: what casts shadows besides them; `used`: which entry points are.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        flat: &FlatScene,
        (by_tapes, obstacles): (bool, Obstacles),
        used: [bool; 2],
        options: Options,
    ) -> Result<(), ShaderError> {
        let wanted = OpSet::of(flat);
        let fits = |one: &ScenePipeline| {
            one.by_tapes == by_tapes
                && one.obstacles == obstacles
                && one.ops.covers(&wanted)
                && one.ops.is_near(&wanted)
        };
        match self.pipelines.iter().position(fits) {
            Some(at) => self.pipelines[..=at].rotate_right(1),
            None => {
                self.pipelines.insert(0, ScenePipeline { ops: wanted, by_tapes, obstacles, pipelines: [None, None] })
            }
        }
        self.pipelines.truncate(MOST_PIPELINES);
        let Self { layouts, own, hierarchies, pipelines } = self;
        let queried = &hierarchies[layout_of(obstacles)];
        let features: Vec<&str> = [(obstacles.meshes, "MESH_RAYS"), (obstacles.copies, SCENE_COPIES)]
            .into_iter()
            .filter_map(|(met, feature)| met.then_some(feature))
            .collect();
        let ScenePipeline { ops, pipelines, .. } = &mut pipelines[0];
        let evaluator = if by_tapes { Evaluator::Tape(ops.clone()) } else { Evaluator::Interpreter(ops.clone()) };
        for ((pipeline, entry_point), _) in pipelines.iter_mut().zip(ENTRY_POINTS).zip(used).filter(|(_, used)| *used) {
            if pipeline.is_none() {
                let text = assemble_with(Pass::Shadow.file(), &evaluator, options, &features)?;
                let groups = [&layouts.view, &layouts.scene, &*own, queried];
                *pipeline = Some(compute_pipeline(device, Pass::Shadow.label(), text, entry_point, &groups));
            }
        }
        Ok(())
    }
}

impl FramePass for ShadowPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        Ok(Self {
            layouts: layouts.clone(),
            own: ShadowBindings::layout(device),
            hierarchies: [0, 1, 2, 3].map(|at| {
                let obstacles = Obstacles { meshes: at & 1 != 0, copies: at & 2 != 0 };
                HierarchyBuffers::layout(device, obstacles)
            }),
            pipelines: Vec::new(),
        })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let shadows = &bound.resources.shadows;
        if !shadows.used.is_on() {
            return Vec::new();
        }
        let own = ShadowBindings {
            depth: bound.targets.depth.binding(),
            normal: bound.targets.normal.binding(),
            lights: bound.resources.lights(),
            shares: shadows.shares.binding(),
            states: shadows.states.binding(),
            unfinished: shadows.unfinished.binding(),
            settings: shadows.settings.binding(),
            dispatch: window(bound.resources.dispatch_params(), size_of::<DispatchParams>()),
        };
        let Obstacles { meshes, copies } = shadows.obstacles;
        let of_meshes = shadows.meshes.as_ref().filter(|_| meshes).map(MeshRayBuffer::binding);
        let of_copies = copies.then(|| [shadows.instancers.binding(), bound.places.clone()]);
        let layout = &self.hierarchies[layout_of(shadows.obstacles)];
        vec![own.bind(device, &self.own), shadows.hierarchy.bind(device, layout, of_meshes, of_copies)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let Some(ScenePipeline { pipelines, .. }) = self.pipelines.first() else { return };
        let used = recorder.resources.shadows.used.parts();
        let (scene, [_, own], [_, hierarchy]) = (recorder.scene(), recorder.groups(0), recorder.groups(1));
        for at in dispatches {
            let [x, y] = recorder.frame.plan.dispatches[at].tiles();
            const { assert!(TILE == 8, "the size of a workgroup") };
            // Occlusion first: rays to the environment look where its cones are in doubt.
            for (pipeline, _) in pipelines.iter().zip(used).rev().filter(|(_, used)| *used) {
                let (Some(pipeline), pass) = (pipeline, recorder.open()) else { continue };
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, scene, &[0, 0]);
                pass.set_bind_group(2, own, &[(at * UNIFORM_STRIDE) as u32]);
                pass.set_bind_group(3, hierarchy, &[]);
                pass.dispatch_workgroups(x, y, 1);
            }
        }
    }
}
