//! The node hierarchy: the placement of each mesh.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use super::clip::{NodePose, Poses};
use super::error::LoadRefusal;
use super::limits::MAX_NODES;
use super::schema::{GltfNode, Root};

/// The nodes of a document.
pub(super) struct Forest {
    /// The transform of each node to the file's space.
    pub world_from_node: Vec<DAffine3>,
    /// The nodes with meshes in the shown scene, in depth-first order.
    pub shown: Vec<usize>,
}

/// Traverses the hierarchy, with what a clip sets. Shows the default scene; without a default the first scene; without any scene, every tree.
pub(super) fn walk(root: &Root, poses: &Poses) -> Result<Forest, LoadRefusal> {
    if root.nodes.len() > MAX_NODES {
        return Err(LoadRefusal::at("nodes", format!("has {} entries, more than {MAX_NODES}", root.nodes.len())));
    }
    let (parents, order) = check_forest(root)?;
    // Joints of skins may stand outside of the scene, so every node gets a transform.
    let mut world_from_node = vec![DAffine3::IDENTITY; root.nodes.len()];
    for index in order {
        let local = local_transform(&root.nodes[index], poses.get(&index), &format!("nodes[{index}]"))?;
        let parent = parents[index].map_or(DAffine3::IDENTITY, |parent| world_from_node[parent]);
        world_from_node[index] = parent * local;
    }
    let shown = shown_nodes(root, &parents)?;
    match shown.iter().find(|index| !world_from_node[**index].is_finite()) {
        Some(index) => Err(LoadRefusal::at(format!("nodes[{index}]"), "stands infinitely far away")),
        None => Ok(Forest { world_from_node, shown }),
    }
}

/// The index of the shown scene.
pub(super) fn shown_scene(root: &Root) -> usize {
    root.scene.map_or(0, |scene| scene.index())
}

fn shown_nodes(root: &Root, parents: &[Option<usize>]) -> Result<Vec<usize>, LoadRefusal> {
    let scene = shown_scene(root);
    let tops: Vec<usize> = match root.scenes.get(scene) {
        Some(scene) => scene.nodes.iter().map(|n| n.index()).collect(),
        None => (0..root.nodes.len()).filter(|n| parents[*n].is_none()).collect(),
    };
    let mut seen = vec![false; root.nodes.len()];
    let mut shown = Vec::new();
    let mut open: Vec<usize> = tops.iter().rev().copied().collect();
    while let Some(index) = open.pop() {
        if std::mem::replace(&mut seen[index], true) {
            return Err(LoadRefusal::at(format!("scenes[{scene}].nodes"), format!("shows node {index} twice")));
        }
        let node = &root.nodes[index];
        if node.mesh.is_some() {
            shown.push(index);
        }
        open.extend(node.children.iter().rev().map(|c| c.index()));
    }
    Ok(shown)
}

/// The parent of each node, and all nodes with parents before children. Refuses nodes with two parents and nodes that
/// are their own ancestors, so that a traversal from the top ends.
fn check_forest(root: &Root) -> Result<(Vec<Option<usize>>, Vec<usize>), LoadRefusal> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for (c, child) in node.children.iter().enumerate() {
            if let Some(other) = parents[child.index()].replace(index) {
                let reason = format!("is node {}, which is a child of node {other} already", child.0);
                return Err(LoadRefusal::at(format!("nodes[{index}].children[{c}]"), reason));
            }
        }
    }
    // With one parent each, a node that no root reaches is on a cycle or below one.
    let mut reached = vec![false; root.nodes.len()];
    let mut order: Vec<usize> = (0..root.nodes.len()).filter(|n| parents[*n].is_none()).collect();
    let mut next = 0;
    while next < order.len() {
        let index = order[next];
        reached[index] = true;
        order.extend(root.nodes[index].children.iter().map(|c| c.index()));
        next += 1;
    }
    match reached.iter().position(|r| !r) {
        Some(index) => Err(LoadRefusal::at(format!("nodes[{index}]"), "is its own ancestor, or below one that is")),
        None => Ok((parents, order)),
    }
}

/// Exporters that compute in f32 leave an error of this size in the last row of a matrix, which should be 0 0 0 1.
const ROUNDING: f64 = 1e-5;

fn local_transform(node: &GltfNode, pose: Option<&NodePose>, place: &str) -> Result<DAffine3, LoadRefusal> {
    let refuse = |field: &str, reason: &str| Err(LoadRefusal::at(format!("{place}.{field}"), reason));
    let pose = pose.filter(|pose| pose.translation.is_some() || pose.rotation.is_some() || pose.scale.is_some());
    // A clip moves nodes by translation, rotation and scale, so a matrix beside it has no part (specification, 3.5.3).
    if let Some(m) = node.matrix.as_ref().filter(|_| pose.is_none()) {
        if m.iter().any(|v| !v.is_finite()) {
            return refuse("matrix", "holds a number that is not finite");
        }
        let m = DMat4::from_cols_array(m);
        let last = m.row(3);
        if last.w == 0.0 || last.truncate().abs().max_element() > ROUNDING * last.w.abs() {
            return refuse("matrix", "is not affine");
        }
        // A last component other than 1 scales the whole matrix.
        let m = m * (1.0 / last.w);
        return Ok(DAffine3::from_mat3_translation(DMat3::from_mat4(m), m.w_axis.truncate()));
    }
    let set = |of: fn(&NodePose) -> Option<DVec3>| pose.and_then(of);
    let own = |value: Option<[f64; 3]>, default: DVec3| value.map_or(default, DVec3::from);
    let translation = set(|pose| pose.translation).unwrap_or_else(|| own(node.translation, DVec3::ZERO));
    let scale = set(|pose| pose.scale).unwrap_or_else(|| own(node.scale, DVec3::ONE));
    if !translation.is_finite() {
        return refuse("translation", "holds a number that is not finite");
    }
    if !scale.is_finite() {
        return refuse("scale", "holds a number that is not finite");
    }
    let rotation = pose.and_then(|pose| pose.rotation);
    let rotation = rotation.or(node.rotation.map(DQuat::from_array)).unwrap_or(DQuat::IDENTITY);
    if !rotation.is_finite() || rotation.length() < 1e-6 {
        return refuse("rotation", "is not a rotation");
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation.normalize(), translation))
}
