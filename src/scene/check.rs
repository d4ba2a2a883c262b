//! What the values of a scene must be, one by one: finite, within [`super::limits`], and at peace with
//! each other. Files are checked with this on the way in and on the way out, edits on the way through.

use glam::DQuat;

use super::drawn::text_fault;
use super::limits::{
    ATTENUATION, BLEND_RADIUS, CLIP, CONE, FOV, INTENSITY, Limits, MAX_APART, MAX_NAME, MAX_PATH, MAX_TEXT, POSITION,
    RANGE, SCALE, SHININESS, STEPS, THICKNESS, UNIT,
};
use super::{
    Attenuation, BlendOverride, CameraNode, Environment, Group, Light, LightKind, List, MAX_MODIFIERS, Material,
    MeshNode, Modifier, ModifierValue, Node, NodeKind, ParamValue, SceneError, Shape,
};
use crate::geometry::Transform;

/// A value that is not what it must be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Which value, as a path below the node, the material or the environment.
    pub field: String,
    /// What it must be, and what it is.
    pub reason: String,
}

impl Fault {
    fn new(field: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { field: field.into(), reason: reason.into() }
    }

    /// The same fault, seen from one level higher.
    fn below(mut self, outer: &str) -> Self {
        self.field = format!("{outer}.{}", self.field);
        self
    }

    /// The fault as the reason why an edit was refused.
    pub fn into_error(self, subject: impl Into<String>) -> SceneError {
        SceneError::Invalid { subject: subject.into(), field: self.field, reason: self.reason }
    }
}

/// Checks every value of a node by itself; ids and references are the table's business.
pub fn node(node: &Node) -> Result<(), Fault> {
    name(&node.name)?;
    if node.negative && !node.has_field() {
        return Err(Fault::new("negative", "only objects and groups can be negative"));
    }
    if let BlendOverride::Radius(radius) = node.blend_override {
        number("joining.radius", radius, &BLEND_RADIUS)?;
    }
    if node.apart.len() > MAX_APART {
        return Err(Fault::new("apart", format!("must name at most {MAX_APART} nodes, not {}", node.apart.len())));
    }
    transform(&node.transform).map_err(|f| f.below("transform"))?;
    if !node.modifiers.is_empty() && !node.has_field() {
        return Err(Fault::new("modifiers", "only objects and groups can have modifiers"));
    }
    if node.modifiers.len() > MAX_MODIFIERS {
        return Err(Fault::new("modifiers", format!("must be at most {MAX_MODIFIERS} of them")));
    }
    for (i, slot) in node.modifiers.iter().enumerate() {
        modifier(&slot.modifier).map_err(|f| f.below(&format!("modifiers[{i}].modifier")))?;
    }
    match &node.kind {
        NodeKind::Group(g) => group(g).map_err(|f| f.below("group")),
        NodeKind::Object(o) => shape(&o.shape).map_err(|f| f.below("object.shape")),
        NodeKind::Mesh(m) => mesh(m).map_err(|f| f.below("mesh")),
        NodeKind::Light(l) => light(l).map_err(|f| f.below("light")),
        NodeKind::Camera(c) => camera(c).map_err(|f| f.below("camera")),
    }
}

/// Checks every value of a material.
pub fn material(material: &Material) -> Result<(), Fault> {
    name(&material.name)?;
    vector("albedo", material.albedo, &UNIT)?;
    number("specular", material.specular, &UNIT)?;
    number("shininess", material.shininess, &SHININESS)?;
    vector("emission", material.emission, &INTENSITY)
}

/// Checks every value of an environment.
pub fn environment(environment: &Environment) -> Result<(), Fault> {
    vector("sky", environment.sky, &INTENSITY)?;
    vector("horizon", environment.horizon, &INTENSITY)?;
    vector("ambient", environment.ambient, &INTENSITY)
}

/// How far from 1 the length of a quaternion may be to be taken for a rotation at all.
const UNIT_TOLERANCE: f64 = 1e-3;
/// Up to here the length counts as 1 and the numbers are left as they are, so that a file keeps its bytes.
const UNIT_EXACT: f64 = 1e-12;

/// The unit quaternion that is meant: nearly unit ones are normalized, exact ones left alone.
/// Anything else comes back as it is, for [`node`] to refuse.
pub fn settled_rotation(rotation: DQuat) -> DQuat {
    let off = (rotation.length() - 1.0).abs();
    if off > UNIT_EXACT && off <= UNIT_TOLERANCE { rotation.normalize() } else { rotation }
}

