//! WGSL source of each pass: includes resolved, and what depends on the evaluator generated.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use thiserror::Error;

use super::dual::DUAL_PRELUDE;
use super::gradients::gradient_wgsl;
use super::lookahead;
use super::modifiers::{modifier_gradients_wgsl, modifiers_wgsl};
use super::specialize::{Fold, specialize};
use super::{Evaluator, Options, SkipMode};
use crate::flat::{
    self, FIRST_EXTENDED_KERNEL, FlatNode, FlatScene, Join, LEAF_ROWS, MAX_STACK, modifier_rows, payload_row,
};
use crate::scene::{ModifierKind, ShapeKind};

/// Every file of `shaders/`, by its path there.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// What the interpreter must be able to evaluate. Pipelines are built for it and cached by it, so a
/// changed value never builds one.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct OpSet {
    /// Shapes in use.
    pub shapes: BTreeSet<ShapeKind>,
    /// Modifiers in use.
    pub modifiers: BTreeSet<ModifierKind>,
    /// Accumulators that can be put aside: a power of two.
    pub stack: u32,
    /// Operators and blend kernels beyond the first three.
    pub extended: Extended,
}

/// Which of the operators a source holds: those beyond the first three are left out where nothing needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Extended {
    /// Whether there are operators beyond union, intersection and difference.
    pub joins: bool,
    /// Whether there are blends beyond circular, quadratic and cubic ones.
    pub kernels: bool,
}

impl Extended {
    /// What these entries need.
    fn of(nodes: &[FlatNode]) -> Self {
        Self {
            joins: nodes.iter().any(|node| Join::ALL[node.join() as usize].is_extended()),
            kernels: nodes.iter().any(|node| node.kernel() >= FIRST_EXTENDED_KERNEL),
        }
    }
}

impl OpSet {
    /// What `flat` uses.
    pub fn of(flat: &FlatScene) -> Self {
        let mut used = vec![false; ShapeKind::ALL.len()];
        let mut modifiers = BTreeSet::new();
        for node in &flat.nodes {
            if let Some(kind) = node.modifier() {
                modifiers.insert(kind);
            } else if node.is_leaf() {
                used[(node.code & 0xffff) as usize] = true;
            }
        }
        let shapes = ShapeKind::ALL.iter().filter(|k| used[**k as usize]).copied().collect();
        let stack = flat.components.iter().map(|c| c.stack).max().unwrap_or(0);
        Self { shapes, modifiers, stack: stack.max(1).next_power_of_two(), extended: Extended::of(&flat.nodes) }
    }

    /// Nothing.
    pub fn none() -> Self {
        Self { shapes: BTreeSet::new(), modifiers: BTreeSet::new(), stack: 1, extended: Extended::default() }
    }

    /// Everything there is.
    pub fn all() -> Self {
        Self {
            shapes: ShapeKind::ALL.iter().copied().collect(),
            modifiers: ModifierKind::ALL.iter().copied().filter(|kind| modifier_rows(*kind) > 0).collect(),
            stack: MAX_STACK,
            extended: Extended { joins: true, kernels: true },
        }
    }

    /// Loops that the code holds besides the walk itself. lavapipe counts one iteration of each for every entry
    /// that is walked, also where no lane enters it.
    pub fn loops(&self) -> u32 {
        let modifiers = if self.modifiers.is_empty() { 0 } else { MODIFIER_LOOPS };
        modifiers + self.shapes.iter().map(|kind| shape_loops(*kind)[0]).sum::<u32>()
    }

    /// Whether a pipeline for `self` also serves `other`.
    pub fn covers(&self, other: &Self) -> bool {
        let has = |a: bool, b: bool| a || !b;
        self.stack >= other.stack
            && self.shapes.is_superset(&other.shapes)
            && self.modifiers.is_superset(&other.modifiers)
            && has(self.extended.joins, other.extended.joins)
            && has(self.extended.kernels, other.extended.kernels)
    }

    /// Whether it holds hardly more than `other`: a few shapes, no loops.
    pub fn is_near(&self, other: &Self) -> bool {
        const FEW: usize = 3;
        // Rough ones draw otherwise: what a picture is like must not depend on those before it.
        self.is_rough() == other.is_rough()
            && self.loops() == other.loops()
            && self.shapes.len() <= other.shapes.len() + FEW
    }

    /// Whether rays may come as near to 0 as to a surface, and touch nothing: fields of fractals and landscapes may be far
    /// below the distance, and so may what is divided by the stretch of a deformation. Then nothing but a change of sign
    /// is a hit, and oversteps are short: they would pass bumps of a fraction of a pixel.
    fn is_rough(&self) -> bool {
        use ShapeKind::{Heightmap, Julia, Kleinian, Mandelbulb, MengerSponge, Ocean, Terrain};
        let is_rough = |kind: &ShapeKind| {
            matches!(kind, Julia | Kleinian | Mandelbulb | MengerSponge | Terrain | Heightmap | Ocean)
        };
        self.shapes.iter().any(is_rough) || self.modifiers.iter().any(|kind| flat::is_rough(*kind))
    }

