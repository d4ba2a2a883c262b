//! Limits and their exceptions.

use crate::StageMetrics;
use crate::cards::{Card, Report};
use crate::subjects::{EvaluatorKind, NO_FIELD, Purpose, Subjects};

/// The compiler's figures for all pipelines of one purpose on a card: the worst of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The card.
    pub card: Card,
    /// The purpose of the pipelines.
    pub purpose: Purpose,
    /// Number of pipelines.
    pub pipelines: usize,
    /// The worst of each figure.
    pub metrics: StageMetrics,
}

impl StageMetrics {
    /// The worse of each: the fewest waves, and the most of all others.
    fn worst(self, other: Self) -> Self {
        Self {
            vgprs: self.vgprs.max(other.vgprs),
            sgprs: self.sgprs.max(other.sgprs),
            spilled_vgprs: self.spilled_vgprs.max(other.spilled_vgprs),
            spilled_sgprs: self.spilled_sgprs.max(other.spilled_sgprs),
            scratch: self.scratch.max(other.scratch),
            waves: self.waves.min(other.waves),
            inverse_throughput: self.inverse_throughput.max(other.inverse_throughput),
            code_size: self.code_size.max(other.code_size),
            compile_ms: self.compile_ms.max(other.compile_ms),
        }
    }
}

/// A row for each purpose.
pub fn rows(card: &Card, subjects: &Subjects, report: &Report) -> Vec<Row> {
    let row = |(purpose, pipelines): &(Purpose, Vec<usize>)| {
        let stages = || pipelines.iter().flat_map(|index| &report.statistics[*index]).map(|stage| stage.metrics);
        let of_pipelines = pipelines.iter().filter_map(|index| report.statistics[*index].first());
        let compile_ms = of_pipelines.map(|stage| stage.metrics.compile_ms).sum();
        let metrics = StageMetrics { compile_ms, ..stages().reduce(StageMetrics::worst).unwrap_or_default() };
        Row { card: *card, purpose: purpose.clone(), pipelines: pipelines.len(), metrics }
    };
    subjects.purposes.iter().map(row).collect()
}

/// Raised limits for one purpose, with the reason.
#[derive(Clone, Copy, Debug)]
pub struct Exception {
    /// Name of the scene.
    pub scene: &'static str,
    /// The evaluator.
    pub way: EvaluatorKind,
    /// The pass.
    pub pass: &'static str,
    /// Most vector registers, on the card that takes more.
    pub vgprs: u64,
    /// Most spilled vector registers.
    pub spilled: u64,
    /// Reason of the exception.
    pub reason: &'static str,
}

/// For its backward pass, the Mandelbulb keeps two numbers of each of up to 17 steps, with their derivatives: 136
/// registers, because the compiler puts such an array into registers. The surface pass evaluates once per visible
/// pixel. The march has no derivatives and takes 96.
const ORBIT: &str = "the orbit of a fractal, with derivatives, is in registers";
/// The interpreter keeps three surfaces alive at once beside the derivatives of a shape: the one before a modifier, its
/// nearest copy, and the content. Tapes and straight-line code for surfaces with modifiers would avoid this. The march
/// takes 96.
const COPIES: &str = "with modifiers three surfaces are alive at once, beside a shape's derivatives";

/// Exceptions from the limits, as measured with Mesa 22.3.6. Its compiler gives a lane of GFX11 at most 132 registers
/// and spills the rest.
pub const EXCEPTIONS: &[Exception] = &[
    surface("shapes", EvaluatorKind::Interpreter, 256, 373, ORBIT),
    surface("shapes", EvaluatorKind::Straight, 232, 296, ORBIT),
    surface("fractals", EvaluatorKind::Interpreter, 256, 409, ORBIT),
    surface("fractals", EvaluatorKind::Straight, 232, 296, ORBIT),
    surface("modifiers", EvaluatorKind::Interpreter, 136, 4, COPIES),
    surface("modifiers", EvaluatorKind::Straight, 136, 4, COPIES),
    surface("chessboard", EvaluatorKind::Interpreter, 136, 4, COPIES),
    surface("chessboard", EvaluatorKind::Straight, 136, 4, COPIES),
    shadow("shadow", "shapes", 144, 16),
    shadow("shadow", "fractals", 152, 22),
    shadow("shadow occlusion", "shapes", 136, 1),
    shadow("shadow occlusion", "fractals", 136, 7),
    shadow("shadow", "modifiers", 136, 4),
    shadow("shadow", "chessboard", 136, 4),
    shade("shade", 26),
    shade("shade agx", 26),
    shade("shade neutral", 26),
    shade("shade sample", 30),
];

/// Why lighting may take more.
const WHOLE_LIGHT: &str = "textures, layers, area lights and an image around the scene at once; few scenes need all";

const fn shade(pass: &'static str, spilled: u64) -> Exception {
    Exception { scene: NO_FIELD, way: EvaluatorKind::None, pass, vgprs: 160, spilled, reason: WHOLE_LIGHT }
}

