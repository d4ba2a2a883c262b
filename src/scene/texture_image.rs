//! Images of textures: the decoded file, and its levels of detail in the form that renderers read.

use std::sync::{Arc, OnceLock};

use super::attachment::{Attachment, Content};
use super::heights::exr;
use super::image_file;
use image::{DynamicImage, ImageFormat, guess_format};

/// The form of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TexelForm {
    /// Three channels of 10 bits, red lowest: the square root of each, which is finer than 8 bits of sRGB everywhere.
    Color,
    /// A number of 32 bits: the first channel.
    Value,
    /// Three channels of 10 bits, red lowest, as they are.
    Vector,
}

/// An image and its smaller versions, each half as wide and high, down to one texel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pyramid {
    /// The form of all texels.
    pub form: TexelForm,
    /// From the finest to the coarsest.
    pub levels: Vec<TexelLevel>,
}

/// One level of a [`Pyramid`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TexelLevel {
    /// Width and height.
    pub size: [u32; 2],
    /// The texels in blocks of 4 by 4, row by row of blocks; blocks at the right and lower edges are filled up.
    pub texels: Vec<u32>,
}

/// Side of a block of texels.
const BLOCK: u32 = 4;

impl TexelLevel {
    /// Position of a texel among the words.
    pub fn index(&self, x: u32, y: u32) -> usize {
        let blocks = self.size[0].div_ceil(BLOCK);
        let block = (y / BLOCK) * blocks + x / BLOCK;
        (block * BLOCK * BLOCK + (y % BLOCK) * BLOCK + x % BLOCK) as usize
    }
}

/// A decoded image.
#[derive(Debug)]
pub struct TextureImage {
    /// Width and height.
    size: [u32; 2],
    /// Gray, or red, green and blue.
    channels: usize,
    /// The numbers, row by row; 65 535 is 1.
    codes: Vec<u16>,
    /// Whether the file's numbers are linear by their format.
    is_linear: bool,
    /// Number of decoded pixels, for the budget.
    pub(super) pixels: u64,
    /// Made on first use, by whether the numbers are meant as sRGB, and by form.
    pyramids: [[OnceLock<Arc<Pyramid>>; 3]; 2],
    /// Made on first use.
    shares: OnceLock<Arc<ShareImage>>,
}

/// Most pixels along a side of a [`ShareImage`].
pub const MAX_SHARES: u32 = 256;

/// The brightness of an image, from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ShareImage {
    /// Columns and rows; at most [`MAX_SHARES`].
    pub size: [u32; 2],
    /// Row by row, four pixels each.
    pub rows: Vec<[f32; 4]>,
}

impl ShareImage {
    /// The brightness of a pixel.
    pub fn at(&self, column: u32, line: u32) -> f64 {
        let at = (line * self.size[0] + column) as usize;
        f64::from(self.rows[at / 4][at % 4])
    }
}

impl Content for TextureImage {
    const WHAT: &'static str = "a PNG, JPEG or EXR image";
    const WITHOUT: &'static str = "No image";
    const ENDINGS: &'static [&'static str] = &["png", "jpg", "jpeg", "exr"];

    /// Decodes an image at its full size. Alpha is ignored; an orientation tag is applied.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        match guess_format(bytes).map_err(|_| "it is of another kind")? {
            ImageFormat::OpenExr => {
                let (size, colors, pixels) = exr::read_colors(bytes)?;
                let codes = colors.into_iter().map(|v| (v * f64::from(u16::MAX)).round() as u16).collect();
                Ok(Self::new(size, 3, codes, true, pixels))
            }
            format => {
                let (mut image, orientation, pixels) = image_file::decoded(bytes, format)?;
                image.apply_orientation(orientation);
                let size = [image.width(), image.height()];
                let (channels, codes) = match image {
                    DynamicImage::ImageLuma8(_) | DynamicImage::ImageLumaA8(_) => {
                        (1, wide(image.into_luma8().into_raw()))
                    }
                    DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_) => (1, image.into_luma16().into_raw()),
                    DynamicImage::ImageRgb8(_) | DynamicImage::ImageRgba8(_) => (3, wide(image.into_rgb8().into_raw())),
                    image => (3, image.into_rgb16().into_raw()),
                };
                Ok(Self::new(size, channels, codes, false, pixels))
            }
        }
    }
}

/// 8 bits as 16 bits.
fn wide(codes: Vec<u8>) -> Vec<u16> {
    codes.into_iter().map(|code| u16::from(code) * 257).collect()
}

impl TextureImage {
    fn new(size: [u32; 2], channels: usize, codes: Vec<u16>, is_linear: bool, pixels: u64) -> Self {
        Self { size, channels, codes, is_linear, pixels, pyramids: Default::default(), shares: OnceLock::new() }
    }

