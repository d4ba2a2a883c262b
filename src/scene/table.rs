//! The scene: tables of nodes and materials, and the few methods that change them.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;

use glam::DAffine3;

use super::image_budget::{self, ImageHolders};
use super::limits::{MAX_DEPTH, MAX_ID, MAX_MATERIALS, MAX_NODES};
use super::{
    Animation, Bookmark, DisplaySettings, Environment, MAX_BOOKMARKS, Material, MaterialId, Node, NodeId, NodeKind,
    PackedFiles, SceneError,
};

/// A scene.
///
/// Invariants, held by every method: the node table is in depth-first pre-order, so a subtree is a contiguous range and
/// siblings stand in the artist's order; every parent is a group; ids are unique and below `next_id`; every object's
/// material exists. Nodes, depths and index are shared (`Arc`): cloning a scene for undo copies only pointers to nodes,
/// and changing a value leaves the others shared.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(super) nodes: Vec<Arc<Node>>,
    depths: Arc<Vec<u32>>,
    index: Arc<HashMap<NodeId, u32>>,
    pub(super) materials: Vec<Arc<Material>>,
    next_id: u64,
    /// The environment.
    pub environment: Environment,
    /// How its light becomes the colors of a screen.
    pub display: DisplaySettings,
    /// Its parameters that change with time. Their tracks follow from [`Scene::set_tracks`].
    pub animation: Animation,
    /// Views to come back to.
    pub bookmarks: [Option<Bookmark>; MAX_BOOKMARKS],
    /// The files that travel within it.
    pub packed: PackedFiles,
}

impl PartialEq for Scene {
    /// Depths and index follow from the nodes; shared entries are equal without a comparison.
    fn eq(&self, other: &Self) -> bool {
        fn same<T: PartialEq>(a: &[Arc<T>], b: &[Arc<T>]) -> bool {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b) || a == b)
        }
        self.next_id == other.next_id
            && self.environment == other.environment
            && self.display == other.display
            && self.animation == other.animation
            && self.bookmarks == other.bookmarks
            && self.packed == other.packed
            && same(&self.materials, &other.materials)
            && same(&self.nodes, &other.nodes)
    }
}

impl Default for Scene {
    fn default() -> Self {
        Self::new()
    }
}

impl Scene {
    /// A scene without nodes, and with one material for new objects.
    pub fn new() -> Self {
        Self {
            nodes: Vec::new(),
            depths: Arc::default(),
            index: Arc::default(),
            materials: vec![Arc::new(Material::new(MaterialId(1), "Clay", [0.62, 0.56, 0.50]))],
            next_id: 1,
            environment: Environment::default(),
            display: DisplaySettings::default(),
            animation: Animation::default(),
            bookmarks: [None; MAX_BOOKMARKS],
            packed: PackedFiles::default(),
        }
    }

    /// A scene from its tables: nodes in depth-first pre-order, each with its final id and parent. Raises `next_id`
    /// above every id.
    pub fn from_tables(
        nodes: Vec<Node>,
        materials: Vec<Material>,
        environment: Environment,
        next_id: u64,
    ) -> Result<Self, SceneError> {
        check_limit("the number of materials", materials.len(), MAX_MATERIALS)?;
        let mut scene = Self { materials: Vec::new(), environment, next_id: next_id.max(1), ..Self::new() };
        let mut seen = HashSet::new();
        for material in materials {
            if !seen.insert(material.id) {
                return Err(SceneError::DuplicateMaterial(material.id));
            }
            scene.materials.push(Arc::new(material));
        }
        scene.set_nodes(nodes.into_iter().map(Arc::new).collect())?;
        Ok(scene)
    }

    /// Replaces the whole table of nodes in one step. The new one is in depth-first pre-order with final ids and
    /// parents. Edits that move or copy many nodes build the table they want and set it here. `next_id` only grows.
    pub fn set_nodes(&mut self, nodes: Vec<Arc<Node>>) -> Result<(), SceneError> {
        check_limit("the number of nodes", nodes.len(), MAX_NODES)?;
        let depths = nest(nodes.iter().map(|n| &**n), None, 0)?;
        let materials: HashSet<MaterialId> = self.materials.iter().map(|m| m.id).collect();
        for node in &nodes {
            if let Some(id) = node.materials().find(|id| !materials.contains(id)) {
                return Err(SceneError::NoMaterial(id));
            }
            self.next_id = self.next_id.max(node.id.0 + 1);
        }
        self.index = Arc::new(nodes.iter().enumerate().map(|(i, n)| (n.id, i as u32)).collect());
        self.depths = Arc::new(depths);
        self.nodes = nodes;
        Ok(())
    }

    /// All nodes in depth-first pre-order.
    pub fn nodes(&self) -> &[Arc<Node>] {
        &self.nodes
    }

    /// The pixels of all its images, each file counted once: at most [`super::limits::MAX_SCENE_PIXELS`].
    pub fn image_pixels(&self) -> u64 {
        image_budget::used(self.images())
    }

