//! From bytes to a scene. All checks happen here, at the border.
//!
//! Reading never builds a tree of values: it parses the text for the version alone, then into the types of that
//! version. No step recurses over the nesting of a file, and lists are bounded while they grow.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use super::animation;
use super::error::{FileError, clipped};
use super::format::{NodeFile, SceneFile, VERSION};
use super::old_version::{FileMaterial, LightV1, SceneV1};
use super::place;
use super::watch;
use super::weight::weigh;
use crate::limits::{MAX_DEPTH, MAX_ENTRY_VALUES, MAX_FILE_BYTES, MAX_ID};
use crate::{Bookmark, Node, NodeId, Scene, check, decode_budget, whole};
use isolith_jobs::Task;

/// Reads a scene from the contents of a file; `file` is for messages only.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Scene, FileError> {
    parse_by(bytes, file, &Task::new("Reading"))
}

/// Like [`parse`], as a part of a task: reports progress to it, and stops when the task is canceled.
pub(super) fn parse_by(bytes: &[u8], file: &Path, task: &Task) -> Result<Scene, FileError> {
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::new(file, format!("is larger than {} MiB", MAX_FILE_BYTES >> 20)));
    }
    // Some editors write a byte order mark.
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let (line, column) = place::line_and_column(&bytes[..e.valid_up_to()]);
        FileError::new(file, format!("line {line}, column {column}: is not text in UTF-8"))
    })?;
    let nodes = weigh(text).map_err(|found| {
        let (line, column) = place::line_and_column(&bytes[..found.at]);
        let reason = format!("line {line}, column {column}: holds more than {MAX_ENTRY_VALUES} values");
        let error = FileError::new(file, reason).at(found.field);
        if let Some(id) = found.id { error.of_node(&found.name, NodeId(id)) } else { error }
    })?;
    match version(text, file)? {
        1 => {
            let old: SceneV1 = watch::within(task, nodes, || decode_budget::within(|| typed(text, file)))?;
            check_materials(&old.materials, file)?;
            check_lights(&old.nodes, file)?;
            old.environment.check().map_err(|f| FileError::from_fault(file, "environment", f))?;
            checked_scene(old.converted(), file)
        }
        2 => {
            let scene: SceneFile = watch::within(task, nodes, || decode_budget::within(|| typed(text, file)))?;
            check_materials(&scene.materials, file)?;
            checked_scene(scene, file)
        }
        0 => Err(FileError::new(file, "there is no version 0 of the format").at("isolith")),
        newer => {
            let reason = format!("version {newer} is newer than this program, which reads up to {VERSION}");
            Err(FileError::new(file, reason).at("isolith"))
        }
    }
}

/// The version, regardless of the rest.
fn version(text: &str, file: &Path) -> Result<u64, FileError> {
    #[derive(Deserialize)]
    struct Header {
        isolith: Option<Value>,
    }
    let header: Header = serde_json::from_str(text).map_err(|e| {
        // Parsing the text as a scene locates the error better. The right version gets farthest.
        let found = [located::<SceneV1>(text).err(), located::<SceneFile>(text).err()];
        let farthest = found.into_iter().flatten().max_by_key(|e| (e.inner().line(), e.inner().column()));
        match farthest {
            Some(found) => place::json_error(text, file, Some(found.path()), found.inner()),
            None => place::json_error(text, file, None, &e),
        }
    })?;
    let Some(version) = header.isolith else {
        return Err(FileError::new(file, "is missing: this is not a scene of Isolith").at("isolith"));
    };
    let shown = || clipped(&version.to_string(), 40);
    whole::read(&version).map_err(|_: serde_json::Error| {
        FileError::new(file, format!("must be the number of a version, not {}", shown())).at("isolith")
    })
}

/// Parses the text into the types of one version.
fn typed<'a, T: Deserialize<'a>>(text: &'a str, file: &Path) -> Result<T, FileError> {
    located(text).map_err(|e| place::json_error(text, file, Some(e.path()), e.inner()))
}

