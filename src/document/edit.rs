//! Edits: every possible change of a scene.

use std::sync::Arc;

use super::change::Change;
use super::{copying, keys, links, structure};
use isolith_scene::{
    Bookmark, Changed, DisplaySettings, Environment, Group, Keyframe, MAX_BOOKMARKS, Material, MaterialId, Node,
    NodeId, NodeKind, PackedFiles, ParamPath, ParamValue, Scene, SceneError, Timeline, Track, check,
};

/// A change to a scene. Values are checked against [`isolith_scene::limits`].
///
/// If an edit names several nodes, those below another one of them move along with it, and all keep their order in the
/// scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Replaces the node of the same id; its parent stays.
    Replace(Node),
    /// Adds a node with a new id as the `position`-th child of `parent` (at the end if there are fewer).
    Insert {
        /// A group, or `None` for the top.
        parent: Option<NodeId>,
        /// Counted from 0.
        position: usize,
        /// Its id and parent are ignored.
        node: Node,
    },
    /// Removes nodes with their subtrees.
    Remove(Vec<NodeId>),
    /// Makes nodes children of `parent`, with the first of them at `position`, counted without the moved ones. They
    /// keep their place in the world if a translation, rotation and scale can express it. Below a group that would
    /// shear them they keep their own transform.
    Move {
        /// The nodes to move.
        ids: Vec<NodeId>,
        /// A group, or `None` for the top.
        parent: Option<NodeId>,
        /// Counted from 0.
        position: usize,
    },
    /// Adds a copy of each node behind it, with new ids and a numbered name. Copies of linked objects are not linked.
    Duplicate(Vec<NodeId>),
    /// The same, and each copied object shares shape and material with its original from then on.
    DuplicateLinked(Vec<NodeId>),
    /// Puts nodes into a new group, at the position of the first of them. They keep their place in the world as with
    /// [`Edit::Move`].
    Group {
        /// The nodes to put into the group; not empty.
        ids: Vec<NodeId>,
        /// The operator and blend of the new group.
        group: Group,
    },
    /// Makes nodes the types of a new instancer, at the position of the first of them. They keep their place in the
    /// world as with [`Edit::Move`].
    Instance {
        /// The nodes to put into the instancer; not empty.
        ids: Vec<NodeId>,
        /// The instancer; its id and parent are ignored.
        node: Node,
    },
    /// Adds the nodes of another scene, as copied, with new ids and with the materials that they use.
    Merge {
        /// A group, or `None` for the top. The nodes keep their place in the world as with [`Edit::Move`].
        parent: Option<NodeId>,
        /// Counted from 0.
        position: usize,
        /// The nodes.
        from: Arc<Scene>,
    },
    /// Replaces the material of the same id.
    ReplaceMaterial(Material),
    /// Adds a material with its own id, see [`Scene::next_material_id`].
    InsertMaterial(Material),
    /// Moves a material to a place in the list, counted without it.
    MoveMaterial {
        /// The material.
        id: MaterialId,
        /// Counted from 0.
        position: usize,
    },
    /// Removes a material that no node uses.
    RemoveMaterial(MaterialId),
    /// Replaces the environment.
    SetEnvironment(Environment),
    /// Replaces the display settings.
    SetDisplay(DisplaySettings),
    /// Replaces the files that travel within the scene.
    SetPacked(PackedFiles),
    /// Keeps a view in the bookmark of this number, or none.
    SetBookmark(usize, Option<Bookmark>),
    /// Changes one parameter of a node, a material, the environment or the display.
    SetParam {
        /// The path of the parameter.
        path: ParamPath,
        /// Its new value.
        value: ParamValue,
    },
    /// Replaces the timeline.
    SetTimeline(Timeline),
    /// Sets keys of parameters, each in the place of the one at its moment. A parameter without keys becomes animated.
    SetKeys(Vec<(ParamPath, Keyframe)>),
    /// Removes the keys of parameters at moments. A parameter that loses its last key keeps the value of that key.
    RemoveKeys(Vec<(ParamPath, f64)>),
    /// Replaces all keys of parameters: moves and copies of keys. A track without keys ends the animation of its
    /// parameter.
    SetTracks(Vec<Track>),
}

