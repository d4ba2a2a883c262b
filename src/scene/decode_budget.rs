//! The budget of what is decoded while a scene is read. A small file may hold many large images, each of which takes long
//! to read; so all that are read for one scene are counted, from what their first bytes say, before they are.

use std::any::Any;
use std::cell::RefCell;
use std::sync::Arc;

use super::limits::{MAX_IMAGE_BYTES, MAX_IMAGE_SIDE, MAX_SCENE_PIXELS};

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

/// Refuses an image of this size that takes so many bytes as pixels; else how many pixels it has.
pub(super) fn check_size([width, height]: [u64; 2], bytes: u64) -> Result<u64, String> {
    let most = u64::from(MAX_IMAGE_SIDE);
    if width > most || height > most {
        return Err(format!("it must be at most {most} pixels wide and high, not {width} by {height}"));
    }
    if bytes > MAX_IMAGE_BYTES {
        return Err(format!("its pixels take more than {} MiB", MAX_IMAGE_BYTES >> 20));
    }
    Ok(width * height)
}
