//! Locked nodes stay where they are; a deletion clears the selection.

use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::editor::Editor;
use isolith::scene::{NodeId, Scene};

use super::{open, open_tall, pointer, press, row, scene, select};

fn lock(scene: &mut Scene, id: NodeId) {
    let mut node = scene.node(id).unwrap().as_ref().clone();
    node.locked = true;
    scene.replace(node).unwrap();
}

fn choose(harness: &mut Harness<'_, Editor>, ids: &[NodeId]) {
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run();
}

fn told(harness: &Harness<'_, Editor>) -> String {
    harness.state().messages().last().map_or(String::new(), |message| message.text.clone())
}

#[test]
fn locked_nodes_cannot_be_deleted() {
    let (mut scene, [group, ball, cube, ring]) = scene();
    lock(&mut scene, ball);
    // The node itself, with either key, and its parent, whose deletion would include it.
    for (id, key) in [(ball, Key::X), (ball, Key::Delete), (group, Key::X)] {
        let mut harness = open(scene.clone());
        choose(&mut harness, &[id]);
        press(&mut harness, Modifiers::NONE, key);
        assert_eq!(*harness.state().document().scene(), scene);
        assert_eq!(told(&harness), "“Ball” is locked and cannot be deleted. Unlock it first.");
        assert_eq!(harness.state().document().selection(), [id], "what is not deleted stays selected");
    }
    // Children of a locked group.
    let (mut below, _) = super::scene();
    lock(&mut below, group);
    let mut harness = open(below.clone());
    choose(&mut harness, &[cube]);
    press(&mut harness, Modifiers::NONE, Key::X);
    assert_eq!(*harness.state().document().scene(), below);
    assert!(told(&harness).starts_with("“Body” is locked"));
    // The other nodes are deleted.
    let mut harness = open(scene);
    choose(&mut harness, &[ball, cube, ring]);
    press(&mut harness, Modifiers::NONE, Key::X);
    let left: Vec<_> = harness.state().document().scene().nodes().iter().map(|node| node.id).collect();
    assert_eq!(left, [group, ball]);
    assert!(told(&harness).starts_with("“Ball” is locked"));
}

#[test]
fn after_a_deletion_nothing_is_selected() {
    let (scene, [group, ball, cube, ring]) = scene();
    for ids in [vec![ball], vec![ring], vec![group], vec![ball, cube], vec![group, ring]] {
        let mut harness = open(scene.clone());
        choose(&mut harness, &ids);
        press(&mut harness, Modifiers::NONE, Key::Delete);
        assert!(harness.state().document().scene().nodes().len() < 4);
        assert!(harness.state().document().selection().is_empty(), "{ids:?}");
        // A second press therefore deletes nothing more.
        let left = harness.state().document().scene().nodes().len();
        press(&mut harness, Modifiers::NONE, Key::Delete);
        assert_eq!(harness.state().document().scene().nodes().len(), left);
        press(&mut harness, Modifiers::COMMAND, Key::Z);
        assert_eq!(harness.state().document().selection(), ids, "undo brings the selection back");
    }
}

#[test]
fn locked_nodes_are_not_grouped_cut_or_reordered() {
    let (mut scene, [_, ball, cube, _]) = scene();
    lock(&mut scene, ball);
    let keys = [
        (Modifiers::COMMAND, Key::G),
        (Modifiers::NONE, Key::D),
        (Modifiers::NONE, Key::I),
        (Modifiers::NONE, Key::N),
        (Modifiers::ALT, Key::ArrowDown),
    ];
    for (modifiers, key) in keys {
        let mut harness = open(scene.clone());
        choose(&mut harness, &[cube, ball]);
        press(&mut harness, modifiers, key);
        assert_eq!(*harness.state().document().scene(), scene, "{key:?}");
        assert!(told(&harness).starts_with("“Ball” is locked"), "{key:?}: {}", told(&harness));
    }
    // Its group cannot be dissolved either.
    let mut harness = open(scene.clone());
    let group = scene.node(ball).unwrap().parent.unwrap();
    choose(&mut harness, &[group]);
    press(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::G);
    assert_eq!(*harness.state().document().scene(), scene);
    assert!(told(&harness).starts_with("“Ball” is locked"));
}

