//! Adding: the palette at the pointer, favorites, and where new nodes stand.

use egui::{Event, Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use isolith::document::Preferences;
use isolith::editor::Editor;
use isolith::scene::{Node, NodeKind, Object, Scene, Shape, ShapeKind};

use super::{open, press, undo_all};

/// The position of a point of the world on the screen.
fn on_screen(harness: &Harness<'_, Editor>, p: DVec3) -> Pos2 {
    let rect = harness.get_by_label("Viewport").rect();
    let size = harness.state().view().size_px.map(f64::from);
    let (pixel, _) = harness.state().view().camera.project(p, size.into()).unwrap();
    rect.min + vec2(pixel.x as f32, pixel.y as f32)
}

/// Opens the palette over a point of the world, types and confirms.
fn add(harness: &mut Harness<'_, Editor>, over: DVec3, text: &str) -> Node {
    let at = on_screen(harness, over);
    harness.event(Event::PointerMoved(at));
    harness.run();
    press(harness, Modifiers::SHIFT, Key::A);
    assert!(harness.state().has_dialog());
    harness.event(Event::Text(text.into()));
    harness.run();
    press(harness, Modifiers::NONE, Key::Enter);
    assert!(!harness.state().has_dialog());
    let document = harness.state().document();
    document.scene().node(document.selection()[0]).unwrap().as_ref().clone()
}

fn object(kind: ShapeKind) -> Node {
    let material = Scene::new().materials()[0].id;
    Node::new("Thing", NodeKind::Object(Object { shape: kind.default_shape(), material }))
}

#[test]
fn what_is_added_stands_on_the_ground_under_the_pointer() {
    let mut harness = open(Scene::new());
    let node = add(&mut harness, DVec3::new(0.6, 0.0, 0.4), "cylin");
    assert_eq!(node.name, "Cylinder");
    let at = node.transform.translation;
    assert!((at - DVec3::new(0.6, 0.5, 0.4)).abs().max_element() < 0.01, "{at}");
    assert!(at.x.to_string().len() <= 6, "tidy: {at}");
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn what_is_added_sits_on_what_is_under_the_pointer() {
    let mut scene = Scene::new();
    scene.insert(None, 0, object(ShapeKind::Box).at(DVec3::Y * 0.5)).unwrap();
    let mut harness = open(scene);
    let ball = add(&mut harness, DVec3::new(0.2, 1.0, 0.1), "sphere");
    let at = ball.transform.translation;
    assert!((at - DVec3::new(0.2, 1.5, 0.1)).length() < 0.02 && (at.y - 1.5).abs() < 1e-3, "on top: {at}");
    // On the side, which faces along X.
    let ball = add(&mut harness, DVec3::new(0.5, 0.4, 0.2), "sphere");
    let at = ball.transform.translation;
    assert!((at - DVec3::new(1.0, 0.4, 0.2)).length() < 0.02, "at the side: {at}");
    assert_eq!(undo_all(&mut harness), 2);
}

#[test]
fn a_new_shape_suits_the_view() {
    let mut scene = Scene::new();
    scene.insert(None, 0, object(ShapeKind::Box).scaled(DVec3::splat(400.0))).unwrap();
    let mut harness = open(scene);
    let ball = add(&mut harness, DVec3::new(50.0, 200.0, 20.0), "sphere");
    let NodeKind::Object(Object { shape: Shape::Sphere { radius }, .. }) = ball.kind else { panic!() };
    assert!((50.0..=250.0).contains(&radius), "{radius}");
    assert!((ball.transform.translation.y - 200.0 - radius).abs() < 1.0, "and stands on the box");
}

#[test]
fn a_new_shape_is_not_hidden_in_another() {
    let mut harness = open(Scene::new());
    for name in ["Add box", "Add sphere", "Add sphere"] {
        harness.get_by_label(name).click();
        harness.run();
    }
    let nodes = harness.state().document().scene().nodes();
    let heights: Vec<f64> = nodes.iter().map(|node| node.transform.translation.y).collect();
    assert_eq!(heights, [0.0, 1.0, 2.0], "each on top of the last");
}

#[test]
fn the_toolbar_shows_favorites_that_are_kept_for_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("preferences.json");
    let mut harness = open(Scene::new());
    harness.state_mut().set_preferences(Preferences::load_from(&store));
    harness.run();
    let buttons = |harness: &Harness<'_, Editor>| {
        let labels = harness.query_all_by_label_contains("Add ").filter_map(|node| node.accesskit_node().label());
        labels.filter(|label| !label.contains("something") && !label.contains("material")).count()
    };
    assert_eq!(buttons(&harness), 8);
    harness.get_by_label("Add something").click();
    harness.run();
    harness.get_by_label("Category Fractals").click();
    harness.run();
    for name in ["Favorite: Mandelbulb", "Favorite: Julia set"] {
        harness.get_by_label(name).click();
        harness.run();
    }
    harness.get_by_label("Category Favorites").click();
    harness.run();
    harness.get_by_label("Favorite: Torus").click();
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().has_dialog());
    assert_eq!(undo_all(&mut harness), 0, "nothing has been added");
    let mut next = open(Scene::new());
    next.state_mut().set_preferences(Preferences::load_from(&store));
    next.run();
    assert_eq!(buttons(&next), 9);
    assert!(next.query_by_label("Add torus").is_none());
    next.get_by_label("Add mandelbulb").click();
    next.run();
    assert_eq!(next.state().document().scene().nodes()[0].name, "Mandelbulb");
}

#[test]
fn a_click_in_the_palette_adds_where_the_pointer_was() {
    let mut harness = open(Scene::new());
    let over = DVec3::new(-0.5, 0.0, 0.7);
    let at = on_screen(&harness, over);
    harness.event(Event::PointerMoved(at));
    harness.run();
    press(&mut harness, Modifiers::SHIFT, Key::A);
    harness.get_by_label("Category Lights").click();
    harness.run();
    harness.get_by_label("New Point light").click();
    harness.run();
    let node = harness.state().document().scene().nodes()[0].clone();
    let at = node.transform.translation;
    assert!((at - over - DVec3::Y * 2.0).length() < 0.02, "two meters above: {at}");
}
