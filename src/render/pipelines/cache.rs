//! The pipeline that evaluates each component: the interpreter at once, a specialized pipeline as soon as it is built.
//! Equal structures share a pipeline. No frame waits for a pipeline unless the strategy demands it.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::evaluators::tape_evaluators;
use crate::gpu::Gpu;
use crate::pipelines::field::{FieldLayouts, FieldPipelines};
use crate::pipelines::key::{PipelineKey, Templates};
use crate::pipelines::prewarm::Prewarmer;
use crate::pipelines::strategy::EvalStrategy;
use crate::resources::layouts::Layouts;
use isolith_field::FlatScene;
use isolith_guard::guarded;
use isolith_wgsl::{Evaluator, OpSet, Options, ShaderError, Veil};

/// Limit of cached specialized pipelines. The cache evicts the least recently used first.
pub const MAX_PIPELINES: usize = 1024;

/// Pipeline cache, see the module.
#[derive(Debug)]
pub struct PipelineCache {
    shared: Arc<CompileContext>,
    interpreters: Vec<InterpreterPipelines>,
    templates: Templates,
    specialized: HashMap<u128, CachedPipelines>,
    worker: Option<CompileWorker>,
    clock: u64,
    built: u32,
    failures: Vec<String>,
}

/// Limit of cached interpreter pipelines for scenes with other shapes.
const MAX_INTERPRETERS: usize = 8;

/// Interpreter pipelines for scenes with a certain set of operations.
#[derive(Debug)]
struct InterpreterPipelines {
    ops: OpSet,
    /// For each of [`WALKED`]: built when needed.
    walked: [WalkedPipelines; WALKED.len()],
}

/// Kinds of pipelines that walk: whether for types of instancers, and what rays may pass.
const WALKED: [(bool, Veil); 6] = [
    (false, Veil::None),
    (true, Veil::None),
    (false, Veil::Plain),
    (true, Veil::Plain),
    (false, Veil::Textured),
    (true, Veil::Textured),
];

/// What rays may pass of a scene.
pub fn veil_of(flat: &FlatScene) -> Veil {
    match flat.veiled().contains(&true) {
        false => Veil::None,
        true if flat.has_opacity_textures() => Veil::Textured,
        true => Veil::Plain,
    }
}

/// Pipelines that walk through entries or tapes.
#[derive(Debug, Default)]
struct WalkedPipelines {
    entries: Option<Arc<FieldPipelines>>,
    tape: Option<Arc<FieldPipelines>>,
    /// The tape evaluator for components with modifiers.
    tape_modified: Option<Arc<FieldPipelines>>,
}

/// State that the cache shares with the worker.
#[derive(Debug)]
struct CompileContext {
    gpu: Gpu,
    layouts: Layouts,
    field: FieldLayouts,
    options: Options,
}

#[derive(Debug)]
struct CachedPipelines {
    state: PipelineState,
    used: u64,
}

#[derive(Debug)]
enum PipelineState {
    Building,
    Ready(Arc<FieldPipelines>),
    Failed,
}

/// The pipelines chosen for a component.
#[derive(Clone, Debug)]
pub struct PipelineChoice {
    /// The pipelines.
    pub pipelines: Arc<FieldPipelines>,
    /// How these pipelines evaluate the component.
    pub mode: EvalMode,
}

/// How pipelines evaluate a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvalMode {
    /// Loop over all entries of the subtree-extent array.
    Interpreter,
    /// Loop over the tape of a cell.
    Tape,
    /// Straight-line code of the component's structure or template.
    StraightLine,
}

/// A pipeline to build: its key, its evaluator, and whether it is for types of instancers.
type PipelineOrder = (u128, Evaluator, bool);
type FinishedBuild = (u128, Result<FieldPipelines, String>);