impl Edit {
    /// Performs the edit. On failure the scene is unchanged.
    pub(super) fn perform(self, scene: &mut Arc<Scene>) -> Result<Change, SceneError> {
        match self {
            Self::Replace(node) => {
                let node = check::settled(node);
                let old = scene.node(node.id).ok_or(SceneError::NoNode(node.id))?;
                let mut node = Node { parent: old.parent, ..node };
                if !matches!(node.kind, NodeKind::Object(_)) {
                    node.linked = None;
                }
                if **old == node {
                    return Ok(Change::NONE);
                }
                check_node(&node)?;
                links::replace(scene, node)?;
                Ok(Change::VALUE)
            }
            Self::Insert { parent, position, node } => {
                let node = check::settled(node);
                check_node(&node)?;
                let id = Arc::make_mut(scene).insert(parent, position, node)?;
                Ok(Change { changed: true, added: vec![id] })
            }
            Self::Remove(ids) => structure::remove(scene, &ids).map(|()| Change::VALUE),
            Self::Move { ids, parent, position } => {
                structure::move_to(scene, &ids, parent, position).map(|()| Change::VALUE)
            }
            Self::Duplicate(ids) => {
                structure::duplicate(scene, &ids, false).map(|added| Change { changed: !added.is_empty(), added })
            }
            Self::DuplicateLinked(ids) => {
                structure::duplicate(scene, &ids, true).map(|added| Change { changed: !added.is_empty(), added })
            }
            Self::Group { ids, group } => enclose(scene, &ids, Node::new("Group", NodeKind::Group(group))),
            Self::Instance { ids, node } => enclose(scene, &ids, node),
            Self::Merge { parent, position, from } => {
                copying::merge(scene, &from, parent, position).map(|added| Change { changed: !added.is_empty(), added })
            }
            Self::ReplaceMaterial(material) => replace_material(scene, material),
            Self::InsertMaterial(material) => {
                check_material(&material)?;
                Arc::make_mut(scene).insert_material(material)?;
                Ok(Change::VALUE)
            }
            Self::MoveMaterial { id, position } => move_material(scene, id, position),
            Self::RemoveMaterial(id) => {
                Arc::make_mut(scene).remove_material(id)?;
                Ok(Change::VALUE)
            }
            Self::SetEnvironment(environment) => set_environment(scene, environment),
            Self::SetDisplay(display) => set_display(scene, display),
            Self::SetParam { path, value } => Self::of_param(scene, &path, value)?.perform(scene),
            Self::SetTimeline(timeline) => set_timeline(scene, timeline),
            Self::SetPacked(packed) => set_packed(scene, packed),
            Self::SetBookmark(index, view) => set_bookmark(scene, index, view),
            Self::SetKeys(keys) => keys::set_keys(scene, keys),
            Self::RemoveKeys(keys) => keys::remove_keys(scene, &keys),
            Self::SetTracks(tracks) => keys::set_tracks(scene, tracks),
        }
    }

    /// The edit of the owner, for the edit of a parameter; others as they are.
    pub(super) fn resolved(self, scene: &Scene) -> Result<Self, SceneError> {
        match self {
            Self::SetParam { path, value } => Self::of_param(scene, &path, value),
            other => Ok(other),
        }
    }

    /// The edit that replaces the owner of the parameter.
    fn of_param(scene: &Scene, path: &ParamPath, value: ParamValue) -> Result<Self, SceneError> {
        Ok(match path.changed(scene, value)? {
            Changed::Node(node) => Self::Replace(*node),
            Changed::Material(material) => Self::ReplaceMaterial(*material),
            Changed::Environment(environment) => Self::SetEnvironment(environment),
            Changed::Display(display) => Self::SetDisplay(display),
        })
    }

    /// The label in a history list.
    pub(super) fn label(&self, scene: &Scene) -> String {
        match self {
            Self::Replace(new) => scene.node(new.id).map_or_else(|| "Change".into(), |old| replace_label(old, new)),
            Self::Insert { node, .. } => format!("Add {}", node.name),
            Self::Remove(ids) => format!("Delete {}", names(scene, ids)),
            Self::Move { ids, .. } => format!("Reorder {}", names(scene, ids)),
            Self::Duplicate(ids) => format!("Duplicate {}", names(scene, ids)),
            Self::DuplicateLinked(ids) => format!("Duplicate {} linked", names(scene, ids)),
            Self::Group { ids, .. } => format!("Group {}", names(scene, ids)),
            Self::Instance { ids, .. } => format!("Instance {}", names(scene, ids)),
            Self::Merge { from, .. } => {
                let tops: Vec<NodeId> = from.children(None).map(|node| node.id).collect();
                format!("Paste {}", names(from, &tops))
            }
            Self::ReplaceMaterial(material) => format!("Change material {}", material.name),
            Self::InsertMaterial(material) => format!("Add material {}", material.name),
            Self::MoveMaterial { id, .. } => format!("Reorder material {}", material_name(scene, *id)),
            Self::RemoveMaterial(id) => format!("Delete material {}", material_name(scene, *id)),
            Self::SetEnvironment(_) => "Change environment".into(),
            Self::SetDisplay(_) => "Change display".into(),
            Self::SetParam { path, value } => match Self::of_param(scene, path, value.clone()) {
                Ok(edit) => edit.label(scene),
                Err(_) => format!("Change {path}"),
            },
            Self::SetTimeline(_) => "Change timeline".into(),
            Self::SetPacked(packed) if packed.is_empty() => "Unpack files".into(),
            Self::SetPacked(_) => "Pack files".into(),
            Self::SetBookmark(index, _) => format!("Set bookmark {}", index + 1),
            Self::SetKeys(keys) => format!("Insert {}", counted(keys.len(), "key")),
            Self::RemoveKeys(keys) => format!("Delete {}", counted(keys.len(), "key")),
            Self::SetTracks(_) => "Move keys".into(),
        }
    }
}

