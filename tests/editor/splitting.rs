//! Several viewports: each with a view of its own; keys mean the one under the pointer.

use glam::DVec3;

use super::*;
use isolith::editor::Command;

fn split(harness: &mut Harness<'_, Editor>, count: usize) {
    let ctx = harness.ctx.clone();
    harness.state_mut().run(Command::SplitView(count), &ctx);
    harness.run_steps(4);
    harness.settle();
}

fn rect(harness: &Harness<'_, Editor>, name: &str) -> egui::Rect {
    // Its tab has the same name.
    let found = harness.get_all_by_label(name).find(|node| node.accesskit_node().role() != Role::Tab);
    found.unwrap_or_else(|| panic!("no {name}")).rect()
}

fn over(harness: &mut Harness<'_, Editor>, name: &str) -> Pos2 {
    let at = rect(harness, name).center();
    harness.event(Event::PointerMoved(at));
    harness.run_steps(3);
    at
}

#[test]
fn four_views_share_the_room_of_one_and_join_again() {
    let mut harness = open(scene().0);
    let whole = rect(&harness, "Viewport");
    split(&mut harness, 4);
    let names = ["Viewport", "View 2", "View 3", "View 4"];
    let rects = names.map(|name| rect(&harness, name));
    for (index, one) in rects.iter().enumerate() {
        assert!(one.width() > 0.4 * whole.width() && one.height() > 0.35 * whole.height(), "{one} of {whole}");
        assert!(whole.expand(1.0).contains_rect(*one), "{one} of {whole}");
        assert!(rects[..index].iter().all(|other| !other.shrink(1.0).intersects(*one)), "{rects:?}");
    }
    let views = harness.state().views_beside();
    assert_eq!(views.iter().map(|(index, _)| *index).collect::<Vec<_>>(), [1, 2, 3]);
    let axes = views.iter().map(|(_, view)| view.grid.axis).collect::<Vec<_>>();
    assert_eq!(axes, [2, 0, 1], "from the front, the right and the top");
    split(&mut harness, 1);
    assert_eq!(rect(&harness, "Viewport"), whole);
    assert!(harness.state().views_beside().is_empty() && harness.query_by_label("View 2").is_none());
}

#[test]
fn keys_and_clicks_mean_the_view_under_the_pointer() {
    let (scene, [group, ..]) = scene();
    let mut harness = open(scene);
    split(&mut harness, 2);
    let main = harness.state().view().camera;
    let at = over(&mut harness, "View 2");
    assert_eq!(harness.state().active_view(), 1);
    press(&mut harness, Modifiers::NONE, Key::Num7);
    let top = harness.state().view();
    assert_eq!(top.grid.axis, 1);
    assert!((top.camera.rotation * DVec3::Z - DVec3::Y).length() < 1e-9);
    assert_eq!(harness.state().views_beside()[0].1.camera, main, "the main one stays");
    click(&mut harness, at);
    assert_eq!(harness.state().document().selection(), [group], "a click selects in it");
    // A move by keys follows the pointer in it, in its plane.
    press(&mut harness, Modifiers::NONE, Key::G);
    for step in 1..=6 {
        harness.event(Event::PointerMoved(at + vec2(10.0 * step as f32, 0.0)));
        harness.step();
    }
    click(&mut harness, at + vec2(60.0, 0.0));
    let place = harness.state().document().scene().node(group).unwrap().transform.translation;
    assert!(place.x > 0.1 && place.y.abs() < 1e-9 && place.z.abs() < 1e-9, "{place}");
    over(&mut harness, "Viewport");
    assert_eq!((harness.state().active_view(), harness.state().view().camera), (0, main));
    assert_eq!(harness.state().views_beside()[0].1.camera, top.camera);
}

#[test]
fn a_view_that_is_closed_gives_its_keys_back_and_another_document_is_seen_anew() {
    let mut harness = open(scene().0);
    split(&mut harness, 2);
    over(&mut harness, "View 2");
    split(&mut harness, 1);
    assert_eq!(harness.state().active_view(), 0);
    split(&mut harness, 2);
    // The view under the pointer is the active one.
    over(&mut harness, "Viewport");
    let before = harness.state().views_beside()[0].1.camera;
    let ctx = harness.ctx.clone();
    harness.state_mut().run(Command::New, &ctx);
    harness.settle();
    harness.run_steps(4);
    assert_eq!(harness.state().active_view(), 0);
    assert_ne!(harness.state().views_beside()[0].1.camera.position, before.position);
}
