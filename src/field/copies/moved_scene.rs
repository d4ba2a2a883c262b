//! The scene at a moment: with what its tracks, the dynamics of its nodes and running waves change.

use std::borrow::Cow;
use std::sync::Arc;

use glam::DVec3;

use super::dynamics::{CopyMotion, copy_motion};
use super::instancer::FlatDynamic;
use isolith_scene::check::Fault;
use isolith_scene::{DynamicKind, Node, NodeId, NodeKind, Object, Scene, Shape};

/// The scene at `time`, and the nodes that stay at rest because their tracks contradict each other.
pub(crate) fn scene_at(scene: &Scene, time: f64) -> (Cow<'_, Scene>, Vec<(NodeId, Fault)>) {
    let (mut shown, faults) = scene.at_with_faults(time);
    if shown.nodes().iter().any(|node| moves(node)) {
        let nodes =
            shown.nodes().iter().map(|node| if moves(node) { Arc::new(moved(node, time)) } else { node.clone() });
        let nodes = nodes.collect();
        // Only values change, so the table stays valid.
        let _ = shown.to_mut().set_nodes(nodes);
    }
    (shown, faults)
}

/// Whether it changes with time by itself. The dynamics of an instancer are those of its copies.
fn moves(node: &Node) -> bool {
    let has_dynamics = node.dynamics.iter().any(|slot| slot.enabled) && !matches!(node.kind, NodeKind::Instancer(_));
    has_dynamics || ocean_speed(node) != 0.0
}

fn ocean_speed(node: &Node) -> f64 {
    match &node.kind {
        NodeKind::Object(Object { shape: Shape::Ocean { speed, .. }, .. }) => *speed,
        _ => 0.0,
    }
}

fn moved(node: &Node, time: f64) -> Node {
    let mut out = node.clone();
    let speed = ocean_speed(node);
    if let NodeKind::Object(Object { shape: Shape::Ocean { phase, .. }, .. }) = &mut out.kind {
        *phase += 360.0 * speed * time;
    }
    if matches!(node.kind, NodeKind::Instancer(_)) {
        return out;
    }
    let seed = node.id.0 as u32;
    let dynamics = node_dynamics(node, time, seed);
    let CopyMotion { translation, rotation, scale, .. } =
        copy_motion(&dynamics, seed, [0; 3], node.transform.translation);
    out.transform.translation += translation;
    out.transform.rotation = (rotation * node.transform.rotation).normalize();
    out.transform.scale *= DVec3::splat(scale);
    out
}

/// The enabled dynamics of a node at `time`.
pub(crate) fn node_dynamics(node: &Node, time: f64, seed: u32) -> Vec<FlatDynamic> {
    let enabled = node.dynamics.iter().enumerate().filter(|(_, slot)| slot.enabled);
    enabled.map(|(at, slot)| FlatDynamic::new(&slot.dynamic, time, at, seed)).collect()
}

/// Dynamics of a node that show on copies only.
pub(crate) fn unseen_dynamics(node: &Node) -> Option<&'static str> {
    if matches!(node.kind, NodeKind::Instancer(_)) {
        return None;
    }
    let mut kinds = node.dynamics.iter().filter(|slot| slot.enabled).map(|slot| slot.dynamic.kind());
    kinds.find(|kind| matches!(kind, DynamicKind::Flicker | DynamicKind::ColorCycle)).map(DynamicKind::label)
}
