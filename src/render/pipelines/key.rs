//! Which components get a pipeline, and for what: their structure, or their template.
//!
//! A pipeline for a structure is the fastest, but a scene may have as many structures as components: each takes a driver
//! tenths of a second, and lavapipe compiles all of them anew in every frame where they are too many (137 s instead of
//! 0.14 for 128 groups of 8 leaves), probably because it throws pipelines away that hold more than about 500 000
//! instructions together. So where there are many, components whose templates are alike share a pipeline for their template, which
//! takes about a fifth longer. What has no template, see [`Structure::template`], keeps the pipeline for its structure, or gets none.

use std::collections::{HashMap, HashSet};

use crate::pipelines::strategy::EvalStrategy;
use isolith_field::{Component, FlatScene};
use isolith_wgsl::{Evaluator, OpSet, ShapeSet, Structure, tapes_are_cheaper};

/// What a component's pipeline is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PipelineKey {
    /// Equal for what shares a pipeline.
    pub bits: u128,
    /// The shapes that its leaves may be, where it is for a template.
    pub template: Option<ShapeSet>,
}

impl PipelineKey {
    /// What its pipeline evaluates: `component` is one of those that share it. `None` where the component has no such pipeline.
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

/// The component's numbers as bits, without the data of its leaves.
fn component_rows(flat: &FlatScene, component: &Component) -> Vec<[u32; 4]> {
    let rows = component.params as usize..(component.params + component.param_rows - component.payload_rows) as usize;
    flat.params[rows].iter().map(|row| row.map(f32::to_bits)).collect()
}

/// Most entries of all different structures together that get pipelines. Twice as many are too many for lavapipe.
const MAX_STRUCTURE_ENTRIES: usize = 600;
/// Where there are more than this, compiling them takes longer than one waits gladly: a second for twenty.
const MANY_STRUCTURE_ENTRIES: usize = 200;
/// Pipelines for templates of more shapes have not been measured: a leaf has the code of each of them.
const MOST_SHAPES: u32 = 12;
/// So many structures of one template share a pipeline, where there are many.
const LEAST_SHARED: usize = 3;

/// Knows which shapes each template has been used with: while they are few only ever more, so that pipelines are seldom made
/// anew.
#[derive(Debug, Default)]
pub struct Templates {
    shapes: HashMap<u128, ShapeSet>,
}

impl Templates {
    /// The key of each component; `None` where it gets no pipeline of its own. `lengths` stand beside the components: how many
    /// entries their tapes hold on average, as far as tapes are there.
    pub fn keys(
        &mut self,
        flat: &FlatScene,
        strategy: EvalStrategy,
        lengths: &[Option<f64>],
    ) -> Vec<Option<PipelineKey>> {
        let structure = |bits| PipelineKey { bits, template: None };
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

    /// The keys where the structures are many. Templates of many shapes are slow, and only for where they are too many.
    fn shared(&mut self, flat: &FlatScene, structures: &[Option<u128>], too_many: bool) -> Vec<Option<PipelineKey>> {
        // What is drawn by tapes has no key, and takes no part.
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
                PipelineKey { bits: template ^ (u128::from(shapes.0) << 64) ^ TEMPLATE, template: Some(shapes) }
            });
        }
        // The largest of the others have room for pipelines of their own.
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
                keys[index] = Some(PipelineKey { bits, template: None });
            }
        }
        keys
    }
}

/// Tells templates from structures.
const TEMPLATE: u128 = 0x5eed_f0f0_0000_0000_0000_0000_0000_0001;

/// Entries of all different structures.
fn entries(flat: &FlatScene, keys: &[Option<u128>]) -> usize {
    let mut seen = HashSet::new();
    let pairs = flat.components.iter().zip(keys).filter_map(|(c, key)| Some((c, (*key)?)));
    pairs.filter(|(_, key)| seen.insert(*key)).map(|(component, _)| component.count as usize).sum()
}
