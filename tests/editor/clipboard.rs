//! Copy, cut and paste within a scene and between two windows; parts of a copied node; steps along the last move; the
//! list of undo steps.

use egui::{Event, Key, Modifiers, OutputCommand};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use isolith::editor::Editor;
use isolith::scene::{Material, ModifierKind, Node, NodeId, NodeKind, Scene, file};

use super::{click, open, press, scene, undo_all};

/// Presses the keys of the system for the clipboard; returns what was copied.
fn copied(harness: &mut Harness<'_, Editor>, event: Event) -> Option<String> {
    harness.event(event);
    let mut found = None;
    for _ in 0..4 {
        harness.step();
        found = found.or(harness.output().platform_output.commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        }));
    }
    found
}

fn paste(harness: &mut Harness<'_, Editor>, text: &str) {
    harness.event(Event::Paste(text.to_owned()));
    harness.run();
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

fn names(scene: &Scene) -> Vec<&str> {
    scene.nodes().iter().map(|node| node.name.as_str()).collect()
}

fn node(harness: &Harness<'_, Editor>, id: NodeId) -> Node {
    Node::clone(harness.state().document().scene().node(id).unwrap())
}

#[test]
fn what_is_copied_in_one_window_is_pasted_in_another() {
    let (mut one, [group, ball, ..]) = scene();
    let id = one.next_material_id();
    one.insert_material(Material::new(id, "Red", [0.8, 0.1, 0.1])).unwrap();
    let mut red = Node::clone(one.node(ball).unwrap());
    if let NodeKind::Object(object) = &mut red.kind {
        object.material = id;
    }
    one.replace(red).unwrap();
    let mut first = open(one.clone());
    choose(&mut first, &[group]);
    let text = copied(&mut first, Event::Copy).expect("the system gets a text");
    let part = file::parse(text.as_bytes(), "copied".as_ref()).expect("the text of a scene");
    assert_eq!(names(&part), ["Body", "Ball", "Cube"]);
    assert_eq!(*first.state().document().scene(), one, "copying changes nothing");

    let (two, [.., ring]) = scene();
    let mut second = open(two.clone());
    choose(&mut second, &[ring]);
    paste(&mut second, &text);
    let now = second.state().document().scene();
    assert_eq!(names(now), ["Body", "Ball", "Cube", "Ring", "Body 2", "Ball", "Cube"]);
    assert_eq!(now.materials().len(), two.materials().len() + 1, "its material comes along; the clay is there");
    let pasted = second.state().document().selection().to_vec();
    assert_eq!((pasted.len(), &*now.node(pasted[0]).unwrap().name), (1, "Body 2"));
    assert_eq!(second.state().document().undo_label(), Some("Paste Body"));
    assert_eq!(undo_all(&mut second), 1);
    assert_eq!(*second.state().document().scene(), two);
}

#[test]
fn cut_and_paste_is_two_steps_and_keeps_the_place() {
    let (scene, [_, ball, _, ring]) = scene();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[ball]);
    let before = harness.state().document().scene().world_from_local(ball);
    let text = copied(&mut harness, Event::Cut).unwrap();
    assert_eq!(names(harness.state().document().scene()), ["Body", "Cube", "Ring"]);
    choose(&mut harness, &[ring]);
    paste(&mut harness, &text);
    let pasted = harness.state().document().selection()[0];
    let now = harness.state().document().scene();
    assert_eq!((now.node(pasted).unwrap().parent, now.world_from_local(pasted)), (None, before));
    let labels: Vec<_> = harness.state().document().undo_labels().map(str::to_owned).collect();
    assert_eq!(labels, ["Paste Ball", "Cut Ball"]);
    assert_eq!(undo_all(&mut harness), 2);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn what_is_no_scene_is_not_pasted_and_typing_keeps_its_clipboard() {
    let (scene, [.., ring]) = scene();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[ring]);
    for text in ["a recipe", "{\"version\": 99}", "{", "{}"] {
        paste(&mut harness, text);
        let told = harness.state().messages().next_back().expect("a message").text.clone();
        assert!(told.contains("clipboard"), "{text}: {told}");
    }
    let search = harness.get_by_label("Search").rect().center();
    click(&mut harness, search);
    paste(&mut harness, "Cube");
    assert!(harness.query_by_label("Ring").is_none(), "the text went to the search field");
    assert_eq!(*harness.state().document().scene(), scene);
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn transform_material_and_modifiers_of_a_copied_node_go_to_others() {
    let (mut scene, [_, ball, cube, ring]) = scene();
    let id = scene.next_material_id();
    scene.insert_material(Material::new(id, "Red", [0.8, 0.1, 0.1])).unwrap();
    let mut source = Node::clone(scene.node(ring).unwrap()).at(DVec3::new(3.0, 1.0, 0.0));
    source.modifiers.push(ModifierKind::ALL[0].default_modifier().into());
    if let NodeKind::Object(object) = &mut source.kind {
        object.material = id;
    }
    scene.replace(source.clone()).unwrap();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[ring]);
    copied(&mut harness, Event::Copy).unwrap();
    choose(&mut harness, &[ball, cube]);
    for (command, steps) in [("Paste transform", 1), ("Paste material", 2), ("Paste modifiers", 3)] {
        run_command(&mut harness, command);
        assert_eq!(harness.state().document().undo_labels().count(), steps, "{command} is one step");
    }
    for id in [ball, cube] {
        let now = node(&harness, id);
        assert_eq!((now.transform, &now.modifiers), (source.transform, &source.modifiers));
        assert_eq!(now.materials().next(), source.materials().next());
    }
    assert_eq!(undo_all(&mut harness), 3);
    assert_eq!(*harness.state().document().scene(), scene);
}

#[test]
fn copies_along_the_last_move_make_a_row() {
    let (scene, [.., ring]) = scene();
    let mut harness = open(scene);
    choose(&mut harness, &[ring]);
    press(&mut harness, Modifiers::SHIFT, Key::D);
    press(&mut harness, Modifiers::NONE, Key::G);
    press(&mut harness, Modifiers::NONE, Key::X);
    harness.event(Event::Text("1.5".into()));
    harness.step();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    for _ in 0..2 {
        press(&mut harness, Modifiers::SHIFT, Key::R);
    }
    let scene = harness.state().document().scene();
    let row: Vec<f64> =
        scene.nodes().iter().filter(|n| n.name.starts_with("Ring")).map(|n| n.transform.translation.x).collect();
    assert_eq!(row, [0.0, 1.5, 3.0, 4.5]);
    assert_eq!(harness.state().document().undo_label(), Some("Duplicate along the last move"));
    assert_eq!(undo_all(&mut harness), 4);
}

#[test]
fn a_click_in_the_history_goes_to_that_step() {
    let (scene, [.., ring]) = scene();
    let mut harness = open(scene.clone());
    choose(&mut harness, &[ring]);
    for key in [Key::N, Key::H, Key::L] {
        press(&mut harness, Modifiers::NONE, key);
    }
    let done = harness.state().document().scene().clone();
    press(&mut harness, Modifiers::ALT, Key::Z);
    harness.get_by_label("Step 1: Subtract Ring").click();
    harness.run();
    assert_eq!(harness.state().document().undo_labels().count(), 1);
    assert_eq!(harness.state().document().selection(), [ring], "the selection of that time");
    harness.get_by_label("Step 0: Begin").click();
    harness.run();
    assert_eq!(*harness.state().document().scene(), scene);
    harness.get_by_label("Step 3: Lock Ring").click();
    harness.run();
    assert_eq!(*harness.state().document().scene(), done);
}
