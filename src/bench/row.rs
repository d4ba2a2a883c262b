//! What one measurement says: one scene, by one method, at one quality.

use serde::Serialize;
use thiserror::Error;

/// The method that the program takes when nobody chooses one; others are compared with it.
pub(super) const AUTO: &str = "auto";
/// The method that is a bound for the others and no way to draw.
pub(super) const LIMIT: &str = "limit";
/// The quality that the program takes when nobody chooses one.
pub(super) const DEFAULT: &str = "default";

/// One measurement. The fields stand in the order in which they are written, as JSON and as CSV.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchRow {
    /// Name of the scene.
    pub scene: String,
    /// How many nodes the scene has.
    pub nodes: usize,
    /// How the picture was made: thesis, baked, interpreter, tape, straight-line, limit or auto.
    pub method: String,
    /// Pixels along each side of the picture.
    pub size: u32,
    /// Milliseconds of all threads together, the median of several runs.
    pub cpu_ms: f64,
    /// Milliseconds on the clock, the median of several runs.
    pub wall_ms: f64,
    /// Steps of the march per pixel.
    pub steps_per_px: f64,
    /// Evaluations of a component's field per pixel, of all passes together: by rays, by cones around tiles, and for normal
    /// and material.
    pub evals_per_px: f64,
    /// Those of them for normal and material: one for each pixel that shows a field.
    pub surface_evals_per_px: f64,
    /// Share of the pixels, 0 to 1, that are wrong: in hit or miss, in the node, or by more than a footprint in depth.
    pub wrong_share: f64,
    /// Share of the pixels, 0 to 1, that differ like that because their rays graze.
    pub grazing_share: f64,
    /// Median of the depth errors, in pixel footprints.
    pub depth_p50: f64,
    /// 99th percentile of the depth errors, in pixel footprints.
    pub depth_p99: f64,
    /// Largest depth error, in pixel footprints.
    pub depth_max: f64,
    /// Median of the angles between the normals and the true ones, in degrees.
    pub normal_p50: f64,
    /// 99th percentile of the angles between the normals and the true ones, in degrees.
    pub normal_p99: f64,
    /// How fine the march was: draft, default or fine.
    pub quality: String,
    /// The slowest run's `cpu_ms` less the fastest's, in milliseconds: below it, differences say nothing.
    pub cpu_ms_spread: f64,
    /// Steps that 99 of 100 pixels do not exceed.
    pub steps_p99: f64,
    /// Most steps of a pixel.
    pub steps_max: f64,
    /// Cells of tapes looked up per pixel, by rays and cones.
    pub cells_per_px: f64,
    /// Entries of tapes read per pixel, by rays and cones.
    pub entries_per_px: f64,
}

/// A number of a row that is infinite or not a number, and so says nothing.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{scene}, {method}: {field} is not a finite number")]
pub struct NotFinite {
    /// The scene of the row.
    pub scene: String,
    /// The method of the row.
    pub method: String,
    /// The name of the first such field.
    pub field: &'static str,
}

impl BenchRow {
    /// Says which number is not finite, if one is. Whoever measures asks this first, so that a failed
    /// measurement ends as an error and not as a number.
    pub fn check(&self) -> Result<(), NotFinite> {
        let mut copy = self.clone();
        match copy.numbers().into_iter().find(|(_, value)| !value.is_finite()) {
            None => Ok(()),
            Some((field, _)) => Err(NotFinite { scene: self.scene.clone(), method: self.method.clone(), field }),
        }
    }

    /// The row as one JSON object without line breaks. JSON knows no infinity, and a `null` would read as
    /// "not measured"; so what is not finite becomes the largest number there is, which passes no limit.
    pub fn to_json_line(&self) -> String {
        serde_json::to_string(&self.clamped()).expect("texts and finite numbers can always be written")
    }

    /// The row with the largest number there is in place of what is not finite: a number that nobody knows must
    /// not look like a good one.
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

    /// How many nodes the scene has, in words.
    pub(super) fn node_count(&self) -> String {
        if self.nodes == 1 { "1 node".into() } else { format!("{} nodes", self.nodes) }
    }

    /// Whether this is how the program draws when nobody chooses anything.
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
