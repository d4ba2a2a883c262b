//! Models as triangles and as fields: conversion of nodes in place.

use super::edit_session::EditSession;
use isolith_document::Edit;
use isolith_scene::{MeshNode, ModelFile, Node, NodeKind, Object, Scene, Shape};

/// Whether the selection has a model that is drawn as triangles.
pub fn can_become_field(session: &EditSession) -> bool {
    session.selected().iter().any(|node| matches!(node.kind, NodeKind::Mesh(_)))
}

/// Whether the selection has the field of a model.
pub fn can_become_mesh(session: &EditSession) -> bool {
    session.selected().iter().any(|node| mesh_of(node).is_some())
}

/// Makes fields of the selected models.
pub fn to_fields(session: &mut EditSession) {
    convert(session, field_of);
}

/// Makes models that are drawn as triangles of the selected fields.
pub fn to_meshes(session: &mut EditSession) {
    convert(session, |node, _| mesh_of(node));
}

/// Replaces the selected nodes by what `to` makes of them, as one step.
fn convert(session: &mut EditSession, to: impl Fn(&Node, &Scene) -> Option<Node>) {
    let scene = session.document.scene().clone();
    let new: Vec<Node> = session.selected().iter().filter_map(|node| to(node, &scene)).collect();
    session.together(|session| {
        for node in new {
            session.apply(Edit::Replace(node));
        }
    });
}

/// The field of a model that is drawn as triangles. Without a material of its own it shows those of its file; where they
/// have nothing to say, the first of the scene.
fn field_of(node: &Node, scene: &Scene) -> Option<Node> {
    let NodeKind::Mesh(MeshNode { path, material, clip, clip_time, .. }) = &node.kind else { return None };
    let shape = Shape::MeshField {
        file: ModelFile::new(path.clone()),
        clip: clip.clone(),
        clip_time: *clip_time,
        resolution: 0.0,
        voxel_size: 0.0,
        file_materials: material.is_none(),
    };
    let material = material.or_else(|| scene.materials().first().map(|material| material.id))?;
    Some(Node { kind: NodeKind::Object(Object { shape, material }), ..node.clone() })
}

/// The triangles of a field; what only fields can have is left out.
fn mesh_of(node: &Node) -> Option<Node> {
    let NodeKind::Object(Object { shape: Shape::MeshField { file, clip, clip_time, file_materials, .. }, material }) =
        &node.kind
    else {
        return None;
    };
    if file.path.is_empty() {
        return None;
    }
    let own = (!file_materials).then_some(*material);
    let mesh =
        MeshNode { clip: clip.clone(), clip_time: *clip_time, material: own, ..MeshNode::new(file.path.clone()) };
    let plain = Node::new(node.name.clone(), NodeKind::Mesh(mesh));
    Some(Node {
        id: node.id,
        parent: node.parent,
        visible: node.visible,
        locked: node.locked,
        transform: node.transform,
        weight: node.weight,
        ..plain
    })
}
