//! Tests of tracks, curves, and the scene at a moment.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::*;
use crate::limits::MAX_TRACK_KEYS;
use crate::{
    CameraNode, Environment, Group, Material, MaterialId, Modifier, Node, NodeId, NodeKind, Object, ParamPath,
    ParamValue, Part, Scene, SceneError, Shape, file,
};

fn key(time: f64, value: f64, interpolation: KeyInterpolation) -> Keyframe {
    Keyframe { time, value: ParamValue::Scalar(value), interpolation }
}

fn scalar_track(keys: &[(f64, f64)], interpolation: KeyInterpolation) -> Track {
    let path = ParamPath::of_node(NodeId(1), Part::Shape, "radius");
    Track { path, keys: keys.iter().map(|(time, value)| key(*time, *value, interpolation)).collect() }
}

fn scalar(track: &Track, time: f64) -> f64 {
    match track.value_at(time) {
        Some(ParamValue::Scalar(value)) => value,
        other => panic!("{other:?}"),
    }
}

/// A ball, node 1; a camera, node 2; a group, node 3.
fn scene() -> Scene {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let ball = Object { shape: Shape::Sphere { radius: 1.0 }, material };
    scene.insert(None, 0, Node::new("Ball", NodeKind::Object(ball))).unwrap();
    scene.insert(None, 1, Node::new("Eye", NodeKind::Camera(CameraNode::default()))).unwrap();
    scene.insert(None, 2, Node::new("Parts", NodeKind::Group(Group::UNION))).unwrap();
    scene
}

fn set(scene: &mut Scene, path: &str, keys: Vec<(f64, ParamValue)>) -> Result<(), SceneError> {
    let keyframe = |(time, value)| Keyframe { time, value, interpolation: KeyInterpolation::Linear };
    scene.set_tracks([Track { path: path.parse().unwrap(), keys: keys.into_iter().map(keyframe).collect() }])
}

#[test]
fn curves_pass_through_their_keys_and_never_beyond() {
    let keys = [(0.0, 1.0), (1.0, 2.0), (1.5, 5.0), (4.0, 5.0), (5.0, 3.0), (7.0, 4.0)];
    for interpolation in KeyInterpolation::ALL {
        let track = scalar_track(&keys, interpolation);
        for (time, value) in keys {
            assert_eq!(scalar(&track, time), value, "{interpolation:?}");
        }
        assert_eq!((scalar(&track, -1e6), scalar(&track, 1e6)), (1.0, 4.0));
        for pair in keys.windows(2) {
            let [(start, from), (end, to)] = [pair[0], pair[1]];
            for i in 0..=1000 {
                let value = scalar(&track, start + (end - start) * f64::from(i) / 1000.0);
                assert!((from.min(to)..=from.max(to)).contains(&value), "{interpolation:?}: {value}");
            }
        }
    }
    let half = |interpolation| scalar(&scalar_track(&keys, interpolation), 0.5);
    assert_eq!((half(KeyInterpolation::Linear), half(KeyInterpolation::Hold)), (1.5, 1.0));
}

#[test]
fn smooth_curves_have_no_corners_and_stand_still_at_their_ends() {
    let keys = [(0.0, 1.0), (1.0, 2.0), (1.5, 5.0), (4.0, 5.0), (5.0, 3.0), (7.0, 4.0)];
    let slope_at = |track: &Track, time: f64, h: f64| (scalar(track, time + h) - scalar(track, time)) / h;
    let smooth = scalar_track(&keys, KeyInterpolation::Smooth);
    for (time, _) in keys {
        let [before, after] = [-1e-6, 1e-6].map(|h| slope_at(&smooth, time, h));
        assert!((before - after).abs() < 1e-4, "{time}: {before} and {after}");
    }
    assert!(slope_at(&smooth, 0.0, 1e-6).abs() < 1e-4 && slope_at(&smooth, 7.0, -1e-6).abs() < 1e-4);
    assert!(slope_at(&smooth, 1.0, 1e-6) > 1.0, "it does not stop between two keys that rise");
    // Straight lines have corners: the check can fail.
    let linear = scalar_track(&keys, KeyInterpolation::Linear);
    assert!((slope_at(&linear, 1.0, -1e-6) - slope_at(&linear, 1.0, 1e-6)).abs() > 1.0);
}

