//! The fixed part of numerical stress; `make bench` draws all of it.

use isolith::bench::{Figures, cases};
use isolith::flat::truth::{Truth, truth};
use isolith::geometry::Camera;
use isolith::render::Method;
use isolith::scene::{MaterialId, ModifierKind, Node, NodeKind, Object, Operator, Scene, Shape, ShapeKind};

use crate::gpu::{Subject, shared};

#[test]
fn what_is_difficult_is_drawn_as_it_is() {
    let renderer = &mut shared().renderer;
    renderer.set_method(Method::Interpreted);
    let (mut faults, mut drawn) = (Vec::new(), 0);
    for case in cases().iter().filter(|case| case.is_tested()) {
        let figures = case.measure(renderer);
        let figures = figures.unwrap_or_else(|error| panic!("{}, {}: {error}", case.name(), case.circumstance));
        if let Some(figures) = figures {
            faults.extend(figures.faults());
            drawn += 1;
        }
    }
    assert!(drawn > 70, "{drawn} cases were drawn");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_shape_operator_and_modifier_is_stressed() {
    let names: Vec<String> = cases().iter().map(|case| case.name()).collect();
    let labels = ShapeKind::ALL.iter().map(|kind| kind.label());
    let labels = labels.chain(Operator::ALL.iter().map(|operator| operator.label()));
    for label in labels.chain(ModifierKind::ALL.iter().map(|kind| kind.label())) {
        let count = names.iter().filter(|name| name.split(',').next() == Some(label)).count();
        assert!(count >= 8, "{label}: {count} cases");
    }
}

/// A ball before the background.
fn ball(radius: f64) -> Subject {
    let mut scene = Scene::new();
    let object = Object { shape: Shape::Sphere { radius }, material: MaterialId(1) };
    scene.insert(None, 0, Node::new("Ball", NodeKind::Object(object))).unwrap();
    let mut subject = Subject::new("ball", &scene, None);
    subject.camera = Camera::looking_at(glam::DVec3::new(0.3, 0.4, 3.0), glam::DVec3::ZERO, 0.5);
    subject
}

#[test]
fn another_radius_and_what_is_no_number_are_refused() {
    const SIDE: u32 = 40;
    let right = ball(0.5);
    let truth: Truth = truth(&right.flat, &[], &right.camera, [SIDE, SIDE], &|_| ()).unwrap();
    let footprint = right.camera.footprint(f64::from(SIDE));
    let faults = |buffers: &_| Figures::of(buffers, &truth, footprint).faults();
    let picture = right.render(SIDE, Method::Interpreted);
    assert!(faults(&picture).is_empty(), "{:?}", faults(&picture));
    for radius in [0.49, 0.51] {
        assert!(!faults(&ball(radius).render(SIDE, Method::Interpreted)).is_empty(), "{radius}");
    }
    let hit = picture.depth.iter().position(|depth| depth.is_finite()).unwrap();
    for pixel in [0, hit] {
        let mut broken = picture.clone();
        broken.depth[pixel] = f32::NAN;
        assert!(!faults(&broken).is_empty());
        let mut broken = picture.clone();
        broken.normal[pixel][1] = f32::NAN;
        assert!(!faults(&broken).is_empty());
    }
}
