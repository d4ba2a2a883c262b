//! Evaluates and traces a whole scene on the GPU, for the tests that compare it with the scene evaluator of the CPU.

use glam::DVec3;
use wgpu::{BindGroup, BindGroupLayout, ComputePipeline, ShaderStages};

use crate::gpu::Gpu;
use crate::gpu::readback::read_words;
use crate::renderer::RenderError;
use crate::renderer::evaluation::EvaluationCost;
use crate::renderer::scene::PIPELINE_WINDOW;
use crate::resources::brick_texture::BrickTexture;
use crate::resources::buffers::{DataTexture, SyncedBuffer};
use crate::resources::hierarchy::{HierarchyBuffers, Obstacles, SceneLimits, query_components};
use crate::resources::layouts::{
    Layouts, PARAMS_FORMAT, SceneBindings, TAPES_FORMAT, bind, compute_pipeline, entry, layout, read_storage, uniform,
    window, write_storage,
};
use crate::resources::uniforms::{GpuComponent, GpuView};
use isolith_field::hierarchy::Hierarchy;
use isolith_field::standpoint::Standpoint;
use isolith_field::{CellTree, FlatScene};
use isolith_geometry::Camera;
use isolith_wgsl::{Evaluator, OpSet, Options, assemble, shape_loops};

/// A ray through a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeRay {
    /// Its origin, in the world.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Near and far limit of hits: distances from the origin.
    pub limits: [f64; 2],
    /// Length of the path from the eye to the origin, which determines the footprint.
    pub gone: f64,
    /// Unit normal of the surface that the ray leaves, if any.
    pub normal: Option<DVec3>,
}

/// Result of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbedHit {
    /// Distance from the ray's origin, and the component.
    pub hit: Option<(f64, u32)>,
    /// Evaluations of fields.
    pub evaluations: u32,
    /// Visited nodes of the hierarchy.
    pub visits: u32,
    /// Whether the march reached its end.
    pub ended: bool,
}

/// The value of a scene at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbedValue {
    /// The value.
    pub value: f64,
    /// The component with this value; `u32::MAX` for none.
    pub component: u32,
    /// Whether the evaluation completed within the limits of an invocation.
    pub complete: bool,
    /// Evaluations of fields.
    pub evaluations: u32,
    /// Visited nodes of the hierarchy.
    pub visits: u32,
}

/// Words of a value and of a march in the results buffer.
const VALUE_WORDS: usize = 5;
const MARCH_WORDS: usize = 10;
/// The word of a march that tells whether it has ended, and its value before the march begins.
const ENDED_WORD: usize = 7;
const NOT_BEGUN: u32 = 2;

/// The pipelines. One source serves every scene within the evaluator's set of operations.
#[derive(Debug)]
pub struct SceneProbe {
    evaluator: Evaluator,
    ops: OpSet,
    layouts: Layouts,
    own: BindGroupLayout,
    hierarchy: BindGroupLayout,
    value: ComputePipeline,
    ray: ComputePipeline,
    /// Limits of evaluations and visits of an invocation, to override the limits of the driver.
    pub most: Option<[u32; 2]>,
}

