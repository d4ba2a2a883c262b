//! A picture, its reference and their difference, side by side.

use image::{Rgb, RgbImage};

use crate::field::GBuffer;

/// Picture, reference and difference side by side. In the difference, wrong pixels are red and gray shows the depth
/// error: white from a tenth of a footprint on.
pub(super) fn strip(measured: &GBuffer, reference: &GBuffer, footprint: f64, wrong: &[bool]) -> RgbImage {
    RgbImage::from_fn(3 * measured.width, measured.height, |x, y| {
        let i = measured.index(x % measured.width, y);
        let [r, g, b, _] = match x / measured.width {
            0 => measured.color[i],
            1 => reference.color[i],
            _ if wrong[i] => [255, 0, 0, 255],
            _ => {
                let (m, t) = (f64::from(measured.depth[i]), f64::from(reference.depth[i]));
                let error = if m.is_finite() && t.is_finite() { (m - t).abs() / (footprint * t) } else { 0.0 };
                [(error * 10.0 * 255.0).min(255.0) as u8; 4]
            }
        };
        Rgb([r, g, b])
    })
}
