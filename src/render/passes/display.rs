//! Pass `display`: the mean of accumulated samples as a picture. It runs only for frames that accumulate.

use std::ops::Range;
use std::sync::OnceLock;

use wgpu::{BindGroupLayout, RenderPipeline};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::resources::layouts::*;
use isolith_scene::ViewTransform;
use isolith_wgsl::{ShaderError, assemble_plain};

bindings! {
    /// Group 1.
    SumBindings, "sum of samples", FRAGMENT {
        sum: read_texture(false),
    }
}

/// The pass.
#[derive(Debug)]
pub struct DisplayPass {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    /// By view transform, built on first use.
    pipelines: [OnceLock<RenderPipeline>; ViewTransform::ALL.len()],
    sum: BindGroupLayout,
}

/// Entry points by view transform.
const ENTRY_POINTS: [&str; ViewTransform::ALL.len()] =
    ["display_fragment", "display_agx_fragment", "display_neutral_fragment"];

impl FramePass for DisplayPass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let sum = SumBindings::layout(device);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(Pass::Display.label()),
            source: wgpu::ShaderSource::Wgsl(assemble_plain(Pass::Display.file())?.into()),
        });
        let layout = pipeline_layout(device, Pass::Display.label(), &[&layouts.view, &sum]);
        Ok(Self { module, layout, pipelines: Default::default(), sum })
    }

    fn record(&self, recorder: &mut Recorder<'_>, _: Range<usize>) {
        let (frame, device) = (recorder.frame, &recorder.gpu.device);
        let Some((sampling, accumulation)) = frame.sampling.zip(recorder.accumulation) else { return };
        let transform = frame.view_transform as usize;
        let pipeline = self.pipelines[transform]
            .get_or_init(|| screen_pipeline(device, &self.module, ENTRY_POINTS[transform], &self.layout, None));
        let sum = SumBindings { sum: accumulation.sum(sampling.index).binding() }.bind(device, &self.sum);
        let (targets, view) = (recorder.targets, recorder.view());
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Display.label(), &targets.color.view, stamps);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, view, &[]);
        pass.set_bind_group(1, &sum, &[]);
        pass.draw(0..3, 0..1);
    }
}
