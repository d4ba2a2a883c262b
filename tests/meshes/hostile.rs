//! Files made to hang, to exhaust memory or to write into a terminal.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use isolith::field::flatten;
use isolith::mesh::{MeshLibrary, ReloadOutcome, load, parse};
use isolith::scene::file;
use serde_json::{Value, json};

use super::tiny::{Tiny, everything, triangle};

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/hostile/mesh")
}

/// Messages about the meshes of a scene in this folder.
fn said(folder: &Path, scene: &str) -> Vec<String> {
    let scene = file::load(&folder.join(scene)).unwrap_or_else(|error| panic!("{error}"));
    let flat = flatten(&scene, 0.0).unwrap();
    let (meshes, warnings) = flat.load_meshes(&mut MeshLibrary::new(Some(folder.into())));
    assert!(meshes.iter().all(Option::is_none));
    warnings.into_iter().map(|warning| warning.reason).collect()
}

#[cfg(unix)]
fn make_pipe(path: &Path) {
    let status = std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo is there");
    assert!(status.success());
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_before_they_are_opened() {
    let started = Instant::now();
    let folder = tempfile::tempdir().unwrap();
    fs::copy(cases().join("pipe.json"), folder.path().join("pipe.json")).unwrap();
    make_pipe(&folder.path().join("pipe.glb"));
    let said = said(folder.path(), "pipe.json");
    assert!(said.len() == 1 && said[0].contains("pipe.glb: is not a file"), "{said:?}");
    // As a buffer, as an image, through a link, as a device.
    make_pipe(&folder.path().join("pipe.bin"));
    std::os::unix::fs::symlink("pipe.bin", folder.path().join("link.bin")).unwrap();
    for uri in ["pipe.bin", "link.bin"] {
        let mut tiny = triangle();
        tiny.json["buffers"] = json!([{ "byteLength": 42, "uri": uri }]);
        fs::write(folder.path().join("model.gltf"), tiny.gltf()).unwrap();
        let error = load(&folder.path().join("model.gltf")).unwrap_err();
        assert!(error.place == "buffers[0].uri" && error.reason == "is not a file", "{error}");
        let mut tiny = everything();
        tiny.json["images"] = json!([{ "uri": uri }]);
        fs::write(folder.path().join("model.gltf"), tiny.gltf()).unwrap();
        let mesh = load(&folder.path().join("model.gltf")).unwrap();
        assert_eq!(mesh.warnings, ["images[0]: is not a file; it is not drawn"]);
    }
    for device in ["/dev/zero", "/dev/null"] {
        assert_eq!(load(Path::new(device)).unwrap_err().reason, "is not a file");
    }
    assert!(started.elapsed() < Duration::from_secs(5));
}

#[test]
fn what_controls_a_terminal_never_reaches_a_message() {
    let said = said(&cases(), "escape.json");
    assert!(said.len() == 1 && said[0].contains("\\u{1b}]0;owned\\u{7}.bin"), "{said:?}");
    let evil = "\u{1b}]0;owned\u{7}\u{9b}31m\u{202e}\r\n";
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut tiny = triangle();
        change(&mut tiny.json);
        parse(&tiny.gltf(), Path::new(evil), None).unwrap_err().to_string()
    };
    let long = evil.repeat(10_000);
    for text in [
        broken(&|json| json["extensionsRequired"] = json!([evil])),
        broken(&|json| json["extensionsRequired"] = json!([long])),
        broken(&|json| json["meshes"][0]["primitives"][0]["attributes"][evil] = json!(99)),
        broken(&|json| json["meshes"][0]["primitives"][0]["attributes"][long.as_str()] = json!(99)),
        broken(&|json| json["asset"]["version"] = json!(evil)),
        broken(&|json| json["buffers"] = json!([{ "byteLength": 42, "uri": format!("data:{evil}") }])),
        broken(&|json| json["accessors"][0]["count"] = json!(evil)),
    ] {
        assert!(!text.chars().any(|c| c.is_control() || c == '\u{202e}'), "{text:?}");
        assert!(text.len() < 10_000, "{} bytes", text.len());
    }
    let mut library = MeshLibrary::new(Some(cases()));
    let error = library.get(evil).unwrap_err().to_string();
    assert!(!error.chars().any(char::is_control), "{error:?}");
}

#[test]
fn json_that_would_fill_the_memory_is_refused_before_it_is_read() {
    let started = Instant::now();
    for (list, reason) in [("{},", "objects, more than"), ("[],", "objects, more than"), ("0,", "values, more than")] {
        let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}0]}}", list.repeat(17 << 20));
        let error = parse(text.as_bytes(), Path::new("x.gltf"), None).unwrap_err();
        assert!(error.reason.contains(reason), "{error}");
    }
    assert!(started.elapsed() < Duration::from_secs(20));
}

