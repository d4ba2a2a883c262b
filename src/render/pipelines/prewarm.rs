//! Prewarms pipelines: has the driver compile them before a frame needs them, on a separate device.

use crate::gpu::{Gpu, GpuError};
use crate::pipelines::field::{FieldLayouts, FieldPipelines};
use crate::pipelines::field_buffers::FieldBuffers;
use crate::resources::buffers::{DataTexture, SyncedBuffer};
use crate::resources::layouts::{
    BRICKS_FORMAT, CopiesBindings, Layouts, PARAMS_FORMAT, SceneBindings, TAPES_FORMAT, bind, window,
};
use crate::resources::targets::Targets;
use crate::resources::uniforms::{DispatchParams, GpuComponent, GpuView, INSTANCER_STRIDE};
use isolith_field::copies::GpuInstancer;
use isolith_wgsl::{Evaluator, MAX_PIPELINE_ROWS, Options};

/// A device with the minimum of resources to dispatch a pipeline over no work.
#[derive(Debug)]
pub struct Prewarmer {
    gpu: Gpu,
    layouts: Layouts,
    field: FieldLayouts,
    options: Options,
    view: wgpu::BindGroup,
    /// For components, and for types of instancers.
    scene: [wgpu::BindGroup; 2],
    dispatch_params: wgpu::BindGroup,
    /// Bind groups of the passes of a pipeline.
    own: [[wgpu::BindGroup; FieldPipelines::STAGES.len()]; 2],
}

impl Prewarmer {
    /// Opens a device on the adapter of `drawing`.
    pub fn new(drawing: &Gpu, options: Options) -> Result<Self, GpuError> {
        let gpu = drawing.another()?;
        let device = &gpu.device;
        let (layouts, field) = (Layouts::new(device), FieldLayouts::new(device));
        let zeros = |size: usize| {
            let mut buffer = SyncedBuffer::rows(device, "prewarm");
            buffer.set(device, &gpu.queue, &vec![0; size]);
            buffer
        };
        let rows = zeros(MAX_PIPELINE_ROWS as usize * 16);
        let small = zeros(1024);
        // A dispatch must not read a buffer that it writes, so each binding has its own buffer.
        let written = [(); 7].map(|()| zeros(1024));
        let lists = FieldBuffers {
            subtiles: written[0].buffer(),
            subtile_counts: written[1].buffer(),
            march_counts: written[2].buffer(),
            rays: written[3].buffer(),
            ray_counts: written[4].buffer(),
            nothing: written[5].buffer(),
        };
        let [params, tapes_texture, bricks] = empty_textures(device);
        let scene = SceneBindings {
            nodes: small.binding(),
            params: params.binding(),
            subject: window(small.buffer(), size_of::<GpuComponent>()),
            rows: window(rows.buffer(), MAX_PIPELINE_ROWS as usize * 16),
            tapes: tapes_texture.binding(),
            bricks: bricks.binding(),
        };
        let instancer = zeros(INSTANCER_STRIDE);
        let copies = CopiesBindings {
            nodes: small.binding(),
            params: params.binding(),
            subject: window(small.buffer(), size_of::<GpuComponent>()),
            rows: window(rows.buffer(), MAX_PIPELINE_ROWS as usize * 16),
            tapes: tapes_texture.binding(),
            bricks: bricks.binding(),
            instancer: window(instancer.buffer(), size_of::<GpuInstancer>()),
            places: small.binding(),
        };
        // Sides that are not powers of two, as in most windows: the code that lavapipe compiles depends on it.
        let targets = Targets::new(device, [24, 24]);
        let [trace, _] = field.bind_trace(device, &targets, lists);
        let copied = written[6].buffer();
        let [trace_copies, _] = field.bind_trace_copies(device, &targets, lists, copied);
        let own = [
            [field.bind_cone(device, &targets, lists), trace, field.bind_surface(device, &targets, lists)],
            [
                field.bind_cone(device, &targets, lists),
                trace_copies,
                field.bind_surface_copies(device, &targets, lists, copied),
            ],
        ];
        Ok(Self {
            view: bind(device, "view", &layouts.view, &[window(small.buffer(), size_of::<GpuView>())]),
            scene: [scene.bind(device, &layouts.scene), copies.bind(device, &layouts.copies)],
            dispatch_params: bind(
                device,
                "dispatch_params",
                &layouts.dispatch_params,
                &[window(small.buffer(), size_of::<DispatchParams>())],
            ),
            own,
            layouts,
            field,
            options,
            gpu: gpu.clone(),
        })
    }

    /// The device, and the layouts on it.
    pub fn device(&self) -> (&Gpu, &Layouts) {
        (&self.gpu, &self.layouts)
    }

    /// Dispatches a pipeline of the pass `shadow` over no work.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn meet_shadow(
        &self,
        pipeline: &wgpu::ComputePipeline,
        own: &wgpu::BindGroup,
        hierarchy: &wgpu::BindGroup,
    ) -> Result<(), GpuError> {
        let label = Some("shadow ahead of its use");
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.view, &[]);
            pass.set_bind_group(1, &self.scene[0], &[0, 0]);
            pass.set_bind_group(2, own, &[0]);
            pass.set_bind_group(3, hierarchy, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()?;
        self.gpu.check()
    }

    /// Compiles the pipeline of `evaluator` by dispatching it over no work.
    ///
    /// # Errors
    /// The device reports an error. The same failure shows up again where the pipeline is built for use.
    pub fn prewarm(&self, evaluator: &Evaluator, copies: bool) -> Result<(), GpuError> {
        let options = Options { copies, ..self.options };
        let Ok(pipelines) = self.field.build(&self.gpu.device, &self.layouts, evaluator, options) else {
            return Ok(());
        };
        let label = Some("pipelines ahead of their use");
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
            pass.set_bind_group(0, &self.view, &[]);
            let offsets = &[0; 3][..if copies { 3 } else { 2 }];
            pass.set_bind_group(1, &self.scene[usize::from(copies)], offsets);
            pass.set_bind_group(3, &self.dispatch_params, &[0]);
            for (stage, targets) in FieldPipelines::STAGES.into_iter().zip(&self.own[usize::from(copies)]) {
                pass.set_pipeline(pipelines.pipeline(stage));
                pass.set_bind_group(2, targets, &[]);
                pass.dispatch_workgroups(1, 1, 1);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()
    }
}

/// Textures of rows, tapes and bricks without contents.
fn empty_textures(device: &wgpu::Device) -> [DataTexture; 3] {
    [("params", PARAMS_FORMAT), ("tapes", TAPES_FORMAT), ("bricks", BRICKS_FORMAT)]
        .map(|(label, format)| DataTexture::new(device, label, format))
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_gallery as gallery;
    use isolith_wgsl::OpSet;

    /// Errors of a prewarmer's device go unnoticed: pipelines would just compile later, while a frame waits.
    #[test]
    fn what_is_dispatched_over_nothing_is_accepted() {
        let prewarmer = Gpu::headless()
            .and_then(|gpu| Prewarmer::new(&gpu, Options::default()))
            .unwrap_or_else(|error| panic!("{error}"));
        let flat = isolith_field::flatten(&gallery::random(8, 1), 0.0).expect("within the limits");
        for copies in [false, true] {
            let evaluator = Evaluator::Interpreter(OpSet::of(&flat));
            prewarmer.prewarm(&evaluator, copies).unwrap_or_else(|error| panic!("{error}"));
        }
    }
}
