//! Files broken by hand, one fault each: the error names the place and the reason.

use std::path::Path;

use isolith::mesh::parse;
use serde_json::{Value, json};

use super::tiny::{Tiny, container, everything, triangle};

const PRIMITIVE: &str = "meshes[0].primitives[0]";

#[track_caller]
fn refused(tiny: &Tiny, place: &str, reason: &str) {
    let error = parse(&tiny.gltf(), Path::new("broken.gltf"), None).expect_err(place);
    assert_eq!(error.file, "broken.gltf");
    assert_eq!(error.place, place, "{error}");
    assert!(error.reason.contains(reason), "{error}");
    let shown = error.to_string();
    assert!(shown.starts_with("broken.gltf: ") && shown.contains(place) && shown.contains(reason), "{shown}");
}

/// Sets a value in the triangle's JSON and expects the error.
#[track_caller]
fn set(pointer: &str, value: Value, place: &str, reason: &str) {
    let mut tiny = triangle();
    set_in(&mut tiny, pointer, value);
    refused(&tiny, place, reason);
}

/// Like the one above, in the file with all features.
#[track_caller]
fn set_rich(pointer: &str, value: Value, place: &str, reason: &str) {
    let mut tiny = everything();
    set_in(&mut tiny, pointer, value);
    refused(&tiny, place, reason);
}

#[track_caller]
fn set_in(tiny: &mut Tiny, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = tiny.json.pointer_mut(parent).expect(pointer);
    match key.parse::<usize>() {
        Ok(index) if parent.is_array() => parent[index] = value,
        _ => parent[key] = value,
    }
}

fn place(field: &str) -> String {
    format!("{PRIMITIVE}.{field}")
}

#[test]
fn accessors_and_views() {
    let position = place("attributes.POSITION");
    set("/accessors/0/count", json!(1000), &position, "needs 12000 bytes");
    set("/accessors/0/count", json!(0), &position, "entries");
    set("/accessors/0/count", json!(u64::MAX), &position, "entries");
    set("/accessors/0/byteOffset", json!(4), &position, "from byte 4");
    set("/accessors/0/byteOffset", json!(u64::MAX), &position, "from byte");
    set("/accessors/0/type", json!("VEC2"), &position, "2 components");
    set("/accessors/0/type", json!("MAT3"), &position, "matrices");
    set("/accessors/0/type", json!("VEC9"), "accessors[0].type", "not allow");
    set("/accessors/0/componentType", json!(77), "accessors[0].componentType", "not allow");
    set("/accessors/0/bufferView", json!(9), "accessors[0].bufferView", "missing");
    set("/accessors/0/bufferView", Value::Null, &position, "lacks data");
    set("/bufferViews/0/byteLength", json!(9999), "bufferViews[0]", "reaches past");
    set("/bufferViews/0/byteOffset", json!(u64::MAX), "bufferViews[0]", "reaches past");
    set("/bufferViews/0/buffer", json!(3), "bufferViews[0].buffer", "missing");
    set("/bufferViews/0/byteStride", json!(8), &position, "stride of 8");
}

#[test]
fn buffers() {
    for (buffer, place, reason) in [
        (json!({ "byteLength": 42 }), "buffers[0].uri", "no data"),
        (json!({ "byteLength": 42, "uri": "data:;base64,AAAA" }), "buffers[0].byteLength", "says 42"),
        (json!({ "byteLength": 42, "uri": "data:;base64,A*AA" }), "buffers[0].uri", "character 1"),
        (json!({ "byteLength": 42, "uri": "data:;base64" }), "buffers[0].uri", "comma"),
        (json!({ "byteLength": 42, "uri": "data:text/plain,abc" }), "buffers[0].uri", "base64"),
        (json!({ "byteLength": 42, "uri": "../x.bin" }), "buffers[0].uri", "no folder"),
    ] {
        let mut tiny = triangle();
        tiny.json["buffers"] = json!([buffer]);
        refused(&tiny, place, reason);
    }
}

#[test]
fn indices() {
    let place = place("indices");
    set("/accessors/1/componentType", json!(5126), &place, "whole numbers");
    set("/accessors/1/count", json!(2), &place, "does not make triangles");
    set("/meshes/0/primitives/0/indices", json!(9), &place, "missing");
    let mut tiny = triangle();
    tiny.bytes[38] = 7;
    refused(&tiny, &place, "names vertex 7 at entry 1");
}

