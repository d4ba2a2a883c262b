//! One measurement: one scene by one method at one quality.

use serde::Serialize;
use thiserror::Error;

/// The default method of the program, with which the others are compared.
pub(super) const AUTO: &str = "auto";
/// The method that is a lower bound for the others and not usable for drawing.
pub(super) const LIMIT: &str = "limit";
/// The default quality of the program.
pub(super) const DEFAULT: &str = "default";

/// One measurement. JSON and CSV write the fields in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchRow {
    /// Name of the scene.
    pub scene: String,
    /// Number of nodes of the scene.
    pub nodes: usize,
    /// Method: thesis, baked, interpreter, tape, straight-line, limit or auto.
    pub method: String,
    /// Pixels along each side of the picture.
    pub size: u32,
    /// CPU time of all threads together in milliseconds, median of several runs.
    pub cpu_ms: f64,
    /// Wall time in milliseconds, median of several runs.
    pub wall_ms: f64,
    /// Steps of the march per pixel.
    pub steps_per_px: f64,
    /// Evaluations of a component's field per pixel in all passes: by rays, by cones around tiles, and for normal and
    /// material.
    pub evals_per_px: f64,
    /// The part of `evals_per_px` for normal and material: one for each pixel that shows a field.
    pub surface_evals_per_px: f64,
    /// Fraction of wrong pixels, 0 to 1: in hit or miss, in the node, or by more than a footprint in depth.
    pub wrong_share: f64,
    /// Fraction of pixels, 0 to 1, that differ in this way because their rays graze.
    pub grazing_share: f64,
    /// Median of the depth errors, in pixel footprints.
    pub depth_p50: f64,
    /// 99th percentile of the depth errors, in pixel footprints.
    pub depth_p99: f64,
    /// Largest depth error, in pixel footprints.
    pub depth_max: f64,
    /// Median angle between the normals and those of the reference, in degrees.
    pub normal_p50: f64,
    /// 99th percentile of the angles between the normals and those of the reference, in degrees.
    pub normal_p99: f64,
    /// Quality of the march: draft, default or fine.
    pub quality: String,
    /// CPU time of the slowest run minus that of the fastest, in milliseconds. Smaller differences mean nothing.
    pub cpu_ms_spread: f64,
    /// 99th percentile of the steps per pixel.
    pub steps_p99: f64,
    /// Maximum of the steps per pixel.
    pub steps_max: f64,
    /// Tape cells looked up per pixel by rays and cones.
    pub cells_per_px: f64,
    /// Tape entries read per pixel by rays and cones.
    pub entries_per_px: f64,
}

/// The error for a number of a row that is infinite or NaN.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{scene}, {method}: {field} is not a finite number")]
pub struct NotFinite {
    /// The scene of the row.
    pub scene: String,
    /// The method of the row.
    pub method: String,
    /// The name of the first field that is not finite.
    pub field: &'static str,
}

impl BenchRow {
    /// Returns an error for the first number that is not finite. Measurements call this first, so that a failed one
    /// ends as an error instead of a number.
    pub fn check(&self) -> Result<(), NotFinite> {
        let mut copy = self.clone();
        match copy.numbers().into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(()),
            Some((field, _)) => Err(NotFinite { scene: self.scene.clone(), method: self.method.clone(), field }),
        }
    }

    /// The row as one JSON object without line breaks. JSON has no infinity, and a `null` would mean "not measured", so
    /// numbers that are not finite become the largest finite number, which passes no limit.
    pub fn to_json_line(&self) -> String {
        serde_json::to_string(&self.clamped()).expect("texts and finite numbers can always be written")
    }

    /// The row with the largest finite number in place of those that are not finite: an unknown number must not look
    /// like a good one.
    pub(super) fn clamped(&self) -> Self {
        let mut row = self.clone();
        for (_, value) in row.numbers() {
            *value = match *value {
                f64::NEG_INFINITY => f64::MIN,
                finite if finite.is_finite() => finite,
                _ => f64::MAX,
            };
        }
        row
    }

    fn numbers(&mut self) -> [(&'static str, &mut f64); 17] {
        [
            ("cpu_ms", &mut self.cpu_ms),
            ("wall_ms", &mut self.wall_ms),
            ("steps_per_px", &mut self.steps_per_px),
            ("evals_per_px", &mut self.evals_per_px),
            ("surface_evals_per_px", &mut self.surface_evals_per_px),
            ("wrong_share", &mut self.wrong_share),
            ("grazing_share", &mut self.grazing_share),
            ("depth_p50", &mut self.depth_p50),
            ("depth_p99", &mut self.depth_p99),
            ("depth_max", &mut self.depth_max),
            ("normal_p50", &mut self.normal_p50),
            ("normal_p99", &mut self.normal_p99),
            ("cpu_ms_spread", &mut self.cpu_ms_spread),
            ("steps_p99", &mut self.steps_p99),
            ("steps_max", &mut self.steps_max),
            ("cells_per_px", &mut self.cells_per_px),
            ("entries_per_px", &mut self.entries_per_px),
        ]
    }

    /// The number of nodes as text.
    pub(super) fn node_count(&self) -> String {
        if self.nodes == 1 { "1 node".into() } else { format!("{} nodes", self.nodes) }
    }

    /// Whether the row has the default method and the default quality.
    pub(super) fn is_the_default(&self) -> bool {
        self.method == AUTO && self.quality == DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use crate::bench::samples::row;

    #[test]
    fn a_json_line_has_its_keys_in_order() {
        let line = row("pawn", 13, "auto", "fine", 12.5, 0.25).to_json_line();
        let keys = [
            "scene",
            "nodes",
            "method",
            "size",
            "cpu_ms",
            "wall_ms",
            "steps_per_px",
            "evals_per_px",
            "surface_evals_per_px",
            "wrong_share",
            "grazing_share",
            "depth_p50",
            "depth_p99",
            "depth_max",
            "normal_p50",
            "normal_p99",
            "quality",
            "cpu_ms_spread",
            "steps_p99",
            "steps_max",
            "cells_per_px",
            "entries_per_px",
        ];
        let places: Vec<usize> = keys.iter().map(|key| line.find(&format!("\"{key}\":")).expect(key)).collect();
        assert!(places.is_sorted(), "{line}");
        assert_eq!(line.matches("\":").count(), keys.len());
        assert!(!line.contains('\n'));
    }

    #[test]
    fn what_is_not_finite_is_an_error_and_is_never_null() {
        let mut bad = row("pawn", 13, "auto", "fine", 12.5, 0.1);
        bad.depth_p99 = f64::NAN;
        bad.depth_max = f64::INFINITY;
        let line = bad.to_json_line();
        assert!(!line.contains("null"), "{line}");
        let back: serde_json::Value = serde_json::from_str(&line).unwrap();
        assert_eq!(back["depth_p99"].as_f64(), Some(f64::MAX));
        assert_eq!(back["depth_max"].as_f64(), Some(f64::MAX));
        assert_eq!(bad.check().unwrap_err().to_string(), "pawn, auto: depth_p99 is not a finite number");
        assert_eq!(row("pawn", 13, "auto", "fine", 12.5, 0.0).check(), Ok(()));
    }
}
