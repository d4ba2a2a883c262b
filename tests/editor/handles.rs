//! The handles on the selected shape: one builds by dragging them in the viewport.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::editor::Editor;
use isolith::scene::{
    Falloff, Group, Instancer, Lattice, Light, LightKind, Mask, Node, NodeId, NodeKind, Object, Scene, Shape, ShapeKind,
};

use super::{open, press, shape, undo_all};

/// An editor with one selected node, seen from the front right.
fn with(kind: NodeKind) -> (Harness<'static, Editor>, Scene, NodeId) {
    let mut scene = Scene::new();
    let id = scene.insert(None, 0, Node::new("Thing", kind)).unwrap();
    let mut harness = open(scene.clone());
    harness.state_mut().document_mut().select(vec![id]);
    harness.run();
    (harness, scene, id)
}

fn object(kind: ShapeKind) -> NodeKind {
    let material = Scene::new().materials()[0].id;
    NodeKind::Object(Object { shape: kind.default_shape(), material })
}

fn handle(harness: &Harness<'_, Editor>, name: &str) -> Pos2 {
    harness.get_by_label(&format!("Handle: {name}")).rect().center()
}

fn names(harness: &Harness<'_, Editor>) -> Vec<String> {
    let labels = harness.query_all_by_label_contains("Handle: ").filter_map(|node| node.accesskit_node().label());
    labels.map(|label| label.trim_start_matches("Handle: ").to_owned()).collect()
}

fn button(harness: &mut Harness<'_, Editor>, pos: Pos2, pressed: bool, modifiers: Modifiers) {
    let event = Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
    harness.event_modifiers(event, modifiers);
    harness.step();
}

/// Presses on a position and moves in a few frames, without letting go; returns the last position.
fn pull(harness: &mut Harness<'_, Editor>, from: Pos2, by: Vec2, modifiers: Modifiers) -> Pos2 {
    harness.event_modifiers(Event::PointerMoved(from), modifiers);
    button(harness, from, true, modifiers);
    for step in 1..=8 {
        harness.event_modifiers(Event::PointerMoved(from + by * (step as f32 / 8.0)), modifiers);
        harness.step();
    }
    from + by
}

fn drag(harness: &mut Harness<'_, Editor>, from: Pos2, by: Vec2, modifiers: Modifiers) -> Pos2 {
    let end = pull(harness, from, by, modifiers);
    button(harness, end, false, modifiers);
    harness.run();
    end
}

fn tap(harness: &mut Harness<'_, Editor>, at: Pos2, modifiers: Modifiers) {
    harness.event_modifiers(Event::PointerMoved(at), modifiers);
    button(harness, at, true, modifiers);
    button(harness, at, false, modifiers);
    harness.run();
}

#[test]
fn a_side_of_a_box_follows_the_pointer_and_the_other_side_stays() {
    let (mut harness, scene, id) = with(object(ShapeKind::Box));
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let (right, left) = (handle(&harness, "Size X"), handle(&harness, "Size X, other side"));
    let end = drag(&mut harness, right, vec2(60.0, 0.0), Modifiers::NONE);
    let Shape::Box { size, .. } = shape(&harness, id) else { panic!() };
    assert!(size[0] > 1.1 && size[1] == 1.0 && size[2] == 1.0, "{size:?}");
    let moved = harness.state().document().scene().node(id).unwrap().transform.translation;
    assert!((moved.x - 0.5 * (size[0] - 1.0)).abs() < 1e-9, "{moved}");
    assert!(handle(&harness, "Size X").distance(end) < 1.0, "it stays under the pointer");
    assert!(handle(&harness, "Size X, other side").distance(left) < 1.0, "the other side stays");
    assert!(size[0].to_string().len() <= 5, "no more digits than the picture shows: {}", size[0]);
    assert_eq!(undo_all(&mut harness), 1, "one drag is one step");
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn shift_is_precise_ctrl_snaps_and_escape_cancels() {
    let radius = |modifiers: Modifiers| {
        let (mut harness, _, id) = with(object(ShapeKind::Sphere));
        let from = handle(&harness, "Radius");
        let center = harness.get_by_label("Viewport").rect().center();
        drag(&mut harness, from, (from - center).normalized() * 70.0, modifiers);
        let Shape::Sphere { radius } = shape(&harness, id) else { panic!() };
        radius
    };
    let (plain, precise, snapped) = (radius(Modifiers::NONE), radius(Modifiers::SHIFT), radius(Modifiers::COMMAND));
    assert!(plain > 0.55, "{plain}");
    assert!(((precise - 0.5) * 10.0 - (plain - 0.5)).abs() < 0.02, "{precise} {plain}");
    assert!((snapped * 10.0 - (snapped * 10.0).round()).abs() < 1e-9 && snapped > 0.5, "{snapped}");
    let (mut harness, scene, id) = with(object(ShapeKind::Sphere));
    let from = handle(&harness, "Radius");
    let end = pull(&mut harness, from, vec2(50.0, 20.0), Modifiers::NONE);
    assert_ne!(shape(&harness, id), ShapeKind::Sphere.default_shape());
    harness.key_press(Key::Escape);
    harness.step();
    assert_eq!(*harness.state().document().scene(), scene);
    harness.event(Event::PointerMoved(end + vec2(30.0, 0.0)));
    harness.step();
    button(&mut harness, end, false, Modifiers::NONE);
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene, "until the button is pressed again");
    assert_eq!(undo_all(&mut harness), 0);
    assert_eq!(harness.state().document().selection(), [id]);
}

