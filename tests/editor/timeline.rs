//! The timeline: keys from the inspector and by the keyboard, playback, and the keys in their rows.

use std::time::Duration;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, ViewportId, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::editor::Editor;
use isolith::scene::{KeyInterpolation, Keyframe, NodeId, ParamPath, ParamValue, Part, Scene, Shape, Track};

use super::{click, field, list_box, open, open_tall, pointer, press, scene, select, shape, undo_all};

fn radius(id: NodeId) -> ParamPath {
    ParamPath::of_node(id, Part::Shape, "radius")
}

/// The scene with the ball's radius growing from 0.5 to 1.5 in four seconds.
fn growing() -> (Scene, NodeId) {
    let (mut scene, [_, ball, ..]) = scene();
    let key = |time: f64, value: f64| Keyframe {
        time,
        value: ParamValue::Scalar(value),
        interpolation: KeyInterpolation::Linear,
    };
    scene.set_tracks([Track { path: radius(ball), keys: vec![key(0.0, 0.5), key(4.0, 1.5)] }]).unwrap();
    (scene, ball)
}

fn times(harness: &Harness<'_, Editor>, path: &ParamPath) -> Vec<f64> {
    let track = harness.state().document().scene().animation.track(path);
    track.map_or(Vec::new(), |track| track.keys.iter().map(|key| (key.time * 1e6).round() / 1e6).collect())
}

/// The place of a moment in a lane of the timeline, which shows 0 to 10 seconds.
fn place(harness: &Harness<'_, Editor>, lane: &str, time: f32) -> Pos2 {
    let rect = field(harness, lane).rect();
    pos2(rect.left() + 10.0 + time / 10.0 * (rect.width() - 20.0), rect.center().y)
}

fn go_to(harness: &mut Harness<'_, Editor>, time: f32) {
    let at = place(harness, "Ruler", time);
    click(harness, at);
}

fn drag(harness: &mut Harness<'_, Editor>, from: Pos2, to: Pos2, modifiers: Modifiers) {
    harness.event(Event::PointerMoved(from));
    let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
    harness.event_modifiers(button(from, true), modifiers);
    harness.step();
    for part in 1..=4 {
        let at = from + (to - from) * (part as f32 / 4.0);
        harness.event_modifiers(Event::PointerMoved(at), modifiers);
        harness.step();
    }
    harness.event_modifiers(button(to, false), modifiers);
    harness.run();
}

fn set(harness: &mut Harness<'_, Editor>, name: &str, text: &str) {
    let pos = field(harness, name).rect().center();
    click(harness, pos);
    press(harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(text.into()));
    harness.run();
    press(harness, Modifiers::NONE, Key::Enter);
}

/// When the window is painted again if nothing happens.
fn next_paint(harness: &Harness<'_, Editor>) -> Duration {
    harness.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

#[test]
fn marks_beside_parameters_set_and_remove_keys() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    let mark = field(&harness, "Insert key: Radius").rect().center();
    click(&mut harness, mark);
    assert_eq!(times(&harness, &radius(ball)), [0.0]);
    // At another moment a changed value sets a key, and between them the value is between them.
    go_to(&mut harness, 5.0);
    assert_eq!(harness.state().document().time(), 5.0);
    set(&mut harness, "Radius", "2");
    assert_eq!(times(&harness, &radius(ball)), [0.0, 5.0]);
    go_to(&mut harness, 2.5);
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 1.25 });
    let mark = field(&harness, "Insert key: Radius").rect().center();
    click(&mut harness, mark);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 2.5, 5.0]);
    let mark = field(&harness, "Remove key: Radius").rect().center();
    click(&mut harness, mark);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 5.0]);
    // What cannot change with time has no mark.
    assert_eq!(harness.query_all_by_label("Insert key: Boolean operation").count(), 0);
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn a_key_press_keys_the_transforms_of_the_selection() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    press(&mut harness, Modifiers::NONE, Key::K);
    let transform = |name: &'static str| ParamPath::of_node(ball, Part::Transform, name);
    for name in ["translation", "rotation", "scale"] {
        assert_eq!(times(&harness, &transform(name)), [0.0], "{name}");
    }
    go_to(&mut harness, 1.0);
    set(&mut harness, "Position X", "3");
    set(&mut harness, "Rotation Y", "90");
    assert_eq!(times(&harness, &transform("translation")), [0.0, 1.0]);
    assert_eq!(times(&harness, &transform("rotation")), [0.0, 1.0]);
    assert_eq!(times(&harness, &transform("scale")), [0.0], "the scale was not changed");
    assert_eq!(undo_all(&mut harness), 3, "three keys are one step");
}