/// A file of one kilobyte that reads millions of vertices again and again.
#[test]
fn what_is_read_again_and_again_is_counted() {
    let started = Instant::now();
    let mut tiny = Tiny::new();
    let positions = tiny.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 0, "componentType": 5121 },
        "values": { "bufferView": 0 },
    });
    let accessor = json!({ "componentType": 5126, "type": "VEC3", "count": 8_000_000, "sparse": sparse });
    tiny.json["accessors"].as_array_mut().unwrap().push(accessor);
    let indices = tiny.indices(&[0, 1, 2]);
    let primitive = |i: usize| json!({ "attributes": { "POSITION": positions + 1, "TEXCOORD_9": i % 2 }, "indices": indices, "targets": vec![json!({}); i] });
    tiny.json["meshes"] = json!([{ "primitives": (0..100).map(primitive).collect::<Vec<_>>() }]);
    let error = parse(&tiny.gltf(), Path::new("x.gltf"), None).unwrap_err();
    assert!(error.reason.contains("entries to read"), "{error}");
    assert!(started.elapsed() < Duration::from_secs(20), "{:?}", started.elapsed());
}

/// Files of a few hundred kilobytes in which everything refers to everything.
#[test]
fn what_many_nodes_name_is_counted() {
    let nodes = |tiny: &mut Tiny, count: usize, node: Value| {
        tiny.json["nodes"] = json!(vec![node; count]);
        tiny.json["scenes"][0]["nodes"] = json!((0..count).collect::<Vec<_>>());
    };
    let primitives = |tiny: &mut Tiny, count: usize, primitive: Value| {
        tiny.json["meshes"][0]["primitives"].as_array_mut().unwrap().extend(vec![primitive; count]);
    };
    let mut points = triangle();
    nodes(&mut points, 50_000, json!({ "mesh": 0 }));
    primitives(&mut points, 1_000, json!({ "attributes": { "POSITION": 0 }, "mode": 0 }));
    let mut targets = triangle();
    nodes(&mut targets, 50_000, json!({ "mesh": 0 }));
    targets.json["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({}); 10_000]);
    let mut joints = triangle();
    nodes(&mut joints, 50_000, json!({ "mesh": 0, "skin": 0 }));
    joints.json["skins"] = json!([{ "joints": vec![0; 10_000] }]);
    let mut degenerate = triangle();
    let same = degenerate.indices(&[0; 3]);
    nodes(&mut degenerate, 50_000, json!({ "mesh": 0 }));
    primitives(&mut degenerate, 1_000, json!({ "attributes": { "POSITION": 0 }, "indices": same }));
    let mut large = triangle();
    large.json["accessors"][0]["count"] = json!(8_000_000);
    large.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": 0, "componentType": 5121 },
        "values": { "bufferView": 0 },
    });
    large.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    large.json["meshes"][0]["primitives"] = json!([]);
    primitives(&mut large, 100, json!({ "attributes": { "POSITION": 0 }, "mode": 5 }));
    for (tiny, reason) in [
        (points, "attributes to look at"),
        (targets, "attributes to look at"),
        (joints, "entries to read"),
        (degenerate, "attributes to look at"),
        (large, "triangles"),
    ] {
        let started = Instant::now();
        let error = parse(&tiny.gltf(), Path::new("x.gltf"), None).unwrap_err();
        assert!(error.reason.contains(reason), "{error}");
        assert!(started.elapsed() < Duration::from_secs(20), "{reason}: {:?}", started.elapsed());
    }
}

/// Textures of several files share one budget.
#[test]
fn textures_are_counted_for_the_scene_and_not_for_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut tiny = everything();
    let mut bytes = std::io::Cursor::new(Vec::new());
    // 11 KB that decode to 256 MiB.
    image::GrayImage::new(8192, 8192).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let view = tiny.view(bytes.get_ref());
    tiny.json["images"] = json!([{ "bufferView": view }]);
    for name in ["a.glb", "b.glb", "c.glb"] {
        fs::write(folder.path().join(name), tiny.glb()).unwrap();
    }
    let mut library = MeshLibrary::new(Some(folder.path().into()));
    let [a, b, c] = ["a.glb", "b.glb", "c.glb"].map(|name| library.get(name).unwrap());
    assert!(a.warnings.is_empty() && b.warnings.is_empty());
    assert!(c.textures.is_empty() && c.warnings[0].contains("textures of the scene together"), "{:?}", c.warnings);
    // A reloaded file may use its previous share of the budget again.
    let source = library.sources().into_iter().find(|source| source.path() == "a.glb").unwrap();
    assert!(matches!(library.replace(source.read()), ReloadOutcome::Fresh(mesh) if mesh.textures.len() == 1));
}
