//! A document of ten thousand nodes, and one drag of a radius in it: the subject of the benches.

use glam::DVec3;
use isolith::document::{Document, Edit};
use isolith::field::FlatScene;
use isolith::geometry::Camera;
use isolith::render::{OverlaySettings, Renderer, Slot};
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Node, NodeId, NodeKind, Object, Operator, Scene, Shape, ShapeKind,
};

/// Groups in the document, each with [`LEAVES`] blended leaves.
const GROUPS: usize = 1_111;
/// Leaves in each group.
const LEAVES: usize = 8;

/// 1 111 groups of 8 blended leaves on a grid, 9 999 nodes, and the node whose radius is dragged.
pub fn document() -> (Document, NodeId) {
    let mut scene = Scene::new();
    let mut add = |parent, node| scene.insert(parent, usize::MAX, node).expect("the scene has room");
    let blend = Blend::new(BlendKernel::Circular, 0.1);
    let mut dragged = NodeId(0);
    for group in 0..GROUPS {
        let place = DVec3::new((group % 34) as f64, 0.0, (group / 34) as f64) * 2.0;
        let kind = NodeKind::Group(Group::new(Operator::Union, blend));
        let parent = add(None, Node::new("group", kind).at(place));
        for leaf in 0..LEAVES {
            let angle = leaf as f64 * std::f64::consts::TAU / LEAVES as f64;
            let shape = match leaf {
                0 => Shape::Sphere { radius: 0.3 },
                i => ShapeKind::ALL[i % 3].default_shape(),
            };
            let object = NodeKind::Object(Object { shape, material: MaterialId(1) });
            let node = Node::new("leaf", object).at(DVec3::new(angle.cos(), 0.2, angle.sin()) * 0.4);
            let id = add(Some(parent), node.scaled(DVec3::splat(0.4)));
            if group == GROUPS / 2 && leaf == 0 {
                dragged = id;
            }
        }
    }
    (Document::new(scene), dragged)
}

/// Renders frames until every pipeline of the scene is built, as they soon are in the editor.
pub fn warm(renderer: &mut Renderer, flat: &FlatScene, camera: &Camera, size: [u32; 2]) {
    loop {
        renderer.begin(Slot::Full, flat, &[], camera, size, OverlaySettings::default()).expect("a frame");
        if !renderer.is_preparing() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

/// The edit of one frame of a drag.
pub fn drag(document: &mut Document, dragged: NodeId, radius: f64) {
    let mut node = Node::clone(document.scene().node(dragged).expect("the node that is dragged"));
    let NodeKind::Object(object) = &mut node.kind else { unreachable!("it is a sphere") };
    object.shape = Shape::Sphere { radius };
    document.apply(Edit::Replace(node)).expect("a radius within its limits");
}
