//! Groups whose content is drawn from bricks of voxels: which, why some cannot be, and the scene with bricks instead.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use super::{MaterialId, Node, NodeId, NodeKind, Object, ParamOwner, Part, Scene, Shape, ShapeKind, Textures};
use isolith_bricks::BrickLevels;

impl Scene {
    /// The groups that are to be baked and are in no other such group, by their index.
    pub fn baked_groups(&self) -> Vec<usize> {
        let (mut out, mut at) = (Vec::new(), 0);
        while at < self.nodes().len() {
            let is_baked = matches!(&self.nodes()[at].kind, NodeKind::Group(group) if group.bake > 0.0);
            if is_baked {
                out.push(at);
            }
            at = if is_baked { self.subtree(at).end } else { at + 1 };
        }
        out
    }

    /// Why the content of the group at `index` cannot be baked, as a reason for the user.
    pub fn unbakeable(&self, index: usize) -> Option<String> {
        let content = self.subtree(index).start + 1..self.subtree(index).end;
        let named = |node: &Node, what: &str| Some(format!("{} {} {what}", node.name, node.id));
        for node in &self.nodes()[content.clone()] {
            match &node.kind {
                NodeKind::Object(object) if matches!(object.shape, Shape::MeshField { .. }) => {
                    return named(node, "is a model, which is drawn from bricks of its own");
                }
                NodeKind::Group(_) | NodeKind::Object(_) => {}
                NodeKind::Instancer(_) => return named(node, "places copies"),
                NodeKind::Mesh(_) => return named(node, "has triangles, which are no field"),
                NodeKind::Light(_) | NodeKind::Camera(_) => return named(node, "is neither an object nor a group"),
            }
            if !node.dynamics.is_empty() {
                return named(node, "moves with time");
            }
        }
        let is_inside = |id: NodeId| self.index_of(id).is_some_and(|at| content.contains(&at));
        let moving = self.animation.tracks().iter().find_map(|track| match track.path.owner {
            ParamOwner::Node(id, part) if is_inside(id) || (part == Part::Operator && self.nodes()[index].id == id) => {
                self.node(id)
            }
            _ => None,
        });
        if let Some(node) = moving {
            return named(node, "has keys, so that it changes with time");
        }
        if self.first_object(content.clone()).is_none() {
            return Some("it has no content".into());
        }
        self.unbakeable_material(content)
    }

    /// Several materials become colors in the bricks, which hold no textures and no keys.
    fn unbakeable_material(&self, content: Range<usize>) -> Option<String> {
        let used: HashSet<MaterialId> = self.nodes()[content].iter().flat_map(|node| node.materials()).collect();
        if used.len() < 2 {
            return None;
        }
        let moves = |id| self.animation.tracks().iter().any(|track| track.path.owner == ParamOwner::Material(id));
        used.iter().filter_map(|id| self.material(*id)).find_map(|material| {
            let what = match material.textures {
                _ if moves(material.id) => "has keys",
                Textures::None {} => return None,
                Textures::Triplanar { .. } => "has a texture",
            };
            Some(format!("its material {} {what}, which bricks of several materials cannot hold", material.name))
        })
    }

    fn first_object(&self, content: Range<usize>) -> Option<&Object> {
        self.nodes()[content].iter().find_map(|node| match &node.kind {
            NodeKind::Object(object) => Some(object),
            _ => None,
        })
    }

    /// The same scene with bricks in place of the content of groups, by their index in this one.
    pub fn with_baked(&self, made: &HashMap<usize, Arc<BrickLevels>>) -> Self {
        let mut nodes: Vec<Arc<Node>> = Vec::with_capacity(self.nodes().len());
        let mut at = 0;
        while at < self.nodes().len() {
            let node = &self.nodes()[at];
            let content = at + 1..self.subtree(at).end;
            let baked = made.get(&at).and_then(|levels| Some((levels, self.first_object(content.clone())?.material)));
            let Some((levels, material)) = baked else {
                nodes.push(node.clone());
                at += 1;
                continue;
            };
            let mut shape = ShapeKind::MeshField.default_shape();
            if let Shape::MeshField { file, .. } = &mut shape {
                *file = file.with_bricks(levels.clone());
            }
            let kind = NodeKind::Object(Object { shape, material });
            nodes.push(Arc::new(Node { kind, ..Node::clone(node) }));
            at = content.end;
        }
        let mut out = self.clone();
        // What is left was valid, and an object may stand wherever a group may.
        if out.set_nodes(nodes).is_err() { self.clone() } else { out }
    }
}
