//! Assembles the whole WGSL source of each pass, with generated text for the parts that depend on the evaluator.

use std::fmt::Write as _;

use super::calls::{gradients_wgsl, shapes_wgsl};
use super::dual::DUAL_PRELUDE;
use super::evaluator::Evaluator;
use super::files::{ShaderError, resolve};
use super::gradients::gradient_wgsl;
use super::lookahead;
use super::modifiers::{modifier_gradients_wgsl, modifiers_wgsl};
use super::op_set::OpSet;
use super::options::{Options, SkipMode, Veil};
use super::specialize::{Fold, specialize};

/// The whole source of the shader `entry`. It contains each file once, before its first user.
pub fn assemble(entry: &str, evaluator: &Evaluator, options: Options) -> Result<String, ShaderError> {
    assemble_with(entry, evaluator, options, &[])
}

/// The same with the parts between `#if` and `#end` for these features.
pub fn assemble_with(
    entry: &str,
    evaluator: &Evaluator,
    options: Options,
    features: &[&str],
) -> Result<String, ShaderError> {
    let mut out = String::new();
    let (fineness, ops) = (options.quality.fineness(), evaluator.op_set());
    let extended = ops.extended;
    write!(
        out,
        "const COUNTING: bool = {};\nconst CONES: bool = {};\nconst RELAXED: bool = {};\nconst SKIPPING: bool = {};\nconst RETURNS_EARLY: bool = {};\nconst FINENESS: f32 = \
         {fineness:?};\nconst MIN_STEP_SCALE: f32 = {:?};\nconst CLOSE_IS_HIT: bool = {};\nconst EXTENDED_JOINS: bool = {};\nconst EXTENDED_KERNELS: bool = {};\nconst LAYERS: bool = {};\nconst AREA_LIGHTS: bool = {};\nconst IMAGE_LIT: bool = {};\n",
        options.counting,
        options.cones,
        options.relaxed,
        options.skip_mode != SkipMode::Never,
        options.skip_mode == SkipMode::Branches || !evaluator.is_straight(),
        fineness.sqrt(),
        !ops.is_rough(),
        extended.joins,
        extended.kernels,
        options.layers,
        options.area_lights,
        options.image_lit
    )
    .expect("strings take all");
    out += &lookahead::constants(evaluator, options);
    let modifiers = (!ops.modifiers.is_empty()).then_some("MODIFIERS");
    let veils = match options.veil {
        _ if entry != "trace.wgsl" => &[],
        Veil::None => &[][..],
        Veil::Plain => &["VEILED"],
        Veil::Textured => &["VEILED", "TEXTURES"],
    };
    let features: Vec<&str> = features.iter().chain(veils).copied().chain(modifiers).collect();
    out += &resolve(entry, &features, &|name| match name {
        "generated/instancer.wgsl" => Some(instancer(&features)),
        _ => generated(name, evaluator, options),
    })?;
    // One of several instancers has the name of the only one: the same files serve both.
    Ok(if features.contains(&SCENE_COPIES) { out.replace("instancer.", "instancers[instancer_at].") } else { out })
}

/// The feature of passes that query the whole scene: it has instancers.
pub const SCENE_COPIES: &str = "SCENE_COPIES";

/// The bindings of the instancer of a dispatch, or of all.
fn instancer(features: &[&str]) -> String {
    let file = if features.contains(&SCENE_COPIES) { "instancers_of_scene" } else { "instancer_of_dispatch" };
    format!("#include \"copy/{file}.wgsl\"")
}

/// The source of a shader that evaluates no field.
pub fn assemble_plain(entry: &str) -> Result<String, ShaderError> {
    assemble_featured(entry, &[])
}

/// The same with the parts between `#if` and `#end` for these features.
pub fn assemble_featured(entry: &str, features: &[&str]) -> Result<String, ShaderError> {
    let nothing = Evaluator::Interpreter(OpSet::none());
    assemble_with(entry, &nothing, Options::default(), features)
}