#[test]
fn rotations_go_the_shorter_way_at_a_rate_without_jumps() {
    let turned = |angle: f64| DQuat::from_rotation_y(angle);
    let track = |interpolation| Track {
        path: ParamPath::of_node(NodeId(1), Part::Transform, "rotation"),
        keys: [(0.0, turned(0.0)), (1.0, turned(0.5 * PI)), (2.0, -turned(PI)), (3.0, turned(1.5 * PI))]
            .map(|(time, rotation)| Keyframe { time, value: ParamValue::Rotation(rotation), interpolation })
            .into(),
    };
    let angle = |track: &Track, time: f64| match track.value_at(time) {
        Some(ParamValue::Rotation(rotation)) => {
            assert!((rotation.length() - 1.0).abs() < 1e-12);
            let x = rotation * DVec3::X;
            (-x.z).atan2(x.x).rem_euclid(2.0 * PI)
        }
        other => panic!("{other:?}"),
    };
    let linear = track(KeyInterpolation::Linear);
    for i in 0..=30 {
        let time = f64::from(i) / 10.0;
        assert!((angle(&linear, time) - 0.5 * PI * time).abs() < 1e-9, "{time}");
    }
    // Between keys that turn on, a smooth rotation turns on; at the ends it stands.
    let smooth = track(KeyInterpolation::Smooth);
    let rate = |time: f64, h: f64| (angle(&smooth, time + h) - angle(&smooth, time)) / h;
    assert!((rate(1.0, -1e-5) - rate(1.0, 1e-5)).abs() < 1e-3 && rate(1.0, 1e-5) > 1.0);
    assert!(rate(0.0, 1e-5).abs() < 1e-3 && rate(3.0, -1e-5).abs() < 1e-3);
}

#[test]
fn a_scene_at_a_moment_shares_what_does_not_move() {
    let mut scene = scene();
    assert!(matches!(scene.at(3.0), std::borrow::Cow::Borrowed(_)), "without tracks nothing is copied");
    set(
        &mut scene,
        "node.1.transform.translation[1]",
        vec![(0.0, ParamValue::Scalar(0.0)), (2.0, ParamValue::Scalar(4.0))],
    )
    .unwrap();
    set(
        &mut scene,
        "material.1.base_color",
        vec![(0.0, ParamValue::Vector(DVec3::ZERO)), (2.0, ParamValue::Vector(DVec3::ONE))],
    )
    .unwrap();
    let before = scene.clone();
    set(&mut scene, "display.exposure", vec![(0.0, ParamValue::Scalar(0.0)), (1.0, ParamValue::Scalar(2.0))]).unwrap();
    set(&mut scene, "environment.type", vec![]).unwrap();
    let shown = scene.at(1.0);
    shown.assert_invariants();
    assert_eq!(shown.nodes()[0].transform.translation, DVec3::new(0.0, 2.0, 0.0));
    assert_eq!(shown.materials()[0].base_color, [0.5; 3]);
    assert_eq!(shown.display.exposure, 2.0);
    assert!(Arc::ptr_eq(&shown.nodes()[1], &scene.nodes()[1]) && !Arc::ptr_eq(&shown.nodes()[0], &scene.nodes()[0]));
    // The same moment is the same scene, also of a scene at another moment.
    assert_eq!(*shown, *scene.at(1.0));
    assert_eq!(*shown, *scene.at(0.3).at(1.0));
    assert_eq!(scene.nodes(), before.nodes(), "the scene itself keeps its resting values");
}