#[test]
fn attributes() {
    let (position, normal) = (place("attributes.POSITION"), place("attributes.NORMAL"));
    set("/meshes/0/primitives/0/attributes", json!({}), &position, "missing");
    set("/meshes/0/primitives/0/attributes/POSITION", json!(9), &position, "accessor 9");
    set("/meshes/0/primitives/0/attributes/NORMAL", json!(9), &normal, "missing");
    set("/meshes/0/primitives/0/mode", json!(77), &place("mode"), "not allow");
    set_rich("/accessors/1/count", json!(3), &normal, "3 entries for 4 vertices");
    set_rich("/accessors/2/count", json!(2), &place("attributes.TEXCOORD_0"), "2 entries for 4");
    set_rich("/accessors/3/type", json!("VEC2"), &place("attributes.COLOR_0"), "2 components");
    let mut tiny = triangle();
    tiny.bytes[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(&tiny, &position, "vertex 0");
    let mut tiny = everything();
    tiny.bytes[48..52].copy_from_slice(&f32::INFINITY.to_le_bytes());
    refused(&tiny, &normal, "not finite at vertex 0");
    let mut tiny = triangle();
    tiny.json["nodes"][0]["scale"] = json!([1e30, 1, 1]);
    refused(&tiny, &position, "too far");
}

#[test]
fn sparse_accessors() {
    let user = "meshes[1].primitives[0].attributes.POSITION.sparse";
    set_rich("/accessors/5/sparse/count", json!(9), user, "9 of 4 entries");
    set_rich("/accessors/5/sparse/indices/byteOffset", json!(99), user, "from byte 99");
    set_rich("/accessors/5/sparse/indices/componentType", json!(5126), "accessors[5].sparse.indices.componentType", "");
    set_rich("/accessors/5/sparse/values/bufferView", json!(99), "accessors[5].sparse.values.bufferView", "missing");
    let mut tiny = everything();
    let view = tiny.json["accessors"][5]["sparse"]["indices"]["bufferView"].as_u64().unwrap() as usize;
    let at = tiny.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    tiny.bytes[at] = 4;
    refused(&tiny, user, "missing, by index 0");
}

#[test]
fn nodes() {
    let position = place("attributes.POSITION");
    set("/nodes/0/children", json!([0]), "nodes[0]", "own ancestor");
    set("/nodes", json!([{ "mesh": 0 }, { "children": [2] }, { "children": [1] }]), "nodes[1]", "own ancestor");
    set("/nodes", json!([{ "children": [2] }, { "children": [2] }, { "mesh": 0 }]), "nodes[1].children[0]", "already");
    set("/nodes/0/children", json!([5]), "nodes[0].children[0]", "missing");
    set("/nodes/0/mesh", json!(5), "nodes[0].mesh", "missing");
    set("/nodes/0/matrix", json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "nodes[0].matrix", "affine");
    set("/nodes/0/matrix", json!([1e300, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), &position, "too far");
    set("/nodes/0/matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0]), "nodes[0].matrix", "affine");
    set("/nodes/0/matrix", json!([1, 0, 0]), "nodes[0].matrix", "not glTF JSON");
    set("/nodes/0/rotation", json!([0, 0, 0, 0]), "nodes[0].rotation", "not a rotation");
    set("/nodes/0/scale", json!([1e300, 1, 1]), &position, "too far");
    set("/nodes/0/translation", json!([0, 1e300, 1]), &position, "too far");
    set("/scenes/0/nodes", json!([0, 0]), "scenes[0].nodes", "twice");
    set("/scenes/0/nodes", json!([4]), "scenes[0].nodes[0]", "missing");
    set("/scene", json!(4), "scene", "missing");
    set("/scenes/0/nodes", json!([]), "", "no triangles");
}

#[test]
fn materials_and_images() {
    set("/meshes/0/primitives/0/material", json!(2), &place("material"), "missing");
    set_rich(
        "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
        json!(5),
        "materials[0].pbrMetallicRoughness.baseColorTexture.index",
        "missing",
    );
    set_rich("/textures/0/source", json!(5), "textures[0].source", "missing");
}

/// Sets a value in the file with all features; it reads without its texture, with a reason.
#[track_caller]
fn without_texture(tiny: &Tiny, reason: &str) {
    let mesh = parse(&tiny.gltf(), Path::new("x.gltf"), None).expect(reason);
    assert!(mesh.textures.is_empty() && mesh.parts.iter().all(|part| part.surface.base_color.is_none()));
    let [warning] = &mesh.warnings[..] else { panic!("{reason}: {:?}", mesh.warnings) };
    assert!(warning.starts_with("images[0]: ") && warning.contains(reason), "{warning}");
}

#[test]
fn an_image_that_cannot_be_used_leaves_the_surface_plain() {
    for (image, reason) in [
        (json!({}), "no data"),
        (json!({ "uri": "data:;base64,R0lGODlh" }), "neither PNG nor JPEG"),
        (json!({ "uri": "nothing.png" }), "no folder"),
        (json!({ "uri": "data:image/png;base64,iVBORw0KGgo=" }), "cannot be decoded"),
    ] {
        let mut tiny = everything();
        tiny.json["images"][0] = image;
        without_texture(&tiny, reason);
    }
    let mut tiny = everything();
    let view = tiny.json["images"][0]["bufferView"].as_u64().unwrap();
    set_in(&mut tiny, &format!("/bufferViews/{view}/byteLength"), json!(40));
    without_texture(&tiny, "cannot be decoded");
}

/// The file with all features, with this image size in its header and a valid checksum.
fn with_image_size(width: u32, height: u32) -> Tiny {
    let mut tiny = everything();
    let view = tiny.json["images"][0]["bufferView"].as_u64().unwrap() as usize;
    let at = tiny.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    tiny.bytes[at + 16..at + 20].copy_from_slice(&width.to_be_bytes());
    tiny.bytes[at + 20..at + 24].copy_from_slice(&height.to_be_bytes());
    let sum = crc32(&tiny.bytes[at + 12..at + 29]);
    tiny.bytes[at + 29..at + 33].copy_from_slice(&sum.to_be_bytes());
    tiny
}

#[test]
fn an_image_of_too_many_pixels_is_left_out_before_it_is_decoded() {
    without_texture(&with_image_size(60_000, 2), "60000 × 2 pixels");
    // 768 MiB as RGBA: more than the budget for all textures of a scene.
    without_texture(&with_image_size(16_384, 12_288), "together would take more than");
    // Too large for the decoder.
    without_texture(&with_image_size(16_384, 16_384), "more than");
}

/// The checksum of PNG chunks (ISO 3309).
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 0 { c >> 1 } else { c >> 1 ^ 0xedb8_8320 })
    })
}

