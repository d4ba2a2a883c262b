//! The field by the lists, in f64: what the shader computes.

use glam::DVec3;

use super::entry::Leaf;
use super::token::{Token, TokenOp};
use super::{Cell, CellTree};
use crate::flat::twin::{Joint, modified_field, op_join};
use crate::flat::{Component, FlatScene, Join};

/// The field of `component` at `p` by its lists, in metres; `p` is relative to the component's origin.
///
/// Where a cell has a list this is the field. Elsewhere it is a bound: of the field in cells without a
/// surface, of the distance to the surface outside of the grid.
pub fn pruned_field(flat: &FlatScene, component: &Component, tree: &CellTree, p: DVec3) -> f64 {
    in_space(flat, component, tree, 0, p)
}

/// The field in the space of the tree's grid of this number.
fn in_space(flat: &FlatScene, component: &Component, tree: &CellTree, number: usize, p: DVec3) -> f64 {
    let grid = &tree.grids[number];
    match tree.list_at(number, p) {
        Cell::Outside => grid.distance(p) + grid.clear,
        Cell::Empty { bound } => bound,
        Cell::List(tokens) => {
            fold(flat, component, tokens, p, &|content, q| in_space(flat, component, tree, content, q))
        }
    }
}

/// The value of a list at `p`; `content` is the field of what a modifier holds, by its number, in its space.
pub(super) fn fold(
    flat: &FlatScene,
    component: &Component,
    tokens: &[[u32; 2]],
    p: DVec3,
    content: &dyn Fn(usize, DVec3) -> f64,
) -> f64 {
    let mut value = 0.0;
    let mut aside = Vec::with_capacity(component.stack as usize);
    for token in tokens.iter().map(|words| Token(*words)) {
        let numbers = &flat.numbers[component.numbers as usize + token.row()..];
        let joint = Joint::read(&numbers[0]);
        let join = |a, b| op_join(token.join(), a, b, &joint, token.kernel()).value;
        match token.op() {
            TokenOp::Leaf => {
                let distance = match token.content() {
                    Some((kind, number)) => modified_field(kind, numbers, p, &|q| content(number, q)),
                    None => Leaf::read(token.shape(), numbers).distance(p),
                };
                value = if token.join() == Join::First as u32 { distance } else { join(value, distance) };
            }
            TokenOp::Begin => aside.push(value),
            TokenOp::End => value = join(aside.pop().expect("every group that ends has begun"), value),
            TokenOp::Negate => value = -value,
        }
    }
    value
}
