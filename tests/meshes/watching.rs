//! Files that change while the editor shows them.

use std::fs;
use std::path::Path;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use isolith::document::{Document, Edit};
use isolith::editor::{Command, Editor, Picture};
use isolith::mesh::{MeshLibrary, ReloadOutcome, Watcher};
use isolith::scene::{MeshNode, Node, NodeKind, Scene, file};
use serde_json::json;

use super::tiny::{Tiny, triangle};
use crate::settle::Settle;

/// Longer than any change takes to be noticed: the watcher looks once a second.
const PATIENCE: Duration = Duration::from_secs(20);

/// Writes a model of this size and its buffer.
fn write(folder: &Path, size: f32) {
    let mut tiny = Tiny::new();
    let positions = tiny.floats(&[[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]]);
    tiny.mesh(json!({ "attributes": { "POSITION": positions } }));
    tiny.json["buffers"] = json!([{ "byteLength": tiny.bytes.len(), "uri": "model.bin" }]);
    fs::write(folder.join("model.bin"), &tiny.bytes).unwrap();
    fs::write(folder.join("model.gltf"), tiny.gltf()).unwrap();
}

/// Waits until `done` returns a value.
fn wait<T>(what: &str, mut done: impl FnMut() -> Option<T>) -> T {
    let started = Instant::now();
    loop {
        if let Some(found) = done() {
            return found;
        }
        assert!(started.elapsed() < PATIENCE, "{what} did not happen");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_file_that_changes_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1.0);
    let mut library = MeshLibrary::new(Some(folder.path().into()));
    assert_eq!(library.get("model.gltf").unwrap().bounds.max.x, 1.0);
    let (woken, wakes) = channel();
    let watcher = Watcher::start(move || {
        let _ = woken.send(());
    })
    .unwrap();
    watcher.watch(library.sources());
    // Only its buffer has changed.
    let mut bytes = fs::read(folder.path().join("model.bin")).unwrap();
    bytes[12..16].copy_from_slice(&3.0_f32.to_le_bytes());
    std::thread::sleep(Duration::from_millis(20));
    fs::write(folder.path().join("model.bin"), &bytes).unwrap();
    let fresh = wait("a change of the buffer", || watcher.news().next());
    assert!(wakes.try_recv().is_ok());
    assert!(matches!(library.replace(fresh), ReloadOutcome::Fresh(mesh) if mesh.bounds.max.x == 3.0));
    assert_eq!(library.get("model.gltf").unwrap().bounds.max.x, 3.0);
    // While the file is broken, the old model stays; once it is repaired, the watcher reads it.
    fs::write(folder.path().join("model.gltf"), "{").unwrap();
    let fresh = wait("a broken file", || watcher.news().next());
    assert!(matches!(library.replace(fresh), ReloadOutcome::Kept(error) if error.reason.contains("not glTF JSON")));
    assert_eq!(library.get("model.gltf").unwrap().bounds.max.x, 3.0);
    write(folder.path(), 5.0);
    let fresh = wait("a mended file", || watcher.news().next());
    assert!(matches!(library.replace(fresh), ReloadOutcome::Fresh(mesh) if mesh.bounds.max.x == 5.0));
    // Nothing waits for it in another folder.
    watcher.read_all();
    let fresh = wait("a file that was asked for", || watcher.news().next());
    library.set_folder(None);
    assert!(matches!(library.replace(fresh), ReloadOutcome::Unwanted));
}

#[test]
fn a_file_that_appears_is_read() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1.0);
    fs::remove_file(folder.path().join("model.bin")).unwrap();
    let mut library = MeshLibrary::new(Some(folder.path().into()));
    assert!(library.get("model.gltf").is_err() && library.get("later.glb").is_err());
    let watcher = Watcher::start(|| ()).unwrap();
    watcher.watch(library.sources());
    write(folder.path(), 2.0);
    fs::write(folder.path().join("later.glb"), triangle().glb()).unwrap();
    for _ in 0..2 {
        let fresh = wait("a file that appears", || watcher.news().next());
        assert!(matches!(library.replace(fresh), ReloadOutcome::Fresh(_)));
    }
    assert_eq!(library.get("model.gltf").unwrap().bounds.max.x, 2.0);
    assert!(library.get("later.glb").is_ok());
}

