//! Selecting in the viewport: groups and what is in them, what lies below, boxes, relations; isolating and dropping.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::document::Document;
use isolith::editor::{Editor, Picture};
use isolith::scene::{Group, Node, NodeId, NodeKind, Object, Scene, ShapeKind};

use super::{press, undo_all};

const FRONT: DVec3 = DVec3::new(0.0, 0.0, 1.0);
const SIDE: DVec3 = DVec3::new(2.0, 0.0, 0.0);

/// A group of a ball in front and one at the side; another ball behind the first.
fn balls() -> (Scene, [NodeId; 4]) {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let ball = |name: &str, at: DVec3| {
        let object = Object { shape: ShapeKind::Sphere.default_shape(), material };
        Node::new(name, NodeKind::Object(object)).at(at)
    };
    let pair = scene.insert(None, 0, Node::new("Pair", NodeKind::Group(Group::UNION))).unwrap();
    let front = scene.insert(Some(pair), 0, ball("Front", FRONT)).unwrap();
    let side = scene.insert(Some(pair), 1, ball("Side", SIDE)).unwrap();
    let back = scene.insert(None, 1, ball("Back", DVec3::new(0.0, 0.0, -1.0))).unwrap();
    (scene, [pair, front, side, back])
}

/// The editor with short frames, so that two clicks can be a double click; seen from the front.
fn open(scene: Scene) -> Harness<'static, Editor> {
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(400)
        .with_context_setup(Editor::setup)
        .build_ui_state(
            |ui, editor: &mut Editor| editor.show(ui, &Picture::default()),
            Editor::new(Document::new(scene)),
        );
    press(&mut harness, Modifiers::NONE, Key::Num1);
    harness
}

fn on_screen(harness: &Harness<'_, Editor>, p: DVec3) -> Pos2 {
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(p, size.into()).unwrap();
    rect.min + vec2(pixel.x as f32, pixel.y as f32)
}

/// A position on a ball beside its middle, where handles would be.
fn on_ball(harness: &Harness<'_, Editor>, center: DVec3) -> Pos2 {
    on_screen(harness, center + DVec3::new(0.2, 0.25, 0.0))
}

fn click(harness: &mut Harness<'_, Editor>, pos: Pos2, button: PointerButton, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.event(Event::PointerMoved(pos));
    for pressed in [true, false] {
        harness.event(Event::PointerButton { pos, button, pressed, modifiers });
        harness.step();
    }
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.step();
}

/// Waits so long that the next click is not the second of a double click.
fn wait(harness: &mut Harness<'_, Editor>) {
    harness.run_steps(40);
}

fn chosen(harness: &Harness<'_, Editor>) -> Vec<NodeId> {
    harness.state().document().selection().to_vec()
}

fn visible(harness: &Harness<'_, Editor>, id: NodeId) -> bool {
    harness.state().document().scene().node(id).unwrap().visible
}

