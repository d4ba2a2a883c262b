//! Pass `shade`: lighting of the hits, and the background.

use std::ops::Range;

use wgpu::{BindGroup, BindGroupLayout};

use super::frame_pass::{Building, FramePass};
use crate::recipe::Pass;
use crate::renderer::mesh_materials::mesh_materials;
use crate::renderer::recorder::Recorder;
use crate::renderer::resources::Bound;
use crate::resources::layouts::*;
use crate::resources::uniforms::DispatchParams;
use isolith_field::FlatScene;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, assemble};

bindings! {
    /// Group 1.
    LightBindings, "lights", FRAGMENT {
        lights: read_storage(),
        materials: read_storage(),
        mesh_materials: read_storage(),
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

/// The pass. It has a pipeline for each kind of scene, built when such a scene comes.
#[derive(Debug)]
pub struct ShadePass {
    layout: wgpu::PipelineLayout,
    /// Without and with the layers of OpenPBR.
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    /// Whether the scene has materials with layers.
    has_layers: bool,
    lights: BindGroupLayout,
    targets: BindGroupLayout,
}

impl FramePass for ShadePass {
    fn new(Building { device, layouts, .. }: Building<'_>) -> Result<Self, ShaderError> {
        let (lights, targets) = (LightBindings::layout(device), ShadeBindings::layout(device));
        let layout = pipeline_layout(device, Pass::Shade.label(), &[&layouts.view, &lights, &targets]);
        Ok(Self { layout, pipelines: [None, None], has_layers: false, lights, targets })
    }

    fn bind(&self, device: &wgpu::Device, bound: &Bound<'_>) -> Vec<BindGroup> {
        let lights = LightBindings {
            lights: bound.resources.lights(),
            materials: bound.materials.clone(),
            mesh_materials: bound.resources.mesh_materials(),
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
        let (encoder, stamps) = recorder.drawing();
        let stamps = stamps.map(|stamps| stamps.of_drawing());
        let mut pass = screen_pass(encoder, Pass::Shade.label(), &targets.color.view, stamps);
        let pipeline = self.pipelines[usize::from(self.has_layers)].as_ref();
        pass.set_pipeline(pipeline.expect("the frame has prepared it"));
        for (at, group) in (0..).zip([view, lights, textures]) {
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
    /// Makes the pipeline for the materials of this scene current.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn prepare(&mut self, device: &wgpu::Device, flat: &FlatScene) -> Result<(), ShaderError> {
        let meshes = mesh_materials(flat);
        self.has_layers = flat.materials.iter().chain(&meshes).any(|material| material.phong_weight < 1.0);
        let pipeline = &mut self.pipelines[usize::from(self.has_layers)];
        if pipeline.is_none() {
            let options = Options { layers: self.has_layers, ..Options::default() };
            let text = assemble(Pass::Shade.file(), &Evaluator::Interpreter(OpSet::none()), options)?;
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(Pass::Shade.label()),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            });
            *pipeline = Some(screen_pipeline(device, &module, "shade_fragment", &self.layout, None));
        }
        Ok(())
    }
}
