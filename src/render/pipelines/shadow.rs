//! Pipelines of the pass `shadow`. A window has them built beside its frames, which show no shadows until then: a driver
//! takes seconds for them.

use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;

use wgpu::{BindGroupLayout, ComputePipeline};

use super::prewarm::Prewarmer;
use crate::gpu::Gpu;
use crate::recipe::Pass;
use crate::resources::buffers::SyncedBuffer;
use crate::resources::hierarchy::{HierarchyBuffers, Obstacles};
use crate::resources::layouts::*;
use crate::resources::shadows::{SHADOW_PARTS, ShadowSettings};
use crate::resources::targets::Targets;
use crate::resources::uniforms::DispatchParams;
use isolith_field::FlatScene;
use isolith_guard::guarded;
use isolith_wgsl::{Evaluator, OpSet, Options, SCENE_COPIES, ShaderError, assemble_with};

bindings! {
    /// Group 2.
    ShadowBindings, "shadow targets", COMPUTE {
        depth: read_texture(false),
        normal: read_texture(false),
        lights: read_storage(),
        shares: write_storage(),
        states: write_storage(),
        unfinished: write_storage(),
        settings: uniform(false),
        dispatch: uniform(true),
    }
}

/// Entry points of the parts: shadows, occlusion, and shadows with rays to the environment, which a picture of something
/// that moves has not.
const ENTRY_POINTS: [&str; SHADOW_PARTS] = ["shadow", "shadow_occlusion", "shadow"];
/// The part with rays to the environment.
const WITH_RAYS: usize = 2;

/// What pipelines depend on: they serve all scenes within a set of operations.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowKind {
    ops: OpSet,
    by_tapes: bool,
    /// What casts shadows besides components.
    pub obstacles: Obstacles,
    /// Whether light passes some of them.
    veiled: bool,
}

/// The pipelines of a kind, one for each part; each is built when a scene first uses it.
#[derive(Debug)]
pub struct ShadowPipelines {
    /// What they serve.
    pub kind: ShadowKind,
    /// The pipelines.
    pub pipelines: [Option<ComputePipeline>; SHADOW_PARTS],
}

impl ShadowKind {
    /// The kind for a scene. `by_tapes`: whether all components have tapes.
    pub fn of(flat: &FlatScene, by_tapes: bool, obstacles: Obstacles) -> Self {
        Self { ops: OpSet::of(flat), by_tapes, obstacles, veiled: flat.veiled().contains(&true) }
    }

    /// Whether pipelines of this kind serve the other, and know little besides.
    pub fn serves(&self, other: &Self) -> bool {
        let alike = |kind: &Self| (kind.by_tapes, kind.obstacles, kind.veiled);
        alike(self) == alike(other) && self.ops.covers(&other.ops) && self.ops.is_near(&other.ops)
    }

    /// Builds the pipeline of a part.
    ///
    /// # Errors
    /// A shader file is missing.
    pub fn build(
        &self,
        device: &wgpu::Device,
        layouts: &Layouts,
        [own, queried]: [&BindGroupLayout; 2],
        part: usize,
        options: Options,
    ) -> Result<ComputePipeline, ShaderError> {
        let Obstacles { meshes, copies } = self.obstacles;
        let features = [
            (meshes, "MESH_RAYS"),
            (copies, SCENE_COPIES),
            (self.veiled, "VEILS"),
            (part == WITH_RAYS, "AMBIENT_RAYS"),
        ];
        let features: Vec<&str> =
            features.into_iter().filter_map(|(is_on, feature)| is_on.then_some(feature)).collect();
        let ops = self.ops.clone();
        let evaluator = if self.by_tapes { Evaluator::Tape(ops) } else { Evaluator::Interpreter(ops) };
        let text = assemble_with(Pass::Shadow.file(), &evaluator, options, &features)?;
        let groups = [&layouts.view, &layouts.scene, own, queried];
        Ok(compute_pipeline(device, Pass::Shadow.label(), text, ENTRY_POINTS[part], &groups))
    }
}

/// Builds pipelines in a thread, one kind after the other.
#[derive(Debug, Default)]
pub struct ShadowOrders {
    order: Option<(ShadowKind, [bool; SHADOW_PARTS])>,
    finished: Option<Receiver<Result<ShadowPipelines, String>>>,
    thread: Option<JoinHandle<()>>,
}

impl ShadowOrders {
    /// Whether pipelines are being built.
    pub fn is_building(&self) -> bool {
        self.finished.is_some()
    }

    /// Has the used parts of a kind built, unless others are.
    pub fn order(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        kind: &ShadowKind,
        used: [bool; SHADOW_PARTS],
        options: Options,
    ) {
        if self.is_building() {
            return;
        }
        let (finish, finished) = channel();
        let (gpu, layouts, of) = (gpu.clone(), layouts.clone(), kind.clone());
        let work = move || {
            let built = guarded(|| build_beside(&gpu, &layouts, of, used, options)).unwrap_or_else(Err);
            // Without a receiver nobody wants them any more.
            let _ = finish.send(built);
        };
        self.order = Some((kind.clone(), used));
        self.finished = Some(finished);
        self.thread = std::thread::Builder::new().name("shadow pipelines".into()).spawn(work).ok();
    }

