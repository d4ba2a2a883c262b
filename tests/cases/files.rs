//! Files written: pictures, scenes, recovery.

mod conflict;
mod outputs;

use std::fs;
use std::path::Path;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::Document;
use isolith::editor::{Editor, Picture};
use isolith::scene::{Group, Node, NodeKind, Scene};

/// Groups whose names can be shown, and end in `mark`.
fn plain_scene(mark: u64, nodes: u64) -> Scene {
    let mut scene = Scene::new();
    for i in 0..nodes {
        let node = Node::new(format!("Group {i} of {mark}"), NodeKind::Group(Group::UNION));
        scene.insert(None, 0, node).expect("there is room");
    }
    scene
}

/// The names in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// An editor without a GPU, prepared by `with`.
fn editor(document: Document, with: impl FnOnce(&mut Editor)) -> Harness<'static, Editor> {
    let mut editor = Editor::new(document);
    editor.ask_for_paths_in_window();
    with(&mut editor);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &Picture::default()), editor);
    harness.run();
    harness
}

fn press(harness: &mut Harness<'_, Editor>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

fn shows(harness: &Harness<'_, Editor>, label: &str) -> bool {
    harness.query_by_label(label).is_some()
}

fn last_message(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().next_back().map_or(String::new(), |message| message.text.clone())
}
