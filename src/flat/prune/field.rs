//! The field by the lists, in f64: what the shader computes.

use glam::DVec3;

use super::entry::Leaf;
use super::token::{Token, TokenOp};
use super::{Cell, CellTree};
use crate::flat::twin::{Joint, op_join};
use crate::flat::{Component, FlatScene, Join};

/// The field of `component` at `p` by its lists, in metres; `p` is relative to the component's origin.
///
/// Where a cell has a list this is the field. Elsewhere it is a bound: of the field in cells without a
/// surface, of the distance to the surface outside of the grid.
pub fn pruned_field(flat: &FlatScene, component: &Component, tree: &CellTree, p: DVec3) -> f64 {
    match tree.list_at(p) {
        Cell::Outside => tree.distance(p) + tree.margin(),
        Cell::Empty { bound } => bound,
        Cell::List(tokens) => fold(flat, component, tokens, p),
    }
}

/// The value of a list at `p`.
pub(super) fn fold(flat: &FlatScene, component: &Component, tokens: &[[u32; 2]], p: DVec3) -> f64 {
    let mut value = 0.0;
    let mut aside = Vec::with_capacity(component.stack as usize);
    for token in tokens.iter().map(|words| Token(*words)) {
        let numbers = &flat.numbers[component.numbers as usize + token.row()..];
        let joint = Joint::read(&numbers[0]);
        let join = |a, b| op_join(token.join(), a, b, &joint, token.kernel()).value;
        match token.op() {
            TokenOp::Leaf => {
                let distance = Leaf::read(token.shape(), numbers).distance(p);
                value = if token.join() == Join::First as u32 { distance } else { join(value, distance) };
            }
            TokenOp::Begin => aside.push(value),
            TokenOp::End => value = join(aside.pop().expect("every group that ends has begun"), value),
            TokenOp::Negate => value = -value,
        }
    }
    value
}
