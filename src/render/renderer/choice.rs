//! Which kernel draws which component, and with which lists.

use std::sync::Arc;

use super::{RenderError, Renderer};
use crate::flat::{CellTree, Component, FlatScene};
use crate::render::kernel::shape_loops;
use crate::render::kernels::{Choice, Kernels, Method, Walk};
use crate::render::schedule::Evaluation;
use crate::scene::ShapeKind;

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
        let loops = self.kernels.loops();
        let evaluation = |((component, choice), tree): ((&Component, &Choice), &Option<Arc<CellTree>>)| {
            let rounds = rounds(flat, component);
            match (choice.walk, tree) {
                (Walk::Straight, _) => Evaluation::of_straight(component, rounds),
                (Walk::List, Some(tree)) => Evaluation::of_lists(tree, loops, rounds),
                _ => Evaluation::of_entries(component, loops, rounds),
            }
        };
        let evaluations = flat.components.iter().zip(&choices).zip(&trees).map(evaluation).collect();
        Ok(Chosen { keys, choices, evaluations, trees })
    }
}

/// Rounds that the loops of the component's leaves take together, at most.
fn rounds(flat: &FlatScene, component: &Component) -> u32 {
    let entries = &flat.nodes[component.first as usize..(component.first + component.count) as usize];
    let leaves = entries.iter().filter(|node| node.is_leaf());
    let own = leaves.map(|node| shape_loops(ShapeKind::ALL[(node.code & 0xffff) as usize])[1]).sum::<u32>();
    own + component.data
}
