//! Measures one scene by one method: run time, evaluations, errors. Covers only the passes that find the visible
//! surface (depth, normal, material), not light.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;

use super::baseline::Baseline;
use super::row::BenchRow;
use crate::field::reference::image::{ReferenceImage, render_reference};
use crate::field::reference::trace::TraceError;
use crate::field::{Accuracy, FlatScene, FlattenError, GBuffer, HitTarget, flatten, flatten_whole};
use crate::geometry::Camera;
use crate::mesh::{MeshLibrary, TriangleMesh};
use crate::render::{Counts, EvalStrategy, Frame, Gpu, OverlaySettings, PixelCounts, RenderError, Renderer, Slot};
use crate::scene::Scene;
use crate::wgsl::{Options, Quality};

/// Why a measurement failed.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The scene is beyond a limit.
    #[error(transparent)]
    Scene(#[from] FlattenError),
    /// The renderer failed.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The ray that determines a view does not end.
    #[error(transparent)]
    View(#[from] TraceError),
    /// The reference renderer failed.
    #[error("{scene}: {error}")]
    Reference {
        /// The scene.
        scene: String,
        /// The node at which a ray did not end.
        error: TraceError,
    },
    /// A measurement is infinite or NaN.
    #[error(transparent)]
    NotFinite(#[from] super::row::NotFinite),
}

/// Maximum number of runs of a measurement.
const RUNS: usize = 7;
/// No further run starts once all runs together have taken this long.
const ENOUGH: Duration = Duration::from_millis(1500);

/// CPU time of all threads of the process so far.
#[cfg(unix)]
pub fn cpu_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Wall time since the first call, for systems without a clock for the process.
#[cfg(not(unix))]
pub fn cpu_time() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}

/// A scene to measure.
pub struct BenchScene {
    /// Its name.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// Its arrays.
    pub flat: FlatScene,
    /// Its meshes.
    pub meshes: Vec<Option<Arc<TriangleMesh>>>,
    /// The view.
    pub camera: Camera,
}

impl BenchScene {
    /// A scene with its default view in a square picture.
    ///
    /// # Errors
    /// The scene is beyond a limit.
    pub fn new(name: &str, scene: Scene, library: &mut MeshLibrary) -> Result<Self, BenchError> {
        let flat = flatten(&scene, 0.0)?;
        let (meshes, _) = flat.load_meshes(library);
        let camera = flat.default_camera(&meshes, 1.0);
        Ok(Self { name: name.to_owned(), scene, flat, meshes, camera })
    }
}

/// The reference of each scene, rendered once.
#[derive(Default)]
pub struct ReferenceCache {
    found: HashMap<(String, u32), Arc<ReferenceImage>>,
}

impl ReferenceCache {
    /// The reference of `bench_scene` at `size` pixels a side.
    ///
    /// # Errors
    /// A ray does not end.
    pub fn of(&mut self, bench_scene: &BenchScene, size: u32) -> Result<Arc<ReferenceImage>, BenchError> {
        let key = (bench_scene.name.clone(), size);
        if let Some(found) = self.found.get(&key) {
            return Ok(found.clone());
        }
        let made = render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [size, size], &|_| ())
            .map_err(|error| BenchError::Reference { scene: bench_scene.name.clone(), error })?;
        let made = Arc::new(made);
        self.found.insert(key, made.clone());
        Ok(made)
    }
}

/// Measurements on one device.
pub struct Bench {
    gpu: Gpu,
}

/// Results of the runs of one renderer.
struct Runs {
    cpu: Vec<Duration>,
    wall: Vec<Duration>,
    buffers: GBuffer,
    counts: Counts,
    pixels: PixelCounts,
}

