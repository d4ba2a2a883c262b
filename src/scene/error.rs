//! Why a change to a scene is refused.

use thiserror::Error;

use super::{MaterialId, NodeId};

/// Why a change to a scene was refused. The scene is unchanged.
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
    /// The change exceeds a limit of [`super::limits`].
    #[error("{what} would pass its limit of {limit}")]
    Limit {
        /// The limited quantity.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// Files cannot be packed into the scene.
    #[error("the packed file {0}")]
    Packed(String),
    /// A node with this id exists already.
    #[error("node {0} is in the scene already")]
    DuplicateNode(NodeId),
    /// A material with this id exists already.
    #[error("material {0} is in the scene already")]
    DuplicateMaterial(MaterialId),
    /// An edit of nodes names no node.
    #[error("no node is chosen")]
    Nothing,
    /// A table is not in depth-first pre-order.
    #[error("node {0} does not stand next to the other nodes of its group")]
    OutOfOrder(NodeId),
    /// A parameter does not exist, or the value has another type, see [`super::ParamPath`].
    #[error("{path}: {reason}")]
    Param {
        /// The path of the parameter.
        path: String,
        /// The reason.
        reason: String,
    },
    /// A value fails a check, see [`super::check`].
    #[error("{subject}: {field}: {reason}")]
    Invalid {
        /// The node or material, by name and id, or the environment.
        subject: String,
        /// The path of the value below the subject, such as `object.shape.radius`.
        field: String,
        /// The requirement.
        reason: String,
    },
}
