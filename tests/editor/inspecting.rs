//! Number fields by the wheel and by their menu; coordinates of the world; modifiers found by typing and collapsed.

use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::editor::Editor;
use isolith::scene::{ModifierKind, Node, NodeId, Shape};

use super::{field, open_tall, press, scene, shape, undo_all};

fn with(id: impl Fn([NodeId; 4]) -> NodeId) -> (Harness<'static, Editor>, NodeId) {
    let (mut scene, ids) = scene();
    let group = Node::clone(scene.node(ids[0]).unwrap()).at(DVec3::new(4.0, 0.0, -1.0)).scaled(DVec3::splat(2.0));
    scene.replace(group).unwrap();
    let mut harness = open_tall(scene);
    harness.state_mut().document_mut().select(vec![id(ids)]);
    harness.run();
    (harness, id(ids))
}

fn radius(harness: &Harness<'_, Editor>, id: NodeId) -> f64 {
    match shape(harness, id) {
        Shape::Sphere { radius } => radius,
        other => panic!("{other:?}"),
    }
}

fn right_click(harness: &mut Harness<'_, Editor>, name: &str) {
    let pos = field(harness, name).rect().center();
    harness.event(Event::PointerMoved(pos));
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
        harness.step();
    }
    harness.run();
}

fn choose(harness: &mut Harness<'_, Editor>, entry: &str) {
    harness.get_by_label_contains(entry).click();
    harness.run();
}

#[test]
fn the_wheel_with_ctrl_changes_a_number_and_alone_it_does_not() {
    let (mut harness, ball) = with(|[_, ball, ..]| ball);
    let before = radius(&harness, ball);
    let pos = field(&harness, "Radius").rect().center();
    harness.event(Event::PointerMoved(pos));
    harness.run();
    let turn = |harness: &mut Harness<'_, Editor>, y: f32, modifiers: Modifiers| {
        harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, y),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers,
        });
        harness.run_steps(10);
    };
    turn(&mut harness, 1.0, Modifiers::NONE);
    assert_eq!(radius(&harness, ball), before);
    turn(&mut harness, 1.0, Modifiers::COMMAND);
    let up = radius(&harness, ball);
    assert!(up > before, "{up}");
    turn(&mut harness, -1.0, Modifiers::COMMAND);
    assert!((radius(&harness, ball) - before).abs() < 1e-12);
    assert_eq!(undo_all(&mut harness), 2);
}

#[test]
fn a_value_is_copied_to_another_field_and_reset() {
    let (mut harness, ball) = with(|[_, ball, ..]| ball);
    right_click(&mut harness, "Scale X");
    choose(&mut harness, "Copy value");
    right_click(&mut harness, "Radius");
    choose(&mut harness, "Paste value 1");
    assert_eq!(radius(&harness, ball), 1.0);
    right_click(&mut harness, "Radius");
    choose(&mut harness, "Reset to");
    assert_eq!(radius(&harness, ball), 0.5);
    assert_eq!(undo_all(&mut harness), 2);
}

#[test]
fn a_node_in_a_group_is_placed_in_the_world() {
    let (mut harness, ball) = with(|[_, ball, ..]| ball);
    field(&harness, "Coordinates").click();
    harness.run();
    harness.get_by_label("World").click();
    harness.run();
    let pos = field(&harness, "World position X").rect().center();
    super::click(&mut harness, pos);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("6".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let scene = harness.state().document().scene();
    assert_eq!(scene.world_from_local(ball).translation, DVec3::new(6.0, 0.0, -1.0));
    assert_eq!(scene.node(ball).unwrap().transform.translation.x, 1.0);
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn a_modifier_is_added_by_typing_its_name_and_collapsed() {
    let (mut harness, ring) = with(|[.., ring]| ring);
    harness.get_by_label_contains("Add modifier").click();
    harness.run();
    harness.event(Event::Text("twi".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let node = harness.state().document().scene().node(ring).unwrap().clone();
    let kinds: Vec<_> = node.modifiers.iter().map(|slot| slot.modifier.kind()).collect();
    assert_eq!(kinds, [ModifierKind::Twist]);
    let name = ModifierKind::Twist.params()[0].label.to_string();
    let rows = |harness: &Harness<'_, Editor>| harness.query_all_by_label(&name).count();
    let before = rows(&harness);
    assert!(before > 0);
    harness.get_by_label("Collapse twist").click();
    harness.run();
    assert!(rows(&harness) < before);
    harness.get_by_label("Open twist").click();
    harness.run();
    assert_eq!(rows(&harness), before);
    assert_eq!(undo_all(&mut harness), 1);
}
