//! How many pixels the images of a scene have together. A small file may hold many large images, each of which takes long
//! to read; so all that are read for one scene are counted, from what their first bytes say, before they are.

use std::any::Any;
use std::cell::RefCell;
use std::sync::Arc;

use super::limits::MAX_SCENE_PIXELS;
use super::{Attached, Attachment, Heights, Node, NodeKind, ParamValue, SceneError, Shape};

/// What was read for the scene that is being read on this thread.
#[derive(Default)]
struct Reading {
    pixels: u64,
    /// Each file once: copies of a node hold the same one.
    files: Vec<Arc<dyn Any + Send + Sync>>,
}

thread_local! {
    static READING: RefCell<Option<Reading>> = const { RefCell::new(None) };
}

/// Counts together all that `read` reads.
pub(super) fn within<T>(read: impl FnOnce() -> T) -> T {
    struct Ended;
    impl Drop for Ended {
        fn drop(&mut self) {
            READING.set(None);
        }
    }
    READING.set(Some(Reading::default()));
    let _ended = Ended;
    read()
}

/// Takes so many pixels out of the budget, or says that they are not in it.
pub(super) fn spend(pixels: u64) -> Result<(), String> {
    let sum = READING.with_borrow_mut(|reading| {
        let Some(reading) = reading else { return pixels };
        reading.pixels = reading.pixels.saturating_add(pixels);
        reading.pixels
    });
    if sum > MAX_SCENE_PIXELS {
        return Err(format!("with it the images of the scene take more than {} megapixels", MAX_SCENE_PIXELS >> 20));
    }
    Ok(())
}

/// The file that was read before and is meant.
pub(super) fn known<T: Any + Send + Sync>(is_meant: impl Fn(&T) -> bool) -> Option<Arc<T>> {
    READING.with_borrow(|reading| {
        let files = reading.as_ref()?.files.iter();
        files.filter_map(|file| Arc::clone(file).downcast::<T>().ok()).find(|file| is_meant(file))
    })
}

/// Keeps a file in mind until the scene is read.
pub(super) fn remember<T: Any + Send + Sync>(file: &Arc<T>) {
    READING.with_borrow_mut(|reading| {
        if let Some(reading) = reading {
            reading.files.push(Arc::clone(file) as _);
        }
    });
}

/// The images that a node holds.
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

/// Refuses `new` nodes whose images a scene of `nodes` has no room for: it could not be read again. `old` is replaced.
pub(super) fn check(nodes: &[Arc<Node>], old: Option<&Node>, new: &[Node]) -> Result<(), SceneError> {
    let added: Vec<_> = new.iter().flat_map(images).collect();
    let there = old.map(images).unwrap_or_default();
    if added.iter().all(|image| there.iter().any(|known| known.is_same(image))) {
        return Ok(());
    }
    let others = nodes.iter().filter(|node| old.is_none_or(|old| old.id != node.id)).flat_map(|node| images(node));
    let mut counted: Vec<Attachment<Heights>> = Vec::new();
    let mut pixels = 0;
    for image in others.chain(added) {
        if !counted.iter().any(|known| known.is_same(&image)) {
            pixels += image.content().map_or(0, |heights| heights.pixels);
            counted.push(image);
        }
    }
    if pixels > MAX_SCENE_PIXELS {
        return Err(SceneError::Limit { what: "the pixels of all images", limit: MAX_SCENE_PIXELS as usize });
    }
    Ok(())
}
