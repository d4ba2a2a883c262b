//! Saving and opening: every command gets a response, and the editor asks before it overwrites anything.

use std::path::Path;
use std::sync::Arc;

use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::jobs::Task;
use isolith::scene::{Scene, Shape};

use super::{click, field, open, open_in, pointer, press, scene, select, shape};
use crate::settle::Settle;

const CTRL: Modifiers = Modifiers::COMMAND;

/// Presses Ctrl S or Ctrl O and types a path, ended by Enter.
fn give_path(harness: &mut Harness<'_, Editor>, key: Key, path: &str) {
    press(harness, if key == Key::S { CTRL.plus(Modifiers::SHIFT) } else { CTRL }, key);
    retype(harness, path);
}

fn retype(harness: &mut Harness<'_, Editor>, path: &str) {
    press(harness, CTRL, Key::A);
    harness.event(Event::Text(path.into()));
    harness.settle();
    press(harness, Modifiers::NONE, Key::Enter);
}

fn last(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().last().map_or(String::new(), |message| message.text.clone())
}

fn saved(path: &Path) -> Scene {
    Document::open(path).unwrap().scene().clone()
}

/// A document with a file in a folder of its own.
fn with_file() -> (Harness<'static, Editor>, tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.json");
    let (scene, _) = scene();
    let mut document = Document::new(scene);
    document.save_as(&path).unwrap();
    (open_in(document, egui::vec2(1280.0, 2400.0)), folder, path)
}

#[test]
fn ctrl_s_always_answers() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    press(&mut harness, CTRL, Key::S);
    assert!(harness.query_by_label("Path").is_some(), "without a file the path is asked for");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    let (mut harness, _folder, path) = with_file();
    press(&mut harness, CTRL, Key::S);
    assert!(last(&harness).starts_with("Saved"), "though nothing has changed");
    // While the user types a number: the editor commits it first.
    select(&mut harness, "Ball");
    let radius = field(&harness, "Radius").rect().center();
    click(&mut harness, radius);
    press(&mut harness, CTRL, Key::A);
    harness.event(Event::Text("3".into()));
    harness.settle();
    press(&mut harness, CTRL, Key::S);
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 3.0 });
    assert_eq!(saved(&path), *harness.state().document().scene());
    assert!(!harness.state().document().is_changed());
    // While the user types a name in the tree.
    press(&mut harness, Modifiers::NONE, Key::F2);
    harness.event(Event::Text("Xenon".into()));
    harness.settle();
    press(&mut harness, CTRL, Key::S);
    assert_eq!(saved(&path).node(ball).unwrap().name, "Xenon");
    // With an open menu, which closes.
    harness.state_mut().document_mut().undo();
    let menu = harness.get_all_by_label("Edit").next().unwrap().rect().center();
    click(&mut harness, menu);
    press(&mut harness, CTRL, Key::S);
    assert!(!egui::Popup::is_any_open(&harness.ctx));
    assert_eq!(saved(&path).node(ball).unwrap().name, "Ball");
    // With the open palette, which closes too.
    press(&mut harness, Modifiers::NONE, Key::F3);
    std::fs::remove_file(&path).unwrap();
    press(&mut harness, CTRL, Key::S);
    assert!(!harness.state().has_dialog() && path.is_file());
    // In the middle of a drag.
    harness.run_steps(40);
    let radius = field(&harness, "Radius").rect().center();
    pointer(&mut harness, radius, true);
    for step in 1..=8 {
        harness.event(Event::PointerMoved(radius + egui::vec2(step as f32 * 10.0, 0.0)));
        harness.step();
    }
    press(&mut harness, CTRL, Key::S);
    assert_eq!(saved(&path), *harness.state().document().scene());
    pointer(&mut harness, radius + egui::vec2(80.0, 0.0), false);
    harness.settle();
}

#[test]
fn saving_over_a_file_asks() {
    let (mut harness, folder, _) = with_file();
    let other = folder.path().join("other.json");
    std::fs::write(&other, "precious").unwrap();
    let precious = || std::fs::read_to_string(&other).unwrap() == "precious";
    // Under its name, and under a name that gets the extension.
    for name in [other.display().to_string(), other.with_extension("").display().to_string()] {
        give_path(&mut harness, Key::S, &name);
        assert!(harness.query_by_label("Replace").is_some());
        assert!(precious());
        // Neither a second Enter nor Escape confirms.
        press(&mut harness, Modifiers::NONE, Key::Enter);
        assert!(precious());
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(precious());
        assert!(harness.query_by_label("Path").is_some(), "another path can be typed");
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(!harness.state().has_dialog());
    }
    assert!(harness.state().title().starts_with("own.json"));
    give_path(&mut harness, Key::S, &other.display().to_string());
    harness.get_by_label("Replace").click();
    harness.settle();
    assert!(!precious());
    assert!(harness.state().title().starts_with("other.json"));
}

