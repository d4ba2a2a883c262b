//! A dragged value reaches the picture in the same frame, builds no pipeline and uploads next to nothing.

use isolith::document::{Document, Edit};
use isolith::field::{GBuffer, flatten};
use isolith::render::{EvalStrategy, Renderer};
use isolith::scene::{MaterialId, Node, NodeId, NodeKind, Object, Scene, Shape};

use crate::gpu::{Shared, shared};

const SIZE: [u32; 2] = [64, 64];
/// Upload limit for an edit of a leaf: more than one value, far less than the scene.
const MOST_BYTES: u64 = 256;

/// A row of balls; the test drags the first.
fn document() -> (Document, NodeId) {
    let mut scene = Scene::new();
    let mut dragged = None;
    for i in 0..16 {
        let object = Object { shape: Shape::Sphere { radius: 0.4 }, material: MaterialId(1) };
        let node = Node::new("ball", NodeKind::Object(object)).at([f64::from(i), 0.0, 0.0].into());
        let id = scene.insert(None, usize::MAX, node).expect("the scene has room");
        dragged.get_or_insert(id);
    }
    (Document::new(scene), dragged.expect("a ball"))
}

fn set_radius(document: &mut Document, id: NodeId, radius: f64) {
    let mut node = Node::clone(document.scene().node(id).expect("the ball"));
    let NodeKind::Object(object) = &mut node.kind else { unreachable!("it is a ball") };
    object.shape = Shape::Sphere { radius };
    document.apply(Edit::Replace(node)).expect("within the limits");
}

fn picture(renderer: &mut Renderer, document: &Document) -> GBuffer {
    let flat = flatten(document.scene(), 0.0).expect("within the limits");
    let eye = glam::DVec3::new(1.0, 1.0, 5.0);
    let camera = isolith::geometry::Camera::looking_at(eye, glam::DVec3::new(1.0, 0.0, 0.0), 0.8);
    renderer.render(&flat, &[], &camera, SIZE, &mut |_| true).expect("a picture").0
}

#[test]
fn a_dragged_radius_is_in_the_next_picture_and_builds_nothing() {
    let Shared { gpu, renderer } = &mut *shared();
    for strategy in [EvalStrategy::Interpreter, EvalStrategy::StraightLine] {
        renderer.set_strategy(strategy);
        let (mut document, ball) = document();
        let mut last = picture(renderer, &document);
        let (built, mut uploaded) = (renderer.pipelines().built(), renderer.uploaded());
        document.begin_gesture();
        for step in 1..=10 {
            set_radius(&mut document, ball, 0.4 + 0.05 * f64::from(step));
            let next = picture(renderer, &document);
            assert_ne!(next.depth, last.depth, "step {step} is not in the picture");
            let bytes = renderer.uploaded() - uploaded;
            assert!(bytes > 0 && bytes <= MOST_BYTES, "step {step} uploaded {bytes} bytes");
            (last, uploaded) = (next, renderer.uploaded());
        }
        document.end_gesture();
        assert_eq!(renderer.pipelines().built(), built, "{strategy:?}: a drag built a pipeline");
        // A renderer without the history of the drag draws the same picture.
        let mut fresh = Renderer::new(gpu).expect("a renderer");
        fresh.set_strategy(strategy);
        assert_eq!(picture(&mut fresh, &document), last);
        assert!(document.undo() && !document.undo(), "the drag is one step of undo");
    }
}

#[test]
fn a_new_shape_does_build_a_pipeline() {
    // The count above can change: a shape new to the renderer needs a pipeline.
    let gpu = shared().gpu.clone();
    let mut renderer = Renderer::new(&gpu).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Interpreter);
    let (mut document, ball) = document();
    picture(&mut renderer, &document);
    let built = renderer.pipelines().built();
    let mut node = Node::clone(document.scene().node(ball).expect("the ball"));
    let shape = Shape::Torus { major_radius: 0.5, minor_radius: 0.2 };
    node.kind = NodeKind::Object(Object { shape, material: MaterialId(1) });
    document.apply(Edit::Replace(node)).expect("within the limits");
    picture(&mut renderer, &document);
    assert_eq!(renderer.pipelines().built(), built + 1);
}