#[test]
fn every_handle_of_every_shape_changes_it_in_one_step() {
    // A half space has no size, and a model that of its file.
    let without = [ShapeKind::Plane, ShapeKind::MeshField];
    for kind in ShapeKind::ALL.iter().filter(|kind| !without.contains(kind)) {
        let (mut harness, scene, id) = with(object(*kind));
        let all = names(&harness);
        assert!(!all.is_empty(), "{kind:?}");
        // A few of the points stand for all of them.
        let is_chosen = |name: &&String| !name.contains("oint") || ["Point 2", "New point 2"].contains(&name.as_str());
        for name in all.iter().filter(is_chosen) {
            let from = handle(&harness, name);
            for by in [vec2(23.0, -17.0), vec2(-19.0, 23.0)] {
                drag(&mut harness, from, by, Modifiers::NONE);
                if *harness.state().document().scene() != scene {
                    break;
                }
            }
            let now = harness.state().document().scene().node(id).unwrap();
            assert_ne!(now.kind, scene.node(id).unwrap().kind, "{kind:?}: {name}");
            assert_eq!(undo_all(&mut harness), 1, "{kind:?}: {name}");
            harness.run();
            assert_eq!(*harness.state().document().scene(), scene, "{kind:?}: {name}");
        }
    }
}

#[test]
fn points_of_a_curve_are_dragged_added_and_deleted() {
    let (mut harness, _, id) = with(object(ShapeKind::Tube));
    let points = |harness: &Harness<'_, Editor>| match shape(harness, id) {
        Shape::Tube { points, .. } => points.to_vec(),
        _ => panic!("a tube"),
    };
    let before = points(&harness);
    let from = handle(&harness, "Point 2");
    let end = drag(&mut harness, from, vec2(30.0, -40.0), Modifiers::NONE);
    assert!(handle(&harness, "Point 2").distance(end) < 1.5, "it stays under the pointer");
    assert_eq!(points(&harness)[2..], before[2..]);
    let middle = handle(&harness, "New point 2");
    let end = drag(&mut harness, middle, vec2(0.0, 45.0), Modifiers::NONE);
    assert_eq!(points(&harness).len(), before.len() + 1, "dragging a plus adds a point");
    assert!(handle(&harness, "Point 2").distance(end) < 1.5);
    let plus = handle(&harness, "New point 4");
    tap(&mut harness, plus, Modifiers::NONE);
    assert_eq!(points(&harness).len(), before.len() + 2, "so does a click");
    let last = handle(&harness, "Point 6");
    tap(&mut harness, last, Modifiers::COMMAND);
    assert_eq!(points(&harness).len(), before.len() + 1, "a click with Ctrl deletes");
    assert_eq!(harness.state().document().selection(), [id], "clicks on handles select nothing else");
    assert_eq!(undo_all(&mut harness), 4);
    assert_eq!(points(&harness), before);
}

#[test]
fn a_profile_stays_flat_and_keeps_three_corners() {
    let (mut harness, _, id) = with(object(ShapeKind::Extrusion));
    let corners = |harness: &Harness<'_, Editor>| match shape(harness, id) {
        Shape::Extrusion { corners, .. } => corners.to_vec(),
        _ => panic!("an extrusion"),
    };
    let from = handle(&harness, "Point 3");
    let end = drag(&mut harness, from, vec2(-25.0, 30.0), Modifiers::NONE);
    assert!(handle(&harness, "Point 3").distance(end) < 1.5, "it stays under the pointer");
    for _ in 0..12 {
        let at = handle(&harness, "Point 2");
        tap(&mut harness, at, Modifiers::COMMAND);
    }
    assert_eq!(corners(&harness).len(), 3);
}

