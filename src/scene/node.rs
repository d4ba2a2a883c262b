//! Nodes: the entries of the scene's table.

use glam::{DQuat, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{
    APERTURE, BAKED_VOXELS, CLIP, CLIP_NAME_LENGTH, CLIP_SPEED, CLIP_TIME, FOV, NO_LIMITS, PATH_LENGTH, POSITION,
    SCALE, SHUTTER, THICKNESS, UNIT, WEIGHT,
};
use super::node_id::NodeId;
use super::params::{param_struct, param_table};
use super::{
    Blend, BlendOverride, Dynamic, DynamicSlot, Instancer, Light, MarchSettings, MaterialId, Modifier, ModifierSlot,
    Operation, Operator, Shape,
};
use isolith_geometry::Transform;

/// One entry of the scene's table.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Identity.
    pub id: NodeId,
    /// The group that contains it; `None` at the top.
    pub parent: Option<NodeId>,
    /// Display name; need not be unique.
    pub name: String,
    /// Hidden nodes and their subtrees are not drawn and take no part in any operator. A hidden first child can hide
    /// its whole group, see [`Operator::needs_first`].
    pub visible: bool,
    /// The viewport neither selects nor changes locked nodes.
    pub locked: bool,
    /// What it does to those before it in its group; only objects and groups do something else than
    /// [`Operation::Add`].
    pub operation: Operation,
    /// How it blends with its siblings; objects and groups only.
    pub blend_override: BlendOverride,
    /// Siblings with which it does not blend; it holds in both directions. Ids of other nodes have no effect. Objects
    /// and groups only.
    pub apart: Vec<NodeId>,
    /// The set of linked objects to which it belongs: they share shape and material, and each keeps its own place, role,
    /// modifiers and dynamics. Objects only.
    pub linked: Option<u64>,
    /// Parent from local.
    pub transform: Transform,
    /// How often an instancer takes it as the type of a copy, in relation to its siblings; children of instancers only.
    pub weight: f64,
    /// Motions of the node, or of each copy of an instancer, in order of application; objects, groups and instancers
    /// only.
    pub dynamics: Vec<DynamicSlot>,
    /// The modifiers of the node and its subtree, in its own space, in order of application; objects and groups only.
    pub modifiers: Vec<ModifierSlot>,
    /// How the parts below it are marched; objects, groups and instancers only. The nearest node above a part that has
    /// other settings than the usual ones decides.
    pub march: MarchSettings,
    /// The kind of the node, with its data.
    pub kind: NodeKind,
}

impl Node {
    /// A visible, unlocked, added node at the origin. [`super::Scene::insert`] assigns its id.
    pub fn new(name: impl Into<String>, kind: NodeKind) -> Self {
        Self {
            id: NodeId(0),
            parent: None,
            name: name.into(),
            visible: true,
            locked: false,
            operation: Operation::Add,
            blend_override: BlendOverride::Inherit,
            apart: Vec::new(),
            linked: None,
            transform: Transform::IDENTITY,
            weight: 1.0,
            dynamics: Vec::new(),
            modifiers: Vec::new(),
            march: MarchSettings::default(),
            kind,
        }
    }

    /// The same node at this translation.
    pub fn at(mut self, translation: DVec3) -> Self {
        self.transform.translation = translation;
        self
    }

    /// The same node with this rotation.
    pub fn rotated(mut self, rotation: DQuat) -> Self {
        self.transform.rotation = rotation;
        self
    }

    /// The same node with this scale.
    pub fn scaled(mut self, scale: DVec3) -> Self {
        self.transform.scale = scale;
        self
    }

    /// The same node, subtracted instead of added.
    pub fn subtracted(mut self) -> Self {
        self.operation = Operation::Subtract;
        self
    }

    /// The same node, intersected instead of added.
    pub fn intersected(mut self) -> Self {
        self.operation = Operation::Intersect;
        self
    }

    /// The same node with one more modifier, behind the others.
    pub fn modified(mut self, modifier: Modifier) -> Self {
        self.modifiers.push(modifier.into());
        self
    }

    /// The same node with one more motion, behind the others.
    pub fn moving(mut self, dynamic: Dynamic) -> Self {
        self.dynamics.push(dynamic.into());
        self
    }

    /// The same node, taken this often as a type.
    pub fn weighted(mut self, weight: f64) -> Self {
        self.weight = weight;
        self
    }

