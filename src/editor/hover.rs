//! The node under the pointer, marked before a click selects it.

use std::time::{Duration, Instant};

use egui::{Color32, Painter, Pos2, Stroke};

use super::bounds;
use super::choice_walk::representative;
use super::overlay::paint_box;
use super::picking::pick_copy;
use super::projection::Projection;
use super::state::EditorState;
use super::viewport_click::hit_at;
use isolith_field::pick::{Picked, PickedCopy};
use isolith_geometry::Camera;
use isolith_scene::{NodeId, Scene};

/// The share of the time that looking for the node may take.
const SHARE: u32 = 8;

/// What was found under the pointer, and for which picture.
#[derive(Default)]
pub struct Hover {
    looked: Option<(Pos2, Camera, u64)>,
    node: Option<NodeId>,
    copy: Option<Picked>,
    /// Where looking is slow, it waits.
    rests: Option<(Instant, Duration)>,
}

impl Hover {
    /// Looks under the pointer, unless nothing has moved since or looking takes too much of the time.
    pub fn look(&mut self, state: &EditorState, projection: &Projection, pointer: Option<Pos2>) {
        let Some(at) = pointer else {
            *self = Self { rests: self.rests, ..Self::default() };
            return;
        };
        let now = (at, state.view.navigation.camera(), state.session.document.revision());
        let is_resting = self.rests.is_some_and(|(since, length)| since.elapsed() < length);
        if self.looked == Some(now) || is_resting {
            return;
        }
        let start = Instant::now();
        let scene = state.session.document.scene();
        self.node = hit_at(state, projection, at).map(|id| representative(scene, state.view.entered, id));
        // Only where there are copies is it worth another look.
        let has_copies = self.node.is_some() && !state.flat().instancers.is_empty();
        self.copy = if has_copies { pick_copy(state, &projection.ray(at)) } else { None };
        self.looked = Some(now);
        self.rests = Some((Instant::now(), start.elapsed() * SHARE));
    }

    /// What the copy under the pointer is part of, from the top of the scene to the object.
    pub fn copy_path(&self, scene: &Scene) -> Option<String> {
        let Picked { node, copy } = self.copy?;
        copy_path(scene, node, copy?)
    }

    /// Paints the corners of its box, unless it is selected.
    pub fn paint(&self, state: &EditorState, painter: &Painter, projection: &Projection) {
        let Some(id) = self.node.filter(|id| !state.session.document.selection().contains(id)) else { return };
        let scene = state.session.document.scene();
        let Some((world_from_local, bounds)) = bounds::oriented(scene, state.derived.library(), id) else { return };
        let corners = bounds.corners().map(|c| projection.to_screen(world_from_local.transform_point3(c)));
        // A dark line below a light one is seen on every color.
        paint_box(painter, &corners, Stroke::new(3.0, Color32::from_black_alpha(90)));
        paint_box(painter, &corners, Stroke::new(1.25, Color32::from_white_alpha(190)));
    }
}

/// The names of the nodes from the top of the scene down to `node`, with the cell of the copy behind its instancer.
fn copy_path(scene: &Scene, node: NodeId, copy: PickedCopy) -> Option<String> {
    let mut names = Vec::new();
    let mut at = Some(node);
    while let Some(id) = at {
        let node = scene.node(id)?;
        if id == copy.instancer {
            let [x, y, z] = copy.cell;
            names.push(format!("copy {x}, {y}, {z}"));
        }
        names.push(node.name.clone());
        at = node.parent;
    }
    names.reverse();
    Some(names.join(" › "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Node, NodeKind, Object, Shape};

    #[test]
    fn a_copy_is_named_with_its_cell_behind_its_instancer() {
        let mut scene = Scene::new();
        let material = scene.materials()[0].id;
        let copies = NodeKind::Instancer(Box::default());
        let instancer = scene.insert(None, 0, Node::new("Forest", copies)).expect("room");
        let tree = NodeKind::Object(Object { shape: Shape::Sphere { radius: 1.0 }, material });
        let tree = scene.insert(Some(instancer), 0, Node::new("Fir", tree)).expect("room");
        let copy = PickedCopy { instancer, cell: [3, 0, -2] };
        assert_eq!(copy_path(&scene, tree, copy).as_deref(), Some("Forest › copy 3, 0, -2 › Fir"));
        assert_eq!(copy_path(&scene, NodeId(99), copy), None);
    }
}
