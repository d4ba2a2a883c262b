//! The budget for the pixels of all images of a scene. A change that exceeds it is refused, since the resulting scene
//! could not be read again.

use std::sync::Arc;

use super::limits::MAX_SCENE_PIXELS;
use super::{Attached, Material, Node, NodeKind, ParamValue, Params, SceneError, Shape};

/// The images of a node.
fn images(node: &Node) -> Vec<Attached> {
    let shape = match &node.kind {
        NodeKind::Object(object) => match &object.shape {
            Shape::Heightmap { image, .. } => Some(Attached::Heights(image.clone())),
            _ => None,
        },
        _ => None,
    };
    let values = node.modifiers.iter().flat_map(|slot| slot.modifier.values());
    let of_modifiers = values.filter_map(|value| match value {
        ParamValue::File(image @ Attached::Heights(_)) => Some(image),
        _ => None,
    });
    shape.into_iter().chain(of_modifiers).filter(|image| pixels(image) > 0).collect()
}

/// The images of a material.
fn images_of_material(material: &Material) -> Vec<Attached> {
    let mut found = Vec::new();
    if !material.textures.is_none() {
        material.visit("", &mut |_, _, value| {
            if let ParamValue::File(image) = value {
                found.push(image);
            }
        });
    }
    found
}

/// Number of decoded pixels.
fn pixels(image: &Attached) -> u64 {
    match image {
        Attached::Heights(image) => image.content().map_or(0, |heights| heights.pixels),
        Attached::Texture(image) => image.content().map_or(0, |texture| texture.pixels),
        Attached::Font(_) => 0,
    }
}

/// Whether both are the same file, decoded once.
fn is_same(a: &Attached, b: &Attached) -> bool {
    match (a, b) {
        (Attached::Heights(a), Attached::Heights(b)) => a.is_same(b),
        (Attached::Texture(a), Attached::Texture(b)) => a.is_same(b),
        _ => false,
    }
}

/// Refuses `new` nodes whose images would exceed the budget of a scene of `nodes` and `materials`: it could not be read
/// again. `old` is the node that they replace.
pub(super) fn check(
    nodes: &[Arc<Node>],
    materials: &[Arc<Material>],
    old: Option<&Node>,
    new: &[Node],
) -> Result<(), SceneError> {
    let added: Vec<_> = new.iter().flat_map(images).collect();
    let there = old.map(images).unwrap_or_default();
    if added.iter().all(|image| there.iter().any(|known| is_same(known, image))) {
        return Ok(());
    }
    let others = nodes.iter().filter(|node| old.is_none_or(|old| old.id != node.id)).flat_map(|node| images(node));
    let of_materials = materials.iter().flat_map(|material| images_of_material(material));
    check_sum(others.chain(of_materials).chain(added))
}

/// The same for a `new` material, which may replace one of the same id.
pub(super) fn check_material(
    nodes: &[Arc<Node>],
    materials: &[Arc<Material>],
    new: &Material,
) -> Result<(), SceneError> {
    let added = images_of_material(new);
    let old = materials.iter().find(|old| old.id == new.id);
    let there = old.map(|old| images_of_material(old)).unwrap_or_default();
    if added.iter().all(|image| there.iter().any(|known| is_same(known, image))) {
        return Ok(());
    }
    let others = materials.iter().filter(|old| old.id != new.id).flat_map(|material| images_of_material(material));
    check_sum(nodes.iter().flat_map(|node| images(node)).chain(others).chain(added))
}

fn check_sum(images: impl Iterator<Item = Attached>) -> Result<(), SceneError> {
    if sum(images) > MAX_SCENE_PIXELS {
        return Err(SceneError::Limit { what: "the pixels of all images", limit: MAX_SCENE_PIXELS as usize });
    }
    Ok(())
}

/// The pixels of images, each file counted once.
fn sum(images: impl Iterator<Item = Attached>) -> u64 {
    let mut counted: Vec<Attached> = Vec::new();
    let mut sum = 0;
    for image in images {
        if !counted.iter().any(|known| is_same(known, &image)) {
            sum += pixels(&image);
            counted.push(image);
        }
    }
    sum
}

/// The pixels of all images of these nodes and materials.
pub(super) fn used(nodes: &[Arc<Node>], materials: &[Arc<Material>]) -> u64 {
    let of_materials = materials.iter().flat_map(|material| images_of_material(material));
    sum(nodes.iter().flat_map(|node| images(node)).chain(of_materials))
}
