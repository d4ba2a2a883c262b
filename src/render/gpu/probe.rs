//! Evaluates fields and surfaces at given points on the GPU, for the tests that compare it with the CPU evaluator.

use glam::DVec3;
use wgpu::ShaderStages;

use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::renderer::RenderError;
use crate::renderer::scene::PIPELINE_WINDOW;
use crate::resources::brick_texture::BrickTexture;
use crate::resources::buffers::{DataTexture, SyncedBuffer};
use crate::resources::layouts::{
    Layouts, PARAMS_FORMAT, SceneBindings, TAPES_FORMAT, bind, compute_pipeline, entry, layout, read_storage, uniform,
    window, write_storage,
};
use crate::resources::uniforms::GpuComponent;
use isolith_field::mixture::{Mixture, mixture_decoded, mixture_material};
use isolith_field::standpoint::Standpoint;
use isolith_field::{CellTree, FlatScene, ParamRow, ROW_ALIGNMENT};
use isolith_wgsl::{Evaluator, Options, assemble, template_rows};

/// The field of the component `index` at `points`, which are relative to its origin, by the same source as the passes.
///
/// # Errors
/// The device fails.
pub fn field(
    gpu: &Gpu,
    flat: &FlatScene,
    index: usize,
    points: &[DVec3],
    evaluator: &Evaluator,
    options: Options,
) -> Result<Vec<f32>, RenderError> {
    let probe = Probe { file: "probe.wgsl", entry: "probe_field", words: 1, evaluator, options };
    Ok(probe.run(gpu, flat, index, points)?.into_iter().map(f32::from_bits).collect())
}

/// The surface near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbedSurface {
    /// The field's gradient.
    pub gradient: DVec3,
    /// The field, in meters.
    pub distance: f64,
    /// The materials, in the encoding that shading reads.
    pub materials: Mixture,
    /// Linear diffuse reflectance of their mixture.
    pub base_color: DVec3,
}

/// The surface at the same points: gradients and materials, by the source of the surface pass.
///
/// # Errors
/// The device fails.
pub fn surface(
    gpu: &Gpu,
    flat: &FlatScene,
    index: usize,
    points: &[DVec3],
    evaluator: &Evaluator,
    options: Options,
) -> Result<Vec<ProbedSurface>, RenderError> {
    let probe = Probe { file: "probe_surface.wgsl", entry: "probe_surface", words: 8, evaluator, options };
    let found = probe.run(gpu, flat, index, points)?;
    let read = |&[x, y, z, distance, materials @ ..]: &[u32; 8]| {
        let [x, y, z, distance] = [x, y, z, distance].map(|bits| f64::from(f32::from_bits(bits)));
        let materials = mixture_decoded(materials);
        let base_color = mixture_material(&materials, &flat.materials).base_color;
        ProbedSurface { gradient: DVec3::new(x, y, z), distance, materials, base_color }
    };
    Ok(found.as_chunks().0.iter().map(read).collect())
}

/// The lookahead for pairs of points on a ray, both relative to the origin. The result holds the field at the second
/// point; how far beyond it the field is proven positive; the lower bound that is proven within four times their
/// distance before the first point, or the field there if it is less; and the field at the first point.
///
/// # Errors
/// The device fails.
pub fn lookahead(
    gpu: &Gpu,
    flat: &FlatScene,
    index: usize,
    pairs: &[DVec3],
    evaluator: &Evaluator,
    options: Options,
) -> Result<Vec<[f32; 4]>, RenderError> {
    let probe = Probe { file: "probe_lookahead.wgsl", entry: "probe_lookahead", words: 2, evaluator, options };
    let words = probe.run(gpu, flat, index, pairs)?;
    Ok(words.as_chunks().0.iter().map(|found| found.map(f32::from_bits)).collect())
}

/// A shader to run at each point.
struct Probe<'a> {
    file: &'a str,
    entry: &'a str,
    /// Words that it writes for each point.
    words: usize,
    evaluator: &'a Evaluator,
    options: Options,
}

