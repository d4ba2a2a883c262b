//! Tests of the tables against the code generated from them.

use super::*;
use crate::{
    BlendKernel, BlendOverride, CameraNode, ColorTexture, Environment, Group, HeightTexture, Light, LightKind,
    Material, MaterialId, MeshNode, ModifierKind, ModifierSlot, Node, NodeId, NodeKind, NormalTexture, Object,
    OpacityTexture, Operator, ParamOwner, ParamPath, Part, RadiusUnit, RoughnessTexture, Scene, Shape, ShapeKind,
    Textures, check,
};

/// A node of each kind, and objects with every shape and every modifier.
fn nodes() -> Vec<Node> {
    let object = |shape| NodeKind::Object(Object { shape, material: MaterialId(1) });
    let light = |light| NodeKind::Light(Light { light, ..Light::default() });
    let mut all = vec![
        NodeKind::Group(Group::default()),
        NodeKind::Mesh(MeshNode::new("a.glb")),
        NodeKind::Camera(CameraNode::default()),
    ];
    all.extend(LightKind::variants().into_iter().map(|(kind, ..)| light(kind)));
    all.extend(ShapeKind::ALL.iter().map(|kind| object(kind.default_shape())));
    let mut nodes: Vec<Node> = all.into_iter().map(|kind| Node::new("a", kind)).collect();
    for kind in ModifierKind::ALL {
        nodes.push(Node::new("b", object(Shape::Sphere { radius: 1.0 })).modified(kind.default_modifier()));
    }
    nodes[0].blend_override = BlendOverride::Radius(0.5);
    nodes
}

fn scene() -> Scene {
    let mut scene = Scene::new();
    for node in nodes() {
        let end = scene.nodes().len();
        scene.insert(None, end, node).expect("valid");
    }
    for material in textured() {
        scene.insert_material(Material { id: scene.next_material_id(), ..material }).expect("valid");
    }
    scene
}

/// Materials with every kind of texture.
fn textured() -> Vec<Material> {
    let normals: Vec<_> = NormalTexture::variants().into_iter().map(|(normal, ..)| normal).collect();
    let colors = ColorTexture::variants().into_iter().map(|(color, ..)| color);
    let roughnesses = RoughnessTexture::variants().into_iter().map(|(roughness, ..)| roughness);
    let heights = HeightTexture::variants().into_iter().map(|(height, ..)| height);
    let opacities = OpacityTexture::variants().into_iter().map(|(opacity, ..)| opacity);
    let all = colors.zip(roughnesses).zip(heights.zip(opacities)).enumerate();
    all.map(|(i, ((new_color, new_roughness), (new_height, new_opacity)))| {
        let mut textures = Textures::triplanar();
        if let Textures::Triplanar { color, roughness, normal, height, opacity, .. } = &mut textures {
            (*color, *roughness, *height, *opacity) = (new_color, new_roughness, new_height, new_opacity);
            *normal = normals[i % normals.len()].clone();
        }
        Material { textures, ..Material::default() }
    })
    .collect()
}

/// Another value of the same type; passes the checks wherever one can.
fn another(param: &Param, value: &ParamValue) -> Option<ParamValue> {
    let number = |v: f64| if param.limits.accept(v + 1.0) { v + 1.0 } else { 0.5 * (v + param.limits.hard[0]) };
    Some(match value {
        ParamValue::Scalar(v) => ParamValue::Scalar(number(*v)),
        ParamValue::Vector(v) => ParamValue::Vector(v.map(number)),
        ParamValue::Count(v) => ParamValue::Count(number(f64::from(*v)) as u32),
        ParamValue::Counts(v) => ParamValue::Counts(v.map(|v| number(f64::from(v)) as u32)),
        ParamValue::Flag(v) => ParamValue::Flag(!v),
        ParamValue::Flags(v) => ParamValue::Flags(v.map(|v| !v)),
        ParamValue::Choice(key) => ParamValue::Choice(&param.choices.iter().find(|choice| choice.key != *key)?.key),
        ParamValue::Rotation(_) => ParamValue::Rotation(glam::DQuat::from_rotation_x(1.0)),
        ParamValue::List(list) => {
            let mut list = list.clone();
            list.rows.swap(0, 1);
            ParamValue::List(list)
        }
        ParamValue::Text(text) => ParamValue::Text(format!("b{text}")),
        // No file is a value too; the tests of attachments cover other files.
        ParamValue::File(_) => return None,
    })
}

