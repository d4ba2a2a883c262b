//! Has a driver compile kernels before they are needed, on a device of its own.

use super::buffers::{Mirror, RowTexture};
use super::gpu::{Gpu, GpuError};
use super::kernel::{Evaluator, MAX_KERNEL_ROWS, Options};
use super::layouts::{LISTS_FORMAT, Layouts, NUMBERS_FORMAT, bind, window};
use super::passes::field::{FieldGroups, FieldLayouts, Lists};
use super::targets::Targets;
use super::uniforms::{GpuComponent, View, Work};

/// A device with just enough on it to dispatch a kernel over nothing.
#[derive(Debug)]
pub struct Warmer {
    gpu: Gpu,
    layouts: Layouts,
    field: FieldLayouts,
    options: Options,
    view: wgpu::BindGroup,
    scene: wgpu::BindGroup,
    work: wgpu::BindGroup,
    groups: FieldGroups,
}

impl Warmer {
    /// Opens a device on the adapter of `drawing`.
    pub fn new(drawing: &Gpu, options: Options) -> Result<Self, GpuError> {
        let gpu = drawing.another()?;
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let field = FieldLayouts::new(device);
        let zeros = |size: usize| {
            let mut mirror = Mirror::rows(device, "warm");
            mirror.set(device, &gpu.queue, &vec![0; size]);
            mirror
        };
        let rows = zeros(MAX_KERNEL_ROWS as usize * 16);
        let small = zeros(1024);
        // What is written to may not be read in the same dispatch: each has a buffer of its own.
        let written = [(); 6].map(|()| zeros(1024));
        let lists = Lists {
            quads: written[0].buffer(),
            quad_counts: written[1].buffer(),
            march_counts: written[2].buffer(),
            rays: written[3].buffer(),
            ray_counts: written[4].buffer(),
            nothing: written[5].buffer(),
        };
        let [numbers, lists_texture] =
            [("numbers", NUMBERS_FORMAT), ("lists", LISTS_FORMAT)].map(|(l, f)| RowTexture::new(device, l, f));
        let scene = [
            small.binding(),
            numbers.binding(),
            window(small.buffer(), size_of::<GpuComponent>()),
            small.binding(),
            window(rows.buffer(), MAX_KERNEL_ROWS as usize * 16),
            lists_texture.binding(),
        ];
        Ok(Self {
            view: bind(device, "view", &layouts.view, &[window(small.buffer(), size_of::<View>())]),
            scene: bind(device, "scene", &layouts.scene, &scene),
            work: bind(device, "work", &layouts.work, &[window(small.buffer(), size_of::<Work>())]),
            // Sides that are no powers of two, as in most windows: what lavapipe compiles depends on it.
            groups: field.bind(device, &Targets::new(device, [24, 24]), lists),
            layouts,
            field,
            options,
            gpu: gpu.clone(),
        })
    }

    /// Compiles the kernel of `evaluator` by dispatching it over nothing.
    ///
    /// # Errors
    /// What the device complains about. Failures show up again where the kernel is built for use.
    pub fn warm(&self, evaluator: &Evaluator) -> Result<(), GpuError> {
        let Ok(kernel) = self.field.build(&self.gpu.device, &self.layouts, evaluator, self.options) else {
            return Ok(());
        };
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(0, &self.view, &[]);
            pass.set_bind_group(1, &self.scene, &[0, 0]);
            pass.set_bind_group(3, &self.work, &[0]);
            let passes = [
                (&kernel.cone, &self.groups.cone),
                (&kernel.trace, &self.groups.trace),
                (&kernel.surface, &self.groups.surface),
            ];
            for (pipeline, targets) in passes {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(2, targets, &[]);
                pass.dispatch_workgroups(1, 1, 1);
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery;
    use crate::render::kernel::Features;

    /// Nobody sees what a warmer's device complains about: kernels would only be compiled later, while a frame waits.
    #[test]
    fn what_is_dispatched_over_nothing_is_accepted() {
        let warmer = Gpu::headless()
            .and_then(|gpu| Warmer::new(&gpu, Options::default()))
            .unwrap_or_else(|error| panic!("{error}"));
        let flat = crate::flat::flatten(&gallery::random(8, 1), 0.0).expect("within the limits");
        warmer.warm(&Evaluator::Interpreted(Features::of(&flat))).unwrap_or_else(|error| panic!("{error}"));
    }
}