#[test]
fn documents_and_extensions() {
    set("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "extensionsRequired[0]", "not supported");
    set("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "extensionsRequired[0]", "KHR_draco");
    set("/asset", json!({}), "", "version");
    set("/asset/version", json!("1.0"), "asset.version", "is 1.0");
    set("/asset/minVersion", json!("2.1"), "asset.minVersion", "is 2.1");
    set("/meshes/0/primitives", json!(7), "meshes[0].primitives", "not glTF JSON");
    set("/meshes/0/primitives/0/indices", json!(0.5), "meshes[0].primitives[0].indices", "not a whole number");
    set("/meshes/0/primitives/0/indices", json!(-1), "meshes[0].primitives[0].indices", "negative");
    for (bytes, reason) in [(&b""[..], "EOF"), (b"[1, 2", "not glTF JSON"), (b"{}", "asset"), (b"\xff\xfe", "not glTF")]
    {
        let error = parse(bytes, Path::new("x.gltf"), None).unwrap_err();
        assert!(error.reason.contains(reason), "{error}");
    }
}

#[test]
fn containers() {
    let whole = triangle().glb();
    let with = |at: usize, bytes: &[u8]| {
        let mut broken = whole.clone();
        broken[at..at + bytes.len()].copy_from_slice(bytes);
        broken
    };
    let cases: [(Vec<u8>, &str); 8] = [
        (whole[..10].to_vec(), "ends within a header"),
        (whole[..whole.len() - 4].to_vec(), "bytes, but has"),
        (with(4, &[1]), "version 1"),
        (with(8, &[4, 0, 0, 0]), "says 4 bytes"),
        (with(8, &[255, 255, 255, 255]), "says 4294967295"),
        (with(12, &[255, 255, 255, 255]), "does not fit"),
        (with(16, b"BIN\0"), "does not begin with a JSON chunk"),
        (
            container(b"", b"")[..12].iter().copied().enumerate().map(|(i, b)| if i == 8 { 12 } else { b }).collect(),
            "no JSON chunk",
        ),
    ];
    for (bytes, reason) in cases {
        let error = parse(&bytes, Path::new("x.glb"), None).expect_err(reason);
        assert_eq!(error.place, "container", "{error}");
        assert!(error.reason.contains(reason), "{error}");
    }
}
