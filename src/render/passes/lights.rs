//! Pass `lights`: which lights may reach the surfaces of each tile. It runs only in scenes with many lights, whose shade
//! pass then visits those alone.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout, ComputePipeline};

use super::frame_pass::{Building, FramePass};
use crate::frame::light_tiles::LIGHT_TILE;
use crate::frame::rect::TILE;
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use isolith_wgsl::{ShaderError, assemble_plain};

bindings! {
    /// Group 2.
    TileBindings, "tiles of lights", COMPUTE {
        depth: read_texture(false),
        lights: read_storage(),
        tiles: write_storage(),
    }
}

/// The pass.
#[derive(Debug)]
pub struct LightsPass {
    pipeline: ComputePipeline,
    targets: BindGroupLayout,
}

impl FramePass for LightsPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let targets = TileBindings::layout(device);
        // Group 1 is that of the passes around it; an empty one there made lavapipe 22 read beyond its descriptors.
        let groups = [&layouts.view, &layouts.scene, &targets, &layouts.dispatch_params];
        let text = assemble_plain(Pass::Lights.file())?;
        let pipeline = compute_pipeline(device, Pass::Lights.label(), text, "lights_of_tiles", &groups);
        Ok(Self { pipeline, targets })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let Some(tiles) = bound.resources.light_tiles() else { return Vec::new() };
        let (depth, lights) = (bound.targets.depth.binding(), bound.resources.lights());
        vec![TileBindings { depth, lights, tiles }.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        const { assert!(TILE == LIGHT_TILE, "a dispatch counts its tiles") };
        for at in dispatches {
            let [x, y] = recorder.frame.plan.dispatches[at].tiles().map(|tiles| tiles.div_ceil(TILE));
            let ([_, targets], scene) = (recorder.groups(0), recorder.scene());
            let pass = recorder.compute(at);
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(1, scene, &[0, 0]);
            pass.set_bind_group(2, targets, &[]);
            pass.dispatch_workgroups(x, y, 1);
        }
    }
}
