//! The file format, as types for serde and the schema. What older versions have different is a parameter of the types;
//! see [`super::old_version`].
//!
//! Values that most nodes share are left out, so that a file shows what is special.

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::json;

use super::animation::TrackFile;
use super::list::at_most;
use crate::limits::{MAX_APART, MAX_MATERIALS, MAX_NODES, MAX_TRACKS};
use crate::{
    BlendOverride, Bookmark, CameraNode, DisplaySettings, DynamicSlot, Environment, Group, Instancer, Light,
    MAX_BOOKMARKS, MAX_DYNAMICS, MAX_MODIFIERS, MarchSettings, Material, MaterialId, MeshNode, ModifierSlot, Node,
    NodeId, NodeKind, Object, Operation, PackedFiles, Timeline, whole,
};
use isolith_geometry::Transform;

/// The version that is written; every version up to it can be read.
pub const VERSION: u64 = 2;

/// A scene of Isolith. Lengths are meters, angles degrees, colors linear; +Y is up.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a scene in braces")]
#[serde(bound(deserialize = "M: Deserialize<'de>, E: Deserialize<'de>, L: Deserialize<'de>"))]
pub(super) struct SceneFile<M = Material, E: Default = Environment, L = Light> {
    /// Location of this schema, for text editors; the program ignores it.
    #[serde(rename = "$schema", default, skip_serializing)]
    pub schema: Option<String>,
    /// Version of the format.
    #[serde(deserialize_with = "whole::read")]
    pub isolith: u64,
    /// The environment.
    #[serde(default)]
    pub environment: E,
    /// How its light becomes the colors of a screen.
    #[serde(default)]
    pub display: DisplaySettings,
    /// Materials, in the artist's order.
    #[serde(default, deserialize_with = "at_most::<_, _, MAX_MATERIALS>")]
    pub materials: Vec<M>,
    /// The id of the next new node; ids are never reused.
    #[serde(default, deserialize_with = "whole::read")]
    pub next_id: u64,
    /// All nodes: each group is followed by its children, in the artist's order.
    #[serde(deserialize_with = "at_most::<_, _, MAX_NODES>")]
    pub nodes: Vec<NodeFile<L>>,
    /// The part of time that is played.
    #[serde(default, skip_serializing_if = "is_usual_timeline")]
    pub timeline: Timeline,
    /// Parameters that change with time.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "at_most::<_, _, MAX_TRACKS>")]
    pub tracks: Vec<TrackFile>,
    /// Views to come back to.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "at_most::<_, _, MAX_BOOKMARKS>")]
    pub bookmarks: Vec<Option<Bookmark>>,
    /// Files that travel within the scene: its models, with the buffers and images that these name.
    #[serde(default, skip_serializing_if = "PackedFiles::is_empty")]
    pub packed: PackedFiles,
}

/// A node: exactly one of `group`, `object`, `instancer`, `mesh`, `light`, `camera` gives its kind.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a node in braces")]
#[serde(bound(deserialize = "L: Deserialize<'de>"))]
pub(super) struct NodeFile<L = Light> {
    /// Identity; never changes.
    pub id: NodeId,
    /// Id of the group that contains it; none at the top.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<NodeId>,
    /// Display name.
    #[serde(default)]
    pub name: String,
    /// Hides the node and its subtree when false.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub visible: bool,
    /// Protected from selection and change in the viewport.
    #[serde(default, skip_serializing_if = "is_false")]
    pub locked: bool,
    /// What it does to those before it in its group. Earlier files say `negative` for what is subtracted.
    #[serde(default, alias = "negative", deserialize_with = "operation", skip_serializing_if = "is_added")]
    pub operation: Operation,
    /// How it blends with its siblings.
    #[serde(default, skip_serializing_if = "is_inherited")]
    pub joining: BlendOverride,
    /// Ids of siblings with which it does not blend.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "at_most::<_, _, MAX_APART>")]
    pub apart: Vec<NodeId>,
    /// The set of linked objects to which it belongs: all of a set have the same shape and material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linked: Option<u64>,
    /// Its place in its group.
    #[serde(default, skip_serializing_if = "TransformFile::is_identity")]
    pub transform: TransformFile,
    /// How often an instancer takes it as a type, in relation to its siblings.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub weight: f64,
    /// Motions of the node, or of each copy of an instancer, in order of application.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "at_most::<_, _, MAX_DYNAMICS>")]
    pub dynamics: Vec<DynamicSlot>,
    /// Modifiers of the node and its subtree, in order of application.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "at_most::<_, _, MAX_MODIFIERS>")]
    pub modifiers: Vec<ModifierSlot>,
    /// How the parts below it are marched.
    #[serde(default, skip_serializing_if = "MarchSettings::is_usual")]
    pub march: MarchSettings,
    /// Joins its children.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<Group>,
    /// A shape with a material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub object: Option<Object>,
    /// Places copies of its children.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instancer: Option<Box<Instancer>>,
    /// Triangles from a glTF file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshNode>,
    /// A light.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<L>,
    /// A viewpoint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraNode>,
}

/// Scale first, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a transform in braces")]
pub(super) struct TransformFile {
    /// The position of the origin.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub translation: [f64; 3],
    /// Unit quaternion x, y, z, w.
    #[serde(default = "no_rotation", skip_serializing_if = "is_no_rotation")]
    pub rotation: [f64; 4],
    /// Factor per axis; not zero.
    #[serde(default = "no_scale", skip_serializing_if = "is_no_scale")]
    pub scale: [f64; 3],
}

