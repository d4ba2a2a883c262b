//! Paths: names for every parameter of a scene.
//!
//! In text a path is the owner and the field as files and their errors name it: `node.12.object.shape.radius`,
//! `node.12.modifiers[0].modifier.angle`, `node.12.transform.translation[1]`, `material.3.base_color`,
//! `environment.background.sky`, `display.exposure`.

mod of_scene;

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use super::params::{Param, ParamValue, Params};
use super::{DisplaySettings, Environment, Material, MaterialId, Node, NodeId, NodeKind, SceneError};

/// Names a parameter of a scene, or one element of a parameter with three.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParamPath {
    /// The owner of the parameter.
    pub owner: ParamOwner,
    /// The parameter's key in files, below its owner: `radius`, `blend.radius`.
    pub name: Cow<'static, str>,
    /// Index of one of its three elements; `None` for the whole value.
    pub element: Option<usize>,
}

/// An owner of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ParamOwner {
    /// A part of a node.
    Node(NodeId, Part),
    /// A material.
    Material(MaterialId),
    /// The environment.
    Environment,
    /// The display settings.
    Display,
}

/// A part of a node that has parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// The node itself: visibility, blending.
    Node,
    /// Its transform.
    Transform,
    /// How it is marched.
    March,
    /// The modifier at this index of its list.
    Modifier(usize),
    /// The motion at this index of its list.
    Dynamic(usize),
    /// An instancer.
    Instancer,
    /// The mask at this index of an instancer's list.
    Mask(usize),
    /// The shape of an object.
    Shape,
    /// The operator of a group.
    Operator,
    /// The file of a mesh.
    Mesh,
    /// A light.
    Light,
    /// A camera.
    Camera,
}

impl Part {
    /// The parts of the node, in the order of files.
    pub fn of(node: &Node) -> impl Iterator<Item = Self> {
        let kind = match &node.kind {
            NodeKind::Group(_) => Self::Operator,
            NodeKind::Object(_) => Self::Shape,
            NodeKind::Instancer(_) => Self::Instancer,
            NodeKind::Mesh(_) => Self::Mesh,
            NodeKind::Light(_) => Self::Light,
            NodeKind::Camera(_) => Self::Camera,
        };
        let masks = if let NodeKind::Instancer(instancer) = &node.kind { instancer.masks.len() } else { 0 };
        let dynamics = (0..node.dynamics.len()).map(Self::Dynamic);
        let modifiers = (0..node.modifiers.len()).map(Self::Modifier);
        let lists = dynamics.chain(modifiers).chain([kind]).chain((0..masks).map(Self::Mask));
        let march = node.can_move().then_some(Self::March);
        [Self::Node, Self::Transform].into_iter().chain(march).chain(lists)
    }

    /// The parameters of this part of the node, if it exists.
    pub fn params(self, node: &Node) -> Option<&dyn Params> {
        Some(match (self, &node.kind) {
            (Self::Node, _) => node,
            (Self::Transform, _) => &node.transform,
            (Self::March, _) => &node.march,
            (Self::Modifier(place), _) => node.modifiers.get(place)?,
            (Self::Dynamic(place), _) => node.dynamics.get(place)?,
            (Self::Instancer, NodeKind::Instancer(instancer)) => &**instancer,
            (Self::Mask(place), NodeKind::Instancer(instancer)) => instancer.masks.get(place)?,
            (Self::Shape, NodeKind::Object(object)) => &object.shape,
            (Self::Operator, NodeKind::Group(group)) => group,
            (Self::Mesh, NodeKind::Mesh(mesh)) => mesh,
            (Self::Light, NodeKind::Light(light)) => light,
            (Self::Camera, NodeKind::Camera(camera)) => camera,
            _ => return None,
        })
    }

    /// The same parameters, mutable.
    pub fn params_mut(self, node: &mut Node) -> Option<&mut dyn Params> {
        if self == Self::Node {
            return Some(node);
        }
        Some(match (self, &mut node.kind) {
            (Self::Transform, _) => &mut node.transform,
            (Self::March, _) => &mut node.march,
            (Self::Modifier(place), _) => node.modifiers.get_mut(place)?,
            (Self::Dynamic(place), _) => node.dynamics.get_mut(place)?,
            (Self::Instancer, NodeKind::Instancer(instancer)) => &mut **instancer,
            (Self::Mask(place), NodeKind::Instancer(instancer)) => instancer.masks.get_mut(place)?,
            (Self::Shape, NodeKind::Object(object)) => &mut object.shape,
            (Self::Operator, NodeKind::Group(group)) => group,
            (Self::Mesh, NodeKind::Mesh(mesh)) => mesh,
            (Self::Light, NodeKind::Light(light)) => light,
            (Self::Camera, NodeKind::Camera(camera)) => camera,
            _ => return None,
        })
    }

