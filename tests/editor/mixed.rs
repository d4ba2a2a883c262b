//! Every parameter of every kind of node: where two selected nodes differ, its field shows a dash.

use std::collections::{BTreeMap, BTreeSet};

use egui::accesskit::{Role, Toggled};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::document::Edit;
use isolith::editor::Editor;
use isolith::scene::{
    Blend, BlendKernel, CameraNode, DynamicKind, Falloff, Group, Instancer, Lattice, Light, LightKind, MaskKind,
    MaterialId, ModifierKind, Node, NodeId, NodeKind, Object, Operator, Param, ParamValue, Part, Scene, ShapeKind,
    check,
};

use super::open_sized;

/// Another value that is allowed for a parameter; `None` if the node has no other.
fn other_value(node: &Node, part: Part, name: &str, param: &'static Param, value: &ParamValue) -> Option<Node> {
    let candidates: Vec<ParamValue> = match value {
        ParamValue::Scalar(v) => {
            [v + 0.1, v * 1.5, v * 0.75, v - 0.1, v + 1.0, v + 10.0].into_iter().map(ParamValue::Scalar).collect()
        }
        ParamValue::Count(n) => [n + 1, n.saturating_sub(1)].map(ParamValue::Count).to_vec(),
        ParamValue::Vector(v) => [*v + 0.1, *v * 0.75, *v + 1.0].map(ParamValue::Vector).to_vec(),
        ParamValue::Counts(n) => vec![ParamValue::Counts(n.map(|n| n + 1))],
        ParamValue::Flag(on) => vec![ParamValue::Flag(!on)],
        ParamValue::Flags(on) => vec![ParamValue::Flags(on.map(|on| !on))],
        ParamValue::Choice(key) => param
            .choices
            .iter()
            .filter(|choice| choice.key != *key)
            .map(|choice| ParamValue::Choice(&choice.key))
            .collect(),
        ParamValue::Text(text) => vec![ParamValue::Text(format!("{text}x"))],
        ParamValue::List(list) => {
            let mut list = list.clone();
            list.rows.first_mut()?[0] += 0.01;
            vec![ParamValue::List(list)]
        }
        ParamValue::File(_) | ParamValue::Rotation(_) => Vec::new(),
    };
    candidates.into_iter().find_map(|candidate| {
        let mut changed = node.clone();
        let is_set = part.params_mut(&mut changed)?.set(name, candidate);
        (is_set && changed != *node && check::node(&changed).is_ok()).then_some(changed)
    })
}

/// A node of every kind of shape, operator, light, lattice, mask, modifier and motion.
fn specimens(material: MaterialId) -> Vec<Node> {
    let object = |kind: ShapeKind| NodeKind::Object(Object { shape: kind.default_shape(), material });
    let mut nodes: Vec<Node> = ShapeKind::ALL.iter().map(|kind| Node::new("Node", object(*kind))).collect();
    let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 1.0, range: 5.0 };
    let point = LightKind::Point { power: 1.0, radius: 0.1, falloff };
    let spot = LightKind::Spot { power: 1.0, radius: 0.1, falloff, inner: 10.0, outer: 20.0 };
    let sun = Light::sun();
    let lights = [point, spot, LightKind::RECTANGLE].map(Light::new).into_iter().chain([sun]);
    nodes.extend(lights.map(|light| Node::new("Node", NodeKind::Light(light))));
    nodes.push(Node::new("Node", NodeKind::Camera(CameraNode { aperture: 0.1, ..CameraNode::default() })));
    nodes.extend(
        Operator::ALL
            .iter()
            .map(|operator| Node::new("Node", NodeKind::Group(Group { operator: *operator, ..Group::UNION }))),
    );
    let grid = Lattice::Grid { counts: [2; 3], spacing: [1.0; 3] };
    let polar = Lattice::Polar { count: 6, rings: 2, radius: 2.0, spacing: 1.0 };
    for lattice in [grid, Lattice::Hexagonal { counts: [2; 3], spacing: 1.0, height: 1.0 }, polar] {
        let masks = MaskKind::ALL.iter().map(|kind| kind.default_mask().into()).collect();
        let instancer = Instancer { lattice, masks, ..Instancer::default() };
        nodes.push(Node::new("Node", NodeKind::Instancer(Box::new(instancer))));
    }
    for kernel in BlendKernel::ALL {
        let blend = Blend { kernel, ..Group::UNION.blend };
        nodes.push(Node::new("Node", NodeKind::Group(Group { blend, ..Group::UNION })));
    }
    let mut snapping = nodes.iter().rev().find(|node| matches!(node.kind, NodeKind::Instancer(_))).unwrap().clone();
    let mut all = parameters(&snapping).into_iter();
    let (part, name, param, value) = all.find(|(_, name, ..)| name == "snap").unwrap();
    snapping = other_value(&snapping, part, &name, param, &value).unwrap();
    nodes.push(snapping);
    for kind in ModifierKind::ALL {
        let mut node = Node::new("Node", object(ShapeKind::Sphere));
        node.modifiers.push(kind.default_modifier().into());
        nodes.push(node);
    }
    for kind in DynamicKind::ALL {
        let mut node = Node::new("Node", object(ShapeKind::Sphere));
        node.dynamics.push(kind.default_dynamic().into());
        nodes.push(node);
    }
    nodes
}