    /// Whether it is joined by the operator of its group; others act on what stands before them and need something
    /// there.
    pub fn adds(&self) -> bool {
        self.operation == Operation::Add
    }

    /// The same node, marched in this manner.
    pub fn marched(mut self, march: MarchSettings) -> Self {
        self.march = march;
        self
    }

    /// Whether an instancer can make copies of it.
    pub fn can_be_type(&self) -> bool {
        self.has_field() || matches!(self.kind, NodeKind::Mesh(_))
    }

    /// Whether it can be an operand: only objects and groups have a field of their own.
    pub fn has_field(&self) -> bool {
        matches!(self.kind, NodeKind::Group(_) | NodeKind::Object(_))
    }

    /// Whether it can have dynamics, and settings of its march.
    pub fn can_move(&self) -> bool {
        self.has_field() || matches!(self.kind, NodeKind::Instancer(_))
    }

    /// The materials that it names.
    pub fn materials(&self) -> impl Iterator<Item = MaterialId> {
        let (one, palette) = match &self.kind {
            NodeKind::Object(object) => (Some(object.material), &[][..]),
            NodeKind::Mesh(mesh) => (mesh.material, &[][..]),
            NodeKind::Instancer(instancer) => (None, &instancer.palette[..]),
            NodeKind::Group(_) | NodeKind::Light(_) | NodeKind::Camera(_) => (None, &[][..]),
        };
        one.into_iter().chain(palette.iter().copied())
    }

    /// Replaces the ids of other nodes that it names, for a copy together with them; `None` keeps an id.
    pub fn rename_references(&mut self, new: impl Fn(NodeId) -> Option<NodeId>) {
        for id in &mut self.apart {
            *id = new(*id).unwrap_or(*id);
        }
        if let NodeKind::Instancer(instancer) = &mut self.kind {
            instancer.target = instancer.target.map(|id| new(id).unwrap_or(id));
        }
    }

    /// Replaces the ids of its materials, for a copy in another scene; `None` keeps an id.
    pub fn rename_materials(&mut self, new: impl Fn(MaterialId) -> Option<MaterialId>) {
        let rename = |id: &mut MaterialId| *id = new(*id).unwrap_or(*id);
        match &mut self.kind {
            NodeKind::Object(object) => rename(&mut object.material),
            NodeKind::Mesh(mesh) => mesh.material.iter_mut().for_each(rename),
            NodeKind::Instancer(instancer) => instancer.palette.iter_mut().for_each(rename),
            NodeKind::Group(_) | NodeKind::Light(_) | NodeKind::Camera(_) => {}
        }
    }

    /// Whether other nodes can be its children.
    pub fn has_children(&self) -> bool {
        matches!(self.kind, NodeKind::Group(_) | NodeKind::Instancer(_))
    }
}

/// The kind of a node, with its data.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeKind {
    /// Joins its children.
    Group(Group),
    /// A shape with a material.
    Object(Object),
    /// Copies of its children.
    Instancer(Box<Instancer>),
    /// Triangles from a glTF file, rasterized.
    Mesh(MeshNode),
    /// A light.
    Light(Light),
    /// A viewpoint.
    Camera(CameraNode),
}

param_struct! {
    /// Joins its children with one operator, in their order.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Group {
        /// How each later child joins what precedes it.
        operator: Operator = Operator::Union, NO_LIMITS;
        /// How round the blends are, those of negative children too.
        blend: Blend = Blend::HARD, NO_LIMITS;
        /// Full width of grooves and tongues, diameter of pipes.
        #[serde(default = "usual_width", skip_serializing_if = "is_usual_width")]
        width: f64 = usual_width(), THICKNESS;
        /// Depth of grooves and engravings, height of tongues.
        #[serde(default = "usual_depth", skip_serializing_if = "is_usual_depth")]
        depth: f64 = usual_depth(), THICKNESS;
        /// How far a morph has come, from 0, the first child, to 1, the next.
        #[serde(default = "half", skip_serializing_if = "is_half")]
        share: f64 = half(), UNIT;
        /// Voxels along the longest side of bricks that are drawn in place of the content, quicker where it is made of
        /// much; 0 for none.
        #[serde(default, skip_serializing_if = "is_zero")]
        bake: f64 = 0.0, BAKED_VOXELS.fixed().labeled("Bake resolution");
    }
}

const fn usual_width() -> f64 {
    0.1
}

fn is_usual_width(width: &f64) -> bool {
    *width == usual_width()
}

