//! `isolith check`: contents of scenes, their use of each limit, and their faults.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::failure::Failure;
use super::input::{folder, read_scene, shown};
use super::text::{complain, say};
use crate::field::{self, Cancel, FlatScene, Usage, flatten_until};
use crate::font::MAX_TEXT_ARCS;
use crate::mesh::{MeshLibrary, TriangleMesh};
use crate::scene::limits::{
    MAX_ATTACHMENT_BYTES, MAX_DEPTH, MAX_KEYS, MAX_MATERIALS, MAX_NODES, MAX_SCENE_PIXELS, MAX_TRACKS,
};
use crate::scene::{Node, NodeId, NodeKind, Object, Param, ParamPath, ParamValue, Scene, Shape, text_profile};
use crate::session::{library_of, pose_of};

/// Arguments of `isolith check`.
#[derive(Debug, clap::Args)]
pub struct CheckArguments {
    /// Scene files; - reads standard input
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Print one JSON object a scene and line: {ok, file, nodes, components, tree_depth, cameras, clips, limits,
    /// warnings}, or {ok, file, node, field, reason} for a scene that cannot be used
    #[arg(long)]
    json: bool,
    /// Make warnings errors, such as a model that is missing
    #[arg(long)]
    strict: bool,
    /// List every parameter: its path, its value with unit, the range that it may have, its default. With --json as params:
    /// [{path, label, value, unit, least, most, default, animatable}]; least and most are null where the value is no number
    #[arg(long)]
    params: bool,
}

/// Prints the contents of each scene. With `--json`, scenes that cannot be used are reported on standard output too, as
/// one object each. Checks all scenes; the first failure decides the exit code.
pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for path in &arguments.scenes {
        let looked_at = read(path, arguments.params).and_then(|report| {
            let is_fine = report.warnings.is_empty() || !arguments.strict;
            match arguments.json {
                true => say(&report.to_json(&shown(path), is_fine).to_string())?,
                false => say(&report.to_text(&shown(path)))?,
            }
            let count = report.warnings.len();
            if is_fine { Ok(()) } else { Err(Failure::Strict { file: shown(path), count }) }
        });
        match looked_at {
            Ok(()) => {}
            Err(failure @ Failure::Scene(_)) => {
                if arguments.json {
                    say(&failure.to_json(path).to_string())?;
                }
                failures.push(failure);
            }
            Err(failure @ Failure::Strict { .. }) => failures.push(failure),
            Err(failure) => return Err(failure),
        }
    }
    let (bad, all) = (failures.len(), arguments.scenes.len());
    if bad <= 1 && all == 1 {
        return failures.pop().map_or(Ok(()), Err);
    }
    failures.iter().for_each(|failure| complain(&format!("error: {failure}")));
    if bad == 0 { Ok(()) } else { Err(Failure::Several { bad, all }) }
}

