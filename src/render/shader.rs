//! WGSL source of each pass: includes resolved, and the choice of shapes generated for what a scene uses.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use thiserror::Error;

use crate::flat::{FlatScene, MAX_STACK};
use crate::scene::ShapeKind;

/// Every file of `shaders/`, by its path there.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// What the interpreter must be able to evaluate. Kernels are built for it and cached by it, so a
/// changed value never builds one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
            if !node.is_group() {
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

    /// The generated file: the choice of the shape by its code.
    fn shapes_wgsl(&self) -> String {
        let mut out = String::new();
        for kind in &self.shapes {
            let file = kind.function().trim_start_matches("sdf_");
            writeln!(out, "#include \"sdf/{file}.wgsl\"").expect("strings take all");
        }
        writeln!(out, "const STACK_SIZE: u32 = {}u;", self.stack).expect("strings take all");
        out.push_str("fn shape_distance(shape: u32, p: vec3f, a: vec4f, b: vec4f) -> f32 {\n    switch shape {\n");
        for kind in &self.shapes {
            writeln!(out, "        case {}u: {{ return {}(p, a, b); }}", *kind as u32, kind.function())
                .expect("strings take all");
        }
        out.push_str("        default: { return 1e30; }\n    }\n}\n");
        out
    }
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

/// The whole source of the shader `entry`, each file included once, before its first user.
pub fn source(entry: &str, features: &Features) -> Result<String, ShaderError> {
    let mut out = String::new();
    let mut seen = BTreeSet::new();
    let generated = features.shapes_wgsl();
    include(entry, entry, &generated, &mut seen, &mut out)?;
    Ok(out)
}

fn include(
    name: &str,
    from: &str,
    generated: &str,
    seen: &mut BTreeSet<String>,
    out: &mut String,
) -> Result<(), ShaderError> {
    if !seen.insert(name.to_owned()) {
        return Ok(());
    }
    let text = if name == "generated/shapes.wgsl" {
        generated
    } else {
        let missing = || ShaderError::NoFile { from: from.to_owned(), name: name.to_owned() };
        FILES.iter().find(|(file, _)| *file == name).ok_or_else(missing)?.1
    };
    for line in text.lines() {
        match line.strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"')) {
            Some(included) => include(included, name, generated, seen, out)?,
            None => {
                out.push_str(line);
                out.push('\n');
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_included_once_and_missing_ones_are_named() {
        let text = source("trace.wgsl", &Features::all()).unwrap();
        assert_eq!(text.matches("fn view_direction").count(), 1);
        assert!(!text.contains("#include"));
        let error = source("no_such.wgsl", &Features::all()).unwrap_err();
        assert!(error.to_string().contains("no_such.wgsl"));
    }

    #[test]
    fn a_kernel_holds_only_the_shapes_in_use() {
        let features = Features { shapes: [ShapeKind::Sphere].into(), stack: 1 };
        let text = source("trace.wgsl", &features).unwrap();
        assert!(text.contains("fn sdf_sphere") && !text.contains("fn sdf_torus"));
    }
}
