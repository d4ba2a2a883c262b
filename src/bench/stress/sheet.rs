//! The worst cases as pictures: what is drawn, the reference, and what differs.

use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use plotters::style::RGBColor;

use super::metrics::{Metrics, PICTURE};
use crate::bench::canvas::{LEFT, canvas};
use crate::flat::GBuffer;

/// A pixel of a picture is shown so many pixels wide.
const ENLARGED: u32 = 4;
/// Between pictures, in pixels.
const GAP: u32 = 8;
/// Height of a line of text, in pixels.
const LINE: u32 = 22;
/// Size of the letters, in pixels.
const EM: f64 = 13.0;

/// Picture, reference and difference beside each other. Red is wrong, gray the error of the depth: white from a tenth of
/// a footprint on.
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

/// The first `count` cases below each other, each with its name.
pub fn stress_sheet(metrics: &[Metrics], count: usize) -> RgbImage {
    let [width, height] = [3 * PICTURE[0] * ENLARGED, PICTURE[1] * ENLARGED];
    let shown = &metrics[..count.min(metrics.len())];
    let row = height + LINE + GAP;
    let top = |i: usize| GAP + i as u32 * row;
    let mut all = canvas((width + 2 * GAP, GAP + (shown.len() as u32 * row).max(1)), |canvas| {
        for (i, one) in shown.iter().enumerate() {
            let text = format!(
                "{}, {}: {} wrong, {} NaN, depth {:.4}",
                one.node, one.circumstance, one.wrong, one.nan, one.depth_p99
            );
            let at = (f64::from(GAP), f64::from(top(i) + LINE / 2));
            canvas.text(&text, at, EM, RGBColor(40, 40, 40), LEFT)?;
        }
        Ok(())
    });
    for (i, one) in shown.iter().enumerate() {
        let large = imageops::resize(&one.strip, width, height, FilterType::Nearest);
        imageops::replace(&mut all, &large, i64::from(GAP), i64::from(top(i) + LINE));
    }
    all
}
