//! Appearance of surfaces, and warnings about features of a file that are not drawn.

use std::path::Path;

use glam::{DVec2, DVec3, DVec4};
use isolith::geometry::Ray;
use isolith::mesh::{Sampler, TriangleMesh, Wrap, parse};
use serde_json::{Value, json};

use super::tiny::{Tiny, everything, triangle};

fn read(tiny: &Tiny) -> TriangleMesh {
    parse(&tiny.gltf(), Path::new("tiny.gltf"), None).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn samplers_are_kept() {
    for (sampler, wrap, nearest) in [
        (json!({}), [Wrap::Repeat; 2], false),
        (json!({ "wrapS": 33071, "wrapT": 33648 }), [Wrap::Clamp, Wrap::Mirror], false),
        (json!({ "wrapS": 10497, "magFilter": 9728 }), [Wrap::Repeat; 2], true),
        (json!({ "magFilter": 9729, "minFilter": 9728 }), [Wrap::Repeat; 2], false),
        (json!({ "minFilter": 9984 }), [Wrap::Repeat; 2], true),
        (json!({ "minFilter": 9987 }), [Wrap::Repeat; 2], false),
    ] {
        let mut tiny = everything();
        tiny.json["samplers"] = json!([sampler]);
        tiny.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
        assert_eq!(read(&tiny).parts[0].surface.sampler, Sampler { wrap, nearest });
    }
}

/// Texture coordinates for (1, 0) and (0, 1) after the transform.
fn transformed(transform: Value) -> [DVec2; 2] {
    let mut tiny = everything();
    tiny.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": transform });
    tiny.json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    tiny.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
    let mesh = read(&tiny);
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    [DVec2::X, DVec2::Y].map(|uv| mesh.parts[0].surface.texture_place(uv))
}

#[test]
fn texture_coordinates_are_scaled_then_turned_then_moved() {
    let turn = std::f64::consts::FRAC_PI_2;
    for (transform, want) in [
        (json!({}), [[1.0, 0.0], [0.0, 1.0]]),
        (json!({ "scale": [2, 3] }), [[2.0, 0.0], [0.0, 3.0]]),
        (json!({ "offset": [0.5, -1] }), [[1.5, -1.0], [0.5, 0.0]]),
        // Counter-clockwise with V pointing down: U turns to −V.
        (json!({ "rotation": turn }), [[0.0, -1.0], [1.0, 0.0]]),
        (json!({ "rotation": turn, "scale": [2, 3], "offset": [10, 20] }), [[10.0, 18.0], [13.0, 20.0]]),
    ] {
        for (have, want) in transformed(transform.clone()).into_iter().zip(want) {
            assert!((have - DVec2::from(want)).length() < 1e-6, "{transform}: {have} is not {want:?}");
        }
    }
}

#[test]
fn a_texture_may_take_another_set_of_coordinates() {
    let mut tiny = everything();
    let other = tiny.floats(&[[7.0, 7.0]; 4]);
    tiny.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(other);
    let info = |json: &mut Value| json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].take();
    let mut by_transform = info(&mut tiny.json);
    by_transform["extensions"] = json!({ "KHR_texture_transform": { "texCoord": 1 } });
    for info in [json!({ "index": 0, "texCoord": 1 }), by_transform] {
        tiny.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info;
        assert_eq!(read(&tiny).uvs[0], [7.0; 2]);
    }
}

/// A triangle with these opacities at its corners and a material with a cutoff.
fn masked(opacities: [f32; 3], material: Value) -> TriangleMesh {
    let mut tiny = triangle();
    let colors = tiny.floats(&opacities.map(|a| [1.0, 1.0, 1.0, a]));
    tiny.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    tiny.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    tiny.json["materials"] = json!([material]);
    read(&tiny)
}

#[test]
fn rays_go_through_what_is_cut_out() {
    let hits = |mesh: &TriangleMesh, x: f64| {
        mesh.hit(&Ray { origin: DVec3::new(x, 0.0, 1.0), direction: DVec3::NEG_Z }, 2.0).is_some()
    };
    // The opacity falls from 1 to 0 along X.
    let falling = [1.0, 0.0, 1.0];
    let mesh = masked(falling, json!({ "alphaMode": "MASK" }));
    assert_eq!([0.4, 0.6].map(|x| hits(&mesh, x)), [true, false], "the cutoff is 1/2 unless the file says");
    let mesh = masked(falling, json!({ "alphaMode": "MASK", "alphaCutoff": 0.25 }));
    assert_eq!([0.7, 0.8].map(|x| hits(&mesh, x)), [true, false]);
    let factor = json!({ "baseColorFactor": [1, 1, 1, 0.5] });
    let mesh = masked(falling, json!({ "alphaMode": "MASK", "alphaCutoff": 0.25, "pbrMetallicRoughness": factor }));
    assert_eq!([0.4, 0.6].map(|x| hits(&mesh, x)), [true, false], "factors of vertices and material multiply");
    let mesh = masked([0.0; 3], json!({}));
    assert!(hits(&mesh, 0.4), "what is opaque is whole, whatever its opacity");
    assert_eq!(mesh.color(0, [1.0, 0.0, 0.0], |_| DVec4::ONE).w, 0.0);
}