    /// The generated file: the choice of the shape by its code. Each shape reads only the rows it has, from
    /// `row` on.
    fn shapes_wgsl(&self) -> String {
        let mut out = String::new();
        for kind in &self.shapes {
            writeln!(out, "{}", shape_include(*kind)).expect("strings take all");
        }
        writeln!(out, "const STACK_SIZE: u32 = {}u;", self.stack).expect("strings take all");
        let call = |kind: ShapeKind| format!("{}({})", kind.function(), read_rows(kind));
        self.choice(&mut out, "shape_distance", ["f32", "1e30"], &call);
        out
    }

    /// The generated file: the same choice of the gradients.
    fn gradients_wgsl(&self) -> String {
        let mut out = String::new();
        for kind in &self.shapes {
            writeln!(out, "{}", gradient_include(*kind)).expect("strings take all");
        }
        let call = |kind: ShapeKind| format!("dual_{}({})", kind.function(), read_rows(kind));
        self.choice(&mut out, "shape_gradient", ["vec4f", "vec4f(0.0)"], &call);
        out
    }

    /// A function that calls what belongs to the shape.
    fn choice(&self, out: &mut String, name: &str, [result, nothing]: [&str; 2], call: &dyn Fn(ShapeKind) -> String) {
        writeln!(out, "fn {name}(shape: u32, p: vec3f, row: u32) -> {result} {{\n    switch shape {{")
            .expect("strings take all");
        for kind in &self.shapes {
            writeln!(out, "        case {}u: {{ return {}; }}", *kind as u32, call(*kind)).expect("strings take all");
        }
        writeln!(out, "        default: {{ return {nothing}; }}\n    }}\n}}").expect("strings take all");
    }
}

/// Loops in the code about modifiers: the choice of the next copy, steps of recursions, layers of noise, each for
/// every place it is called from.
const MODIFIER_LOOPS: u32 = 16;

/// Loops in a shape's function, and how many iterations they take together at most; those over data come on top, at most
/// one for each of the shape's rows.
pub fn shape_loops(kind: ShapeKind) -> [u32; 2] {
    match kind {
        ShapeKind::MengerSponge => [1, 8],
        ShapeKind::Julia | ShapeKind::Kleinian => [2, 64],
        // Up to 16 powers by 5 squarings each, and as many ways back by 6 steps each.
        ShapeKind::Mandelbulb => [4, 240],
        ShapeKind::Tube | ShapeKind::Extrusion | ShapeKind::Revolution | ShapeKind::Text => [3, 0],
        ShapeKind::Terrain | ShapeKind::Ocean => [1, 0],
        _ => [0, 0],
    }
}

/// Whether pipelines for templates hold the shape: it neither loops nor has data.
pub fn fits_templates(kind: ShapeKind) -> bool {
    !kind.is_iterated() && !kind.has_data()
}

/// The arguments of a shape's function, its parameters read from their rows, and where its data begin.
fn read_rows(kind: ShapeKind) -> String {
    let parameters = kind.parameter_rows();
    let row = |i: usize| if i < parameters { format!("scene_row(row + {i}u)") } else { "vec4f(0.0)".to_owned() };
    let data = |at: usize| format!(", row + {at}u + u32(scene_row(row + {at}u).y)");
    let data = payload_row(kind).map_or(String::new(), |at| data(at - LEAF_ROWS));
    format!("p, {}, {}{data}", row(0), row(1))
}

/// Why a shader could not be put together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ShaderError {
    /// An include names no file.
    #[error("{from}: includes {name}, which does not exist")]
    NoFile {
        /// The including file.
        from: String,
        /// What it includes.
        name: String,
    },
}

/// The line that includes a shape's function.
pub(super) fn shape_include(kind: ShapeKind) -> String {
    format!("#include \"sdf/{}.wgsl\"", kind.function().trim_start_matches("sdf_"))
}

/// The line that includes a shape's function together with its gradient.
pub(super) fn gradient_include(kind: ShapeKind) -> String {
    format!("#include \"generated/dual/{}.wgsl\"", kind.function())
}

/// The whole source of the shader `entry`, each file included once, before its first user.
pub fn assemble(entry: &str, evaluator: &Evaluator, options: Options) -> Result<String, ShaderError> {
    let mut resolver = Resolver { evaluator, options, seen: BTreeSet::new(), out: String::new() };
    let (fineness, ops) = (options.quality.fineness(), evaluator.op_set());
    let extended = ops.extended;
    write!(
        resolver.out,
        "const COUNTING: bool = {};\nconst CONES: bool = {};\nconst RELAXED: bool = {};\nconst SKIPPING: bool = {};\nconst RETURNS_EARLY: bool = {};\nconst FINENESS: f32 = \
         {fineness:?};\nconst MIN_STEP_SCALE: f32 = {:?};\nconst CLOSE_IS_HIT: bool = {};\nconst EXTENDED_JOINS: bool = {};\nconst EXTENDED_KERNELS: bool = {};\n",
        options.counting,
        options.cones,
        options.relaxed,
        options.skip_mode != SkipMode::Never,
        options.skip_mode == SkipMode::Branches || !evaluator.is_straight(),
        fineness.sqrt(),
        !ops.is_rough(),
        extended.joins,
        extended.kernels
    )
    .expect("strings take all");
    resolver.out += &lookahead::constants(evaluator, options);
    resolver.include(entry, entry)?;
    Ok(resolver.out)
}

