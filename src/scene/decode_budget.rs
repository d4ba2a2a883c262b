//! The budget for decoding attachments while a scene is read. A small file may hold many large images, each of which
//! takes long to decode. So their pixels are summed up from the image headers before any of them is decoded.

use std::any::Any;
use std::cell::RefCell;
use std::sync::Arc;

use super::limits::{MAX_IMAGE_BYTES, MAX_IMAGE_SIDE, MAX_SCENE_PIXELS};

/// The attachments of the scene that this thread is reading.
#[derive(Default)]
struct Reading {
    pixels: u64,
    /// Each file once: copies of a node share it.
    files: Vec<Arc<dyn Any + Send + Sync>>,
}

thread_local! {
    static READING: RefCell<Option<Reading>> = const { RefCell::new(None) };
}

/// Runs `read` with one budget for everything that it decodes.
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

/// Takes pixels out of the budget. The error says that the budget is exceeded.
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

/// Finds a file that was decoded before.
pub(super) fn known<T: Any + Send + Sync>(is_meant: impl Fn(&T) -> bool) -> Option<Arc<T>> {
    READING.with_borrow(|reading| {
        let files = reading.as_ref()?.files.iter();
        files.filter_map(|file| Arc::clone(file).downcast::<T>().ok()).find(|file| is_meant(file))
    })
}

/// Remembers a file until the scene is read.
pub(super) fn remember<T: Any + Send + Sync>(file: &Arc<T>) {
    READING.with_borrow_mut(|reading| {
        if let Some(reading) = reading {
            reading.files.push(Arc::clone(file) as _);
        }
    });
}

/// The number of pixels of an image. Refuses a side, or a size in bytes, above the limits.
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