const fn usual_focus() -> f64 {
    5.0
}

fn is_usual_focus(distance: &f64) -> bool {
    *distance == usual_focus()
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

const fn usual_depth() -> f64 {
    0.05
}

fn is_usual_depth(depth: &f64) -> bool {
    *depth == usual_depth()
}

const fn half() -> f64 {
    0.5
}

fn is_half(share: &f64) -> bool {
    *share == half()
}

impl Group {
    /// A hard union: the default of a new group.
    pub const UNION: Self = Self::new(Operator::Union, Blend::HARD);

    /// A group with the default width, depth and share.
    pub const fn new(operator: Operator, blend: Blend) -> Self {
        Self { operator, blend, width: usual_width(), depth: usual_depth(), share: half(), bake: 0.0 }
    }
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
    /// The animation clip that poses it, by its name or its number in the file; empty for the rest pose.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub clip: String,
    /// Where in the clip the scene begins.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub clip_time: f64,
    /// How fast the clip runs.
    #[serde(default = "usual_speed", skip_serializing_if = "is_usual_speed")]
    pub clip_speed: f64,
}

const fn usual_speed() -> f64 {
    1.0
}

fn is_usual_speed(speed: &f64) -> bool {
    *speed == usual_speed()
}

impl MeshNode {
    /// A model in its rest pose, with its own materials.
    pub fn new(path: impl Into<String>) -> Self {
        Self { path: path.into(), material: None, clip: String::new(), clip_time: 0.0, clip_speed: usual_speed() }
    }
}

param_struct! {
    /// A viewpoint; looks along local −Z with +Y up.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct CameraNode {
        /// Full vertical angle of view.
        fov_y: f64 = 40.0, FOV.labeled("Field of view");
        /// Nothing nearer is seen: from the eye along the ray of each pixel, as depth is, not along the view axis.
        near: f64 = 0.01, CLIP.labeled("Clip start");
        /// Nothing farther is seen, along the ray of each pixel.
        far: f64 = 1_000.0, CLIP.labeled("Clip end");
        /// Diameter of the lens's opening: depth of field in stills of several samples. 0 sees everything sharp.
        #[serde(default, skip_serializing_if = "is_zero")]
        aperture: f64 = 0.0, APERTURE;
        /// Distance of what is sharp, along the view axis.
        #[serde(default = "usual_focus", skip_serializing_if = "is_usual_focus")]
        focus_distance: f64 = usual_focus(), CLIP.labeled("Focus distance");
        /// How long the shutter is open, around the moment of the picture: motion blur in stills of several samples. 0
        /// stops all motion.
        #[serde(default, skip_serializing_if = "is_zero")]
        shutter: f64 = 0.0, SHUTTER;
    }
}

param_table! { Node {
    /// Hidden, with all below it, when off.
    visible: bool = true, NO_LIMITS.fixed();
    /// Protected from selection and change in the viewport.
    locked: bool = false, NO_LIMITS.fixed();
    /// What the node does to those before it in its group; objects and groups only.
    operation: Operation = Operation::Add, NO_LIMITS.fixed();
    /// How this node blends with its siblings; objects and groups only.
    blend_override as "joining": BlendOverride = BlendOverride::Inherit, NO_LIMITS.labeled("Blend");
    /// How often an instancer takes it as the type of a copy, in relation to its siblings; children of instancers only.
    weight: f64 = 1.0, WEIGHT;
} }

param_table! { Transform {
    /// Where the node stands in its group.
    translation: DVec3 = DVec3::ZERO, POSITION.labeled("Position");
    /// A unit quaternion.
    rotation: DQuat = DQuat::IDENTITY, NO_LIMITS;
    /// Factor along each local axis; negative mirrors, zero is refused.
    scale: DVec3 = DVec3::ONE, SCALE;
} }

param_table! { MeshNode {
    /// A .gltf or .glb file, relative to the scene's folder, with forward slashes.
    path: String = String::new(), PATH_LENGTH.labeled("File");
    /// The animation clip that poses it, by its name or its number in the file; empty for the rest pose.
    clip: String = String::new(), CLIP_NAME_LENGTH;
    /// Where in the clip the scene begins.
    clip_time: f64 = 0.0, CLIP_TIME;
    /// How fast the clip runs; negative is backward, 0 stands still.
    clip_speed: f64 = usual_speed(), CLIP_SPEED;
} }
