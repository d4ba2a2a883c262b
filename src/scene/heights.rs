//! Heights from an image, as a grid for a smooth surface.

pub(super) mod exr;

use std::io::Cursor;
use std::sync::LazyLock;

use image::imageops::{FilterType, resize};
use image::metadata::Orientation;
use image::{DynamicImage, GrayImage, ImageBuffer, ImageFormat, Luma, Primitive, guess_format};

use super::attachment::{Attachment, Content};
use super::image_file;
use super::limits::MAX_HEIGHTS;

/// A grid of heights from 0 to 1, row by row; each height belongs to the middle of its cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Columns and rows; at least 1, at most [`MAX_HEIGHTS`].
    pub size: [usize; 2],
    /// The heights.
    pub values: Vec<f64>,
    /// Number of decoded pixels, for the budget.
    pub pixels: u64,
}

impl Heights {
    /// The height of a cell; outside the grid that of the nearest cell.
    pub fn at(&self, column: isize, line: isize) -> f64 {
        let [x, z] = [(column, self.size[0]), (line, self.size[1])].map(|(i, n)| i.clamp(0, n as isize - 1) as usize);
        self.values[z * self.size[0] + x]
    }

    /// The heights of an image; without an image, a hill.
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
        Self { size: [SIDE; 2], values: (0..SIDE * SIDE).map(height).collect(), pixels: 0 }
    }
}

impl Attachment<Heights> {
    /// Draws an image of at least 1 × 1 pixels and returns it as a PNG file of this name; `level` gives the brightness
    /// of each pixel, up to 255.
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

    /// Decodes an image. Black is 0, white 1; brighter values are clamped. Larger images are reduced by averaging their
    /// pixels. An orientation tag is applied.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        match guess_format(bytes).map_err(|_| "it is of another kind")? {
            ImageFormat::OpenExr => {
                let (image, pixels) = exr::read(bytes)?;
                Ok(Self::from_image(&image, 1.0, Orientation::NoTransforms, pixels))
            }
            format => decoded(bytes, format),
        }
    }
}

fn decoded(bytes: &[u8], format: ImageFormat) -> Result<Heights, String> {
    let (image, orientation, pixels) = image_file::decoded(bytes, format)?;
    Ok(match image {
        // Most images are of this kind; this avoids a copy.
        DynamicImage::ImageLuma8(image) if square_side(&image) > 1 => {
            Heights::from_image(&image, u8::MAX.into(), orientation, pixels)
        }
        image => Heights::from_image(&image.into_luma16(), u16::MAX.into(), orientation, pixels),
    })
}

impl Heights {
    /// The heights of an image in which `white` is 1.
    fn from_image<S>(image: &ImageBuffer<Luma<S>, Vec<S>>, white: f64, orientation: Orientation, pixels: u64) -> Self
    where
        S: Primitive + 'static,
        Luma<S>: image::Pixel<Subpixel = S>,
    {
        let heights =
            if square_side(image) > 1 { grid::<f32>(&means(image, white), 1.0) } else { grid::<S>(image, white) };
        turned(Self { pixels, ..heights }, orientation)
    }
}

/// The heights of an image, reduced if it exceeds the size of the grid.
fn grid<S>(image: &ImageBuffer<Luma<S>, Vec<S>>, white: f64) -> Heights
where
    S: Primitive + 'static,
    Luma<S>: image::Pixel<Subpixel = S>,
{
    let (width, height) = image.dimensions();
    let factor = (MAX_HEIGHTS as f64 / f64::from(width.max(height))).min(1.0);
    let [columns, lines] = [width, height].map(|n| ((f64::from(n) * factor).round() as u32).max(1));
    let smaller = (factor < 1.0).then(|| resize(image, columns, lines, FilterType::Triangle));
    let pixels = smaller.as_ref().unwrap_or(image).as_raw();
    let values = pixels.iter().map(|value| value.to_f64().unwrap_or(0.0) / white).collect();
    Heights { size: [columns as usize, lines as usize], values, pixels: 0 }
}

/// The side of the squares that [`means`] averages to one pixel; 1 for images that are resized directly.
fn square_side<S>(image: &ImageBuffer<Luma<S>, Vec<S>>) -> u32
where
    S: Primitive + 'static,
    Luma<S>: image::Pixel<Subpixel = S>,
{
    (image.width().max(image.height()) / (4 * MAX_HEIGHTS as u32)).max(1)
}

