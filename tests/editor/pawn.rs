//! Pawns from an empty scene by hand: nearly every gesture is one in the viewport, none is in a number field.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{DAffine3, DVec3};
use isolith::editor::Editor;
use isolith::field::flatten;
use isolith::field::scene_eval::SceneEvaluator;
use isolith::scene::{Group, Node, NodeKind, Object, ParamValue, Scene, Shape, file};

use super::{open, press, undo_all};

/// A hand that counts what it does.
struct Hand<'h> {
    harness: Harness<'h, Editor>,
    gestures: usize,
    in_viewport: usize,
}

impl Hand<'_> {
    fn on_screen(&self, p: DVec3) -> Pos2 {
        let rect = self.harness.get_by_label("Viewport").rect();
        let size = self.harness.state().view().size_px.map(f64::from);
        let (pixel, _) = self.harness.state().view().camera.project(p, size.into()).unwrap();
        rect.min + vec2(pixel.x as f32, pixel.y as f32)
    }

    fn key(&mut self, modifiers: Modifiers, key: Key) {
        press(&mut self.harness, modifiers, key);
        self.gestures += 1;
    }

    /// Opens the palette over a point, types a name and confirms.
    fn add(&mut self, over: DVec3, name: &str) {
        let at = self.on_screen(over);
        self.harness.event(Event::PointerMoved(at));
        self.harness.run();
        press(&mut self.harness, Modifiers::SHIFT, Key::A);
        self.harness.event(Event::Text(name.into()));
        self.harness.run();
        press(&mut self.harness, Modifiers::NONE, Key::Enter);
        self.gestures += 2;
        self.in_viewport += 1;
    }

    /// Drags the handle of this name to where a point of the world is, with the steps of the grid.
    fn drag_to(&mut self, handle: &str, to: DVec3) {
        let from = self.harness.get_by_label(&format!("Handle: {handle}")).rect().center();
        let by = self.on_screen(to) - from;
        self.drag(from, by);
    }

    fn drag(&mut self, from: Pos2, by: Vec2) {
        let harness = &mut self.harness;
        harness.event(Event::ModifiersChanged(Modifiers::COMMAND));
        harness.event(Event::PointerMoved(from));
        let modifiers = Modifiers::COMMAND;
        let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        harness.event(button(from, true));
        for step in 1..=6 {
            harness.event(Event::PointerMoved(from + by * (step as f32 / 6.0)));
            harness.step();
        }
        harness.event(button(from + by, false));
        harness.event(Event::ModifiersChanged(Modifiers::NONE));
        harness.run();
        harness.run_steps(4);
        self.gestures += 1;
        self.in_viewport += 1;
    }
}

/// How far sizes and places may be from those of the example, in meters: less than half of a step of the snapping. The
/// example's collar is 0.084 high, which is no multiple of a step.
const SAME: f64 = 0.0021;

impl Hand<'_> {
    /// Clicks a button by its name.
    fn click(&mut self, name: &str) {
        let at = self.harness.get_by_label(name).rect().center();
        super::click(&mut self.harness, at);
        self.gestures += 1;
    }

    /// Chooses an entry of the snapping menu: it is below others in a list that scrolls.
    fn snap_to(&mut self, entry: &str) {
        self.click("Snapping");
        self.harness.get_by_label(entry).click();
        self.harness.run();
        self.gestures += 1;
    }

    /// Moves the view by a drag with Shift.
    fn pan(&mut self, by: Vec2) {
        let from = self.harness.get_by_label("Viewport").rect().center();
        let modifiers = Modifiers::SHIFT;
        let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(Event::PointerMoved(from));
        self.harness.event(button(from, true));
        for step in 1..=4 {
            self.harness.event(Event::PointerMoved(from + by * (step as f32 / 4.0)));
            self.harness.step();
        }
        self.harness.event(button(from + by, false));
        self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        self.harness.run();
        self.gestures += 1;
        self.in_viewport += 1;
    }

    fn wheel(&mut self, lines: f32) {
        self.harness.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: vec2(0.0, lines),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
    }

    /// Draws from the middle of a base to a corner, with the steps of the snapping, and turns the wheel meanwhile.
    fn draw(&mut self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], notches: i32) {
        let [from, to] = [DVec3::new(x0, y0, 0.0), DVec3::new(x1, y1, 0.0)].map(|p| self.on_screen(p));
        let modifiers = Modifiers::COMMAND;
        let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(Event::PointerMoved(from));
        self.harness.event(button(from, true));
        for step in 1..=4 {
            self.harness.event(Event::PointerMoved(from + (to - from) * (step as f32 / 4.0)));
            self.harness.step();
        }
        for _ in 0..notches.abs() {
            self.wheel(notches.signum() as f32);
            self.harness.step();
        }
        self.gestures += usize::from(notches != 0);
        self.in_viewport += usize::from(notches != 0);
        self.harness.event(button(to, false));
        self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        // The wheel has to rest.
        self.harness.run_steps(20);
        self.gestures += 1;
        self.in_viewport += 1;
    }
}