#[test]
fn playback_moves_the_picture_and_an_idle_timeline_costs_nothing() {
    let (scene, ball) = growing();
    let mut harness = open(scene);
    let revision = harness.state().document().revision();
    assert!(next_paint(&harness) > Duration::from_secs(1), "nothing moves, so nothing is painted");
    harness.key_press(Key::Space);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..12 {
        harness.step();
        let document = harness.state().document();
        seen.insert((document.time() * 24.0).round() as i64);
        let Shape::Sphere { radius } = shape(&harness, ball) else { panic!("a ball") };
        assert_eq!(radius, 0.5 + (document.time() / 4.0).min(1.0));
        let flat = harness.state().flat();
        assert!(flat.components.iter().any(|c| c.count >= 1), "the arrays follow");
    }
    assert!(seen.len() > 6, "{seen:?}");
    assert!(harness.state().view().navigating, "playback is a drag for the renderer");
    assert!(next_paint(&harness) < Duration::from_millis(50), "while it plays, frame follows frame");
    harness.key_press(Key::Space);
    harness.step();
    let stopped = harness.state().document().time();
    harness.run();
    assert!(next_paint(&harness) > Duration::from_secs(1));
    assert!(!harness.state().view().navigating);
    assert_eq!(harness.state().document().time(), stopped);
    assert_eq!(harness.state().document().revision(), revision, "another moment is no change");
}

#[test]
fn a_drag_on_the_ruler_scrubs_and_stops_the_playback() {
    let (scene, ball) = growing();
    let mut harness = open(scene);
    harness.key_press(Key::Space);
    harness.step();
    let [from, to] = [1.0, 2.0].map(|time| place(&harness, "Ruler", time));
    pointer(&mut harness, from, true);
    harness.step();
    for part in 0..=4 {
        harness.event(Event::PointerMoved(from + (to - from) * (part as f32 / 4.0)));
        harness.step();
    }
    assert!(harness.state().view().navigating);
    pointer(&mut harness, to, false);
    harness.run();
    assert_eq!(harness.state().document().time(), 2.0);
    assert_eq!(shape(&harness, ball), Shape::Sphere { radius: 1.0 });
    // The number leads to a frame, the buttons to keys and ends.
    set(&mut harness, "Frame", "24");
    assert_eq!(harness.state().document().time(), 1.0);
    for (button, time) in [("Next key", 4.0), ("Previous key", 0.0), ("Last frame", 10.0), ("First frame", 0.0)] {
        let at = field(&harness, button).rect().center();
        click(&mut harness, at);
        assert_eq!(harness.state().document().time(), time, "{button}");
    }
    set(&mut harness, "End", "48");
    assert_eq!(harness.state().document().scene().animation.timeline.end, 2.0);
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn keys_are_selected_dragged_copied_and_deleted_in_their_rows() {
    let (scene, ball) = growing();
    let mut harness = open(scene.clone());
    let lane = "Keys of Ball: Radius";
    let at = |harness: &Harness<'_, Editor>, time: f32| place(harness, lane, time);
    let (from, to) = (at(&harness, 4.0), at(&harness, 6.0));
    drag(&mut harness, from, to, Modifiers::NONE);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 6.0]);
    // Past another key and back leaves that one as it was.
    let (from, to) = (at(&harness, 6.0), at(&harness, 0.0));
    pointer(&mut harness, from, true);
    harness.step();
    for place in [to, from + vec2(30.0, 0.0), from] {
        harness.event(Event::PointerMoved(place));
        harness.step();
    }
    pointer(&mut harness, from, false);
    harness.run();
    assert_eq!(times(&harness, &radius(ball)), [0.0, 6.0]);
    assert_eq!(undo_all(&mut harness), 1, "a drag is one step, and one that changes nothing is none");
    assert_eq!(*harness.state().document().scene(), scene);
    harness.run();
    // With Ctrl a copy is dragged.
    let (from, to) = (at(&harness, 4.0), at(&harness, 8.0));
    drag(&mut harness, from, to, Modifiers::COMMAND);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 4.0, 8.0]);
    // The copy is selected; another interpolation is for it alone.
    let list = list_box(&harness, "Interpolation").rect().center();
    click(&mut harness, list);
    harness.get_by_label("Hold").click();
    harness.run();
    let track = harness.state().document().scene().animation.track(&radius(ball)).unwrap().clone();
    let hold: Vec<_> = track.keys.iter().map(|key| key.interpolation == KeyInterpolation::Hold).collect();
    assert_eq!(hold, [false, false, true]);
    // Over the timeline Delete means keys, elsewhere nodes.
    select(&mut harness, "Ball");
    let key = at(&harness, 4.0);
    click(&mut harness, key);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 8.0]);
    assert!(harness.state().document().scene().node(ball).is_some());
    let key = at(&harness, 8.0);
    click(&mut harness, key);
    go_to(&mut harness, 5.0);
    let copy = field(&harness, "Copy keys to this moment").rect().center();
    click(&mut harness, copy);
    assert_eq!(times(&harness, &radius(ball)), [0.0, 5.0, 8.0]);
}
