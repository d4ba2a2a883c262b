//! The scene: tables of nodes and materials, and the few ways to change them.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;
use thiserror::Error;

use super::limits::{MAX_DEPTH, MAX_MATERIALS, MAX_NODES};
use super::{Environment, Material, MaterialId, Node, NodeId, NodeKind};

/// Why a change to a scene was refused. The scene is as it was before.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SceneError {
    /// No node has this id.
    #[error("there is no node {0}")]
    NoNode(NodeId),
    /// Only groups hold children.
    #[error("node {0} is not a group and cannot hold others")]
    NotAGroup(NodeId),
    /// A node would become its own ancestor.
    #[error("node {0} cannot be moved into itself")]
    Cycle(NodeId),
    /// No material has this id.
    #[error("there is no material {0}")]
    NoMaterial(MaterialId),
    /// Something still wears the material.
    #[error("material {0} is still used by node {1}")]
    MaterialInUse(MaterialId, NodeId),
    /// A limit of [`super::limits`].
    #[error("{what} would pass its limit of {limit}")]
    Limit {
        /// What is limited.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The id stands in the table already.
    #[error("node {0} is in the scene already")]
    DuplicateNode(NodeId),
    /// The id stands in the table already.
    #[error("material {0} is in the scene already")]
    DuplicateMaterial(MaterialId),
}

/// A scene.
///
/// Invariants, held by every method: the node table is in depth-first pre-order, so a subtree is a
/// contiguous range and siblings stand in the artist's order; every parent is a group; ids are unique
/// and below `next_id`; every object's material exists. Nodes are shared (`Arc`), so that cloning a
/// scene for undo copies pointers only.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    nodes: Vec<Arc<Node>>,
    depths: Vec<u32>,
    index: HashMap<NodeId, u32>,
    materials: Vec<Arc<Material>>,
    next_id: u64,
    /// What surrounds the nodes.
    pub environment: Environment,
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

impl Scene {
    /// No nodes, and one material for new objects.
    pub fn new() -> Self {
        Self {
            nodes: Vec::new(),
            depths: Vec::new(),
            index: HashMap::new(),
            materials: vec![Arc::new(Material::new(MaterialId(1), "Clay", [0.62, 0.56, 0.50]))],
            next_id: 1,
            environment: Environment::default(),
        }
    }

    /// A scene from its tables: nodes in depth-first pre-order, each with its final id and parent.
    /// `next_id` is raised above every id.
    pub fn from_tables(
        nodes: Vec<Node>,
        materials: Vec<Material>,
        environment: Environment,
        next_id: u64,
    ) -> Result<Self, SceneError> {
        let mut scene = Self { materials: Vec::new(), environment, next_id: next_id.max(1), ..Self::new() };
        for material in materials {
            scene.insert_material(material)?;
        }
        let mut path: Vec<NodeId> = Vec::new();
        for node in nodes {
            match node.parent {
                None => path.clear(),
                Some(parent) => {
                    let Some(depth) = path.iter().position(|id| *id == parent) else {
                        return Err(SceneError::NoNode(parent));
                    };
                    path.truncate(depth + 1);
                }
            }
            path.push(node.id);
            scene.check_node(&node)?;
            if scene.index.contains_key(&node.id) {
                return Err(SceneError::DuplicateNode(node.id));
            }
            check_limit("the nesting of nodes", path.len(), MAX_DEPTH)?;
            check_limit("the number of nodes", scene.nodes.len() + 1, MAX_NODES)?;
            scene.next_id = scene.next_id.max(node.id.0.saturating_add(1));
            scene.index.insert(node.id, scene.nodes.len() as u32);
            scene.depths.push(path.len() as u32 - 1);
            scene.nodes.push(Arc::new(node));
        }
        Ok(scene)
    }

    /// All nodes in depth-first pre-order.
    pub fn nodes(&self) -> &[Arc<Node>] {
        &self.nodes
    }

    /// How deep each node is nested, parallel to [`Scene::nodes`]; 0 at the top.
    pub fn depths(&self) -> &[u32] {
        &self.depths
    }

    /// The id that the next new node will get.
    pub fn next_id(&self) -> u64 {
        self.next_id
    }

    /// The node with this id.
    pub fn node(&self, id: NodeId) -> Option<&Arc<Node>> {
        self.index_of(id).map(|i| &self.nodes[i])
    }

    /// Where the node stands in [`Scene::nodes`].
    pub fn index_of(&self, id: NodeId) -> Option<usize> {
        self.index.get(&id).map(|i| *i as usize)
    }

    /// The range in [`Scene::nodes`] of the node at `index` and all below it.
    pub fn subtree(&self, index: usize) -> Range<usize> {
        let depth = self.depths[index];
        let below = self.depths[index + 1..].iter().take_while(|d| **d > depth).count();
        index..index + 1 + below
    }

