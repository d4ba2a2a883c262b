//! The passes that evaluate a component: `cone`, `trace`, `surface`. Their pipelines are in `pipelines::field`.

use std::ops::Range;

use wgpu::BindGroup;

use super::frame_pass::{Building, FramePass};
use crate::pipelines::field::{FieldLayouts, own_of};
use crate::pipelines::veiled::VeilBindings;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::{Bound, RAY_COUNTS, SUBTILE_COUNTS};
use isolith_wgsl::{ShaderError, Veil};

/// Invocations in a workgroup of the cone pass.
const CONE_GROUP: u32 = 64;

/// Finds the subtiles that a component touches, and the distance at which rays start there.
#[derive(Debug)]
pub struct ConePass(FieldLayouts);

impl FramePass for ConePass {
    fn new(building: Building<'_>) -> Result<Self, ShaderError> {
        Ok(Self(building.field.clone()))
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        vec![self.0.bind_cone(device, bound.targets, bound.resources.lists())]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        for at in dispatches {
            let [x, y] = recorder.frame.plan.dispatches[at].tiles();
            recorder.component(at, 0, |pipelines| &pipelines.cone).dispatch_workgroups(
                (x * y).div_ceil(CONE_GROUP),
                1,
                1,
            );
        }
    }
}

/// Finds hits within these subtiles.
#[derive(Debug)]
pub struct TracePass(FieldLayouts);

impl FramePass for TracePass {
    fn new(building: Building<'_>) -> Result<Self, ShaderError> {
        Ok(Self(building.field.clone()))
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let (targets, lists) = (bound.targets, bound.resources.lists());
        let plain = self.0.bind_trace(device, targets, lists);
        let copied = targets.copied.as_ref();
        let of_copies = copied.map(|copied| self.0.bind_trace_copies(device, targets, lists, copied));
        // What a scene does not have is never used: any group stands for it.
        let mut all = [plain.clone(), of_copies.unwrap_or_else(|| plain.clone())].concat();
        let veil = bound.resources.veil();
        if veil != Veil::None {
            let textures = bound.resources.textures().filter(|_| veil == Veil::Textured);
            let mut bind = |copied: Option<&wgpu::Buffer>| {
                let own = VeilBindings { copied, materials: bound.materials.clone(), textures: textures.clone() };
                all.extend(self.0.veiled().bind(device, targets, lists, &own));
            };
            bind(None);
            copied.iter().for_each(|copied| bind(Some(copied)));
        }
        all
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        for at in dispatches {
            let (dispatch, resources) = (&recorder.frame.plan.dispatches[at], recorder.resources);
            let (list, compacted) = (dispatch.params.list as usize, dispatch.params.compacted as usize);
            let (counts, word) = match compacted {
                0 => (&resources.subtile_counts, list * SUBTILE_COUNTS),
                _ => (&resources.ray_counts, list * RAY_COUNTS),
            };
            let pipelines = &recorder.frame.choices[dispatch.params.component as usize].pipelines;
            let first = own_of(Pass::Trace, pipelines.copies, pipelines.veil);
            let pass = recorder.component(at, first + compacted, |pipelines| &pipelines.trace);
            pass.dispatch_workgroups_indirect(counts.buffer(), word as u64 * 4);
        }
    }
}

/// Computes normal, material and leaf of the hits.
#[derive(Debug)]
pub struct SurfacePass(FieldLayouts);

impl FramePass for SurfacePass {
    fn new(building: Building<'_>) -> Result<Self, ShaderError> {
        Ok(Self(building.field.clone()))
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let (targets, lists) = (bound.targets, bound.resources.lists());
        let of_copies =
            targets.copied.as_ref().map(|copied| self.0.bind_surface_copies(device, targets, lists, copied));
        std::iter::once(self.0.bind_surface(device, targets, lists)).chain(of_copies).collect()
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        for at in dispatches {
            let dispatch = &recorder.frame.plan.dispatches[at];
            let list = dispatch.params.list as usize;
            let counts = recorder.resources.ray_counts.buffer();
            let own = own_of(Pass::Surface, recorder.frame.is_of_copies(dispatch), Veil::None);
            let pass = recorder.component(at, own, |pipelines| &pipelines.surface);
            pass.dispatch_workgroups_indirect(counts, (list * RAY_COUNTS + 3) as u64 * 4);
        }
    }
}