/// Parses the text; an error comes with its path.
fn located<'a, T: Deserialize<'a>>(text: &'a str) -> Result<T, serde_path_to_error::Error<serde_json::Error>> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut reader)?;
    let track = serde_path_to_error::Track::new();
    reader.end().map_err(|e| serde_path_to_error::Error::new(track.path(), e))?;
    Ok(value)
}

fn checked_scene(scene: SceneFile, file: &Path) -> Result<Scene, FileError> {
    check::environment(&scene.environment).map_err(|f| FileError::from_fault(file, "environment", f))?;
    check::display(&scene.display).map_err(|f| FileError::from_fault(file, "display", f))?;
    scene.timeline.check().map_err(|f| FileError::from_fault(file, "timeline", f))?;
    if scene.next_id > MAX_ID + 1 {
        return Err(FileError::new(file, format!("must be at most {}", MAX_ID + 1)).at("next_id"));
    }
    check_references(&scene, file)?;
    let order = pre_order(&scene.nodes, file)?;
    let mut nodes = Vec::with_capacity(scene.nodes.len());
    for (i, node) in scene.nodes.into_iter().enumerate() {
        nodes.push(Some(checked(node, i, file)?));
    }
    check_links(&nodes, file)?;
    let nodes = order.into_iter().filter_map(|i| nodes[i].take()).collect();
    let tables = Scene::from_tables(nodes, scene.materials, scene.environment, scene.next_id);
    let mut tables = tables.map_err(|e| FileError::new(file, e.to_string()))?;
    tables.display = scene.display;
    tables.packed = scene.packed;
    for (i, bookmark) in scene.bookmarks.into_iter().enumerate() {
        let checked = bookmark.as_ref().map_or(Ok(()), Bookmark::check);
        checked.map_err(|reason| FileError::new(file, reason).at(format!("bookmarks[{i}]")))?;
        tables.bookmarks[i] = bookmark;
    }
    tables.animation.timeline = scene.timeline;
    animation::add_tracks(&mut tables, scene.tracks, file)?;
    Ok(tables)
}

/// The node with its own values checked.
fn checked(node: NodeFile, i: usize, file: &Path) -> Result<Node, FileError> {
    let (name, id) = (node.name.clone(), node.id);
    let kinds = "must hold exactly one of group, object, mesh, light, camera";
    let node = node
        .into_node()
        .map(check::settled)
        .ok_or_else(|| FileError::new(file, kinds).of_node(&name, id).at(format!("nodes[{i}]")))?;
    match check::node(&node) {
        Ok(()) => Ok(node),
        Err(fault) => Err(FileError::from_fault(file, &format!("nodes[{i}]"), fault).of_node(&name, id)),
    }
}

/// Checks that linked objects are alike.
fn check_links(nodes: &[Option<Node>], file: &Path) -> Result<(), FileError> {
    let mut first: HashMap<u64, &Node> = HashMap::new();
    for (i, node) in nodes.iter().enumerate() {
        let Some((node, link)) = node.as_ref().and_then(|node| Some((node, node.linked?))) else { continue };
        let other = *first.entry(link).or_insert(node);
        if other.kind != node.kind {
            let reason = format!("must have the shape and material of node {}, with which it is linked", other.id);
            return Err(FileError::new(file, reason).of_node(&node.name, node.id).at(format!("nodes[{i}].linked")));
        }
    }
    Ok(())
}

fn check_materials<M: FileMaterial>(materials: &[M], file: &Path) -> Result<(), FileError> {
    let mut seen = HashSet::new();
    for (i, material) in materials.iter().enumerate() {
        let field = format!("materials[{i}]");
        if material.id().0 > MAX_ID {
            return Err(FileError::new(file, format!("must be at most {MAX_ID}")).at(field + ".id"));
        }
        if !seen.insert(material.id()) {
            let reason = format!("another material has the id {}", material.id());
            return Err(FileError::new(file, reason).at(field + ".id"));
        }
        material.check().map_err(|f| FileError::from_fault(file, &field, f))?;
    }
    Ok(())
}

