//! Nodes: the entries of the scene's table.

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Blend, Light, MaterialId, Operator, Shape};
use crate::geometry::Transform;

/// Stable identity of a node; never reused within a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct NodeId(pub u64);

impl std::fmt::Display for NodeId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// One entry of the scene's table.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Identity.
    pub id: NodeId,
    /// The group that holds it; `None` at the top.
    pub parent: Option<NodeId>,
    /// Name for people; need not be unique.
    pub name: String,
    /// Hidden nodes, and all below them, are not drawn and take no part in any operator.
    pub visible: bool,
    /// Locked nodes are not selected or changed through the viewport.
    pub locked: bool,
    /// Cut away from what precedes it in its group instead of joined; objects and groups only.
    pub negative: bool,
    /// Parent from local.
    pub transform: Transform,
    /// What it is.
    pub kind: NodeKind,
}

impl Node {
    /// A visible, unlocked, positive node at the origin. Its id is given by [`super::Scene::insert`].
    pub fn new(name: impl Into<String>, kind: NodeKind) -> Self {
        Self {
            id: NodeId(0),
            parent: None,
            name: name.into(),
            visible: true,
            locked: false,
            negative: false,
            transform: Transform::IDENTITY,
            kind,
        }
    }

    /// The same node somewhere else.
    pub fn at(mut self, translation: DVec3) -> Self {
        self.transform.translation = translation;
        self
    }

    /// The same node turned.
    pub fn rotated(mut self, rotation: DQuat) -> Self {
        self.transform.rotation = rotation;
        self
    }

    /// The same node scaled.
    pub fn scaled(mut self, scale: DVec3) -> Self {
        self.transform.scale = scale;
        self
    }

    /// The same node cut away instead of joined.
    pub fn negative(mut self) -> Self {
        self.negative = true;
        self
    }

    /// Whether it can be an operand: only objects and groups have a field.
    pub fn has_field(&self) -> bool {
        matches!(self.kind, NodeKind::Group(_) | NodeKind::Object(_))
    }
}

/// What a node is.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeKind {
    /// Joins its children.
    Group(Group),
    /// A shape with a material.
    Object(Object),
    /// Triangles from a glTF file, rasterised.
    Mesh(MeshNode),
    /// A light.
    Light(Light),
    /// A viewpoint.
    Camera(CameraNode),
}

/// Joins its children with one operator, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// How each later child joins what precedes it.
    pub operator: Operator,
    /// How round the joints are, those of negative children too.
    pub blend: Blend,
}

impl Group {
    /// A hard union: what a new group is.
    pub const UNION: Self = Self { operator: Operator::Union, blend: Blend::HARD };
}

/// A shape with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// The shape, in local space.
    pub shape: Shape,
    /// A material of the scene.
    pub material: MaterialId,
}

/// Triangles from a glTF file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshNode {
    /// Path of a .gltf or .glb file, relative to the scene's folder, with forward slashes.
    pub path: String,
    /// A material instead of the file's own.
    pub material: Option<MaterialId>,
}

/// A viewpoint; looks along local −Z with +Y up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraNode {
    /// Full vertical angle of view, in degrees.
    pub fov_y: f64,
    /// Nearest distance seen, in metres.
    pub near: f64,
    /// Farthest distance seen, in metres.
    pub far: f64,
}
