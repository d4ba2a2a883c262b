//! Every parameter of every kind of node: where two selected nodes differ, its field shows a dash.

use egui::accesskit::{Role, Toggled};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::editor::Editor;
use isolith::scene::{
    CameraNode, DynamicKind, Falloff, Group, Instancer, Lattice, Light, LightKind, MaskKind, MaterialId, ModifierKind,
    Node, NodeId, NodeKind, Object, Operator, Param, ParamValue, Part, Scene, ShapeKind, check,
};

use super::open_sized;

/// Parameters without a field: a file is chosen rather than compared, an orientation stands as three angles, a motion
/// between two moments as keys. The fields of these names stand in a list that is closed at first, or under another name.
const ELSEWHERE: &[&str] = &[];

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
    let lights = [point, spot, LightKind::RECTANGLE].map(|light| Light::new(light)).into_iter().chain([sun]);
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

#[test]
fn a_field_of_any_parameter_shows_a_dash_where_two_nodes_differ() {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let specimens = specimens(material);
    let plain = Node::new("Node", NodeKind::Object(Object { shape: ShapeKind::Sphere.default_shape(), material }));
    let ids = [scene.insert(None, 0, plain.clone()).unwrap(), scene.insert(None, 1, plain).unwrap()];
    let (mut seen, mut faults) = (0, Vec::new());
    let mut harness = open_sized(scene.clone(), 4000.0);
    for node in &specimens {
        // One other node that differs in all that it can.
        let mut differing = node.clone();
        let mut wanted: Vec<&'static Param> = Vec::new();
        for part in Part::of(node) {
            let mut all = Vec::new();
            if let Some(params) = part.params(node) {
                params
                    .visit("", &mut |prefix, param, value| all.push((format!("{prefix}{}", param.name), param, value)));
            }
            for (name, param, value) in all {
                // A choice may replace the fields beside it: those are looked at in the specimens of each choice.
                if matches!(value, ParamValue::Choice(_)) && node.name == "Node" && part != Part::Node {
                    continue;
                }
                if let Some(changed) = other_value(&differing, part, &name, param, &value) {
                    differing = changed;
                    wanted.push(param);
                }
            }
        }
        show_pair(&mut harness, &scene, ids, [node.clone(), differing]);
        let kind = what(node);
        for param in wanted {
            match shows_dash(&harness, &param.label) {
                Some(true) => seen += 1,
                Some(false) => faults.push(format!("{kind}: {} ({})", param.label, param.name)),
                None if ELSEWHERE.contains(&param.name) => {}
                None => faults.push(format!("{kind}: no field {} ({})", param.label, param.name)),
            }
        }
    }
    assert!(faults.is_empty(), "{} of {}: {faults:#?}", faults.len(), seen + faults.len());
    assert!(seen > 300, "{seen}");
    // Equal nodes have none: the look at a field can fail.
    show_pair(&mut harness, &scene, ids, [specimens[0].clone(), specimens[0].clone()]);
    assert_eq!(shows_dash(&harness, "Radius"), Some(false));
}

/// Selects two nodes like these.
fn show_pair(harness: &mut Harness<'_, Editor>, scene: &Scene, ids: [NodeId; 2], nodes: [Node; 2]) {
    let mut scene = scene.clone();
    for (id, node) in ids.into_iter().zip(nodes) {
        scene.replace(Node { id, parent: None, ..node }).unwrap();
    }
    let nodes = scene.nodes().to_vec();
    for node in nodes {
        harness.state_mut().document_mut().apply(isolith::document::Edit::Replace(Node::clone(&node))).unwrap();
    }
    harness.state_mut().document_mut().select(ids.to_vec());
    harness.run_steps(3);
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