    /// The children of a node, or the nodes at the top, in order.
    pub fn children(&self, parent: Option<NodeId>) -> impl Iterator<Item = &Arc<Node>> {
        let range = match parent {
            None => 0..self.nodes.len(),
            Some(id) => self.index_of(id).map_or(0..0, |i| {
                let range = self.subtree(i);
                range.start + 1..range.end
            }),
        };
        self.nodes[range].iter().filter(move |n| n.parent == parent)
    }

    /// Whether `node` is `ancestor` or stands below it.
    pub fn is_within(&self, node: NodeId, ancestor: NodeId) -> bool {
        match (self.index_of(node), self.index_of(ancestor)) {
            (Some(n), Some(a)) => self.subtree(a).contains(&n),
            _ => false,
        }
    }

    /// World from the node's local space: the whole chain of transforms.
    pub fn world_from_local(&self, id: NodeId) -> DAffine3 {
        let mut matrix = DAffine3::IDENTITY;
        let mut at = self.node(id);
        while let Some(node) = at {
            matrix = node.transform.to_affine() * matrix;
            at = node.parent.and_then(|p| self.node(p));
        }
        matrix
    }

    /// Adds a node as the `position`-th child of `parent` (at the end where there are fewer), and
    /// gives it a new id.
    pub fn insert(&mut self, parent: Option<NodeId>, position: usize, node: Node) -> Result<NodeId, SceneError> {
        let id = NodeId(self.next_id);
        self.insert_subtree(parent, position, vec![Node { id, parent, ..node }])?;
        Ok(id)
    }

    /// Adds a whole subtree, in pre-order with final ids, its first node as the `position`-th child of
    /// `parent`.
    pub fn insert_subtree(
        &mut self,
        parent: Option<NodeId>,
        position: usize,
        mut subtree: Vec<Node>,
    ) -> Result<(), SceneError> {
        let parent_depth = match parent {
            None => None,
            Some(id) => Some(self.group_index(id)?),
        }
        .map(|i| self.depths[i]);
        let top = parent_depth.map_or(0, |d| d + 1);
        check_limit("the number of nodes", self.nodes.len() + subtree.len(), MAX_NODES)?;
        if let Some(first) = subtree.first_mut() {
            first.parent = parent;
        }
        let mut depth_of: HashMap<NodeId, u32> = HashMap::new();
        for (i, node) in subtree.iter().enumerate() {
            self.check_material(node)?;
            if self.index.contains_key(&node.id) || depth_of.contains_key(&node.id) {
                return Err(SceneError::DuplicateNode(node.id));
            }
            let depth = match (i, node.parent) {
                (0, _) => top,
                (_, Some(p)) => *depth_of.get(&p).ok_or(SceneError::NoNode(p))? + 1,
                (_, None) => return Err(SceneError::NoNode(node.id)),
            };
            check_limit("the nesting of nodes", depth as usize + 1, MAX_DEPTH)?;
            depth_of.insert(node.id, depth);
        }
        let at = self.insertion_index(parent, position);
        for node in &subtree {
            self.next_id = self.next_id.max(node.id.0.saturating_add(1));
        }
        self.depths.splice(at..at, subtree.iter().map(|n| depth_of[&n.id]));
        self.nodes.splice(at..at, subtree.into_iter().map(Arc::new));
        self.reindex(at);
        Ok(())
    }

    /// Takes out a node and all below it, and returns them in pre-order.
    pub fn remove(&mut self, id: NodeId) -> Result<Vec<Arc<Node>>, SceneError> {
        let range = self.subtree(self.index_of(id).ok_or(SceneError::NoNode(id))?);
        let start = range.start;
        self.depths.drain(range.clone());
        let removed: Vec<_> = self.nodes.drain(range).collect();
        for node in &removed {
            self.index.remove(&node.id);
        }
        self.reindex(start);
        Ok(removed)
    }

    /// Makes a node, with all below it, the `position`-th child of `parent`; `position` counts the
    /// children as they are without the node.
    pub fn move_to(&mut self, id: NodeId, parent: Option<NodeId>, position: usize) -> Result<(), SceneError> {
        let index = self.index_of(id).ok_or(SceneError::NoNode(id))?;
        let range = self.subtree(index);
        let mut top = 0;
        if let Some(p) = parent {
            let parent_index = self.group_index(p)?;
            if range.contains(&parent_index) {
                return Err(SceneError::Cycle(id));
            }
            top = self.depths[parent_index] + 1;
        }
        let deepest = self.depths[range].iter().max().copied().unwrap_or(0) - self.depths[index] + top;
        check_limit("the nesting of nodes", deepest as usize + 1, MAX_DEPTH)?;
        let mut subtree = self.remove(id)?;
        Arc::make_mut(&mut subtree[0]).parent = parent;
        let at = self.insertion_index(parent, position);
        let mut depth_of: HashMap<NodeId, u32> = HashMap::new();
        let depths: Vec<u32> = subtree
            .iter()
            .map(|n| {
                let depth = n.parent.and_then(|p| depth_of.get(&p)).map_or(top, |d| d + 1);
                depth_of.insert(n.id, depth);
                depth
            })
            .collect();
        self.depths.splice(at..at, depths);
        self.nodes.splice(at..at, subtree);
        self.reindex(at);
        Ok(())
    }

