//! Faults that nodes themselves show, without an evaluation.

use std::collections::HashSet;

use super::finding::{Finding, FindingKind, Repair};
use crate::FlatScene;
use isolith_scene::{Node, NodeId, NodeKind, Operation, Scene};

/// A scale beyond these loses digits of f32, or makes a number of meters unreadable.
const SCALES: [f64; 2] = [1e-3, 1e3];
/// A scale whose axes differ by more than this makes steps as much smaller.
const MOST_UNEVEN: f64 = 20.0;

/// The findings, in the order of the nodes.
pub fn findings(scene: &Scene, flat: &FlatScene) -> Vec<Finding> {
    let seen: HashSet<NodeId> = flat.ids.iter().copied().collect();
    let mut found = Vec::new();
    // Whether a node is not drawn, for a reason that is told elsewhere or wanted.
    let mut passed_by: HashSet<NodeId> = HashSet::new();
    for node in scene.nodes() {
        if !node.visible || node.parent.is_some_and(|parent| passed_by.contains(&parent)) {
            passed_by.insert(node.id);
            continue;
        }
        found.extend(extreme_scale(node));
        if let Some(finding) = hidden_first(scene, node) {
            found.push(finding);
            passed_by.insert(node.id);
        } else if let Some(finding) = empty(scene, node, &seen) {
            found.push(finding);
        }
    }
    found
}

/// A group that needs its first operand, which is hidden, though others are shown.
fn hidden_first(scene: &Scene, node: &Node) -> Option<Finding> {
    let NodeKind::Group(group) = &node.kind else { return None };
    let is_operand = |child: &&std::sync::Arc<Node>| matches!(child.kind, NodeKind::Group(_) | NodeKind::Object(_));
    let mut operands = scene.children(Some(node.id)).filter(is_operand);
    let first = operands.next().filter(|first| !first.visible && group.operator.needs_first())?;
    let shown = operands.filter(|child| child.visible).count();
    let waiting = if shown == 1 { "one operand waits".to_owned() } else { format!("{shown} operands wait") };
    (shown > 0).then(|| Finding {
        node: first.id,
        kind: FindingKind::HiddenFirst,
        detail: format!("{waiting} for it in {}", node.name),
        place: None,
        repair: Some(Repair::Show(first.id)),
    })
}

/// An object without an entry, or a group without a content.
fn empty(scene: &Scene, node: &Node, seen: &HashSet<NodeId>) -> Option<Finding> {
    let (detail, repair) = match &node.kind {
        NodeKind::Object(_) if !seen.contains(&node.id) => match is_cut(scene, node) {
            true => return Some(cuts_nothing(node.id)),
            false => ("the shape has no size or no content".to_owned(), None),
        },
        NodeKind::Group(_) if scene.children(Some(node.id)).next().is_none() => {
            ("a group without content".to_owned(), Some(Repair::Delete(node.id)))
        }
        _ => return None,
    };
    Some(Finding { node: node.id, kind: FindingKind::Empty, detail, place: None, repair })
}

/// Whether the node is cut from what stands before it.
fn is_cut(scene: &Scene, node: &Node) -> bool {
    let parent = node.parent.and_then(|parent| scene.node(parent));
    let subtracts = |parent: &Node| match &parent.kind {
        NodeKind::Group(group) => group.operator.needs_first(),
        _ => false,
    };
    node.operation == Operation::Subtract || parent.is_some_and(|parent| subtracts(parent))
}

/// The finding about an operand that cuts nothing.
pub fn cuts_nothing(node: NodeId) -> Finding {
    let detail = "it does not touch what it is cut from".to_owned();
    Finding { node, kind: FindingKind::CutsNothing, detail, place: None, repair: Some(Repair::Hide(node)) }
}

fn extreme_scale(node: &Node) -> Option<Finding> {
    let scale = node.transform.scale.abs();
    let (least, most) = (scale.min_element(), scale.max_element());
    let detail = if least < SCALES[0] {
        format!("one axis is scaled by {least:.2e}")
    } else if most > SCALES[1] {
        format!("one axis is scaled by {most:.2e}")
    } else if most > MOST_UNEVEN * least {
        format!("its axes are scaled unevenly, by up to {:.0} times", most / least)
    } else {
        return None;
    };
    let repair = Some(Repair::ResetScale(node.id));
    Some(Finding { node: node.id, kind: FindingKind::ExtremeScale, detail, place: None, repair })
}