#[test]
fn values_between_keys_are_held_to_limits_and_contradictions_stay_at_rest() {
    let mut scene = scene();
    let scale = |v: f64| ParamValue::Vector(DVec3::splat(v));
    set(&mut scene, "node.1.transform.scale", vec![(0.0, scale(1.0)), (1.0, scale(-1.0))]).unwrap();
    let param = "node.1.transform.scale".parse::<ParamPath>().unwrap().param(&scene).unwrap();
    let least = param.limits.hard[0];
    assert_eq!(scene.at(0.5).nodes()[0].transform.scale.abs(), DVec3::splat(least));
    // A camera that would see nothing.
    set(&mut scene, "node.2.camera.near", vec![(0.0, ParamValue::Scalar(0.1)), (1.0, ParamValue::Scalar(2000.0))])
        .unwrap();
    let (shown, faults) = scene.at_with_faults(1.0);
    assert_eq!(faults.iter().map(|(id, fault)| (id.0, &*fault.field)).collect::<Vec<_>>(), [(2, "camera.far")]);
    assert_eq!(shown.nodes()[1], scene.nodes()[1]);
    assert!(scene.at_with_faults(0.2).1.is_empty());
}

#[test]
fn tracks_that_do_not_suit_their_parameter_are_refused_with_the_place() {
    let scene = scene();
    let number = ParamValue::Scalar;
    let refused = |path: &str, keys: Vec<(f64, ParamValue)>| {
        let mut scene = scene.clone();
        let error = set(&mut scene, path, keys).expect_err(path).to_string();
        assert!(scene.animation.is_empty());
        error
    };
    let radius = "node.1.object.shape.radius";
    assert!(refused("node.9.transform.scale", vec![(0.0, number(1.0))]).contains("there is no node #9"));
    assert!(refused("node.1.object.shape.length", vec![(0.0, number(1.0))]).contains("there is no such parameter"));
    assert!(refused("node.1.visible", vec![(0.0, ParamValue::Flag(true))]).contains("cannot change with time"));
    assert!(refused(radius, vec![(0.0, ParamValue::Flag(true))]).contains("keys[0].value: must be a value like 1"));
    assert!(refused(radius, vec![(0.0, number(-1.0))]).contains("keys[0].value: must be"));
    assert!(refused(radius, vec![(1.0, number(1.0)), (1.0, number(2.0))]).contains("keys[1].time: must be later"));
    assert!(refused(radius, vec![(f64::NAN, number(1.0))]).contains("keys[0].time: must be"));
    assert!(refused(radius, vec![(1e8, number(1.0))]).contains("keys[0].time: must be"));
    let many = (0..=MAX_TRACK_KEYS).map(|i| (i as f64, number(1.0))).collect();
    assert!(refused(radius, many).contains("must be 1 to 4096 keys"));
    // The whole and an element of it cannot both be animated.
    let mut doubled = scene.clone();
    set(&mut doubled, "node.1.transform.scale", vec![(0.0, ParamValue::Vector(DVec3::ONE))]).unwrap();
    assert!(set(&mut doubled, "node.1.transform.scale[0]", vec![(0.0, number(1.0))]).is_err());
    set(&mut doubled, "node.1.transform.scale", vec![]).unwrap();
    set(&mut doubled, "node.1.transform.scale[0]", vec![(0.0, number(1.0))]).unwrap();
    assert!(set(&mut doubled, "node.1.transform.scale", vec![(0.0, ParamValue::Vector(DVec3::ONE))]).is_err());
}

#[test]
fn tracks_follow_their_modifiers() {
    let slots = |kinds: &[Modifier]| {
        kinds.iter().fold(scene().nodes()[0].as_ref().clone(), |node, kind| node.modified(kind.clone()))
    };
    let (round, shell) = (Modifier::Round { radius: 0.1 }, Modifier::Round { radius: 0.2 });
    let twist = crate::ModifierKind::Twist.default_modifier();
    let places = |old: &[Modifier], new: &[Modifier]| {
        let moved = MovedParts::between(&slots(old), &slots(new));
        (0..old.len()).map(|at| moved.of(Part::Modifier(at))).collect::<Vec<_>>()
    };
    let at = |place: usize| Some(Part::Modifier(place));
    assert_eq!(places(&[round.clone(), twist.clone()], std::slice::from_ref(&twist)), [None, at(0)]);
    assert_eq!(places(&[round.clone(), twist.clone()], &[twist.clone(), round.clone()]), [at(1), at(0)]);
    assert_eq!(places(&[round.clone(), twist.clone()], &[shell, twist.clone()]), [at(0), at(1)]);
    assert_eq!(places(std::slice::from_ref(&round), &[twist.clone(), round.clone()]), [at(1)]);
    assert_eq!(places(&[round], &[twist]), [None]);
}

