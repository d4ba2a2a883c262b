//! Pivots, moving onto surfaces, the lasso, aligning, distributing, and the origin of groups.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::editor::Editor;
use isolith::scene::{Group, Node, NodeId, NodeKind, Object, Scene, Shape};

use super::{open, press, undo_all};

/// A wide flat box with its top at Y = 0.5, a small box above it, and two more boxes beside.
fn boxes() -> (Scene, [NodeId; 4]) {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let mut add = |name: &str, size: DVec3, at: DVec3| {
        let shape = Shape::Box { size: size.to_array(), rounding: 0.0 };
        scene.insert(None, usize::MAX, Node::new(name, NodeKind::Object(Object { shape, material })).at(at)).unwrap()
    };
    let ids = [
        add("Floor", DVec3::new(8.0, 1.0, 8.0), DVec3::ZERO),
        add("Small", DVec3::splat(0.4), DVec3::new(0.0, 3.0, 0.0)),
        add("Tall", DVec3::new(0.4, 2.0, 0.4), DVec3::new(2.0, 4.0, 1.0)),
        add("Far", DVec3::splat(1.0), DVec3::new(7.0, 3.0, 0.0)),
    ];
    (scene, ids)
}

fn on_screen(harness: &Harness<'_, Editor>, p: DVec3) -> Pos2 {
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(p, size.into()).unwrap();
    rect.min + vec2(pixel.x as f32, pixel.y as f32)
}

fn choose(harness: &mut Harness<'_, Editor>, ids: &[NodeId]) {
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run();
}

fn run_command(harness: &mut Harness<'_, Editor>, name: &str) {
    press(harness, Modifiers::NONE, Key::F3);
    harness.event(Event::Text(name.into()));
    harness.run();
    press(harness, Modifiers::NONE, Key::Enter);
}

fn place(harness: &Harness<'_, Editor>, id: NodeId) -> DVec3 {
    harness.state().document().scene().node(id).unwrap().transform.translation
}

fn key(harness: &mut Harness<'_, Editor>, key: Key) {
    harness.key_press(key);
    harness.step();
    harness.step();
}

#[test]
fn f_puts_what_is_moved_onto_the_surface_under_the_pointer() {
    let (scene, [_, small, ..]) = boxes();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[small]);
    let target = DVec3::new(-1.5, 0.5, 1.0);
    let at = on_screen(&harness, target);
    harness.event(Event::PointerMoved(at + vec2(30.0, -30.0)));
    harness.run();
    key(&mut harness, Key::G);
    key(&mut harness, Key::F);
    harness.event(Event::PointerMoved(at));
    harness.step();
    harness.step();
    let rests = place(&harness, small);
    assert!((rests - DVec3::new(-1.5, 0.7, 1.0)).length() < 0.02, "it rests on the floor: {rests}");
    assert!((rests.y - 0.7).abs() < 1e-6, "exactly: {rests}");
    // On the front side of the floor, along its normal.
    key(&mut harness, Key::F);
    let side = on_screen(&harness, DVec3::new(0.5, 0.1, 4.0));
    harness.event(Event::PointerMoved(side));
    harness.step();
    harness.step();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let node = harness.state().document().scene().node(small).unwrap().clone();
    assert!((node.transform.translation.z - 4.2).abs() < 0.01, "{}", node.transform.translation);
    assert!((node.transform.rotation * DVec3::Y - DVec3::Z).length() < 1e-3, "it stands on the wall");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn each_node_turns_around_itself_with_individual_origins() {
    let (scene, [_, small, tall, _]) = boxes();
    let mut harness = open(scene);
    choose(&mut harness, &[small, tall]);
    let before = [small, tall].map(|id| place(&harness, id));
    let turn = |harness: &mut Harness<'_, Editor>| {
        let center = harness.get_by_label("Viewport").rect().center();
        harness.event(Event::PointerMoved(center + vec2(60.0, 60.0)));
        harness.run();
        key(harness, Key::R);
        key(harness, Key::Y);
        harness.event(Event::Text("90".into()));
        harness.step();
        press(harness, Modifiers::NONE, Key::Enter);
    };
    run_command(&mut harness, "Pivot: individual origins");
    turn(&mut harness);
    assert_eq!([small, tall].map(|id| place(&harness, id)), before);
    run_command(&mut harness, "Pivot: world origin");
    turn(&mut harness);
    let now = place(&harness, tall);
    assert!((now - DVec3::new(1.0, 4.0, -2.0)).length() < 1e-6, "{now}");
}

