//! Pass `shade`: lighting of the hits, and the background.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use wgpu::{BindGroup, BindGroupLayout, RenderPipeline, ShaderModule};

use super::frame_pass::{Building, FramePass};
use super::shade_features::{ShadeExtras, ShadeFeatures, ShadeOutput};
use crate::recipe::Pass;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use crate::resources::uniforms::DispatchParams;
use isolith_wgsl::ShaderError;

bindings! {
    /// Group 1.
    LightBindings, "lights", FRAGMENT {
        lights: read_storage(),
        materials: read_storage(),
        mesh_materials: read_storage(),
        environment_map: read_storage(),
    }
}

bindings! {
    /// Group 2.
    ShadeBindings, "shade targets", FRAGMENT {
        depth: read_texture(false),
        normal: read_texture(false),
        base_color: read_texture(false),
        material: read_texture(true),
        visibility: read_texture(true),
    }
}

/// The pass.
#[derive(Debug)]
pub struct ShadePass {
    view: BindGroupLayout,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
    /// The sources that pictures have needed so far.
    modules: HashMap<ShadeFeatures, ShaderModule>,
    /// Their pipelines, built on first use.
    pipelines: Mutex<HashMap<(ShadeFeatures, ShadeOutput), ShadePipeline>>,
}

/// A pipeline with the layout of its group 3.
#[derive(Clone, Debug)]
struct ShadePipeline {
    pipeline: RenderPipeline,
    extras_layout: BindGroupLayout,
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        Ok(Self {
            view: layouts.view.clone(),
            lights: LightBindings::layout(device),
            targets: ShadeBindings::layout(device),
            modules: HashMap::new(),
            pipelines: Mutex::default(),
        })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let lights = LightBindings {
            lights: bound.resources.lights(),
            materials: bound.materials.clone(),
            mesh_materials: bound.resources.mesh_materials(),
            environment_map: bound.resources.environment_map(),
        };
        let targets = ShadeBindings {
            depth: bound.targets.depth.binding(),
            normal: bound.targets.normal.binding(),
            base_color: bound.targets.base_color.binding(),
            material: bound.targets.material.binding(),
            visibility: bound.targets.visibility.binding(),
        };
        vec![lights.bind(device, &self.lights), targets.bind(device, &self.targets)]
    }

    fn record(&self, recorder: &mut Recorder<'_>, dispatches: Range<usize>) {
        let (frame, targets) = (recorder.frame, recorder.targets);
        let ([view, lights], [_, textures]) = (recorder.groups(0), recorder.groups(1));
        let device = &recorder.gpu.device;
        let sampled = frame.sampling.zip(recorder.accumulation);
        let extras = ShadeExtras {
            sum: sampled.map(|(sampling, accumulation)| accumulation.sum_before(sampling.index).binding()),
            textures: recorder.resources.textures(),
            shares: recorder.resources.shadows.bindings(),
            copied: targets
                .copied
                .as_ref()
                .filter(|_| frame.shade_features.copies)
                .map(wgpu::Buffer::as_entire_binding),
            bricks: frame.shade_features.looks.then(|| wgpu::BindingResource::TextureView(&recorder.shaded().bricks)),
            carried: frame
                .shade_features
                .carried
                .then(|| recorder.shaded().copies.each_ref().map(wgpu::Buffer::as_entire_binding)),
            tiles: recorder.resources.light_tiles(),
        };
        let (output, target) = match sampled {
            Some((sampling, accumulation)) => (ShadeOutput::Sum, accumulation.sum(sampling.index)),
            None => (ShadeOutput::Picture(frame.view_transform), &targets.color),
        };
        let ShadePipeline { pipeline, extras_layout } = self.pipeline(device, frame.shade_features, output);
        let extras = extras.bind(device, &extras_layout);
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &target.view, stamps);
        pass.set_pipeline(&pipeline);
        for (at, group) in (0..).zip([view, lights, textures, &extras]) {
            pass.set_bind_group(at, group, &[]);
        }
        for DispatchParams { origin, end, .. } in
            frame.plan.dispatches[dispatches].iter().map(|dispatch| dispatch.params)
        {
            pass.set_scissor_rect(origin[0], origin[1], end[0] - origin[0], end[1] - origin[1]);
            pass.draw(0..3, 0..1);
        }
    }
}

impl ShadePass {
    /// Loads the source for these features.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(&mut self, device: &wgpu::Device, features: ShadeFeatures) -> Result<(), ShaderError> {
        if let std::collections::hash_map::Entry::Vacant(place) = self.modules.entry(features) {
            let source = wgpu::ShaderSource::Wgsl(features.source()?.into());
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some(Pass::Shade.label()), source };
            place.insert(device.create_shader_module(descriptor));
        }
        Ok(())
    }

    /// The pipeline; the frame has prepared its features.
    fn pipeline(&self, device: &wgpu::Device, features: ShadeFeatures, output: ShadeOutput) -> ShadePipeline {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        let build = || {
            let extras_layout = features.extras_layout(device, output);
            let groups = [&self.view, &self.lights, &self.targets, &extras_layout];
            let layout = pipeline_layout(device, Pass::Shade.label(), &groups);
            let format = output.format();
            let module = &self.modules[&features];
            let pipeline = screen_pipeline_to(format, device, module, output.entry_point(), &layout, None);
            ShadePipeline { pipeline, extras_layout }
        };
        pipelines.entry((features, output)).or_insert_with(build).clone()
    }
}