/// The node with its rotation settled, see [`settled_rotation`].
pub fn settled(mut node: Node) -> Node {
    node.transform.rotation = settled_rotation(node.transform.rotation);
    node
}

/// Checks the path of a mesh file: relative, with forward slashes, inside the scene's folder.
pub fn mesh_path(path: &str) -> Result<(), String> {
    let refuse = |reason: &str| Err(format!("{reason}, not {path:?}"));
    if path.chars().count() > MAX_PATH {
        return Err(format!("must be at most {MAX_PATH} characters long"));
    }
    if path.is_empty() {
        return refuse("must name a file");
    }
    if path.chars().any(char::is_control) {
        return refuse("must not hold control characters");
    }
    if path.contains('\\') {
        return refuse("must be written with forward slashes");
    }
    if path.starts_with('/') || path.contains(':') {
        return refuse("must be relative to the scene's folder");
    }
    if path.split('/').any(|part| matches!(part, "" | "." | "..")) {
        return refuse("must lead straight to a file inside the scene's folder");
    }
    Ok(())
}

fn name(name: &str) -> Result<(), Fault> {
    if name.chars().count() > MAX_NAME {
        return Err(Fault::new("name", format!("must be at most {MAX_NAME} characters long")));
    }
    if name.chars().any(char::is_control) {
        return Err(Fault::new("name", format!("must not hold control characters, such as in {name:?}")));
    }
    Ok(())
}

fn transform(transform: &Transform) -> Result<(), Fault> {
    vector("translation", transform.translation.to_array(), &POSITION)?;
    let length = transform.rotation.length();
    if !length.is_finite() || (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(Fault::new("rotation", format!("must be a quaternion of length 1, not of length {length}")));
    }
    for (i, factor) in transform.scale.to_array().into_iter().enumerate() {
        if !SCALE.accept(factor.abs()) {
            let [least, most] = SCALE.hard.map(plain);
            let reason = format!("must be {least} to {most} in magnitude, not {}", plain(factor));
            return Err(Fault::new(format!("scale[{i}]"), reason));
        }
    }
    Ok(())
}

fn group(group: &Group) -> Result<(), Fault> {
    number("blend.radius", group.blend.radius, &BLEND_RADIUS)?;
    number("blend.steps", group.blend.steps.into(), &STEPS)?;
    number("width", group.width, &THICKNESS)?;
    number("depth", group.depth, &THICKNESS)?;
    number("share", group.share, &UNIT)
}

/// Every parameter against the limits in its shape's own table.
fn shape(shape: &Shape) -> Result<(), Fault> {
    for (param, value) in shape.kind().params().iter().zip(shape.values()) {
        match value {
            ParamValue::Scalar(v) => number(param.name, v, &param.limits)?,
            ParamValue::Vector(v) => vector(param.name, v.to_array(), &param.limits)?,
            // A file was checked when it was read.
            ParamValue::Flag(_) | ParamValue::File(_) => {}
            ParamValue::Text(text) => letters(param.name, &text)?,
            ParamValue::List(list) => self::list(param.name, &list, &param.limits)?,
        }
    }
    if let Shape::Text { text, font, .. } = shape
        && let Some(reason) = text_fault(text, font)
    {
        return Err(Fault::new(if font.name().is_some() { "font" } else { "text" }, reason));
    }
    Ok(())
}

fn letters(field: &str, text: &str) -> Result<(), Fault> {
    let count = text.chars().count();
    if count > MAX_TEXT {
        return Err(Fault::new(field, format!("must be at most {MAX_TEXT} letters long, not {count}")));
    }
    if text.chars().any(|c| c.is_control() && c != '\n') {
        return Err(Fault::new(field, format!("must not hold control characters, such as in {text:?}")));
    }
    Ok(())
}

/// How many rows a list has, and every number in it.
fn list(field: &str, list: &List, limits: &Limits) -> Result<(), Fault> {
    let [least, most] = list.count;
    if list.rows.len() < least || list.rows.len() > most {
        return Err(Fault::new(field, format!("must be {least} to {most} points, not {}", list.rows.len())));
    }
    for (i, row) in list.rows.iter().enumerate() {
        for (column, value) in row[..list.columns.len()].iter().enumerate() {
            number(&format!("{field}[{i}][{column}]"), *value, &list.limits(column, limits))?;
        }
    }
    Ok(())
}

