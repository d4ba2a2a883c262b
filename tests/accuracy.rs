//! Every scene's picture against the truth, on the same rays.

use isolith::flat::Accuracy;
use isolith::flat::truth::truth;
use isolith::render::Method;
use isolith::scene::{MaterialId, Node, NodeKind, Object, Scene, Shape};

use crate::gpu::{Subject, scenes};

/// Width and height of the pictures, in pixels.
const SIDE: u32 = 256;

/// Both ways to evaluate a component.
const METHODS: [Method; 2] = [Method::Interpreted, Method::Specialised];

/// The errors of what the renderer draws of `drawn`, by each method, measured against the truth of `meant`.
fn measure(drawn: &Subject, meant: &Subject, side: u32) -> [Accuracy; 2] {
    let truth = truth(&meant.flat, &meant.meshes, &meant.camera, [side, side], &|_| ());
    let truth = truth.unwrap_or_else(|error| panic!("{}: {error}", meant.name));
    let footprint = meant.camera.footprint(f64::from(side));
    METHODS.map(|method| Accuracy::against(&drawn.render(side, method), &truth, footprint))
}

#[test]
fn every_scene_is_as_exact_as_promised() {
    let mut faults = Vec::new();
    for scene in scenes() {
        for (method, found) in METHODS.iter().zip(measure(&scene, &scene, SIDE)) {
            let of_scene = |fault: &String| format!("{}, {method:?}: {fault} ({found:?})", scene.name);
            faults.extend(found.faults().iter().map(of_scene));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A ball before the background.
fn ball(radius: f64, lifted: f64) -> Subject {
    let mut scene = Scene::new();
    let object = Object { shape: Shape::Sphere { radius }, material: MaterialId(1) };
    let node = Node::new("ball", NodeKind::Object(object)).at([0.0, lifted, 0.0].into());
    scene.insert(None, 0, node).expect("the scene has room");
    let mut subject = Subject::new("ball", &scene, None);
    let eye = glam::DVec3::new(0.3, 0.4, 3.0);
    subject.camera = isolith::geometry::Camera::looking_at(eye, glam::DVec3::ZERO, 0.7);
    subject
}

#[test]
fn a_ball_is_exact_and_a_slightly_different_one_is_refused() {
    const SMALL: u32 = 64;
    let right = ball(0.8, 0.0);
    assert!(measure(&right, &right, SMALL).iter().all(|found| found.faults().is_empty()));
    for wrong in [ball(0.802, 0.0), ball(0.798, 0.0), ball(0.8, 0.003)] {
        assert!(measure(&wrong, &right, SMALL).iter().all(|found| !found.faults().is_empty()));
    }
}
