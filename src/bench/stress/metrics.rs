//! The metrics of a picture against its reference.

use std::collections::HashSet;
use std::fmt::Write as _;

use image::RgbImage;

use super::allowed::Allowed;
use super::cases::StressCase;
use super::strip::strip;
use crate::bench::BenchError;
use crate::field::reference::accuracy::{Accuracy, verdicts};
use crate::field::reference::image::{ReferenceImage, render_reference};
use crate::field::{FlatScene, GBuffer, flatten};
use crate::render::{EvalStrategy, Renderer};

/// Width and height of the pictures, in pixels.
pub const PICTURE: [u32; 2] = [48, 36];

/// The result of a case.
#[derive(Clone, Debug)]
pub struct Metrics {
    /// The name of the node.
    pub node: String,
    /// The difficulty as text.
    pub circumstance: String,
    /// Pixels in the picture.
    pub pixels: usize,
    /// Pixels where the reference hits something.
    pub hits: usize,
    /// The worst strategy; the following metrics are those of its picture.
    pub strategy: EvalStrategy,
    /// Wrong pixels, see [`crate::field::reference::accuracy`].
    pub wrong: usize,
    /// Pixels that differ from the reference because their rays graze.
    pub grazing: usize,
    /// Pixels whose depth or normal is NaN.
    pub nan: usize,
    /// Components with unfinished rays.
    pub unfinished: usize,
    /// Pixels in which the pictures of other strategies differ in hit or miss from that of the interpreter, except
    /// where the ray passes an edge so closely that rounding decides.
    pub differ: usize,
    /// 99th percentile of the depth error, in pixel footprints.
    pub depth_p99: f64,
    /// Maximum of the depth error, in pixel footprints.
    pub depth_max: f64,
    /// The allowance of the case.
    pub allowed: Allowed,
    /// Picture, reference and difference side by side.
    pub(super) strip: RgbImage,
}

/// Whether depth or normal of the pixel is NaN.
fn is_nan(buffers: &GBuffer, i: usize) -> bool {
    buffers.depth[i].is_nan() || buffers.normal[i].iter().any(|v| v.is_nan())
}

impl StressCase {
    /// Draws the case by each of these strategies and compares each picture with the reference and with the first one.
    /// `None` if the view needs a surface and there is none.
    ///
    /// # Errors
    /// The scene is beyond a limit, the ray that determines the view does not end, or the device fails.
    ///
    /// # Panics
    /// `strategies` is empty.
    pub fn measure(&self, renderer: &mut Renderer, strategies: &[EvalStrategy]) -> Result<Option<Metrics>, BenchError> {
        let flat = flatten(&self.node.scene(self.place), 0.0)?;
        let aspect = f64::from(PICTURE[0]) / f64::from(PICTURE[1]);
        let Some(camera) = self.view.camera(&flat, self.place, aspect)? else { return Ok(None) };
        let reference = render_reference(&flat, &[], &camera, PICTURE, &|_| ())
            .map_err(|error| BenchError::Reference { scene: self.name(), error })?;
        let mut all: Vec<(Metrics, GBuffer)> = Vec::new();
        for strategy in strategies {
            renderer.set_strategy(*strategy);
            let (measured, unfinished) = renderer.render(&flat, &[], &camera, PICTURE, &mut |_| true)?;
            let metrics = Metrics { strategy: *strategy, ..Metrics::of(&measured, &flat, &reference) };
            all.push((Metrics { unfinished: unfinished.len(), ..metrics }, measured));
        }
        let first = &all.first().expect("at least one strategy").1;
        let hits = |buffers: &GBuffer, i: usize| buffers.depth[i].is_finite();
        let differs = |other: &GBuffer, i: usize| hits(first, i) != hits(other, i) && !reference.is_undecided(i);
        let differ = all.iter().map(|(of, other)| (0..of.pixels).filter(|i| differs(other, *i)).count()).sum();
        let mut metrics: Vec<Metrics> = all.into_iter().map(|(metrics, _)| metrics).collect();
        worst_first(&mut metrics);
        let unfinished = metrics.iter().map(|of| of.unfinished).max().unwrap_or(0);
        let nan = metrics.iter().map(|of| of.nan).max().unwrap_or(0);
        let depth_p99 = metrics.iter().map(|of| of.depth_p99).fold(0.0, f64::max);
        let (node, circumstance, allowed) = (self.name(), self.circumstance.clone(), self.allowed());
        let worst = metrics.swap_remove(0);
        Ok(Some(Metrics { node, circumstance, allowed, differ, unfinished, nan, depth_p99, ..worst }))
    }
}

