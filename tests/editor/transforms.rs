//! Moving, rotating and scaling in the viewport, by keys and by the gizmo, in both keymaps.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{DQuat, DVec3};
use isolith::document::Preferences;
use isolith::editor::Editor;
use isolith::scene::{Blend, BlendKernel, Group, Node, NodeId, NodeKind, Operator, Scene};

use super::{open, pointer, press, scene, undo_all};

/// The editor with the ring selected, seen from the front, and the pointer in the picture.
fn with_ring() -> (Harness<'static, Editor>, Scene, NodeId) {
    let (scene, [.., ring]) = scene();
    let mut harness = open(scene.clone());
    harness.state_mut().document_mut().select(vec![ring]);
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let start = middle(&harness) + vec2(90.0, 60.0);
    harness.event(Event::PointerMoved(start));
    harness.run();
    (harness, scene, ring)
}

/// The position of the world's origin on the screen.
fn middle(harness: &Harness<'_, Editor>) -> Pos2 {
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(DVec3::ZERO, size.into()).unwrap();
    rect.min + vec2(pixel.x as f32, pixel.y as f32)
}

fn node(harness: &Harness<'_, Editor>, id: NodeId) -> Node {
    harness.state().document().scene().node(id).unwrap().as_ref().clone()
}

fn key(harness: &mut Harness<'_, Editor>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.step();
    harness.step();
}

fn types(harness: &mut Harness<'_, Editor>, text: &str) {
    harness.event(Event::Text(text.into()));
    harness.step();
}

fn moved_by(harness: &mut Harness<'_, Editor>, by: Vec2, modifiers: Modifiers) {
    let from = middle(harness) + vec2(90.0, 60.0);
    harness.event(Event::ModifiersChanged(modifiers));
    for step in 1..=6 {
        harness.event(Event::PointerMoved(from + by * (step as f32 / 6.0)));
        harness.step();
    }
}

