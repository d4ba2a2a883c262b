//! Which kernel draws which component, and with which lists.

use std::sync::Arc;

use super::{RenderError, Renderer};
use crate::flat::{CellTree, Component, FlatScene};
use crate::render::kernels::{Choice, Kernels, Method, Walk};
use crate::render::schedule::Evaluation;

/// What [`Renderer::choose`] finds, beside the components.
pub(super) struct Chosen {
    pub(super) keys: Vec<Option<u128>>,
    pub(super) choices: Vec<Choice>,
    pub(super) evaluations: Vec<Evaluation>,
    pub(super) trees: Vec<Option<Arc<CellTree>>>,
}

impl Renderer {
    /// Kernels, and what they need to know, for each component.
    pub(super) fn choose(&mut self, flat: &FlatScene) -> Result<Chosen, RenderError> {
        let keys = Kernels::keys(flat, self.method);
        // Lists are made only for what no specialised kernel is to draw.
        let wanted: Vec<bool> = keys.iter().map(|key| key.is_none() && self.method != Method::Interpreted).collect();
        let mut trees = self.pruner.trees(flat, &wanted);
        // What has no room on the device is walked without lists.
        let mut room = self.lists.most_bytes(&self.gpu.device) / size_of::<[u32; 2]>();
        for tree in &mut trees {
            let needed = tree.as_ref().map_or(0, |tree| tree.words.len());
            match room.checked_sub(needed) {
                Some(left) => room = left,
                None => *tree = None,
            }
        }
        let has_lists: Vec<bool> = trees.iter().map(Option::is_some).collect();
        let choices = self.kernels.choose(flat, &keys, self.method, &has_lists)?;
        let evaluation = |((component, choice), tree): ((&Component, &Choice), &Option<Arc<CellTree>>)| match choice
            .walk
        {
            Walk::Straight => Evaluation::of_straight(component),
            Walk::Entries => Evaluation::of_entries(component),
            Walk::List => tree.as_ref().map_or(Evaluation::of_entries(component), |tree| Evaluation::of_lists(tree)),
        };
        let evaluations = flat.components.iter().zip(&choices).zip(&trees).map(evaluation).collect();
        Ok(Chosen { keys, choices, evaluations, trees })
    }
}