struct Report {
    nodes: usize,
    tree_depth: usize,
    components: usize,
    limits: Vec<LimitUse>,
    cameras: Vec<String>,
    /// The animation clips of models: the node, the name, and the length in seconds.
    clips: Vec<(String, String, f64)>,
    warnings: Vec<CheckWarning>,
    /// Every parameter, if `--params` is given.
    params: Option<Vec<(ParamPath, &'static Param, ParamValue)>>,
}

/// The use of a limit by the scene.
struct LimitUse {
    name: &'static str,
    used: usize,
    limit: usize,
    /// The node that contributes most.
    node: Option<String>,
}

struct CheckWarning {
    node: String,
    reason: String,
}

impl From<field::Warning> for CheckWarning {
    fn from(warning: field::Warning) -> Self {
        Self { node: format!("{} {}", warning.name, warning.node), reason: warning.reason }
    }
}

fn read(path: &Path, with_params: bool) -> Result<Report, Failure> {
    let scene = read_scene(path)?;
    let flattened = flatten_until(&scene, 0.0, &Cancel::default());
    let flattened = flattened.map_err(|error| Failure::beyond_limit(&shown(path), &error))?;
    let (flat, usages) = flattened.ok_or(Failure::Canceled)?;
    let mut report = Report::new(&scene, &flat, &usages);
    let mut library = library_of(&scene, folder(path));
    let (meshes, missing) = flat.load_meshes(&mut library);
    report.clips = clips(&scene, &flat, &meshes);
    report.warnings.extend(missing.into_iter().map(CheckWarning::from));
    report.warnings.extend(models_that_are_no_fields(&scene, &mut library));
    report.params = with_params.then(|| ParamPath::all(&scene));
    Ok(report)
}

/// Warnings about shapes whose models cannot be read. Bricks are not made.
fn models_that_are_no_fields(scene: &Scene, library: &mut MeshLibrary) -> Vec<CheckWarning> {
    let refused = scene.nodes().iter().filter_map(|node| {
        let NodeKind::Object(object) = &node.kind else { return None };
        let error = library.get(pose_of(&object.shape.model_request()?)).err()?;
        Some(CheckWarning { node: format!("{} {}", node.name, node.id), reason: error.to_string() })
    });
    refused.collect()
}

/// The animation clips of the models that the scene shows.
fn clips(scene: &Scene, flat: &FlatScene, meshes: &[Option<Arc<TriangleMesh>>]) -> Vec<(String, String, f64)> {
    let named = |id| scene.node(id).map_or_else(|| id.to_string(), |node| format!("{} {id}", node.name));
    let of_mesh = |(placed, mesh): (&field::FlatMesh, &Option<Arc<TriangleMesh>>)| {
        let clips = mesh.as_ref().map_or(&[][..], |mesh| mesh.clips.as_slice());
        clips.iter().map(|clip| (named(placed.id), clip.name.clone(), clip.seconds)).collect::<Vec<_>>()
    };
    flat.meshes.iter().zip(meshes).flat_map(of_mesh).collect()
}

impl Report {
    fn new(scene: &Scene, flat: &FlatScene, usages: &[Usage]) -> Self {
        let tree_depth = scene.depths().iter().max().map_or(0, |depth| *depth as usize + 1);
        let limits = [
            ("nodes", scene.nodes().len(), MAX_NODES),
            ("depth of the tree", tree_depth, MAX_DEPTH),
            ("materials", scene.materials().len(), MAX_MATERIALS),
            ("animated parameters", scene.animation.tracks().len(), MAX_TRACKS),
            ("keys", scene.animation.key_count(), MAX_KEYS),
        ];
        let named = |id| scene.node(id).map(|node| format!("{} {id}", node.name));
        let of_scene = limits.map(|(name, used, limit)| LimitUse { name, used, limit, node: None });
        let most = |name, limit, of: fn(&Node) -> usize| {
            let of_nodes = scene.nodes().iter().map(|node| (of(node), node.id));
            let (used, node) = of_nodes.max_by_key(|(used, _)| *used).unwrap_or((0, NodeId(0)));
            LimitUse { name, used, limit, node: named(node).filter(|_| used > 0) }
        };
        let of_files = [
            LimitUse {
                name: "pixels of all images",
                used: scene.image_pixels() as usize,
                limit: MAX_SCENE_PIXELS as usize,
                node: None,
            },
            most("bytes of an image or font", MAX_ATTACHMENT_BYTES, largest_file),
            most("arcs of a text", MAX_TEXT_ARCS, text_arcs),
        ];
        let of_arrays = usages.iter().map(|usage| {
            let Usage { name, used, limit, node } = *usage;
            LimitUse { name, used, limit, node: node.and_then(named) }
        });
        Self {
            nodes: scene.nodes().len(),
            tree_depth,
            components: flat.components.len(),
            limits: of_scene.into_iter().chain(of_files).chain(of_arrays).collect(),
            cameras: flat.cameras.iter().map(|camera| camera.name.clone()).collect(),
            clips: Vec::new(),
            warnings: flat.warnings.iter().cloned().map(CheckWarning::from).collect(),
            params: None,
        }
    }