/// The scene with another value of the parameter.
fn with(scene: &Scene, path: &ParamPath, value: ParamValue) -> Result<Scene, crate::SceneError> {
    use crate::Changed;
    let mut scene = scene.clone();
    match path.changed(&scene, value)? {
        Changed::Node(node) => scene.replace(*node)?,
        Changed::Material(material) => scene.replace_material(*material)?,
        Changed::Environment(environment) => scene.environment = environment,
        Changed::Display(display) => scene.display = display,
    }
    Ok(scene)
}

#[test]
fn every_parameter_is_read_and_set_through_its_path_and_the_paths_text() {
    let scene = scene();
    let all = ParamPath::all(&scene);
    assert!(all.len() > 400, "{}", all.len());
    let paths: std::collections::HashSet<String> = all.iter().map(|(path, ..)| path.to_string()).collect();
    assert_eq!(paths.len(), all.len(), "each path names one parameter");
    for (path, param, value) in &all {
        let text = path.to_string();
        assert_eq!(text.parse::<ParamPath>().as_ref(), Ok(path), "{text}");
        assert_eq!(path.get(&scene).as_ref(), Ok(value), "{text}");
        assert!(std::ptr::eq(path.param(&scene).expect("there"), *param), "{text}");
        assert_eq!(with(&scene, path, value.clone()).as_ref(), Ok(&scene), "{text}");
        let Some(new) = another(param, value) else { continue };
        let changed = with(&scene, path, new.clone()).expect("of the right type");
        assert_eq!(path.get(&changed), Ok(new), "{text}");
        assert_ne!(changed, scene, "{text}");
        if let Some(first) = value.element(0) {
            let element = path.clone().element(1);
            assert_eq!(element.to_string().parse::<ParamPath>().as_ref(), Ok(&element), "{text}");
            let changed = with(&scene, &element, first.clone()).expect("an element");
            assert_eq!(element.get(&changed).as_ref(), Ok(&first), "{text}");
            assert_eq!(path.clone().element(2).get(&changed), path.clone().element(2).get(&scene), "{text}");
        }
    }
}

#[test]
fn every_parameter_has_a_label_a_help_text_and_a_default_of_its_type_that_is_allowed() {
    let scene = scene();
    for (path, param, value) in ParamPath::all(&scene) {
        assert!(!param.label.is_empty() && !param.help.is_empty(), "{path}");
        assert_eq!(std::mem::discriminant(&param.default), std::mem::discriminant(&value), "{path}");
        assert_eq!(matches!(value, ParamValue::Choice(_)), !param.choices.is_empty(), "{path}");
        // A mesh has no file before the artist chooses one.
        if !path.to_string().ends_with(".mesh.path") {
            let changed = with(&scene, &path, param.default.clone()).expect("of the right type");
            assert_eq!(checked(&changed, &path), Ok(()), "{path}");
        }
    }
}

/// Runs the checks of files on the owner of the parameter.
fn checked(scene: &Scene, path: &ParamPath) -> Result<(), check::Fault> {
    match path.owner {
        ParamOwner::Node(id, _) => check::node(scene.node(id).expect("there")),
        ParamOwner::Material(id) => check::material(scene.material(id).expect("there")),
        ParamOwner::Environment => check::environment(&scene.environment),
        ParamOwner::Display => check::display(&scene.display),
    }
}