#[test]
fn older_materials_show_their_diffuse_color() {
    let mut tiny = everything();
    let older = json!({ "diffuseFactor": [0.25, 0.5, 0.75, 1], "diffuseTexture": { "index": 0 } });
    tiny.json["materials"] = json!([{ "extensions": { "KHR_materials_pbrSpecularGlossiness": older } }]);
    tiny.json["extensionsUsed"] = json!(["KHR_materials_pbrSpecularGlossiness"]);
    let mesh = read(&tiny);
    let surface = mesh.parts[0].surface;
    assert_eq!((surface.color, surface.texture), ([0.25, 0.5, 0.75, 1.0], Some(0)));
    assert_eq!(mesh.warnings, ["KHR_materials_pbrSpecularGlossiness: only its diffuse color is drawn"]);
}

/// The warnings for a triangle after this change.
fn warnings(change: impl Fn(&mut Value)) -> Vec<String> {
    let mut tiny = triangle();
    change(&mut tiny.json);
    read(&tiny).warnings
}

#[test]
fn what_is_not_drawn_is_said() {
    assert_eq!(warnings(|_| ()), [""; 0]);
    let cases: [(&str, Value, &str); 8] = [
        ("extensionsUsed", json!(["KHR_materials_clearcoat"]), "KHR_materials_clearcoat: not supported, drawn without"),
        ("extensionsUsed", json!(["KHR_lights_punctual"]), "KHR_lights_punctual: the lights of the file are not used"),
        ("extensionsUsed", json!(["MY_own"]), "MY_own: not supported, drawn without"),
        ("extensionsUsed", json!(["\u{1b}[31m"]), "\\u{1b}[31m: not supported, drawn without"),
        ("animations", json!([{}, {}]), "2 animations not played: the model is shown at rest"),
        ("cameras", json!([{ "type": "perspective" }]), "1 camera not used"),
        (
            "scenes",
            json!([{ "nodes": [0], "name": "Front" }, { "nodes": [] }]),
            "of its 2 scenes only scenes[0] “Front” is drawn",
        ),
        ("extensionsUsed", json!(["KHR_mesh_quantization", "EXT_structural_metadata"]), ""),
    ];
    for (field, value, want) in cases {
        let said = warnings(|json| json[field] = value.clone());
        let want: Vec<_> = Some(want).filter(|want| !want.is_empty()).into_iter().collect();
        assert_eq!(said, want, "{field}: {value}");
    }
    let lines = warnings(|json| {
        let points = json!({ "attributes": { "POSITION": 0 }, "mode": 0 });
        json["meshes"][0]["primitives"].as_array_mut().unwrap().extend([points.clone(), points]);
    });
    assert_eq!(lines, ["2 primitives made of points or lines not drawn"]);
}

#[test]
fn what_of_materials_is_not_drawn_is_said_once_for_all() {
    let said = warnings(|json| {
        let material = |i: usize| json!({ "name": format!("M{i}"), "normalTexture": { "index": 0 }, "emissiveFactor": [i, 0, 0], "alphaMode": "BLEND" });
        json["materials"] = json!((0..5).map(material).collect::<Vec<_>>());
        let primitive = |i: usize| json!({ "attributes": { "POSITION": 0 }, "material": i % 5 });
        json["meshes"][0]["primitives"] = json!((0..7).map(primitive).collect::<Vec<_>>());
    });
    let named = "materials[0] “M0”, materials[1] “M1”, materials[2] “M2” and 2 more";
    let glowing = "materials[1] “M1”, materials[2] “M2”, materials[3] “M3” and 1 more";
    let want = [
        format!("emission not drawn: {glowing}"),
        format!("normal textures not drawn: {named}"),
        format!("transparency (alphaMode BLEND, drawn as opaque) not drawn: {named}"),
    ];
    assert_eq!(said, want);
}

#[test]
fn there_are_never_many_warnings() {
    let said = warnings(|json| json["extensionsUsed"] = json!((0..500).map(|i| format!("E{i}")).collect::<Vec<_>>()));
    assert_eq!(said.len(), 24);
    assert_eq!(said[23], "477 more things are not drawn");
    let said = warnings(|json| json["extensionsUsed"] = json!(["x".repeat(100_000)]));
    assert!(said[0].len() < 500, "{}", said[0].len());
}
