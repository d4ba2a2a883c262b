//! Many events in one frame, as on a slow machine: each has the same effect as alone.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use isolith::editor::Editor;
use isolith::scene::{NodeId, Shape, ShapeKind};

use super::{field, open_tall, row, scene, select, shape, undo_all};

/// Sends all events in one frame.
fn at_once(harness: &mut Harness<'_, Editor>, events: Vec<Event>) {
    harness.input_mut().events.extend(events);
    // One pass per event, and a few to settle.
    harness.run_steps(60);
}

fn button(pos: Pos2, pressed: bool) -> [Event; 2] {
    let button = PointerButton::Primary;
    [Event::PointerMoved(pos), Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE }]
}

fn click(pos: Pos2) -> Vec<Event> {
    [button(pos, true), button(pos, false)].concat()
}

fn key(key: Key) -> Vec<Event> {
    let event = |pressed| Event::Key { key, pressed, repeat: false, modifiers: Modifiers::NONE, physical_key: None };
    vec![event(true), event(false)]
}

fn text(text: &str) -> Vec<Event> {
    vec![Event::Text(text.into())]
}

fn position(harness: &Harness<'_, Editor>, id: NodeId) -> [f64; 3] {
    harness.state().document().scene().node(id).unwrap().transform.translation.to_array()
}

#[test]
fn typed_digits_never_land_in_the_next_field() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    let x = field(&harness, "Position X").rect().center();
    let tab = || key(Key::Tab);
    let events = [click(x), text("1"), tab(), text("2"), tab(), text("34"), key(Key::Enter), text("9")].concat();
    at_once(&mut harness, events);
    assert_eq!(position(&harness, ball), [1.0, 2.0, 34.0]);
    assert_eq!(undo_all(&mut harness), 3);
}

#[test]
fn typed_digits_go_backward_with_shift_tab_too() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    let z = field(&harness, "Position Z").rect().center();
    let back = |pressed| {
        let modifiers = Modifiers::SHIFT;
        Event::Key { key: Key::Tab, pressed, repeat: false, modifiers, physical_key: None }
    };
    let shift = |on| Event::ModifiersChanged(if on { Modifiers::SHIFT } else { Modifiers::NONE });
    let tab = vec![shift(true), back(true), back(false), shift(false)];
    at_once(&mut harness, [click(z), text("3"), tab, text("2"), key(Key::Enter)].concat());
    assert_eq!(position(&harness, ball), [0.0, 2.0, 3.0]);
}

#[test]
fn typed_digits_never_land_in_another_node() {
    let (scene, [_, ball, _, ring]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    let (x, other) = (field(&harness, "Position X").rect().center(), row(&harness, "Ring"));
    at_once(&mut harness, [click(x), text("5"), click(other)].concat());
    assert_eq!(harness.state().document().selection(), [ring]);
    assert_eq!((position(&harness, ball), position(&harness, ring)), ([5.0, 0.0, 0.0], [0.0; 3]));
}

#[test]
fn a_row_that_appears_above_a_field_does_not_take_its_keyboard() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    let radius = field(&harness, "Radius").rect().center();
    at_once(&mut harness, click(radius));
    // A row for the blend radius appears two cards higher.
    let mut node = harness.state().document().scene().node(ball).unwrap().as_ref().clone();
    node.blend_override = isolith::scene::BlendOverride::Radius(0.2);
    harness.state_mut().document_mut().apply(isolith::document::Edit::Replace(node)).unwrap();
    harness.run();
    at_once(&mut harness, [text("2"), key(Key::Enter)].concat());
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 2.0 });
    let blend_override = harness.state().document().scene().node(ball).unwrap().blend_override;
    assert_eq!(blend_override, isolith::scene::BlendOverride::Radius(0.2));
}

#[test]
fn a_shortcut_and_what_is_typed_into_what_it_opens() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    at_once(&mut harness, [key(Key::F2), text("Xenon"), key(Key::Enter)].concat());
    assert_eq!(harness.state().document().scene().node(ball).unwrap().name, "Xenon");
    at_once(&mut harness, [key(Key::F3), text("octa"), key(Key::Enter)].concat());
    let nodes = harness.state().document().scene().nodes();
    assert!(nodes.iter().any(|node| node.name == ShapeKind::Octahedron.label()));
    assert!(!harness.state().has_dialog());
}

#[test]
fn clicks_and_drags_in_one_frame_happen_where_they_were() {
    let (scene, [group, ball, cube, ring]) = scene();
    let mut harness = open_tall(scene);
    let rows = ["Ball", "Cube", "Ring"].map(|name| row(&harness, name));
    at_once(&mut harness, rows.iter().rev().flat_map(|pos| click(*pos)).collect());
    assert_eq!(harness.state().document().selection(), [ball]);
    let radius = field(&harness, "Radius").rect().center();
    let far = radius + vec2(100.0, 0.0);
    let drag = [&button(radius, true)[..], &[Event::PointerMoved(radius + vec2(30.0, 0.0))], &button(far, false)];
    at_once(&mut harness, drag.concat());
    let Shape::Sphere { radius } = shape(&harness, ball) else { panic!() };
    assert!(radius > 0.6, "{radius}");
    let events = [button(rows[2], true), button(rows[0], false)].concat();
    at_once(&mut harness, events);
    let scene = harness.state().document().scene();
    assert_eq!(scene.node(ring).unwrap().parent, Some(group), "the row is dragged into the group");
    assert_eq!(scene.node(cube).unwrap().parent, Some(group));
}
