//! The range of lights, and lights out of view.

use super::*;
use crate::flatten;
use crate::light::brdf::ShadingPoint;
use crate::light::lighting::{lighting_attenuation, lighting_reflected};
use crate::mixture::SurfaceMaterial;
use isolith_scene::{Light, MaterialId, Node, NodeKind, Object, Scene, Shape};

/// A scene with a point light at each place.
fn lit(places: &[DVec3], power: f64) -> FlatScene {
    let mut scene = Scene::new();
    for place in places {
        let kind = LightKind::Point { power, radius: 0.0, falloff: Falloff::InverseSquare {} };
        let node = Node::new("Lamp", NodeKind::Light(Light::new(kind))).at(*place);
        scene.insert(None, usize::MAX, node).expect("room for it");
    }
    flatten(&scene, 0.0).expect("within the limits")
}

#[test]
fn a_light_ends_where_it_is_too_weak_to_see_and_differs_little_before() {
    let flat = lit(&[DVec3::ZERO], 40.0);
    let light = GpuLight::new(&flat.lights[0], DVec3::ZERO);
    let (range, at_one) = (f64::from(light.range), f64::from(light.color[0]));
    assert!((at_one / (range * range) / LEAST_LIGHT - 1.0).abs() < 1e-5);
    for i in 1..=1_000 {
        let distance = 2.0 * range * f64::from(i) / 1_000.0;
        let off = at_one * (1.0 / (distance * distance) - lighting_attenuation(&light, distance));
        assert!(off >= -1e-6 * at_one && off <= 1.1 * LEAST_LIGHT, "{distance}: {off}");
    }
}

/// A light in view that reaches no bounds of anything in view is left out.
#[test]
fn a_light_that_meets_nothing_in_view_is_left_out() {
    let mut bare = Scene::new();
    let place = |x: f64, y: f64| DVec3::new(x, y, -6.0);
    let power = 4.0 * PI * PI * LEAST_LIGHT;
    // Their range is 1 m.
    for at in [place(0.0, 1.5), place(0.0, 2.5), place(-2.0, 0.0), place(3.5, 0.0)] {
        let kind = LightKind::Point { power, radius: 0.0, falloff: Falloff::InverseSquare {} };
        bare.insert(None, usize::MAX, Node::new("Lamp", NodeKind::Light(Light::new(kind))).at(at)).expect("room");
    }
    for at in [place(0.0, 0.0), place(5.0, 0.0)] {
        let ball = Object { shape: Shape::Sphere { radius: 1.0 }, material: MaterialId(1) };
        bare.insert(None, usize::MAX, Node::new("Ball", NodeKind::Object(ball)).at(at)).expect("room");
    }
    let camera = Camera { near: 0.1, far: 100.0, ..Camera::looking_at(DVec3::ZERO, DVec3::NEG_Z, 0.9) };
    let left = |scene: &Scene| gpu_lights(&flatten(scene, 0.0).expect("within the limits"), &camera, [100, 100]).len();
    // The second is too high, and the last one lights a ball that is out of view.
    assert_eq!(left(&bare), 2);
    // A floor that the second lamp reaches, and one that it does not; the others are in it or near.
    for (height, count) in [(2.0, 4), (1.0, 3)] {
        let mut scene = bare.clone();
        let floor = Object { shape: Shape::Plane {}, material: MaterialId(1) };
        let floor = Node::new("Floor", NodeKind::Object(floor)).at(DVec3::Y * height);
        scene.insert(None, usize::MAX, floor).expect("room");
        assert_eq!(left(&scene), count, "{height}");
    }
}

#[test]
fn only_lights_that_cannot_reach_the_view_are_left_out() {
    let camera = Camera { near: 0.1, far: 100.0, ..Camera::looking_at(DVec3::ZERO, DVec3::NEG_Z, 0.7) };
    let size = [200, 100];
    let mut places = Vec::new();
    for x in -8..=8 {
        for z in -8..=8 {
            places.push(DVec3::new(f64::from(x) * 4.0, f64::from((x + z) % 3) * 3.0, f64::from(z) * 4.0));
        }
    }
    let flat = lit(&places, 4.0);
    let left = gpu_lights(&flat, &camera, size);
    assert!(left.len() > 20 && left.len() < places.len() / 2, "{}", left.len());
    let dropped = |light: &GpuLight| !left.contains(light);
    let white = SurfaceMaterial { base_color: DVec3::ONE, ..SurfaceMaterial::default() };
    for light in flat.lights.iter().map(|light| GpuLight::new(light, camera.position)).filter(dropped) {
        for i in 0..2_000 {
            let [x, y, depth] = [i % 20, i / 20 % 10, i / 200].map(f64::from);
            let pixel = glam::DVec2::new(x * 10.0 + 5.0, y * 10.0 + 5.0);
            let ray = camera.ray(pixel, glam::DVec2::new(200.0, 100.0));
            let position = ray.direction * (0.2 + depth * depth);
            let normal = (DVec3::from(light.position.map(f64::from)) - position).normalize();
            let point = ShadingPoint { material: white, position, normal, to_eye: normal };
            assert_eq!(lighting_reflected(&point, &light), DVec3::ZERO);
        }
    }
    assert!(gpu_lights(&lit(&places, 0.0), &camera, size).is_empty(), "lights without power reach nothing");
}
