//! Base colour textures.

use std::io::Cursor;

use gltf::json::image::Image;
use image::{ImageFormat, ImageReader, Limits};

use super::Texture;
use super::limits::{MAX_IMAGE_SIDE, MAX_TEXTURE_BYTES};

/// Decodes a PNG or JPEG file into 8-bit sRGB; `budget` is how many bytes all further textures may
/// take. The error is a reason for people.
pub(super) fn decode(bytes: &[u8], budget: &mut u64) -> Result<Texture, String> {
    let format = match bytes {
        [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
        [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
        _ => return Err("is neither PNG nor JPEG".into()),
    };
    let cannot = |e: image::ImageError| format!("cannot be decoded: {e}");
    let (width, height) = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().map_err(cannot)?;
    if width == 0 || height == 0 || width > MAX_IMAGE_SIDE || height > MAX_IMAGE_SIDE {
        return Err(format!("is {width} × {height} pixels; 1 to {MAX_IMAGE_SIDE} a side are allowed"));
    }
    let size = u64::from(width) * u64::from(height) * 4;
    *budget = budget.checked_sub(size).ok_or_else(|| {
        format!("is {width} × {height} pixels; the textures together would take more than {MAX_TEXTURE_BYTES} bytes")
    })?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_IMAGE_SIDE);
    limits.max_image_height = Some(MAX_IMAGE_SIDE);
    // 16 bits per channel are twice what is kept, and a decoder holds a copy.
    limits.max_alloc = Some(4 * MAX_TEXTURE_BYTES);
    reader.limits(limits);
    let rgba = reader.decode().map_err(cannot)?.into_rgba8();
    Ok(Texture { width: rgba.width(), height: rgba.height(), rgba: rgba.into_raw() })
}

/// Where an image's bytes are.
pub(super) enum Place<'a> {
    View(gltf::json::Index<gltf::json::buffer::View>),
    Uri(&'a str),
}

/// Where this image's bytes are; `None` where the file does not say.
pub(super) fn place_of(image: &Image) -> Option<Place<'_>> {
    image.buffer_view.map(Place::View).or_else(|| image.uri.as_deref().map(Place::Uri))
}
