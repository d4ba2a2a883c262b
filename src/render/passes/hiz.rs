//! Pass `hiz`: the farthest depth in each subtile after the meshes. It runs only if the scene has meshes.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, TextureFormat};

use super::frame_pass::{Building, FramePass};
use crate::frame::plan::SUBTILES;
use crate::frame::rect::TILE;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use isolith_wgsl::{ShaderError, assemble_plain};

bindings! {
    /// Group 2.
    HizBindings, "hiz targets", COMPUTE {
        depth: read_texture(false),
        hiz: write_texture(TextureFormat::R32Float),
    }
}

/// The pass.
#[derive(Debug)]
pub struct HizPass {
    pipeline: ComputePipeline,
    /// Group 1, which is empty.
    scene: BindGroup,
    targets: BindGroupLayout,
}

impl FramePass for HizPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (targets, nothing) = (HizBindings::layout(device), layout(device, "nothing", &[]));
        let groups = [&layouts.view, &nothing, &targets, &layouts.dispatch_params];
        let text = assemble_plain(Pass::Hiz.file())?;
        let pipeline = compute_pipeline(device, Pass::Hiz.label(), text, "hiz", &groups);
        Ok(Self { pipeline, scene: bind(device, "nothing", &nothing, &[]), targets })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let (depth, hiz) = (bound.targets.depth.binding(), bound.targets.hiz.binding());
        vec![HizBindings { depth, hiz }.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        for at in dispatches {
            let [x, y] = recorder.frame.plan.dispatches[at].tiles().map(|tiles| (tiles * SUBTILES).div_ceil(TILE));
            let [_, targets] = recorder.groups(0);
            let pass = recorder.compute(at);
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(1, &self.scene, &[]);
            pass.set_bind_group(2, targets, &[]);
            pass.dispatch_workgroups(x, y, 1);
        }
    }
}
