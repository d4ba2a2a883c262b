//! Pass `shadow`: soft shadows and occlusion, by cones against the whole scene. It runs only if the scene has them.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline};

use super::frame_pass::{Building, FramePass};
use crate::frame::plan::TILE;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::hierarchy::HierarchyBuffers;
use crate::resources::layouts::*;
use crate::resources::mesh_rays::MeshRayBuffer;
use crate::resources::uniforms::{DispatchParams, UNIFORM_STRIDE};
use isolith_field::FlatScene;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, assemble_with};

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
    /// Whether meshes cast shadows.
    meshes: bool,
    /// Shadows, and occlusion; each is built when a scene first uses it.
    pipelines: [Option<ComputePipeline>; 2],
}

/// Entry points: shadows, and occlusion.
const ENTRY_POINTS: [&str; 2] = ["shadow", "shadow_occlusion"];

/// The pass.
#[derive(Debug)]
pub struct ShadowPass {
    layouts: Layouts,
    own: BindGroupLayout,
    hierarchy: BindGroupLayout,
    /// The same with the meshes.
    with_meshes: BindGroupLayout,
    /// The one in use comes first.
    pipelines: Vec<ScenePipeline>,
}

impl ShadowPass {
    /// Chooses the pipelines for a scene, and builds what is missing. `by_tapes`: whether all components have
    /// tapes; `meshes`: whether meshes cast shadows; `used`: whether there are shadows, and occlusion.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        flat: &FlatScene,
        [by_tapes, meshes]: [bool; 2],
        used: [bool; 2],
        options: Options,
    ) -> Result<(), ShaderError> {
        let wanted = OpSet::of(flat);
        let fits = |one: &ScenePipeline| {
            one.by_tapes == by_tapes && one.meshes == meshes && one.ops.covers(&wanted) && one.ops.is_near(&wanted)
        };
        match self.pipelines.iter().position(fits) {
            Some(at) => self.pipelines[..=at].rotate_right(1),
            None => self.pipelines.insert(0, ScenePipeline { ops: wanted, by_tapes, meshes, pipelines: [None, None] }),
        }
        self.pipelines.truncate(MOST_PIPELINES);
        let Self { layouts, own, hierarchy, with_meshes, pipelines } = self;
        let queried = if meshes { &*with_meshes } else { &*hierarchy };
        let features: &[&str] = if meshes { &["MESH_RAYS"] } else { &[] };
        let ScenePipeline { ops, pipelines, .. } = &mut pipelines[0];
        let evaluator = if by_tapes { Evaluator::Tape(ops.clone()) } else { Evaluator::Interpreter(ops.clone()) };
        for ((pipeline, entry_point), _) in pipelines.iter_mut().zip(ENTRY_POINTS).zip(used).filter(|(_, used)| *used) {
            if pipeline.is_none() {
                let text = assemble_with(Pass::Shadow.file(), &evaluator, options, features)?;
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
            hierarchy: HierarchyBuffers::layout(device, false),
            with_meshes: HierarchyBuffers::layout(device, true),
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
        let meshes = shadows.meshes.as_ref().filter(|_| shadows.has_meshes).map(MeshRayBuffer::binding);
        let layout = if meshes.is_some() { &self.with_meshes } else { &self.hierarchy };
        vec![own.bind(device, &self.own), shadows.hierarchy.bind(device, layout, meshes)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let Some(ScenePipeline { pipelines, .. }) = self.pipelines.first() else { return };
        let used = recorder.resources.shadows.used.parts();
        let (scene, [_, own], [_, hierarchy]) = (recorder.scene(), recorder.groups(0), recorder.groups(1));
        for at in dispatches {
            let [x, y] = recorder.frame.plan.dispatches[at].tiles();
            const { assert!(TILE == 8, "the size of a workgroup") };
            for (pipeline, _) in pipelines.iter().zip(used).filter(|(_, used)| *used) {
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