impl Probe<'_> {
    fn run(&self, gpu: &Gpu, flat: &FlatScene, index: usize, points: &[DVec3]) -> Result<Vec<u32>, RenderError> {
        let Gpu { device, queue, .. } = gpu;
        let (evaluator, count) = (self.evaluator, points.len() * self.words);
        let stage = ShaderStages::COMPUTE;
        let layouts = Layouts::new(device);
        let own = layout(device, "probe", &[entry(0, stage, uniform(false))]);
        let data = layout(device, "probe data", &[entry(0, stage, read_storage()), entry(1, stage, write_storage())]);
        let text = assemble(self.file, evaluator, self.options)?;
        let pipeline = compute_pipeline(device, "probe", text, self.entry, &[&own, &layouts.scene, &data]);
        let uploaded = |bytes: &[u8]| {
            let mut buffer = SyncedBuffer::rows(device, "probe");
            buffer.set_with_room(device, queue, bytes, PIPELINE_WINDOW, 4);
            buffer
        };
        let settings = uploaded(bytemuck::cast_slice(&[points.len() as u32, 0, 0, 0]));
        let tree = matches!(evaluator, Evaluator::Tape(_)).then(|| CellTree::build(flat, &flat.components[index]));
        let component = GpuComponent::new(&flat.components[index], &Standpoint::at_origin());
        let component = tree.as_ref().map_or(component, |tree| component.with_grid(tree, 0, &Standpoint::at_origin()));
        let (rows, rows_at) = window_rows(flat, index, evaluator);
        let scene = [
            uploaded(bytemuck::cast_slice(&flat.nodes)),
            uploaded(bytemuck::bytes_of(&component)),
            uploaded(bytemuck::cast_slice(&rows)),
        ];
        let texture = |label, format, bytes: &[u8]| {
            let mut texture = DataTexture::new(device, label, format);
            texture.reserve(device, bytes.len());
            texture.write(queue, 0, bytes);
            texture
        };
        let params = texture("params", PARAMS_FORMAT, bytemuck::cast_slice(&flat.params));
        let words = tree.as_ref().map_or(&[][..], |tree| bytemuck::cast_slice(&tree.words));
        let tapes = texture("tapes", TAPES_FORMAT, words);
        let mut bricks = BrickTexture::new(device);
        bricks.hold(device, queue, &flat.bricks);
        let bindings = SceneBindings {
            nodes: scene[0].binding(),
            params: params.binding(),
            subject: window(scene[1].buffer(), size_of::<GpuComponent>()),
            rows: window(scene[2].buffer(), PIPELINE_WINDOW),
            tapes: tapes.binding(),
            bricks: bricks.binding(),
        };
        let positions: Vec<[f32; 4]> = points.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32, 0.0]).collect();
        let (positions, values) = (uploaded(bytemuck::cast_slice(&positions)), uploaded(&vec![0; count * 4]));
        let groups = [
            bind(device, "probe", &own, &[settings.binding()]),
            bindings.bind(device, &layouts.scene),
            bind(device, "probe data", &data, &[positions.binding(), values.binding()]),
        ];
        debug_assert_eq!(flat.components[index].params as usize % ROW_ALIGNMENT, 0);
        let label = Some(self.entry);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &groups[0], &[]);
            pass.set_bind_group(1, &groups[1], &[0, rows_at]);
            pass.set_bind_group(2, &groups[2], &[]);
            pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
        Ok(read_words(gpu, values.buffer(), count)?)
    }
}

/// The rows that the pipeline's window binds, and the offset of the window in bytes.
fn window_rows(flat: &FlatScene, index: usize, evaluator: &Evaluator) -> (Vec<ParamRow>, u32) {
    // A pipeline for a template reads its own rows.
    if matches!(evaluator, Evaluator::StraightLine(structure) if structure.is_template()) {
        let mut rows = Vec::new();
        template_rows(flat, &flat.params, &flat.components[index], &mut rows);
        return (rows, 0);
    }
    (flat.params.clone(), flat.components[index].params * size_of::<ParamRow>() as u32)
}
