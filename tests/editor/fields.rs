//! Fields of the inspector: accepted input, messages, and the display of several nodes.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::editor::Editor;
use isolith::scene::{Material, MaterialId, Modifier, Node, NodeId, NodeKind, Object, Scene, Shape, ShapeKind};

use super::{click, field, open, open_tall, press, scene, select, shape, undo_all};

/// Types text into the field with this name and presses Enter.
fn type_into(harness: &mut Harness<'_, Editor>, name: &str, text: &str) {
    let pos = field(harness, name).rect().center();
    click(harness, pos);
    press(harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text(text.into()));
    harness.run();
    press(harness, Modifiers::NONE, Key::Enter);
}

fn said(harness: &Harness<'_, Editor>) -> Vec<String> {
    harness.state().messages().map(|message| message.text.clone()).collect()
}

fn shown(harness: &Harness<'_, Editor>, name: &str) -> String {
    field(harness, name).accesskit_node().value().unwrap_or_default()
}

#[test]
fn one_by_zero_keeps_the_value_and_says_so() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    let before = shape(&harness, ball);
    for (count, text) in ["1/0", "sqrt(-1)", "1e999", "12,,", " "].into_iter().enumerate() {
        type_into(&mut harness, "Radius", text);
        assert_eq!(shape(&harness, ball), before, "{text}");
        let messages = said(&harness);
        assert_eq!(messages.len(), count + 1, "{messages:?}");
        assert!(messages[count].contains("stays as it was") && messages[count].contains(text), "{messages:?}");
    }
    assert_eq!(undo_all(&mut harness), 0);
}

#[test]
fn a_value_that_is_clamped_says_so() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    type_into(&mut harness, "Scale X", "0");
    type_into(&mut harness, "Scale Y", "-1e9");
    type_into(&mut harness, "Position Z", "1e12");
    let node = harness.state().document().scene().node(ball).unwrap().clone();
    assert_eq!(node.transform.scale.to_array(), [0.01, -1e6, 1.0]);
    assert_eq!(node.transform.translation.z, 1e9);
    let messages = said(&harness);
    assert_eq!(messages.len(), 3, "{messages:?}");
    assert_eq!(messages[0], "Scale X: 0 is not possible; it is 0.01 now.");
    assert!(messages[1].starts_with("Scale Y: -1e9 is less than"), "{messages:?}");
    assert!(messages[2].starts_with("Position Z: 1e12 is more than"), "{messages:?}");
}

#[test]
fn a_number_that_must_be_whole_is_rounded_and_says_so() {
    let (mut scene, [_, ball, ..]) = scene();
    let mut node = scene.node(ball).unwrap().as_ref().clone();
    if let NodeKind::Object(object) = &mut node.kind {
        object.shape = ShapeKind::Prism.default_shape();
    }
    scene.replace(node).unwrap();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    type_into(&mut harness, "Sides", "7.4");
    let Shape::Prism { sides, .. } = shape(&harness, ball) else { panic!() };
    assert_eq!(sides.0, 7.0);
    assert_eq!(said(&harness), ["Sides: 7.4 is no whole number; it is 7 now."]);
    assert_eq!(shown(&harness, "Sides"), "7");
}

#[test]
fn a_color_that_is_none_says_so() {
    let (scene, _) = scene();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    let swatch = field(&harness, "Base color").rect().center();
    click(&mut harness, swatch);
    type_into(&mut harness, "Hex", "#12345");
    assert_eq!(*harness.state().document().scene(), scene);
    assert!(said(&harness)[0].contains("“#12345” is no color"), "{:?}", said(&harness));
}

#[test]
fn whole_numbers_have_no_decimals_and_zero_no_sign() {
    let (mut scene, [_, ball, ..]) = scene();
    let mut node = scene.node(ball).unwrap().as_ref().clone();
    node.transform.translation = glam::DVec3::new(2.0, -0.0, -1e-12);
    node.transform.rotation = glam::DQuat::from_rotation_y(30_f64.to_radians());
    scene.replace(node).unwrap();
    let mut harness = open_tall(scene);
    select(&mut harness, "Ball");
    for (name, text) in [
        ("Position X", "2"),
        ("Position Y", "0"),
        ("Position Z", "0"),
        ("Rotation X", "0"),
        ("Rotation Y", "30"),
        ("Scale X", "1"),
        ("Radius", "0.5 m"),
    ] {
        assert_eq!(shown(&harness, name), text, "{name}");
    }
}

#[test]
fn going_through_fields_changes_nothing() {
    let (mut scene, [_, ball, ..]) = scene();
    let mut node = scene.node(ball).unwrap().as_ref().clone();
    node.transform.translation = glam::DVec3::new(1.0 / 3.0, 0.123_456_789, 1e-7);
    node.transform.rotation = glam::DQuat::from_rotation_y(0.3).normalize();
    scene.replace(node).unwrap();
    let mut harness = open_tall(scene.clone());
    select(&mut harness, "Ball");
    let first = field(&harness, "Position X").rect().center();
    click(&mut harness, first);
    for _ in 0..7 {
        press(&mut harness, Modifiers::NONE, Key::Tab);
    }
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(*harness.state().document().scene(), scene);
    assert!(!harness.state().document().is_changed());
    assert_eq!(said(&harness), [""; 0]);
}

/// The current text of the material list.
fn list_shows(harness: &Harness<'_, Editor>) -> Option<String> {
    super::list_box(harness, "Material").accesskit_node().value()
}