/// An editor with a scene that uses the model of this folder.
fn open(folder: &Path) -> Harness<'static, Editor> {
    let mut scene = Scene::new();
    let mesh = NodeKind::Mesh(MeshNode::new("model.gltf"));
    scene.insert(None, 0, Node::new("Model", mesh)).unwrap();
    fs::write(folder.join("scene.json"), file::to_json(&scene).unwrap()).unwrap();
    let document = Document::open(&folder.join("scene.json")).unwrap();
    let mut harness = Harness::builder()
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &Picture::default()), Editor::new(document));
    harness.settle();
    harness
}

fn width(harness: &Harness<'_, Editor>) -> f64 {
    harness.state().meshes().known("model.gltf").unwrap().as_ref().unwrap().bounds.max.x
}

#[test]
fn the_editor_follows_a_model_on_disk_and_reads_it_again_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1.0);
    let mut harness = open(folder.path());
    assert_eq!(width(&harness), 1.0);
    std::thread::sleep(Duration::from_millis(20));
    write(folder.path(), 2.0);
    wait("a change of the model", || {
        harness.step();
        (width(&harness) == 2.0).then_some(())
    });
    let last =
        |harness: &Harness<'_, Editor>| harness.state().messages().last().map(|m| m.text.clone()).unwrap_or_default();
    assert_eq!(last(&harness), "model.gltf was read again");
    // While the file is broken, the editor reports it and keeps the model.
    fs::write(folder.path().join("model.gltf"), "no glTF").unwrap();
    wait("a message", || {
        harness.step();
        last(&harness).ends_with("It is shown as it was before").then_some(())
    });
    assert_eq!(width(&harness), 2.0);
    write(folder.path(), 3.0);
    let ctx = harness.ctx.clone();
    harness.state_mut().run(Command::ReloadModels, &ctx);
    wait("what was asked for", || {
        harness.step();
        (width(&harness) == 3.0).then_some(())
    });
}

#[test]
fn what_a_model_holds_that_is_not_drawn_stands_in_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let mut tiny = triangle();
    tiny.json["animations"] = json!([{}]);
    fs::write(folder.path().join("model.gltf"), tiny.gltf()).unwrap();
    let harness = open(folder.path());
    let told: Vec<_> = harness.state().messages().map(|message| message.text.clone()).collect();
    assert_eq!(told, ["model.gltf: 1 animation not played: the model is shown at rest"]);
}

#[test]
fn the_editor_reads_a_model_beside_its_frames_and_leaves_it_out_when_that_is_canceled() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 4.0);
    let mut harness = open(folder.path());
    assert_eq!(width(&harness), 4.0);
    // A frame takes the model over, and no frame has been drawn yet.
    let document = Document::open(&folder.path().join("scene.json")).unwrap();
    let editor = Editor::new(document);
    assert!(editor.meshes().known("model.gltf").is_none() && editor.is_busy());
    // The first view waited for the model and fits its size.
    let distance = |harness: &Harness<'_, Editor>| harness.state().view().camera.position.length();
    let far = distance(&harness);
    write(folder.path(), 1.0);
    assert!(far > 1.5 * distance(&open(folder.path())), "{far}");
    // A canceled read gives a message for the node; a request reads the model again.
    let mesh = NodeKind::Mesh(MeshNode::new("other.gltf"));
    fs::copy(folder.path().join("model.gltf"), folder.path().join("other.gltf")).unwrap();
    let insert = Edit::Insert { parent: None, position: 0, node: Node::new("Other", mesh) };
    harness.state_mut().document_mut().apply(insert).unwrap();
    harness.step();
    harness.state().jobs().cancel_foremost();
    harness.settle();
    let refused =
        harness.state().meshes().known("other.gltf").unwrap().as_ref().err().map(|error| error.reason.clone());
    // The job may have finished before the cancel.
    if let Some(reason) = refused {
        assert!(reason.contains("canceled"), "{reason}");
        let ctx = harness.ctx.clone();
        harness.state_mut().run(Command::ReloadModels, &ctx);
        wait("what was asked for", || {
            harness.step();
            harness.state().meshes().known("other.gltf").unwrap().is_ok().then_some(())
        });
    }
}
