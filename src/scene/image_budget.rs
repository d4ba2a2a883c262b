//! The budget for the pixels of all images of a scene. A change that exceeds it is refused, since the resulting scene
//! could not be read again.

use std::sync::Arc;

use super::limits::MAX_SCENE_PIXELS;
use super::{Attached, Attachment, Heights, Node, NodeKind, ParamValue, SceneError, Shape};

/// The images of a node.
fn images(node: &Node) -> Vec<Attachment<Heights>> {
    let shape = match &node.kind {
        NodeKind::Object(object) => match &object.shape {
            Shape::Heightmap { image, .. } => Some(image.clone()),
            _ => None,
        },
        _ => None,
    };
    let values = node.modifiers.iter().flat_map(|slot| slot.modifier.values());
    let of_modifiers = values.filter_map(|value| match value {
        ParamValue::File(Attached::Heights(image)) => Some(image),
        _ => None,
    });
    shape.into_iter().chain(of_modifiers).filter(|image| image.content().is_some()).collect()
}

/// Refuses `new` nodes whose images would exceed the budget of a scene of `nodes`: it could not be read again. `old` is
/// the node that they replace.
pub(super) fn check(nodes: &[Arc<Node>], old: Option<&Node>, new: &[Node]) -> Result<(), SceneError> {
    let added: Vec<_> = new.iter().flat_map(images).collect();
    let there = old.map(images).unwrap_or_default();
    if added.iter().all(|image| there.iter().any(|known| known.is_same(image))) {
        return Ok(());
    }
    let others = nodes.iter().filter(|node| old.is_none_or(|old| old.id != node.id)).flat_map(|node| images(node));
    if pixels(others.chain(added)) > MAX_SCENE_PIXELS {
        return Err(SceneError::Limit { what: "the pixels of all images", limit: MAX_SCENE_PIXELS as usize });
    }
    Ok(())
}

/// The pixels of images, each file counted once.
fn pixels(images: impl Iterator<Item = Attachment<Heights>>) -> u64 {
    let mut counted: Vec<Attachment<Heights>> = Vec::new();
    let mut pixels = 0;
    for image in images {
        if !counted.iter().any(|known| known.is_same(&image)) {
            pixels += image.content().map_or(0, |heights| heights.pixels);
            counted.push(image);
        }
    }
    pixels
}

/// The pixels of all images of these nodes.
pub(super) fn used(nodes: &[Arc<Node>]) -> u64 {
    pixels(nodes.iter().flat_map(|node| images(node)))
}
