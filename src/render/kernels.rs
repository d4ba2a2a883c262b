//! Which kernel evaluates which component: the interpreter at once, a specialised one as soon as it is
//! built. Equal structures share a kernel; nobody ever waits for one unless asked to.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::gpu::Gpu;
use super::kernel::{Evaluator, Features, Options, ShaderError, Structure};
use super::layouts::Layouts;
use super::passes::field::{FieldLayouts, Kernel};
use super::warm::Warmer;
use crate::flat::FlatScene;

/// How components are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Specialised kernels where they are ready, built in the background; the interpreter until then.
    #[default]
    Auto,
    /// The interpreter for everything.
    Interpreted,
    /// Specialised kernels for everything that is not too large for one; waits until they are built.
    Specialised,
}

/// Most specialised kernels that are kept; the least recently used go first.
pub const MAX_KERNELS: usize = 1024;

/// See the module.
#[derive(Debug)]
pub struct Kernels {
    shared: Arc<Shared>,
    interpreter: Arc<Kernel>,
    features: Features,
    specialised: HashMap<u128, Slot>,
    worker: Option<Worker>,
    clock: u64,
    built: u32,
    failures: Vec<String>,
}

/// What the worker needs too.
#[derive(Debug)]
struct Shared {
    gpu: Gpu,
    layouts: Layouts,
    field: FieldLayouts,
    options: Options,
}

#[derive(Debug)]
struct Slot {
    state: State,
    used: u64,
}

#[derive(Debug)]
enum State {
    Building,
    Ready(Arc<Kernel>),
    Failed,
}

/// The kernel of a component.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Its pipelines.
    pub kernel: Arc<Kernel>,
    /// Whether it knows the component's structure.
    pub specialised: bool,
}

type Finished = (u128, Result<Kernel, String>);

