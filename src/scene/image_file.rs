//! Reads image files within the budget for decoding.

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::decode_budget::{check_size, spend};
use super::limits::MAX_IMAGE_BYTES;

/// The image of a file, still to be turned, and the number of its pixels.
pub(super) fn decoded(bytes: &[u8], format: ImageFormat) -> Result<(DynamicImage, Orientation, u64), String> {
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_IMAGE_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions();
    let pixels = check_size([width.into(), height.into()], decoder.total_bytes())?;
    spend(pixels * passes(bytes, format))?;
    // Ignores a damaged orientation tag.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let image = DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?;
    Ok((image, orientation, pixels))
}

/// How often decoding passes over the pixels: a progressive JPEG repeats them for each scan, of which it may have
/// thousands.
fn passes(bytes: &[u8], format: ImageFormat) -> u64 {
    const USUAL_SCANS: u64 = 16;
    if format != ImageFormat::Jpeg {
        return 1;
    }
    let scans = bytes.windows(2).filter(|pair| *pair == [0xff, 0xda]).count() as u64;
    scans.div_ceil(USUAL_SCANS).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_of_a_jpeg_are_counted() {
        assert_eq!(passes(&[0xff, 0xda].repeat(10), ImageFormat::Jpeg), 1);
        assert_eq!(passes(&[0xff, 0xda].repeat(1_000), ImageFormat::Jpeg), 63);
        assert_eq!(passes(&[0xff, 0xda].repeat(1_000), ImageFormat::Png), 1);
    }
}
