//! Which components get a kernel, and for what: their structure, or their form.
//!
//! A kernel for a structure is the fastest, but a scene may have as many structures as components: each takes a driver
//! tenths of a second, and lavapipe compiles all of them anew in every frame where they are too many (137 s instead of
//! 0.14 for 128 groups of 8 leaves), probably because it throws kernels away that hold more than about 500 000
//! instructions together. So where there are many, components whose forms are alike share a kernel for their form, which
//! takes about a fifth longer. What has no form, see [`Structure::form`], keeps the kernel for its structure, or gets none.

use std::collections::{HashMap, HashSet};

use super::kernel::{Features, ShapeSet, Structure, lists_are_cheaper};
use super::kernels::Method;
use crate::flat::{Component, FlatScene};

/// What a component's kernel is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key {
    /// Equal for what shares a kernel.
    pub bits: u128,
    /// The shapes that its leaves may be, where it is for a form.
    pub form: Option<ShapeSet>,
}

/// Most entries of all different structures together that get kernels. Twice as many are too many for lavapipe.
const MAX_STRUCTURE_ENTRIES: usize = 600;
/// Where there are more than this, compiling them takes longer than one waits gladly: a second for twenty.
const MANY_STRUCTURE_ENTRIES: usize = 200;
/// Kernels for forms of more shapes have not been measured: a leaf has the code of each of them.
const MOST_SHAPES: u32 = 12;
/// So many structures of one form share a kernel, where there are many.
const LEAST_SHARED: usize = 3;

/// Knows which shapes each form has been used with: while they are few only ever more, so that kernels are seldom made
/// anew.
#[derive(Debug, Default)]
pub struct Forms {
    shapes: HashMap<u128, ShapeSet>,
}

impl Forms {
    /// The key of each component; `None` where it gets no kernel of its own.
    pub fn keys(&mut self, flat: &FlatScene, method: Method) -> Vec<Option<Key>> {
        let structure = |bits| Key { bits, form: None };
        let components = flat.components.iter();
        match method {
            Method::Interpreted | Method::Pruned => vec![None; flat.components.len()],
            Method::Generated => components.map(|c| Some(structure(Structure::baked_key(flat, c)))).collect(),
            Method::Specialised => components.map(|c| Structure::key(flat, c).map(structure)).collect(),
            Method::Auto => {
                let kinds = Features::of(flat).shapes;
                let is_straight = |c: &&Component| !lists_are_cheaper(flat, c, &kinds);
                let keys: Vec<_> =
                    components.map(|c| Some(c).filter(is_straight).and_then(|c| Structure::key(flat, c))).collect();
                match entries(flat, &keys) {
                    0..=MANY_STRUCTURE_ENTRIES => keys.into_iter().map(|key| key.map(structure)).collect(),
                    entries => self.shared(flat, &keys, entries > MAX_STRUCTURE_ENTRIES),
                }
            }
        }
    }

    /// The keys where the structures are many. Forms of many shapes are slow, and only for where they are too many.
    fn shared(&mut self, flat: &FlatScene, structures: &[Option<u128>], too_many: bool) -> Vec<Option<Key>> {
        // What is drawn by lists has no key, and takes no part.
        let form = |(c, key): (&Component, &Option<u128>)| key.and_then(|_| Structure::form_key(flat, c));
        let forms: Vec<_> = flat.components.iter().zip(structures).map(form).collect();
        let mut of_form: HashMap<u128, HashSet<u128>> = HashMap::new();
        let mut met: HashMap<u128, ShapeSet> = HashMap::new();
        for ((form, shapes), structure) in forms.iter().zip(structures).filter_map(|(f, s)| Some(((*f)?, (*s)?))) {
            of_form.entry(form).or_default().insert(structure);
            met.entry(form).or_default().0 |= shapes.0;
        }
        for (form, now) in met {
            let known = self.shapes.entry(form).or_default();
            let both = ShapeSet(known.0 | now.0);
            *known = if both.is_small() { both } else { now };
        }
        let is_shared = |form: &u128| {
            of_form.get(form).is_some_and(|structures| structures.len() >= LEAST_SHARED)
                && (self.shapes[form].is_small() || too_many && self.shapes[form].count() <= MOST_SHAPES)
        };
        let mut keys: Vec<Option<Key>> = vec![None; forms.len()];
        for (key, form) in keys.iter_mut().zip(&forms) {
            *key = form.filter(|(form, _)| is_shared(form)).map(|(form, _)| {
                let shapes = self.shapes[&form];
                Key { bits: form ^ (u128::from(shapes.0) << 64) ^ FORM, form: Some(shapes) }
            });
        }
        // The largest of the others have room for kernels of their own.
        let size = |i: usize| flat.components[i].bounds.half().max_element();
        let mut others: Vec<usize> =
            (0..keys.len()).filter(|i| keys[*i].is_none() && structures[*i].is_some()).collect();
        others.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
        let (mut met, mut left) = (HashSet::new(), MAX_STRUCTURE_ENTRIES);
        for index in others {
            let Some(bits) = structures[index] else { continue };
            let needed = if met.contains(&bits) { 0 } else { flat.components[index].count as usize };
            if let Some(rest) = left.checked_sub(needed) {
                left = rest;
                met.insert(bits);
                keys[index] = Some(Key { bits, form: None });
            }
        }
        keys
    }
}

/// Tells forms from structures.
const FORM: u128 = 0x5eed_f0f0_0000_0000_0000_0000_0000_0001;

/// Entries of all different structures.
fn entries(flat: &FlatScene, keys: &[Option<u128>]) -> usize {
    let mut met = HashSet::new();
    let pairs = flat.components.iter().zip(keys).filter_map(|(c, key)| Some((c, (*key)?)));
    pairs.filter(|(_, key)| met.insert(*key)).map(|(component, _)| component.count as usize).sum()
}