#[derive(Debug)]
struct CompileWorker {
    orders: Option<Sender<PipelineOrder>>,
    finished: Receiver<FinishedBuild>,
    waiting: usize,
    is_unwanted: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl PipelineCache {
    /// Options of all pipelines; the features of scenes are not among them.
    pub fn options(&self) -> Options {
        self.shared.options
    }

    /// A cache with an interpreter that knows no shapes yet.
    pub fn new(gpu: &Gpu, layouts: &Layouts, options: Options) -> Result<Self, ShaderError> {
        let field = FieldLayouts::new(&gpu.device);
        let ops = OpSet::none();
        let evaluator = Evaluator::Interpreter(ops.clone());
        let entries = Some(Arc::new(field.build(&gpu.device, layouts, &evaluator, options)?));
        let plain = WalkedPipelines { entries, ..WalkedPipelines::default() };
        let mut walked: [WalkedPipelines; WALKED.len()] = Default::default();
        walked[0] = plain;
        let interpreters = vec![InterpreterPipelines { ops, walked }];
        let shared = Arc::new(CompileContext { gpu: gpu.clone(), layouts: layouts.clone(), field, options });
        Ok(Self {
            shared,
            interpreters,
            templates: Templates::default(),
            specialized: HashMap::new(),
            worker: None,
            clock: 0,
            built: 0,
            failures: Vec::new(),
        })
    }

    /// Bind group layouts of the field passes.
    pub fn field(&self) -> &FieldLayouts {
        &self.shared.field
    }

    /// Number of pipelines built so far.
    pub fn built(&self) -> u32 {
        self.built
    }

    /// Loops in the interpreter's code, see [`OpSet::loops`].
    pub fn loops(&self) -> u32 {
        self.interpreters.first().map_or(0, |interpreter| interpreter.ops.loops())
    }

    /// Number of pipelines that are being built.
    pub fn building(&self) -> usize {
        self.worker.as_ref().map_or(0, |w| w.waiting)
    }

    /// Number of pipelines that failed to build; the interpreter or tapes draw in their place.
    pub fn failed(&self) -> usize {
        self.specialized.values().filter(|slot| matches!(slot.state, PipelineState::Failed)).count()
    }

    /// Takes the errors since the last call. The interpreter keeps drawing.
    pub fn take_failures(&mut self) -> Vec<String> {
        std::mem::take(&mut self.failures)
    }

    /// Collects the pipelines that the worker has finished. Returns true if there were any.
    pub fn collect(&mut self) -> bool {
        let Some(worker) = &mut self.worker else { return false };
        let finished: Vec<FinishedBuild> = worker.finished.try_iter().collect();
        worker.waiting -= finished.len();
        let any = !finished.is_empty();
        for (key, result) in finished {
            self.store(key, result);
        }
        any
    }

    /// Replaces `choices` with pipelines that have become ready since.
    pub fn refresh(&mut self, keys: &[Option<PipelineKey>], choices: &mut [PipelineChoice]) {
        for (key, choice) in keys.iter().zip(choices) {
            let Some(CachedPipelines { state: PipelineState::Ready(pipelines), .. }) =
                key.and_then(|k| self.specialized.get(&k.bits))
            else {
                continue;
            };
            *choice = PipelineChoice { pipelines: pipelines.clone(), mode: EvalMode::StraightLine };
        }
    }

    /// The pipeline key of each component; `None` if it gets no pipeline of its own. `lengths`: mean tape length of
    /// each component, where its tapes are ready.
    pub fn keys(
        &mut self,
        flat: &FlatScene,
        strategy: EvalStrategy,
        lengths: &[Option<f64>],
    ) -> Vec<Option<PipelineKey>> {
        self.templates.keys(flat, strategy, lengths)
    }

    /// Chooses the pipeline of each component. `keys` come from [`PipelineCache::keys`]; `has_tapes` tells which
    /// components have tapes. The worker builds the pipelines of components that come first in `order` first.
    pub fn choose(
        &mut self,
        flat: &FlatScene,
        keys: &[Option<PipelineKey>],
        strategy: EvalStrategy,
        has_tapes: &[bool],
        order: &[usize],
    ) -> Result<Vec<PipelineChoice>, ShaderError> {
        self.collect();
        self.clock += 1;
        let mut choices = vec![None; flat.components.len()];
        for (index, key) in order.iter().filter_map(|i| Some((*i, keys[*i]?))) {
            let component = &flat.components[index];
            choices[index] = self.specialized(key, strategy, || key.evaluator(flat, component, strategy));
        }
        let by_tape = |i: usize| strategy != EvalStrategy::Interpreter && has_tapes.get(i) == Some(&true);
        let open: Vec<usize> = (0..choices.len()).filter(|i| choices[*i].is_none()).collect();
        let (veiled, veil) = (flat.veiled(), veil_of(flat));
        let kind_of = |i: usize| {
            let veil = if veiled.get(i) == Some(&true) { veil } else { Veil::None };
            let kind = (flat.components[i].instanced.is_some(), veil);
            WALKED.iter().position(|walked| *walked == kind).expect("all kinds are there")
        };
        if !open.is_empty() {
            let needs = |kind: usize| {
                let of_kind = || open.iter().filter(|i| kind_of(**i) == kind);
                let tapes =
                    |modified: bool| of_kind().any(|i| by_tape(*i) && flat.components[*i].is_modified() == modified);
                [of_kind().next().is_some(), tapes(false), tapes(true)]
            };
            self.choose_interpreter(flat, std::array::from_fn(needs))?;
        }
        self.forget_oldest();
        let interpreter = &self.interpreters[0];
        let walked = |i: usize| {
            let WalkedPipelines { entries, tape, tape_modified } = &interpreter.walked[kind_of(i)];
            let tape = if flat.components[i].is_modified() { tape_modified } else { tape };
            match tape {
                Some(pipelines) if by_tape(i) => PipelineChoice { pipelines: pipelines.clone(), mode: EvalMode::Tape },
                _ => {
                    let pipelines = entries.clone().expect("built for every open component");
                    PipelineChoice { pipelines, mode: EvalMode::Interpreter }
                }
            }
        };
        let ready = |pipelines| PipelineChoice { pipelines, mode: EvalMode::StraightLine };
        Ok(choices.into_iter().enumerate().map(|(i, own)| own.map_or_else(|| walked(i), ready)).collect())
    }

    fn specialized(
        &mut self,
        PipelineKey { bits: key, copies, .. }: PipelineKey,
        strategy: EvalStrategy,
        evaluator: impl FnOnce() -> Option<Evaluator>,
    ) -> Option<Arc<FieldPipelines>> {
        if let Some(slot) = self.specialized.get_mut(&key) {
            slot.used = self.clock;
            match &slot.state {
                PipelineState::Ready(pipelines) => return Some(pipelines.clone()),
                PipelineState::Failed => return None,
                PipelineState::Building if strategy == EvalStrategy::Auto => return None,
                PipelineState::Building => {}
            }
        }
        let evaluator = evaluator()?;
        if strategy != EvalStrategy::Auto {
            let result = build(&self.shared, &evaluator, copies);
            self.store(key, result);
            return match &self.specialized.get(&key)?.state {
                PipelineState::Ready(pipelines) => Some(pipelines.clone()),
                _ => None,
            };
        }
        self.specialized.insert(key, CachedPipelines { state: PipelineState::Building, used: self.clock });
        let shared = self.shared.clone();
        let worker = self.worker.get_or_insert_with(|| CompileWorker::start(shared));
        worker.waiting += 1;
        // If the worker has stopped, the interpreter draws everything.
        if let Some(orders) = &worker.orders {
            let _ = orders.send((key, evaluator, copies));
        }
        None
    }

    fn store(&mut self, key: u128, result: Result<FieldPipelines, String>) {
        self.built += 1;
        let state = match result {
            Ok(pipelines) => PipelineState::Ready(Arc::new(pipelines)),
            Err(reason) => {
                self.failures.push(reason);
                PipelineState::Failed
            }
        };
        self.specialized.insert(key, CachedPipelines { state, used: self.clock });
    }

    /// Moves interpreter pipelines to the front that know all shapes of the scene and few others. Every scene pays for
    /// all that its pipeline holds, because lavapipe executes every arm of a `switch`. `needs` tells for each kind of
    /// [`WALKED`] whether there are components, and some with tapes without, and with, modifiers.
    fn choose_interpreter(&mut self, flat: &FlatScene, needs: [[bool; 3]; WALKED.len()]) -> Result<(), ShaderError> {
        let wanted = OpSet::of(flat);
        let CompileContext { gpu, layouts, field, options } = &*self.shared;
        let build = |evaluator, (copies, veil)| {
            field.build(&gpu.device, layouts, &evaluator, Options { copies, veil, ..*options }).map(Arc::new)
        };
        let fits =
            |interpreter: &InterpreterPipelines| interpreter.ops.covers(&wanted) && interpreter.ops.is_near(&wanted);
        match self.interpreters.iter().position(fits) {
            Some(at) => self.interpreters[..=at].rotate_right(1),
            None => {
                self.interpreters.insert(0, InterpreterPipelines { ops: wanted, walked: Default::default() });
                self.interpreters.truncate(MAX_INTERPRETERS);
            }
        }
        let InterpreterPipelines { ops, walked } = &mut self.interpreters[0];
        let [plain, modified] = tape_evaluators(ops);
        for ((WalkedPipelines { entries, tape, tape_modified }, needed), kind) in
            walked.iter_mut().zip(needs).zip(WALKED)
        {
            let of_entries = Evaluator::Interpreter(ops.clone());
            let slots = [(entries, of_entries), (tape, plain.clone()), (tape_modified, modified.clone())];
            for ((slot, evaluator), _) in slots.into_iter().zip(needed).filter(|(_, needed)| *needed) {
                if slot.is_none() {
                    *slot = Some(build(evaluator, kind)?);
                    self.built += 1;
                }
            }
        }
        Ok(())
    }

    fn forget_oldest(&mut self) {
        while self.specialized.len() > MAX_PIPELINES {
            let ready = self.specialized.iter().filter(|(_, slot)| !matches!(slot.state, PipelineState::Building));
            let Some(oldest) = ready.min_by_key(|(_, slot)| slot.used).map(|(key, _)| *key) else { return };
            if self.specialized[&oldest].used == self.clock {
                return;
            }
            self.specialized.remove(&oldest);
        }
    }
}

impl CompileWorker {
    fn start(shared: Arc<CompileContext>) -> Self {
        let (orders, ordered) = channel::<PipelineOrder>();
        let (finish, finished) = channel();
        let is_unwanted = Arc::new(AtomicBool::new(false));
        let should_end = is_unwanted.clone();
        let work = move || {
            // A software driver compiles at the first dispatch, in the thread of the queue. The worker has a device of
            // its own, which takes that time and leaves the result in the driver's cache.
            let new_prewarmer = || guarded(|| Prewarmer::new(&shared.gpu, shared.options)).ok()?.ok();
            let prewarmer = if shared.gpu.is_software() { new_prewarmer() } else { None };
            for (key, evaluator, copies) in ordered {
                if should_end.load(Ordering::Relaxed) {
                    return;
                }
                if let Some(prewarmer) = &prewarmer {
                    // A failure is reported where the pipeline is built for use.
                    let _ = guarded(|| prewarmer.prewarm(&evaluator, copies));
                }
                let built = guarded(|| build(&shared, &evaluator, copies)).flatten();
                if finish.send((key, built)).is_err() {
                    return;
                }
            }
        };
        // Without a thread the orders stay queued, and the interpreter keeps drawing.
        let thread = std::thread::Builder::new().name("pipelines".into()).spawn(work).ok();
        Self { orders: Some(orders), finished, waiting: 0, is_unwanted, thread }
    }
}

/// Waits for the pipeline that is being built: a driver that still compiles when the program ends crashes.
impl Drop for CompileWorker {
    fn drop(&mut self) {
        self.is_unwanted.store(true, Ordering::Relaxed);
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // A worker that has panicked has also finished.
            let _ = thread.join();
        }
    }
}

/// Builds a pipeline. An error of the driver or of the validation is returned as text.
fn build(shared: &CompileContext, evaluator: &Evaluator, copies: bool) -> Result<FieldPipelines, String> {
    let device = &shared.gpu.device;
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let options = Options { copies, ..shared.options };
    let built = shared.field.build(device, &shared.layouts, evaluator, options);
    let complaint = pollster::block_on(scope.pop());
    match (built, complaint) {
        (Ok(pipelines), None) => Ok(pipelines),
        (Err(error), _) => Err(error.to_string()),
        (_, Some(error)) => Err(format!("a pipeline could not be built, the interpreter goes on: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_pipeline_is_counted_and_its_reason_is_told_once() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let layouts = Layouts::new(&gpu.device);
        let mut pipelines = PipelineCache::new(&gpu, &layouts, Options::default()).expect("an interpreter");
        assert_eq!(pipelines.failed(), 0);
        pipelines.store(7, Err("the driver refuses".into()));
        assert_eq!(pipelines.failed(), 1);
        assert_eq!(pipelines.take_failures(), ["the driver refuses"]);
        assert!(pipelines.take_failures().is_empty() && pipelines.failed() == 1, "it stays failed");
    }
}
