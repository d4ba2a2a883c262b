//! Errors of flattening.

use thiserror::Error;

use isolith_scene::{Node, NodeId};

/// A limit that a scene exceeds, so that it has no arrays.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{name} ({node}): {what} is {value}, more than the limit of {limit}")]
pub struct FlattenError {
    /// The node that hit the limit.
    pub node: NodeId,
    /// Its name.
    pub name: String,
    /// The limited quantity.
    pub what: &'static str,
    /// The value reached.
    pub value: usize,
    /// The limit.
    pub limit: usize,
}

impl FlattenError {
    pub(super) fn new(node: &Node, what: &'static str, value: usize, limit: usize) -> Self {
        Self { node: node.id, name: node.name.clone(), what, value, limit }
    }
}
