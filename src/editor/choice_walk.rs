//! What a click selects: the outermost group, what lies below at the next click, the inside of a group after a double
//! click.

use egui::Pos2;

use super::selection;
use isolith_geometry::Camera;
use isolith_scene::{NodeId, Scene};

/// The node that stands for a node under the pointer: the outermost group that holds it, or within the entered group
/// the child of that group.
pub fn representative(scene: &Scene, entered: Option<NodeId>, id: NodeId) -> NodeId {
    let within = entered.filter(|group| *group != id && scene.is_within(id, *group));
    let mut at = id;
    while let Some(parent) = scene.node(at).and_then(|node| node.parent) {
        if Some(parent) == within {
            break;
        }
        at = parent;
    }
    at
}

/// The clicks at one place so far.
#[derive(Clone, Debug)]
pub struct Walk {
    at: Pos2,
    camera: Camera,
    revision: u64,
    choices: Vec<NodeId>,
    index: usize,
}

/// Clicks nearer than this are at the same place, in points.
const SAME_PLACE: f32 = 4.0;

impl Walk {
    /// Starts with the first of the nodes under the pointer, nearest first. After their representatives the nodes
    /// themselves follow. Locked nodes are left out.
    pub fn new(
        scene: &Scene,
        entered: Option<NodeId>,
        below: &[NodeId],
        at: Pos2,
        camera: Camera,
        revision: u64,
    ) -> Self {
        let mut choices: Vec<NodeId> = Vec::new();
        let outer = below.iter().map(|id| representative(scene, entered, *id));
        for id in outer.chain(below.iter().copied()) {
            if !choices.contains(&id) && selection::holder_of_lock(scene, id).is_none() {
                choices.push(id);
            }
        }
        Self { at, camera, revision, choices, index: 0 }
    }

    /// Whether a click is at the same place of the same picture.
    pub fn continues(&self, at: Pos2, camera: &Camera, revision: u64) -> bool {
        self.at.distance(at) < SAME_PLACE
            && self.camera == *camera
            && self.revision == revision
            && !self.choices.is_empty()
    }

    /// Whether it stands at its first node.
    pub fn is_first(&self) -> bool {
        self.index == 0
    }

    /// Goes on to the next node; the first follows the last.
    pub fn step(&mut self) {
        self.index = (self.index + 1) % self.choices.len().max(1);
    }

    /// The node of this click.
    pub fn chosen(&self) -> Option<NodeId> {
        self.choices.get(self.index).copied()
    }
}

/// The list, with its position on the screen.
#[derive(Clone, Debug)]
pub struct BelowList {
    /// Where the pointer was.
    pub at: Pos2,
    /// The nodes, nearest first.
    pub nodes: Vec<NodeId>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Group, Node, NodeKind};

    #[test]
    fn the_outermost_group_stands_for_what_it_holds_unless_it_is_entered() {
        let mut scene = Scene::new();
        let group = || Node::new("G", NodeKind::Group(Group::UNION));
        let outer = scene.insert(None, 0, group()).unwrap();
        let inner = scene.insert(Some(outer), 0, group()).unwrap();
        let leaf = scene.insert(Some(inner), 0, group()).unwrap();
        let other = scene.insert(None, 1, group()).unwrap();
        assert_eq!(representative(&scene, None, leaf), outer);
        assert_eq!(representative(&scene, Some(outer), leaf), inner);
        assert_eq!(representative(&scene, Some(inner), leaf), leaf);
        assert_eq!(representative(&scene, Some(leaf), leaf), outer, "nothing is within itself");
        assert_eq!(representative(&scene, Some(outer), other), other);
        let camera = Camera::looking_at(glam::DVec3::ONE, glam::DVec3::ZERO, 0.7);
        let mut walk = Walk::new(&scene, None, &[leaf, other], Pos2::ZERO, camera, 7);
        let mut order = Vec::new();
        for _ in 0..4 {
            order.extend(walk.chosen());
            walk.step();
        }
        assert_eq!(order, [outer, other, leaf, outer], "first what stands for them, then they themselves");
        assert!(walk.continues(Pos2::new(2.0, 2.0), &camera, 7) && !walk.continues(Pos2::ZERO, &camera, 8));
    }
}
