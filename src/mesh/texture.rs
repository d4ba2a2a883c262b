//! Textures: decoded within a budget, and sampled as a renderer does.

use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

use glam::{DVec2, DVec4};
use image::{DynamicImage, ImageDecoder as _, ImageFormat, ImageReader, Limits};

use super::limits::{MAX_DECODER_BYTES, MAX_IMAGE_SIDE, MAX_TEXTURE_BYTES};

/// An image.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Rows from the top, four bytes per pixel; colors are sRGB with straight alpha.
    pub rgba: Vec<u8>,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Texture({} × {})", self.width, self.height)
    }
}

/// Textures by the index of their image in the file.
pub(super) type SharedTextures = HashMap<usize, Arc<Texture>>;

/// The wrapping mode beyond the edge of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Repeats the texture.
    #[default]
    Repeat,
    /// Repeats the texture, every other time mirrored.
    Mirror,
    /// Extends the color of the edge.
    Clamp,
}

/// A sampler. There are no mipmaps, so one filter serves near and far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Along U and V.
    pub wrap: [Wrap; 2],
    /// Nearest pixel instead of bilinear filtering.
    pub nearest: bool,
}

impl Texture {
    /// Samples the texture at (u, v): `color` converts a pixel's bytes to numbers before they are filtered.
    pub fn sample(&self, sampler: Sampler, u: f64, v: f64, color: impl Fn([u8; 4]) -> DVec4) -> DVec4 {
        let size = [self.width, self.height].map(i64::from);
        let texel = |x: i64, y: i64| {
            let (x, y) = (wrapped(sampler.wrap[0], x, size[0]), wrapped(sampler.wrap[1], y, size[1]));
            let start = 4 * (y * size[0] + x) as usize;
            color(std::array::from_fn(|i| self.rgba[start + i]))
        };
        let at = DVec2::new(u * size[0] as f64, v * size[1] as f64);
        if sampler.nearest {
            return texel(at.x.floor() as i64, at.y.floor() as i64);
        }
        let at = at - 0.5;
        let (corner, part) = (at.floor(), at - at.floor());
        let (x, y) = (corner.x as i64, corner.y as i64);
        let (right, below) = (x.saturating_add(1), y.saturating_add(1));
        texel(x, y).lerp(texel(right, y), part.x).lerp(texel(x, below).lerp(texel(right, below), part.x), part.y)
    }
}

/// The pixel of `size` at coordinate `at`, after wrapping.
fn wrapped(wrap: Wrap, at: i64, size: i64) -> i64 {
    match wrap {
        Wrap::Repeat => at.rem_euclid(size),
        Wrap::Clamp => at.clamp(0, size - 1),
        Wrap::Mirror => {
            let at = at.rem_euclid(2 * size);
            if at < size { at } else { 2 * size - 1 - at }
        }
    }
}

/// Decodes a PNG or JPEG file into 8-bit sRGB; `budget` is the number of bytes left for further textures. The header
/// tells the size before anything is decoded. The error is a reason for the user.
pub(super) fn decode(bytes: &[u8], budget: &mut u64) -> Result<Texture, String> {
    let format = match bytes {
        [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
        [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
        _ => return Err("is neither PNG nor JPEG".into()),
    };
    let cannot = |e: image::ImageError| format!("cannot be decoded: {e}");
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(cannot)?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 || width > MAX_IMAGE_SIDE || height > MAX_IMAGE_SIDE {
        return Err(format!("is {width} × {height} pixels; 1 to {MAX_IMAGE_SIDE} a side are allowed"));
    }
    let size = u64::from(width) * u64::from(height) * 4;
    let left = budget.checked_sub(size).ok_or_else(|| {
        format!("is {width} × {height} pixels; the textures of the scene together would take more than {MAX_TEXTURE_BYTES} bytes")
    })?;
    // 16 bits per channel take twice the kept size.
    if decoder.total_bytes() > MAX_DECODER_BYTES {
        return Err(format!("takes {} bytes to decode, more than {MAX_DECODER_BYTES}", decoder.total_bytes()));
    }
    let rgba = DynamicImage::from_decoder(decoder).map_err(cannot)?.into_rgba8();
    *budget = left;
    Ok(Texture { width: rgba.width(), height: rgba.height(), rgba: rgba.into_raw() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_beyond_the_edge() {
        let row = |wrap| -> Vec<i64> { (-4..7).map(|at| wrapped(wrap, at, 3)).collect() };
        assert_eq!(row(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }

    #[test]
    fn a_lookup_anywhere_is_one_of_the_pixels_or_between() {
        let texture = Texture { width: 2, height: 1, rgba: vec![0, 0, 0, 0, 255, 255, 255, 255] };
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for nearest in [true, false] {
                for u in [-1e300, -3.2, 0.0, 0.25, 0.5, 0.75, 1.0, 1e18, 1e300] {
                    let sampler = Sampler { wrap: [wrap; 2], nearest };
                    let red = texture.sample(sampler, u, 0.5, |[r, ..]| DVec4::splat(r.into())).x;
                    assert!((0.0..=255.0).contains(&red), "{wrap:?} {u}: {red}");
                }
            }
        }
        let at = |nearest, u| {
            texture.sample(Sampler { nearest, ..Default::default() }, u, 0.5, |[r, ..]| DVec4::splat(r.into())).x
        };
        assert_eq!([at(true, 0.4), at(true, 0.6), at(false, 0.25), at(false, 0.5)], [0.0, 255.0, 0.0, 127.5]);
    }
}
