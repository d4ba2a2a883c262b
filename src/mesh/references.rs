//! Checks that every reference in a document leads to an entry, so that later steps need not check.

use super::accessor::{ComponentType, ElementShape};
use super::error::LoadRefusal;
use super::schema::{Accessor, Primitive, Root, Whole};

/// Refuses the first reference without a target, and codes that glTF does not define.
pub(super) fn check_references(root: &Root) -> Result<(), LoadRefusal> {
    for (i, accessor) in root.accessors.iter().enumerate() {
        check_accessor(root, accessor, &format!("accessors[{i}]"))?;
    }
    for (i, view) in root.buffer_views.iter().enumerate() {
        check("buffer", Some(view.buffer), root.buffers.len(), || format!("bufferViews[{i}].buffer"))?;
    }
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            check_primitive(root, primitive, &format!("meshes[{m}].primitives[{p}]"))?;
        }
    }
    for (i, node) in root.nodes.iter().enumerate() {
        check("mesh", node.mesh, root.meshes.len(), || format!("nodes[{i}].mesh"))?;
        check("skin", node.skin, root.skins.len(), || format!("nodes[{i}].skin"))?;
        for (c, child) in node.children.iter().enumerate() {
            check("node", Some(*child), root.nodes.len(), || format!("nodes[{i}].children[{c}]"))?;
        }
    }
    for (i, scene) in root.scenes.iter().enumerate() {
        for (n, node) in scene.nodes.iter().enumerate() {
            check("node", Some(*node), root.nodes.len(), || format!("scenes[{i}].nodes[{n}]"))?;
        }
    }
    check("scene", root.scene, root.scenes.len(), || "scene".into())?;
    for (i, skin) in root.skins.iter().enumerate() {
        check("accessor", skin.inverse_bind_matrices, root.accessors.len(), || {
            format!("skins[{i}].inverseBindMatrices")
        })?;
        for (j, joint) in skin.joints.iter().enumerate() {
            check("node", Some(*joint), root.nodes.len(), || format!("skins[{i}].joints[{j}]"))?;
        }
    }
    check_surfaces(root)
}

fn check_surfaces(root: &Root) -> Result<(), LoadRefusal> {
    for (i, image) in root.images.iter().enumerate() {
        check("bufferView", image.buffer_view, root.buffer_views.len(), || format!("images[{i}].bufferView"))?;
    }
    for (i, texture) in root.textures.iter().enumerate() {
        check("image", texture.source, root.images.len(), || format!("textures[{i}].source"))?;
        check("sampler", texture.sampler, root.samplers.len(), || format!("textures[{i}].sampler"))?;
    }
    for (i, material) in root.materials.iter().enumerate() {
        for (info, field) in material.textures() {
            check("texture", info.map(|i| i.index), root.textures.len(), || format!("materials[{i}].{field}.index"))?;
        }
    }
    Ok(())
}

fn check_accessor(root: &Root, accessor: &Accessor, place: &str) -> Result<(), LoadRefusal> {
    let views = root.buffer_views.len();
    check("bufferView", accessor.buffer_view, views, || format!("{place}.bufferView"))?;
    let wrong = |field: &str| Err(LoadRefusal::at(format!("{place}.{field}"), "has a value that glTF does not allow"));
    if ComponentType::of(accessor.component_type).is_none() {
        return wrong("componentType");
    }
    if ElementShape::of(&accessor.kind).is_none() {
        return wrong("type");
    }
    if let Some(sparse) = &accessor.sparse {
        check("bufferView", Some(sparse.indices.buffer_view), views, || format!("{place}.sparse.indices.bufferView"))?;
        check("bufferView", Some(sparse.values.buffer_view), views, || format!("{place}.sparse.values.bufferView"))?;
        if !ComponentType::of(sparse.indices.component_type).is_some_and(ComponentType::is_index) {
            return wrong("sparse.indices.componentType");
        }
    }
    Ok(())
}

fn check_primitive(root: &Root, primitive: &Primitive, place: &str) -> Result<(), LoadRefusal> {
    let accessors = root.accessors.len();
    if !primitive.attributes.contains_key("POSITION") {
        return Err(LoadRefusal::at(format!("{place}.attributes.POSITION"), "is missing"));
    }
    for (name, accessor) in &primitive.attributes {
        check("accessor", Some(*accessor), accessors, || format!("{place}.attributes.{name}"))?;
    }
    for (t, target) in primitive.targets.iter().enumerate() {
        for (name, accessor) in target {
            check("accessor", Some(*accessor), accessors, || format!("{place}.targets[{t}].{name}"))?;
        }
    }
    check("accessor", primitive.indices, accessors, || format!("{place}.indices"))?;
    check("material", primitive.material, root.materials.len(), || format!("{place}.material"))?;
    if primitive.mode.is_some_and(|mode| mode.0 > 6) {
        return Err(LoadRefusal::at(format!("{place}.mode"), "has a value that glTF does not allow"));
    }
    Ok(())
}

fn check(kind: &str, index: Option<Whole>, count: usize, place: impl Fn() -> String) -> Result<(), LoadRefusal> {
    match index {
        Some(index) if index.index() >= count => {
            Err(LoadRefusal::at(place(), format!("names {kind} {}, which is missing", index.0)))
        }
        _ => Ok(()),
    }
}