    /// Width and height.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The image in this form with its smaller versions; made once. `is_srgb`: its numbers are encoded as colors for
    /// screens are, unless the format of the file says otherwise.
    pub fn pyramid(&self, is_srgb: bool, form: TexelForm) -> Arc<Pyramid> {
        let made = &self.pyramids[usize::from(is_srgb)][form as usize];
        Arc::clone(made.get_or_init(|| Arc::new(self.make(is_srgb, form))))
    }

    /// Its brightness as the file has it; of a large image that of a smaller version. Made once.
    pub fn shares(&self) -> Arc<ShareImage> {
        Arc::clone(self.shares.get_or_init(|| Arc::new(self.make_shares())))
    }

    fn make_shares(&self) -> ShareImage {
        let pyramid = self.pyramid(false, TexelForm::Color);
        let fits = |level: &&TexelLevel| level.size.iter().all(|side| *side <= MAX_SHARES);
        let level = pyramid.levels.iter().find(fits).or(pyramid.levels.last()).expect("there is always one texel");
        // Weights of Rec. 709.
        let brightness = |x: u32, y: u32| {
            let word = level.texels[level.index(x, y)];
            let channel = |bit: u32| ((word >> bit & 1023) as f32 / 1023.0).powi(2);
            (0.2126 * channel(0) + 0.7152 * channel(10) + 0.0722 * channel(20)).min(1.0)
        };
        let [width, height] = level.size;
        let mut shares: Vec<f32> = (0..width * height).map(|i| brightness(i % width, i / width)).collect();
        shares.resize(shares.len().next_multiple_of(4), 0.0);
        let rows = shares.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]]).collect();
        ShareImage { size: level.size, rows }
    }

    fn make(&self, is_srgb: bool, form: TexelForm) -> Pyramid {
        let is_encoded = is_srgb && !self.is_linear;
        let linear = |code: u16| {
            let value = f32::from(code) / f32::from(u16::MAX);
            if is_encoded { decoded(value) } else { value }
        };
        let kept = if form == TexelForm::Value { 1 } else { 3 };
        let texel =
            |texel: &[u16]| -> [f32; 3] { [0, 1, 2].map(|c| linear(texel[c.min(self.channels - 1).min(kept - 1)])) };
        let mut values: Vec<[f32; 3]> = self.codes.chunks_exact(self.channels).map(texel).collect();
        let mut size = self.size;
        let mut levels = vec![level(size, &values, form)];
        while size != [1, 1] {
            (size, values) = halved(size, &values);
            levels.push(level(size, &values, form));
        }
        Pyramid { form, levels }
    }
}

/// Linear from sRGB (IEC 61966-2-1).
fn decoded(v: f32) -> f32 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The texels of a level.
fn level(size: [u32; 2], values: &[[f32; 3]], form: TexelForm) -> TexelLevel {
    let mut out = TexelLevel { size, texels: Vec::new() };
    let blocks = size.map(|n| n.div_ceil(BLOCK) as usize);
    out.texels = vec![0; blocks[0] * blocks[1] * (BLOCK * BLOCK) as usize];
    for y in 0..size[1] {
        for x in 0..size[0] {
            let at = out.index(x, y);
            out.texels[at] = packed(values[y as usize * size[0] as usize + x as usize], form);
        }
    }
    out
}

/// A texel as a word.
fn packed(value: [f32; 3], form: TexelForm) -> u32 {
    let word = |v: [f32; 3]| {
        let [r, g, b] = v.map(|v| (v.clamp(0.0, 1.0) * 1023.0).round() as u32);
        r | (g << 10) | (b << 20)
    };
    match form {
        TexelForm::Color => word(value.map(f32::sqrt)),
        TexelForm::Vector => word(value),
        TexelForm::Value => value[0].to_bits(),
    }
}

/// An image of half the width and height, rounded down: each texel is the mean of what it covers.
fn halved([width, height]: [u32; 2], values: &[[f32; 3]]) -> ([u32; 2], Vec<[f32; 3]>) {
    let (narrow, low) = ((width / 2).max(1), (height / 2).max(1));
    let (columns, lines) = (covered(width, narrow), covered(height, low));
    let mut out = Vec::with_capacity(narrow as usize * low as usize);
    for rows in &lines {
        for cells in &columns {
            let mut sum = [0.0_f32; 3];
            for &(y, tall) in rows {
                for &(x, wide) in cells {
                    let texel = values[y * width as usize + x];
                    for (sum, v) in sum.iter_mut().zip(texel) {
                        *sum += v * tall * wide;
                    }
                }
            }
            out.push(sum);
        }
    }
    ([narrow, low], out)
}

