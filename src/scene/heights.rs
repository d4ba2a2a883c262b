//! Heights from an image, as a grid that is drawn as a smooth surface.

use std::io::Cursor;
use std::sync::LazyLock;

use image::imageops::{FilterType, resize};
use image::{GrayImage, ImageFormat, ImageReader, Limits, Luma};

use super::attachment::{Attachment, Content};
use super::limits::{MAX_HEIGHTS, MAX_IMAGE_SIDE};

/// A grid of heights from 0 to 1, line by line; each stands in the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Columns and lines; at least 1, at most [`MAX_HEIGHTS`].
    pub size: [usize; 2],
    /// The heights.
    pub values: Vec<f64>,
}

impl Heights {
    /// The height in a cell; beyond the border that of the nearest one.
    pub fn at(&self, column: isize, line: isize) -> f64 {
        let [x, z] = [(column, self.size[0]), (line, self.size[1])].map(|(i, n)| i.clamp(0, n as isize - 1) as usize);
        self.values[z * self.size[0] + x]
    }

    /// Those of an image; where there is none, a hill.
    pub fn of(image: &Attachment<Self>) -> &Self {
        static HILL: LazyLock<Heights> = LazyLock::new(Heights::hill);
        image.content().unwrap_or(&HILL)
    }

    /// A round hill with a dent.
    fn hill() -> Self {
        const SIDE: usize = 24;
        let bump = |x: f64, z: f64, wide: f64| (-(x * x + z * z) / (wide * wide)).exp();
        let height = |i: usize| {
            let [x, z] = [i % SIDE, i / SIDE].map(|k| 2.0 * (k as f64 + 0.5) / SIDE as f64 - 1.0);
            (bump(x, z, 0.55) - 0.5 * bump(x - 0.15, z - 0.2, 0.25)).clamp(0.0, 1.0)
        };
        Self { size: [SIDE; 2], values: (0..SIDE * SIDE).map(height).collect() }
    }
}

impl Attachment<Heights> {
    /// An image of so many columns and lines, at least 1 of each, as a PNG file of this name; `level` says how white each
    /// pixel is, up to 255.
    pub fn drawn(name: &str, [columns, lines]: [u32; 2], level: impl Fn(u32, u32) -> u8) -> Self {
        let mut file = Cursor::new(Vec::new());
        let pixels = GrayImage::from_fn(columns, lines, |x, y| Luma([level(x, y)]));
        pixels.write_to(&mut file, ImageFormat::Png).expect("memory takes all");
        Self::new(name, file.into_inner()).expect("a small image that was just written can be read")
    }
}

impl Content for Heights {
    const WHAT: &'static str = "a PNG, JPEG or EXR image";
    const WITHOUT: &'static str = "A hill";
    const ENDINGS: &'static [&'static str] = &["png", "jpg", "jpeg", "exr"];

    /// Black is 0, white 1; what is brighter is cut. Larger images are made smaller, by the means of their pixels.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_IMAGE_SIDE), Some(MAX_IMAGE_SIDE));
        reader.limits(limits);
        let image = reader.decode().map_err(|e| e.to_string())?.into_luma16();
        let (width, height) = image.dimensions();
        let factor = (MAX_HEIGHTS as f64 / f64::from(width.max(height))).min(1.0);
        let [columns, lines] = [width, height].map(|n| ((f64::from(n) * factor).round() as u32).max(1));
        let image = if factor < 1.0 { resize(&image, columns, lines, FilterType::Triangle) } else { image };
        let values = image.pixels().map(|p| f64::from(p.0[0]) / f64::from(u16::MAX)).collect();
        Ok(Self { size: [columns as usize, lines as usize], values })
    }
}

#[cfg(test)]
mod tests {
    use image::{DynamicImage, ImageBuffer};

    use super::*;

    fn png(width: u32, height: u32, value: impl Fn(u32, u32) -> u16) -> Vec<u8> {
        let image = ImageBuffer::from_fn(width, height, |x, y| Luma([value(x, y)]));
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::ImageLuma16(image).write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn small_images_keep_every_pixel_and_large_ones_their_means() {
        let small = Heights::read(&png(3, 2, |x, y| (1000 * x + 7 * y) as u16)).unwrap();
        assert_eq!(small.size, [3, 2]);
        assert_eq!(small.at(2, 1), 2007.0 / 65535.0);
        assert_eq!(small.at(-5, 9), small.at(0, 1));
        let large = Heights::read(&png(1024, 512, |x, _| if x % 2 == 0 { 0 } else { 60_000 })).unwrap();
        assert_eq!(large.size, [MAX_HEIGHTS, MAX_HEIGHTS / 2]);
        assert!((large.at(50, 50) - 30_000.0 / 65535.0).abs() < 0.02);
        let drawn = Attachment::drawn("x.png", [2, 3], |x, y| (100 * x + 50 * y) as u8);
        let drawn = drawn.content().unwrap();
        assert_eq!((drawn.size, drawn.at(1, 2), drawn.at(0, 1)), ([2, 3], 200.0 / 255.0, 50.0 / 255.0));
        // A line of pixels stays a line.
        assert_eq!(Heights::read(&png(2000, 1, |_, _| 9)).unwrap().size, [MAX_HEIGHTS, 1]);
    }
}