    /// The path of the parameter's field in files, below the node.
    pub fn field(self, name: &str) -> String {
        let (part, inner, place) = match self {
            Self::Node => return name.to_owned(),
            Self::Transform => return format!("transform.{name}"),
            Self::March => return format!("march.{name}"),
            Self::Shape => return format!("object.shape.{name}"),
            Self::Operator => return format!("group.{name}"),
            Self::Instancer => return format!("instancer.{name}"),
            Self::Mesh => return format!("mesh.{name}"),
            Self::Light => return format!("light.{name}"),
            Self::Camera => return format!("camera.{name}"),
            Self::Modifier(place) => ("modifiers", "modifier", place),
            Self::Dynamic(place) => ("dynamics", "dynamic", place),
            Self::Mask(place) => ("instancer.masks", "mask", place),
        };
        let is_of_slot = SLOTS.iter().any(|slot| slot.prefix == part && slot.own.contains(&name));
        if is_of_slot { format!("{part}[{place}].{name}") } else { format!("{part}[{place}].{inner}.{name}") }
    }

    /// The part and the parameter's name for a field in files; the inverse of [`Part::field`].
    fn of_field(field: &str) -> Option<(Self, &str)> {
        const PARTS: [(&str, Part); 8] = [
            ("transform.", Part::Transform),
            ("march.", Part::March),
            ("object.shape.", Part::Shape),
            ("group.", Part::Operator),
            ("instancer.", Part::Instancer),
            ("mesh.", Part::Mesh),
            ("light.", Part::Light),
            ("camera.", Part::Camera),
        ];
        for slot in &SLOTS {
            let Some(rest) = field.strip_prefix(slot.prefix).and_then(|rest| rest.strip_prefix('[')) else { continue };
            let (place, rest) = rest.split_once("].")?;
            let below = |rest: &'_ str| rest.strip_prefix(slot.inner)?.strip_prefix('.').map(str::len);
            let name = match below(rest) {
                Some(length) => &rest[rest.len() - length..],
                None if slot.own.contains(&rest) => rest,
                None => return None,
            };
            let is_misplaced = slot.own.contains(&name) && below(rest).is_some();
            return (!is_misplaced).then_some(((slot.part)(whole(place)?), name));
        }
        for (prefix, part) in PARTS {
            if let Some(name) = field.strip_prefix(prefix) {
                return Some((part, name));
            }
        }
        Some((Self::Node, field))
    }
}

/// A list of parts: its field, the field of the part in an entry, and the parameters that belong to the entry itself.
struct SlotList {
    prefix: &'static str,
    inner: &'static str,
    own: &'static [&'static str],
    part: fn(usize) -> Part,
}

const SLOTS: [SlotList; 3] = [
    SlotList { prefix: "modifiers", inner: "modifier", own: &["enabled"], part: Part::Modifier },
    SlotList { prefix: "dynamics", inner: "dynamic", own: &["enabled"], part: Part::Dynamic },
    SlotList { prefix: "instancer.masks", inner: "mask", own: &["inverted", "join"], part: Part::Mask },
];

/// A number in the form that paths use: without a sign or leading zeros.
fn whole<T: FromStr + fmt::Display>(text: &str) -> Option<T> {
    text.parse().ok().filter(|number: &T| number.to_string() == text)
}

impl ParamPath {
    /// A parameter of a part of a node.
    pub fn of_node(id: NodeId, part: Part, name: impl Into<Cow<'static, str>>) -> Self {
        Self { owner: ParamOwner::Node(id, part), name: name.into(), element: None }
    }

    /// A parameter of a material.
    pub fn of_material(id: MaterialId, name: impl Into<Cow<'static, str>>) -> Self {
        Self { owner: ParamOwner::Material(id), name: name.into(), element: None }
    }

    /// A parameter of the environment.
    pub fn of_environment(name: impl Into<Cow<'static, str>>) -> Self {
        Self { owner: ParamOwner::Environment, name: name.into(), element: None }
    }

    /// A parameter of the display settings.
    pub fn of_display(name: impl Into<Cow<'static, str>>) -> Self {
        Self { owner: ParamOwner::Display, name: name.into(), element: None }
    }

    /// The path of one of the parameter's three elements.
    pub fn element(self, index: usize) -> Self {
        Self { element: Some(index), ..self }
    }

    /// All parameters of a node, in the order of files, with their values.
    pub fn all_of_node(node: &Node) -> Vec<(Self, &'static Param, ParamValue)> {
        let mut all = Vec::new();
        for part in Part::of(node) {
            if let Some(params) = part.params(node) {
                collect(ParamOwner::Node(node.id, part), params, &mut all);
            }
        }
        all
    }

