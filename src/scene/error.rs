//! Why a change to a scene is refused.

use thiserror::Error;

use super::{MaterialId, NodeId};

/// Why a change to a scene was refused. The scene is as it was before.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SceneError {
    /// No node has this id.
    #[error("there is no node {0}")]
    NoNode(NodeId),
    /// Only groups hold children.
    #[error("node {0} is not a group and cannot hold others")]
    NotAGroup(NodeId),
    /// A node would become its own ancestor.
    #[error("node {0} cannot be moved into itself")]
    Cycle(NodeId),
    /// No material has this id.
    #[error("there is no material {0}")]
    NoMaterial(MaterialId),
    /// Something still uses the material.
    #[error("material {0} is still used by node {1}")]
    MaterialInUse(MaterialId, NodeId),
    /// A limit of [`super::limits`].
    #[error("{what} would pass its limit of {limit}")]
    Limit {
        /// What is limited.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The id stands in the table already.
    #[error("node {0} is in the scene already")]
    DuplicateNode(NodeId),
    /// The id stands in the table already.
    #[error("material {0} is in the scene already")]
    DuplicateMaterial(MaterialId),
    /// An edit of nodes that names none.
    #[error("no node is chosen")]
    Nothing,
    /// A table is not in depth-first pre-order.
    #[error("node {0} does not stand next to the other nodes of its group")]
    OutOfOrder(NodeId),
    /// A parameter that is not there, or a value of another type, see [`super::ParamPath`].
    #[error("{path}: {reason}")]
    Param {
        /// The path of the parameter.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A value is not what it must be, see [`super::check`].
    #[error("{subject}: {field}: {reason}")]
    Invalid {
        /// The node or material, by name and id, or the environment.
        subject: String,
        /// Which value, as a path below the subject, such as `object.shape.radius`.
        field: String,
        /// What it must be.
        reason: String,
    },
}
