//! WGSL source of each pass: includes resolved, and what depends on the evaluator generated.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::sync::{LazyLock, Mutex, PoisonError};

use thiserror::Error;

use super::dual::{DUAL_PRELUDE, dual};
use super::specialise::{Fold, specialise};
use super::{Evaluator, Options, Skipping};
use crate::flat::{FlatScene, MAX_STACK};
use crate::scene::ShapeKind;

/// Every file of `shaders/`, by its path there.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// What the interpreter must be able to evaluate. Kernels are built for it and cached by it, so a
/// changed value never builds one.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Features {
    /// Shapes in use.
    pub shapes: BTreeSet<ShapeKind>,
    /// Accumulators that can be put aside: a power of two.
    pub stack: u32,
}

impl Features {
    /// What `flat` uses.
    pub fn of(flat: &FlatScene) -> Self {
        let mut used = vec![false; ShapeKind::ALL.len()];
        for node in &flat.nodes {
            if node.is_leaf() {
                used[(node.code & 0xffff) as usize] = true;
            }
        }
        let shapes = ShapeKind::ALL.iter().filter(|k| used[**k as usize]).copied().collect();
        let stack = flat.components.iter().map(|c| c.stack).max().unwrap_or(0);
        Self { shapes, stack: stack.max(1).next_power_of_two() }
    }

    /// Everything there is.
    pub fn all() -> Self {
        Self { shapes: ShapeKind::ALL.iter().copied().collect(), stack: MAX_STACK }
    }

    /// Whether a kernel for `self` also serves `other`.
    pub fn covers(&self, other: &Self) -> bool {
        self.stack >= other.stack && self.shapes.is_superset(&other.shapes)
    }

    /// What serves both.
    pub fn union(&self, other: &Self) -> Self {
        Self { shapes: self.shapes.union(&other.shapes).copied().collect(), stack: self.stack.max(other.stack) }
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

/// The arguments of a shape's function, its parameters read from their rows.
fn read_rows(kind: ShapeKind) -> String {
    let row = |i: usize| if i < kind.rows() { format!("scene_row(row + {i}u)") } else { "vec4f(0.0)".to_owned() };
    let data = if kind.has_data() { ", row - LEAF_ROWS + u32(scene_row(row - LEAF_ROWS).w)" } else { "" };
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

/// A shape's function with its gradient; derived once, however many kernels hold it.
fn gradient_wgsl(function: &str) -> Option<String> {
    static DERIVED: LazyLock<Mutex<BTreeMap<String, String>>> = LazyLock::new(Mutex::default);
    let mut derived = DERIVED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(text) = derived.get(function) {
        return Some(text.clone());
    }
    let text = plain_source(&format!("sdf/{}.wgsl", function.strip_prefix("sdf_")?)).ok()?;
    // A shape without a derivative has no kernel; a test derives every one.
    let dual = own_twins(&dual(&with_rows(&text), function).ok()?, function);
    derived.insert(function.to_owned(), dual.clone());
    Some(dual)
}

/// The twins with names of their own: shapes may share functions, and a twin depends on what its shape hands over.
fn own_twins(text: &str, function: &str) -> String {
    let entry = format!("dual_{function}");
    let names = text.lines().filter_map(|line| line.strip_prefix("fn ")?.split('(').next()).filter(|n| *n != entry);
    names.fold(text.to_owned(), |out, name| out.replace(&format!("{name}("), &format!("{name}_of_{function}(")))
}

/// A shape's source with something that stands for the data it reads; their derivative is zero.
fn with_rows(text: &str) -> String {
    if !text.contains("scene_row(") {
        return text.to_owned();
    }
    format!("{text}\nfn scene_row(at: u32) -> vec4f {{ return vec4f(f32(at)); }}\n")
}

/// The whole source of the shader `entry`, each file included once, before its first user.
pub fn source(entry: &str, evaluator: &Evaluator, options: Options) -> Result<String, ShaderError> {
    let mut resolver = Resolver { evaluator, options, seen: BTreeSet::new(), out: String::new() };
    let fineness = options.quality.fineness();
    write!(
        resolver.out,
        "const COUNTING: bool = {};\nconst CONES: bool = {};\nconst SKIPPING: bool = {};\nconst FINENESS: f32 = \
         {fineness:?};\nconst CREEP_SHARE: f32 = {:?};\n",
        options.counting,
        options.cones,
        options.skipping != Skipping::Never,
        fineness.sqrt()
    )
    .expect("strings take all");
    resolver.include(entry, entry)?;
    Ok(resolver.out)
}

/// The same for a shader that evaluates no field.
pub fn plain_source(entry: &str) -> Result<String, ShaderError> {
    let nothing = Evaluator::Interpreted(Features { shapes: BTreeSet::new(), stack: 1 });
    source(entry, &nothing, Options::default())
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
        let generated = self.generated(name);
        let text = match &generated {
            Some(text) => text,
            None => {
                let missing = || ShaderError::NoFile { from: from.to_owned(), name: name.to_owned() };
                FILES.iter().find(|(file, _)| *file == name).ok_or_else(missing)?.1
            }
        };
        for line in text.lines() {
            match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
                Some(included) => self.include(included, name)?,
                None => {
                    self.out.push_str(line);
                    self.out.push('\n');
                }
            }
        }
        Ok(())
    }

    /// Files that do not exist: the evaluator decides what is in them.
    fn generated(&self, name: &str) -> Option<String> {
        use Evaluator::{Generated, Interpreted, Pruned, Specialised};
        let include = |file: &str| Some(format!("#include \"field/{file}.wgsl\""));
        let special = |structure, rows, fold| Some(specialise(structure, rows, fold, self.options));
        match (name, self.evaluator) {
            ("generated/value.wgsl", Interpreted(_)) => include("interpreted_value"),
            ("generated/surface.wgsl", Interpreted(_)) => include("interpreted_surface"),
            ("generated/value.wgsl", Pruned(_)) => include("pruned_value"),
            ("generated/surface.wgsl", Pruned(_)) => include("pruned_surface"),
            ("generated/value.wgsl", Specialised(structure)) => special(structure, None, Fold::Value),
            ("generated/surface.wgsl", Specialised(structure)) => special(structure, None, Fold::Surface),
            ("generated/value.wgsl", Generated(structure, rows)) => special(structure, Some(rows), Fold::Value),
            ("generated/surface.wgsl", Generated(structure, rows)) => special(structure, Some(rows), Fold::Surface),
            ("generated/shapes.wgsl", Interpreted(f) | Pruned(f)) => Some(f.shapes_wgsl()),
            ("generated/gradients.wgsl", Interpreted(f) | Pruned(f)) => Some(f.gradients_wgsl()),
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
    fn files_are_included_once_and_missing_ones_are_named() {
        let text = source("trace.wgsl", &Evaluator::Interpreted(Features::all()), Options::default()).unwrap();
        assert_eq!(text.matches("fn view_direction").count(), 1);
        assert!(!text.contains("#include"));
        let error = plain_source("no_such.wgsl").unwrap_err();
        assert!(error.to_string().contains("no_such.wgsl"));
    }

    #[test]
    fn a_kernel_holds_only_the_shapes_in_use() {
        let features = Features { shapes: [ShapeKind::Sphere].into(), stack: 1 };
        let text = source("trace.wgsl", &Evaluator::Interpreted(features), Options::default()).unwrap();
        assert!(text.contains("fn sdf_sphere") && !text.contains("fn sdf_torus"));
    }
}
