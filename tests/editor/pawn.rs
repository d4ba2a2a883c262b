//! A pawn from an empty scene by hand: nearly every gesture is one in the viewport, none is in a number field.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::editor::Editor;
use isolith::field::flatten;
use isolith::field::scene_eval::SceneEvaluator;
use isolith::scene::{Group, NodeKind, Scene};

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