/// The text of files that exist only as generated text, which depends on the evaluator.
fn generated(name: &str, evaluator: &Evaluator, options: Options) -> Option<String> {
    use Evaluator::{Baked, Interpreter, StraightLine, Tape};
    let include = |file: &str| Some(format!("#include \"field/{file}.wgsl\""));
    let special = |structure, rows, fold| Some(specialize(structure, rows, fold, options));
    match (name, evaluator) {
        ("generated/value.wgsl", Interpreter(_)) => include("interpreted_value"),
        ("generated/surface.wgsl", Interpreter(_)) => include("interpreted_surface"),
        ("generated/value.wgsl", Tape(f)) if f.modifiers.is_empty() => include("tape_value"),
        ("generated/surface.wgsl", Tape(f)) if f.modifiers.is_empty() => include("tape_surface"),
        ("generated/value.wgsl", Tape(_)) => include("tape_modified_value"),
        ("generated/surface.wgsl", Tape(_)) => include("tape_modified_surface"),
        ("generated/value.wgsl", StraightLine(structure)) => special(structure, None, Fold::Value),
        ("generated/surface.wgsl", StraightLine(s) | Baked(s, _)) if s.is_modified() => include("interpreted_surface"),
        ("generated/surface.wgsl", StraightLine(structure)) => special(structure, None, Fold::Surface),
        ("generated/value.wgsl", Baked(structure, rows)) => special(structure, Some(rows), Fold::Value),
        ("generated/surface.wgsl", Baked(structure, rows)) => special(structure, Some(rows), Fold::Surface),
        ("generated/slack.wgsl", Tape(f)) if f.modifiers.is_empty() => include("tape_slack"),
        ("generated/slack.wgsl", _) => include("no_slack"),
        ("generated/trace_march.wgsl", _) if options.veil != Veil::None => {
            Some(format!("#include \"{}/trace_veiled.wgsl\"", if options.copies { "copy" } else { "common" }))
        }
        ("generated/trace_march.wgsl", _) if options.copies => Some("#include \"copy/trace.wgsl\"".into()),
        ("generated/trace_march.wgsl", _) => Some("#include \"common/trace_march.wgsl\"".into()),
        ("generated/surface_seen.wgsl", _) if options.copies => Some("#include \"copy/surface.wgsl\"".into()),
        ("generated/surface_seen.wgsl", _) => Some("#include \"common/surface_seen.wgsl\"".into()),
        ("generated/shares.wgsl", _) if options.shadowed => Some("#include \"light/shares.wgsl\"".into()),
        ("generated/shares.wgsl", _) => Some("#include \"light/no_shares.wgsl\"".into()),
        ("generated/shapes.wgsl", _) => Some(shapes_wgsl(&evaluator.op_set())),
        ("generated/gradients.wgsl", _) => Some(gradients_wgsl(&evaluator.op_set())),
        ("generated/modifiers.wgsl", _) => Some(modifiers_wgsl(&evaluator.op_set().modifiers)),
        ("generated/modifier_gradients.wgsl", _) => Some(modifier_gradients_wgsl(&evaluator.op_set().modifiers)),
        ("generated/dual.wgsl", _) => Some(DUAL_PRELUDE.to_owned()),
        _ => {
            let function = name.strip_prefix("generated/dual/")?.strip_suffix(".wgsl")?;
            gradient_wgsl(function).map(|text| format!("#include \"generated/dual.wgsl\"\n{text}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::super::op_set::shape_loops;
    use super::*;
    use isolith_scene::ShapeKind;

    #[test]
    fn files_are_included_once_and_missing_ones_are_named() {
        let text = assemble("trace.wgsl", &Evaluator::Interpreter(OpSet::all()), Options::default()).unwrap();
        assert_eq!(text.matches("fn view_direction").count(), 1);
        assert!(!text.contains("#include"));
        let error = assemble_plain("no_such.wgsl").unwrap_err();
        assert!(error.to_string().contains("no_such.wgsl"));
    }

    #[test]
    fn loops_of_shapes_are_known() {
        for kind in ShapeKind::ALL {
            let text = assemble_plain(&format!("sdf/{}.wgsl", kind.function().trim_start_matches("sdf_"))).unwrap();
            let found: usize = ["for (", "while ", "loop {"].map(|word| text.matches(word).count()).iter().sum();
            assert_eq!(shape_loops(*kind)[0] as usize, found, "{kind:?}");
        }
    }

    #[test]
    fn a_source_holds_only_the_shapes_in_use() {
        let ops = OpSet { shapes: [ShapeKind::Sphere].into(), ..OpSet::none() };
        let text = assemble("trace.wgsl", &Evaluator::Interpreter(ops), Options::default()).unwrap();
        assert!(text.contains("fn sdf_sphere") && !text.contains("fn sdf_torus"));
        for &kind in &OpSet::all().modifiers {
            let holds = |modifiers: BTreeSet<_>| {
                let ops = OpSet { modifiers, stack: 2, ..OpSet::none() };
                let text = assemble("trace.wgsl", &Evaluator::Interpreter(ops), Options::default()).unwrap();
                text.contains(&format!("fn mod_{}", super::super::modifiers::file(kind)))
            };
            let others = OpSet::all().modifiers.into_iter().filter(|other| *other != kind).collect();
            assert!(holds([kind].into()) && !holds(others) && !holds(BTreeSet::new()), "{kind:?}");
        }
    }
}
