//! How much of each limit a scene uses.

use super::arrays::*;
use super::budget::Usage;
use isolith_bricks::MAX_BRICK_TEXELS;
use isolith_scene::limits::MAX_TEXTURE_BYTES;

impl FlatScene {
    /// Bytes of the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.params)
            + size_of_val(&*self.ids)
            + size_of_val(&*self.components)
    }
}

/// Usage of each limit by the arrays; flattening took `steps`.
pub(super) fn usage(flat: &FlatScene, steps: usize) -> Vec<Usage> {
    let most = |of: &dyn Fn(&Component) -> usize| {
        let largest = flat.components.iter().max_by_key(|component| of(component));
        let node = largest.and_then(|component| flat.ids.get(component.first as usize)).copied();
        (largest.map_or(0, of), node)
    };
    let (largest, largest_node) = most(&|component| component.count as usize);
    let (stack, stack_node) = most(&|component| component.stack as usize);
    let (copies, copies_node) = most(&|component| component.copies as usize);
    let (_, rows_node) = most(&|component| component.param_rows as usize);
    let row = |name, used, limit, node| Usage { name, used, limit, node };
    vec![
        row("entries", flat.nodes.len(), MAX_FLAT_NODES, largest_node),
        row("entries of one component", largest, MAX_COMPONENT_NODES, largest_node),
        row("components", flat.components.len(), MAX_COMPONENTS, None),
        row("copies evaluated for one point", copies, MAX_COPIES, copies_node),
        row("stack", stack, MAX_STACK as usize, stack_node),
        row("rows", flat.params.len(), MAX_FLAT_ROWS, rows_node),
        row("bytes", flat.bytes(), MAX_FLAT_BYTES, rows_node),
        row("materials, per object with textures", flat.materials.len(), MAX_PLACED_MATERIALS, None),
        row("bytes of images of textures", flat.textures.image_bytes(), MAX_TEXTURE_BYTES, None),
        row("texels of bricks of models", flat.bricks.texels(), MAX_BRICK_TEXELS, None),
        row("steps", steps, MAX_FLAT_STEPS, largest_node),
    ]
}
