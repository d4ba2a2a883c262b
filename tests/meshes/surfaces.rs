//! Appearance of surfaces, and warnings about features of a file that are not drawn.

use std::path::Path;

use glam::{DMat3, DVec2, DVec3, DVec4};
use isolith::geometry::Ray;
use isolith::mesh::{Sampler, TriangleMesh, Wrap, parse};
use serde_json::{Value, json};

use super::tiny::{Tiny, everything, of_color, triangle};

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
        assert_eq!(read(&tiny).parts[0].surface.base_color.unwrap().sampler, Sampler { wrap, nearest });
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
    [DVec2::X, DVec2::Y].map(|uv| mesh.parts[0].surface.base_color.unwrap().place(uv))
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
        assert_eq!(read(&tiny).uvs[0], [7.0, 7.0, 0.0, 0.0]);
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
    assert_eq!((surface.color, surface.base_color.unwrap().texture), ([0.25, 0.5, 0.75, 1.0], 0));
    assert_eq!(
        mesh.warnings,
        ["KHR_materials_pbrSpecularGlossiness: only its diffuse color and glossiness factor are drawn"]
    );
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
        ("extensionsUsed", json!(["KHR_materials_sheen"]), "KHR_materials_sheen: not supported, drawn without"),
        ("extensionsUsed", json!(["KHR_lights_punctual"]), "KHR_lights_punctual: the lights of the file are not used"),
        ("extensionsUsed", json!(["MY_own"]), "MY_own: not supported, drawn without"),
        ("extensionsUsed", json!(["\u{1b}[31m"]), "\\u{1b}[31m: not supported, drawn without"),
        ("animations", json!([{}, {}]), ""),
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
        let coat = |i: usize| if i == 0 { json!({}) } else { json!({ "clearcoatTexture": { "index": 0 } }) };
        let specular = json!({ "specularColorTexture": { "index": 0 } });
        let material = |i: usize| {
            let extensions = json!({ "KHR_materials_clearcoat": coat(i), "KHR_materials_specular": specular });
            json!({ "name": format!("M{i}"), "extensions": extensions })
        };
        json["materials"] = json!((0..5).map(material).collect::<Vec<_>>());
        let primitive = |i: usize| json!({ "attributes": { "POSITION": 0 }, "material": i % 5 });
        json["meshes"][0]["primitives"] = json!((0..7).map(primitive).collect::<Vec<_>>());
    });
    let named = "materials[0] “M0”, materials[1] “M1”, materials[2] “M2” and 2 more";
    let coated = "materials[1] “M1”, materials[2] “M2”, materials[3] “M3” and 1 more";
    let want = [
        format!("textures of KHR_materials_clearcoat not drawn: {coated}"),
        format!("textures of KHR_materials_specular not drawn: {named}"),
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

#[test]
fn materials_have_the_properties_of_their_files() {
    let read_material = |material: Value| {
        let mut tiny = everything();
        tiny.json["materials"] = json!([material]);
        let mesh = read(&tiny);
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        mesh.parts[0].surface
    };
    let plain = read_material(json!({}));
    assert_eq!(plain, isolith::mesh::Surface::default());
    assert_eq!([plain.metalness, plain.roughness, plain.ior], [1.0, 1.0, 1.5]);
    let full = read_material(json!({
        "pbrMetallicRoughness": {
            "metallicFactor": 0.25, "roughnessFactor": 0.5, "metallicRoughnessTexture": { "index": 0 },
        },
        "normalTexture": { "index": 0, "scale": 2 },
        "occlusionTexture": { "index": 0, "texCoord": 1, "strength": 0.75 },
        "emissiveFactor": [1, 0.5, 0],
        "emissiveTexture": { "index": 0 },
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": 8 },
            "KHR_materials_ior": { "ior": 1.25 },
            "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0.25] },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25 },
        },
    }));
    assert_eq!([full.metalness, full.roughness, full.normal_scale, full.occlusion_strength], [0.25, 0.5, 2.0, 0.75]);
    assert_eq!((full.emission, full.specular_color), ([8.0, 4.0, 0.0], [1.0, 0.5, 0.25]));
    assert_eq!([full.ior, full.specular_weight, full.coat_weight, full.coat_roughness], [1.25, 0.5, 0.5, 0.25]);
    assert_eq!(full.maps().map(|used| used.unwrap().slot), [0, 0, 1, 0]);
    // Numbers that mean nothing are replaced, not spread.
    let odd = read_material(json!({
        "pbrMetallicRoughness": { "metallicFactor": -3, "roughnessFactor": 7 },
        "emissiveFactor": [1, 1, 1],
        "extensions": {
            "KHR_materials_ior": { "ior": 0 }, "KHR_materials_emissive_strength": { "emissiveStrength": 1e300 },
        },
    }));
    assert_eq!([odd.metalness, odd.roughness, odd.ior, odd.emission[0]], [0.0, 1.0, 1.0, 65_504.0]);
    let unlit = read_material(json!({ "normalTexture": { "index": 0 }, "extensions": { "KHR_materials_unlit": {} } }));
    assert!(unlit.is_unlit && !unlit.has_maps());
}