/// Whether one of the fields of this name shows that values differ; `None` if there is no field.
fn shows_dash(harness: &Harness<'_, Editor>, label: &str) -> Option<bool> {
    let names = [label.to_owned(), format!("{label} X"), format!("{label} Y"), format!("{label} Z")];
    let mut found = None;
    for name in names {
        for node in harness.query_all_by_label(&name) {
            let node = node.accesskit_node();
            if node.role() == Role::Label {
                continue;
            }
            let value = node.value().unwrap_or_default();
            let is_dash = value.starts_with('–')
                || node.toggled() == Some(Toggled::Mixed)
                || node.placeholder().is_some_and(|text| text == "–");
            *found.get_or_insert(false) |= is_dash;
        }
    }
    found
}

/// The parameters that a node has, with their names and values.
fn parameters(node: &Node) -> Vec<(Part, String, &'static Param, ParamValue)> {
    let mut all = Vec::new();
    for part in Part::of(node) {
        if let Some(params) = part.params(node) {
            params.visit("", &mut |prefix, param, value| {
                all.push((part, format!("{prefix}{}", param.name), param, value));
            });
        }
    }
    all
}

/// What names the field of a parameter.
fn label_of(node: &Node, part: Part, param: &'static Param) -> String {
    match (part, param.name) {
        (Part::Modifier(at), "enabled") => node.modifiers[at].modifier.kind().label().to_owned(),
        (Part::Dynamic(at), "enabled") => node.dynamics[at].dynamic.kind().label().to_owned(),
        (_, "visible") => "Show".to_owned(),
        (_, "seed_locked") => "Unlock the seed".to_owned(),
        _ => param.label.to_string(),
    }
}

#[test]
fn a_field_of_any_parameter_shows_a_dash_where_two_nodes_differ() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let plain = Node::new("Node", NodeKind::Object(Object { shape: ShapeKind::Sphere.default_shape(), material }));
    let parent = scene.insert(None, 0, Node::new("Parent", NodeKind::Group(Group::UNION))).unwrap();
    let ids = [0, 1].map(|place| scene.insert(Some(parent), place, plain.clone()).unwrap());
    let (mut seen, mut missing, mut faults) = (BTreeSet::new(), BTreeMap::new(), Vec::new());
    let mut harness = open_sized(scene.clone(), 4000.0);
    let specimens = specimens(material);
    for node in &specimens {
        // One other node that differs in all that it can. What is locked is not moved, so that its place is not compared.
        let mut differing = node.clone();
        let mut wanted = Vec::new();
        for (part, name, param, value) in parameters(node) {
            // A choice may replace the fields beside it: the specimens have each of them.
            let is_choice = matches!(value, ParamValue::Choice(_)) && part != Part::Node;
            // The march belongs to what stands at the top, weights to the types of an instancer.
            let is_elsewhere = part == Part::March || ["locked", "weight"].contains(&param.name);
            if !is_choice
                && !is_elsewhere
                && let Some(changed) = other_value(&differing, part, &name, param, &value)
            {
                differing = changed;
                wanted.push((part, name, param, value));
            }
        }
        show_pair(&mut harness, &scene, ids, [node.clone(), differing.clone()]);
        for (part, name, param, value) in wanted {
            let key = (format!("{:?}", std::mem::discriminant(&part)), name);
            let told = format!("{}: {} ({})", what(node), param.label, param.name);
            let shown = match value {
                ParamValue::List(_) => Some(harness.query_all_by_label("–").next().is_some()),
                _ => shows_dash(&harness, &label_of(&differing, part, param)),
            };
            match shown {
                Some(true) => _ = seen.insert(key),
                Some(false) => faults.push(told),
                // Many are shown only where they have an effect: one specimen must show them.
                None => _ = missing.insert(key, told),
            }
        }
    }
    faults.extend(
        missing.into_iter().filter(|(key, _)| !seen.contains(key)).map(|(_, told)| format!("no field: {told}")),
    );
    assert!(faults.is_empty(), "{} of {}: {faults:#?}", faults.len(), seen.len() + faults.len());
    assert!(seen.len() > 150, "{}", seen.len());
    // Equal nodes have none: the look at a field can fail.
    show_pair(&mut harness, &scene, ids, [specimens[0].clone(), specimens[0].clone()]);
    assert_eq!(shows_dash(&harness, "Radius"), Some(false));
}

