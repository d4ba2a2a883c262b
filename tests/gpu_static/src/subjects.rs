//! Every pipeline that the renderer builds for the example scenes on a graphics card.

use std::collections::HashMap;

use isolith::field::flatten;
use isolith::gallery;
use isolith::render::{EvalStrategy, EvaluatorUse, evaluators_of};
use isolith::wgsl::{Evaluator, FILES, OpSet, Options, SkipMode, assemble_with};
use naga::ShaderStage;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::spirv::{Resource, Shader, SpirvStage};

/// Format of a vertex attribute or a render target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// One float.
    Float,
    /// Two floats.
    Float2,
    /// Three floats.
    Float3,
    /// Four floats.
    Float4,
    /// Four 16-bit floats.
    Half4,
    /// An unsigned integer.
    Uint,
    /// Four bytes, normalized to 0 to 1.
    Unorm4,
}

impl Format {
    /// Size in bytes.
    pub fn size(self) -> u32 {
        match self {
            Self::Float | Self::Uint | Self::Unorm4 => 4,
            Self::Float2 | Self::Half4 => 8,
            Self::Float3 => 12,
            Self::Float4 => 16,
        }
    }
}

/// A pipeline for a driver to compile.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Pipeline {
    /// Name for messages.
    pub name: String,
    /// A compute stage, or a vertex and a fragment stage.
    pub stages: Vec<SpirvStage>,
    /// Bound resources by group and binding.
    pub bindings: Vec<([u32; 2], Resource)>,
    /// Formats of the vertex buffers.
    pub vertex_formats: Vec<Format>,
    /// Formats of the render targets.
    pub color_formats: Vec<Format>,
    /// Whether the pipeline has a depth buffer.
    pub has_depth: bool,
}

/// The purpose of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Purpose {
    /// The example scene, or [`NO_FIELD`].
    pub scene: String,
    /// The evaluator.
    pub way: EvaluatorKind,
    /// The pass, with its entry point if the pass has several.
    pub pass: String,
}

/// The evaluator of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EvaluatorKind {
    /// No field.
    None,
    /// The interpreter.
    Interpreter,
    /// Tapes.
    Lists,
    /// Tapes with modifiers.
    ModifiedLists,
    /// Straight-line code.
    Straight,
}

impl EvaluatorKind {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "–",
            Self::Interpreter => "interpreter",
            Self::Lists => "lists",
            Self::ModifiedLists => "lists below modifiers",
            Self::Straight => "straight-line",
        }
    }

    fn of(evaluator: &Evaluator) -> Self {
        match evaluator {
            Evaluator::Interpreter(_) => Self::Interpreter,
            Evaluator::Tape(features) if features.modifiers.is_empty() => Self::Lists,
            Evaluator::Tape(_) => Self::ModifiedLists,
            Evaluator::StraightLine(_) | Evaluator::Baked(..) => Self::Straight,
        }
    }
}

/// Takes the place of a scene for passes that evaluate no field.
pub const NO_FIELD: &str = "(any)";

/// All pipelines, without duplicates, and those of each purpose by index.
#[derive(Debug, Default)]
pub struct Subjects {
    /// The pipelines.
    pub pipelines: Vec<Pipeline>,
    /// Each purpose with its pipelines.
    pub purposes: Vec<(Purpose, Vec<usize>)>,
}

/// The options for graphics cards.
const OPTIONS: Options = Options {
    counting: false,
    skip_mode: SkipMode::Branches,
    cones: true,
    relaxed: true,
    quality: isolith::wgsl::Quality::Default,
    layers: true,
    area_lights: true,
    image_lit: true,
    shadowed: false,
    copies: false,
    veil: isolith::wgsl::Veil::None,
};

/// Passes that evaluate a field, with their entry points.
const FIELD_PASSES: [[&str; 2]; 3] = [["cone", "cone"], ["trace", "trace"], ["surface", "surface_pass"]];
/// Bindings of these passes with dynamic offsets: the component, its rows, the dispatch.
const FIELD_OFFSETS: [[u32; 2]; 3] = [[1, 2], [1, 4], [3, 0]];

/// The entry points of pass `shadow`, which evaluates the fields of all components by the interpreter or by tapes.
const SHADOW_PASSES: [[&str; 2]; 2] = [["shadow", "shadow"], ["shadow", "shadow_occlusion"]];
/// Its bindings with dynamic offsets.
const SHADOW_OFFSETS: [[u32; 2]; 3] = [[1, 2], [1, 4], [2, 7]];