#[test]
fn a_lasso_selects_what_it_runs_around() {
    let (scene, [_, small, tall, far]) = boxes();
    let mut harness = open(scene);
    press(&mut harness, Modifiers::NONE, Key::Num1);
    press(&mut harness, Modifiers::NONE, Key::Home);
    press(&mut harness, Modifiers::SHIFT, Key::B);
    let [a, b, c] = [small, tall, far].map(|id| on_screen(&harness, place(&harness, id)));
    // Around the first and the last, below the middle of the tall one.
    let below = vec2(0.0, 30.0);
    let line = [a + vec2(-20.0, -20.0), a + vec2(20.0, -8.0), b + vec2(0.0, 40.0), c + vec2(-20.0, -8.0)];
    let line = line.into_iter().chain([c + vec2(20.0, -20.0), c + below, b + vec2(0.0, 90.0), a + below]);
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let mut last = None;
    for at in line {
        harness.event(Event::PointerMoved(at));
        if last.is_none() {
            harness.event(button(at, true));
        }
        harness.step();
        last = Some(at);
    }
    harness.event(button(last.unwrap(), false));
    harness.run();
    assert_eq!(harness.state().document().selection(), [small, far]);
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn nodes_are_aligned_and_distributed_by_their_bounds() {
    let (scene, [_, small, tall, far]) = boxes();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[small, far, tall]);
    run_command(&mut harness, "Align bottom Y");
    assert_eq!([small, far, tall].map(|id| place(&harness, id).y), [3.2, 3.5, 4.0], "on the lower end of the tall one");
    run_command(&mut harness, "Distribute along X");
    // 7.7 meters from end to end less 1.8 of boxes leave two gaps of 2.95.
    assert_eq!([small, tall, far].map(|id| place(&harness, id).x), [0.0, 3.35, 7.0]);
    let labels: Vec<_> = harness.state().document().undo_labels().map(str::to_owned).collect();
    assert_eq!(labels, ["Distribute along X", "Align bottom Y"]);
    assert_eq!(undo_all(&mut harness), 2);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_origin_of_a_group_moves_below_what_it_holds_and_nothing_else_moves() {
    let (mut scene, [_, small, tall, _]) = boxes();
    let group =
        Node::new("Pair", NodeKind::Group(Group::UNION)).at(DVec3::new(-3.0, 1.0, 0.0)).scaled(DVec3::splat(2.0));
    let group = scene.insert(None, 0, group).unwrap();
    for id in [small, tall] {
        scene.move_to(id, Some(group), usize::MAX).unwrap();
    }
    let before = [small, tall].map(|id| scene.world_from_local(id));
    let mut harness = open(scene.clone());
    choose(&mut harness, &[group]);
    run_command(&mut harness, "Origin to the bottom");
    let now = harness.state().document().scene();
    for (id, before) in [small, tall].into_iter().zip(before) {
        assert!(now.world_from_local(id).abs_diff_eq(before, 1e-9));
    }
    // The lower side of both in the group: X from -0.2 to 2.2, Y from 2.8, Z from -0.2 to 1.2; then doubled.
    let origin = now.node(group).unwrap().transform.translation;
    assert!((origin - DVec3::new(-1.0, 6.6, 1.0)).length() < 1e-9, "{origin}");
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

/// A group turns and grows where it stands, not around the origin of the world.
#[test]
fn a_new_group_has_its_origin_below_what_it_holds() {
    let (scene, [_, _, tall, far]) = boxes();
    let mut harness = open(scene.clone());
    let world =
        |harness: &Harness<'_, Editor>, id: NodeId| harness.state().document().scene().world_from_local(id).translation;
    for key in [Key::U, Key::I, Key::D] {
        choose(&mut harness, &[tall, far]);
        let before = [tall, far].map(|id| world(&harness, id));
        press(&mut harness, Modifiers::NONE, key);
        let group = harness.state().document().selection()[0];
        // From 1.8 to 7.5, from 2.5 to 5 and from -0.5 to 1.2.
        let origin = place(&harness, group);
        assert!((origin - DVec3::new(4.65, 2.5, 0.35)).length() < 1e-9, "{origin}");
        let after = [tall, far].map(|id| world(&harness, id));
        assert!(before.iter().zip(after).all(|(a, b)| (*a - b).length() < 1e-12), "{before:?} {after:?}");
        assert_eq!(undo_all(&mut harness), 1);
        assert_eq!(*harness.state().document().scene(), scene);
    }
}