impl SceneProbe {
    /// Builds the pipelines, for the interpreter or for tapes.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn new(gpu: &Gpu, ops: OpSet, by_tapes: bool) -> Result<Self, RenderError> {
        let evaluator = if by_tapes { Evaluator::Tape(ops.clone()) } else { Evaluator::Interpreter(ops.clone()) };
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let types = [uniform(false), read_storage(), write_storage()];
        let entries: Vec<_> =
            types.into_iter().enumerate().map(|(i, ty)| entry(i as u32, ShaderStages::COMPUTE, ty)).collect();
        let own = layout(device, "scene probe", &entries);
        let hierarchy = HierarchyBuffers::layout(device, Obstacles::default());
        let text = assemble("probe_scene.wgsl", &evaluator, Options::default())?;
        let pipeline = |entry_point| {
            let groups = [&layouts.view, &layouts.scene, &own, &hierarchy];
            compute_pipeline(device, "scene probe", text.clone(), entry_point, &groups)
        };
        let (value, ray) = (pipeline("probe_scene_value"), pipeline("probe_scene_ray"));
        Ok(Self { evaluator, ops, layouts, own, hierarchy, value, ray, most: None })
    }

    /// Uploads a scene with a hierarchy over its components. Queries are relative to the position of `camera`. Its
    /// angle and the `rows` of a picture determine the footprint. With the tape evaluator, every component must be able
    /// to have tapes.
    pub fn load<'a>(
        &'a self,
        gpu: &'a Gpu,
        flat: &FlatScene,
        hierarchy: &Hierarchy,
        (camera, rows): (&Camera, u32),
    ) -> LoadedScene<'a> {
        let Gpu { device, queue, .. } = gpu;
        let origin = camera.position;
        let mut components = query_components(flat, origin, &[]);
        let mut tapes = Vec::new();
        if let Evaluator::Tape(_) = self.evaluator {
            for (own, component) in components.iter_mut().zip(&flat.components) {
                let tree = CellTree::build(flat, component);
                *own = own.with_grid(&tree, tapes.len() as u32, &Standpoint::at_origin());
                tapes.extend(tree.words);
            }
        }
        let mut buffers = HierarchyBuffers::new(device);
        let mut limits = SceneLimits::new(hierarchy, self.iterations(flat));
        if let Some([max_evaluations, max_visits]) = self.most {
            limits = SceneLimits { max_evaluations, max_visits, ..limits };
        }
        buffers.set(gpu, hierarchy, origin, &components, limits);
        let uploaded = |bytes: &[u8]| {
            let mut buffer = SyncedBuffer::rows(device, "scene probe");
            buffer.set_with_room(device, queue, bytes, PIPELINE_WINDOW, 4);
            buffer
        };
        let texture = |label, format, bytes: &[u8]| {
            let mut texture = DataTexture::new(device, label, format);
            texture.reserve(device, bytes.len());
            texture.write(queue, 0, bytes);
            texture
        };
        let view = uploaded(bytemuck::bytes_of(&GpuView::new(camera, [rows, rows], flat, 0)));
        let nodes = uploaded(bytemuck::cast_slice(&flat.nodes));
        let params = texture("params", PARAMS_FORMAT, bytemuck::cast_slice(&flat.params));
        let tapes = texture("tapes", TAPES_FORMAT, bytemuck::cast_slice(&tapes));
        // Components read nothing at their dynamic offsets here.
        let none = uploaded(&[]);
        let mut bricks = BrickTexture::new(device);
        bricks.hold(device, queue, &flat.bricks);
        let bindings = SceneBindings {
            nodes: nodes.binding(),
            params: params.binding(),
            subject: window(none.buffer(), size_of::<GpuComponent>()),
            rows: window(none.buffer(), PIPELINE_WINDOW),
            tapes: tapes.binding(),
            bricks: bricks.binding(),
        };
        let groups = [
            bind(device, "view", &self.layouts.view, &[view.binding()]),
            bindings.bind(device, &self.layouts.scene),
            buffers.bind(device, &self.hierarchy, None, None),
        ];
        LoadedScene { probe: self, gpu, origin, groups }
    }

    /// Upper bound of the loop iterations of one evaluation of a component of `flat`.
    fn iterations(&self, flat: &FlatScene) -> u32 {
        let trips = self.ops.shapes.iter().map(|kind| shape_loops(*kind)[1]).max().unwrap_or(0);
        let of =
            |component| EvaluationCost::of_entries(component, self.ops.loops(), trips * component.count).iterations;
        flat.components.iter().map(of).max().unwrap_or(1)
    }
}

/// A scene on the device.
#[derive(Debug)]
pub struct LoadedScene<'a> {
    probe: &'a SceneProbe,
    gpu: &'a Gpu,
    origin: DVec3,
    groups: [BindGroup; 3],
}

