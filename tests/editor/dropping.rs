//! Dragging something new into the picture, values used last, files dropped on the window, relinking a model, ghosts.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::scene::{MeshNode, Node, NodeKind, Operation, Scene, Shape, ShapeKind};

use super::{click, open, open_in, press, row, scene, undo_all};
use crate::settle::Settle;

fn on_screen(harness: &Harness<'_, Editor>, p: DVec3) -> Pos2 {
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(p, size.into()).unwrap();
    rect.min + vec2(pixel.x as f32, pixel.y as f32)
}

fn drag(harness: &mut Harness<'_, Editor>, from: Pos2, to: Pos2) {
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(from));
    harness.event(button(from, true));
    for step in 1..=5 {
        harness.event(Event::PointerMoved(from + (to - from) * (step as f32 / 5.0)));
        harness.step();
    }
    harness.event(button(to, false));
    harness.run();
}

fn shapes(harness: &Harness<'_, Editor>) -> Vec<(Shape, DVec3)> {
    let nodes = harness.state().document().scene().nodes();
    let shape = |node: &std::sync::Arc<Node>| match &node.kind {
        NodeKind::Object(object) => Some((object.shape.clone(), node.transform.translation)),
        _ => None,
    };
    nodes.iter().filter_map(shape).collect()
}

#[test]
fn a_shape_is_dragged_from_the_toolbar_to_its_place() {
    let mut harness = open(Scene::new());
    let wanted = DVec3::new(1.0, 0.0, 0.5);
    let (from, to) = (harness.get_by_label("Add box").rect().center(), on_screen(&harness, wanted));
    drag(&mut harness, from, to);
    let [(Shape::Box { .. }, place)] = shapes(&harness)[..] else { panic!("one box: {:?}", shapes(&harness)) };
    assert!((place - wanted - DVec3::Y * 0.5).length() < 0.05, "it stands where it was dropped: {place}");
    assert_eq!(undo_all(&mut harness), 1);
    // Dropped beside the picture, or canceled, it is not added.
    drag(&mut harness, from, from + vec2(60.0, 0.0));
    assert!(shapes(&harness).is_empty());
}

#[test]
fn a_shape_is_dragged_from_the_palette() {
    let mut harness = open(Scene::new());
    let middle = on_screen(&harness, DVec3::ZERO);
    harness.event(Event::PointerMoved(middle));
    harness.run();
    press(&mut harness, Modifiers::SHIFT, Key::A);
    let from = harness.get_by_label("New Sphere").rect().center();
    drag(&mut harness, from, middle);
    assert!(matches!(shapes(&harness)[..], [(Shape::Sphere { .. }, _)]), "{:?}", shapes(&harness));
    assert!(!harness.state().has_dialog(), "the palette is closed");
}

#[test]
fn a_new_shape_begins_with_the_values_used_last() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    let mut node = Node::clone(harness.state().document().scene().node(ball).unwrap());
    if let NodeKind::Object(object) = &mut node.kind {
        object.shape = Shape::Sphere { radius: 0.35 };
    }
    let document = harness.state_mut().document_mut();
    document.select(vec![ball]);
    document.apply(isolith::document::Edit::Replace(node)).unwrap();
    harness.run();
    harness.get_by_label("Add sphere").click();
    harness.run();
    let added = harness.state().document().selection()[0];
    assert_eq!(super::shape(&harness, added), Shape::Sphere { radius: 0.35 });
    harness.get_by_label("Add box").click();
    harness.run();
    let added = harness.state().document().selection()[0];
    assert_eq!(super::shape(&harness, added), ShapeKind::Box.default_shape());
}

#[test]
fn a_missing_model_is_relinked_in_all_nodes_that_use_it() {
    let folder = tempfile::tempdir().unwrap();
    let suzanne = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/models/suzanne.glb");
    std::fs::copy(suzanne, folder.path().join("found.glb")).unwrap();
    let mut scene = Scene::new();
    for name in ["One", "Two"] {
        let mesh = Node::new(name, NodeKind::Mesh(MeshNode::new("lost.glb")));
        scene.insert(None, usize::MAX, mesh).unwrap();
    }
    let mut document = Document::new(scene);
    document.save_as(&folder.path().join("scene.isolith")).unwrap();
    let mut harness = open_in(document, vec2(1280.0, 1400.0));
    let one = row(&harness, "One");
    click(&mut harness, one);
    harness.get_by_label("Choose a file…").click();
    harness.run();
    harness.event(Event::Text("found.glb".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.settle();
    let paths: Vec<_> = harness
        .state()
        .document()
        .scene()
        .nodes()
        .iter()
        .map(|node| match &node.kind {
            NodeKind::Mesh(mesh) => mesh.path.clone(),
            _ => panic!("a mesh"),
        })
        .collect();
    assert_eq!(paths, ["found.glb", "found.glb"]);
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn what_is_cut_away_shows_as_a_ghost_while_it_is_selected() {
    let (mut scene, [group, ball, ..]) = scene();
    let mut cutter = Node::clone(scene.node(ball).unwrap());
    cutter.operation = Operation::Subtract;
    scene.replace(cutter).unwrap();
    let mut harness = open(scene);
    let lines = |harness: &mut Harness<'_, Editor>, selected: Vec<isolith::scene::NodeId>| {
        harness.state_mut().document_mut().select(selected);
        harness.run();
        let count = |shape: &egui::Shape| usize::from(matches!(shape, egui::Shape::LineSegment { .. }));
        harness.output().shapes.iter().map(|clipped| count(&clipped.shape)).sum::<usize>()
    };
    let without = lines(&mut harness, Vec::new());
    let with = lines(&mut harness, vec![ball]);
    assert!(with > without + 500, "{with} lines, {without} without");
    assert!(lines(&mut harness, vec![group]) > without + 500, "the group shows what is cut from it");
}
