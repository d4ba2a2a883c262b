//! The budget for the pixels of all images of a scene. A change that exceeds it is refused, since the resulting scene
//! could not be read again.

use std::sync::Arc;

use super::limits::MAX_SCENE_PIXELS;
use super::{Attached, Environment, Mask, Material, Node, NodeKind, ParamValue, Params, SceneError, Shape};

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
    let masks = if let NodeKind::Instancer(instancer) = &node.kind { &instancer.masks[..] } else { &[] };
    let of_masks = masks.iter().filter_map(|slot| match &slot.mask {
        Mask::Image { image, .. } => Some(Attached::Texture(image.clone())),
        _ => None,
    });
    shape.into_iter().chain(of_modifiers).chain(of_masks).filter(|image| pixels(image) > 0).collect()
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
        Attached::Environment(image) => image.content().map_or(0, |image| image.pixels),
        Attached::Font(_) => 0,
    }
}

/// Whether both are the same file, decoded once.
fn is_same(a: &Attached, b: &Attached) -> bool {
    match (a, b) {
        (Attached::Heights(a), Attached::Heights(b)) => a.is_same(b),
        (Attached::Texture(a), Attached::Texture(b)) => a.is_same(b),
        (Attached::Environment(a), Attached::Environment(b)) => a.is_same(b),
        _ => false,
    }
}

/// The parts of a scene that may hold images.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImageHolders<'a> {
    /// The nodes.
    pub nodes: &'a [Arc<Node>],
    /// The materials.
    pub materials: &'a [Arc<Material>],
    /// The environment.
    pub environment: &'a Environment,
}

impl ImageHolders<'_> {
    /// All images but those of this node, this material and, if it is replaced, the environment.
    fn others(self, node: Option<&Node>, material: Option<&Material>, environment: bool) -> Vec<Attached> {
        let nodes = self.nodes.iter().filter(|held| node.is_none_or(|node| node.id != held.id));
        let materials = self.materials.iter().filter(|held| material.is_none_or(|material| material.id != held.id));
        let around = (!environment).then(|| image_around(self.environment)).flatten();
        let of_nodes = nodes.flat_map(|node| images(node));
        of_nodes.chain(materials.flat_map(|material| images_of_material(material))).chain(around).collect()
    }
}

/// The image of an environment.
fn image_around(environment: &Environment) -> Option<Attached> {
    environment.image().cloned().map(Attached::Environment)
}

/// Refuses `new` nodes whose images would exceed the budget of a scene: it could not be read again. `old` is the node
/// that they replace.
pub(super) fn check(scene: ImageHolders<'_>, old: Option<&Node>, new: &[Node]) -> Result<(), SceneError> {
    let added: Vec<_> = new.iter().flat_map(images).collect();
    let there = old.map(images).unwrap_or_default();
    if are_known(&added, &there) {
        return Ok(());
    }
    check_sum(scene.others(old, None, false).into_iter().chain(added))
}

/// The same for a `new` material, which may replace one of the same id.
pub(super) fn check_material(scene: ImageHolders<'_>, new: &Material) -> Result<(), SceneError> {
    let added = images_of_material(new);
    let old = scene.materials.iter().find(|old| old.id == new.id);
    let there = old.map(|old| images_of_material(old)).unwrap_or_default();
    if are_known(&added, &there) {
        return Ok(());
    }
    check_sum(scene.others(None, Some(new), false).into_iter().chain(added))
}

/// The same for a new environment.
pub(super) fn check_environment(scene: ImageHolders<'_>, new: &Environment) -> Result<(), SceneError> {
    let Some(added) = image_around(new) else { return Ok(()) };
    check_sum(scene.others(None, None, true).into_iter().chain([added]))
}

/// The pixels of all images of a scene.
pub(super) fn used(scene: ImageHolders<'_>) -> u64 {
    sum(scene.others(None, None, false).into_iter())
}

fn are_known(added: &[Attached], there: &[Attached]) -> bool {
    added.iter().all(|image| there.iter().any(|known| is_same(known, image)))
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