impl Metrics {
    /// Compares a picture of these arrays with the reference.
    pub fn of(measured: &GBuffer, flat: &FlatScene, reference: &ReferenceImage) -> Self {
        let verdicts = verdicts(measured, flat, reference);
        let accuracy = Accuracy::of(measured, reference, &verdicts);
        let pixels = measured.depth.len();
        let wrong: Vec<bool> = verdicts.iter().map(|verdict| verdict.is_wrong()).collect();
        Self {
            node: String::new(),
            circumstance: String::new(),
            pixels,
            hits: reference.buffers.depth.iter().filter(|depth| depth.is_finite()).count(),
            strategy: EvalStrategy::Interpreter,
            wrong: accuracy.wrong,
            grazing: accuracy.grazing,
            nan: (0..pixels).filter(|&i| is_nan(measured, i)).count(),
            unfinished: 0,
            differ: 0,
            depth_p99: accuracy.depth_p99,
            depth_max: accuracy.depth_max,
            allowed: Allowed::USUAL,
            strip: strip(measured, &reference.buffers, reference.footprint, &wrong),
        }
    }

    /// The metrics beyond the allowance, as text; empty for a good picture.
    pub fn faults(&self) -> Vec<String> {
        let checks = [
            ("pixels that are no number", self.nan as f64, 0.0),
            ("components with unfinished rays", self.unfinished as f64, 0.0),
            ("pixels that other strategies show otherwise", self.differ as f64, self.allowed.differ as f64),
            ("share of pixels that are wrong", self.wrong as f64 / self.pixels.max(1) as f64, self.allowed.wrong),
            ("depth error, 99th percentile, in footprints", self.depth_p99, self.allowed.depth),
        ];
        let beyond = checks.into_iter().filter(|(_, value, limit)| value.is_nan() || value > limit);
        let at = format!("{}, {}", self.node, self.circumstance);
        beyond.map(|(what, value, limit)| format!("{at}: {what}: {value}, allowed {limit}")).collect()
    }
}

/// Sorts the worst first: by NaN, differences between strategies, wrong pixels, unfinished rays, depth error.
pub fn worst_first(metrics: &mut [Metrics]) {
    metrics.sort_by(|a, b| {
        let badness = |one: &Metrics| (one.nan, one.differ, one.wrong, one.unfinished);
        badness(b).cmp(&badness(a)).then(b.depth_p99.total_cmp(&a.depth_p99))
    });
}

/// The first case of each node.
pub fn first_of_each(metrics: &[Metrics]) -> Vec<Metrics> {
    let mut seen = HashSet::new();
    metrics.iter().filter(|one| seen.insert(one.node.as_str())).cloned().collect()
}

/// Totals and one row for each of the first `lines` cases, as Markdown.
pub fn stress_table(metrics: &[Metrics], lines: usize) -> String {
    let sum = |of: fn(&Metrics) -> usize| metrics.iter().map(of).sum::<usize>();
    let beyond = metrics.iter().filter(|one| !one.faults().is_empty()).count();
    let mut out = format!(
        "{} cases, {} pixels, {} of them hits: {} wrong by the worst strategy, {} graze, {} NaN, {} otherwise by straight-line code or \
         tapes; {} cases beyond what is allowed.\n\n",
        metrics.len(),
        sum(|one| one.pixels),
        sum(|one| one.hits),
        sum(|one| one.wrong),
        sum(|one| one.grazing),
        sum(|one| one.nan),
        sum(|one| one.differ),
        beyond,
    );
    out += "| node | circumstance | worst by | hits | wrong | grazing | NaN | unfinished | depth p99 | max | otherwise |\n";
    out += "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for one in metrics.iter().take(lines) {
        let Metrics { node, circumstance, strategy, hits, wrong, grazing, nan, unfinished, .. } = one;
        let Metrics { depth_p99, depth_max, differ, .. } = one;
        writeln!(
            out,
            "| {node} | {circumstance} | {strategy:?} | {hits} | {wrong} | {grazing} | {nan} | {unfinished} | \
             {depth_p99:.5} | {depth_max:.4} | {differ} |"
        )
        .expect("strings take all");
    }
    out
}
