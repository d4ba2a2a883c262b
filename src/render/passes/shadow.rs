//! Pass `shadow`: soft shadows and occlusion, by cones against the whole scene. It runs only if the scene has them.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout};

use super::frame_pass::{Building, FramePass};
use crate::frame::rect::TILE;
use crate::gpu::Gpu;
use crate::pipelines::shadow::{ShadowBindings, ShadowKind, ShadowOrders, ShadowPipelines};
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::hierarchy::{HierarchyBuffers, Obstacles};
use crate::resources::layouts::*;
use crate::resources::mesh_rays::MeshRayBuffer;
use crate::resources::shadows::SHADOW_PARTS;
use crate::resources::uniforms::{DispatchParams, UNIFORM_STRIDE};
use isolith_wgsl::{Options, ShaderError};

/// Pipelines for scenes with other operations that are kept.
const MOST_PIPELINES: usize = 4;

/// The layout of the hierarchy for what is met besides components.
fn layout_of(Obstacles { meshes, copies }: Obstacles) -> usize {
    usize::from(meshes) + 2 * usize::from(copies)
}

/// The pass.
#[derive(Debug)]
pub struct ShadowPass {
    layouts: Layouts,
    own: BindGroupLayout,
    /// By what is met besides components, see `layout_of`.
    hierarchies: [BindGroupLayout; 4],
    /// The one in use comes first.
    pipelines: Vec<ShadowPipelines>,
    /// Those that are built beside the frames.
    orders: ShadowOrders,
}

impl ShadowPass {
    /// Chooses the pipelines for a scene, and builds what is missing. `used`: which parts are.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        kind: ShadowKind,
        used: [bool; SHADOW_PARTS],
        options: Options,
    ) -> Result<(), ShaderError> {
        let queried = self.hierarchies[layout_of(kind.obstacles)].clone();
        match self.pipelines.iter().position(|one| one.kind.serves(&kind)) {
            Some(at) => self.pipelines[..=at].rotate_right(1),
            None => self.pipelines.insert(0, ShadowPipelines { kind, pipelines: Default::default() }),
        }
        self.pipelines.truncate(MOST_PIPELINES);
        let Self { layouts, own, pipelines, .. } = self;
        let ShadowPipelines { kind, pipelines } = &mut pipelines[0];
        for part in (0..used.len()).filter(|part| used[*part]) {
            if pipelines[part].is_none() {
                pipelines[part] = Some(kind.build(device, layouts, [own, &queried], part, options)?);
            }
        }
        Ok(())
    }

    /// Whether the pipelines for a scene are there. If not, they are built beside the frames; what fails there is built again by
    /// the frame, which reports why.
    pub fn is_ready(&mut self, gpu: &Gpu, kind: &ShadowKind, used: [bool; SHADOW_PARTS], options: Options) -> bool {
        let has = |one: &ShadowPipelines| used.iter().zip(&one.pipelines).all(|(used, own)| !used || own.is_some());
        let is_there = self.pipelines.iter().any(|one| one.kind.serves(kind) && has(one));
        if is_there || self.orders.has_failed(kind, used) {
            return true;
        }
        self.orders.order(gpu, &self.layouts, kind, used, options);
        false
    }

    /// Takes pipelines that have become ready. Returns whether there were any, or some could not be built.
    pub fn collect(&mut self) -> bool {
        let Some(built) = self.orders.collect() else { return false };
        if let Ok(built) = built {
            self.pipelines.insert(0, built);
            self.pipelines.truncate(MOST_PIPELINES);
        }
        true
    }

    /// Whether some are being built.
    pub fn is_building(&self) -> bool {
        self.orders.is_building()
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
            orders: ShadowOrders::default(),
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
        let Some(ShadowPipelines { pipelines, .. }) = self.pipelines.first() else { return };
        let used = recorder.resources.shadows.used.parts();
        let (scene, [_, own], [_, hierarchy]) = (recorder.scene(), recorder.groups(0), recorder.groups(1));
        for at in dispatches {
            let spacings = recorder.resources.shadows.used.spacings();
            let tiles = recorder.frame.plan.dispatches[at].tiles();
            const { assert!(TILE == 8, "the size of a workgroup") };
            // Occlusion first: rays to the environment look where its cones are in doubt.
            for part in [1, 0, 2].into_iter().filter(|part| used[*part]) {
                let (Some(pipeline), pass) = (&pipelines[part], recorder.open()) else { continue };
                let [x, y] = tiles.map(|tiles| tiles.div_ceil(spacings[part]));
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, scene, &[0, 0]);
                pass.set_bind_group(2, own, &[(at * UNIFORM_STRIDE) as u32]);
                pass.set_bind_group(3, hierarchy, &[]);
                pass.dispatch_workgroups(x, y, 1);
            }
        }
    }
}
