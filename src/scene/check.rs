//! Checks the values of a scene one by one: each is finite, within [`super::limits`] and consistent with the others.
//! Files pass these checks when they are read and written, edits when they are applied.

use glam::DQuat;

use super::drawn::text_fault;
use super::limits::{Limits, MAX_APART, MAX_ID, MAX_NAME, MAX_PATH, Rule};
use super::params::{Param, Params};
use super::{
    CameraNode, DisplaySettings, Environment, Falloff, Instancer, Light, LightKind, List, MAX_DYNAMICS, MAX_MASKS,
    MAX_MODIFIERS, MAX_PALETTE, Material, Node, NodeKind, ParamValue, Part, SceneError, Shape,
};

/// A value that fails a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The path of the value below the node, the material or the environment.
    pub field: String,
    /// The requirement and the actual value.
    pub reason: String,
}

impl Fault {
    fn new(field: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { field: field.into(), reason: reason.into() }
    }

    /// Converts the fault to the reason why an edit was refused.
    pub fn into_error(self, subject: impl Into<String>) -> SceneError {
        SceneError::Invalid { subject: subject.into(), field: self.field, reason: self.reason }
    }
}

/// Checks the values of a node alone; the table checks ids and references.
pub fn node(node: &Node) -> Result<(), Fault> {
    name(&node.name)?;
    if !node.adds() && !node.has_field() {
        return Err(Fault::new("operation", "only objects and groups can subtract or intersect"));
    }
    if node.linked.is_some() && !matches!(node.kind, NodeKind::Object(_)) {
        return Err(Fault::new("linked", "only objects can be linked"));
    }
    if node.linked.is_some_and(|link| link > MAX_ID) {
        return Err(Fault::new("linked", format!("must be at most {MAX_ID}")));
    }
    if node.apart.len() > MAX_APART {
        return Err(Fault::new("apart", format!("must name at most {MAX_APART} nodes, not {}", node.apart.len())));
    }
    if !node.modifiers.is_empty() && !node.has_field() {
        return Err(Fault::new("modifiers", "only objects and groups can have modifiers"));
    }
    if node.modifiers.len() > MAX_MODIFIERS {
        return Err(Fault::new("modifiers", format!("must be at most {MAX_MODIFIERS} of them")));
    }
    if !node.dynamics.is_empty() && !node.can_move() {
        return Err(Fault::new("dynamics", "only objects, groups and instancers can have dynamics"));
    }
    if node.dynamics.len() > MAX_DYNAMICS {
        return Err(Fault::new("dynamics", format!("must be at most {MAX_DYNAMICS} of them")));
    }
    if !node.march.is_usual() && !node.can_move() {
        return Err(Fault::new("march", "only objects, groups and instancers can have settings of their march"));
    }
    for part in Part::of(node) {
        if let Some(params) = part.params(node) {
            values(params).map_err(|fault| Fault { field: part.field(&fault.field), ..fault })?;
        }
    }
    if node.march.end() <= node.march.near {
        let reason = format!("must be more than the start of {}, or 0, not {}", node.march.near, node.march.far);
        return Err(Fault::new("march.far", reason));
    }
    let (part, together) = match &node.kind {
        NodeKind::Group(_) => return Ok(()),
        NodeKind::Object(o) => (Part::Shape, shape(&o.shape)),
        NodeKind::Instancer(i) => (Part::Instancer, instancer(i)),
        NodeKind::Mesh(m) => (Part::Mesh, mesh_path(&m.path).map_err(|reason| Fault::new("path", reason))),
        NodeKind::Light(l) => (Part::Light, light(l)),
        NodeKind::Camera(c) => (Part::Camera, camera(c)),
    };
    together.map_err(|fault| Fault { field: part.field(&fault.field), ..fault })
}

/// Checks every value of a material.
pub fn material(material: &Material) -> Result<(), Fault> {
    named(&material.name, material)
}

/// Checks a name and every value below it.
pub(crate) fn named(name: &str, params: &dyn Params) -> Result<(), Fault> {
    self::name(name)?;
    values(params)
}

/// Checks every value of an environment.
pub fn environment(environment: &Environment) -> Result<(), Fault> {
    values(environment)
}

/// Checks every value of display settings.
pub fn display(display: &DisplaySettings) -> Result<(), Fault> {
    values(display)
}

