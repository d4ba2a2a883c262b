//! The pipeline key of each component: its structure, or its template.
//!
//! A pipeline for a structure is the fastest, but a scene may have as many structures as components. A driver takes
//! tenths of a second for each. lavapipe compiles all of them again in every frame when they are too many (137 s
//! instead of 0.14 for 128 groups of 8 leaves), probably because it evicts pipelines that hold more than about 500 000
//! instructions together. So when structures are many, components with equal templates share a pipeline for their
//! template, which is about a fifth slower. Components without a template, see [`Structure::template`], keep the
//! pipeline of their structure, or get none.

use std::collections::{HashMap, HashSet};

use crate::pipelines::strategy::EvalStrategy;
use isolith_field::{Component, FlatScene};
use isolith_wgsl::{Evaluator, OpSet, ShapeSet, Structure, tapes_are_cheaper};

/// Identifies the pipeline of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PipelineKey {
    /// Equal for components that share a pipeline.
    pub bits: u128,
    /// For a template: the shapes that its leaves may be.
    pub template: Option<ShapeSet>,
    /// Whether it is for types of instancers.
    pub copies: bool,
}

impl PipelineKey {
    /// The key of the same code for a type of an instancer, if the component is one.
    fn of_copies(self, component: &Component) -> Self {
        if component.instanced.is_none() { self } else { Self { bits: self.bits ^ COPIES, copies: true, ..self } }
    }
}

impl PipelineKey {
    /// The evaluator of this pipeline. `component` is one of those that share it. `None` if the key has no such
    /// pipeline.
    pub fn evaluator(&self, flat: &FlatScene, component: &Component, strategy: EvalStrategy) -> Option<Evaluator> {
        match (strategy, self.template) {
            (EvalStrategy::Baked, _) => {
                Some(Evaluator::Baked(Structure::whole(flat, component), component_rows(flat, component)))
            }
            (_, Some(shapes)) => Structure::template(flat, component, shapes).map(Evaluator::StraightLine),
            _ => Structure::of(flat, component).map(Evaluator::StraightLine),
        }
    }
}

/// The component's rows as bits, without the payload rows of its leaves.
fn component_rows(flat: &FlatScene, component: &Component) -> Vec<[u32; 4]> {
    let rows = component.params as usize..(component.params + component.param_rows - component.payload_rows) as usize;
    flat.params[rows].iter().map(|row| row.map(f32::to_bits)).collect()
}

/// Limit of the entries of all different structures together that get pipelines. Twice as many are too many for
/// lavapipe.
const MAX_STRUCTURE_ENTRIES: usize = 600;
/// Above this, structures share pipelines: compiling twenty takes about one second.
const MANY_STRUCTURE_ENTRIES: usize = 200;
/// Templates of more shapes have not been measured: each leaf contains the code of all of them.
const MOST_SHAPES: u32 = 12;
/// When structures are many, a shared pipeline needs at least this many structures of one template.
const LEAST_SHARED: usize = 3;

/// Remembers the shapes that each template has been used with. While they are few the set only grows, so that pipelines
/// are seldom rebuilt.
#[derive(Debug, Default)]
pub struct Templates {
    shapes: HashMap<u128, ShapeSet>,
}

impl Templates {
    /// The key of each component; `None` if it gets no pipeline of its own. `lengths` is parallel to the components:
    /// the mean length of their tapes, where tapes are ready.
    pub fn keys(
        &mut self,
        flat: &FlatScene,
        strategy: EvalStrategy,
        lengths: &[Option<f64>],
    ) -> Vec<Option<PipelineKey>> {
        let keys = self.of_code(flat, strategy, lengths);
        // What rays may pass needs the surface where they meet it, and is drawn by tapes.
        let veiled = flat.veiled();
        let keys = flat.components.iter().zip(keys).map(|(c, key)| key.map(|key| key.of_copies(c)));
        keys.enumerate().map(|(i, key)| key.filter(|_| veiled.get(i) != Some(&true))).collect()
    }