#[test]
fn locks_and_weights_that_differ_show_a_dash() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let instancer = NodeKind::Instancer(Box::default());
    let parent = scene.insert(None, 0, Node::new("Copies", instancer)).unwrap();
    let ids = [0, 1].map(|place| {
        let shape = ShapeKind::Sphere.default_shape();
        let mut node = Node::new("Type", NodeKind::Object(Object { shape, material }));
        (node.locked, node.weight) = (place == 1, 1.0 + place as f64);
        scene.insert(Some(parent), place, node).unwrap()
    });
    let mut harness = open_sized(scene, 2000.0);
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run_steps(3);
    assert_eq!(shows_dash(&harness, "Unlock"), Some(true));
    assert_eq!(shows_dash(&harness, "Weight"), Some(true));
    harness.state_mut().document_mut().select(vec![ids[1]]);
    harness.run_steps(3);
    assert_eq!(shows_dash(&harness, "Unlock"), Some(false));
}

#[test]
fn settings_of_the_march_that_differ_show_a_dash() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let object = NodeKind::Object(Object { shape: ShapeKind::Sphere.default_shape(), material });
    let plain = Node::new("Ball", object);
    let all: Vec<_> = parameters(&plain).into_iter().filter(|(part, ..)| *part == Part::March).collect();
    let mut other = plain.clone();
    for (part, name, param, value) in &all {
        other = other_value(&other, *part, name, param, value).unwrap_or_else(|| panic!("no other {name}"));
    }
    let ids = [plain, other].map(|node| scene.insert(None, 0, node).unwrap());
    let mut harness = open_sized(scene, 3000.0);
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run_steps(3);
    let folded = harness.query_by_label("Ray march").map(|node| node.rect().center());
    if let Some(at) = folded.filter(|_| shows_dash(&harness, &all[0].2.label).is_none()) {
        super::click(&mut harness, at);
        harness.run_steps(20);
    }
    for (_, name, param, _) in &all {
        assert_eq!(shows_dash(&harness, &param.label), Some(true), "{name}");
    }
}

/// Selects two nodes like these.
fn show_pair(harness: &mut Harness<'_, Editor>, scene: &Scene, ids: [NodeId; 2], nodes: [Node; 2]) {
    let mut scene = scene.clone();
    for (id, node) in ids.into_iter().zip(nodes) {
        let parent = scene.node(id).unwrap().parent;
        scene.replace(Node { id, parent, ..node }).unwrap();
    }
    for id in ids {
        let node = Node::clone(scene.node(id).unwrap());
        harness.state_mut().document_mut().apply(Edit::Replace(node)).unwrap();
    }
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run_steps(3);
    // What is rarely needed is folded at first.
    let folded = harness.query_by_label("Falloff (advanced)").map(|node| node.rect().center());
    if let Some(at) = folded.filter(|_| harness.query_all_by_label("Quadratic").next().is_none()) {
        super::click(harness, at);
        harness.run_steps(20);
    }
}

fn what(node: &Node) -> String {
    let list = |text: Option<String>| text.map_or(String::new(), |text| format!(" with {text}"));
    let modifier = node.modifiers.first().map(|slot| slot.modifier.kind().label().to_owned());
    let dynamic = node.dynamics.first().map(|slot| slot.dynamic.kind().label().to_owned());
    let kind = match &node.kind {
        NodeKind::Object(object) => object.shape.kind().label().to_owned(),
        NodeKind::Group(group) => format!("{:?}", group.operator),
        NodeKind::Light(light) => format!("{:?}", light.light).split(' ').next().unwrap_or_default().to_owned(),
        NodeKind::Instancer(_) => "Instancer".to_owned(),
        NodeKind::Camera(_) => "Camera".to_owned(),
        NodeKind::Mesh(_) => "Mesh".to_owned(),
    };
    format!("{kind}{}{}", list(modifier), list(dynamic))
}
