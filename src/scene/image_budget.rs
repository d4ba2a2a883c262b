//! The budget for the pixels of all images of a scene. A change that exceeds it is refused, since the resulting scene
//! could not be read again.

use std::sync::Arc;

use super::limits::MAX_SCENE_PIXELS;
use super::{Attached, Attachment, Environment, Heights, Node, NodeKind, ParamValue, SceneError, Shape};

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
pub(super) fn check(
    nodes: &[Arc<Node>],
    environment: &Environment,
    old: Option<&Node>,
    new: &[Node],
) -> Result<(), SceneError> {
    let added: Vec<_> = new.iter().flat_map(images).collect();
    let there = old.map(images).unwrap_or_default();
    if added.iter().all(|image| there.iter().any(|known| known.is_same(image))) {
        return Ok(());
    }
    let others = nodes.iter().filter(|node| old.is_none_or(|old| old.id != node.id)).flat_map(|node| images(node));
    let mut counted: Vec<Attachment<Heights>> = Vec::new();
    let mut pixels = pixels_around(environment);
    for image in others.chain(added) {
        if !counted.iter().any(|known| known.is_same(&image)) {
            pixels += image.content().map_or(0, |heights| heights.pixels);
            counted.push(image);
        }
    }
    within(pixels)
}

/// Refuses an environment whose image would exceed the budget of a scene of `nodes`.
pub fn check_environment(nodes: &[Arc<Node>], environment: &Environment) -> Result<(), SceneError> {
    let mut counted: Vec<Attachment<Heights>> = Vec::new();
    for image in nodes.iter().flat_map(|node| images(node)) {
        if !counted.iter().any(|known| known.is_same(&image)) {
            counted.push(image);
        }
    }
    let of_nodes: u64 = counted.iter().filter_map(|image| image.content()).map(|heights| heights.pixels).sum();
    within(of_nodes + pixels_around(environment))
}

/// The pixels of the environment's image.
fn pixels_around(environment: &Environment) -> u64 {
    environment.image().and_then(Attachment::content).map_or(0, |image| image.pixels)
}

fn within(pixels: u64) -> Result<(), SceneError> {
    if pixels > MAX_SCENE_PIXELS {
        return Err(SceneError::Limit { what: "the pixels of all images", limit: MAX_SCENE_PIXELS as usize });
    }
    Ok(())
}
