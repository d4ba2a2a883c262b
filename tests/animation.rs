//! Animation: keys made, moved and lost by edits; the same moment is the same scene everywhere; playback builds no
//! pipeline, and flattens and uploads only what moves.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use isolith::document::{Document, Edit};
use isolith::field::{FlatScene, Flattener, GBuffer, flatten};
use isolith::gallery;
use isolith::render::{EvalStrategy, Renderer};
use isolith::scene::{
    CameraNode, Group, KeyInterpolation, Keyframe, Light, MaterialId, Modifier, Node, NodeId, NodeKind, Object,
    ParamPath, ParamValue, Part, Scene, Shape, Timeline, Track, file,
};
use isolith::session::SceneSession;

use crate::gpu::{Shared, shared};
use crate::random_scene::{Random, random_scene};

fn ball() -> Node {
    let shape = Shape::Sphere { radius: 0.4 };
    Node::new("ball", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn radius(id: NodeId) -> ParamPath {
    ParamPath::of_node(id, Part::Shape, "radius")
}

fn position(id: NodeId) -> ParamPath {
    ParamPath::of_node(id, Part::Transform, "translation")
}

fn key(time: f64, value: ParamValue) -> Keyframe {
    Keyframe { time, value, interpolation: KeyInterpolation::Linear }
}

fn along_x(from: f64, to: f64) -> Vec<Keyframe> {
    let at = |x: f64| ParamValue::Vector(DVec3::new(x, 0.0, 0.0));
    vec![key(0.0, at(from)), key(1.0, at(to))]
}

/// A document with one ball whose radius grows from 1 to 2 in a second.
fn growing() -> (Document, NodeId) {
    let mut document = Document::new(Scene::new());
    let id = document.apply(Edit::Insert { parent: None, position: 0, node: ball() }).expect("room")[0];
    let keys = [1.0, 2.0].map(|value| (radius(id), key(value - 1.0, ParamValue::Scalar(value))));
    document.apply(Edit::SetKeys(keys.into())).expect("keys of a radius");
    (document, id)
}

fn value(document: &Document, path: &ParamPath) -> ParamValue {
    path.get(document.scene()).expect("a parameter")
}

fn times(document: &Document, path: &ParamPath) -> Vec<f64> {
    let track = document.scene().animation.track(path);
    track.map_or(Vec::new(), |track| track.keys.iter().map(|key| key.time).collect())
}

#[test]
fn a_change_of_an_animated_parameter_sets_a_key_at_the_moment_that_is_shown() {
    let (mut document, id) = growing();
    let resting = radius(id).get(document.resting()).expect("a radius");
    document.set_time(0.5);
    assert_eq!(value(&document, &radius(id)), ParamValue::Scalar(1.5));
    let steps = document.undo_labels().count();
    // A drag is one step, and one key.
    document.begin_gesture();
    for step in 1..=5 {
        let value = ParamValue::Scalar(1.5 + f64::from(step));
        document.apply(Edit::SetParam { path: radius(id), value }).expect("within the limits");
    }
    document.end_gesture();
    assert_eq!(times(&document, &radius(id)), [0.0, 0.5, 1.0]);
    assert_eq!(value(&document, &radius(id)), ParamValue::Scalar(6.5));
    assert_eq!(radius(id).get(document.resting()).expect("a radius"), resting, "the resting value stays");
    assert_eq!(document.undo_labels().count(), steps + 1);
    // Other parameters of the node change at rest, and leave the animated one alone.
    let mut node = Node::clone(document.scene().node(id).expect("the ball"));
    node.name = "moon".into();
    node.transform.translation.x = 7.0;
    document.apply(Edit::Replace(node)).expect("within the limits");
    let node = document.resting().node(id).expect("the ball");
    assert_eq!((&*node.name, node.transform.translation.x), ("moon", 7.0));
    assert_eq!(radius(id).get_in(node), Some(resting));
    assert_eq!(times(&document, &radius(id)), [0.0, 0.5, 1.0]);
    document.undo();
    document.undo();
    assert_eq!(
        (times(&document, &radius(id)), value(&document, &radius(id))),
        (vec![0.0, 1.0], ParamValue::Scalar(1.5))
    );
    // A value beyond its limits changes nothing.
    let before = document.snapshot();
    assert!(document.apply(Edit::SetParam { path: radius(id), value: ParamValue::Scalar(-1.0) }).is_err());
    assert_eq!(document.snapshot(), before);
}

#[test]
fn files_hold_the_scene_at_rest_whatever_is_shown() {
    let (mut document, _) = growing();
    let text = file::to_json(document.resting()).expect("a sound scene");
    let revision = document.revision();
    document.set_time(0.7);
    assert_eq!(document.revision(), revision, "another moment is no change");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("growing.json");
    document.save_as(&path).expect("a folder to write to");
    assert_eq!(std::fs::read_to_string(&path).expect("saved"), text);
    assert_eq!(Document::open(&path).expect("a sound file").resting(), document.resting());
}

#[test]
fn keys_follow_their_parameters_through_edits_and_come_back_by_undo() {
    let (mut document, id) = growing();
    let before = document.snapshot();
    let copies = document.apply(Edit::Duplicate(vec![id])).expect("room");
    assert_eq!(times(&document, &radius(copies[0])), [0.0, 1.0]);
    document.apply(Edit::Remove(vec![id])).expect("it is there");
    assert_eq!(document.scene().animation.tracks().len(), 1);
    document.undo();
    document.undo();
    assert_eq!(document.snapshot(), before);
    // A parameter that is gone takes its keys along.
    let mut node = Node::clone(document.scene().node(id).expect("the ball"));
    node.kind = NodeKind::Object(Object { shape: Shape::Plane {}, material: MaterialId(1) });
    document.apply(Edit::Replace(node)).expect("another shape");
    assert!(document.scene().animation.is_empty());
    document.undo();
    assert_eq!(document.snapshot(), before);
    // A modifier keeps its keys when another one before it goes.
    let mut node = Node::clone(document.scene().node(id).expect("the ball"));
    node.modifiers = [0.1, 0.2].map(|radius| Modifier::Round { radius }.into()).into();
    document.apply(Edit::Replace(node.clone())).expect("two modifiers");
    let round = |place| ParamPath::of_node(id, Part::Modifier(place), "radius");
    document.apply(Edit::SetKeys(vec![(round(1), key(0.0, ParamValue::Scalar(0.3)))])).expect("a key");
    let mut node = Node::clone(document.scene().node(id).expect("the ball"));
    node.modifiers.remove(0);
    document.apply(Edit::Replace(node)).expect("one modifier");
    assert_eq!(times(&document, &round(0)), [0.0]);
    assert_eq!(value(&document, &round(0)), ParamValue::Scalar(0.3));
}

#[test]
fn keys_are_set_replaced_moved_and_removed() {
    let (mut document, id) = growing();
    // At its moment, a key replaces the one that is there.
    document.apply(Edit::SetKeys(vec![(radius(id), key(1.0 + 1e-9, ParamValue::Scalar(5.0)))])).expect("a key");
    assert_eq!(times(&document, &radius(id)).len(), 2);
    let mut track = Track::clone(document.scene().animation.track(&radius(id)).expect("a track"));
    track.keys[1].time = 3.0;
    document.apply(Edit::SetTracks(vec![track.clone()])).expect("a later key");
    assert_eq!(times(&document, &radius(id)), [0.0, 3.0]);
    let steps = document.undo_labels().count();
    document.apply(Edit::SetTracks(vec![track])).expect("the same again");
    assert_eq!(document.undo_labels().count(), steps, "nothing changed, so nothing to undo");
    document.apply(Edit::RemoveKeys(vec![(radius(id), 0.0)])).expect("it is there");
    assert_eq!(times(&document, &radius(id)), [3.0]);
    // The last key leaves its value.
    document.apply(Edit::RemoveKeys(vec![(radius(id), 3.0)])).expect("it is there");
    assert!(document.scene().animation.is_empty());
    assert_eq!(value(&document, &radius(id)), ParamValue::Scalar(5.0));
    for (path, keys) in
        [("node.1.visible", ParamValue::Flag(true)), ("node.1.object.shape.radius", ParamValue::Flag(true))]
    {
        let path = path.parse().expect("a path");
        assert!(document.apply(Edit::SetKeys(vec![(path, key(0.0, keys))])).is_err());
    }
    let backward = Timeline { start: 2.0, end: 1.0, ..Timeline::default() };
    assert!(document.apply(Edit::SetTimeline(backward)).is_err());
    document.apply(Edit::SetTimeline(Timeline { end: 2.0, ..Timeline::default() })).expect("a timeline");
    assert!(document.undo());
}

#[test]
fn a_moved_node_stays_where_it_is_seen() {
    let mut document = Document::new(Scene::new());
    let group = Node::new("rig", NodeKind::Group(Group::UNION));
    let rig = document.apply(Edit::Insert { parent: None, position: 0, node: group }).expect("room")[0];
    let still = document.apply(Edit::Insert { parent: None, position: 1, node: ball() }).expect("room")[0];
    let keys = along_x(0.0, 4.0).into_iter().map(|key| (position(rig), key)).collect();
    document.apply(Edit::SetKeys(keys)).expect("keys");
    document.set_time(0.5);
    let before = document.scene().world_from_local(still);
    document.apply(Edit::Move { ids: vec![still], parent: Some(rig), position: 0 }).expect("into the group");
    assert_eq!(document.scene().world_from_local(still), before);
    document.set_time(1.0);
    assert_eq!(document.scene().world_from_local(still).translation.x, 2.0);
}

/// A scene in which everything that can move does: balls, a light, a camera, a material, exposure.
fn moving() -> Scene {
    let mut scene = Scene::new();
    let mut ids = Vec::new();
    for i in 0..16 {
        ids.push(scene.insert(None, usize::MAX, ball().at([f64::from(i), 0.0, 0.0].into())).expect("room"));
    }
    let light = scene.insert(None, usize::MAX, Node::new("lamp", NodeKind::Light(Light::default()))).expect("room");
    let eye = Node::new("eye", NodeKind::Camera(CameraNode::default()));
    let eye = scene.insert(None, usize::MAX, eye).expect("room");
    let track = |path: ParamPath, keys| Track { path, keys };
    let turned = |angle: f64| ParamValue::Rotation(DQuat::from_rotation_y(angle));
    scene
        .set_tracks([
            track(position(ids[0]), along_x(0.0, 0.5)),
            track(position(light), along_x(0.0, 1.0)),
            track(position(eye), along_x(0.0, 1.0)),
            track(
                ParamPath::of_node(ids[1], Part::Transform, "rotation"),
                vec![key(0.0, turned(0.0)), key(1.0, turned(1.0))],
            ),
            track(
                "material.1.base_color[0]".parse().expect("a path"),
                vec![key(0.0, ParamValue::Scalar(0.0)), key(1.0, ParamValue::Scalar(1.0))],
            ),
            track(
                "display.exposure".parse().expect("a path"),
                vec![key(0.0, ParamValue::Scalar(0.0)), key(1.0, ParamValue::Scalar(1.0))],
            ),
        ])
        .expect("sound tracks");
    scene
}

#[test]
fn a_step_in_time_gives_the_same_arrays_as_a_fresh_start() {
    let mut scenes: Vec<(&str, Scene)> = vec![("moving", moving())];
    // The pedestals of all shapes are batched, and batches stay as they were.
    for (name, mut scene) in gallery::all().into_iter().filter(|(name, _)| *name != "shapes") {
        let nodes = scene.nodes().iter().step_by(scene.nodes().len() / 6 + 1);
        let track = |node: &Arc<Node>| Track {
            path: position(node.id),
            keys: [0.0, 1.0].map(|time| key(time, ParamValue::Vector(node.transform.translation + 0.01 * time))).into(),
        };
        let tracks: Vec<Track> = nodes.map(track).collect();
        scene.set_tracks(tracks).expect("sound tracks");
        scenes.push((name, scene));
    }
    for (name, scene) in scenes {
        let mut flattener = Flattener::default();
        for time in [0.0, 0.25, 0.5, 1.0, 0.0, -3.0] {
            let again = flattener.flatten(&scene, time).expect("within the limits");
            assert_eq!(*again, flatten(&scene, time).expect("within the limits"), "{name} at {time}");
        }
    }
}

/// Sets keys of a random parameter at random moments.
fn animate(random: &mut Random, scene: &mut Scene) {
    let all = ParamPath::all(scene);
    let (path, param, value) = &all[random.below(all.len())];
    let ParamValue::Scalar(_) = value else { return };
    if !param.animatable {
        return;
    }
    let keys = (0..1 + random.below(4)).map(|i| Keyframe {
        time: i as f64 + random.unit() * 0.5,
        value: ParamValue::Scalar(random.number(&param.limits)),
        interpolation: random.pick(&KeyInterpolation::ALL),
    });
    let track = Track { path: path.clone(), keys: keys.collect() };
    scene.set_tracks([track]).expect("random values keep the limits");
}

/// A random edit of what is seen.
fn edit(random: &mut Random, scene: &Scene) -> Option<Edit> {
    let node = &scene.nodes()[random.below(scene.nodes().len().max(1)).min(scene.nodes().len().checked_sub(1)?)];
    let mut new = Node::clone(node);
    Some(match random.below(8) {
        0 => Edit::Remove(vec![node.id]),
        1 => Edit::Duplicate(vec![node.id]),
        2 => {
            new.transform = random.transform();
            Edit::Replace(new)
        }
        3 if !new.modifiers.is_empty() => {
            new.modifiers.remove(random.below(new.modifiers.len()));
            Edit::Replace(new)
        }
        4 if !new.modifiers.is_empty() => {
            let at = random.below(new.modifiers.len());
            new.modifiers.rotate_left(at);
            Edit::Replace(new)
        }
        5 => {
            let parents: Vec<_> = scene.nodes().iter().filter(|node| node.has_children()).map(|node| node.id).collect();
            let parent = (!parents.is_empty()).then(|| parents[random.below(parents.len())]);
            Edit::Move { ids: vec![node.id], parent, position: random.below(3) }
        }
        6 => Edit::SetDisplay(random.display()),
        _ => {
            let all = ParamPath::all(scene);
            let (path, param, value) = &all[random.below(all.len())];
            let ParamValue::Scalar(_) = value else { return None };
            Edit::SetParam { path: path.clone(), value: ParamValue::Scalar(random.number(&param.limits)) }
        }
    })
}

#[test]
fn random_edits_at_random_moments_keep_every_track_sound_and_are_undone() {
    let (mut keyed, mut dropped) = (0, 0);
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let mut scene = random_scene(seed, 24);
        for _ in 0..40 {
            animate(&mut random, &mut scene);
        }
        let mut document = Document::new(scene);
        let start = Arc::clone(document.resting());
        for _ in 0..90 {
            document.set_time(random.unit() * 5.0 - 0.5);
            let before = (document.resting().animation.key_count(), document.resting().animation.tracks().len());
            let Some(edit) = edit(&mut random, document.scene()) else { continue };
            let seen = document.snapshot();
            if document.apply(edit).is_err() {
                assert_eq!(document.snapshot(), seen, "a refused edit changes nothing");
                continue;
            }
            let scene = document.resting();
            scene.assert_invariants();
            file::to_json(scene).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            document.scene().assert_invariants();
            let after = (scene.animation.key_count(), scene.animation.tracks().len());
            keyed += usize::from(after.0 > before.0 && after.1 == before.1);
            dropped += usize::from(after.1 < before.1);
        }
        while document.undo() {}
        assert_eq!(**document.resting(), *start, "seed {seed}");
    }
    assert!(keyed > 5 && dropped > 5, "{keyed} edits set keys, {dropped} took tracks along");
}

fn picture(renderer: &mut Renderer, flat: &FlatScene) -> GBuffer {
    let camera = isolith::geometry::Camera::looking_at(DVec3::new(1.0, 1.0, 5.0), DVec3::X, 0.8);
    let flat = Arc::new(flat.clone());
    renderer.render(&flat, &[], &camera, [64, 64], &mut |_| true).expect("a picture").0
}

#[test]
fn playback_builds_no_pipeline_and_uploads_only_what_moves() {
    let Shared { gpu, renderer } = &mut *shared();
    renderer.set_strategy(EvalStrategy::StraightLine);
    let mut document = Document::new(moving());
    let mut session = SceneSession::default();
    session.follow(&document);
    let mut last = picture(renderer, session.flat());
    let (built, mut uploaded) = (renderer.pipelines().built(), renderer.uploaded());
    for frame in 1..=12 {
        document.set_time(f64::from(frame) / 24.0);
        assert!(session.follow(&document), "frame {frame} is new");
        let next = picture(renderer, session.flat());
        assert_ne!(next.color, last.color, "frame {frame} shows nothing new");
        let bytes = renderer.uploaded() - uploaded;
        assert!(bytes > 0 && bytes <= MOST_BYTES, "frame {frame} uploaded {bytes} bytes");
        (last, uploaded) = (next, renderer.uploaded());
        assert!(!session.follow(&document), "a moment that stays costs nothing");
    }
    assert_eq!(renderer.pipelines().built(), built, "playback built a pipeline");
    // The same moment is the same picture, without the history of the playback.
    let mut fresh = Renderer::new(gpu).expect("a renderer");
    fresh.set_strategy(EvalStrategy::StraightLine);
    assert_eq!(picture(&mut fresh, &flatten(document.resting(), 0.5).expect("within the limits")), last);
}

/// Upload limit for a frame of a dozen instancers, or of two hundred places.
const MOST_BYTES_OF_COPIES: u64 = 32_768;

/// Copies that move by themselves, and copies on a sea that runs: each moment shows something new, is that of a fresh
/// start, and compiles nothing.
#[test]
fn copies_play_without_a_new_pipeline() {
    let renderer = &mut shared().renderer;
    renderer.set_strategy(EvalStrategy::Tape);
    for name in ["dynamics-2d", "ocean"] {
        let scene = gallery::all().into_iter().find(|(other, _)| *other == name).expect("it is shipped").1;
        let mut document = Document::new(scene);
        let mut session = SceneSession::default();
        session.follow(&document);
        let mut last = picture(renderer, session.flat());
        let (built, mut uploaded) = (renderer.pipelines().built(), renderer.uploaded());
        for frame in 1..=4 {
            let time = f64::from(frame) / 8.0;
            document.set_time(time);
            assert!(session.follow(&document), "{name}, frame {frame} is new");
            assert_eq!(**session.flat(), flatten(document.resting(), time).expect("within the limits"), "{name}");
            let next = picture(renderer, session.flat());
            assert_ne!(next.color, last.color, "{name}, frame {frame} shows nothing new");
            let bytes = renderer.uploaded() - uploaded;
            assert!(bytes <= MOST_BYTES_OF_COPIES, "{name}, frame {frame} uploaded {bytes} bytes");
            (last, uploaded) = (next, renderer.uploaded());
        }
        assert_eq!(renderer.pipelines().built(), built, "{name}: playback built a pipeline");
    }
}

/// Upload limit for a frame in which two balls and a material change.
const MOST_BYTES: u64 = 1024;