/// Why shadows by the interpreter may take more.
const MARCHED: &str = "a cone keeps its state beside that of the interpreter; only scenes without tapes come here";

const fn shadow(pass: &'static str, scene: &'static str, vgprs: u64, spilled: u64) -> Exception {
    Exception { scene, way: EvaluatorKind::Interpreter, pass, vgprs, spilled, reason: MARCHED }
}

const fn surface(scene: &'static str, way: EvaluatorKind, vgprs: u64, spilled: u64, reason: &'static str) -> Exception {
    Exception { scene, way, pass: "surface", vgprs, spilled, reason }
}

/// Faults of these rows: spills, too many registers, and unused exceptions.
pub fn faults(rows: &[Row], exceptions: &[Exception]) -> Vec<String> {
    let is_for = |exception: &Exception, row: &Row| {
        let Purpose { scene, way, pass } = &row.purpose;
        exception.scene == scene && exception.way == *way && exception.pass == pass
    };
    let is_within = |row: &Row| row.metrics.vgprs <= row.card.max_vgprs && row.metrics.spilled_vgprs == 0;
    let mut faults = Vec::new();
    for row in rows {
        let exception = exceptions.iter().find(|exception| is_for(exception, row));
        let [vgprs, spilled] = exception.map_or([row.card.max_vgprs, 0], |e| [e.vgprs, e.spilled]);
        let Purpose { scene, way, pass } = &row.purpose;
        let what = format!("{}: {pass} of {scene} by {}", row.card.name, way.name());
        if row.metrics.spilled_vgprs > spilled {
            faults.push(format!(
                "{what}: {} spilled vector registers are more than {spilled}",
                row.metrics.spilled_vgprs
            ));
        }
        if row.metrics.vgprs > vgprs {
            faults.push(format!("{what}: {} vector registers are more than {vgprs}", row.metrics.vgprs));
        }
    }
    for exception in exceptions {
        let Exception { scene, way, pass, .. } = exception;
        if rows.iter().filter(|row| is_for(exception, row)).all(is_within) {
            faults.push(format!("the exception for {pass} of {scene} by {} is not needed", way.name()));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cards::CARDS;

    const MOST: u64 = CARDS[0].max_vgprs;

    fn row(vgprs: u64, spilled_vgprs: u64) -> Row {
        let purpose = Purpose { scene: "pawn".into(), way: EvaluatorKind::Straight, pass: "trace".into() };
        let metrics = StageMetrics {
            vgprs,
            sgprs: 64,
            spilled_vgprs,
            spilled_sgprs: 3,
            scratch: 0,
            waves: 8,
            inverse_throughput: 1000,
            code_size: 1000,
            compile_ms: 1.0,
        };
        Row { card: CARDS[0], purpose, pipelines: 1, metrics }
    }

    const FOR_PAWN: Exception = Exception {
        scene: "pawn",
        way: EvaluatorKind::Straight,
        pass: "trace",
        vgprs: 192,
        spilled: 2,
        reason: "a sample",
    };

    #[test]
    fn the_worst_of_metrics_has_the_fewest_waves_and_the_most_of_all_else() {
        let [mut a, mut b] = [row(64, 1).metrics, row(80, 0).metrics];
        (a.waves, b.waves, a.scratch, b.code_size) = (6, 12, 16, 2000);
        let worst = StageMetrics { vgprs: 80, spilled_vgprs: 1, waves: 6, scratch: 16, code_size: 2000, ..a };
        assert_eq!((a.worst(b), b.worst(a)), (worst, worst));
    }

    #[test]
    fn what_spills_and_what_takes_too_many_registers_is_refused() {
        assert_eq!(faults(&[row(MOST, 0)], &[]), [""; 0]);
        assert!(faults(&[row(64, 1)], &[])[0].contains("1 spilled vector registers are more than 0"));
        assert!(faults(&[row(MOST + 1, 0)], &[])[0].contains("129 vector registers are more than 128"));
    }

    #[test]
    fn exceptions_allow_what_they_say_and_must_be_needed() {
        assert_eq!(faults(&[row(192, 0)], &[FOR_PAWN]), [""; 0]);
        assert_eq!(faults(&[row(MOST, 2)], &[FOR_PAWN]), [""; 0]);
        assert!(faults(&[row(200, 0)], &[FOR_PAWN])[0].contains("more than 192"));
        assert!(faults(&[row(192, 3)], &[FOR_PAWN])[0].contains("3 spilled vector registers are more than 2"));
        assert!(faults(&[row(MOST, 0)], &[FOR_PAWN])[0].contains("is not needed"));
        assert!(faults(&[], &[FOR_PAWN])[0].contains("is not needed"));
        let elsewhere = Exception { pass: "surface", ..FOR_PAWN };
        assert_eq!(faults(&[row(192, 0)], &[elsewhere]).len(), 2, "it is for another pass");
    }
}