#[test]
fn g_follows_the_pointer_until_a_click_and_is_one_step() {
    let (mut harness, scene, ring) = with_ring();
    key(&mut harness, Modifiers::NONE, Key::G);
    moved_by(&mut harness, vec2(60.0, -30.0), Modifiers::NONE);
    let moved = node(&harness, ring).transform.translation;
    assert!(moved.x > 0.1 && moved.y > 0.05 && moved.z == 0.0, "in the plane of the screen: {moved}");
    let size = harness.state().view().size_px.map(f64::from);
    let project = |p| harness.state().view().camera.project(p, size.into()).unwrap().0;
    let way = project(moved) - project(DVec3::ZERO);
    assert!((way - glam::DVec2::new(60.0, -30.0)).length() < 1.0, "it stays under the pointer: {way}");
    let at = middle(&harness) + vec2(150.0, 30.0);
    pointer(&mut harness, at, true);
    pointer(&mut harness, at, false);
    harness.run();
    assert_eq!(harness.state().document().selection(), [ring], "the click that ends it selects nothing");
    assert_eq!(node(&harness, ring).transform.translation, moved);
    harness.event(Event::PointerMoved(at + vec2(50.0, 50.0)));
    harness.run();
    assert_eq!(node(&harness, ring).transform.translation, moved, "it has ended");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn axis_letters_and_typed_expressions() {
    let (mut harness, scene, ring) = with_ring();
    // Along an axis, and in a plane.
    key(&mut harness, Modifiers::NONE, Key::G);
    key(&mut harness, Modifiers::NONE, Key::X);
    moved_by(&mut harness, vec2(60.0, -30.0), Modifiers::NONE);
    let t = node(&harness, ring).transform.translation;
    assert!(t.x > 0.1 && t.y == 0.0 && t.z == 0.0, "{t}");
    types(&mut harness, "3");
    types(&mut harness, "*");
    types(&mut harness, "2");
    assert_eq!(node(&harness, ring).transform.translation, DVec3::X * 6.0);
    key(&mut harness, Modifiers::NONE, Key::Backspace);
    key(&mut harness, Modifiers::NONE, Key::Backspace);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(node(&harness, ring).transform.translation, DVec3::X * 3.0);
    key(&mut harness, Modifiers::NONE, Key::G);
    key(&mut harness, Modifiers::SHIFT, Key::Z);
    types(&mut harness, "1");
    key(&mut harness, Modifiers::NONE, Key::Tab);
    types(&mut harness, "-2");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(node(&harness, ring).transform.translation, DVec3::new(4.0, -2.0, 0.0));
    // Around an axis.
    key(&mut harness, Modifiers::NONE, Key::R);
    key(&mut harness, Modifiers::NONE, Key::Y);
    types(&mut harness, "90");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    let turn = node(&harness, ring).transform.rotation;
    assert!(turn.abs_diff_eq(DQuat::from_rotation_y(90_f64.to_radians()), 1e-12), "{turn}");
    // X again: the node's own axis, which lies along −Z of the world now.
    key(&mut harness, Modifiers::NONE, Key::G);
    key(&mut harness, Modifiers::NONE, Key::X);
    key(&mut harness, Modifiers::NONE, Key::X);
    types(&mut harness, "1");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    let t = node(&harness, ring).transform.translation;
    assert!((t - DVec3::new(4.0, -2.0, -1.0)).length() < 1e-9, "{t}");
    // All alike, and one axis.
    key(&mut harness, Modifiers::NONE, Key::S);
    types(&mut harness, "2");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(node(&harness, ring).transform.scale, DVec3::splat(2.0));
    key(&mut harness, Modifiers::NONE, Key::S);
    key(&mut harness, Modifiers::NONE, Key::Y);
    types(&mut harness, "1/4");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(node(&harness, ring).transform.scale, DVec3::new(2.0, 0.5, 2.0));
    assert_eq!(undo_all(&mut harness), 6, "one step each");
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn escape_and_the_right_button_take_it_back() {
    let (mut harness, scene, ring) = with_ring();
    for kind in [Key::G, Key::R, Key::S] {
        moved_by(&mut harness, Vec2::ZERO, Modifiers::NONE);
        key(&mut harness, Modifiers::NONE, kind);
        moved_by(&mut harness, vec2(40.0, 50.0), Modifiers::NONE);
        assert!(*harness.state().document().scene() != scene, "{kind:?}");
        // The keys of other commands wait: nothing is hidden or deleted.
        for other in [Key::H, Key::Delete, Key::Num3] {
            key(&mut harness, Modifiers::NONE, other);
        }
        key(&mut harness, Modifiers::NONE, Key::Escape);
        assert_eq!(*harness.state().document().scene(), scene, "{kind:?}");
        assert_eq!(harness.state().document().selection(), [ring], "Escape has only that effect");
    }
    key(&mut harness, Modifiers::NONE, Key::G);
    moved_by(&mut harness, vec2(40.0, 50.0), Modifiers::NONE);
    let pos = middle(&harness) + vec2(130.0, 110.0);
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
        harness.step();
    }
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn ctrl_snaps_to_the_grid_and_to_angles_and_shift_is_precise() {
    let along = |first: Key, modifiers: Modifiers, by: Vec2| {
        let (mut harness, _, ring) = with_ring();
        key(&mut harness, Modifiers::NONE, first);
        moved_by(&mut harness, by, modifiers);
        node(&harness, ring).transform
    };
    let free = along(Key::G, Modifiers::NONE, vec2(57.0, 0.0)).translation.x;
    let snapped = along(Key::G, Modifiers::COMMAND, vec2(57.0, 0.0)).translation.x;
    let precise = along(Key::G, Modifiers::SHIFT, vec2(57.0, 0.0)).translation.x;
    assert!((snapped * 10.0 - (snapped * 10.0).round()).abs() < 1e-9 && snapped != free, "{snapped} {free}");
    assert!((precise * 10.0 - free).abs() < 0.02, "{precise} {free}");
    let angle = |modifiers| along(Key::R, modifiers, vec2(0.0, -100.0)).rotation.to_axis_angle().1.to_degrees();
    let (free, snapped) = (angle(Modifiers::NONE), angle(Modifiers::COMMAND));
    assert!((snapped / 5.0 - (snapped / 5.0).round()).abs() < 1e-9, "{snapped}");
    assert!((free - snapped).abs() <= 2.5 && free > 30.0, "{free}");
    assert!(along(Key::R, Modifiers::NONE, vec2(0.0, -100.0)).rotation.z > 0.0, "counterclockwise, as on the screen");
    let scale = along(Key::S, Modifiers::COMMAND, vec2(90.0, 60.0)).scale;
    assert_eq!(scale, DVec3::splat(2.0), "twice as far from the pivot");
}

/// Chooses an entry of the menu View.
fn choose(harness: &mut Harness<'_, Editor>, path: [&str; 2]) {
    for name in ["View", path[0], path[1]] {
        let entry = harness.get_all_by_label(name).next().expect("an entry").rect().center();
        super::click(harness, entry);
        harness.run_steps(40);
    }
    press(harness, Modifiers::NONE, Key::Escape);
    press(harness, Modifiers::NONE, Key::Escape);
}

#[test]
fn the_other_keymap_has_tools_and_is_kept_for_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let (mut harness, _, ring) = with_ring();
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    choose(&mut harness, ["Keymap", "Keymap: Industry"]);
    harness.state_mut().document_mut().select(vec![ring]);
    press(&mut harness, Modifiers::NONE, Key::G);
    moved_by(&mut harness, vec2(40.0, 50.0), Modifiers::NONE);
    assert_eq!(node(&harness, ring).transform.translation, DVec3::ZERO, "G has no meaning there");
    // R chooses the tool to scale: the cube in the middle scales along all axes.
    press(&mut harness, Modifiers::NONE, Key::R);
    drag(&mut harness, Vec2::ZERO, vec2(40.0, 0.0));
    let scale = node(&harness, ring).transform.scale;
    assert!(scale.x > 1.1 && scale.x == scale.y && scale.y == scale.z, "{scale}");
    // E: the ring around the view.
    press(&mut harness, Modifiers::NONE, Key::E);
    drag(&mut harness, vec2(65.0, 65.0), vec2(0.0, -60.0));
    let turn = node(&harness, ring).transform.rotation;
    assert!(turn.z > 0.1 && turn.x.abs() < 1e-9, "{turn}");
    // Q: no gizmo, so that the view orbits.
    press(&mut harness, Modifiers::NONE, Key::Q);
    let camera = harness.state().view().camera;
    drag(&mut harness, vec2(50.0, 0.0), vec2(40.0, 0.0));
    assert_ne!(harness.state().view().camera, camera);
    assert_eq!(undo_all(&mut harness), 2);
    let (mut next, _, ring) = with_ring();
    next.state_mut().set_preferences(Preferences::load_from(&store));
    next.state_mut().document_mut().select(vec![ring]);
    press(&mut next, Modifiers::NONE, Key::R);
    drag(&mut next, Vec2::ZERO, vec2(40.0, 0.0));
    assert!(node(&next, ring).transform.scale.x > 1.1, "the next start has the same keys");
}

/// Drags from a place relative to the pivot at the origin.
fn drag(harness: &mut Harness<'_, Editor>, from: Vec2, by: Vec2) {
    let start = middle(harness) + from;
    pointer(harness, start, true);
    harness.step();
    for step in 1..=6 {
        harness.event(Event::PointerMoved(start + by * (step as f32 / 6.0)));
        harness.step();
    }
    pointer(harness, start + by, false);
    harness.run();
}

#[test]
fn the_gizmo_follows_the_axes_that_are_chosen() {
    let (mut scene, [.., ring]) = scene();
    let mut turned = scene.node(ring).unwrap().as_ref().clone();
    turned.transform.rotation = DQuat::from_rotation_z(90_f64.to_radians());
    scene.replace(turned).unwrap();
    let mut harness = open(scene);
    choose(&mut harness, ["Orientation", "Orientation: Local"]);
    harness.state_mut().document_mut().select(vec![ring]);
    press(&mut harness, Modifiers::NONE, Key::Num1);
    // The arrow to the right is the node's −Y; its X points up.
    drag(&mut harness, vec2(0.0, -70.0), vec2(30.0, -40.0));
    let t = node(&harness, ring).transform.translation;
    assert!(t.y > 0.05 && t.x.abs() < 1e-9 && t.z.abs() < 1e-9, "{t}");
}

#[test]
fn scaling_a_group_scales_its_blends() {
    let (mut scene, [body, ..]) = scene();
    let mut group = scene.node(body).unwrap().as_ref().clone();
    group.kind = NodeKind::Group(Group::new(Operator::Union, Blend::new(BlendKernel::Circular, 0.2)));
    scene.replace(group).unwrap();
    let mut harness = open(scene.clone());
    harness.state_mut().document_mut().select(vec![body]);
    harness.run();
    key(&mut harness, Modifiers::NONE, Key::S);
    types(&mut harness, "2");
    key(&mut harness, Modifiers::NONE, Key::Enter);
    let NodeKind::Group(Group { blend, .. }) = node(&harness, body).kind else { panic!() };
    assert_eq!(blend.radius, 0.4);
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn locked_nodes_are_not_transformed() {
    let (mut harness, _, ring) = with_ring();
    press(&mut harness, Modifiers::NONE, Key::L);
    press(&mut harness, Modifiers::NONE, Key::G);
    moved_by(&mut harness, vec2(40.0, 0.0), Modifiers::NONE);
    assert_eq!(node(&harness, ring).transform.translation, DVec3::ZERO);
    let told = harness.state().messages().last().unwrap().text.clone();
    assert!(told.starts_with("“Ring” is locked and cannot be moved"), "{told}");
    press(&mut harness, Modifiers::NONE, Key::L);
    assert!(!node(&harness, ring).locked, "and the keys work again");
}