#[test]
fn locked_nodes_are_not_moved() {
    let (mut scene, [_, ball, cube, ring]) = scene();
    lock(&mut scene, ring);
    let mut harness = open_tall(scene.clone());
    // In the tree.
    let (from, onto) = (row(&harness, "Ring"), row(&harness, "Body"));
    drag(&mut harness, from, onto);
    assert_eq!(*harness.state().document().scene(), scene);
    assert!(told(&harness).starts_with("“Ring” is locked and cannot be moved"));
    // With the gizmo's arrows.
    choose(&mut harness, &[ring]);
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(glam::DVec3::ZERO, size.into()).unwrap();
    let start = rect.min + vec2(pixel.x as f32 + 50.0, pixel.y as f32);
    drag(&mut harness, start, start + vec2(80.0, 0.0));
    assert_eq!(*harness.state().document().scene(), scene);
    // With its fields.
    let x = super::field(&harness, "Position X").rect().center();
    drag(&mut harness, x, x + vec2(80.0, 0.0));
    super::click(&mut harness, x);
    harness.event(Event::Text("5".into()));
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene);
    assert!(harness.query_by_label_contains("locked and not moved").is_some());
    // In a multi-selection, the unlocked nodes move.
    choose(&mut harness, &[ring, ball, cube]);
    super::field(&harness, "Position X").set_value_accesskit(2.0);
    harness.run();
    let x = [ring, ball, cube].map(|id| harness.state().document().scene().node(id).unwrap().transform.translation.x);
    assert_eq!(x, [0.0, 2.0, 2.0]);
    // Unlocked, it moves again.
    choose(&mut harness, &[ring]);
    press(&mut harness, Modifiers::NONE, Key::L);
    super::field(&harness, "Position X").set_value_accesskit(3.0);
    harness.run();
    assert_eq!(harness.state().document().scene().node(ring).unwrap().transform.translation.x, 3.0);
}

pub fn drag(harness: &mut Harness<'_, Editor>, from: egui::Pos2, to: egui::Pos2) {
    pointer(harness, from, true);
    harness.step();
    for step in 1..=10 {
        harness.event(Event::PointerMoved(from + (to - from) * (step as f32 / 10.0)));
        harness.step();
    }
    pointer(harness, to, false);
    harness.run();
    harness.run_steps(40);
}

#[test]
fn a_row_dropped_below_the_others_goes_to_the_top_level() {
    let (scene, [group, ball, cube, ring]) = scene();
    let mut harness = open(scene.clone());
    // Between the last row and the materials.
    let empty = egui::pos2(100.0, 400.0);
    let from = row(&harness, "Ball");
    drag(&mut harness, from, empty);
    let order = |harness: &Harness<'_, Editor>| {
        harness.state().document().scene().children(None).map(|node| node.id).collect::<Vec<_>>()
    };
    assert_eq!(order(&harness), [group, ring, ball]);
    // A drop onto its own parent moves a node to the end; several nodes keep their order.
    let from = row(&harness, "Body");
    drag(&mut harness, from, empty);
    assert_eq!(order(&harness), [ring, ball, group]);
    choose(&mut harness, &[ring, cube]);
    let from = row(&harness, "Ring");
    drag(&mut harness, from, empty);
    assert_eq!(order(&harness), [ball, group, ring, cube]);
    // A drop onto the picture has no effect.
    let before = harness.state().document().scene().clone();
    let (from, picture) = (row(&harness, "Ball"), harness.get_by_label("Viewport").rect().center());
    drag(&mut harness, from, picture);
    assert_eq!(*harness.state().document().scene(), before);
    select(&mut harness, "Ball");
    assert_eq!(super::undo_all(&mut harness), 3);
    assert_eq!(*harness.state().document().scene(), scene);
}