#[derive(Debug)]
struct Worker {
    orders: Option<Sender<(u128, Structure)>>,
    finished: Receiver<Finished>,
    waiting: usize,
    is_unwanted: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Kernels {
    /// The interpreter, for no shapes yet.
    pub fn new(gpu: &Gpu, layouts: &Layouts, options: Options) -> Result<Self, ShaderError> {
        let field = FieldLayouts::new(&gpu.device);
        let features = Features { shapes: [].into(), stack: 1 };
        let evaluator = Evaluator::Interpreted(features.clone());
        let interpreter = Arc::new(field.build(&gpu.device, layouts, &evaluator, options)?);
        let shared = Arc::new(Shared { gpu: gpu.clone(), layouts: layouts.clone(), field, options });
        Ok(Self {
            shared,
            interpreter,
            features,
            specialised: HashMap::new(),
            worker: None,
            clock: 0,
            built: 0,
            failures: Vec::new(),
        })
    }

    /// Layouts of the field passes.
    pub fn field(&self) -> &FieldLayouts {
        &self.shared.field
    }

    /// Kernels built so far.
    pub fn built(&self) -> u32 {
        self.built
    }

    /// How many kernels are being built.
    pub fn building(&self) -> usize {
        self.worker.as_ref().map_or(0, |w| w.waiting)
    }

    /// What went wrong since the last call; the interpreter goes on.
    pub fn take_failures(&mut self) -> Vec<String> {
        std::mem::take(&mut self.failures)
    }

    /// Takes over what the worker has finished. True if there was anything.
    pub fn collect(&mut self) -> bool {
        let Some(worker) = &mut self.worker else { return false };
        let finished: Vec<Finished> = worker.finished.try_iter().collect();
        worker.waiting -= finished.len();
        let any = !finished.is_empty();
        for (key, result) in finished {
            self.store(key, result);
        }
        any
    }

    /// Kernels that have become ready since `choices` were made, put in their place.
    pub fn refresh(&mut self, flat_keys: &[Option<u128>], choices: &mut [Choice]) {
        for (key, choice) in flat_keys.iter().zip(choices) {
            let Some(Slot { state: State::Ready(kernel), .. }) = key.and_then(|k| self.specialised.get(&k)) else {
                continue;
            };
            *choice = Choice { kernel: kernel.clone(), specialised: true };
        }
    }

    /// The key of each component's structure; `None` where it gets no kernel of its own.
    pub fn keys(flat: &FlatScene, method: Method) -> Vec<Option<u128>> {
        let key = |c| if method == Method::Interpreted { None } else { Structure::key(flat, c) };
        flat.components.iter().map(key).collect()
    }

    /// The kernel for each component; `keys` from [`Kernels::keys`].
    pub fn choose(
        &mut self,
        flat: &FlatScene,
        keys: &[Option<u128>],
        method: Method,
    ) -> Result<Vec<Choice>, ShaderError> {
        self.collect();
        self.clock += 1;
        let mut choices = Vec::with_capacity(flat.components.len());
        let mut needs_interpreter = false;
        for (component, key) in flat.components.iter().zip(keys) {
            let ready = match *key {
                None => None,
                Some(key) => self.specialised(key, method, || Structure::of(flat, component)),
            };
            needs_interpreter |= ready.is_none();
            choices.push(ready);
        }
        if needs_interpreter {
            self.learn_features(flat)?;
        }
        self.forget_oldest();
        let interpreted = Choice { kernel: self.interpreter.clone(), specialised: false };
        Ok(choices
            .into_iter()
            .map(|ready| ready.map_or(interpreted.clone(), |kernel| Choice { kernel, specialised: true }))
            .collect())
    }

    fn specialised(
        &mut self,
        key: u128,
        method: Method,
        structure: impl FnOnce() -> Option<Structure>,
    ) -> Option<Arc<Kernel>> {
        if let Some(slot) = self.specialised.get_mut(&key) {
            slot.used = self.clock;
            match &slot.state {
                State::Ready(kernel) => return Some(kernel.clone()),
                State::Failed => return None,
                State::Building if method == Method::Auto => return None,
                State::Building => {}
            }
        }
        let structure = structure()?;
        if method == Method::Specialised {
            let result = build(&self.shared, &structure);
            self.store(key, result);
            return match &self.specialised.get(&key)?.state {
                State::Ready(kernel) => Some(kernel.clone()),
                _ => None,
            };
        }
        self.specialised.insert(key, Slot { state: State::Building, used: self.clock });
        let shared = self.shared.clone();
        let worker = self.worker.get_or_insert_with(|| Worker::start(shared));
        worker.waiting += 1;
        // A worker that is gone leaves everything to the interpreter.
        if let Some(orders) = &worker.orders {
            let _ = orders.send((key, structure));
        }
        None
    }

    fn store(&mut self, key: u128, result: Result<Kernel, String>) {
        self.built += 1;
        let state = match result {
            Ok(kernel) => State::Ready(Arc::new(kernel)),
            Err(reason) => {
                self.failures.push(reason);
                State::Failed
            }
        };
        self.specialised.insert(key, Slot { state, used: self.clock });
    }

    fn learn_features(&mut self, flat: &FlatScene) -> Result<(), ShaderError> {
        let wanted = Features::of(flat);
        if !self.features.covers(&wanted) {
            // Only ever more: going back and forth between scenes builds nothing twice.
            let features = self.features.union(&wanted);
            let evaluator = Evaluator::Interpreted(features.clone());
            let Shared { gpu, layouts, field, options } = &*self.shared;
            self.interpreter = Arc::new(field.build(&gpu.device, layouts, &evaluator, *options)?);
            self.features = features;
            self.built += 1;
        }
        Ok(())
    }

    fn forget_oldest(&mut self) {
        while self.specialised.len() > MAX_KERNELS {
            let ready = self.specialised.iter().filter(|(_, slot)| !matches!(slot.state, State::Building));
            let Some(oldest) = ready.min_by_key(|(_, slot)| slot.used).map(|(key, _)| *key) else { return };
            if self.specialised[&oldest].used == self.clock {
                return;
            }
            self.specialised.remove(&oldest);
        }
    }
}

impl Worker {
    fn start(shared: Arc<Shared>) -> Self {
        let (orders, ordered) = channel::<(u128, Structure)>();
        let (finish, finished) = channel();
        let is_unwanted = Arc::new(AtomicBool::new(false));
        let should_end = is_unwanted.clone();
        let work = move || {
            // A driver that computes on the processor compiles at the first dispatch, in the queue's own
            // thread: a device of the worker's own takes that time, and leaves the result in the driver's cache.
            let warmer = if shared.gpu.is_software() { Warmer::new(shared.options).ok() } else { None };
            for (key, structure) in ordered {
                if should_end.load(Ordering::Relaxed) {
                    return;
                }
                if let Some(warmer) = &warmer {
                    warmer.warm(&structure);
                }
                if finish.send((key, build(&shared, &structure))).is_err() {
                    return;
                }
            }
        };
        // Without a thread the orders stay where they are, and the interpreter goes on.
        let thread = std::thread::Builder::new().name("kernels".into()).spawn(work).ok();
        Self { orders: Some(orders), finished, waiting: 0, is_unwanted, thread }
    }
}

/// Waits for the kernel that is being built: a driver that is compiling while the program ends crashes.
impl Drop for Worker {
    fn drop(&mut self) {
        self.is_unwanted.store(true, Ordering::Relaxed);
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // A worker that has panicked has nothing left to do either.
            let _ = thread.join();
        }
    }
}

/// Builds a kernel; what the driver or the validation has against it comes back in words.
fn build(shared: &Shared, structure: &Structure) -> Result<Kernel, String> {
    let device = &shared.gpu.device;
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let evaluator = Evaluator::Specialised(structure.clone());
    let built = shared.field.build(device, &shared.layouts, &evaluator, shared.options);
    let complaint = pollster::block_on(scope.pop());
    match (built, complaint) {
        (Ok(kernel), None) => Ok(kernel),
        (Err(error), _) => Err(error.to_string()),
        (_, Some(error)) => Err(format!("a kernel could not be built, the interpreter goes on: {error}")),
    }
}