#[test]
fn lights_cameras_and_blends_have_handles() {
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.1, range: 2.0 };
    let spot = LightKind::Spot { power: 100.0, radius: 0.1, falloff, inner: 20.0, outer: 30.0 };
    let (mut harness, scene, id) = with(NodeKind::Light(Light::new(spot)));
    for wanted in ["Radius", "Range", "Inner angle", "Outer angle"] {
        assert!(names(&harness).iter().any(|name| name == wanted), "{wanted}: {:?}", names(&harness));
    }
    let cone = |harness: &Harness<'_, Editor>| match &harness.state().document().scene().node(id).unwrap().kind {
        NodeKind::Light(Light { light: LightKind::Spot { inner, outer, .. }, .. }) => [*inner, *outer],
        _ => panic!("a spot"),
    };
    let (outer, inner) = (handle(&harness, "Outer angle"), handle(&harness, "Inner angle"));
    // Across the middle of the cone: the outer angle ends at the inner one.
    drag(&mut harness, outer, (inner - outer) * 0.6, Modifiers::NONE);
    assert_eq!(cone(&harness), [20.0, 20.0]);
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
    let (harness, ..) = with(NodeKind::Light(Light::new(LightKind::RECTANGLE)));
    assert!(names(&harness).iter().any(|name| name == "Width") && names(&harness).iter().any(|n| n == "Height"));

    let (scene, [group, ..]) = super::scene();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![group]);
    harness.run();
    let from = handle(&harness, "Blend radius");
    drag(&mut harness, from, vec2(40.0, 20.0), Modifiers::NONE);
    let radius = match harness.state().document().scene().node(group).unwrap().kind {
        NodeKind::Group(Group { blend, .. }) => blend.radius,
        _ => panic!("a group"),
    };
    assert!(radius > 0.05, "{radius}");
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn locked_hidden_and_several_nodes_have_no_handles() {
    let (mut harness, ..) = with(object(ShapeKind::Sphere));
    assert_eq!(names(&harness), ["Radius"]);
    press(&mut harness, Modifiers::NONE, Key::H);
    assert!(names(&harness).is_empty(), "hidden");
    press(&mut harness, Modifiers::NONE, Key::H);
    press(&mut harness, Modifiers::NONE, Key::L);
    assert!(names(&harness).is_empty(), "locked");
    let (scene, [_, ball, cube, _]) = super::scene();
    let mut harness = open(scene);
    harness.state_mut().document_mut().select(vec![ball, cube]);
    harness.run();
    assert!(names(&harness).is_empty(), "two of them");
}

#[test]
fn the_spacing_of_a_lattice_follows_the_pointer() {
    let grid = Instancer::grid([3, 1, 3], [1.0; 3]);
    let (mut harness, scene, id) = with(NodeKind::Instancer(Box::new(grid)));
    let wanted = ["Spacing X", "Spacing Z", "Counts X", "Counts Z"];
    assert_eq!(names(&harness), wanted, "none along an axis with a single layer");
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let from = handle(&harness, "Spacing X");
    let end = drag(&mut harness, from, vec2(60.0, 0.0), Modifiers::NONE);
    let NodeKind::Instancer(instancer) = harness.state().document().scene().node(id).unwrap().kind.clone() else {
        panic!()
    };
    let Lattice::Grid { spacing, .. } = instancer.lattice else { panic!() };
    assert!(spacing[0] > 1.1 && spacing[1..] == [1.0; 2], "{spacing:?}");
    assert!(handle(&harness, "Spacing X").distance(end) < 1.0, "it stays under the pointer");
    assert_eq!(undo_all(&mut harness), 1, "one drag is one step");
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_count_of_a_lattice_follows_the_pointer_in_whole_copies() {
    let grid = Instancer::grid([3, 1, 3], [1.0; 3]);
    let (mut harness, scene, id) = with(NodeKind::Instancer(Box::new(grid)));
    press(&mut harness, Modifiers::NONE, Key::Num1);
    let (edge, one) = (handle(&harness, "Counts X"), handle(&harness, "Spacing X"));
    let end = edge - one;
    // Two and a half meters from the middle instead of one and a half: five copies.
    let meter = -end.x / 2.5;
    drag(&mut harness, edge, vec2(-meter * 1.1, 0.0), Modifiers::NONE);
    let NodeKind::Instancer(instancer) = harness.state().document().scene().node(id).unwrap().kind.clone() else {
        panic!()
    };
    let Lattice::Grid { counts, .. } = instancer.lattice else { panic!() };
    assert_eq!(counts, [5, 1, 3]);
    assert_eq!(undo_all(&mut harness), 1, "one drag is one step");
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_distances_of_a_mask_follow_the_pointer() {
    let mut grid = Instancer::grid([3, 1, 3], [1.0; 3]);
    grid.masks = vec![Mask::Radius { inner: 0.8, outer: 1.6 }.into()];
    let (mut harness, scene, id) = with(NodeKind::Instancer(Box::new(grid)));
    let found = names(&harness);
    assert!(found.contains(&"Inner (mask)".to_owned()) && found.contains(&"Outer (mask)".to_owned()), "{found:?}");
    let from = handle(&harness, "Outer (mask)");
    let end = drag(&mut harness, from, vec2(40.0, 0.0), Modifiers::NONE);
    let NodeKind::Instancer(instancer) = harness.state().document().scene().node(id).unwrap().kind.clone() else {
        panic!()
    };
    let Mask::Radius { inner, outer } = instancer.masks[0].mask else { panic!() };
    assert!(inner == 0.8 && outer > 1.65, "{inner} {outer}");
    assert!(handle(&harness, "Outer (mask)").distance(end) < 40.0);
    assert_eq!(undo_all(&mut harness), 1, "one drag is one step");
    assert_eq!(*harness.state().document().scene(), scene);
}