/// Two objects of a kind with different materials; `change` makes them differ by their index.
fn two(change: impl Fn(&mut Node, usize), kind: ShapeKind) -> (Scene, [NodeId; 2]) {
    let mut scene = Scene::new();
    let first = scene.materials()[0].id;
    let second = MaterialId(first.0 + 1);
    scene.insert_material(Material::new(second, "Second", [0.1, 0.2, 0.3])).unwrap();
    let ids = [0, 1].map(|index| {
        let material = [first, second][index];
        let object = Object { shape: kind.default_shape(), material };
        let mut node = Node::new(format!("Node {index}"), NodeKind::Object(object));
        change(&mut node, index);
        scene.insert(None, index, node).unwrap()
    });
    (scene, ids)
}

fn open_both(scene: Scene, ids: [NodeId; 2]) -> Harness<'static, Editor> {
    let mut harness = open_tall(scene);
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run();
    harness
}

#[test]
fn mixed_materials_show_a_dash_and_can_be_made_one() {
    let (scene, ids) = two(|_, _| {}, ShapeKind::Sphere);
    let mut harness = open_both(scene.clone(), ids);
    assert_eq!(list_shows(&harness), Some("–".into()));
    assert!(harness.query_by_label("Material name").is_none(), "none of the two is edited");
    let list = super::list_box(&harness, "Material").rect().center();
    click(&mut harness, list);
    let second = harness.get_all_by_label("Second").next().unwrap().rect().center();
    click(&mut harness, second);
    for id in ids {
        let NodeKind::Object(object) = &harness.state().document().scene().node(id).unwrap().kind else { panic!() };
        assert_eq!(object.material, scene.materials()[1].id);
    }
    assert_eq!(list_shows(&harness), Some("Second".into()));
    assert_eq!(undo_all(&mut harness), 1);
}

#[test]
fn mixed_fields_show_a_dash() {
    let place = |node: &mut Node, index: usize| {
        node.transform.translation = glam::DVec3::new(index as f64, 5.0, 0.0);
        node.transform.rotation = glam::DQuat::from_rotation_y(index as f64);
        node.modifiers.push(Modifier::Round { radius: 0.1 * index as f64 }.into());
        if let NodeKind::Object(object) = &mut node.kind {
            object.shape = Shape::Sphere { radius: 1.0 + index as f64 };
        }
    };
    let (scene, ids) = two(place, ShapeKind::Sphere);
    let harness = open_both(scene, ids);
    for (name, text) in
        [("Position X", "–"), ("Position Y", "5"), ("Rotation X", "0"), ("Rotation Y", "–"), ("Scale X", "1")]
    {
        assert_eq!(shown(&harness, name), text, "{name}");
    }
    let numbers = harness.get_all_by_label("Radius").filter(|n| n.accesskit_node().role() != Role::Label);
    let radii: Vec<_> = numbers.filter_map(|n| n.accesskit_node().value()).collect();
    assert_eq!(radii, ["– m", "– m"]);
}

#[test]
fn a_mixed_number_takes_that_of_the_active_node_too() {
    let place = |node: &mut Node, index: usize| node.transform.translation.x = index as f64;
    let (scene, ids) = two(place, ShapeKind::Sphere);
    let mut harness = open_both(scene, ids);
    type_into(&mut harness, "Position X", "1");
    let x = ids.map(|id| harness.state().document().scene().node(id).unwrap().transform.translation.x);
    assert_eq!(x, [1.0, 1.0]);
}

#[test]
fn mixed_texts_and_points_show_a_dash() {
    let write = |node: &mut Node, index: usize| {
        if let NodeKind::Object(object) = &mut node.kind {
            let at = object.shape.values().iter().position(|v| matches!(v, isolith::scene::ParamValue::Text(_)));
            object.shape.set_value(at.unwrap(), isolith::scene::ParamValue::Text(format!("Text {index}")));
        }
    };
    let (scene, ids) = two(write, ShapeKind::Text);
    let mut harness = open_both(scene, ids);
    assert_eq!(shown(&harness, "Text"), "");
    let text = field(&harness, "Text").rect().center();
    click(&mut harness, text);
    harness.event(Event::Text("Both".into()));
    harness.run();
    for id in ids {
        let Shape::Text { text, .. } = shape(&harness, id) else { panic!() };
        assert_eq!(text, "Both");
    }
}

#[test]
fn what_cannot_be_taken_as_it_is_typed_is_told() {
    let (scene, [_, ball, ..]) = scene();
    let mut harness = open(scene);
    select(&mut harness, "Ball");
    let mut told = |text: &str| {
        let radius = field(&harness, "Radius").rect().center();
        click(&mut harness, radius);
        press(&mut harness, Modifiers::COMMAND, Key::A);
        harness.event(Event::Text(text.into()));
        harness.run();
        press(&mut harness, Modifiers::NONE, Key::Enter);
        harness.run();
        let Shape::Sphere { radius } = shape(&harness, ball) else { panic!() };
        (radius, harness.state().messages().map(|m| m.text.clone()).collect::<Vec<_>>())
    };
    let hard = ShapeKind::Sphere.params()[0].limits.hard;
    assert_eq!(told("2"), (2.0, vec![]));
    let (radius, messages) = told("ball");
    assert_eq!((radius, &*messages[0]), (2.0, "Radius: “ball” is not a number, so it stays as it was."));
    let (radius, messages) = told("1e30");
    assert_eq!((radius, messages.len()), (hard[1], 2));
    assert!(messages[1].starts_with("Radius: 1e30 is more than"), "{messages:?}");
    let (radius, messages) = told("-1");
    assert_eq!((radius, messages.len()), (hard[0], 3));
    assert!(messages[2].starts_with("Radius: -1 is less than"), "{messages:?}");
    assert_eq!(told("3").1.len(), 3);
}
