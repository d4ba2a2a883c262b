//! Every control of every panel has a name for readers of the screen, and says what it does when the pointer rests on it.

use std::collections::BTreeSet;

use egui::accesskit::Role;
use egui::{Event, Order, Pos2, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT;
use isolith::scene::{
    CameraNode, DynamicKind, Instancer, Light, LightKind, MaskKind, ModifierKind, Node, NodeId, NodeKind, Object,
    Scene, ShapeKind,
};

use super::open_sized;

/// What is pressed, ticked, dragged or typed into.
const CONTROLS: [Role; 10] = [
    Role::Button,
    Role::CheckBox,
    Role::RadioButton,
    Role::ComboBox,
    Role::SpinButton,
    Role::TextInput,
    Role::MultilineTextInput,
    Role::ColorWell,
    Role::Slider,
    Role::Link,
];

/// Menus explain their entries in the status bar, and titles of cards and rows of lists show what they are.
const SAYS_ITSELF: &[&str] = &["File", "Edit", "Add", "View", "Help"];

/// A control: its role, its name and its place.
fn controls<S>(harness: &Harness<'_, S>) -> Vec<(Role, String, Rect)> {
    let is_control = |node: &egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        CONTROLS.contains(&node.role()) && !node.is_hidden() && node.bounding_box().is_some()
    };
    let told = |node: egui_kittest::Node<'_>| {
        let place = node.rect();
        let node = node.accesskit_node();
        (node.role(), node.label().unwrap_or_default(), place)
    };
    harness.root().children_recursive().filter(is_control).map(told).collect()
}

/// Whether a tooltip comes when the pointer rests here.
fn has_tooltip<S>(harness: &mut Harness<'_, S>, at: Pos2) -> bool {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(3);
    let areas = |ctx: &egui::Context| ctx.memory(|memory| memory.areas().visible_layer_ids());
    areas(&harness.ctx).iter().any(|layer| layer.order == Order::Tooltip)
}

/// The controls without a name, and those without a tooltip that are not in `known` yet.
fn faults<S>(harness: &mut Harness<'_, S>, known: &mut BTreeSet<String>) -> Vec<String> {
    harness.ctx.all_styles_mut(|style| {
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
        style.interaction.tooltip_grace_time = 0.0;
    });
    let screen = harness.ctx.content_rect();
    let mut found = Vec::new();
    for (role, name, place) in controls(harness) {
        if name.trim().is_empty() {
            found.push(format!("{role:?} without a name at {place:?}"));
            continue;
        }
        let is_known = !known.insert(format!("{role:?} {name}")) || SAYS_ITSELF.contains(&&*name);
        if is_known || !screen.contains(place.center()) {
            continue;
        }
        if !has_tooltip(harness, place.center()) {
            found.push(format!("{role:?} “{name}” without a tooltip at {place:?}"));
        }
    }
    found
}

/// A scene with a node of every kind; nodes have modifiers and motions of many kinds.
fn everything() -> (Scene, Vec<NodeId>) {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let object = |kind: ShapeKind| NodeKind::Object(Object { shape: kind.default_shape(), material });
    let mut ball = Node::new("Ball", object(ShapeKind::Sphere));
    ball.modifiers = [ModifierKind::Round, ModifierKind::Twist].map(|kind| kind.default_modifier().into()).to_vec();
    ball.dynamics = vec![DynamicKind::ALL[0].default_dynamic().into()];
    let masks = MaskKind::ALL.iter().map(|kind| kind.default_mask().into()).collect();
    let instancer = Instancer { masks, ..Instancer::default() };
    let group = scene.insert(None, 0, Node::new("Group", NodeKind::Group(isolith::scene::Group::UNION))).unwrap();
    let ball = scene.insert(Some(group), 0, ball).unwrap();
    let others = [
        Node::new("Tube", object(ShapeKind::Tube)),
        Node::new("Text", object(ShapeKind::Text)),
        Node::new("Land", object(ShapeKind::Heightmap)),
        Node::new("Copies", NodeKind::Instancer(Box::new(instancer))),
        Node::new("Sun", NodeKind::Light(Light::sun())),
        Node::new("Spot", NodeKind::Light(Light::new(LightKind::SPOT))),
        Node::new("Camera", NodeKind::Camera(CameraNode::default())),
    ];
    let mut ids = vec![group, ball];
    ids.extend(others.into_iter().map(|node| scene.insert(None, 1, node).unwrap()));
    (scene, ids)
}

#[test]
fn every_control_of_every_panel_has_a_name_and_a_tooltip() {
    let (scene, ids) = everything();
    let mut harness = open_sized(scene, 4000.0);
    let mut known = BTreeSet::new();
    let mut found = faults(&mut harness, &mut known);
    for id in ids {
        harness.state_mut().document_mut().select(vec![id]);
        harness.run_steps(4);
        found.extend(faults(&mut harness, &mut known));
    }
    assert!(found.is_empty(), "{} of {}: {found:#?}", found.len(), known.len());
    assert!(known.len() > 150, "{}", known.len());
}

#[test]
fn a_control_without_name_or_tooltip_is_found() {
    let mut harness =
        Harness::builder().with_size(egui::vec2(300.0, 200.0)).with_accessibility_check(false).build_ui(|ui| {
            ui.button("Told").on_hover_text("What it does");
            _ = ui.button("Untold");
            _ = ui.button("");
        });
    harness.run();
    let found = faults(&mut harness, &mut BTreeSet::new());
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].contains("“Untold” without a tooltip") && found[1].contains("without a name"), "{found:?}");
}