/// The same for a shader that evaluates no field.
pub fn assemble_plain(entry: &str) -> Result<String, ShaderError> {
    let nothing = Evaluator::Interpreter(OpSet::none());
    assemble(entry, &nothing, Options::default())
}

struct Resolver<'a> {
    evaluator: &'a Evaluator,
    options: Options,
    seen: BTreeSet<String>,
    out: String,
}

impl Resolver<'_> {
    fn include(&mut self, name: &str, from: &str) -> Result<(), ShaderError> {
        if !self.seen.insert(name.to_owned()) {
            return Ok(());
        }
        let mut generated = self.generated(name);
        if let Some(text) = generated.as_mut().filter(|_| name.starts_with("generated/dual/")) {
            // Dual functions of functions that several shapes call stand in each of their texts, and are written once.
            let fresh = text.split("\n\n").filter(|part| self.seen.insert((*part).trim_end().to_owned()));
            *text = fresh.collect::<Vec<_>>().join("\n\n");
        }
        let text = match &generated {
            Some(text) => text,
            None => {
                let missing = || ShaderError::NoFile { from: from.to_owned(), name: name.to_owned() };
                FILES.iter().find(|(file, _)| *file == name).ok_or_else(missing)?.1
            }
        };
        // What stands between `#if MODIFIERS` and `#end` is for scenes that have some.
        let has_modifiers = !self.evaluator.op_set().modifiers.is_empty();
        let mut is_wanted = true;
        for line in text.lines() {
            match line {
                "#if MODIFIERS" => is_wanted = has_modifiers,
                "#end" => is_wanted = true,
                _ if is_wanted => self.line(line, name)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn line(&mut self, line: &str, name: &str) -> Result<(), ShaderError> {
        match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            Some(included) => self.include(included, name),
            None => {
                self.out.push_str(line);
                self.out.push('\n');
                Ok(())
            }
        }
    }

    /// Files that do not exist: the evaluator decides what is in them.
    fn generated(&self, name: &str) -> Option<String> {
        use Evaluator::{Baked, Interpreter, StraightLine, Tape};
        let include = |file: &str| Some(format!("#include \"field/{file}.wgsl\""));
        let special = |structure, rows, fold| Some(specialize(structure, rows, fold, self.options));
        match (name, self.evaluator) {
            ("generated/value.wgsl", Interpreter(_)) => include("interpreted_value"),
            ("generated/surface.wgsl", Interpreter(_)) => include("interpreted_surface"),
            ("generated/value.wgsl", Tape(f)) if f.modifiers.is_empty() => include("tape_value"),
            ("generated/surface.wgsl", Tape(f)) if f.modifiers.is_empty() => include("tape_surface"),
            ("generated/value.wgsl", Tape(_)) => include("tape_modified_value"),
            ("generated/surface.wgsl", Tape(_)) => include("tape_modified_surface"),
            ("generated/value.wgsl", StraightLine(structure)) => special(structure, None, Fold::Value),
            ("generated/surface.wgsl", StraightLine(s) | Baked(s, _)) if s.is_modified() => {
                include("interpreted_surface")
            }
            ("generated/surface.wgsl", StraightLine(structure)) => special(structure, None, Fold::Surface),
            ("generated/value.wgsl", Baked(structure, rows)) => special(structure, Some(rows), Fold::Value),
            ("generated/surface.wgsl", Baked(structure, rows)) => special(structure, Some(rows), Fold::Surface),
            ("generated/shapes.wgsl", _) => Some(self.evaluator.op_set().shapes_wgsl()),
            ("generated/gradients.wgsl", _) => Some(self.evaluator.op_set().gradients_wgsl()),
            ("generated/modifiers.wgsl", _) => Some(modifiers_wgsl(&self.evaluator.op_set().modifiers)),
            ("generated/modifier_gradients.wgsl", _) => {
                Some(modifier_gradients_wgsl(&self.evaluator.op_set().modifiers))
            }
            ("generated/dual.wgsl", _) => Some(DUAL_PRELUDE.to_owned()),
            _ => {
                let function = name.strip_prefix("generated/dual/")?.strip_suffix(".wgsl")?;
                gradient_wgsl(function).map(|text| format!("#include \"generated/dual.wgsl\"\n{text}"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_are_iterated_are_those_without_data_that_loop() {
        for &kind in ShapeKind::ALL.iter().filter(|kind| !kind.has_data()) {
            assert_eq!(shape_loops(kind)[0] > 0, kind.is_iterated(), "{kind:?}");
        }
    }

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