/// Every parameter against the limits in its modifier's own table.
fn modifier(modifier: &Modifier) -> Result<(), Fault> {
    for (param, value) in modifier.kind().params().iter().zip(modifier.values()) {
        match value {
            ModifierValue::Scalar(v) => number(param.name, v, &param.limits)?,
            ModifierValue::Vector(v) => vector(param.name, v.to_array(), &param.limits)?,
            ModifierValue::Count(n) => number(param.name, n.into(), &param.limits)?,
            ModifierValue::Counts(n) => vector(param.name, n.map(f64::from), &param.limits)?,
            // A file was checked when it was read.
            ModifierValue::Flag(_) | ModifierValue::Flags(_) | ModifierValue::Axis(_) | ModifierValue::File(_) => {}
        }
    }
    Ok(())
}

fn mesh(mesh: &MeshNode) -> Result<(), Fault> {
    mesh_path(&mesh.path).map_err(|reason| Fault::new("path", reason))
}

fn light(light: &Light) -> Result<(), Fault> {
    vector("color", light.color, &INTENSITY)?;
    number("intensity", light.intensity, &INTENSITY)?;
    match &light.light {
        LightKind::Sun {} => Ok(()),
        LightKind::Point { attenuation: a } => attenuation(a).map_err(|f| f.below("light.attenuation")),
        LightKind::Spot { attenuation: a, inner, outer } => {
            attenuation(a).map_err(|f| f.below("light.attenuation"))?;
            number("light.inner", *inner, &CONE)?;
            number("light.outer", *outer, &CONE)?;
            if outer < inner {
                let reason = format!("must be at least the inner angle of {inner}, not {outer}");
                return Err(Fault::new("light.outer", reason));
            }
            Ok(())
        }
    }
}

fn attenuation(attenuation: &Attenuation) -> Result<(), Fault> {
    let Attenuation { constant, linear, quadratic, range } = *attenuation;
    number("constant", constant, &ATTENUATION)?;
    number("linear", linear, &ATTENUATION)?;
    number("quadratic", quadratic, &ATTENUATION)?;
    number("range", range, &RANGE)?;
    if constant + linear + quadratic == 0.0 {
        return Err(Fault::new("constant", "must not be 0 when linear and quadratic are 0"));
    }
    Ok(())
}

fn camera(camera: &CameraNode) -> Result<(), Fault> {
    number("fov_y", camera.fov_y, &FOV)?;
    number("near", camera.near, &CLIP)?;
    number("far", camera.far, &CLIP)?;
    if camera.near >= camera.far {
        let reason = format!("must be more than the near limit of {}, not {}", camera.near, camera.far);
        return Err(Fault::new("far", reason));
    }
    Ok(())
}

fn number(field: &str, value: f64, limits: &Limits) -> Result<(), Fault> {
    if limits.accept(value) {
        return Ok(());
    }
    let ([least, most], unit) = (limits.hard, limits.unit);
    let space = if unit.is_empty() || unit == "°" { "" } else { " " };
    let (least, most, value) = (plain(least), plain(most), plain(value));
    Err(Fault::new(field, format!("must be {least} to {most}{space}{unit}, not {value}")))
}

/// A number for a message: with an exponent where it would have many zeros.
fn plain(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || (1e-4..1e9).contains(&magnitude) { value.to_string() } else { format!("{value:e}") }
}