#[test]
fn the_limits_of_the_tables_are_those_that_files_are_held_to() {
    let scene = scene();
    let mut count = 0;
    for (path, param, value) in ParamPath::all(&scene) {
        let [low, high] = param.limits.hard;
        for bad in [f64::NAN, f64::INFINITY, low - low.abs().max(1.0) * 0.01, high * 1.01] {
            let beyond = if bad > high { bad.ceil() } else { bad.floor() };
            let whole = || (0.0..=f64::from(u32::MAX)).contains(&beyond).then_some(beyond as u32);
            let (value, suffix) = match &value {
                ParamValue::Scalar(_) => (ParamValue::Scalar(bad), ""),
                ParamValue::Vector(v) => (ParamValue::Vector(glam::DVec3::new(v.x, bad, v.z)), "[1]"),
                ParamValue::Count(_) => match whole() {
                    Some(n) => (ParamValue::Count(n), ""),
                    None => continue,
                },
                ParamValue::Counts([x, y, _]) => match whole() {
                    Some(n) => (ParamValue::Counts([*x, *y, n]), "[2]"),
                    None => continue,
                },
                ParamValue::Rotation(q) => (ParamValue::Rotation(*q * bad), ""),
                ParamValue::Text(_) if bad.is_finite() && bad > 1.0 => {
                    (ParamValue::Text("a".repeat(bad.ceil() as usize)), "")
                }
                _ => continue,
            };
            // With a sign, the same number is within the limits of a magnitude.
            if param.limits.accept(bad) {
                continue;
            }
            let changed = with(&scene, &path, value).expect("of the right type");
            let fault = checked(&changed, &path).expect_err(&path.to_string());
            let field = match path.owner {
                ParamOwner::Node(_, part) => part.field(&path.name),
                ParamOwner::Material(_) | ParamOwner::Environment | ParamOwner::Display => path.name.to_string(),
            };
            assert_eq!(fault.field, format!("{field}{suffix}"), "{path}: {bad}");
            count += 1;
        }
    }
    assert!(count > 800, "{count}");
}

#[test]
fn what_is_no_path_and_what_is_not_there_are_errors_that_name_it() {
    let scene = scene();
    for text in [
        "",
        "environment",
        "environment.",
        "node.1",
        "node.01.transform.translation",
        "node.x.transform.translation",
        "node.-1.transform.translation",
        "node.1.transform.",
        "node.1.transform.translation[",
        "node.1.transform.translation[x]",
        "node.1.modifiers[0]x.modifier.angle",
        "node.1.modifiers[00].modifier.angle",
        "node.1.modifiers[0].angle",
        "node.1.modifiers[0].modifier.enabled",
        "node.1.Transform.translation",
        "material.1",
        "light.1.intensity",
    ] {
        let error = text.parse::<ParamPath>().expect_err(text).to_string();
        assert!(error.starts_with(text) && error.contains("is not the path of a parameter"), "{text}: {error}");
    }
    let group = scene.nodes()[0].id.0;
    let path = |field: &str| format!("node.{group}.{field}");
    for (text, reason) in [
        (path("transform.size"), "there is translation, rotation, scale"),
        (path("object.shape.radius"), "no such part"),
        (path("modifiers[0].modifier.angle"), "no such part"),
        (path("group.blend"), "there is no such parameter"),
        (path("group.blend.radius.x"), "there is no such parameter"),
        (path("group.blend.radius[0]"), "no such element"),
        (path("transform.translation[3]"), "no such element"),
        ("material.1.color".into(), "there is base_color, base_weight"),
        ("environment.fog".into(), "there is no such parameter"),
        ("display.gamma".into(), "there is exposure, view_transform"),
    ] {
        let error = text.parse::<ParamPath>().expect(&text).get(&scene).expect_err(&text).to_string();
        assert!(error.starts_with(&text) && error.contains(reason), "{text}: {error}");
    }
    let missing = ParamPath::of_node(NodeId(1 << 40), Part::Transform, "translation").get(&scene);
    assert!(missing.is_err_and(|error| error.to_string().contains("no node")));
    let wrong = with(&scene, &path("transform.translation").parse().expect("a path"), ParamValue::Flag(true));
    assert!(wrong.is_err_and(|error| error.to_string().contains("must be a value like [0, 0, 0], not true")));
}

#[test]
fn choices_are_named_as_in_files() {
    fn same<T: Serialize + ParamField>(all: &[T]) {
        for (value, choice) in all.iter().zip(T::choices()) {
            assert_eq!(serde_json::to_value(value).ok(), Some(choice.key.as_str().into()));
        }
        assert_eq!(all.len(), T::choices().len());
    }
    same(&Operator::ALL);
    same(&BlendKernel::ALL);
    same(&RadiusUnit::ALL);
    same(&crate::Axis::ALL);
    same(&crate::ViewTransform::ALL);
}

