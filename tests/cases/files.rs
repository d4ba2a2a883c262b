//! Output files: pictures, scenes, recovery.

mod conflict;
mod killed;
mod outputs;
mod recovery;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::{Document, Edit};
use isolith::editor::{Editor, Picture};
use isolith::scene::{Group, Node, NodeKind, Scene, file};

use crate::settle::Settle;

/// Groups with displayable names that end in `mark`.
fn plain_scene(mark: u64, nodes: u64) -> Scene {
    let mut scene = Scene::new();
    for i in 0..nodes {
        let node = Node::new(format!("Group {i} of {mark}"), NodeKind::Group(Group::UNION));
        scene.insert(None, 0, node).expect("there is room");
    }
    scene
}

/// The sorted names in a folder.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// An editor without a GPU, set up by `with`.
fn editor(document: Document, with: impl FnOnce(&mut Editor)) -> Harness<'static, Editor> {
    let mut editor = Editor::new(document);
    editor.ask_for_paths_in_window();
    with(&mut editor);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &Picture::default()), editor);
    harness.settle();
    harness
}

fn press(harness: &mut Harness<'_, Editor>, label: &str) {
    harness.get_by_label(label).click();
    harness.settle();
}

fn shows(harness: &Harness<'_, Editor>, label: &str) -> bool {
    harness.query_by_label(label).is_some()
}

fn last_message(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().next_back().map_or(String::new(), |message| message.text.clone())
}

fn add_group(document: &mut Document, name: &str) {
    let node = Node::new(name, NodeKind::Group(Group::UNION));
    document.apply(Edit::Insert { parent: None, position: 0, node }).expect("the scene takes a group");
}

/// A document with a change.
fn changed(name: &str) -> Document {
    let mut document = Document::new(Scene::new());
    add_group(&mut document, name);
    document
}

fn has(document: &Document, name: &str) -> bool {
    document.scene().nodes().iter().any(|node| node.name == name)
}

/// Waits until the condition is true.
fn until(what: &str, is_true: impl Fn() -> bool) {
    let start = Instant::now();
    while !is_true() {
        assert!(start.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// All scenes below the folder, of any process.
fn kept(root: &Path) -> Vec<PathBuf> {
    let folders = fs::read_dir(root).into_iter().flatten().flatten();
    folders.map(|entry| entry.path().join("scene.json")).filter(|path| path.exists()).collect()
}

fn kept_with(root: &Path, name: &str) -> bool {
    kept(root).iter().any(|path| file::load(path).is_ok_and(|scene| scene.nodes().iter().any(|n| n.name == name)))
}
