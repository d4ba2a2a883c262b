//! Keyframes: a ball that bounces and is squashed, a ring that turns, drops that merge, a lamp whose color changes.

use std::f64::consts::FRAC_PI_2;

use glam::{DQuat, DVec3};

use super::scene_builder::{SceneBuilder, blended, cuboid, object, sphere, torus, turn_x, v};
use isolith_scene::KeyInterpolation::{self, Linear, Smooth};
use isolith_scene::{
    BlendKernel, Falloff, Keyframe, LightKind, NodeId, Operator, ParamPath, ParamValue, Part, Scene, Shadowing,
    Timeline, Track,
};

/// Seconds of a bounce, and of the whole loop.
const BOUNCE: f64 = 1.0;
const LOOP: f64 = 4.0;

pub(super) fn scene() -> Scene {
    let mut builder = SceneBuilder::new([0.10, 0.14, 0.20], [0.22, 0.22, 0.24], [0.20, 0.21, 0.24]);
    builder.shade(Shadowing::default());
    let floor = builder.matte("Floor", [0.42, 0.41, 0.39]);
    let rubber = builder.glossy("Rubber", [0.72, 0.16, 0.10], 0.35);
    let brass = builder.metal("Brass", [0.80, 0.56, 0.24], 0.25);
    let water = builder.glossy("Water", [0.10, 0.34, 0.52], 0.1);
    builder.add(None, object("Floor", cuboid(7.0, 0.2, 5.0, 0.03), floor).at(v(0.0, -0.1, 0.0)));
    let ball = builder.add(None, object("Ball", sphere(0.4), rubber).at(v(-1.6, 1.7, 0.0)));
    let ring = builder.add(None, object("Ring", torus(0.6, 0.14), brass).at(v(1.7, 0.9, -0.2)).rotated(turn_x(90.0)));
    let drops = builder.add(None, blended("Drops", Operator::Union, BlendKernel::Circular, 0.35));
    let left = builder.add(drops, object("Left drop", sphere(0.32), water).at(v(-0.55, 0.8, 0.4)));
    let right = builder.add(drops, object("Right drop", sphere(0.26), water).at(v(0.65, 0.8, 0.4)));
    let lamp = LightKind::Point { power: 520.0, radius: 0.2, falloff: Falloff::InverseSquare {} };
    builder.light("Lamp", [[0.6, 3.4, 2.6], [0.0; 3]], [1.0, 0.85, 0.7], lamp);
    builder.camera([0.5, 2.4, 6.6], [0.1, 0.85, 0.0], 44.0);
    let mut scene = builder.finish();
    let light = scene.nodes().iter().find(|node| node.name == "Lamp").map(|node| node.id);
    scene.animation.timeline = Timeline { end: LOOP, ..Timeline::default() };
    let turned = DQuat::from_rotation_x(FRAC_PI_2);
    let turns = (0..=4).map(|i| (f64::from(i), ParamValue::Rotation(turned * DQuat::from_rotation_x(quarter(i)))));
    let mut tracks = bounce(ball);
    tracks.push(track(ring, Part::Transform, "rotation", Linear, turns));
    tracks.push(track(left, Part::Transform, "translation", Smooth, sway(v(-0.55, 0.8, 0.4), v(0.0, 0.8, 0.4))));
    tracks.push(track(right, Part::Transform, "translation", Smooth, sway(v(0.65, 0.8, 0.4), v(0.1, 1.0, 0.4))));
    let colors = [[1.0, 0.85, 0.7], [0.55, 0.75, 1.0], [1.0, 0.85, 0.7]];
    let colors = colors.into_iter().enumerate().map(|(i, color)| (2.0 * i as f64, vector(color.into())));
    tracks.extend(light.map(|light| track(light, Part::Light, "color", Smooth, colors)));
    scene.set_tracks(tracks).expect("the tracks suit their parameters");
    scene
}

fn quarter(count: i32) -> f64 {
    f64::from(count) * FRAC_PI_2
}

fn vector(value: DVec3) -> ParamValue {
    ParamValue::Vector(value)
}

fn track(
    id: NodeId,
    part: Part,
    name: &'static str,
    interpolation: KeyInterpolation,
    keys: impl IntoIterator<Item = (f64, ParamValue)>,
) -> Track {
    let key = |(time, value)| Keyframe { time, value, interpolation };
    Track { path: ParamPath::of_node(id, part, name), keys: keys.into_iter().map(key).collect() }
}

/// There and back.
fn sway(from: DVec3, to: DVec3) -> [(f64, ParamValue); 3] {
    [(0.0, vector(from)), (0.5 * LOOP, vector(to)), (LOOP, vector(from))]
}

/// The height and the scale of a ball that falls to the floor and rises again; it is flat for a moment where it lands.
fn bounce(ball: NodeId) -> Vec<Track> {
    let height = ParamPath::of_node(ball, Part::Transform, "translation").element(1);
    let mut heights = Vec::new();
    let mut scales = vec![(0.0, vector(DVec3::ONE))];
    for count in 0..4 {
        let (start, landing) = (f64::from(count) * BOUNCE, (f64::from(count) + 0.5) * BOUNCE);
        heights.extend([(start, 1.7), (landing - 0.06, 0.4), (landing, 0.28), (landing + 0.06, 0.4)]);
        let whole = |time| (time, vector(DVec3::ONE));
        scales.extend([whole(landing - 0.06), (landing, vector(v(1.2, 0.7, 1.2))), whole(landing + 0.06)]);
    }
    heights.push((LOOP, 1.7));
    scales.push((LOOP, vector(DVec3::ONE)));
    let heights = heights.into_iter().map(|(time, value)| (time, ParamValue::Scalar(value)));
    let heights = Track { path: height, ..track(ball, Part::Transform, "translation", Smooth, heights) };
    vec![heights, track(ball, Part::Transform, "scale", Smooth, scales)]
}