fn enclose(scene: &mut Arc<Scene>, ids: &[NodeId], node: Node) -> Result<Change, SceneError> {
    check_node(&node)?;
    let id = structure::group(scene, ids, node)?;
    Ok(Change { changed: true, added: vec![id] })
}

fn counted(count: usize, what: &str) -> String {
    if count == 1 { what.to_owned() } else { format!("{count} {what}s") }
}

fn replace_label(old: &Node, new: &Node) -> String {
    let name = &old.name;
    if old.name != new.name {
        format!("Rename {name}")
    } else if old.visible != new.visible {
        format!("{} {name}", if new.visible { "Show" } else { "Hide" })
    } else if old.locked != new.locked {
        format!("{} {name}", if new.locked { "Lock" } else { "Unlock" })
    } else if old.operation != new.operation {
        format!("{} {name}", new.operation.label())
    } else if old.transform != new.transform {
        let [now, was] = [&new.transform, &old.transform];
        let changed = [now.translation != was.translation, now.rotation != was.rotation, now.scale != was.scale];
        let verb = match changed {
            [true, false, false] => "Move",
            [_, true, false] => "Rotate",
            [_, false, true] => "Scale",
            _ => "Transform",
        };
        format!("{verb} {name}")
    } else {
        format!("Change {name}")
    }
}

fn replace_material(scene: &mut Arc<Scene>, material: Material) -> Result<Change, SceneError> {
    if scene.material(material.id).is_some_and(|old| **old == material) {
        return Ok(Change::NONE);
    }
    check_material(&material)?;
    Arc::make_mut(scene).replace_material(material)?;
    Ok(Change::VALUE)
}

fn set_environment(scene: &mut Arc<Scene>, environment: Environment) -> Result<Change, SceneError> {
    if scene.environment == environment {
        return Ok(Change::NONE);
    }
    check::environment(&environment).map_err(|f| f.into_error("environment"))?;
    Arc::make_mut(scene).set_environment(environment)?;
    Ok(Change::VALUE)
}

fn set_display(scene: &mut Arc<Scene>, display: DisplaySettings) -> Result<Change, SceneError> {
    if scene.display == display {
        return Ok(Change::NONE);
    }
    check::display(&display).map_err(|f| f.into_error("display"))?;
    Arc::make_mut(scene).display = display;
    Ok(Change::VALUE)
}

fn set_timeline(scene: &mut Arc<Scene>, timeline: Timeline) -> Result<Change, SceneError> {
    if scene.animation.timeline == timeline {
        return Ok(Change::NONE);
    }
    timeline.check().map_err(|f| f.into_error("timeline"))?;
    Arc::make_mut(scene).animation.timeline = timeline;
    Ok(Change::VALUE)
}

fn set_packed(scene: &mut Arc<Scene>, packed: PackedFiles) -> Result<Change, SceneError> {
    if scene.packed == packed {
        return Ok(Change::NONE);
    }
    Arc::make_mut(scene).packed = packed;
    Ok(Change::VALUE)
}

fn set_bookmark(scene: &mut Arc<Scene>, index: usize, view: Option<Bookmark>) -> Result<Change, SceneError> {
    let field = format!("bookmarks[{index}]");
    let invalid = |reason: String| SceneError::Invalid { subject: "the scene".into(), field: field.clone(), reason };
    if scene.bookmarks.get(index).is_none() {
        return Err(invalid(format!("there are {MAX_BOOKMARKS} bookmarks")));
    }
    view.as_ref().map_or(Ok(()), Bookmark::check).map_err(invalid)?;
    if scene.bookmarks[index] == view {
        return Ok(Change::NONE);
    }
    Arc::make_mut(scene).bookmarks[index] = view;
    Ok(Change::VALUE)
}

fn move_material(scene: &mut Arc<Scene>, id: MaterialId, position: usize) -> Result<Change, SceneError> {
    if scene.materials().iter().position(|material| material.id == id) == Some(position) {
        return Ok(Change::NONE);
    }
    Arc::make_mut(scene).move_material(id, position)?;
    Ok(Change::VALUE)
}

fn material_name(scene: &Scene, id: MaterialId) -> String {
    scene.material(id).map_or_else(|| id.to_string(), |material| material.name.clone())
}

fn names(scene: &Scene, ids: &[NodeId]) -> String {
    match ids {
        [id] => scene.node(*id).map_or_else(|| id.to_string(), |n| n.name.clone()),
        _ => format!("{} nodes", ids.len()),
    }
}

fn check_node(node: &Node) -> Result<(), SceneError> {
    check::node(node).map_err(|f| f.into_error(format!("{} {}", node.name, node.id)))
}

fn check_material(material: &Material) -> Result<(), SceneError> {
    check_material_id(material.id)?;
    check::material(material).map_err(|f| f.into_error(format!("material {} {}", material.name, material.id)))
}

fn check_material_id(id: MaterialId) -> Result<(), SceneError> {
    use isolith_scene::limits::MAX_ID;
    if id.0 > MAX_ID {
        return Err(SceneError::Limit { what: "the id of a material", limit: MAX_ID as usize });
    }
    Ok(())
}