    fn images(&self) -> ImageHolders<'_> {
        ImageHolders { nodes: &self.nodes, materials: &self.materials, environment: &self.environment }
    }

    /// The depth of each node, parallel to [`Scene::nodes`]; 0 at the top.
    pub fn depths(&self) -> &[u32] {
        &self.depths
    }

    /// The id of the next new node.
    pub fn next_id(&self) -> u64 {
        self.next_id
    }

    /// The number of a new set of linked objects.
    pub fn next_link(&self) -> u64 {
        self.nodes.iter().filter_map(|node| node.linked).max().unwrap_or(0) + 1
    }

    /// The objects of a set of linked objects.
    pub fn linked(&self, link: u64) -> impl Iterator<Item = &Arc<Node>> {
        self.nodes.iter().filter(move |node| node.linked == Some(link))
    }

    /// The node with this id.
    pub fn node(&self, id: NodeId) -> Option<&Arc<Node>> {
        self.index_of(id).map(|i| &self.nodes[i])
    }

    /// The index of the node in [`Scene::nodes`].
    pub fn index_of(&self, id: NodeId) -> Option<usize> {
        self.index.get(&id).map(|i| *i as usize)
    }

    /// The range in [`Scene::nodes`] of the subtree whose root is at `index`.
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

    /// Whether `node` is `ancestor` or one of its descendants.
    pub fn is_within(&self, node: NodeId, ancestor: NodeId) -> bool {
        match (self.index_of(node), self.index_of(ancestor)) {
            (Some(n), Some(a)) => self.subtree(a).contains(&n),
            _ => false,
        }
    }

    /// The transform from the node's local space to the world: the whole chain of transforms.
    pub fn world_from_local(&self, id: NodeId) -> DAffine3 {
        let mut matrix = DAffine3::IDENTITY;
        let mut at = self.node(id);
        while let Some(node) = at {
            matrix = node.transform.to_affine() * matrix;
            at = node.parent.and_then(|p| self.node(p));
        }
        matrix
    }

    /// Adds a node as the `position`-th child of `parent` (at the end if there are fewer), and assigns it a new id.
    pub fn insert(&mut self, parent: Option<NodeId>, position: usize, node: Node) -> Result<NodeId, SceneError> {
        let id = NodeId(self.next_id);
        self.insert_subtree(parent, position, vec![Node { id, parent, ..node }])?;
        Ok(id)
    }

    /// Adds a whole subtree, in pre-order with final ids, with its root as the `position`-th child of `parent`.
    pub fn insert_subtree(
        &mut self,
        parent: Option<NodeId>,
        position: usize,
        mut subtree: Vec<Node>,
    ) -> Result<(), SceneError> {
        let top = match parent {
            None => 0,
            Some(id) => self.depths[self.group_index(id)?] as usize + 1,
        };
        check_limit("the number of nodes", self.nodes.len() + subtree.len(), MAX_NODES)?;
        image_budget::check(self.images(), None, &subtree)?;
        if let Some(first) = subtree.first_mut() {
            first.parent = parent;
        }
        let depths = nest(&subtree, parent, top)?;
        for node in &subtree {
            self.check_material(node)?;
            if self.index.contains_key(&node.id) {
                return Err(SceneError::DuplicateNode(node.id));
            }
        }
        let at = self.insertion_index(parent, position);
        for node in &subtree {
            self.next_id = self.next_id.max(node.id.0 + 1);
        }
        Arc::make_mut(&mut self.depths).splice(at..at, depths);
        self.nodes.splice(at..at, subtree.into_iter().map(Arc::new));
        self.reindex(at);
        Ok(())
    }

    /// Removes a node with its subtree, and returns them in pre-order.
    pub fn remove(&mut self, id: NodeId) -> Result<Vec<Arc<Node>>, SceneError> {
        let range = self.subtree(self.index_of(id).ok_or(SceneError::NoNode(id))?);
        let start = range.start;
        Arc::make_mut(&mut self.depths).drain(range.clone());
        let removed: Vec<_> = self.nodes.drain(range).collect();
        let index = Arc::make_mut(&mut self.index);
        for node in &removed {
            index.remove(&node.id);
        }
        self.reindex(start);
        Ok(removed)
    }

    /// Makes a node with its subtree the `position`-th child of `parent`; `position` counts the children without the
    /// moved node.
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
        let mut depths = self.depths[self.subtree(index)].to_vec();
        let old_top = depths[0];
        for depth in &mut depths {
            *depth = *depth - old_top + top;
        }
        let mut subtree = self.remove(id)?;
        Arc::make_mut(&mut subtree[0]).parent = parent;
        let at = self.insertion_index(parent, position);
        Arc::make_mut(&mut self.depths).splice(at..at, depths);
        self.nodes.splice(at..at, subtree);
        self.reindex(at);
        Ok(())
    }

    /// Replaces the node of the same id. Its place in the tree stays, whatever `node.parent` says.
    pub fn replace(&mut self, node: Node) -> Result<(), SceneError> {
        let index = self.index_of(node.id).ok_or(SceneError::NoNode(node.id))?;
        self.check_material(&node)?;
        let has_children = self.subtree(index).len() > 1;
        if has_children && !node.has_children() {
            return Err(SceneError::NotAGroup(node.id));
        }
        let old = Some(&*self.nodes[index]);
        image_budget::check(self.images(), old, std::slice::from_ref(&node))?;
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
        image_budget::check_material(self.images(), &material)?;
        self.materials.push(Arc::new(material));
        Ok(())
    }

    /// Replaces the material of the same id.
    pub fn replace_material(&mut self, material: Material) -> Result<(), SceneError> {
        let at = self.materials.iter().position(|m| m.id == material.id).ok_or(SceneError::NoMaterial(material.id))?;
        image_budget::check_material(self.images(), &material)?;
        self.materials[at] = Arc::new(material);
        Ok(())
    }

    /// Moves a material to a place in the list, counted without it.
    pub fn move_material(&mut self, id: MaterialId, position: usize) -> Result<(), SceneError> {
        let at = self.materials.iter().position(|m| m.id == id).ok_or(SceneError::NoMaterial(id))?;
        let material = self.materials.remove(at);
        self.materials.insert(position.min(self.materials.len()), material);
        Ok(())
    }

    /// Removes a material that no node uses.
    pub fn remove_material(&mut self, id: MaterialId) -> Result<(), SceneError> {
        let at = self.materials.iter().position(|m| m.id == id).ok_or(SceneError::NoMaterial(id))?;
        if let Some(node) = self.nodes.iter().find(|n| n.materials().any(|used| used == id)) {
            return Err(SceneError::MaterialInUse(id, node.id));
        }
        self.materials.remove(at);
        Ok(())
    }

    /// Replaces the environment.
    pub fn set_environment(&mut self, environment: Environment) -> Result<(), SceneError> {
        image_budget::check_environment(self.images(), &environment)?;
        self.environment = environment;
        Ok(())
    }

    fn check_node(&self, node: &Node) -> Result<(), SceneError> {
        if let Some(parent) = node.parent {
            self.group_index(parent)?;
        }
        self.check_material(node)
    }

    fn check_material(&self, node: &Node) -> Result<(), SceneError> {
        match node.materials().find(|id| self.material(*id).is_none()) {
            Some(id) => Err(SceneError::NoMaterial(id)),
            None => Ok(()),
        }
    }

    fn group_index(&self, id: NodeId) -> Result<usize, SceneError> {
        let index = self.index_of(id).ok_or(SceneError::NoNode(id))?;
        match self.nodes[index].kind {
            NodeKind::Group(_) | NodeKind::Instancer(_) => Ok(index),
            _ => Err(SceneError::NotAGroup(id)),
        }
    }

    /// The index in the table of the `position`-th child of `parent`, existing or new.
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
        let index = Arc::make_mut(&mut self.index);
        for (i, node) in self.nodes.iter().enumerate().skip(from) {
            index.insert(node.id, i as u32);
        }
    }

    /// Panics if an invariant is violated; for tests.
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