#[test]
fn a_third_set_of_coordinates_is_left_out_and_said() {
    let mut tiny = everything();
    let info = |set: u32| json!({ "index": 0, "texCoord": set });
    tiny.json["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": info(0), "metallicRoughnessTexture": info(3) },
        "occlusionTexture": info(5),
    }]);
    let mesh = read(&tiny);
    let surface = mesh.parts[0].surface;
    let slots = (surface.base_color.map(|used| used.slot), surface.metal_rough.map(|used| used.slot));
    assert_eq!((slots, surface.occlusion), ((Some(0), Some(1)), None));
    assert!(mesh.warnings[0].starts_with("textures[0] needs more than 2 sets"), "{:?}", mesh.warnings);
}

/// A triangle with a texture of one normal, by the file's tangents or by its texture coordinates.
fn bumpy(tangent: Option<[f32; 4]>, normal: [u8; 3], scale: f64) -> TriangleMesh {
    let mut tiny = triangle();
    let normals = tiny.floats(&[[0.0, 0.0, 1.0]; 3]);
    let uvs = tiny.floats(&[[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]);
    let [r, g, b] = normal;
    let image = tiny.view(&of_color([1, 1], [r, g, b, 255]));
    tiny.json["images"] = json!([{ "bufferView": image, "mimeType": "image/png" }]);
    tiny.json["textures"] = json!([{ "source": 0 }]);
    tiny.json["materials"] = json!([{ "normalTexture": { "index": 0, "scale": scale } }]);
    let primitive = &mut tiny.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = json!(normals);
    primitive["attributes"]["TEXCOORD_0"] = json!(uvs);
    primitive["material"] = json!(0);
    if let Some(tangent) = tangent {
        let tangents = tiny.floats(&[tangent; 3]);
        tiny.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(tangents);
    }
    read(&tiny)
}

#[test]
fn normals_of_textures_stand_in_the_tangent_frame() {
    let third = [1.0 / 3.0; 3];
    let turned = |mesh: &TriangleMesh, by: DMat3| mesh.mapped_normal(0, third, DVec3::Z * by.z_axis.z.signum(), &by);
    let near = |a: DVec3, b: DVec3| assert!((a - b.normalize()).length() < 1e-2, "{a} {b}");
    // Red leans to the right, green upward in the image.
    for tangent in [None, Some([1.0, 0.0, 0.0, 1.0])] {
        near(turned(&bumpy(tangent, [255, 128, 128], 1.0), DMat3::IDENTITY), DVec3::X);
        near(turned(&bumpy(tangent, [128, 255, 128], 1.0), DMat3::IDENTITY), DVec3::Y);
        near(turned(&bumpy(tangent, [255, 128, 255], 0.5), DMat3::IDENTITY), DVec3::new(0.5, 0.0, 1.0));
        // A mirrored mesh leans to the other side.
        let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        near(turned(&bumpy(tangent, [255, 128, 128], 1.0), mirror), DVec3::NEG_X);
        near(turned(&bumpy(tangent, [128, 255, 128], 1.0), mirror), DVec3::Y);
    }
    near(turned(&bumpy(Some([0.0, 1.0, 0.0, -1.0]), [128, 255, 128], 1.0), DMat3::IDENTITY), DVec3::X);
    assert!(bumpy(None, [0; 3], 1.0).tangents.is_empty());
    assert_eq!(bumpy(Some([0.0, 2.0, 0.0, -1.0]), [0; 3], 1.0).tangents[2], [0.0, 1.0, 0.0, -1.0]);
}