    /// Replaces a node by one of the same id. Its place in the tree stays, whatever `node.parent` says.
    pub fn replace(&mut self, node: Node) -> Result<(), SceneError> {
        let index = self.index_of(node.id).ok_or(SceneError::NoNode(node.id))?;
        self.check_material(&node)?;
        let has_children = self.subtree(index).len() > 1;
        if has_children && !matches!(node.kind, NodeKind::Group(_)) {
            return Err(SceneError::NotAGroup(node.id));
        }
        let parent = self.nodes[index].parent;
        self.nodes[index] = Arc::new(Node { parent, ..node });
        Ok(())
    }

    /// All materials, in the artist's order.
    pub fn materials(&self) -> &[Arc<Material>] {
        &self.materials
    }

    /// The material with this id.
    pub fn material(&self, id: MaterialId) -> Option<&Arc<Material>> {
        self.materials.iter().find(|m| m.id == id)
    }

    /// An id for a new material.
    pub fn next_material_id(&self) -> MaterialId {
        MaterialId(self.materials.iter().map(|m| m.id.0).max().unwrap_or(0) + 1)
    }

    /// Adds a material.
    pub fn insert_material(&mut self, material: Material) -> Result<(), SceneError> {
        if self.material(material.id).is_some() {
            return Err(SceneError::DuplicateMaterial(material.id));
        }
        check_limit("the number of materials", self.materials.len() + 1, MAX_MATERIALS)?;
        self.materials.push(Arc::new(material));
        Ok(())
    }

    /// Replaces a material by one of the same id.
    pub fn replace_material(&mut self, material: Material) -> Result<(), SceneError> {
        let at = self.materials.iter().position(|m| m.id == material.id).ok_or(SceneError::NoMaterial(material.id))?;
        self.materials[at] = Arc::new(material);
        Ok(())
    }

    /// Takes out a material that nothing wears.
    pub fn remove_material(&mut self, id: MaterialId) -> Result<(), SceneError> {
        let at = self.materials.iter().position(|m| m.id == id).ok_or(SceneError::NoMaterial(id))?;
        if let Some(node) = self.nodes.iter().find(|n| worn_by(n) == Some(id)) {
            return Err(SceneError::MaterialInUse(id, node.id));
        }
        self.materials.remove(at);
        Ok(())
    }

    fn check_node(&self, node: &Node) -> Result<(), SceneError> {
        if let Some(parent) = node.parent {
            self.group_index(parent)?;
        }
        self.check_material(node)
    }

    fn check_material(&self, node: &Node) -> Result<(), SceneError> {
        match worn_by(node) {
            Some(id) if self.material(id).is_none() => Err(SceneError::NoMaterial(id)),
            _ => Ok(()),
        }
    }

    fn group_index(&self, id: NodeId) -> Result<usize, SceneError> {
        let index = self.index_of(id).ok_or(SceneError::NoNode(id))?;
        match self.nodes[index].kind {
            NodeKind::Group(_) => Ok(index),
            _ => Err(SceneError::NotAGroup(id)),
        }
    }

    /// Where in the table the `position`-th child of `parent` starts, or would start.
    fn insertion_index(&self, parent: Option<NodeId>, position: usize) -> usize {
        let range = match parent.and_then(|p| self.index_of(p)) {
            None => 0..self.nodes.len(),
            Some(i) => {
                let range = self.subtree(i);
                range.start + 1..range.end
            }
        };
        let end = range.end;
        range.filter(|i| self.nodes[*i].parent == parent).nth(position).unwrap_or(end)
    }

    fn reindex(&mut self, from: usize) {
        for (i, node) in self.nodes.iter().enumerate().skip(from) {
            self.index.insert(node.id, i as u32);
        }
    }

    /// Panics unless every invariant holds; for tests.
    #[doc(hidden)]
    pub fn assert_invariants(&self) {
        assert_eq!(self.nodes.len(), self.depths.len());
        assert_eq!(self.nodes.len(), self.index.len());
        let mut path: Vec<NodeId> = Vec::new();
        let mut seen = HashSet::new();
        for (i, node) in self.nodes.iter().enumerate() {
            let depth = self.depths[i] as usize;
            assert!(depth <= path.len(), "pre-order");
            path.truncate(depth);
            assert_eq!(node.parent, path.last().copied());
            assert!(self.check_node(node).is_ok());
            assert_eq!(self.index_of(node.id), Some(i));
            assert!(node.id.0 < self.next_id && seen.insert(node.id));
            path.push(node.id);
        }
    }
}

/// The material that a node refers to.
fn worn_by(node: &Node) -> Option<MaterialId> {
    match &node.kind {
        NodeKind::Object(object) => Some(object.material),
        NodeKind::Mesh(mesh) => mesh.material,
        _ => None,
    }
}

fn check_limit(what: &'static str, value: usize, limit: usize) -> Result<(), SceneError> {
    if value > limit { Err(SceneError::Limit { what, limit }) } else { Ok(()) }
}
