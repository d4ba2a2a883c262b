//! Drives the editor as an artist would: by pointer and keyboard, without a GPU.

mod adding;
mod arranging;
mod attachments;
mod choosing;
mod clipboard;
mod commands;
mod controls;
mod doctor;
mod dropping;
mod fields;
mod first_run;
mod handles;
mod inspecting;
mod instancers;
mod jobs;
mod locks;
mod materials;
mod mixed;
mod modifiers;
mod monkey;
mod names;
mod order;
mod outliner;
mod panels;
mod pawn;
mod picture;
mod popups;
mod preferences;
mod rendering;
mod saving;
mod scale;
mod sharing;
mod splitting;
mod timeline;
mod transforms;
mod views;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, accesskit::Role, vec2};
use egui_kittest::{Harness, kittest::NodeT, kittest::Queryable};
use isolith::document::Document;
use isolith::editor::{Editor, Picture};
use isolith::scene::{Group, Node, NodeId, NodeKind, Object, Scene, Shape, ShapeKind};

use crate::settle::Settle;

/// A group of a ball and a box, and a torus beside it.
fn scene() -> (Scene, [NodeId; 4]) {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let object = |kind: ShapeKind, name: &str| {
        Node::new(name, NodeKind::Object(Object { shape: kind.default_shape(), material }))
    };
    let group = scene.insert(None, 0, Node::new("Body", NodeKind::Group(Group::UNION))).unwrap();
    let ball = scene.insert(Some(group), 0, object(ShapeKind::Sphere, "Ball")).unwrap();
    let cube = scene.insert(Some(group), 1, object(ShapeKind::Box, "Cube")).unwrap();
    let ring = scene.insert(None, 1, object(ShapeKind::Torus, "Ring")).unwrap();
    (scene, [group, ball, cube, ring])
}

fn open(scene: Scene) -> Harness<'static, Editor> {
    open_sized(scene, 864.0)
}

/// Opens the editor in a window so tall that the inspector does not scroll.
fn open_tall(scene: Scene) -> Harness<'static, Editor> {
    open_sized(scene, 2400.0)
}

fn open_sized(scene: Scene, height: f32) -> Harness<'static, Editor> {
    open_in(Document::new(scene), vec2(1280.0, height))
}

fn open_in(document: Document, size: egui::Vec2) -> Harness<'static, Editor> {
    let mut editor = Editor::new(document);
    editor.ask_for_paths_in_window();
    let mut harness = Harness::builder()
        .with_size(size)
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &no_picture()), editor);
    harness.settle();
    harness
}

/// No picture yet, but a text for the status bar.
fn no_picture() -> Picture {
    Picture { progress: Some(0.4), status: "adapter, 12 ms".into(), ..Picture::default() }
}

/// The position of a row's name in the tree, on the left.
fn row(harness: &Harness<'_, Editor>, name: &str) -> Pos2 {
    let rows = harness.get_all_by_label(name).filter(|n| n.rect().center().x < 200.0);
    rows.map(|n| n.rect().center()).next().unwrap_or_else(|| panic!("no row {name}"))
}

/// The field of this name, not its label.
fn field<'h>(harness: &'h Harness<'_, Editor>, name: &'h str) -> egui_kittest::Node<'h> {
    let found = harness.get_all_by_label(name).find(|n| n.accesskit_node().role() != Role::Label);
    found.unwrap_or_else(|| panic!("no field {name}"))
}

/// The drop-down list of this name.
fn list_box<'h>(harness: &'h Harness<'_, Editor>, name: &'h str) -> egui_kittest::Node<'h> {
    let found = harness.get_all_by_label(name).find(|n| n.accesskit_node().role() == Role::ComboBox);
    found.unwrap_or_else(|| panic!("no list {name}"))
}

fn pointer(harness: &mut Harness<'_, Editor>, pos: Pos2, pressed: bool) {
    harness.event(Event::PointerMoved(pos));
    harness.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE });
}

fn click(harness: &mut Harness<'_, Editor>, pos: Pos2) {
    pointer(harness, pos, true);
    pointer(harness, pos, false);
    harness.settle();
}

fn select(harness: &mut Harness<'_, Editor>, name: &str) {
    let pos = row(harness, name);
    click(harness, pos);
    // Long enough that the next click is not a double click.
    harness.run_steps(40);
}

fn press(harness: &mut Harness<'_, Editor>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.settle();
}