#[test]
fn animation_survives_a_file() {
    let mut scene = scene();
    let smooth = |time, value| Keyframe { time, value, interpolation: KeyInterpolation::Smooth };
    let track = |path: &str, keys| Track { path: path.parse().unwrap(), keys };
    scene.animation.timeline = Timeline { frames_per_second: 25.0, start: -1.0, end: 2.5, is_looping: false };
    let rotation = |angle| ParamValue::Rotation(DQuat::from_rotation_x(angle));
    let hold = Keyframe { time: 0.1, value: ParamValue::Scalar(2.0), interpolation: KeyInterpolation::Hold };
    let tracks = [
        track("node.1.transform.rotation", vec![smooth(0.0, rotation(0.3)), smooth(1.0, rotation(0.7))]),
        track("node.1.object.shape.radius", vec![hold, smooth(0.3, ParamValue::Scalar(0.25))]),
        track("material.1.base_color[2]", vec![smooth(0.0, ParamValue::Scalar(1.0))]),
    ];
    scene.set_tracks(tracks).unwrap();
    let text = file::to_json(&scene).unwrap();
    let again = file::parse(text.as_bytes(), "x.json".as_ref()).unwrap();
    assert_eq!(again, scene);
    assert_eq!(file::to_json(&again).unwrap(), text);
    // Without animation a file does not mention it.
    let still = file::to_json(&self::scene()).unwrap();
    assert!(!still.contains("tracks") && !still.contains("timeline"));
    let broken = |from: &str, to: &str| {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text, "{from}");
        file::parse(changed.as_bytes(), "x.json".as_ref()).expect_err(to)
    };
    let error = broken("node.1.object.shape.radius", "node.1.object.shape.size");
    assert_eq!((error.node.as_deref(), error.field.as_deref()), (Some("Ball #1"), Some("tracks[1].path")));
    let error = broken("\"time\": 0.3", "\"time\": 0.1");
    assert_eq!(error.field.as_deref(), Some("tracks[1].keys[1].time"));
    let error = broken("\"value\": 0.25", "\"value\": [1, 2, 3]");
    assert_eq!(error.field.as_deref(), Some("tracks[1].keys[1].value"));
    let error = broken("\"value\": 0.25", "\"value\": \"soon\"");
    assert!(error.reason.contains("must be a number, true or false, three of them, or a quaternion"), "{error}");
    assert_eq!(broken("\"end\": 2.5", "\"end\": -2.5").field.as_deref(), Some("timeline.end"));
    let error = broken("material.1.base_color[2]", "node.1.object.shape.radius");
    assert!(error.reason.contains("another track has the path"), "{error}");
}

#[test]
fn environments_and_materials_drop_the_tracks_of_what_they_lose() {
    let mut scene = scene();
    scene.environment = Environment::sky([0.1; 3], [0.2; 3], [0.3; 3]);
    set(&mut scene, "environment.background.sky", vec![(0.0, ParamValue::Vector(DVec3::ONE))]).unwrap_or_else(|_| {
        let all: Vec<String> = ParamPath::all(&scene).iter().map(|(path, ..)| path.to_string()).collect();
        panic!("{all:?}")
    });
    scene.drop_lost_tracks();
    assert_eq!(scene.animation.tracks().len(), 1);
    scene.insert_material(Material::new(MaterialId(7), "Paint", [0.5; 3])).unwrap();
    set(&mut scene, "material.7.specular_roughness", vec![(0.0, ParamValue::Scalar(0.5))]).unwrap();
    scene.remove_material(MaterialId(7)).unwrap();
    scene.drop_lost_tracks();
    assert_eq!(scene.animation.tracks().len(), 1);
}
