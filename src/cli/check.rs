//! `isolith check`: what a scene holds, how much of each limit it uses, what is wrong with it.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::failure::Failure;
use super::say;
use crate::flat::{self, FlatScene, MAX_COMPONENT_NODES, MAX_FLAT_NODES, MAX_STACK, flatten};
use crate::mesh::MeshLibrary;
use crate::scene::limits::{MAX_DEPTH, MAX_MATERIALS, MAX_NODES};
use crate::scene::{Scene, file};

/// Arguments of `isolith check`.
#[derive(Debug, clap::Args)]
pub struct CheckArguments {
    /// Scene file
    scene: PathBuf,
    /// Print one JSON object: {nodes, components, tree_depth, warnings}, or {file, node, field, reason}
    /// when the scene cannot be used
    #[arg(long)]
    json: bool,
}

/// Prints what the scene holds. With `--json`, a scene that cannot be used is reported on standard output
/// too, as one object.
pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    match read(&arguments.scene) {
        Ok(report) if arguments.json => say(&report.to_json().to_string()),
        Ok(report) => say(&report.to_text(&arguments.scene)),
        Err(failure) => {
            if let (true, Failure::Scene(error)) = (arguments.json, &failure) {
                say(&serde_json::to_string(error).expect("four strings can always be written"))?;
            }
            Err(failure)
        }
    }
}

struct Report {
    nodes: usize,
    tree_depth: usize,
    materials: usize,
    components: usize,
    entries: usize,
    largest_component: usize,
    stack: u32,
    warnings: Vec<Warning>,
}

struct Warning {
    node: String,
    reason: String,
}

impl From<flat::Warning> for Warning {
    fn from(warning: flat::Warning) -> Self {
        Self { node: format!("{} {}", warning.name, warning.node), reason: warning.reason }
    }
}

fn read(path: &Path) -> Result<Report, Failure> {
    let scene = file::load(path).map_err(Failure::Scene)?;
    let flat = flatten(&scene, 0.0).map_err(|error| Failure::beyond_limit(path, &error))?;
    let mut report = Report::new(&scene, &flat);
    let mut library = MeshLibrary::new(path.parent().map(Path::to_path_buf));
    let (_, missing) = flat.load_meshes(&mut library);
    report.warnings.extend(missing.into_iter().map(Warning::from));
    Ok(report)
}

impl Report {
    fn new(scene: &Scene, flat: &FlatScene) -> Self {
        let counts = flat.components.iter().map(|component| component.count as usize);
        Self {
            nodes: scene.nodes().len(),
            tree_depth: scene.depths().iter().max().map_or(0, |depth| *depth as usize + 1),
            materials: scene.materials().len(),
            components: flat.components.len(),
            entries: flat.nodes.len(),
            largest_component: counts.max().unwrap_or(0),
            stack: flat.components.iter().map(|component| component.stack).max().unwrap_or(0),
            warnings: flat.warnings.iter().cloned().map(Warning::from).collect(),
        }
    }

    fn to_json(&self) -> Value {
        let warnings: Vec<Value> =
            self.warnings.iter().map(|w| json!({ "node": w.node, "reason": w.reason })).collect();
        json!({
            "nodes": self.nodes,
            "components": self.components,
            "tree_depth": self.tree_depth,
            "warnings": warnings,
        })
    }

    fn to_text(&self, path: &Path) -> String {
        let rows = [
            ("nodes", self.nodes, Some(MAX_NODES)),
            ("depth of the tree", self.tree_depth, Some(MAX_DEPTH)),
            ("materials", self.materials, Some(MAX_MATERIALS)),
            ("components", self.components, None),
            ("entries when flat", self.entries, Some(MAX_FLAT_NODES)),
            ("largest component", self.largest_component, Some(MAX_COMPONENT_NODES)),
            ("stack", self.stack as usize, Some(MAX_STACK as usize)),
            ("warnings", self.warnings.len(), None),
        ];
        let mut text = path.display().to_string();
        for (name, value, limit) in rows {
            let of = limit.map_or(String::new(), |limit| format!(" of {limit}"));
            text += &format!("\n  {name:<18} {value:>6}{of}");
        }
        for warning in &self.warnings {
            text += &format!("\nwarning: {}: {}", warning.node, warning.reason);
        }
        text
    }
}