#[test]
fn a_click_selects_the_outermost_group_and_the_next_what_lies_below() {
    let (scene, [pair, front, _, back]) = balls();
    let mut harness = open(scene.clone());
    let at = on_ball(&harness, FRONT);
    let mut seen = Vec::new();
    for _ in 0..4 {
        click(&mut harness, at, PointerButton::Primary, Modifiers::NONE);
        seen.extend(chosen(&harness));
        wait(&mut harness);
    }
    assert_eq!(seen, [pair, back, front, pair]);
    let elsewhere = on_ball(&harness, SIDE);
    click(&mut harness, elsewhere, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(chosen(&harness), [pair], "another place begins again");
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(undo_all(&mut harness), 0, "looking changes nothing");
}

#[test]
fn a_double_click_enters_a_group_and_a_click_beside_leaves_it() {
    let (scene, [pair, front, side, back]) = balls();
    let mut harness = open(scene);
    let (on_front, on_side) = (on_ball(&harness, FRONT), on_ball(&harness, SIDE));
    for _ in 0..2 {
        click(&mut harness, on_front, PointerButton::Primary, Modifiers::NONE);
    }
    assert_eq!(chosen(&harness), [front]);
    wait(&mut harness);
    click(&mut harness, on_side, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(chosen(&harness), [side], "a click within the group selects its children");
    wait(&mut harness);
    click(&mut harness, on_front, PointerButton::Primary, Modifiers::SHIFT);
    assert_eq!(chosen(&harness), [side, front], "Shift adds");
    wait(&mut harness);
    // The ball behind is outside of it.
    press(&mut harness, Modifiers::NONE, Key::Num3);
    let on_back = on_ball(&harness, DVec3::new(0.0, 0.0, -1.0));
    click(&mut harness, on_back, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(chosen(&harness), [back]);
    wait(&mut harness);
    let on_front = on_ball(&harness, FRONT);
    click(&mut harness, on_front, PointerButton::Primary, Modifiers::NONE);
    assert_eq!(chosen(&harness), [pair], "the group is whole again");
}

#[test]
fn alt_lists_what_lies_below() {
    let (scene, [.., back]) = balls();
    let mut harness = open(scene);
    let at = on_ball(&harness, FRONT);
    click(&mut harness, at, PointerButton::Primary, Modifiers::ALT);
    harness.run();
    for name in ["Front", "Pair", "Back"] {
        harness.get_by_label(&format!("Below the pointer: {name}"));
    }
    assert!(harness.query_by_label("Below the pointer: Side").is_none());
    harness.get_by_label("Below the pointer: Back").click();
    harness.run();
    assert_eq!(chosen(&harness), [back]);
    assert!(!harness.state().has_dialog());
    wait(&mut harness);
    click(&mut harness, at, PointerButton::Primary, Modifiers::ALT);
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().has_dialog());
    assert_eq!(chosen(&harness), [back], "Escape closes the list and does nothing else");
}

fn drag(harness: &mut Harness<'_, Editor>, area: Rect, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    let (from, to) = (area.min, area.max);
    harness.event(Event::PointerMoved(from));
    let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
    harness.event(button(from, true));
    for step in 1..=8 {
        harness.event(Event::PointerMoved(from + (to - from) * (step as f32 / 8.0)));
        harness.step();
    }
    harness.event(button(to, false));
    harness.step();
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    harness.run();
}

#[test]
fn a_box_selects_what_has_its_middle_in_it() {
    let (scene, [pair, _, side, back]) = balls();
    let mut harness = open(scene.clone());
    let around =
        |harness: &Harness<'_, Editor>, p: DVec3| Rect::from_center_size(on_screen(harness, p), vec2(90.0, 90.0));
    let camera = harness.state().view().camera;
    let area = around(&harness, DVec3::new(0.0, 0.0, -1.0));
    drag(&mut harness, area, Modifiers::COMMAND);
    assert_eq!(chosen(&harness), [back], "the middle of the pair is farther to the side");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, Modifiers::NONE, Key::B);
    let rect = harness.get_by_label("Viewport").rect();
    drag(&mut harness, rect.shrink(60.0), Modifiers::NONE);
    assert_eq!(chosen(&harness), [pair, back]);
    assert_eq!(harness.state().view().camera, camera, "the view stays");
    // In an entered group its children are selected.
    let on_side = on_ball(&harness, SIDE);
    for _ in 0..2 {
        click(&mut harness, on_side, PointerButton::Primary, Modifiers::NONE);
    }
    press(&mut harness, Modifiers::NONE, Key::B);
    let area = around(&harness, SIDE);
    drag(&mut harness, area, Modifiers::NONE);
    assert_eq!(chosen(&harness), [side]);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn parents_children_and_what_is_alike() {
    let (mut scene, [pair, front, side, back]) = balls();
    let material = scene.materials()[0].id;
    let object = Object { shape: ShapeKind::Box.default_shape(), material };
    scene.insert(None, 2, Node::new("Cube", NodeKind::Object(object)).at(DVec3::Y * 5.0)).unwrap();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![side]);
    press(&mut harness, Modifiers::NONE, Key::OpenBracket);
    assert_eq!(chosen(&harness), [pair]);
    press(&mut harness, Modifiers::NONE, Key::OpenBracket);
    assert_eq!(chosen(&harness), [pair], "there is none above");
    press(&mut harness, Modifiers::NONE, Key::CloseBracket);
    assert_eq!(chosen(&harness), [front, side]);
    press(&mut harness, Modifiers::SHIFT, Key::G);
    let mut alike = chosen(&harness);
    alike.sort();
    assert_eq!(alike, [front, side, back], "all balls, not the cube");
}

#[test]
fn a_slash_shows_the_selection_alone_and_everything_again() {
    let (scene, [pair, front, side, back]) = balls();
    let mut harness = open(scene.clone());
    harness.state_mut().document_mut().select(vec![side]);
    press(&mut harness, Modifiers::NONE, Key::Slash);
    assert!(visible(&harness, pair) && visible(&harness, side));
    assert!(!visible(&harness, front) && !visible(&harness, back));
    press(&mut harness, Modifiers::NONE, Key::Slash);
    assert_eq!(*harness.state().document().scene(), scene);
    press(&mut harness, Modifiers::NONE, Key::Slash);
    assert!(!visible(&harness, back));
    assert_eq!(undo_all(&mut harness), 3, "one step each");
    assert_eq!(*harness.state().document().scene(), scene);
    press(&mut harness, Modifiers::NONE, Key::Slash);
    assert!(!visible(&harness, back), "after undo it begins again");
}

#[test]
fn the_context_menu_of_the_viewport_is_about_what_is_under_the_pointer() {
    let (scene, [pair, ..]) = balls();
    let mut harness = open(scene);
    let at = on_ball(&harness, FRONT);
    click(&mut harness, at, PointerButton::Secondary, Modifiers::NONE);
    harness.run();
    assert_eq!(chosen(&harness), [pair]);
    harness.get_by_label("Isolate");
    // The toolbar has a button of the same name.
    let entries = harness.get_all_by_label("Delete").map(|node| node.rect().center());
    let entry = entries.max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    click(&mut harness, entry, PointerButton::Primary, Modifiers::NONE);
    harness.run();
    assert_eq!(harness.state().document().scene().nodes().len(), 1);
    // What is added from the menu goes where it was opened.
    wait(&mut harness);
    let top = on_screen(&harness, DVec3::new(0.0, 0.3, -1.0));
    click(&mut harness, top, PointerButton::Secondary, Modifiers::NONE);
    harness.run();
    harness.get_by_label("Add at the pointer…").click();
    harness.run();
    harness.event(Event::Text("box".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let cube = harness.state().document().scene().node(chosen(&harness)[0]).unwrap().clone();
    assert!(cube.transform.translation.z > -0.6, "in front of the ball: {}", cube.transform.translation);
}

#[test]
fn what_is_dropped_stands_on_what_is_below_it_or_on_the_ground() {
    let (mut scene, _) = balls();
    let material = scene.materials()[0].id;
    let object = |kind: ShapeKind| NodeKind::Object(Object { shape: kind.default_shape(), material });
    let at = DVec3::new(2.0, 3.0, 0.0);
    let high = scene.insert(None, 2, Node::new("High", object(ShapeKind::Sphere)).at(at)).unwrap();
    let at = DVec3::new(8.0, 3.0, 0.0);
    let alone = scene.insert(None, 3, Node::new("Alone", object(ShapeKind::Box)).at(at)).unwrap();
    let mut harness = open(scene.clone());
    let height = |harness: &Harness<'_, Editor>, id| {
        harness.state().document().scene().node(id).unwrap().transform.translation.y
    };
    harness.state_mut().document_mut().select(vec![high]);
    press(&mut harness, Modifiers::NONE, Key::End);
    assert!((height(&harness, high) - 1.0).abs() < 1e-3, "on the ball: {}", height(&harness, high));
    harness.state_mut().document_mut().select(vec![alone]);
    press(&mut harness, Modifiers::NONE, Key::End);
    assert!((height(&harness, alone) - 0.5).abs() < 1e-6, "on the ground: {}", height(&harness, alone));
    assert_eq!(undo_all(&mut harness), 2);
    assert_eq!(*harness.state().document().scene(), scene);
}