    /// The same without a difference between components and types of instancers.
    fn of_code(
        &mut self,
        flat: &FlatScene,
        strategy: EvalStrategy,
        lengths: &[Option<f64>],
    ) -> Vec<Option<PipelineKey>> {
        let structure = |bits| PipelineKey { bits, template: None, copies: false };
        let components = flat.components.iter();
        match strategy {
            EvalStrategy::Interpreter | EvalStrategy::Tape => vec![None; flat.components.len()],
            EvalStrategy::Baked => components.map(|c| Some(structure(Structure::baked_key(flat, c)))).collect(),
            EvalStrategy::StraightLine => components.map(|c| Structure::key(flat, c).map(structure)).collect(),
            EvalStrategy::Auto => {
                let kinds = OpSet::of(flat).shapes;
                let length = |i: usize| lengths.get(i).copied().flatten();
                let is_listed = |(i, c): (usize, &Component)| tapes_are_cheaper(flat, c, &kinds, length(i));
                let key = |(i, c)| if is_listed((i, c)) { None } else { Structure::key(flat, c) };
                let keys: Vec<_> = components.enumerate().map(key).collect();
                match entries(flat, &keys) {
                    0..=MANY_STRUCTURE_ENTRIES => keys.into_iter().map(|key| key.map(structure)).collect(),
                    entries => self.shared(flat, &keys, entries > MAX_STRUCTURE_ENTRIES),
                }
            }
        }
    }

    /// The keys when structures are many. Templates of many shapes are slow, and serve only when structures are too
    /// many.
    fn shared(&mut self, flat: &FlatScene, structures: &[Option<u128>], too_many: bool) -> Vec<Option<PipelineKey>> {
        // Components drawn by tapes have no key here and are ignored.
        let template = |(c, key): (&Component, &Option<u128>)| key.and_then(|_| Structure::template_key(flat, c));
        let templates: Vec<_> = flat.components.iter().zip(structures).map(template).collect();
        let mut of_template: HashMap<u128, HashSet<u128>> = HashMap::new();
        let mut seen: HashMap<u128, ShapeSet> = HashMap::new();
        for ((template, shapes), structure) in
            templates.iter().zip(structures).filter_map(|(f, s)| Some(((*f)?, (*s)?)))
        {
            of_template.entry(template).or_default().insert(structure);
            seen.entry(template).or_default().0 |= shapes.0;
        }
        for (template, now) in seen {
            let known = self.shapes.entry(template).or_default();
            let both = ShapeSet(known.0 | now.0);
            *known = if both.is_small() { both } else { now };
        }
        let is_shared = |template: &u128| {
            of_template.get(template).is_some_and(|structures| structures.len() >= LEAST_SHARED)
                && (self.shapes[template].is_small() || too_many && self.shapes[template].count() <= MOST_SHAPES)
        };
        let mut keys: Vec<Option<PipelineKey>> = vec![None; templates.len()];
        for (key, template) in keys.iter_mut().zip(&templates) {
            *key = template.filter(|(template, _)| is_shared(template)).map(|(template, _)| {
                let shapes = self.shapes[&template];
                PipelineKey {
                    bits: template ^ (u128::from(shapes.0) << 64) ^ TEMPLATE,
                    template: Some(shapes),
                    copies: false,
                }
            });
        }
        // The largest of the other components get pipelines of their own, as far as the limit allows.
        let size = |i: usize| flat.components[i].bounds.half().max_element();
        let mut others: Vec<usize> =
            (0..keys.len()).filter(|i| keys[*i].is_none() && structures[*i].is_some()).collect();
        others.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
        let (mut seen, mut left) = (HashSet::new(), MAX_STRUCTURE_ENTRIES);
        for index in others {
            let Some(bits) = structures[index] else { continue };
            let needed = if seen.contains(&bits) { 0 } else { flat.components[index].count as usize };
            if let Some(rest) = left.checked_sub(needed) {
                left = rest;
                seen.insert(bits);
                keys[index] = Some(PipelineKey { bits, template: None, copies: false });
            }
        }
        keys
    }
}

/// Distinguishes keys of templates from keys of structures.
const TEMPLATE: u128 = 0x5eed_f0f0_0000_0000_0000_0000_0000_0001;

/// Distinguishes keys for types of instancers from those of other components.
const COPIES: u128 = 0xc0b1_e5c0_0000_0000_0000_0000_0000_0002;

/// Number of entries of all different structures.
fn entries(flat: &FlatScene, keys: &[Option<u128>]) -> usize {
    let mut seen = HashSet::new();
    let pairs = flat.components.iter().zip(keys).filter_map(|(c, key)| Some((c, (*key)?)));
    pairs.filter(|(_, key)| seen.insert(*key)).map(|(component, _)| component.count as usize).sum()
}