    /// The pipelines that have become ready, or why they could not be built.
    pub fn collect(&mut self) -> Option<Result<ShadowPipelines, String>> {
        let built = match self.finished.as_ref()?.try_recv() {
            Ok(built) => built,
            Err(std::sync::mpsc::TryRecvError::Empty) => return None,
            Err(std::sync::mpsc::TryRecvError::Disconnected) => Err("the thread has panicked".into()),
        };
        self.finished = None;
        self.join();
        Some(built)
    }

    /// Whether a kind was ordered and could not be built: frames then build it themselves, and report why not.
    pub fn has_failed(&self, kind: &ShadowKind, used: [bool; SHADOW_PARTS]) -> bool {
        !self.is_building() && self.order.as_ref().is_some_and(|(of, parts)| of == kind && *parts == used)
    }

    fn join(&mut self) {
        if let Some(thread) = self.thread.take() {
            // A thread that has panicked has also finished.
            let _ = thread.join();
        }
    }
}

/// Waits for the pipeline that is being built: a driver that still compiles when the program ends crashes.
impl Drop for ShadowOrders {
    fn drop(&mut self) {
        self.join();
    }
}

fn build_beside(
    gpu: &Gpu,
    layouts: &Layouts,
    kind: ShadowKind,
    used: [bool; SHADOW_PARTS],
    options: Options,
) -> Result<ShadowPipelines, String> {
    if gpu.is_software() {
        // A software driver compiles at the first dispatch; the result stays in its cache.
        meet_elsewhere(gpu, &kind, used, options)?;
    }
    let own = ShadowBindings::layout(&gpu.device);
    let queried = HierarchyBuffers::layout(&gpu.device, kind.obstacles);
    let build = |part: usize| match used[part] {
        true => kind.build(&gpu.device, layouts, [&own, &queried], part, options).map(Some),
        false => Ok(None),
    };
    let [lights, cones, rays] = [0, 1, 2].map(|part| build(part).map_err(|error| error.to_string()));
    Ok(ShadowPipelines { kind, pipelines: [lights?, cones?, rays?] })
}

/// Dispatches the pipelines over nothing, on a device of their own.
fn meet_elsewhere(gpu: &Gpu, kind: &ShadowKind, used: [bool; SHADOW_PARTS], options: Options) -> Result<(), String> {
    let prewarmer = Prewarmer::new(gpu, options).map_err(|error| error.to_string())?;
    let (gpu, layouts) = prewarmer.device();
    let device = &gpu.device;
    // A dispatch must not read a buffer that it writes, so each binding has its own buffer.
    let zeros: Vec<SyncedBuffer> = (0..12)
        .map(|_| {
            let mut buffer = SyncedBuffer::rows(device, "prewarm");
            buffer.set(device, &gpu.queue, &[0; 4096]);
            buffer
        })
        .collect();
    let targets = Targets::new(device, [24, 24]);
    let own_layout = ShadowBindings::layout(device);
    let own = ShadowBindings {
        depth: targets.depth.binding(),
        normal: targets.normal.binding(),
        lights: zeros[0].binding(),
        shares: zeros[1].binding(),
        states: zeros[2].binding(),
        unfinished: zeros[3].binding(),
        settings: window(zeros[4].buffer(), size_of::<ShadowSettings>()),
        dispatch: window(zeros[5].buffer(), size_of::<DispatchParams>()),
    };
    let own = own.bind(device, &own_layout);
    let queried = HierarchyBuffers::layout(device, kind.obstacles);
    let Obstacles { meshes, copies } = kind.obstacles;
    let held = [true, true, true, meshes, copies, copies];
    let entries: Vec<_> = (0..)
        .zip(held)
        .filter(|(_, is_held)| *is_held)
        .map(|(binding, _)| wgpu::BindGroupEntry { binding, resource: zeros[6 + binding as usize].binding() })
        .collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("prewarm"), layout: &queried, entries: &entries };
    let hierarchy = device.create_bind_group(&descriptor);
    for part in (0..used.len()).filter(|part| used[*part]) {
        let pipeline = kind.build(device, layouts, [&own_layout, &queried], part, options);
        let pipeline = pipeline.map_err(|error| error.to_string())?;
        prewarmer.meet_shadow(&pipeline, &own, &hierarchy).map_err(|error| error.to_string())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_gallery as gallery;

    #[test]
    fn pipelines_are_built_beside_for_every_kind_of_scene() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let layouts = Layouts::new(&gpu.device);
        let flat = isolith_field::flatten(&gallery::random(4, 1), 0.0).expect("within the limits");
        let mut orders = ShadowOrders::default();
        for (meshes, copies, by_tapes) in [(false, false, true), (true, true, false)] {
            let kind = ShadowKind::of(&flat, by_tapes, Obstacles { meshes, copies });
            assert!(orders.collect().is_none() && !orders.has_failed(&kind, [true; SHADOW_PARTS]));
            orders.order(&gpu, &layouts, &kind, [true; SHADOW_PARTS], Options::default());
            assert!(orders.is_building());
            let built = loop {
                if let Some(built) = orders.collect() {
                    break built;
                }
                std::thread::sleep(std::time::Duration::from_millis(20));
            };
            let built = built.unwrap_or_else(|reason| panic!("{kind:?}: {reason}"));
            assert!(built.pipelines.iter().all(Option::is_some) && built.kind.serves(&kind));
            gpu.check().unwrap_or_else(|error| panic!("{error}"));
        }
    }
}