/// Reduces an image whose sides are much longer than those of the grid by averaging squares of its pixels. High-quality
/// resizing from there takes a tenth of the time, and is as good. White is 1.
fn means<S>(image: &ImageBuffer<Luma<S>, Vec<S>>, white: f64) -> ImageBuffer<Luma<f32>, Vec<f32>>
where
    S: Primitive + 'static,
    Luma<S>: image::Pixel<Subpixel = S>,
{
    let (width, height) = image.dimensions();
    let side = square_side(image);
    let (columns, lines) = (width.div_ceil(side), height.div_ceil(side));
    let mut out = ImageBuffer::new(columns, lines);
    let mut sums = vec![0.0_f64; columns as usize];
    for line in 0..lines {
        sums.fill(0.0);
        let rows = line * side..((line + 1) * side).min(height);
        for y in rows.clone() {
            let start = y as usize * width as usize;
            let row = &image.as_raw()[start..start + width as usize];
            for (sum, pixels) in sums.iter_mut().zip(row.chunks(side as usize)) {
                *sum += pixels.iter().filter_map(|value| value.to_f64()).sum::<f64>();
            }
        }
        for (x, sum) in (0..).zip(&sums) {
            let count = side.min(width - x * side) * rows.len() as u32;
            out.put_pixel(x, line, Luma([(sum / f64::from(count) / white) as f32]));
        }
    }
    out
}

/// The heights in their display orientation.
fn turned(heights: Heights, orientation: Orientation) -> Heights {
    let [columns, lines] = heights.size;
    let (is_aside, flips_x, flips_y) = match orientation {
        Orientation::NoTransforms => return heights,
        Orientation::FlipHorizontal => (false, true, false),
        Orientation::Rotate180 => (false, true, true),
        Orientation::FlipVertical => (false, false, true),
        Orientation::Rotate90FlipH => (true, false, false),
        Orientation::Rotate90 => (true, false, true),
        Orientation::Rotate270FlipH => (true, true, true),
        Orientation::Rotate270 => (true, true, false),
    };
    let size = if is_aside { [lines, columns] } else { [columns, lines] };
    let value = |i: usize| {
        let [x, y] = [i % size[0], i / size[0]];
        let [x, y] = if is_aside { [y, x] } else { [x, y] };
        let [x, y] = [if flips_x { columns - 1 - x } else { x }, if flips_y { lines - 1 - y } else { y }];
        heights.values[y * columns + x]
    };
    Heights { size, values: (0..columns * lines).map(value).collect(), ..heights }
}

#[cfg(test)]
mod tests {
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
        // A single row of pixels stays a single row.
        assert_eq!(Heights::read(&png(2000, 1, |_, _| 9)).unwrap().size, [MAX_HEIGHTS, 1]);
    }

    #[test]
    fn heights_are_turned_as_images_are() {
        let image = ImageBuffer::from_fn(3, 2, |x, y| Luma([(10 * x + y) as u16]));
        for exif in 1..=8 {
            let orientation = Orientation::from_exif(exif).unwrap();
            let ours = Heights::from_image(&image, 1.0, orientation, 6);
            let mut theirs = DynamicImage::ImageLuma16(image.clone());
            theirs.apply_orientation(orientation);
            let theirs = Heights::from_image(&theirs.into_luma16(), 1.0, Orientation::NoTransforms, 6);
            assert_eq!(ours, theirs, "orientation {exif}");
        }
    }

    #[test]
    fn means_of_squares_are_as_good_as_resizing_at_once() {
        let wave =
            |x: u32, y: u32| (30_000.0 + 20_000.0 * (f64::from(x) * 0.01).sin() * (f64::from(y) * 0.013).cos()) as u16;
        let image = ImageBuffer::from_fn(2500, 2100, |x, y| Luma([wave(x, y)]));
        let (at_once, by_means) =
            (grid(&image, 65_535.0), Heights::from_image(&image, 65_535.0, Orientation::NoTransforms, 0));
        assert_eq!(at_once.size, by_means.size);
        let off = at_once.values.iter().zip(&by_means.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 2e-3, "{off}");
        // 8-bit images, too, give heights finer than 8 bits: no steps.
        let image = ImageBuffer::from_fn(2048, 64, |x, _| Luma([(x / 8) as u8]));
        let ramp = Heights::from_image(&image, 255.0, Orientation::NoTransforms, 0);
        let steps = (4..MAX_HEIGHTS - 4).map(|x| ramp.values[x] - ramp.values[x - 1]);
        assert!(steps.clone().all(|step| (step - 1.0 / 255.0).abs() < 5e-4), "{:?}", steps.collect::<Vec<_>>());
    }
}
