//! Which kernel evaluates which component: the interpreter at once, a specialised one as soon as it is
//! built. Equal structures share a kernel; nobody ever waits for one unless asked to.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::gpu::Gpu;
use super::kernel::{Evaluator, Features, Options, ShaderError, Structure};
use super::keys::{Forms, Key};
use super::layouts::Layouts;
use super::passes::field::{FieldLayouts, Kernel};
use super::warm::Warmer;
use crate::flat::{Component, FlatScene};
use crate::guard::guarded;

/// How components are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Specialised kernels for what is not too large for one, pruned lists for the rest; both are made in the
    /// background, and the interpreter draws until they are ready.
    #[default]
    Auto,
    /// The interpreter for everything.
    Interpreted,
    /// Pruned lists where a component has them, the interpreter for the rest; waits until they are made.
    Pruned,
    /// Specialised kernels for everything that is not too large for one; waits until they are built.
    Specialised,
    /// A kernel for each component with its numbers written into it, however large: what the benches compare with.
    Generated,
}

/// Most specialised kernels that are kept; the least recently used go first.
pub const MAX_KERNELS: usize = 1024;

/// See the module.
#[derive(Debug)]
pub struct Kernels {
    shared: Arc<Shared>,
    walkers: Vec<Walker>,
    forms: Forms,
    specialised: HashMap<u128, Slot>,
    worker: Option<Worker>,
    clock: u64,
    built: u32,
    failures: Vec<String>,
}

/// Most kernels for walking that are kept for scenes of other shapes.
const MAX_WALKERS: usize = 8;

/// Kernels that walk, for scenes with certain shapes.
#[derive(Debug)]
struct Walker {
    features: Features,
    interpreter: Arc<Kernel>,
    pruned: Option<Arc<Kernel>>,
    /// By pruned lists too, for components with modifiers.
    pruned_modified: Option<Arc<Kernel>>,
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
    /// How it goes about it.
    pub walk: Walk,
}

/// How a kernel goes through a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// All entries of the subtree-extent array.
    Entries,
    /// The pruned list of a cell.
    List,
    /// Straight on: the code is the component's structure.
    Straight,
}

type Finished = (u128, Result<Kernel, String>);

