//! Views: orthographic, along an axis, flying, through a camera, bookmarks.

use glam::DVec3;
use isolith::scene::CameraNode;

use super::*;

fn middle(harness: &Harness<'_, Editor>) -> Pos2 {
    harness.get_by_label("Viewport").rect().center()
}

#[test]
fn a_view_along_an_axis_is_parallel_until_one_orbits() {
    let mut harness = open(scene().0);
    let before = harness.state().view().camera;
    press(&mut harness, Modifiers::NONE, Key::Num5);
    let flat = harness.state().view().camera;
    assert!(flat.fov_y < before.fov_y * 2e-3 && flat.position.length() > 100.0 * before.position.length());
    press(&mut harness, Modifiers::NONE, Key::Num5);
    assert!((harness.state().view().camera.position - before.position).length() < 1e-9);
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let front = harness.state().view();
    assert!(front.camera.fov_y < 1e-2 && front.grid.axis == 2 && !front.grid.fades, "{front:?}");
    let from = middle(&harness) + vec2(150.0, 150.0);
    pointer(&mut harness, from, true);
    harness.step();
    for step in 1..=6 {
        harness.event(Event::PointerMoved(from + vec2(8.0 * step as f32, 0.0)));
        harness.step();
    }
    pointer(&mut harness, from + vec2(48.0, 0.0), false);
    harness.settle();
    let orbited = harness.state().view();
    assert!(orbited.camera.fov_y > 0.1 && orbited.grid.axis == 1 && orbited.grid.fades);
}

#[test]
fn a_click_selects_in_an_orthographic_view() {
    let (scene, [_, _, _, ring]) = scene();
    let mut harness = open(scene);
    press(&mut harness, Modifiers::NONE, Key::Num7);
    let center = middle(&harness);
    // From above the ring is around the ball: its tube is where the view is a fifth of its height off the middle.
    let mut found = false;
    for step in 1..30 {
        click(&mut harness, center + vec2(10.0 * step as f32, 0.0));
        harness.run_steps(40);
        found |= harness.state().document().selection() == [ring];
    }
    assert!(found, "the ring is picked somewhere between the middle and the border");
}

#[test]
fn the_right_button_flies_with_the_keys_of_movement() {
    let mut harness = open(scene().0);
    let at = middle(&harness);
    let before = harness.state().view().camera;
    let button = |harness: &mut Harness<'_, Editor>, pressed| {
        harness.event(Event::PointerMoved(at));
        let modifiers = Modifiers::NONE;
        harness.event(Event::PointerButton { pos: at, button: PointerButton::Secondary, pressed, modifiers });
        harness.step();
    };
    let key = |harness: &mut Harness<'_, Editor>, key, pressed| {
        harness.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE });
        harness.step();
    };
    let revision = harness.state().document().revision();
    button(&mut harness, true);
    key(&mut harness, Key::W, true);
    harness.run_steps(20);
    key(&mut harness, Key::W, false);
    let after = harness.state().view().camera;
    button(&mut harness, false);
    harness.settle();
    let forward = before.rotation * DVec3::NEG_Z;
    let moved = after.position - before.position;
    assert!(moved.dot(forward) > 0.1 && moved.normalize().dot(forward) > 0.999, "{moved}");
    assert_eq!(harness.state().document().revision(), revision, "keys of flight run no commands");
    let still = harness.state().view().camera;
    harness.run_steps(10);
    assert_eq!(harness.state().view().camera, still, "it ends with the button");
}

#[test]
fn a_locked_camera_follows_the_view_in_one_step_and_a_free_one_is_left() {
    let (mut scene, _) = scene();
    let camera = Node::new("Camera", NodeKind::Camera(CameraNode::default())).at(DVec3::new(0.0, 1.0, 6.0));
    let camera = scene.insert(None, 0, camera).unwrap();
    let mut harness = open(scene.clone());
    let place = |harness: &Harness<'_, Editor>| {
        let node = harness.state().document().scene().node(camera).unwrap();
        node.transform.translation
    };
    // The first view is the camera's; a second one brings its frame.
    press(&mut harness, Modifiers::NONE, Key::Num0);
    let view = harness.state().view().camera;
    assert!((view.position - DVec3::new(0.0, 1.0, 6.0)).length() < 1e-9);
    assert!(view.fov_y > 40.0_f64.to_radians(), "the frame is inside of the viewport");
    choose(&mut harness, &["View", "Lock camera to view"]);
    let from = middle(&harness) + vec2(150.0, 150.0);
    drag(&mut harness, from);
    let moved = place(&harness);
    assert!((moved - DVec3::new(0.0, 1.0, 6.0)).length() > 0.1, "{moved}");
    assert!((harness.state().view().camera.position - moved).length() < 1e-9);
    assert!(harness.state_mut().document_mut().undo());
    assert_eq!(harness.state().document().scene(), &scene, "one step");
    harness.settle();
    assert!((harness.state().view().camera.position - DVec3::new(0.0, 1.0, 6.0)).length() < 1e-9, "the view follows");
    choose(&mut harness, &["View", "Lock camera to view"]);
    drag(&mut harness, from);
    assert_eq!(place(&harness), DVec3::new(0.0, 1.0, 6.0), "a free camera stays");
}

fn choose(harness: &mut Harness<'_, Editor>, names: &[&str]) {
    for name in names {
        let entry = harness.get_all_by_label(name).next().expect("an entry").rect().center();
        super::click(harness, entry);
        harness.run_steps(40);
    }
}

fn drag(harness: &mut Harness<'_, Editor>, from: Pos2) {
    pointer(harness, from, true);
    harness.step();
    for step in 1..=6 {
        harness.event(Event::PointerMoved(from + vec2(8.0 * step as f32, 0.0)));
        harness.step();
    }
    pointer(harness, from + vec2(48.0, 0.0), false);
    harness.settle();
}

#[test]
fn bookmarks_bring_views_back() {
    let mut harness = open(scene().0);
    let first = harness.state().view().camera;
    press(&mut harness, Modifiers::SHIFT, Key::F5);
    press(&mut harness, Modifiers::NONE, Key::Num7);
    assert_ne!(harness.state().view().camera, first);
    press(&mut harness, Modifiers::NONE, Key::F6);
    assert!(harness.state().messages().next_back().expect("told").text.contains("empty"));
    press(&mut harness, Modifiers::NONE, Key::F5);
    assert_eq!(harness.state().view().camera, first);
    let scene = harness.state().document().scene().clone();
    assert!(scene.bookmarks[0].is_some() && scene.bookmarks[1].is_none());
    let text = isolith::scene::file::to_json(&scene).unwrap();
    let again = isolith::scene::file::parse(text.as_bytes(), std::path::Path::new("x")).unwrap();
    assert_eq!(again.bookmarks[0].map(|view| view.target), scene.bookmarks[0].map(|view| view.target));
    assert_eq!(undo_all(&mut harness), 1, "the scene keeps it");
}