impl TransformFile {
    fn is_identity(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for TransformFile {
    fn default() -> Self {
        Transform::IDENTITY.into()
    }
}

impl From<Transform> for TransformFile {
    fn from(t: Transform) -> Self {
        Self { translation: t.translation.to_array(), rotation: t.rotation.to_array(), scale: t.scale.to_array() }
    }
}

impl From<TransformFile> for Transform {
    fn from(t: TransformFile) -> Self {
        Self {
            translation: DVec3::from_array(t.translation),
            rotation: DQuat::from_array(t.rotation),
            scale: DVec3::from_array(t.scale),
        }
    }
}

impl From<&Node> for NodeFile {
    fn from(node: &Node) -> Self {
        let mut out = Self {
            id: node.id,
            parent: node.parent,
            name: node.name.clone(),
            visible: node.visible,
            locked: node.locked,
            operation: node.operation,
            joining: node.blend_override,
            apart: node.apart.clone(),
            linked: node.linked,
            transform: node.transform.into(),
            weight: node.weight,
            dynamics: node.dynamics.clone(),
            modifiers: node.modifiers.clone(),
            march: node.march,
            group: None,
            object: None,
            instancer: None,
            mesh: None,
            light: None,
            camera: None,
        };
        match &node.kind {
            NodeKind::Group(v) => out.group = Some(*v),
            NodeKind::Object(v) => out.object = Some(v.clone()),
            NodeKind::Instancer(v) => out.instancer = Some(v.clone()),
            NodeKind::Mesh(v) => out.mesh = Some(v.clone()),
            NodeKind::Light(v) => out.light = Some(*v),
            NodeKind::Camera(v) => out.camera = Some(*v),
        }
        out
    }
}

impl NodeFile {
    /// The node, or `None` if it is not of exactly one kind.
    pub fn into_node(self) -> Option<Node> {
        let kinds = [
            self.group.map(NodeKind::Group),
            self.object.map(NodeKind::Object),
            self.instancer.map(NodeKind::Instancer),
            self.mesh.map(NodeKind::Mesh),
            self.light.map(NodeKind::Light),
            self.camera.map(NodeKind::Camera),
        ];
        let mut kinds = kinds.into_iter().flatten();
        let (kind, None) = (kinds.next()?, kinds.next()) else { return None };
        Some(Node {
            id: self.id,
            parent: self.parent,
            name: self.name,
            visible: self.visible,
            locked: self.locked,
            operation: self.operation,
            blend_override: self.joining,
            apart: self.apart,
            linked: self.linked,
            transform: self.transform.into(),
            weight: self.weight,
            dynamics: self.dynamics,
            modifiers: self.modifiers,
            march: self.march,
            kind,
        })
    }

    /// The referenced materials, with the places of the references.
    pub fn materials(&self) -> impl Iterator<Item = (MaterialId, &'static str)> {
        let of_object = self.object.as_ref().map(|o| (o.material, "object.material"));
        let of_mesh = self.mesh.as_ref().and_then(|m| m.material).map(|id| (id, "mesh.material"));
        let palette = self.instancer.iter().flat_map(|instancer| &instancer.palette);
        of_object.into_iter().chain(of_mesh).chain(palette.map(|id| (*id, "instancer.palette")))
    }
}

/// The JSON Schema of the format, generated from the types that read it. It does not contain the limits of numbers;
/// loading checks those.
pub fn schema() -> serde_json::Value {
    let mut schema = schemars::schema_for!(SceneFile).to_value();
    schema["title"] = "Isolith scene".into();
    schema["properties"]["isolith"]["const"] = VERSION.into();
    let kinds = ["group", "object", "instancer", "mesh", "light", "camera"];
    schema["$defs"]["NodeFile"]["oneOf"] = kinds.iter().map(|kind| json!({ "required": [kind] })).collect();
    schema
}

fn yes() -> bool {
    true
}

fn is_true(value: &bool) -> bool {
    *value
}

fn is_usual_timeline(value: &Timeline) -> bool {
    *value == Timeline::default()
}

fn one() -> f64 {
    1.0
}

fn is_one(value: &f64) -> bool {
    *value == one()
}

/// Reads an operation; in earlier files the node was subtracted, or not.
fn operation<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Operation, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "must be \"add\", \"subtract\" or \"intersect\"")]
    enum NameOrFlag {
        Name(Operation),
        Flag(bool),
    }
    Ok(match NameOrFlag::deserialize(deserializer)? {
        NameOrFlag::Name(operation) => operation,
        NameOrFlag::Flag(false) => Operation::Add,
        NameOrFlag::Flag(true) => Operation::Subtract,
    })
}

fn is_added(operation: &Operation) -> bool {
    *operation == Operation::Add
}

fn is_inherited(value: &BlendOverride) -> bool {
    *value == BlendOverride::Inherit
}

fn is_false(value: &bool) -> bool {
    !value
}

fn is_origin(value: &[f64; 3]) -> bool {
    *value == DVec3::ZERO.to_array()
}

fn no_rotation() -> [f64; 4] {
    DQuat::IDENTITY.to_array()
}

fn is_no_rotation(value: &[f64; 4]) -> bool {
    *value == no_rotation()
}

fn no_scale() -> [f64; 3] {
    DVec3::ONE.to_array()
}

fn is_no_scale(value: &[f64; 3]) -> bool {
    *value == no_scale()
}
