//! The content of groups that are drawn from bricks.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::DVec3;

use isolith_bricks::{BakedField, BrickError, Bricks, ContentHash, ContentKey, VoxelLook, bake_levels};
use isolith_field::eval::surface;
use isolith_field::flatten;
use isolith_field::scene_eval::SceneEvaluator;
use isolith_geometry::{Aabb, Transform};
use isolith_jobs::Task;
use isolith_mesh::maker_key;
use isolith_scene::{
    BlendOverride, Environment, Group, Material, Node, NodeId, NodeKind, Operation, Scene, Track, file,
};

/// Changes with what the f64 evaluation says of the same content; what bricks hold of it is in the maker's key.
const MAKER: u64 = 2;

/// The content of a group, in its own space.
#[derive(Debug)]
pub struct GroupContent {
    /// The group, for messages.
    pub name: String,
    scene: Scene,
    key: ContentKey,
}

// Equal keys stand for equal content.
impl PartialEq for GroupContent {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for GroupContent {}

impl Hash for GroupContent {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key.hash(state);
    }
}

impl GroupContent {
    /// The content of the group at `index`, or why it cannot be baked.
    fn of(scene: &Scene, index: usize) -> Result<Self, String> {
        if let Some(reason) = scene.unbakeable(index) {
            return Err(reason);
        }
        let top = &scene.nodes()[index];
        let mut nodes: Vec<Node> = scene.nodes()[scene.subtree(index)].iter().map(|node| Node::clone(node)).collect();
        for node in &mut nodes {
            // What says nothing of the surface.
            (node.name, node.locked) = (String::new(), false);
            if let NodeKind::Group(group) = &mut node.kind {
                group.bake = 0.0;
            }
        }
        nodes[0] = Node {
            parent: None,
            visible: true,
            operation: Operation::Add,
            blend_override: BlendOverride::Inherit,
            apart: Vec::new(),
            transform: Transform::IDENTITY,
            dynamics: Vec::new(),
            modifiers: Vec::new(),
            ..nodes[0].clone()
        };
        let used = |material: &&Arc<Material>| nodes.iter().flat_map(Node::materials).any(|id| id == material.id);
        let materials = scene.materials().iter().filter(used).map(|material| Material::clone(material)).collect();
        let part =
            Scene::from_tables(nodes, materials, Environment::default(), 0).map_err(|error| error.to_string())?;
        let mut hash = ContentHash::default();
        maker_key().0.into_iter().chain([MAKER]).for_each(|word| hash.word(word));
        hash.bytes(file::to_json(&part).map_err(|error| error.to_string())?.as_bytes());
        Ok(Self { name: format!("{} {}", top.name, top.id), scene: part, key: hash.key() })
    }

    /// The key of its bricks in voxels of this size.
    pub fn key(&self, voxel: f64) -> ContentKey {
        let mut hash = ContentHash::default();
        self.key.0.into_iter().chain([voxel.to_bits()]).for_each(|word| hash.word(word));
        hash.key()
    }

    /// Its bricks in voxels of this size, or with this many along the longest side if that is 0.
    ///
    /// # Errors
    /// It has no end, there would be too many, or the task was canceled.
    pub fn bricks(
        &self,
        [resolution, voxel]: [f64; 2],
        known: &dyn Fn(ContentKey) -> Option<Bricks>,
        task: &Task,
    ) -> Result<(ContentKey, Arc<Bricks>), BrickError> {
        let flat = flatten(&self.scene, 0.0).map_err(|error| BrickError::Refused(error.to_string()))?;
        let all = |all: Aabb, component: &isolith_field::Component| all.union(&component.world_bounds());
        let bounds = flat.components.iter().fold(Aabb::EMPTY, all);
        let longest = (2.0 * bounds.half()).max_element();
        let voxel = if voxel > 0.0 || bounds.is_empty() || !bounds.is_finite() { voxel } else { longest / resolution };
        let key = self.key(voxel);
        if let Some(bricks) = known(key) {
            return Ok((key, Arc::new(bricks)));
        }
        let distance = |p: DVec3, within: f64| SceneEvaluator::new(&flat).distance(p, within).value;
        let look = |p: DVec3| {
            let nearest = SceneEvaluator::new(&flat).distance(p, f64::INFINITY).component;
            nearest.map_or(VoxelLook::unpacked([0xff_ffff, 0]), |index| {
                let component = &flat.components[index as usize];
                look_of(&surface(&flat, component, p - component.origin))
            })
        };
        let has_looks = self.scene.materials().len() > 1;
        let field = BakedField { bounds, distance: &distance, look: has_looks.then_some(&look) };
        let progress = |share: f32| {
            task.set_progress(share);
            !task.is_canceled()
        };
        bake_levels(&field, if voxel > 0.0 { voxel } else { 1.0 }, &progress).map(|bricks| (key, bricks))
    }
}

