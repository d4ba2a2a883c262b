//! Images of everything around a scene: equirectangular, linear, of any brightness.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, Rgb32FImage, guess_format};

use super::attachment::{Attachment, Content};
use super::decode_budget::{check_size, spend};
use super::limits::{MAX_ENVIRONMENT_WIDTH, MAX_IMAGE_BYTES, MAX_RADIANCE};

/// Radiance from every direction: columns around the vertical axis, lines from above to below.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentImage {
    /// Columns and lines; at least 1, at most [`MAX_ENVIRONMENT_WIDTH`].
    pub size: [usize; 2],
    /// Linear colors, line by line, from 0 to [`MAX_RADIANCE`].
    pub texels: Vec<[f32; 3]>,
    /// Number of decoded pixels, for the budget.
    pub pixels: u64,
}

impl Attachment<EnvironmentImage> {
    /// Draws an image of at least 1 × 1 pixels and returns it as an HDR file of this name; `color` gives the linear
    /// color of each pixel.
    pub fn painted(name: &str, [columns, lines]: [u32; 2], color: impl Fn(u32, u32) -> [f32; 3]) -> Self {
        let mut file = Cursor::new(Vec::new());
        let pixels = Rgb32FImage::from_fn(columns, lines, |x, y| image::Rgb(color(x, y)));
        DynamicImage::from(pixels).write_to(&mut file, ImageFormat::Hdr).expect("memory takes all");
        Self::new(name, file.into_inner()).expect("a small image that was just written can be read")
    }
}

impl Content for EnvironmentImage {
    const WHAT: &'static str = "an HDR, EXR, PNG or JPEG image";
    const WITHOUT: &'static str = "No image";
    const ENDINGS: &'static [&'static str] = &["hdr", "exr", "png", "jpg", "jpeg"];

    /// Decodes an image. PNG and JPEG images are sRGB. Larger images are reduced by averaging their pixels.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let format = guess_format(bytes).map_err(|_| "it is of another kind")?;
        let is_encoded = match format {
            ImageFormat::Hdr | ImageFormat::OpenExr => false,
            ImageFormat::Png | ImageFormat::Jpeg => true,
            _ => return Err("it is of another kind".to_owned()),
        };
        let mut limits = Limits::default();
        limits.max_alloc = Some(MAX_IMAGE_BYTES);
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(|e| e.to_string())?;
        let (width, height) = decoder.dimensions();
        let pixels = check_size([width.into(), height.into()], decoder.total_bytes())?;
        if pixels == 0 {
            return Err("it is empty".to_owned());
        }
        spend(pixels)?;
        let mut image = DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?.into_rgb32f();
        for value in image.iter_mut() {
            // NaN becomes 0.
            let linear = if is_encoded { decoded(*value) } else { *value };
            *value = if linear > 0.0 { linear.min(MAX_RADIANCE) } else { 0.0 };
        }
        Ok(Self { pixels, ..Self::reduced(&image) })
    }
}

impl EnvironmentImage {
    /// The image, reduced to the greatest width by means of its pixels.
    fn reduced(image: &Rgb32FImage) -> Self {
        let (width, height) = image.dimensions();
        let factor = (MAX_ENVIRONMENT_WIDTH as f64 / f64::from(width.max(height))).min(1.0);
        let [columns, lines] = [width, height].map(|n| ((f64::from(n) * factor).round() as u32).max(1));
        let range = |i: u32, count: u32, of: u32| {
            let at = |i: u32| (u64::from(i) * u64::from(of) / u64::from(count)) as u32;
            at(i)..at(i + 1).max(at(i) + 1)
        };
        let mean = |i: u32| {
            let (mut sum, mut count) = ([0.0_f64; 3], 0.0);
            for y in range(i / columns, lines, height) {
                for x in range(i % columns, columns, width) {
                    sum.iter_mut().zip(image.get_pixel(x, y).0).for_each(|(sum, value)| *sum += f64::from(value));
                    count += 1.0;
                }
            }
            sum.map(|v| (v / count) as f32)
        };
        let texels = (0..columns * lines).map(mean).collect();
        Self { size: [columns as usize, lines as usize], texels, pixels: 0 }
    }
}

/// Decodes a value of sRGB (IEC 61966-2-1).
fn decoded(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bright_images_keep_their_brightness_and_encoded_ones_become_linear() {
        let bright = |x: u32, y: u32| [x as f32 * 100.0, y as f32, 0.5];
        let file = Attachment::<EnvironmentImage>::painted("sky.hdr", [16, 8], bright);
        let image = file.content().expect("it was drawn");
        assert_eq!((image.size, image.pixels), ([16, 8], 128));
        for (i, texel) in image.texels.iter().enumerate() {
            let meant = bright(i as u32 % 16, i as u32 / 16);
            let step = meant.iter().fold(0.0_f32, |a, b| a.max(*b)) / 128.0;
            assert!(texel.iter().zip(meant).all(|(a, b)| (a - b).abs() <= step), "{texel:?} {meant:?}");
        }
        let mut png = Cursor::new(Vec::new());
        let gray = image::RgbImage::from_pixel(2, 1, image::Rgb([188, 255, 0]));
        gray.write_to(&mut png, ImageFormat::Png).expect("memory takes all");
        let file = Attachment::<EnvironmentImage>::new("gray.png", png.into_inner()).expect("a PNG");
        let [r, g, b] = file.content().expect("it was read").texels[0];
        assert!((r - 0.5029).abs() < 1e-3 && (g - 1.0).abs() < 1e-6 && b == 0.0, "{r} {g} {b}");
    }

    #[test]
    fn large_images_are_reduced_and_what_is_no_image_is_refused() {
        let file =
            Attachment::<EnvironmentImage>::painted("wide.hdr", [2 * MAX_ENVIRONMENT_WIDTH as u32, 4], |_, y| {
                [y as f32; 3]
            });
        let image = file.content().expect("it was drawn");
        assert_eq!(image.size, [MAX_ENVIRONMENT_WIDTH, 2]);
        assert_eq!(image.pixels, 8 * MAX_ENVIRONMENT_WIDTH as u64);
        let mean: f32 = image.texels.iter().map(|texel| texel[0]).sum::<f32>() / image.texels.len() as f32;
        assert!((mean - 1.5).abs() < 0.05, "{mean}");
        let refused = Attachment::<EnvironmentImage>::new("x.hdr", b"#?RADIANCE\nbroken".to_vec()).unwrap_err();
        assert!(refused.contains("must be an HDR, EXR, PNG or JPEG image"), "{refused}");
    }
}
