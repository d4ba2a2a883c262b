//! Thumbnails of documents.

use std::io::Cursor;

use image::{ImageFormat, RgbImage};

/// Longest sides of a thumbnail, in pixels.
pub const THUMBNAIL_PX: [u32; 2] = [192, 120];

/// A small picture of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Thumbnail(RgbImage);

impl Thumbnail {
    /// A thumbnail of a picture of this size; `pixel` returns its pixels by column and row. `None` if the picture is
    /// empty.
    pub fn of(size_px: [u32; 2], pixel: impl Fn(u32, u32) -> [u8; 3]) -> Option<Self> {
        let [width, height] = size_px;
        if width == 0 || height == 0 {
            return None;
        }
        let shrink = |axis: usize| f64::from(THUMBNAIL_PX[axis]) / f64::from(size_px[axis]);
        let scale = shrink(0).min(shrink(1)).min(1.0);
        let small = size_px.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        // Samples the middle of each small pixel: fast, and exact enough to recognize a scene.
        let at = |i: u32, axis: usize| {
            let place = (f64::from(i) + 0.5) / f64::from(small[axis]) * f64::from(size_px[axis]);
            (place as u32).min(size_px[axis] - 1)
        };
        Some(Self(RgbImage::from_fn(small[0], small[1], |x, y| image::Rgb(pixel(at(x, 0), at(y, 1))))))
    }

    /// Encodes it as a PNG file.
    pub(super) fn to_png(&self) -> Option<Vec<u8>> {
        let mut bytes = Cursor::new(Vec::new());
        self.0.write_to(&mut bytes, ImageFormat::Png).ok()?;
        Some(bytes.into_inner())
    }

    /// Decodes a PNG file of ours; `None` if it is another file.
    pub(super) fn from_png(bytes: &[u8]) -> Option<Self> {
        let mut reader = image::ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        let mut limits = image::Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(THUMBNAIL_PX[0]), Some(THUMBNAIL_PX[1]));
        reader.limits(limits);
        Some(Self(reader.decode().ok()?.into_rgb8()))
    }

    /// Width and height.
    pub fn size_px(&self) -> [u32; 2] {
        [self.0.width(), self.0.height()]
    }

    /// Rows from the top, three bytes per pixel.
    pub fn bytes(&self) -> &[u8] {
        self.0.as_raw()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_shrink_keep_their_sides_and_survive_as_files() {
        let halves = |x: u32, _: u32| if x < 500 { [255, 0, 0] } else { [0, 0, 255] };
        let small = Thumbnail::of([1000, 500], halves).unwrap();
        assert_eq!(small.size_px(), [192, 96]);
        assert_eq!((&small.bytes()[..3], &small.bytes()[191 * 3..192 * 3]), (&[255, 0, 0][..], &[0, 0, 255][..]));
        assert_eq!(Thumbnail::from_png(&small.to_png().unwrap()), Some(small));
        assert_eq!(Thumbnail::of([10, 5], halves).unwrap().size_px(), [10, 5]);
        assert_eq!(Thumbnail::of([1, 100_000], halves).unwrap().size_px(), [1, 120]);
        assert_eq!(Thumbnail::of([0, 5], halves), None);
        assert_eq!(Thumbnail::from_png(b"no picture"), None);
        let large = RgbImage::new(400, 300);
        assert_eq!(Thumbnail::from_png(&Thumbnail(large).to_png().unwrap()), None, "not one of ours");
    }
}
