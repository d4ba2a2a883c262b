//! What an animation clip sets of nodes.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};

/// What a clip sets of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct NodePose {
    pub translation: Option<DVec3>,
    pub rotation: Option<DQuat>,
    pub scale: Option<DVec3>,
    pub weights: Option<Vec<f64>>,
}

/// What a clip sets, by node; empty at rest.
pub(super) type Poses = BTreeMap<usize, NodePose>;
