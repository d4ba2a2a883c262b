//! The node hierarchy: which mesh stands where.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use gltf::json::{Root, scene::Node};

use super::error::Refusal;
use super::limits::MAX_NODES;

/// A mesh of the document with its place in the file's space.
pub(super) struct Placed {
    pub mesh: usize,
    pub world_from_local: DAffine3,
}

/// Every mesh that the default scene shows, in depth-first order. Without a default scene the first
/// one counts; without any, every tree.
///
/// Skins and morph targets are not applied: a mesh stands as it is stored.
pub(super) fn placed_meshes(root: &Root) -> Result<Vec<Placed>, Refusal> {
    if root.nodes.len() > MAX_NODES {
        return Err(Refusal::at("nodes", format!("has {} entries, more than {MAX_NODES}", root.nodes.len())));
    }
    let parents = check_forest(root)?;
    let scene = root.scene.map(|s| s.value()).unwrap_or(0);
    let tops: Vec<usize> = match root.scenes.get(scene) {
        Some(scene) => scene.nodes.iter().map(|n| n.value()).collect(),
        None => (0..root.nodes.len()).filter(|n| parents[*n].is_none()).collect(),
    };
    let mut seen = vec![false; root.nodes.len()];
    let mut out = Vec::new();
    let mut open: Vec<(usize, DAffine3)> = tops.iter().rev().map(|n| (*n, DAffine3::IDENTITY)).collect();
    while let Some((index, world_from_parent)) = open.pop() {
        let place = format!("nodes[{index}]");
        if std::mem::replace(&mut seen[index], true) {
            return Err(Refusal::at(format!("scenes[{scene}].nodes"), format!("shows node {index} twice")));
        }
        let node = &root.nodes[index];
        let world_from_local = world_from_parent * local_transform(node, &place)?;
        if !world_from_local.is_finite() {
            return Err(Refusal::at(place, "stands infinitely far away"));
        }
        if let Some(mesh) = node.mesh {
            out.push(Placed { mesh: mesh.value(), world_from_local });
        }
        open.extend(node.children.iter().flatten().rev().map(|c| (c.value(), world_from_local)));
    }
    Ok(out)
}

/// The parent of each node. Refuses nodes with two parents and nodes that are their own ancestors, so
/// that a walk from the top ends.
fn check_forest(root: &Root) -> Result<Vec<Option<usize>>, Refusal> {
    let mut parents = vec![None; root.nodes.len()];
    for (index, node) in root.nodes.iter().enumerate() {
        for (c, child) in node.children.iter().flatten().enumerate() {
            if let Some(other) = parents[child.value()].replace(index) {
                let reason = format!("is node {}, which is a child of node {other} already", child.value());
                return Err(Refusal::at(format!("nodes[{index}].children[{c}]"), reason));
            }
        }
    }
    // With one parent each, what cannot be reached from a parentless node is on a cycle or below one.
    let mut reached = vec![false; root.nodes.len()];
    let mut open: Vec<usize> = (0..root.nodes.len()).filter(|n| parents[*n].is_none()).collect();
    while let Some(index) = open.pop() {
        reached[index] = true;
        open.extend(root.nodes[index].children.iter().flatten().map(|c| c.value()));
    }
    match reached.iter().position(|r| !r) {
        Some(index) => Err(Refusal::at(format!("nodes[{index}]"), "is its own ancestor, or below one that is")),
        None => Ok(parents),
    }
}

fn local_transform(node: &Node, place: &str) -> Result<DAffine3, Refusal> {
    let refuse = |field: &str, reason: &str| Err(Refusal::at(format!("{place}.{field}"), reason));
    if let Some(m) = node.matrix {
        if m.iter().any(|v| !v.is_finite()) {
            return refuse("matrix", "holds a number that is not finite");
        }
        let m = DMat4::from_cols_array(&m.map(f64::from));
        if m.row(3) != glam::DVec4::W {
            return refuse("matrix", "is not affine");
        }
        return Ok(DAffine3::from_mat3_translation(DMat3::from_mat4(m), m.w_axis.truncate()));
    }
    let vector = |v: Option<[f32; 3]>, default: DVec3| v.map_or(default, |v| DVec3::from(v.map(f64::from)));
    let (translation, scale) = (vector(node.translation, DVec3::ZERO), vector(node.scale, DVec3::ONE));
    if !translation.is_finite() {
        return refuse("translation", "holds a number that is not finite");
    }
    if !scale.is_finite() {
        return refuse("scale", "holds a number that is not finite");
    }
    let rotation = DQuat::from_array(node.rotation.unwrap_or_default().0.map(f64::from));
    if !rotation.is_finite() || rotation.length() < 1e-6 {
        return refuse("rotation", "is not a rotation");
    }
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation.normalize(), translation))
}
