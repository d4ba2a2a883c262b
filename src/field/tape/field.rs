//! Evaluation of the field by the tapes, in f64, as in the shader.

use glam::DVec3;

use super::cell_tree::{Cell, CellTree};
use super::entry::Leaf;
use super::tape_entry::{TapeEntry, TapeOp};
use crate::eval::{BlendParams, modified_field, op_join};
use crate::{Component, FlatScene, Join};

/// The field of `component` at `p` by its tapes, in meters; `p` is relative to the component's origin.
///
/// In a cell with a tape this is the field. Elsewhere it is a bound: of the field in cells without a surface, of the
/// distance to the surface outside of the grid.
pub fn tape_field(flat: &FlatScene, component: &Component, tree: &CellTree, p: DVec3) -> f64 {
    in_space(flat, component, tree, 0, p)
}

/// The field in the space of the tree's grid `number`.
fn in_space(flat: &FlatScene, component: &Component, tree: &CellTree, number: usize, p: DVec3) -> f64 {
    let grid = &tree.grids[number];
    match tree.tape_at(number, p) {
        Cell::Outside => grid.distance(p) + grid.clear,
        Cell::Empty { bound } => bound,
        Cell::Tape(tape_entries) => {
            fold(flat, component, tape_entries, p, &|content, q| in_space(flat, component, tree, content, q))
        }
    }
}

/// The value of a tape at `p`; `content` is the field of a modifier's content, by its number, in its space.
pub(super) fn fold(
    flat: &FlatScene,
    component: &Component,
    tape_entries: &[[u32; 2]],
    p: DVec3,
    content: &dyn Fn(usize, DVec3) -> f64,
) -> f64 {
    let mut value = 0.0;
    let mut aside = Vec::with_capacity(component.stack as usize);
    for tape_entry in tape_entries.iter().map(|words| TapeEntry(*words)) {
        let params = &flat.params[component.params as usize + tape_entry.row()..];
        let blend_params = BlendParams::read(&params[0]);
        let join = |a, b| op_join(tape_entry.join(), a, b, &blend_params, tape_entry.kernel()).value;
        match tape_entry.op() {
            TapeOp::Leaf => {
                let distance = match tape_entry.content() {
                    Some((kind, number)) => modified_field(kind, params, p, &|q| content(number, q)),
                    None => Leaf::read(tape_entry.shape(), params, &flat.bricks).distance(p),
                };
                value = if tape_entry.join() == Join::First as u32 { distance } else { join(value, distance) };
            }
            TapeOp::Begin => aside.push(value),
            TapeOp::End => value = join(aside.pop().expect("every group that ends has begun"), value),
            TapeOp::Negate => value = -value,
        }
    }
    value
}