#[derive(Debug)]
struct Worker {
    orders: Option<Sender<(u128, Evaluator)>>,
    finished: Receiver<Finished>,
    waiting: usize,
    is_unwanted: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Kernels {
    /// The interpreter, for no shapes yet.
    pub fn new(gpu: &Gpu, layouts: &Layouts, options: Options) -> Result<Self, ShaderError> {
        let field = FieldLayouts::new(&gpu.device);
        let features = Features::none();
        let evaluator = Evaluator::Interpreted(features.clone());
        let interpreter = Arc::new(field.build(&gpu.device, layouts, &evaluator, options)?);
        let walkers = vec![Walker { features, interpreter, pruned: None, pruned_modified: None }];
        let shared = Arc::new(Shared { gpu: gpu.clone(), layouts: layouts.clone(), field, options });
        Ok(Self {
            shared,
            walkers,
            forms: Forms::default(),
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

    /// Loops in the code that walks, see [`Features::loops`].
    pub fn loops(&self) -> u32 {
        self.walkers.first().map_or(0, |walker| walker.features.loops())
    }

    /// How many kernels are being built.
    pub fn building(&self) -> usize {
        self.worker.as_ref().map_or(0, |w| w.waiting)
    }

    /// Kernels that could not be built; the interpreter or pruned lists draw in their place.
    pub fn failed(&self) -> usize {
        self.specialised.values().filter(|slot| matches!(slot.state, State::Failed)).count()
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
    pub fn refresh(&mut self, keys: &[Option<Key>], choices: &mut [Choice]) {
        for (key, choice) in keys.iter().zip(choices) {
            let Some(Slot { state: State::Ready(kernel), .. }) = key.and_then(|k| self.specialised.get(&k.bits)) else {
                continue;
            };
            *choice = Choice { kernel: kernel.clone(), walk: Walk::Straight };
        }
    }

    /// What each component's kernel is for; `None` where it gets none.
    pub fn keys(&mut self, flat: &FlatScene, method: Method) -> Vec<Option<Key>> {
        self.forms.keys(flat, method)
    }

    /// The kernel for each component; `keys` from [`Kernels::keys`], `has_lists` tells which components have pruned
    /// lists. Those that come first in `order` have their kernels ordered first.
    pub fn choose(
        &mut self,
        flat: &FlatScene,
        keys: &[Option<Key>],
        method: Method,
        has_lists: &[bool],
        order: &[usize],
    ) -> Result<Vec<Choice>, ShaderError> {
        self.collect();
        self.clock += 1;
        let mut choices = vec![None; flat.components.len()];
        for (index, key) in order.iter().filter_map(|i| Some((*i, keys[*i]?))) {
            let component = &flat.components[index];
            choices[index] = self.specialised(key.bits, method, || match (method, key.form) {
                (Method::Generated, _) => {
                    Some(Evaluator::Generated(Structure::whole(flat, component), component_rows(flat, component)))
                }
                (_, Some(shapes)) => Structure::form(flat, component, shapes).map(Evaluator::Specialised),
                _ => Structure::of(flat, component).map(Evaluator::Specialised),
            });
        }
        let prunes = |i: usize| method != Method::Interpreted && has_lists.get(i) == Some(&true);
        let open: Vec<usize> = (0..choices.len()).filter(|i| choices[*i].is_none()).collect();
        let needs_lists =
            |modified: bool| open.iter().any(|i| prunes(*i) && flat.components[*i].is_modified() == modified);
        if !open.is_empty() {
            self.choose_walker(flat, [false, true].map(needs_lists))?;
        }
        self.forget_oldest();
        let walker = &self.walkers[0];
        let pruned = |i: usize| {
            if flat.components[i].is_modified() { &walker.pruned_modified } else { &walker.pruned }
        };
        let walked = |i: usize| match pruned(i) {
            Some(kernel) if prunes(i) => Choice { kernel: kernel.clone(), walk: Walk::List },
            _ => Choice { kernel: walker.interpreter.clone(), walk: Walk::Entries },
        };
        let ready = |kernel| Choice { kernel, walk: Walk::Straight };
        Ok(choices.into_iter().enumerate().map(|(i, own)| own.map_or_else(|| walked(i), ready)).collect())
    }

    fn specialised(
        &mut self,
        key: u128,
        method: Method,
        evaluator: impl FnOnce() -> Option<Evaluator>,
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
        let evaluator = evaluator()?;
        if method != Method::Auto {
            let result = build(&self.shared, &evaluator);
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
            let _ = orders.send((key, evaluator));
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

    /// Puts the kernels first that walk and know all shapes of the scene, and not many more: what a kernel holds is
    /// paid for by every scene, because lavapipe executes every arm of a `switch`.
    /// `needs_lists` tells whether components without, and with, modifiers have some.
    fn choose_walker(&mut self, flat: &FlatScene, needs_lists: [bool; 2]) -> Result<(), ShaderError> {
        let wanted = Features::of(flat);
        let Shared { gpu, layouts, field, options } = &*self.shared;
        let build = |evaluator| field.build(&gpu.device, layouts, &evaluator, *options).map(Arc::new);
        let fits = |walker: &Walker| walker.features.covers(&wanted) && walker.features.is_near(&wanted);
        match self.walkers.iter().position(fits) {
            Some(at) => self.walkers[..=at].rotate_right(1),
            None => {
                let interpreter = build(Evaluator::Interpreted(wanted.clone()))?;
                self.walkers.insert(0, Walker { features: wanted, interpreter, pruned: None, pruned_modified: None });
                self.walkers.truncate(MAX_WALKERS);
                self.built += 1;
            }
        }
        let walker = &mut self.walkers[0];
        let plain = Features { modifiers: BTreeSet::new(), ..walker.features.clone() };
        let pruned = [(&mut walker.pruned, plain), (&mut walker.pruned_modified, walker.features.clone())];
        for ((slot, features), _) in pruned.into_iter().zip(needs_lists).filter(|(_, needed)| *needed) {
            if slot.is_none() {
                *slot = Some(build(Evaluator::Pruned(features))?);
                self.built += 1;
            }
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
        let (orders, ordered) = channel::<(u128, Evaluator)>();
        let (finish, finished) = channel();
        let is_unwanted = Arc::new(AtomicBool::new(false));
        let should_end = is_unwanted.clone();
        let work = move || {
            // A driver that computes on the processor compiles at the first dispatch, in the queue's own
            // thread: a device of the worker's own takes that time, and leaves the result in the driver's cache.
            let new_warmer = || guarded(|| Warmer::new(&shared.gpu, shared.options)).ok()?.ok();
            let warmer = if shared.gpu.is_software() { new_warmer() } else { None };
            for (key, evaluator) in ordered {
                if should_end.load(Ordering::Relaxed) {
                    return;
                }
                if let Some(warmer) = &warmer {
                    // A kernel that fails is reported where it is built for use.
                    let _ = guarded(|| warmer.warm(&evaluator));
                }
                let built = guarded(|| build(&shared, &evaluator)).flatten();
                if finish.send((key, built)).is_err() {
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

/// The component's numbers as bits, without the data of its leaves.
fn component_rows(flat: &FlatScene, component: &Component) -> Vec<[u32; 4]> {
    let rows = component.numbers as usize..(component.numbers + component.rows - component.data) as usize;
    flat.numbers[rows].iter().map(|row| row.map(f32::to_bits)).collect()
}

/// Builds a kernel; what the driver or the validation has against it comes back in words.
fn build(shared: &Shared, evaluator: &Evaluator) -> Result<Kernel, String> {
    let device = &shared.gpu.device;
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let built = shared.field.build(device, &shared.layouts, evaluator, shared.options);
    let complaint = pollster::block_on(scope.pop());
    match (built, complaint) {
        (Ok(kernel), None) => Ok(kernel),
        (Err(error), _) => Err(error.to_string()),
        (_, Some(error)) => Err(format!("a kernel could not be built, the interpreter goes on: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_kernel_is_counted_and_its_reason_is_told_once() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let layouts = Layouts::new(&gpu.device);
        let mut kernels = Kernels::new(&gpu, &layouts, Options::default()).expect("an interpreter");
        assert_eq!(kernels.failed(), 0);
        kernels.store(7, Err("the driver refuses".into()));
        assert_eq!(kernels.failed(), 1);
        assert_eq!(kernels.take_failures(), ["the driver refuses"]);
        assert!(kernels.take_failures().is_empty() && kernels.failed() == 1, "it stays failed");
    }
}