fn vector(field: &str, values: [f64; 3], limits: &Limits) -> Result<(), Fault> {
    values.iter().enumerate().try_for_each(|(i, v)| number(&format!("{field}[{i}]"), *v, limits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MaterialId, Object, ShapeKind};

    #[test]
    fn every_parameter_of_every_shape_is_held_to_its_limits() {
        for &kind in ShapeKind::ALL {
            for (i, param) in kind.params().iter().enumerate() {
                for bad in [f64::NAN, f64::INFINITY, param.limits.hard[0] - 1.0, param.limits.hard[1] * 1.01] {
                    let mut shape = kind.default_shape();
                    match &mut shape.values()[i] {
                        ParamValue::Flag(_) | ParamValue::Text(_) | ParamValue::File(_) => continue,
                        ParamValue::Scalar(_) => assert!(shape.set_value(i, ParamValue::Scalar(bad))),
                        ParamValue::Vector(_) => {
                            assert!(shape.set_value(i, ParamValue::Vector(glam::DVec3::new(0.5, bad, 0.5))))
                        }
                        ParamValue::List(list) => {
                            list.rows[1][0] = bad;
                            assert!(shape.set_value(i, ParamValue::List(list.clone())));
                        }
                    }
                    let object = Object { shape, material: MaterialId(1) };
                    let fault = node(&Node::new("x", NodeKind::Object(object))).unwrap_err();
                    assert!(fault.field.starts_with(&format!("object.shape.{}", param.name)), "{fault:?}");
                }
            }
            let object = Object { shape: kind.default_shape(), material: MaterialId(1) };
            assert_eq!(node(&Node::new("x", NodeKind::Object(object))), Ok(()));
        }
    }

    #[test]
    fn lists_are_held_to_their_lengths_and_columns() {
        let check = |change: &dyn Fn(&mut List)| {
            let mut shape = ShapeKind::Tube.default_shape();
            let ParamValue::List(mut list) = shape.values()[0].clone() else { panic!("a list") };
            change(&mut list);
            assert!(shape.set_value(0, ParamValue::List(list)));
            node(&Node::new("x", NodeKind::Object(Object { shape, material: MaterialId(1) })))
        };
        assert_eq!(check(&|_| {}), Ok(()));
        let fault = check(&|list| list.rows.truncate(1)).unwrap_err();
        assert_eq!((&*fault.field, &*fault.reason), ("object.shape.points", "must be 2 to 256 points, not 1"));
        assert!(check(&|list| list.rows = vec![[0.0; 4]; 257]).is_err());
        assert_eq!(check(&|list| list.rows[2][3] = -1.0).unwrap_err().field, "object.shape.points[2][3]");
        assert_eq!(check(&|list| list.rows[2][1] = -1.0), Ok(()));
    }

    #[test]
    fn every_parameter_of_every_modifier_is_held_to_its_limits() {
        use crate::scene::{ModifierKind, Shape};
        let object = Object { shape: Shape::Sphere { radius: 1.0 }, material: MaterialId(1) };
        for &kind in ModifierKind::ALL {
            let with = |modifier| Node::new("x", NodeKind::Object(object.clone())).modified(modifier);
            assert_eq!(node(&with(kind.default_modifier())), Ok(()));
            for (i, param) in kind.params().iter().enumerate() {
                let bad = param.limits.hard[1] * 1.01 + 1.0;
                let mut modifier = kind.default_modifier();
                let value = match modifier.values()[i] {
                    ModifierValue::Scalar(_) => ModifierValue::Scalar(f64::NAN),
                    ModifierValue::Vector(_) => ModifierValue::Vector(glam::DVec3::new(1.0, bad, 1.0)),
                    ModifierValue::Count(_) => ModifierValue::Count(bad as u32),
                    ModifierValue::Counts(_) => ModifierValue::Counts([1, 1, bad as u32]),
                    ModifierValue::Flag(_) | ModifierValue::Flags(_) => continue,
                    ModifierValue::Axis(_) | ModifierValue::File(_) => continue,
                };
                assert!(modifier.set_value(i, value));
                let fault = node(&with(modifier)).unwrap_err();
                assert!(fault.field.starts_with(&format!("modifiers[0].modifier.{}", param.name)), "{fault:?}");
            }
        }
    }

    #[test]
    fn only_paths_inside_the_scenes_folder_pass() {
        for good in ["duck.glb", "models/a b/ä.gltf", "a..b/c.glb"] {
            assert_eq!(mesh_path(good), Ok(()));
        }
        let long = "a".repeat(MAX_PATH + 1);
        let bad = ["", "/a.glb", "../a.glb", "a/../b.glb", "a//b.glb", "./a.glb", "a\\b.glb", "C:/a.glb", "a/", &long];
        for path in bad.into_iter().chain(["http://x/a.glb", "file:a.glb", "a\n.glb"]) {
            assert!(mesh_path(path).is_err(), "{path:?}");
        }
    }

    #[test]
    fn rotations_settle_only_when_they_must() {
        let exact = DQuat::from_rotation_x(0.3) * DQuat::from_rotation_y(1.1);
        assert_eq!(settled_rotation(exact), exact);
        let near = exact * 1.0005;
        assert!((settled_rotation(near).length() - 1.0).abs() < 1e-15);
        let far = exact * 1.1;
        assert_eq!(settled_rotation(far), far);
    }
}