/// Checks every parameter against the limits of its table.
pub(super) fn values(params: &dyn Params) -> Result<(), Fault> {
    let mut found = Ok(());
    params.visit("", &mut |prefix, param, value| {
        if found.is_ok() {
            found = self::value(param, &value)
                .map_err(|fault| Fault { field: format!("{prefix}{}", fault.field), ..fault });
        }
    });
    found
}

/// Checks the value of a parameter against its limits.
pub(super) fn value(param: &Param, value: &ParamValue) -> Result<(), Fault> {
    let (field, limits) = (param.name, &param.limits);
    match value {
        ParamValue::Scalar(v) => number(field, *v, limits),
        ParamValue::Vector(v) => vector(field, v.to_array(), limits),
        ParamValue::Count(n) => number(field, f64::from(*n), limits),
        ParamValue::Counts(n) => vector(field, n.map(f64::from), limits),
        ParamValue::Rotation(rotation) => unit_length(field, *rotation),
        ParamValue::Text(text) => letters(field, text, limits),
        ParamValue::List(list) => self::list(field, list, limits),
        // Attachments are checked when they are read; the types of the others allow valid values only.
        ParamValue::Flag(_) | ParamValue::Flags(_) | ParamValue::Choice(_) | ParamValue::File(_) => Ok(()),
    }
}

/// How far from 1 the length of a quaternion may be for it to count as a rotation.
const UNIT_TOLERANCE: f64 = 1e-3;
/// Up to this deviation the length counts as 1 and the numbers stay as they are, so that a file keeps its bytes.
const UNIT_EXACT: f64 = 1e-12;

/// Normalizes a quaternion that is nearly unit and leaves an exactly unit one alone. Returns anything else unchanged,
/// for [`node`] to refuse.
pub fn settled_rotation(rotation: DQuat) -> DQuat {
    let off = (rotation.length() - 1.0).abs();
    if off > UNIT_EXACT && off <= UNIT_TOLERANCE { rotation.normalize() } else { rotation }
}

/// The node with its rotation normalized, see [`settled_rotation`].
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

fn unit_length(field: &str, rotation: DQuat) -> Result<(), Fault> {
    let length = rotation.length();
    if !length.is_finite() || (length - 1.0).abs() > UNIT_TOLERANCE {
        return Err(Fault::new(field, format!("must be a quaternion of length 1, not of length {length}")));
    }
    Ok(())
}

/// Checks the values of a shape against each other.
fn shape(shape: &Shape) -> Result<(), Fault> {
    if let Shape::Text { text, font, .. } = shape
        && let Some(reason) = text_fault(text, font)
    {
        return Err(Fault::new(if font.name().is_some() { "font" } else { "text" }, reason));
    }
    Ok(())
}

fn letters(field: &str, text: &str, limits: &Limits) -> Result<(), Fault> {
    let (count, most) = (text.chars().count(), limits.hard[1]);
    if count as f64 > most {
        return Err(Fault::new(field, format!("must be at most {most} letters long, not {count}")));
    }
    if text.chars().any(|c| c.is_control() && c != '\n') {
        return Err(Fault::new(field, format!("must not hold control characters, such as in {text:?}")));
    }
    Ok(())
}

/// Checks the row count of a list and every number in it.
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

/// Checks the values of a light against each other.
fn light(light: &Light) -> Result<(), Fault> {
    match light.light {
        LightKind::Sun { .. } | LightKind::Rectangle { .. } => Ok(()),
        LightKind::Point { falloff: f, .. } => falloff(f),
        LightKind::Spot { falloff: f, inner, outer, .. } => {
            falloff(f)?;
            cone([inner, outer])
        }
    }
}

fn falloff(falloff: Falloff) -> Result<(), Fault> {
    match falloff {
        Falloff::InverseSquare {} => Ok(()),
        Falloff::Attenuation { constant, linear, quadratic, .. } => {
            attenuation("light.falloff.constant", [constant, linear, quadratic])
        }
    }
}

/// Checks the half angles of a spot light: the inner and the outer one.
pub(super) fn cone([inner, outer]: [f64; 2]) -> Result<(), Fault> {
    if outer < inner {
        let reason = format!("must be at least the inner angle of {inner}, not {outer}");
        return Err(Fault::new("light.outer", reason));
    }
    Ok(())
}

