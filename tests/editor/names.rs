//! Long names and narrow windows: no widget grows or leaves the window, and the full name is readable.

use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::scene::{Group, Light, Node, NodeId, NodeKind, Object, Operation, Scene, ShapeKind};

use super::{open, open_in, press, scene};

fn long(letter: char) -> String {
    format!("Begin {} end", letter.to_string().repeat(120))
}

fn rename(scene: &mut Scene, id: NodeId, name: String, operation: Operation) {
    let mut node = scene.node(id).unwrap().as_ref().clone();
    (node.name, node.operation) = (name, operation);
    scene.replace(node).unwrap();
}

fn viewport(harness: &Harness<'_, Editor>) -> egui::Rect {
    harness.get_by_label("Viewport").rect()
}

#[test]
fn long_names_are_elided_in_the_tree() {
    let (mut scene, [_, ball, cube, _]) = scene();
    rename(&mut scene, ball, long('x'), Operation::Add);
    rename(&mut scene, cube, long('y'), Operation::Subtract);
    let harness = open(scene);
    let left = viewport(&harness).left();
    for name in [long('x'), long('y')] {
        // Its switches stay visible, and its name ends before them.
        let eye = harness.get_by_label(&format!("Hide {name}")).rect();
        assert!(eye.right() <= left, "{eye} {left}");
        let label = harness.get_all_by_label(&name).find(|node| node.rect().right() < left).unwrap().rect();
        assert!(label.right() <= eye.left() + 1.0 && label.width() > 40.0, "{label} {eye}");
    }
    assert_eq!(left, viewport(&open(super::scene().0)).left());
}

#[test]
fn a_deep_tree_can_be_scrolled_to_its_names() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let mut parent = None;
    for depth in 0..30 {
        parent = Some(scene.insert(parent, 0, Node::new(format!("G{depth}"), NodeKind::Group(Group::UNION))).unwrap());
    }
    let object = Object { shape: ShapeKind::Box.default_shape(), material };
    let deepest = scene.insert(parent, 0, Node::new("Deepest", NodeKind::Object(object))).unwrap();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![deepest]);
    harness.run();
    let label = harness.get_all_by_label("Deepest").map(|node| node.rect()).next().unwrap();
    assert!(label.width() > 30.0, "{label}");
}

#[test]
fn the_inspector_keeps_its_width_whatever_is_selected() {
    for size in [vec2(800.0, 500.0), vec2(1280.0, 800.0)] {
        let mut scene = Scene::new();
        let material = scene.materials()[0].id;
        let mut ids = Vec::new();
        for (index, kind) in ShapeKind::ALL.iter().enumerate() {
            let object = Object { shape: kind.default_shape(), material };
            ids.push(scene.insert(None, index, Node::new(long('w'), NodeKind::Object(object))).unwrap());
        }
        ids.push(scene.insert(None, 0, Node::new(long('g'), NodeKind::Group(Group::UNION))).unwrap());
        ids.push(scene.insert(None, 0, Node::new(long('l'), NodeKind::Light(Light::sun()))).unwrap());
        let mut harness = open_in(Document::new(scene), size);
        let before = viewport(&harness);
        for id in ids.iter().copied() {
            harness.state_mut().document_mut().select(vec![id]);
            harness.run();
            assert_eq!(viewport(&harness), before, "{id}");
        }
        harness.state_mut().document_mut().select(ids);
        harness.run();
        assert_eq!(viewport(&harness), before);
    }
}

#[test]
fn long_names_are_elided_in_the_title_and_in_questions() {
    let folder = tempfile::tempdir().unwrap();
    let name = format!("{}.json", long('f'));
    let path = folder.path().join(&name);
    let mut document = Document::new(scene().0);
    document.save_as(&path).unwrap();
    let mut harness = open_in(document, vec2(800.0, 500.0));
    let title = harness.state().title();
    assert!(title.chars().count() < 100 && title.starts_with("Begin f") && title.contains("f end.json"), "{title}");
    harness.get_by_label("Add sphere").click();
    // The outliner scrolls to it.
    harness.run_steps(12);
    press(&mut harness, Modifiers::COMMAND, Key::N);
    let question = harness.get_by_label_contains("Save the changes to").rect();
    assert!(question.width() < 420.0 && question.height() < 60.0, "{question}");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    // A refused path wraps.
    press(&mut harness, Modifiers::COMMAND, Key::O);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(format!("{}/{}", folder.path().display(), long('n'))));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let problem = harness.get_by_label_contains("There is no file").rect();
    assert!(problem.width() < 480.0, "{problem}");
}

#[test]
fn long_names_are_elided_in_menus_and_lists() {
    let folder = tempfile::tempdir().unwrap();
    let (mut scene, [_, ball, ..]) = scene();
    let mut material = scene.materials()[0].as_ref().clone();
    material.name = long('m');
    scene.replace_material(material).unwrap();
    let mut harness = open_in(Document::new(scene), vec2(1000.0, 1400.0));
    let mut recent = isolith::document::RecentFiles::load_from(&folder.path().join("recent.json"));
    recent.add(&folder.path().join(format!("{}.json", long('r'))));
    harness.state_mut().set_recent(recent);
    harness.state_mut().document_mut().select(vec![ball]);
    harness.run();
    let file = harness.get_all_by_label("File").next().unwrap().rect().center();
    super::click(&mut harness, file);
    harness.run_steps(40);
    let list = harness.get_all_by_label("Open recent").next().unwrap().rect().center();
    super::click(&mut harness, list);
    harness.run_steps(40);
    let entry = harness.get_by_label_contains("Begin r").rect();
    assert!(entry.width() < 420.0, "{entry}");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    harness.state_mut().document_mut().select(vec![ball]);
    harness.run();
    let before = viewport(&harness);
    let list = super::list_box(&harness, "Material").rect();
    assert!(list.right() <= 1000.0);
    super::click(&mut harness, list.center());
    harness.run_steps(40);
    let widest = harness.get_all_by_label(&long('m')).map(|node| node.rect().width()).fold(0.0, f32::max);
    assert!(widest < 360.0, "{widest}");
    assert_eq!(viewport(&harness), before);
}