    fn to_json(&self, path: &Path, is_fine: bool) -> Value {
        let warnings: Vec<Value> =
            self.warnings.iter().map(|w| json!({ "node": w.node, "reason": w.reason })).collect();
        let limit = |l: &LimitUse| json!({ "name": l.name, "used": l.used, "limit": l.limit, "node": l.node });
        let limits: Vec<Value> = self.limits.iter().map(limit).collect();
        let clip =
            |(node, name, seconds): &(String, String, f64)| json!({ "node": node, "name": name, "seconds": seconds });
        let clips: Vec<Value> = self.clips.iter().map(clip).collect();
        let mut report = json!({
            "ok": is_fine,
            "file": path.display().to_string(),
            "nodes": self.nodes,
            "components": self.components,
            "tree_depth": self.tree_depth,
            "cameras": self.cameras,
            "clips": clips,
            "limits": limits,
            "warnings": warnings,
        });
        if let Some(params) = &self.params {
            report["params"] = params.iter().map(param_json).collect();
        }
        report
    }

    fn to_text(&self, path: &Path) -> String {
        let mut text = path.display().to_string();
        for LimitUse { name, used, limit, .. } in &self.limits {
            text += &format!("\n  {name:<30} {used:>9} of {limit}");
        }
        text += &format!("\n  {:<30} {:>9}", "cameras", self.cameras.len());
        text += &format!("\n  {:<30} {:>9}", "warnings", self.warnings.len());
        for (node, name, seconds) in &self.clips {
            text += &format!("\n  clip “{}” of {}, {seconds:.2} s", one_line(name), one_line(node));
        }
        for (path, param, value) in self.params.iter().flatten() {
            text += &format!("\n  {}", param_line(path, param, value));
        }
        for warning in &self.warnings {
            text += &format!("\nwarning: {}: {}", one_line(&warning.node), one_line(&warning.reason));
        }
        text
    }
}

/// The size of the largest file in a node.
fn largest_file(node: &Node) -> usize {
    let shape = match &node.kind {
        NodeKind::Object(object) => object.shape.values(),
        _ => Vec::new(),
    };
    let values = shape.into_iter().chain(node.modifiers.iter().flat_map(|slot| slot.modifier.values()));
    let sizes = values.map(|value| if let ParamValue::File(file) = value { file.size() } else { 0 });
    sizes.max().unwrap_or(0)
}

/// The number of arcs of a text's outlines.
fn text_arcs(node: &Node) -> usize {
    match &node.kind {
        NodeKind::Object(Object { shape: Shape::Text { text, font, size, .. }, .. }) => {
            text_profile(text, font, *size).len()
        }
        _ => 0,
    }
}

/// The range of a parameter; empty if its value is not a number.
fn range(param: &Param, value: &ParamValue) -> Option<[f64; 2]> {
    use ParamValue::{Count, Counts, List, Scalar, Vector};
    matches!(value, Scalar(_) | Vector(_) | Count(_) | Counts(_) | List(_)).then(|| param.limits.signed_range())
}

fn param_json((path, param, value): &(ParamPath, &'static Param, ParamValue)) -> Value {
    let range = range(param, value);
    json!({
        "path": path.to_string(),
        "label": param.label,
        "value": value.to_string(),
        "unit": param.limits.unit,
        "least": range.map(|[least, _]| least),
        "most": range.map(|[_, most]| most),
        "default": param.default.to_string(),
        "animatable": param.animatable,
    })
}

fn param_line(path: &ParamPath, param: &Param, value: &ParamValue) -> String {
    let with_unit = |text: String| format!("{text} {}", param.limits.unit).trim_end().to_owned();
    let range = range(param, value).map_or(String::new(), |[least, most]| format!("{least} to {most}, "));
    let (value, default) = (with_unit(value.to_string()), with_unit(param.default.to_string()));
    format!("{path} = {} ({range}default {})", one_line(&value), one_line(&default))
}

/// Text from a file, safe as part of a line.
fn one_line(text: &str) -> String {
    text.replace('\n', " ")
}