#[test]
fn another_kind_of_light_keeps_what_both_have() {
    let mut light = Light::default();
    assert!(light.set("light.type", ParamValue::Choice("point")));
    assert!(light.set("light.falloff.type", ParamValue::Choice("attenuation")));
    assert!(light.set("light.falloff.range", ParamValue::Scalar(7.0)));
    assert!(!light.set("light.inner", ParamValue::Scalar(7.0)), "a point light has no cone");
    assert!(light.set("light.type", ParamValue::Choice("spot")));
    assert_eq!(light.get("light.falloff.range"), Some(ParamValue::Scalar(7.0)));
    assert_eq!(light.get("light.inner"), Some(ParamValue::Scalar(20.0)));
    assert!(!light.set("light.type", ParamValue::Choice("moon")));
}

/// A parameter costs one line: the field, its check, its path and its row in the inspector follow from the row below.
#[test]
fn a_row_of_a_table_is_all_that_a_parameter_costs() {
    param_struct! {
        /// A thing.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Thing {
            /// How much it sways.
            sway: f64 = 0.5, crate::limits::UNIT.labeled("Wind");
        }
    }
    let mut thing = Thing::default();
    assert_eq!(thing.sway, 0.5);
    let param = thing.find("sway").expect("there");
    assert_eq!((&*param.label, param.help, param.default.to_string()), ("Wind", "How much it sways.", "0.5".into()));
    assert!(param.animatable && !param.limits.accept(2.0));
    assert!(thing.set("sway", ParamValue::Scalar(0.25)) && !thing.set("sway", ParamValue::Flag(true)));
    assert_eq!(thing.get("sway"), Some(ParamValue::Scalar(0.25)));
}

#[test]
fn materials_surroundings_and_modifiers_are_reached_too() {
    let material = Material::new(MaterialId(1), "a", [0.5; 3]);
    let names = |params: &dyn Params| {
        let mut names = Vec::new();
        params.visit("", &mut |prefix, param, _| names.push(format!("{prefix}{}", param.name)));
        names
    };
    assert_eq!(names(&material)[..3], ["base_color", "base_weight", "base_metalness"]);
    assert_eq!(names(&material).last().map(String::as_str), Some("textures.type"));
    assert_eq!(
        names(&Environment::default())[..4],
        ["background.type", "background.sky", "background.horizon", "background.ambient"]
    );
    assert_eq!(names(&ModifierSlot::from(ModifierKind::Twist.default_modifier())), ["enabled", "angle"]);
    let group = "operator blend.kernel blend.radius blend.unit blend.steps width depth share bake";
    assert_eq!(names(&Group::default()), group.split(' ').collect::<Vec<_>>());
}

/// A table with parameters that old files do not have.
#[allow(dead_code, reason = "a sample uses only what it shows")]
mod sample {
    use schemars::JsonSchema;
    use serde::Serialize;

    use crate::limits::SIZE;
    use crate::params::param_kinds;

    param_kinds! {
        /// A sample.
        #[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
        pub enum Sample;

        /// Its kinds.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum SampleKind;

        /// A ring.
        Ring = "Ring" {
            /// Its radius.
            radius: f64 = 1.0, SIZE;
            /// Came later.
            #[serde(default)]
            thickness: f64 = 0.25, SIZE;
            /// Came later, too.
            #[serde(default)]
            sides: u32 = 6, SIZE;
        }
    }
}

#[test]
fn a_parameter_that_a_file_does_not_have_is_its_default() {
    use sample::Sample;
    let read = |text: &str| serde_json::from_str::<Sample>(text).map_err(|error| error.to_string());
    let old = read(r#"{"type": "ring", "radius": 2.0}"#);
    assert_eq!(old, Ok(Sample::Ring { radius: 2.0, thickness: 0.25, sides: 6 }));
    let new = read(r#"{"type": "ring", "radius": 2.0, "thickness": 0.0, "sides": 3}"#);
    assert_eq!(new, Ok(Sample::Ring { radius: 2.0, thickness: 0.0, sides: 3 }));
    for (wrong, part) in [
        (r#"{"type": "ring"}"#, "missing field `radius`"),
        (r#"{"type": "ring", "radius": 2.0, "thickness": null}"#, "invalid type"),
        (r#"{"type": "ring", "radius": 2.0, "width": 1.0}"#, "unknown field `width`"),
    ] {
        assert!(read(wrong).is_err_and(|error| error.contains(part)), "{wrong}");
    }
}