    /// Its value in a node, whatever the node's id; `None` if the node has no such parameter.
    pub fn get_in(&self, node: &Node) -> Option<ParamValue> {
        let ParamOwner::Node(_, part) = self.owner else { return None };
        self.value_in(part.params(node)?)
    }

    /// Sets it in a node, whatever the node's id. Returns false and changes nothing if the node has no such parameter
    /// or the value is of another type. Does not check limits.
    pub fn set_in(&self, node: &mut Node, value: ParamValue) -> bool {
        let ParamOwner::Node(_, part) = self.owner else { return false };
        part.params_mut(node).is_some_and(|params| self.set_value(params, value))
    }

    /// Its value among the parameters of an owner, whatever the owner is; `None` if they hold no such parameter.
    pub fn value_in(&self, params: &dyn Params) -> Option<ParamValue> {
        let value = params.get(&self.name)?;
        self.element.map_or_else(|| Some(value.clone()), |index| value.element(index))
    }

    /// Sets it among the parameters of an owner. Returns false and changes nothing if they hold no such parameter or the
    /// value is of another type. Does not check limits.
    pub fn set_value(&self, params: &mut dyn Params, value: ParamValue) -> bool {
        let new = match self.element {
            None => Some(value),
            Some(index) => params.get(&self.name).and_then(|whole| whole.with_element(index, &value)),
        };
        new.is_some_and(|new| params.set(&self.name, new))
    }

    fn refused(&self, reason: impl Into<String>) -> SceneError {
        SceneError::Param { path: self.to_string(), reason: reason.into() }
    }

    fn no_part(&self) -> SceneError {
        self.refused("the node has no such part")
    }

    fn unknown(&self, params: &dyn Params) -> SceneError {
        if params.find(&self.name).is_some() {
            return self.refused("it has no such element");
        }
        let mut names = Vec::new();
        params.visit("", &mut |prefix, param, _| names.push(format!("{prefix}{}", param.name)));
        self.refused(format!("there is no such parameter; there is {}", names.join(", ")))
    }
}

fn collect(owner: ParamOwner, params: &dyn Params, all: &mut Vec<(ParamPath, &'static Param, ParamValue)>) {
    params.visit("", &mut |prefix, param, value| {
        let name = if prefix.is_empty() { param.name.into() } else { format!("{prefix}{}", param.name).into() };
        all.push((ParamPath { owner, name, element: None }, param, value));
    });
}

/// The owner of a parameter, after a change of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Changed {
    /// A node.
    Node(Box<Node>),
    /// A material.
    Material(Box<Material>),
    /// The environment.
    Environment(Environment),
    /// The display settings.
    Display(DisplaySettings),
}

impl fmt::Display for ParamPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.owner {
            ParamOwner::Node(id, part) => write!(f, "node.{}.{}", id.0, part.field(&self.name)),
            ParamOwner::Material(id) => write!(f, "material.{}.{}", id.0, self.name),
            ParamOwner::Environment => write!(f, "environment.{}", self.name),
            ParamOwner::Display => write!(f, "display.{}", self.name),
        }?;
        self.element.map_or(Ok(()), |index| write!(f, "[{index}]"))
    }
}

impl FromStr for ParamPath {
    type Err = SceneError;

    fn from_str(text: &str) -> Result<Self, SceneError> {
        parse(text).ok_or_else(|| SceneError::Param {
            path: text.to_owned(),
            reason: "is not the path of a parameter, such as node.12.object.shape.radius, material.3.base_color[0] or environment.background.sky"
                .into(),
        })
    }
}

fn parse(text: &str) -> Option<ParamPath> {
    let (text, element) = match text.strip_suffix(']').and_then(|text| text.rsplit_once('[')) {
        Some((text, index)) => (text, Some(whole::<usize>(index)?)),
        None => (text, None),
    };
    let (owner, rest) = text.split_once('.')?;
    let (owner, name) = match owner {
        "environment" => (ParamOwner::Environment, rest),
        "display" => (ParamOwner::Display, rest),
        "material" => {
            let (id, name) = rest.split_once('.')?;
            (ParamOwner::Material(MaterialId(whole(id)?)), name)
        }
        "node" => {
            let (id, field) = rest.split_once('.')?;
            let (part, name) = Part::of_field(field)?;
            (ParamOwner::Node(NodeId(whole(id)?), part), name)
        }
        _ => return None,
    };
    let is_name = |word: &str| {
        !word.is_empty() && word.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_')
    };
    name.split('.').all(is_name).then(|| ParamPath { owner, name: name.to_owned().into(), element })
}