/// What a scene has below its only group with this many parts: shapes with their places in the world, from bottom to top.
fn parts(scene: &Scene, name: &str) -> (f64, Vec<(Shape, DAffine3)>) {
    let group = scene.nodes().iter().find(|node| node.name == name).unwrap();
    let NodeKind::Group(Group { blend, .. }) = group.kind else { panic!("a group") };
    let part = |node: &std::sync::Arc<Node>| match &node.kind {
        NodeKind::Object(object) => (object.shape.clone(), scene.world_from_local(node.id)),
        _ => panic!("an object"),
    };
    let mut parts: Vec<_> = scene.children(Some(group.id)).map(part).collect();
    parts.sort_by(|a, b| a.1.translation.y.total_cmp(&b.1.translation.y));
    (blend.radius, parts)
}

/// The greatest difference of two sizes or places, or of two axes.
fn difference(a: &(Shape, DAffine3), b: &(Shape, DAffine3)) -> f64 {
    assert_eq!(a.0.kind(), b.0.kind());
    let numbers = |value| match value {
        ParamValue::Scalar(value) => vec![value],
        ParamValue::Vector(value) => value.to_array().to_vec(),
        other => panic!("{other:?}"),
    };
    let sizes = |shape: &Shape| shape.values().into_iter().flat_map(numbers).collect::<Vec<f64>>();
    let places = |place: &DAffine3| place.to_cols_array().to_vec();
    let all = |(shape, place): &(Shape, DAffine3)| [sizes(shape), places(place)].concat();
    all(a).into_iter().zip(all(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_pawn_of_the_example_takes_at_most_twenty_five_gestures() {
    let mut hand = Hand { harness: open(Scene::new()), gestures: 0, in_viewport: 0 };
    hand.key(Modifiers::NONE, Key::Num1);
    hand.in_viewport += 1;
    hand.pan(vec2(0.0, 170.0));
    hand.snap_to("Snap lengths: 0.005 m");
    hand.key(Modifiers::NONE, Key::P);
    // Each from the middle of its base to a corner; the wheel turns a bevel or an upper radius.
    hand.click("Add cylinder");
    hand.draw([0.0, 0.76], [0.11, 0.9], 0);
    hand.draw([0.0, 0.0], [0.375, 0.13], 10);
    hand.click("Add torus");
    hand.draw([0.0, 0.13], [0.325, 0.24], 0);
    hand.click("Add truncated cone");
    hand.draw([0.0, 0.18], [0.27, 0.34], 12);
    hand.draw([0.0, 0.27], [0.185, 0.73], 4);
    hand.click("Add sphere");
    hand.draw([0.0, 0.78], [0.205, 1.19], 0);
    press(&mut hand.harness, Modifiers::SHIFT, Key::A);
    hand.harness.event(Event::Text("ellipsoid".into()));
    hand.harness.run();
    press(&mut hand.harness, Modifiers::NONE, Key::Enter);
    hand.gestures += 2;
    hand.draw([0.0, 0.735], [0.215, 0.815], 0);
    // One group, blended and turned as the example is.
    hand.key(Modifiers::COMMAND, Key::A);
    hand.key(Modifiers::NONE, Key::U);
    let handle = hand.harness.get_by_label("Handle: Blend radius").rect().center();
    // It moves to the right and down.
    let way = DVec3::new(0.9, -0.44, 0.0).normalize() * 0.07;
    let by = hand.on_screen(way) - hand.on_screen(DVec3::ZERO);
    hand.drag(handle, by);
    press(&mut hand.harness, Modifiers::NONE, Key::R);
    press(&mut hand.harness, Modifiers::NONE, Key::Y);
    hand.harness.event(Event::Text("20".into()));
    hand.harness.run();
    hand.key(Modifiers::NONE, Key::Enter);
    hand.in_viewport += 1;
    assert!(hand.gestures <= 25, "{}", hand.gestures);
    assert!(2 * hand.in_viewport > hand.gestures, "{} of {}", hand.in_viewport, hand.gestures);

    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/pawn.json");
    let (blend, wanted) = parts(&file::load(&path).unwrap(), "White pawn");
    let (drawn_blend, drawn) = parts(hand.harness.state().document().scene(), "Group");
    assert_eq!((wanted.len(), drawn.len()), (7, 7));
    assert!((blend - drawn_blend).abs() < 1e-9, "{drawn_blend}");
    for (a, b) in wanted.iter().zip(&drawn) {
        assert!(difference(a, b) <= SAME, "{a:?} {b:?}");
    }
    // The comparison sees a step of the snapping.
    let mut moved = drawn[3].clone();
    moved.1.translation.y += 0.005;
    assert!(difference(&wanted[3], &moved) > SAME);
    assert_eq!(undo_all(&mut hand.harness), 10, "one step for each shape, the group, its blend and its rotation");
}

#[test]
fn a_shape_drawn_on_a_wall_stands_on_it() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let shape = Shape::Box { size: [4.0, 4.0, 0.2], rounding: 0.0 };
    scene.insert(None, 0, Node::new("Wall", NodeKind::Object(Object { shape, material }))).unwrap();
    let mut hand = Hand { harness: open(scene), gestures: 0, in_viewport: 0 };
    hand.key(Modifiers::NONE, Key::P);
    hand.click("Add cylinder");
    let [from, to] = [DVec3::new(0.2, 0.4, 0.1), DVec3::new(1.2, 0.4, 0.1)].map(|p| hand.on_screen(p));
    hand.harness.event(Event::PointerMoved(from));
    hand.harness.run();
    hand.drag(from, to - from);
    let scene = hand.harness.state().document().scene();
    let node = scene.nodes().last().unwrap();
    let NodeKind::Object(Object { shape: Shape::Cylinder { radius, height, .. }, .. }) = node.kind else {
        panic!("{node:?}, {:?}", hand.harness.state().messages().collect::<Vec<_>>())
    };
    // The step of the snapping that suits this view is a meter.
    assert_eq!(radius, 1.0);
    let place = scene.world_from_local(node.id);
    assert!((place.matrix3.y_axis - DVec3::Z).length() < 1e-3, "{place:?}");
    assert!((place.translation.z - 0.1 - 0.5 * height).abs() < 1e-3, "it touches the wall");
    // Escape takes back what is being drawn.
    let revision = scene.nodes().len();
    pointer_drag_and_escape(&mut hand, from, to - from);
    assert_eq!(hand.harness.state().document().scene().nodes().len(), revision);
    assert_eq!(undo_all(&mut hand.harness), 1);
}

fn pointer_drag_and_escape(hand: &mut Hand<'_>, from: Pos2, by: Vec2) {
    super::pointer(&mut hand.harness, from, true);
    hand.harness.step();
    for step in 1..=4 {
        hand.harness.event(Event::PointerMoved(from + by * (step as f32 / 4.0)));
        hand.harness.step();
    }
    assert_eq!(hand.harness.state().document().scene().nodes().len(), 3);
    press(&mut hand.harness, Modifiers::NONE, Key::Escape);
    super::pointer(&mut hand.harness, from + by, false);
    hand.harness.run();
}

#[test]
fn a_pawn_takes_at_most_twenty_five_gestures_most_of_them_in_the_viewport() {
    let mut hand = Hand { harness: open(Scene::new()), gestures: 0, in_viewport: 0 };
    // The foot: flat, its lower end stays on the ground.
    hand.add(DVec3::ZERO, "cylinder");
    let foot = hand.harness.state().document().scene().nodes()[0].transform.translation;
    let (x, floor) = (foot.x, foot.y - 0.5);
    let at = |height: f64| DVec3::new(x, floor + height, foot.z);
    hand.drag_to("Height", at(0.3));
    // The body on it, a cone; the collar; the head.
    hand.add(at(0.3), "truncated cone");
    hand.drag_to("Height", at(1.1));
    hand.add(at(1.1), "ellipsoid");
    // All of it in view.
    hand.key(Modifiers::NONE, Key::Home);
    hand.drag_to("Radii Y", at(1.3));
    hand.add(at(1.3), "sphere");
    // All of it in one group, blended.
    hand.key(Modifiers::COMMAND, Key::A);
    hand.key(Modifiers::NONE, Key::U);
    let handle = hand.harness.get_by_label("Handle: Blend radius").rect().center();
    hand.drag(handle, vec2(26.0, 12.0));
    assert!(hand.gestures <= 25, "{}", hand.gestures);
    assert!(2 * hand.in_viewport > hand.gestures, "{} of {}", hand.in_viewport, hand.gestures);

    let scene = hand.harness.state().document().scene().clone();
    let names: Vec<_> = scene.nodes().iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["Group", "Cylinder", "Truncated cone", "Ellipsoid", "Sphere"]);
    let NodeKind::Group(Group { blend, .. }) = scene.nodes()[0].kind else { panic!("a group") };
    assert!(blend.radius > 0.0, "{blend:?}");
    // It is one solid from the foot to the head, and stands on the ground.
    let flat = flatten(&scene, 0.0).unwrap();
    let mut field = SceneEvaluator::new(&flat);
    let mut value = |height: f64| field.distance(at(height), 1.0).value;
    let top = (1..400).map(|step| 0.01 * f64::from(step)).find(|height| value(*height) > 0.0).unwrap();
    assert!((top - 2.3).abs() < 0.05, "{top}");
    assert!(value(-0.02) > 0.0);
    assert_eq!(undo_all(&mut hand.harness), 9, "one step for each change");
    assert!(hand.harness.state().document().scene().nodes().is_empty());
}