impl Bench {
    /// Measurements on `gpu`.
    pub fn new(gpu: Gpu) -> Self {
        Self { gpu }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Measures `bench_scene` by `baseline`, with errors against `reference`.
    ///
    /// # Errors
    /// The scene is too large for this baseline, or the device fails.
    pub fn measure(
        &self,
        bench_scene: &BenchScene,
        baseline: Baseline,
        quality: Quality,
        size: u32,
        reference: &ReferenceImage,
    ) -> Result<BenchRow, BenchError> {
        let whole = if baseline.is_whole() { Some(flatten_whole(&bench_scene.scene, 0.0)?) } else { None };
        let flat = whole.as_ref().unwrap_or(&bench_scene.flat);
        let (strategy, timed) = self.quickest(bench_scene, flat, baseline, quality, size)?;
        let counted = self.run(bench_scene, flat, (baseline, strategy), quality, size, true)?;
        let error = Accuracy::against(&timed.buffers, flat, reference);
        let pixels = f64::from(size) * f64::from(size);
        let fields = (0..timed.buffers.leaf.len())
            .filter(|i| matches!(timed.buffers.hit_target(*i), HitTarget::Leaf(_)))
            .count();
        let Counts { steps, cone_steps, .. } = counted.counts;
        // The limit counts only its own evaluations.
        let cones = if baseline == Baseline::Limit { 0 } else { cone_steps };
        let ms = |times: &[Duration]| times.iter().map(|t| t.as_secs_f64() * 1e3).collect::<Vec<_>>();
        let (cpu, wall) = (ms(&timed.cpu), ms(&timed.wall));
        let row = BenchRow {
            scene: bench_scene.name.clone(),
            nodes: bench_scene.scene.nodes().len(),
            method: baseline.name().to_owned(),
            size,
            cpu_ms: median(&cpu),
            wall_ms: median(&wall),
            steps_per_px: steps as f64 / pixels,
            evals_per_px: (steps + cones + fields as u64) as f64 / pixels,
            surface_evals_per_px: fields as f64 / pixels,
            wrong_share: error.wrong_share(),
            grazing_share: error.grazing_share(),
            depth_p50: error.depth_p50,
            depth_p99: error.depth_p99,
            depth_max: error.depth_max,
            normal_p50: error.normal_p50,
            normal_p99: error.normal_p99,
            quality: quality.name().to_owned(),
            cpu_ms_spread: spread(&cpu),
            steps_p99: counted.pixels.steps().p99,
            steps_max: counted.pixels.steps().max,
            cells_per_px: counted.pixels.per_pixel(|counted| counted.cells),
            entries_per_px: counted.pixels.per_pixel(|counted| counted.entries),
        };
        row.check()?;
        Ok(row)
    }

    /// The fastest strategy of the baseline and the results of its runs.
    fn quickest(
        &self,
        bench_scene: &BenchScene,
        flat: &FlatScene,
        baseline: Baseline,
        quality: Quality,
        size: u32,
    ) -> Result<(EvalStrategy, Runs), BenchError> {
        let mut best: Option<(EvalStrategy, Runs)> = None;
        for strategy in baseline.strategies() {
            let runs = self.run(bench_scene, flat, (baseline, *strategy), quality, size, false)?;
            let time = |runs: &Runs| {
                let mut cpu = runs.cpu.clone();
                cpu.sort();
                cpu[cpu.len() / 2]
            };
            if best.as_ref().is_none_or(|(_, least)| time(&runs) < time(least)) {
                best = Some((*strategy, runs));
            }
        }
        Ok(best.expect("every baseline has a strategy"))
    }

    fn run(
        &self,
        bench_scene: &BenchScene,
        flat: &FlatScene,
        (baseline, strategy): (Baseline, EvalStrategy),
        quality: Quality,
        size: u32,
        counting: bool,
    ) -> Result<Runs, BenchError> {
        let options = Options { quality, counting, ..Renderer::options(&self.gpu) };
        let mut renderer = Renderer::with_options(&self.gpu, baseline.options(options))?;
        renderer.set_strategy(strategy);
        let begin = |renderer: &mut Renderer| {
            let overlay = OverlaySettings::default();
            let mut frame =
                renderer.begin(Slot::Full, flat, &bench_scene.meshes, &bench_scene.camera, [size, size], overlay)?;
            frame.skip_shading();
            Ok::<_, RenderError>(frame)
        };
        // Build pipelines and tapes and train the cost model before timing.
        renderer.estimate(flat, &bench_scene.camera, [size, size])?;
        while strategy == EvalStrategy::Auto && renderer.is_preparing() {
            std::thread::sleep(Duration::from_millis(5));
            renderer.estimate(flat, &bench_scene.camera, [size, size])?;
        }
        let mut frame = begin(&mut renderer)?;
        renderer.advance(&mut frame, Duration::MAX)?;
        let started = Instant::now();
        let (mut cpu, mut wall) = (Vec::new(), Vec::new());
        while cpu.is_empty() || (!counting && cpu.len() < RUNS && started.elapsed() < ENOUGH) {
            let (cpu_start, start);
            let mut next: Frame;
            if baseline == Baseline::Limit {
                next = begin(&mut renderer)?;
                renderer.advance(&mut next, Duration::MAX)?;
                renderer.gpu().wait().map_err(RenderError::from)?;
                renderer.forget_counts(&next);
                (cpu_start, start) = (cpu_time(), Instant::now());
                next = renderer.begin_limit(&next);
            } else {
                (cpu_start, start) = (cpu_time(), Instant::now());
                next = begin(&mut renderer)?;
            }
            renderer.advance(&mut next, Duration::MAX)?;
            cpu.push(cpu_time() - cpu_start);
            wall.push(start.elapsed());
            frame = next;
        }
        let counts = renderer.counts(&frame)?;
        Ok(Runs { cpu, wall, buffers: renderer.read(&frame)?, counts, pixels: renderer.pixel_counts(&frame)? })
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

fn spread(values: &[f64]) -> f64 {
    let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().reduce(pick).unwrap_or(0.0));
    high - low
}
