//! The tapes of all components in one texture. A tree that remains keeps its place, so there is nothing to compare and
//! only new trees are uploaded: trees take megabytes.

use std::collections::HashSet;
use std::sync::Arc;

use crate::resources::buffers::DataTexture;
use crate::resources::layouts::TAPES_FORMAT;
use isolith_field::CellTree;

/// The texture of tapes, see the module.
#[derive(Debug)]
pub struct TapeTexture {
    texture: DataTexture,
    /// The trees in the order of their places.
    placed: Vec<PlacedTree>,
}

#[derive(Debug)]
struct PlacedTree {
    tree: Arc<CellTree>,
    /// Its first word in the texture.
    at: usize,
    is_new: bool,
}

impl PlacedTree {
    fn end(&self) -> usize {
        self.at + self.tree.words.len()
    }
}

impl TapeTexture {
    /// An empty texture.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { texture: DataTexture::new(device, "tapes", TAPES_FORMAT), placed: Vec::new() }
    }

    /// Capacity on this device, in words.
    pub fn most_words(&self, device: &wgpu::Device) -> usize {
        self.texture.most_bytes(device) / self.texture.texel()
    }

    /// Stores these trees, which must fit together on the device, and drops all others. Returns whether the texture was
    /// replaced.
    pub fn hold(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, trees: &[Option<Arc<CellTree>>]) -> bool {
        let wanted: HashSet<*const CellTree> = trees.iter().flatten().map(Arc::as_ptr).collect();
        self.placed.retain(|placed| wanted.contains(&Arc::as_ptr(&placed.tree)));
        let held: HashSet<*const CellTree> = self.placed.iter().map(|placed| Arc::as_ptr(&placed.tree)).collect();
        for tree in trees.iter().flatten().filter(|tree| !held.contains(&Arc::as_ptr(tree))) {
            insert(&mut self.placed, tree.clone());
        }
        let texel = self.texture.texel();
        if self.end() > self.most_words(device) {
            self.move_together();
        }
        let grown = self.texture.reserve(device, self.end() * texel);
        if grown {
            self.move_together();
        }
        for placed in self.placed.iter_mut().filter(|placed| placed.is_new) {
            self.texture.write(queue, placed.at * texel, bytemuck::cast_slice(&placed.tree.words));
            placed.is_new = false;
        }
        grown
    }

    /// First word of a stored tree.
    pub fn place(&self, tree: &Arc<CellTree>) -> Option<u32> {
        self.placed.iter().find(|placed| Arc::ptr_eq(&placed.tree, tree)).map(|placed| placed.at as u32)
    }

    /// The whole texture as a binding.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        self.texture.binding()
    }

    /// Bytes uploaded so far.
    pub fn uploaded(&self) -> u64 {
        self.texture.uploaded()
    }

    fn end(&self) -> usize {
        self.placed.last().map_or(0, PlacedTree::end)
    }

    /// Moves all trees together; all of them need a new upload then.
    fn move_together(&mut self) {
        let mut at = 0;
        for placed in &mut self.placed {
            (placed.at, placed.is_new) = (at, true);
            at = placed.end();
        }
    }
}

/// Places a tree into the first gap that is long enough, or after all others.
fn insert(placed: &mut Vec<PlacedTree>, tree: Arc<CellTree>) {
    let mut at = 0;
    let fits = |(_, next): &(usize, &PlacedTree)| {
        let gap = next.at - at;
        at = if gap >= tree.words.len() { at } else { next.end() };
        gap >= tree.words.len()
    };
    let index = placed.iter().enumerate().find(fits).map_or(placed.len(), |(index, _)| index);
    placed.insert(index, PlacedTree { tree, at, is_new: true });
}