/// The look of a point of the surface, with one color for what it reflects and what it emits.
fn look_of(point: &isolith_field::eval::SurfacePoint) -> VoxelLook {
    let material = &point.material;
    let light = material.emission.max_element();
    let color = if light > material.base_color.max_element() { material.emission / light } else { material.base_color };
    let emission = if light > 0.0 { light / color.max_element() } else { 0.0 };
    let bend = DVec3::ZERO;
    VoxelLook { color, metalness: material.metalness, roughness: material.roughness, emission, bend }
}

/// What a group's content was made of.
#[derive(Debug)]
struct KnownContent {
    nodes: Vec<Arc<Node>>,
    materials: Vec<Arc<Material>>,
    tracks: Vec<Arc<Track>>,
    content: Result<Arc<GroupContent>, String>,
}

impl KnownContent {
    fn is_current(&self, scene: &Scene, index: usize) -> bool {
        let now = &scene.nodes()[scene.subtree(index)];
        let group = |node: &Node| if let NodeKind::Group(group) = node.kind { Some(group) } else { None };
        let inside = |a: &Option<Group>| a.map(|group| Group { bake: 0.0, ..group });
        now.len() == self.nodes.len()
            && inside(&group(&now[0])) == inside(&group(&self.nodes[0]))
            && are_same(&now[1..], &self.nodes[1..])
            && are_same(scene.materials(), &self.materials)
            && are_same(scene.animation.tracks(), &self.tracks)
    }
}

/// Whether both hold the same; what is shared is not compared.
fn are_same<T: PartialEq>(a: &[Arc<T>], b: &[Arc<T>]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b) || a == b)
}

/// The contents of the groups to be baked, made anew where one has changed.
#[derive(Debug, Default)]
pub struct GroupContents {
    known: HashMap<NodeId, KnownContent>,
}

impl GroupContents {
    /// Follows the scene.
    pub fn follow(&mut self, scene: &Scene) {
        let baked = scene.baked_groups();
        self.known.retain(|id, _| baked.iter().any(|index| scene.nodes()[*index].id == *id));
        for index in baked {
            let id = scene.nodes()[index].id;
            if self.known.get(&id).is_some_and(|known| known.is_current(scene, index)) {
                continue;
            }
            let known = KnownContent {
                nodes: scene.nodes()[scene.subtree(index)].to_vec(),
                materials: scene.materials().to_vec(),
                tracks: scene.animation.tracks().to_vec(),
                content: GroupContent::of(scene, index).map(Arc::new),
            };
            self.known.insert(id, known);
        }
    }

    /// The contents in this scene, by the index of their group, with its resolution.
    pub fn of<'a>(
        &'a self,
        scene: &'a Scene,
    ) -> impl Iterator<Item = (usize, f64, &'a Result<Arc<GroupContent>, String>)> {
        scene.baked_groups().into_iter().filter_map(|index| {
            let node = &scene.nodes()[index];
            let NodeKind::Group(group) = node.kind else { return None };
            let known = self.known.get(&node.id).filter(|known| known.is_current(scene, index))?;
            Some((index, group.bake, &known.content))
        })
    }

    /// Whether no group is to be baked.
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use isolith_scene::{
        KeyInterpolation, Keyframe, MaterialId, Object, ParamOwner, ParamPath, ParamValue, Part, ShapeKind,
    };

    use super::*;

    /// A baked group with a ball, and a ball beside it; `moving` has keys.
    fn scene(moving: u64) -> Scene {
        let mut scene = Scene::new();
        let group = NodeKind::Group(Group { bake: 32.0, ..Group::UNION });
        let parent = scene.insert(None, 0, Node::new("Group", group)).unwrap();
        for parent in [Some(parent), None] {
            let shape = ShapeKind::Sphere.default_shape();
            let ball = Node::new("Ball", NodeKind::Object(Object { shape, material: MaterialId(1) }));
            scene.insert(parent, usize::MAX, ball).unwrap();
        }
        let owner = ParamOwner::Node(NodeId(moving), Part::Transform);
        let path = ParamPath { owner, name: "translation".into(), element: None };
        let key = |time: f64| Keyframe {
            time,
            value: ParamValue::Vector(DVec3::X * time),
            interpolation: KeyInterpolation::Linear,
        };
        scene.set_tracks([Track { path, keys: vec![key(0.0), key(1.0)] }]).unwrap();
        scene
    }

    #[test]
    fn content_is_read_again_only_where_it_changed() {
        let content = |contents: &GroupContents, scene: &Scene| contents.of(scene).next().expect("a group").2.clone();
        let (mut contents, mut scene) = (GroupContents::default(), scene(3));
        contents.follow(&scene);
        let first = content(&contents, &scene).unwrap();
        contents.follow(&scene);
        assert!(Arc::ptr_eq(&first, &content(&contents, &scene).unwrap()), "keys beside it change nothing");
        // Keys within it are refused as soon as they are there.
        scene.set_tracks(self::scene(2).animation.tracks().iter().map(|track| Track::clone(track))).unwrap();
        contents.follow(&scene);
        assert!(content(&contents, &scene).unwrap_err().contains("has keys"));
    }
}