/// All pipelines to compile.
pub fn subjects() -> Result<Subjects, Error> {
    let mut sources: Vec<(String, &str, &[[u32; 2]])> = Vec::new();
    let mut known: HashMap<(String, &str), usize> = HashMap::new();
    let mut purposes: Vec<(Purpose, Vec<usize>)> = Vec::new();
    for (scene, evaluator) in evaluators()? {
        let is_straight = EvaluatorKind::of(&evaluator) == EvaluatorKind::Straight;
        let of_shadows = SHADOW_PASSES.into_iter().filter(|_| !is_straight).map(|pass| (pass, &SHADOW_OFFSETS));
        for ([pass, entry_point], offsets) in
            FIELD_PASSES.map(|pass| (pass, &FIELD_OFFSETS)).into_iter().chain(of_shadows)
        {
            let failed = |error| Error::Refused { what: format!("{scene}, {pass}"), reason: format!("{error}") };
            // Shadows with the rays of samples need the most.
            let features: &[&str] = if entry_point == "shadow" { &["AMBIENT_RAYS"] } else { &[] };
            let text = assemble_with(&format!("{pass}.wgsl"), &evaluator, OPTIONS, features).map_err(failed)?;
            let index = *known.entry((text, entry_point)).or_insert_with_key(|(text, _)| {
                sources.push((text.clone(), entry_point, offsets.as_slice()));
                sources.len() - 1
            });
            let purpose =
                Purpose { scene: scene.clone(), way: EvaluatorKind::of(&evaluator), pass: named(pass, entry_point) };
            match purposes.iter_mut().find(|(other, _)| *other == purpose) {
                Some((_, all)) if all.contains(&index) => {}
                Some((_, all)) => all.push(index),
                None => purposes.push((purpose, vec![index])),
            }
        }
    }
    let made = sources.par_iter().map(|(text, entry_point, offsets)| compute(entry_point, text, entry_point, offsets));
    let mut all = Subjects { pipelines: made.collect::<Result<_, _>>()?, purposes };
    for (pass, pipeline) in passes_without_fields()? {
        let purpose = Purpose { scene: NO_FIELD.to_owned(), way: EvaluatorKind::None, pass };
        all.purposes.push((purpose, vec![all.pipelines.len()]));
        all.pipelines.push(pipeline);
    }
    Ok(all)
}

/// The name of a pass with this entry point.
fn named(pass: &str, entry_point: &str) -> String {
    if pass == "shadow" { entry_point.replace('_', " ") } else { pass.to_owned() }
}

/// Every evaluator of every scene, for each strategy that the window may choose.
fn evaluators() -> Result<Vec<(String, Evaluator)>, Error> {
    let mut all = Vec::new();
    for (scene, contents) in gallery::all() {
        let failed = |error| Error::Refused { what: scene.to_owned(), reason: format!("{error:?}") };
        let flat = flatten(&contents, 0.0).map_err(failed)?;
        let methods = [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::Auto];
        let uses = methods.into_iter().flat_map(|method| evaluators_of(&flat, method));
        all.extend(uses.map(|EvaluatorUse { evaluator, .. }| (scene.to_owned(), evaluator)));
    }
    Ok(all)
}

/// A compute pipeline for one entry point.
pub fn compute(name: &str, text: &str, entry_point: &str, dynamic: &[[u32; 2]]) -> Result<Pipeline, Error> {
    let shader = Shader::new(name, text)?;
    Ok(Pipeline {
        name: name.to_owned(),
        stages: vec![shader.stage(entry_point, ShaderStage::Compute)?],
        bindings: shader.bindings(dynamic).into_iter().collect(),
        ..Pipeline::default()
    })
}

/// Pipelines for all compute entry points of a file.
pub fn of_file(name: &str, text: &str) -> Result<Vec<Pipeline>, Error> {
    let entry_points = Shader::new(name, text)?.entry_points(ShaderStage::Compute);
    entry_points.iter().map(|entry_point| compute(entry_point, text, entry_point, &FIELD_OFFSETS)).collect()
}

/// Pipelines of all passes without a field.
fn passes_without_fields() -> Result<Vec<(String, Pipeline)>, Error> {
    let mut all = Vec::new();
    let evaluates_fields = |pass: &str| {
        FIELD_PASSES.iter().any(|[field, _]| *field == pass) || pass.starts_with("probe") || pass == "shadow"
    };
    let passes = FILES.iter().filter_map(|(file, _)| file.strip_suffix(".wgsl").filter(|name| !name.contains('/')));
    for pass in passes.filter(|pass| !evaluates_fields(pass)) {
        let failed = |error| Error::Refused { what: pass.to_owned(), reason: format!("{error}") };
        // With all that a scene may need of the pass `shade`.
        let options = Options { shadowed: true, ..OPTIONS };
        let nothing = Evaluator::Interpreter(OpSet::none());
        let text = assemble_with(&format!("{pass}.wgsl"), &nothing, options, &["TEXTURES"]).map_err(failed)?;
        let shader = Shader::new(pass, &text)?;
        for entry_point in shader.entry_points(ShaderStage::Compute) {
            all.push((pass.to_owned(), compute(pass, &text, &entry_point, &FIELD_OFFSETS)?));
        }
        for fragment in shader.entry_points(ShaderStage::Fragment) {
            let name = fragment.trim_end_matches("_fragment").replace('_', " ");
            all.push((name.clone(), drawn(&name, &shader, &fragment)?));
        }
    }
    Ok(all)
}

/// A render pipeline.
fn drawn(name: &str, shader: &Shader, fragment: &str) -> Result<Pipeline, Error> {
    let is_mesh = name == "mesh";
    let vertex = shader.entry_points(ShaderStage::Vertex);
    let failed = || Error::Refused { what: name.to_owned(), reason: "it has no vertex shader".to_owned() };
    let vertex = vertex.first().ok_or_else(failed)?;
    let (vertex_formats, color_formats) = match is_mesh {
        true => (
            vec![Format::Float3, Format::Float3, Format::Float4, Format::Float2],
            vec![Format::Float, Format::Uint, Format::Float4, Format::Half4],
        ),
        false => (Vec::new(), vec![Format::Unorm4]),
    };
    Ok(Pipeline {
        name: name.to_owned(),
        stages: vec![shader.stage(vertex, ShaderStage::Vertex)?, shader.stage(fragment, ShaderStage::Fragment)?],
        bindings: shader.bindings(if is_mesh { &[[1, 0]] } else { &[] }).into_iter().collect(),
        vertex_formats,
        color_formats,
        has_depth: is_mesh,
    })
}
