//! `isolith shader`: the assembled WGSL of a pass, with all files and generated code in one text.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::failure::Failure;
use super::input::{read_scene, shown};
use super::text::say;
use crate::bench::Baseline;
use crate::field::flatten;
use crate::render::{EvalStrategy, EvaluatorUse, evaluators_of};
use crate::scene::ShapeKind;
use crate::wgsl::{Evaluator, FILES, OpSet, Options, SkipMode, assemble};

/// Arguments of `isolith shader`.
#[derive(Debug, clap::Args)]
pub struct ShaderArguments {
    /// Scene file; - reads standard input. Without one fields are those of every shape, modifier and operator
    scene: Option<PathBuf>,
    /// List the passes, and the evaluators that the scene has pipelines for
    #[arg(long)]
    list: bool,
    /// Pass to print
    #[arg(long, value_name = "NAME", default_value = "trace")]
    pass: String,
    /// Evaluator of the field, by its number in the list
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    evaluator: usize,
    /// How components are evaluated: auto, interpreter, tape, straight-line or baked
    #[arg(long, value_name = "METHOD", default_value = "auto", value_parser = parse_method)]
    method: EvalStrategy,
    /// What the source is for: card (code out of reach is skipped by branches) or processor (values are selected)
    #[arg(long = "for", value_name = "DEVICE", default_value = "card", value_parser = parse_device)]
    device: SkipMode,
    /// With the code that counts steps and evaluations
    #[arg(long)]
    counting: bool,
}

/// Names of kinds of devices, and how their pipelines skip code that is out of reach.
const DEVICES: [(&str, SkipMode); 2] = [("card", SkipMode::Branches), ("processor", SkipMode::Selects)];

fn parse_method(name: &str) -> Result<EvalStrategy, String> {
    name.parse().ok().and_then(Baseline::strategy).ok_or_else(|| {
        let named = Baseline::ALL.into_iter().filter(|method| method.strategy().is_some()).map(Baseline::name);
        format!("it is none of {}", named.collect::<Vec<_>>().join(", "))
    })
}

fn parse_device(name: &str) -> Result<SkipMode, String> {
    let device = DEVICES.iter().find(|(other, _)| *other == name).map(|(_, mode)| *mode);
    device.ok_or_else(|| format!("it is none of {}", DEVICES.map(|(name, _)| name).join(", ")))
}

/// Prints the source of a pass, or lists passes and evaluators.
pub fn shader(arguments: &ShaderArguments) -> Result<(), Failure> {
    let uses = uses(arguments)?;
    if arguments.list {
        return list(&uses);
    }
    if !passes().any(|pass| pass == arguments.pass) {
        let passes = passes().collect::<Vec<_>>().join(", ");
        return Err(Failure::Usage(format!("there is no pass \"{}\"; the passes are {passes}", arguments.pass)));
    }
    let Some(EvaluatorUse { evaluator, .. }) = uses.get(arguments.evaluator) else {
        let (number, count) = (arguments.evaluator, uses.len());
        return Err(Failure::Usage(format!(
            "there is no evaluator {number}: --list shows the {count} of this scene, from 0 on"
        )));
    };
    let options = Options { skip_mode: arguments.device, counting: arguments.counting, ..Options::default() };
    let text = assemble(&format!("{}.wgsl", arguments.pass), evaluator, options);
    say(text.map_err(|error| Failure::Other(error.to_string()))?.trim_end())
}

/// The evaluators of the scene; without a scene, the interpreter with every shape, modifier and operator.
fn uses(arguments: &ShaderArguments) -> Result<Vec<EvaluatorUse>, Failure> {
    let Some(path) = &arguments.scene else {
        return Ok(vec![EvaluatorUse { evaluator: Evaluator::Interpreter(OpSet::all()), components: Vec::new() }]);
    };
    let scene = read_scene(path)?;
    let flat = flatten(&scene, 0.0).map_err(|error| Failure::beyond_limit(&shown(path), &error))?;
    Ok(evaluators_of(&flat, arguments.method))
}

/// Names of the passes: the shader files at the top level.
fn passes() -> impl Iterator<Item = &'static str> {
    FILES.iter().filter_map(|(file, _)| file.strip_suffix(".wgsl")).filter(|name| !name.contains('/'))
}

fn list(uses: &[EvaluatorUse]) -> Result<(), Failure> {
    say(&format!("passes: {}", passes().collect::<Vec<_>>().join(", ")))?;
    for (number, EvaluatorUse { evaluator, components }) in uses.iter().enumerate() {
        let (what, shapes) = describe(evaluator);
        let shapes: Vec<_> = shapes.into_iter().map(ShapeKind::label).collect();
        say(&format!("evaluator {number}: {what}; components: {}; shapes: {}", components.len(), shapes.join(", ")))?;
    }
    Ok(())
}

/// The description of an evaluator with the shapes that it evaluates.
fn describe(evaluator: &Evaluator) -> (String, BTreeSet<ShapeKind>) {
    match evaluator {
        Evaluator::Interpreter(ops) => ("interpreter".to_owned(), ops.shapes.clone()),
        Evaluator::Tape(ops) => {
            let below = if ops.modifiers.is_empty() { "" } else { " below modifiers" };
            (format!("tapes{below}"), ops.shapes.clone())
        }
        Evaluator::StraightLine(structure) | Evaluator::Baked(structure, _) => {
            let values = if matches!(evaluator, Evaluator::Baked(..)) { " with its values" } else { "" };
            let any = if structure.is_template() { " of any of its shapes" } else { "" };
            let count = structure.entries.len();
            let entries = if count == 1 { "entry" } else { "entries" };
            let what = format!("straight-line code for {count} {entries}{any}{values}");
            (what, structure.shapes().shapes().collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_have_the_names_that_the_bench_has_for_them() {
        for (name, strategy) in [("straight-line", EvalStrategy::StraightLine), ("pruned", EvalStrategy::Tape)] {
            assert_eq!(parse_method(name), Ok(strategy));
        }
        for refused in ["fastest", "thesis", "limit"] {
            let reason = parse_method(refused).expect_err(refused);
            assert!(reason.contains("interpreter, tape") && !reason.contains("thesis"), "{reason}");
        }
        assert!(parse_device("toaster").is_err_and(|reason| reason.contains("card, processor")));
    }
}