#[test]
fn saving_to_the_documents_own_file_does_not_ask() {
    let (mut harness, folder, path) = with_file();
    harness.get_by_label("Add sphere").click();
    harness.settle();
    for name in [path.clone(), folder.path().join(".").join("own.json"), path.with_extension("")] {
        give_path(&mut harness, Key::S, &name.display().to_string());
        assert!(!harness.state().has_dialog(), "{name:?}");
        assert!(last(&harness).starts_with("Saved"));
    }
    assert_eq!(saved(&path).nodes().len(), 5);
}

#[test]
fn a_folder_is_no_file() {
    let (mut harness, folder, path) = with_file();
    std::fs::create_dir(folder.path().join("sub.json")).unwrap();
    let below = |name: &str| format!("{}/{name}", folder.path().display());
    for (name, reason) in [
        (folder.path().display().to_string(), "is a folder"),
        (below(""), "is a folder"),
        (below("new/"), "is a folder"),
        (below("sub"), "is a folder"),
        (below("none/scene.json"), "There is no folder"),
        (" ".into(), "Type the name"),
    ] {
        give_path(&mut harness, Key::S, &name);
        assert!(harness.query_by_label_contains(reason).is_some(), "{name}: {reason}");
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(!harness.state().has_dialog());
    }
    for (name, reason) in [(below(""), "is a folder"), (below("none.json"), "There is no file")] {
        give_path(&mut harness, Key::O, &name);
        assert!(harness.query_by_label_contains(reason).is_some(), "{name}: {reason}");
        // The next input may be right.
        retype(&mut harness, &path.display().to_string());
        assert!(!harness.state().has_dialog());
    }
    assert!(!folder.path().join("none").exists() && !folder.path().join("new").exists(), "nothing was written");
}

#[test]
fn a_broken_file_is_refused_before_the_question_about_unsaved_work() {
    let (mut harness, folder, path) = with_file();
    let broken = folder.path().join("broken.json");
    std::fs::write(&broken, "{").unwrap();
    harness.get_by_label("Add sphere").click();
    harness.settle();
    let scene = harness.state().document().scene().clone();
    give_path(&mut harness, Key::O, &broken.display().to_string());
    assert!(harness.query_by_label("Discard").is_none());
    assert!(last(&harness).contains("broken.json"), "{}", last(&harness));
    assert_eq!(*harness.state().document().scene(), scene);
    // For a good path the editor asks, and shows the scene after confirmation.
    give_path(&mut harness, Key::O, &path.display().to_string());
    harness.get_by_label("Discard").click();
    harness.settle();
    assert_eq!(harness.state().document().scene().nodes().len(), 4);
    assert!(!harness.state().document().is_changed());
}

#[test]
fn a_broken_example_is_refused_before_the_question() {
    let (scene, _) = scene();
    let mut editor = Editor::new(Document::new(scene));
    let open = |_: &Task| Err("example.json: nodes: must be a list".to_owned());
    editor.set_examples(vec![isolith::editor::Example { name: "Broken".into(), is_test: false, open: Arc::new(open) }]);
    let mut harness = Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &super::no_picture()), editor);
    harness.settle();
    harness.get_by_label("Add sphere").click();
    harness.settle();
    let menu = harness.get_all_by_label("File").next().unwrap().rect().center();
    click(&mut harness, menu);
    harness.run_steps(40);
    let list = harness.get_all_by_label("Examples").next().unwrap().rect().center();
    click(&mut harness, list);
    harness.run_steps(40);
    let entry = harness.get_by_label("Broken").rect().center();
    click(&mut harness, entry);
    assert!(harness.query_by_label("Discard").is_none());
    assert!(last(&harness).contains("example.json"), "{}", last(&harness));
}

#[test]
fn ctrl_s_answers_a_question_about_saving() {
    let (mut harness, folder, path) = with_file();
    harness.get_by_label("Add sphere").click();
    harness.settle();
    press(&mut harness, CTRL, Key::N);
    press(&mut harness, CTRL, Key::S);
    assert_eq!(saved(&path).nodes().len(), 5);
    assert_eq!(harness.state().document().scene().nodes().len(), 1, "and goes on with what was wanted");
    press(&mut harness, CTRL, Key::S);
    press(&mut harness, CTRL, Key::A);
    let new = folder.path().join("new.json");
    harness.event(Event::Text(new.display().to_string()));
    harness.settle();
    press(&mut harness, CTRL, Key::S);
    assert!(new.is_file() && !harness.state().has_dialog());
}

#[test]
fn leaving_a_question_by_escape_loses_nothing() {
    let (mut harness, _folder, _) = with_file();
    harness.get_by_label("Add sphere").click();
    harness.settle();
    for key in [Key::N, Key::Q] {
        press(&mut harness, CTRL, key);
        assert!(harness.query_by_label("Discard").is_some());
        press(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(!harness.state().has_dialog() && !harness.state().wants_close());
        assert_eq!(harness.state().document().scene().nodes().len(), 5);
        assert_eq!(harness.state().document().selection().len(), 1, "and deselects nothing");
    }
}
