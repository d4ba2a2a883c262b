//! The worst cases as one picture: drawn picture, reference and difference of each.

use image::RgbImage;
use image::imageops::{self, FilterType};
use plotters::style::RGBColor;

use super::metrics::{Metrics, PICTURE};
use crate::bench::canvas::{LEFT, canvas};

/// Width of an enlarged pixel, in pixels.
const ENLARGED: u32 = 4;
/// Gap between pictures, in pixels.
const GAP: u32 = 8;
/// Height of a line of text, in pixels.
const LINE: u32 = 22;
/// Font size, in pixels.
const EM: f64 = 13.0;

/// The first `count` cases in one column, each with its name.
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
