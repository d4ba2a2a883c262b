//! The outliner: renaming, selecting and dragging rows.

use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::editor::Editor;
use isolith::scene::{Node, NodeId, NodeKind, Object, Operation, Operator, Scene, ShapeKind};

use super::{field, open, pointer, press, row, scene, select, undo_all};

#[test]
fn renaming_in_the_tree() {
    let (scene, [_, _, cube, _]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Cube");
    press(&mut harness, Modifiers::NONE, Key::F2);
    field(&harness, "New name");
    harness.event(Event::Text("Xenon".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let name = |h: &Harness<'_, Editor>| h.state().document().scene().node(cube).unwrap().name.clone();
    assert_eq!(name(&harness), "Xenon", "and X in a text field deletes nothing");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(name(&harness), "Cube");
    press(&mut harness, Modifiers::NONE, Key::F2);
    harness.event(Event::Text("Other".into()));
    harness.run();
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert_eq!(name(&harness), "Cube", "Escape leaves the name");
}

#[test]
fn shift_and_ctrl_select_several_rows() {
    let (scene, [group, ball, cube, ring]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    let click_with = |harness: &mut Harness<'_, Editor>, name: &str, modifiers: Modifiers| {
        let pos = row(harness, name);
        harness.event(Event::PointerMoved(pos));
        for pressed in [true, false] {
            let event = Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
            harness.event_modifiers(event, modifiers);
        }
        harness.run();
        harness.run_steps(40);
        let mut ids = harness.state().document().selection().to_vec();
        ids.sort();
        ids
    };
    assert_eq!(click_with(&mut harness, "Ball", Modifiers::SHIFT), [ball]);
    assert_eq!(click_with(&mut harness, "Ring", Modifiers::SHIFT), [ball, cube, ring]);
    assert_eq!(click_with(&mut harness, "Cube", Modifiers::COMMAND), [ball, ring]);
    assert_eq!(click_with(&mut harness, "Body", Modifiers::COMMAND), [group, ball, ring]);
    assert_eq!(click_with(&mut harness, "Cube", Modifiers::NONE), [cube]);
    assert_eq!(click_with(&mut harness, "Ball", Modifiers::SHIFT), [ball, cube]);
}

#[test]
fn rows_are_dragged_into_groups() {
    let (scene, [group, _, _, ring]) = scene();
    let mut harness = open(scene.clone());
    let (from, onto) = (row(&harness, "Ring"), row(&harness, "Body"));
    pointer(&mut harness, from, true);
    harness.step();
    for step in 1..=10 {
        harness.event(Event::PointerMoved(from + (onto - from) * (step as f32 / 10.0)));
        harness.step();
    }
    pointer(&mut harness, onto, false);
    harness.run();
    assert_eq!(harness.state().document().scene().node(ring).unwrap().parent, Some(group));
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn the_tree_scrolls_to_what_is_selected_elsewhere() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let ids: Vec<NodeId> = (0..200)
        .map(|i| {
            let object = Object { shape: ShapeKind::Sphere.default_shape(), material };
            scene.insert(None, i, Node::new(format!("Ball {i}"), NodeKind::Object(object))).unwrap()
        })
        .collect();
    let mut harness = open(scene);
    for i in [150, 3, 199] {
        harness.state_mut().document_mut().select(vec![ids[i]]);
        harness.run();
        let y = row(&harness, &format!("Ball {i}")).y;
        assert!((100.0..780.0).contains(&y), "{y}");
    }
}

#[test]
fn the_tree_lists_one_kind_and_what_holds_it() {
    let (mut scene, [_, ball, ..]) = scene();
    let mut cutter = Node::clone(scene.node(ball).unwrap());
    cutter.operation = Operation::Subtract;
    scene.replace(cutter).unwrap();
    let mut harness = open(scene);
    let filter = |harness: &mut Harness<'_, Editor>, kind: &str| {
        harness.get_by_label("Filter by kind").click();
        harness.run();
        harness.get_by_label(kind).click();
        harness.run();
    };
    let listed = |harness: &Harness<'_, Editor>| {
        ["Body", "Ball", "Cube", "Ring"].map(|name| harness.query_by_label(name).is_some())
    };
    assert_eq!(listed(&harness), [true; 4]);
    filter(&mut harness, "Subtracted");
    assert_eq!(listed(&harness), [true, true, false, false], "what is subtracted, with its group");
    filter(&mut harness, "Lights");
    assert_eq!(listed(&harness), [false; 4]);
    filter(&mut harness, "Everything");
    assert_eq!(listed(&harness), [true; 4]);
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn the_icon_of_a_group_changes_its_operator() {
    let (scene, [group, ..]) = scene();
    let mut harness = open(scene.clone());
    harness.get_by_label("Operation of Body").click();
    harness.run();
    harness.get_by_label_contains("Intersection").click();
    harness.run();
    let NodeKind::Group(now) = harness.state().document().scene().node(group).unwrap().kind else { panic!("a group") };
    assert_eq!(now.operator, Operator::Intersection);
    assert_eq!(undo_all(&mut harness), 1);
    assert_eq!(*harness.state().document().scene(), scene);
}