/// Checks the lights of a scene of version 1, before they lose the names of their fields.
fn check_lights(nodes: &[NodeFile<LightV1>], file: &Path) -> Result<(), FileError> {
    for (i, node) in nodes.iter().enumerate() {
        if let Some(Err(fault)) = node.light.as_ref().map(LightV1::check) {
            let field = format!("nodes[{i}].light");
            return Err(FileError::from_fault(file, &field, fault).of_node(&node.name, node.id));
        }
    }
    Ok(())
}

/// Checks that ids are unique, that parents and materials exist, and that parents are groups.
fn check_references(scene: &SceneFile, file: &Path) -> Result<(), FileError> {
    let materials: HashSet<_> = scene.materials.iter().map(|m| m.id).collect();
    let mut holds: HashMap<NodeId, bool> = HashMap::with_capacity(scene.nodes.len());
    let fail = |i: usize, field: &str, reason: String| {
        let node = &scene.nodes[i];
        Err(FileError::new(file, reason).of_node(&node.name, node.id).at(format!("nodes[{i}].{field}")))
    };
    for (i, node) in scene.nodes.iter().enumerate() {
        if node.id.0 > MAX_ID {
            return fail(i, "id", format!("must be at most {MAX_ID}"));
        }
        if holds.insert(node.id, node.group.is_some() || node.instancer.is_some()).is_some() {
            return fail(i, "id", format!("another node has the id {}", node.id));
        }
    }
    for (i, node) in scene.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            match holds.get(&parent) {
                Some(true) => {}
                Some(false) => {
                    return fail(
                        i,
                        "parent",
                        format!("node {parent} is neither a group nor an instancer and holds no others"),
                    );
                }
                None => return fail(i, "parent", format!("there is no node {parent}")),
            }
        }
        if let Some((material, field)) = node.materials().find(|(id, _)| !materials.contains(id)) {
            return fail(i, field, format!("there is no material {material}"));
        }
    }
    Ok(())
}

/// The indices of the nodes in depth-first pre-order. Siblings keep the order of the file, so a file in pre-order stays
/// unchanged. All parents exist.
fn pre_order(nodes: &[NodeFile], file: &Path) -> Result<Vec<usize>, FileError> {
    let mut children: HashMap<Option<NodeId>, Vec<usize>> = HashMap::new();
    for (i, node) in nodes.iter().enumerate().rev() {
        children.entry(node.parent).or_default().push(i);
    }
    let mut order = Vec::with_capacity(nodes.len());
    let mut reached = vec![false; nodes.len()];
    // Nodes still to visit, with their depth; the last is next. Visiting a node takes its entry out, so each node is
    // visited once.
    let mut open: Vec<(usize, usize)> =
        children.remove(&None).unwrap_or_default().into_iter().map(|i| (i, 1)).collect();
    while let Some((i, depth)) = open.pop() {
        let node = &nodes[i];
        if depth > MAX_DEPTH {
            let error = FileError::new(file, format!("stands deeper than {MAX_DEPTH} groups"));
            return Err(error.of_node(&node.name, node.id).at(format!("nodes[{i}].parent")));
        }
        reached[i] = true;
        order.push(i);
        open.extend(children.remove(&Some(node.id)).unwrap_or_default().into_iter().map(|c| (c, depth + 1)));
    }
    match reached.iter().position(|r| !r) {
        None => Ok(order),
        Some(i) => {
            let i = on_cycle(nodes, i);
            let node = &nodes[i];
            let error = FileError::new(file, "the parents lead in a circle");
            Err(error.of_node(&node.name, node.id).at(format!("nodes[{i}].parent")))
        }
    }
}

/// The first node of the cycle that the parents of `start` lead into.
fn on_cycle(nodes: &[NodeFile], start: usize) -> usize {
    let index: HashMap<NodeId, usize> = nodes.iter().enumerate().map(|(i, n)| (n.id, i)).collect();
    let mut seen = HashSet::new();
    let mut at = start;
    while seen.insert(at) {
        match nodes[at].parent.and_then(|p| index.get(&p)) {
            Some(parent) => at = *parent,
            None => break,
        }
    }
    at
}