/// For each of `fewer` equal parts of `many` texels in a row: which texels it covers, with their shares.
fn covered(many: u32, fewer: u32) -> Vec<Vec<(usize, f32)>> {
    let part = f64::from(many) / f64::from(fewer);
    let of = |i: u32| {
        let (from, to) = (f64::from(i) * part, f64::from(i + 1) * part);
        let last = ((to - 1e-9).floor() as u32).min(many - 1);
        let share = |x: u32| (to.min(f64::from(x + 1)) - from.max(f64::from(x))) / part;
        (from.floor() as u32..=last).map(|x| (x as usize, share(x) as f32)).filter(|(_, share)| *share > 0.0).collect()
    };
    (0..fewer).map(of).collect()
}

impl Attachment<TextureImage> {
    /// Draws an image of at least 1 × 1 pixels and returns it as a PNG file of this name; `color` gives the channels of
    /// each pixel, up to 255.
    pub fn painted(name: &str, [columns, lines]: [u32; 2], color: impl Fn(u32, u32) -> [u8; 3]) -> Self {
        let mut file = std::io::Cursor::new(Vec::new());
        let pixels = image::RgbImage::from_fn(columns, lines, |x, y| image::Rgb(color(x, y)));
        pixels.write_to(&mut file, ImageFormat::Png).expect("memory takes all");
        Self::new(name, file.into_inner()).expect("a small image that was just written can be read")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color(word: u32) -> [f64; 3] {
        [0, 10, 20].map(|bit| (f64::from(word >> bit & 1023) / 1023.0).powi(2))
    }

    #[test]
    fn every_level_keeps_the_mean_and_colors_are_finer_than_their_file() {
        for size in [[7, 5], [8, 8], [1, 9], [1, 1]] {
            let image =
                Attachment::<TextureImage>::painted("x.png", size, |x, y| [(40 * x) as u8, 255, (30 * y) as u8]);
            let pyramid = image.content().unwrap().pyramid(false, TexelForm::Value);
            let mean = |level: &TexelLevel| {
                let [w, h] = level.size;
                let all = (0..w * h).map(|i| f64::from(f32::from_bits(level.texels[level.index(i % w, i / w)])));
                all.sum::<f64>() / f64::from(w * h)
            };
            let finest = mean(&pyramid.levels[0]);
            assert!(pyramid.levels.iter().all(|level| (mean(level) - finest).abs() < 1e-5), "{size:?}");
            assert_eq!(pyramid.levels.last().map(|level| level.size), Some([1, 1]));
        }
        let ramp = Attachment::<TextureImage>::painted("x.png", [256, 1], |x, _| [x as u8; 3]);
        let pyramid = ramp.content().unwrap().pyramid(true, TexelForm::Color);
        let shown: Vec<f64> =
            (0..256).map(|x| color(pyramid.levels[0].texels[pyramid.levels[0].index(x, 0)])[0]).collect();
        for (code, shown) in (0_u16..).zip(&shown) {
            let linear = f64::from(decoded(f32::from(code) / 255.0));
            let v = if *shown <= 0.0031308 { 12.92 * shown } else { 1.055 * shown.powf(1.0 / 2.4) - 0.055 };
            assert_eq!((v * 255.0).round() as u16, code, "{linear} is shown as {shown}");
        }
    }

    #[test]
    fn shares_are_the_brightness_of_small_images_and_of_versions_of_large_ones() {
        let shares = |size, color: &dyn Fn(u32, u32) -> [u8; 3]| {
            Attachment::<TextureImage>::painted("x.png", size, color).content().unwrap().shares()
        };
        let small = shares([3, 2], &|x, y| if [x, y] == [2, 1] { [255; 3] } else { [0; 3] });
        assert_eq!((small.size, small.at(2, 1), small.at(1, 1)), ([3, 2], 1.0, 0.0));
        let green = shares([1, 1], &|_, _| [0, 255, 0]);
        assert!((green.at(0, 0) - 0.7152).abs() < 1e-6);
        let large = shares([700, 300], &|x, _| if x % 2 == 0 { [0; 3] } else { [255; 3] });
        assert_eq!(large.size, [175, 75]);
        assert!((large.at(80, 40) - 0.5).abs() < 0.01, "{}", large.at(80, 40));
    }

    #[test]
    fn images_are_read_as_they_are_meant() {
        let written = |image: DynamicImage| {
            let mut bytes = std::io::Cursor::new(Vec::new());
            image.write_to(&mut bytes, ImageFormat::Png).unwrap();
            TextureImage::read(&bytes.into_inner()).unwrap()
        };
        let deep =
            written(DynamicImage::ImageLuma16(image::ImageBuffer::from_fn(2, 1, |x, _| image::Luma([300 + x as u16]))));
        assert_eq!((deep.channels, &deep.codes[..]), (1, &[300, 301][..]));
        let gray = written(DynamicImage::ImageLumaA8(image::ImageBuffer::from_fn(1, 1, |_, _| image::LumaA([7, 0]))));
        assert_eq!((gray.channels, &gray.codes[..]), (1, &[7 * 257][..]));
        let error = TextureImage::read(b"no image").unwrap_err();
        assert_eq!(error, "it is of another kind");
    }
}
