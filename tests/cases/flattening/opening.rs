//! Scenes that take long to flatten open in the editor in the background.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use isolith::document::{Document, Edit};
use isolith::editor::{Editor, Picture};
use isolith::field::flatten;
use isolith::scene::{CameraNode, Modifier, Node, NodeId, NodeKind, Scene};

use super::{add, around, ball, flat, load};

/// `inner` times `outer` balls in rings, and a camera.
fn rings(inner: u32, outer: u32) -> Scene {
    let mut scene = Scene::new();
    add(&mut scene, None, ball().modified(around(inner)).modified(around(outer)));
    let lens = CameraNode { fov_y: 33.0, near: 0.01, far: 99.0, ..CameraNode::default() };
    add(&mut scene, None, Node::new("lens", NodeKind::Camera(lens)));
    scene
}

fn open(scene: Scene) -> Harness<'static, Editor> {
    shown(Editor::new(Document::new(scene)))
}

fn shown(editor: Editor) -> Harness<'static, Editor> {
    Harness::builder()
        .with_context_setup(Editor::setup)
        .build_ui_state(|ui, editor: &mut Editor| editor.show(ui, &Picture::default()), editor)
}

/// Shows frames until the arrays are ready.
fn wait(harness: &mut Harness<'_, Editor>) {
    let started = Instant::now();
    while harness.query_by_label("Preparing the scene…").is_some() {
        assert!(started.elapsed() < Duration::from_secs(20), "it is never ready");
        std::thread::sleep(Duration::from_millis(10));
        harness.step();
    }
}

#[test]
fn a_large_scene_is_prepared_beside_the_frames() {
    let scene = rings(512, 100);
    let started = Instant::now();
    let editor = Editor::new(Document::new(scene.clone()));
    // The editor has not waited, and shows no arrays of another document in the meantime.
    assert!(editor.flat().nodes.is_empty(), "it was there after {:?}", started.elapsed());
    let mut harness = shown(editor);
    harness.step();
    wait(&mut harness);
    assert_eq!(**harness.state().flat(), flat(&scene));
    // The first view waited for the scene's camera.
    assert!((harness.state().view().camera.fov_y.to_degrees() - 33.0).abs() < 1e-9);
    // A small scene is ready in its first frame.
    assert!(!open(rings(3, 2)).state().flat().nodes.is_empty());
}

#[test]
fn what_is_newer_replaces_what_is_being_prepared() {
    let mut harness = open(rings(512, 100));
    harness.step();
    let change = |harness: &mut Harness<'_, Editor>, count: u32| {
        let node = Node::clone(harness.state().document().scene().node(NodeId(1)).expect("the ball"));
        let mut node = node;
        node.modifiers[1].modifier = Modifier::Polar { count, radius: 9.0, mirrored: false };
        harness.state_mut().document_mut().apply(Edit::Replace(node)).expect("a good value");
        harness.step();
        harness.step();
    };
    change(&mut harness, 99);
    change(&mut harness, 2);
    assert!(harness.query_by_label("Preparing the scene…").is_none(), "a small one is there at once");
    let expected = flatten(harness.state().document().scene(), 0.0).expect("within every limit");
    assert_eq!(**harness.state().flat(), expected);
    change(&mut harness, 98);
    wait(&mut harness);
    let expected = flatten(harness.state().document().scene(), 0.0).expect("within every limit");
    assert_eq!(**harness.state().flat(), expected);
}

#[test]
fn a_scene_beyond_a_limit_opens_and_says_so() {
    let mut harness = open(load("hostile/polar2.json"));
    harness.step();
    let told = harness.query_all_by_label_contains("Not shown: n1 (#1)").next();
    assert!(told.is_some() && harness.state().flat().nodes.is_empty());
}