impl LoadedScene<'_> {
    /// The values at points of the world. See `scene_value` for `within`.
    ///
    /// # Errors
    /// The device fails.
    pub fn values(&self, points: &[DVec3], within: f64) -> Result<Vec<ProbedValue>, RenderError> {
        let inputs: Vec<_> = points.iter().map(|p| self.relative(*p, within)).collect();
        let results = self.results(&vec![0; points.len() * VALUE_WORDS]);
        self.dispatch(&self.probe.value, &inputs, points.len(), false, &results);
        let words = read_words(self.gpu, results.buffer(), points.len() * VALUE_WORDS)?;
        let read = |&[value, component, complete, evaluations, visits]: &[u32; VALUE_WORDS]| ProbedValue {
            value: f32::from_bits(value).into(),
            component,
            complete: complete == 1,
            evaluations,
            visits,
        };
        Ok(words.as_chunks().0.iter().map(read).collect())
    }

    /// The first hits of rays, either all of which leave a surface, or none. Dispatches continue the marches until
    /// every ray has ended or makes no progress; [`ProbedHit::ended`] tells which.
    ///
    /// # Errors
    /// The device fails.
    pub fn rays(&self, rays: &[ProbeRay]) -> Result<Vec<ProbedHit>, RenderError> {
        let leaves_surface = rays.iter().any(|ray| ray.normal.is_some());
        let inputs: Vec<_> = rays
            .iter()
            .flat_map(|ray| {
                let word = |v: DVec3, w: f64| v.as_vec3().extend(w as f32).to_array();
                let [near, far] = ray.limits.map(|t| t + ray.gone);
                let normal = ray.normal.unwrap_or_default();
                [self.relative(ray.origin, ray.gone), word(ray.direction, far), word(normal, near)]
            })
            .collect();
        let mut words = vec![0; rays.len() * MARCH_WORDS];
        words.iter_mut().skip(ENDED_WORD).step_by(MARCH_WORDS).for_each(|word| *word = NOT_BEGUN);
        let results = self.results(&words);
        loop {
            self.dispatch(&self.probe.ray, &inputs, rays.len(), leaves_surface, &results);
            let now = read_words(self.gpu, results.buffer(), words.len())?;
            let before = std::mem::replace(&mut words, now);
            // Counters change in every dispatch. A march that has ended, or that cannot proceed, stays the same.
            let marches = |words: &[u32]| -> Vec<u32> {
                words.chunks_exact(MARCH_WORDS).flat_map(|march| march[..=ENDED_WORD].to_vec()).collect()
            };
            if marches(&words) == marches(&before) {
                break;
            }
        }
        let read = |(ray, words): (&ProbeRay, &[u32; MARCH_WORDS])| ProbedHit {
            hit: (words[1] != u32::MAX).then(|| (f64::from(f32::from_bits(words[0])) - ray.gone, words[1])),
            evaluations: words[8],
            visits: words[9],
            ended: words[ENDED_WORD] == 1,
        };
        Ok(rays.iter().zip(words.as_chunks().0).map(read).collect())
    }

    /// A point relative to the origin of the query, with a fourth component.
    fn relative(&self, p: DVec3, w: f64) -> [f32; 4] {
        (p - self.origin).as_vec3().extend(w as f32).to_array()
    }

    fn results(&self, words: &[u32]) -> SyncedBuffer {
        let mut buffer = SyncedBuffer::read_back(&self.gpu.device, "scene probe");
        buffer.set(&self.gpu.device, &self.gpu.queue, bytemuck::cast_slice(words));
        buffer
    }

    fn dispatch(
        &self,
        pipeline: &ComputePipeline,
        inputs: &[[f32; 4]],
        count: usize,
        leaves_surface: bool,
        results: &SyncedBuffer,
    ) {
        let Gpu { device, queue, .. } = self.gpu;
        let mut settings = SyncedBuffer::uniform(device, "scene probe");
        settings.set(device, queue, bytemuck::cast_slice(&[count as u32, u32::from(leaves_surface), 0, 0]));
        let mut queries = SyncedBuffer::storage(device, "scene probe");
        queries.set(device, queue, bytemuck::cast_slice(inputs));
        let own = [settings.binding(), queries.binding(), results.binding()];
        let own = bind(device, "scene probe", &self.probe.own, &own);
        let [view, scene, hierarchy] = &self.groups;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, view, &[]);
            pass.set_bind_group(1, scene, &[0, 0]);
            pass.set_bind_group(2, &own, &[]);
            pass.set_bind_group(3, hierarchy, &[]);
            pass.dispatch_workgroups((count as u32).div_ceil(64), 1, 1);
        }
        queue.submit([encoder.finish()]);
    }
}