/// Undoes every step and returns their number.
fn undo_all(harness: &mut Harness<'_, Editor>) -> usize {
    std::iter::from_fn(|| harness.state_mut().document_mut().undo().then_some(())).count()
}

fn shape(harness: &Harness<'_, Editor>, id: NodeId) -> Shape {
    match &harness.state().document().scene().node(id).unwrap().kind {
        NodeKind::Object(object) => object.shape.clone(),
        _ => panic!("not an object"),
    }
}

#[test]
fn a_drag_over_fifty_frames_is_one_step_and_undo_restores_the_scene() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ball");
    assert_eq!(harness.state().document().selection(), [ball]);
    let radius = field(&harness, "Radius").rect().center();
    pointer(&mut harness, radius, true);
    let mut revisions = std::collections::HashSet::new();
    for frame in 1..=50 {
        harness.event(Event::PointerMoved(radius + vec2(frame as f32 * 2.0, 0.0)));
        harness.step();
        revisions.insert(harness.state().document().revision());
        assert!(harness.state().view().navigating || frame < 5);
    }
    pointer(&mut harness, radius + vec2(100.0, 0.0), false);
    harness.run();
    let Shape::Sphere { radius } = shape(&harness, ball) else { panic!() };
    assert!(radius > 0.6, "{radius}");
    assert!(revisions.len() > 20, "the value follows the pointer");
    assert!(!harness.state().view().navigating);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(harness.state().document().selection(), [ball]);
    assert_eq!(undo_all(&mut harness), 0, "one step and no more");
}

#[test]
fn the_flat_scene_follows_a_drag_in_the_same_frame() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    let radius = field(&harness, "Radius").rect().center();
    pointer(&mut harness, radius, true);
    harness.step();
    for frame in 1..=10 {
        let before = harness.state().document().revision();
        let flat = harness.state().flat().clone();
        harness.event(Event::PointerMoved(radius + vec2(frame as f32 * 10.0, 0.0)));
        harness.step();
        let moved = harness.state().document().revision() != before;
        assert_eq!(moved, **harness.state().flat() != *flat, "frame {frame}");
    }
    pointer(&mut harness, radius, false);
    harness.run();
}

#[test]
fn typing_a_value_takes_an_expression_and_is_one_step() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ball");
    let radius = field(&harness, "Radius").rect().center();
    click(&mut harness, radius);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("3*2".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 6.0 }, "beyond the soft range, by typing");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn backspace_over_a_field_resets_it() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    field(&harness, "Radius").set_value_accesskit(2.0);
    harness.run();
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 2.0 });
    let radius = field(&harness, "Radius").rect().center();
    harness.event(Event::PointerMoved(radius));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Backspace);
    assert_eq!(shape(&harness, ball), ShapeKind::Sphere.default_shape());
}