/// The depth of each node of a forest in pre-order whose roots stand below `parent` at depth `top`.
fn nest<'a>(
    nodes: impl IntoIterator<Item = &'a Node>,
    parent: Option<NodeId>,
    top: usize,
) -> Result<Vec<u32>, SceneError> {
    let mut depths = Vec::new();
    let mut seen = HashSet::new();
    let mut open: Vec<&Node> = Vec::new();
    for node in nodes {
        while open.last().is_some_and(|n| Some(n.id) != node.parent) {
            open.pop();
        }
        match (open.last(), node.parent) {
            (None, p) if p == parent => {}
            (Some(last), _) if last.has_children() => {}
            (Some(last), _) => return Err(SceneError::NotAGroup(last.id)),
            (None, Some(p)) if !seen.contains(&p) => return Err(SceneError::NoNode(p)),
            (None, _) => return Err(SceneError::OutOfOrder(node.id)),
        }
        if !seen.insert(node.id) {
            return Err(SceneError::DuplicateNode(node.id));
        }
        let depth = top + open.len();
        check_limit("the nesting of nodes", depth + 1, MAX_DEPTH)?;
        if node.id.0 > MAX_ID {
            return Err(SceneError::Limit { what: "the id of a node", limit: MAX_ID as usize });
        }
        depths.push(depth as u32);
        open.push(node);
    }
    Ok(depths)
}

fn check_limit(what: &'static str, value: usize, limit: usize) -> Result<(), SceneError> {
    if value > limit { Err(SceneError::Limit { what, limit }) } else { Ok(()) }
}

#[cfg(test)]
mod tests;