/// Checks the constant, linear and quadratic term of an attenuation, the first of which is at `field`.
pub(super) fn attenuation(field: &str, terms: [f64; 3]) -> Result<(), Fault> {
    if terms.iter().sum::<f64>() == 0.0 {
        return Err(Fault::new(field, "must not be 0 when linear and quadratic are 0"));
    }
    Ok(())
}

/// Checks the lists of an instancer, and its values against each other.
fn instancer(instancer: &Instancer) -> Result<(), Fault> {
    let lists = [("masks", instancer.masks.len(), MAX_MASKS), ("palette", instancer.palette.len(), MAX_PALETTE)];
    if let Some((name, count, most)) = lists.into_iter().find(|(_, count, most)| count > most) {
        return Err(Fault::new(name, format!("must be at most {most} of them, not {count}")));
    }
    for (at, slot) in instancer.masks.iter().enumerate() {
        if let Some(reason) = slot.curve.fault() {
            return Err(Fault::new(format!("masks[{at}].curve"), reason));
        }
    }
    let variation = &instancer.variation;
    let ranges = [
        ("variation.offset_max", variation.offset_min, variation.offset_max),
        ("variation.rotation_max", variation.rotation_min, variation.rotation_max),
        ("variation.scale_max", variation.scale_min, variation.scale_max),
    ];
    for (name, least, most) in ranges {
        if let Some(axis) = (0..3).find(|axis| least[*axis] > most[*axis]) {
            let reason = format!("must be at least the minimum of {}, not {}", least[axis], most[axis]);
            return Err(Fault::new(format!("{name}[{axis}]"), reason));
        }
    }
    Ok(())
}

fn camera(camera: &CameraNode) -> Result<(), Fault> {
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
    let of_what = if limits.rule == Rule::Magnitude { " in magnitude" } else { "" };
    let (least, most, value) = (plain(least), plain(most), plain(value));
    Err(Fault::new(field, format!("must be {least} to {most}{space}{unit}{of_what}, not {value}")))
}

/// Formats a number for a message: with an exponent where it would have many zeros.
fn plain(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || (1e-4..1e9).contains(&magnitude) { value.to_string() } else { format!("{value:e}") }
}

fn vector(field: &str, values: [f64; 3], limits: &Limits) -> Result<(), Fault> {
    let fault = values.iter().position(|v| !limits.accept(*v));
    fault.map_or(Ok(()), |i| number(&format!("{field}[{i}]"), values[i], limits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MaterialId, Object, ShapeKind};

    #[test]
    fn every_parameter_of_every_shape_is_held_to_its_limits() {
        for &kind in ShapeKind::ALL {
            for (i, param) in kind.params().iter().enumerate() {
                for bad in [f64::NAN, f64::INFINITY, param.limits.hard[0] - 1.0, param.limits.hard[1] * 1.01] {
                    let mut shape = kind.default_shape();
                    match &mut shape.values()[i] {
                        ParamValue::Scalar(_) => assert!(shape.set_value(i, ParamValue::Scalar(bad))),
                        ParamValue::Vector(_) => {
                            assert!(shape.set_value(i, ParamValue::Vector(glam::DVec3::new(0.5, bad, 0.5))))
                        }
                        ParamValue::List(list) => {
                            list.rows[1][0] = bad;
                            assert!(shape.set_value(i, ParamValue::List(list.clone())));
                        }
                        _ => continue,
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
        use crate::{ModifierKind, Shape};
        let object = Object { shape: Shape::Sphere { radius: 1.0 }, material: MaterialId(1) };
        for &kind in ModifierKind::ALL {
            let with = |modifier| Node::new("x", NodeKind::Object(object.clone())).modified(modifier);
            assert_eq!(node(&with(kind.default_modifier())), Ok(()));
            for (i, param) in kind.params().iter().enumerate() {
                let bad = param.limits.hard[1] * 1.01 + 1.0;
                let mut modifier = kind.default_modifier();
                let value = match modifier.values()[i] {
                    ParamValue::Scalar(_) => ParamValue::Scalar(f64::NAN),
                    ParamValue::Vector(_) => ParamValue::Vector(glam::DVec3::new(1.0, bad, 1.0)),
                    ParamValue::Count(_) => ParamValue::Count(bad as u32),
                    ParamValue::Counts(_) => ParamValue::Counts([1, 1, bad as u32]),
                    _ => continue,
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