#[test]
fn a_color_is_picked_by_dragging_and_by_typing() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ball");
    let swatch = field(&harness, "Base color").rect().center();
    click(&mut harness, swatch);
    let square = harness.get_by_label("Saturation and brightness").rect();
    pointer(&mut harness, square.center(), true);
    harness.step();
    for step in 1..=10 {
        harness.event(Event::PointerMoved(square.center() + vec2(step as f32 * 6.0, 0.0)));
        harness.step();
    }
    pointer(&mut harness, square.center() + vec2(60.0, 0.0), false);
    harness.run();
    let albedo = |h: &Harness<'_, Editor>| h.state().document().scene().materials()[0].base_color;
    assert_ne!(albedo(&harness), scene.materials()[0].base_color);
    let hex = field(&harness, "Hex").rect().center();
    click(&mut harness, hex);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("#00ff00".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(albedo(&harness), [0.0, 1.0, 0.0]);
    assert_eq!(undo_all(&mut harness), 2);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn shortcuts_do_not_fire_in_text_fields() {
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ring");
    let name = field(&harness, "Name").rect().center();
    click(&mut harness, name);
    for key in [Key::X, Key::H, Key::Delete, Key::N] {
        press(&mut harness, Modifiers::NONE, key);
    }
    assert_eq!(harness.state().document().scene().nodes().len(), 4);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn delete_and_undo() {
    let (scene, [group, ..]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Body");
    press(&mut harness, Modifiers::NONE, Key::X);
    assert_eq!(harness.state().document().scene().nodes().len(), 1);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(harness.state().document().selection(), [group]);
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(harness.state().document().scene().nodes().len(), 1);
}

#[test]
fn changing_the_shape_keeps_the_node() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene.clone());
    select(&mut harness, "Ball");
    let combo = field(&harness, "Primitive").rect().center();
    click(&mut harness, combo);
    let entries: Vec<_> = harness.get_all_by_label("Box").map(|n| n.rect().center()).collect();
    click(&mut harness, entries[0]);
    assert_eq!(shape(&harness, ball), Shape::Box { size: [1.0; 3], rounding: 0.0 });
    field(&harness, "Size X");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn adding_grouping_and_duplicating() {
    let mut harness = open(Scene::new());
    harness.get_by_label("Add sphere").click();
    harness.run();
    harness.get_by_label("Add box").click();
    harness.run();
    let document = harness.state().document();
    let names: Vec<_> = document.scene().nodes().iter().map(|n| n.name.as_str()).collect();
    assert_eq!(names, ["Sphere", "Box"]);
    let ids: Vec<_> = document.scene().nodes().iter().map(|n| n.id).collect();
    harness.state_mut().document_mut().select(ids.clone());
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::D);
    let scene = harness.state().document().scene().clone();
    let group = &scene.nodes()[0];
    assert!(matches!(group.kind, NodeKind::Group(g) if g.operator == isolith::scene::Operator::Difference));
    assert_eq!(scene.children(Some(group.id)).map(|n| n.id).collect::<Vec<_>>(), ids);
    press(&mut harness, Modifiers::SHIFT, Key::D);
    assert_eq!(harness.state().document().scene().nodes().len(), 6);
    assert_eq!(harness.state().document().selection().len(), 1, "the copy is selected");
    assert_eq!(undo_all(&mut harness), 4);
}

#[test]
fn hiding_by_the_eye_and_by_the_key() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    harness.get_by_label("Hide Ball").click();
    harness.run();
    let visible = |h: &Harness<'_, Editor>| h.state().document().scene().node(ball).unwrap().visible;
    assert!(!visible(&harness));
    press(&mut harness, Modifiers::ALT, Key::H);
    assert!(visible(&harness));
    select(&mut harness, "Ball");
    press(&mut harness, Modifiers::NONE, Key::H);
    assert!(!visible(&harness));
    assert_eq!(undo_all(&mut harness), 3);
}

#[test]
fn work_is_not_lost_without_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.json");
    let (scene, _) = scene();
    let mut harness = open(scene);
    press(&mut harness, Modifiers::COMMAND, Key::N);
    assert!(harness.query_by_label("Discard").is_none(), "nothing to lose");
    harness.get_by_label("Add sphere").click();
    harness.run();
    press(&mut harness, Modifiers::COMMAND, Key::Q);
    harness.get_by_label("Cancel").click();
    harness.run();
    assert!(!harness.state().wants_close());
    press(&mut harness, Modifiers::COMMAND, Key::Q);
    harness.get_by_label("Save").click();
    harness.run();
    // The document has no file yet, so the editor asks for a path; then the window may close.
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(path.display().to_string()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(harness.state().wants_close());
    assert!(path.is_file());
    assert_eq!(harness.state().title(), "scene.json – Isolith");
}

#[test]
fn a_broken_file_is_a_message_and_the_scene_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.json");
    std::fs::write(&path, "{").unwrap();
    let (scene, _) = scene();
    let mut harness = open(scene.clone());
    press(&mut harness, Modifiers::COMMAND, Key::O);
    harness.event(Event::Text(path.display().to_string()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let message = harness.state().messages().last().unwrap();
    assert!(message.text.contains("broken.json"), "{}", message.text);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_palette_runs_what_is_typed() {
    let (scene, _) = scene();
    let mut harness = open(scene);
    press(&mut harness, Modifiers::NONE, Key::F3);
    harness.event(Event::Text("octa".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let nodes = harness.state().document().scene().nodes();
    assert_eq!(nodes.last().unwrap().name, "Octahedron");
    assert!(!harness.state().has_dialog());
}

#[test]
fn several_nodes_are_edited_together() {
    let (scene, [_, ball, cube, _]) = scene();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![ball, cube]);
    harness.run();
    field(&harness, "Position Y").set_value_accesskit(1.5);
    harness.run();
    let y = |h: &Harness<'_, Editor>, id| h.state().document().scene().node(id).unwrap().transform.translation.y;
    assert_eq!((y(&harness, ball), y(&harness, cube)), (1.5, 1.5));
    assert_eq!(undo_all(&mut harness), 1);
}
