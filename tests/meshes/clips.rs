//! Animation clips: sampled transforms against values computed by hand.

use std::path::Path;

use glam::DVec3;
use isolith::field::{flatten, model_pose};
use isolith::mesh::{ClipTime, MeshError, MeshLibrary, TriangleMesh, parse_posed};
use isolith::scene::{MeshNode, Node, NodeKind, Scene};
use serde_json::{Value, json};

use super::tiny::{FLOAT, Tiny, U8, push, triangle};

fn posed(tiny: &Tiny, name: &str, time: f64) -> Result<TriangleMesh, MeshError> {
    let clip = ClipTime { name: name.into(), time };
    parse_posed(&tiny.gltf(), Path::new("tiny.gltf"), None, Some(&clip))
}

/// The corners of the triangle at this time.
fn corners(tiny: &Tiny, time: f64) -> [DVec3; 3] {
    posed(tiny, "Move", time).unwrap_or_else(|error| panic!("{error}")).corners(0)
}

/// A triangle whose node has a clip with one channel.
fn moving(path: &str, interpolation: &str, times: &[f32], output: impl FnOnce(&mut Tiny) -> usize) -> Tiny {
    let mut tiny = triangle();
    let bytes: Vec<u8> = times.iter().flat_map(|t| t.to_le_bytes()).collect();
    let input = tiny.accessor(&bytes, FLOAT, "SCALAR", times.len());
    let output = output(&mut tiny);
    let sampler = json!({ "input": input, "output": output, "interpolation": interpolation });
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": path } });
    tiny.json["animations"] = json!([{ "name": "Move", "channels": [channel], "samplers": [sampler] }]);
    tiny
}

#[test]
fn keys_are_joined_by_lines_steps_and_splines() {
    let keys = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 4.0, 0.0_f32]];
    let line = moving("translation", "LINEAR", &[0.0, 1.0, 3.0], |tiny| tiny.floats(&keys));
    let step = moving("translation", "STEP", &[0.0, 1.0, 3.0], |tiny| tiny.floats(&keys));
    for (time, on_line, on_step) in [
        (0.0, [0.0, 0.0], [0.0, 0.0]),
        (0.25, [0.5, 0.0], [0.0, 0.0]),
        (1.0, [2.0, 0.0], [2.0, 0.0]),
        (1.5, [2.0, 1.0], [2.0, 0.0]),
        // The end shows the last key; behind it the clip begins again, before it the clip comes from behind.
        (3.0, [2.0, 4.0], [2.0, 4.0]),
        (3.25, [0.5, 0.0], [0.0, 0.0]),
        (-1.5, [2.0, 1.0], [2.0, 0.0]),
    ] {
        for (tiny, [x, y]) in [(&line, on_line), (&step, on_step)] {
            let at = corners(tiny, time)[0];
            assert!((at - DVec3::new(x, y, 0.0)).length() < 1e-6, "{time}: {at}");
        }
    }
    // From (0, 0) to (1, 1) in 2 s, leaving along X by 1 m/s, arriving along Y by 1 m/s.
    let spline = [[9.0, 9.0, 9.0], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [9.0, 9.0, 9.0_f32]];
    let spline = moving("translation", "CUBICSPLINE", &[1.0, 3.0], |tiny| tiny.floats(&spline));
    // At the middle: 1/2 of either value, 1/8 of 2 s times either tangent, the second one negative.
    let at = corners(&spline, 2.0)[0];
    assert!((at - DVec3::new(0.5 + 0.25, 0.5 - 0.25, 0.0)).length() < 1e-6, "{at}");
    // At a quarter: 27/32 and 5/32 of the values, 9/64 and -3/64 of 2 s times the tangents.
    let at = corners(&spline, 1.5)[0];
    assert!((at - DVec3::new(5.0 / 32.0 + 18.0 / 64.0, 5.0 / 32.0 - 6.0 / 64.0, 0.0)).length() < 1e-6, "{at}");
    assert_eq!(corners(&spline, 0.5)[0], DVec3::ZERO, "before the first key it stays there");
}

#[test]
fn nodes_turn_the_shorter_way_and_stretch() {
    // By 90° around Z, written with the opposite sign: half way is 45°.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -half, -half]];
    let tiny = moving("rotation", "LINEAR", &[0.0, 1.0], |tiny| tiny.floats(&turned));
    let at = corners(&tiny, 0.5)[1];
    assert!((at - DVec3::new(1.0, 1.0, 0.0) / 2.0_f64.sqrt()).length() < 1e-6, "{at}");
    let at = corners(&tiny, 1.0 / 3.0)[1];
    assert!((at - DVec3::new(30.0_f64.to_radians().cos(), 0.5, 0.0)).length() < 1e-6, "{at}");
    let tiny = moving("scale", "LINEAR", &[0.0, 1.0], |tiny| tiny.floats(&[[1.0, 1.0, 1.0], [3.0, 5.0, 1.0]]));
    assert_eq!(corners(&tiny, 0.5), [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 3.0]);
    let mesh = posed(&tiny, "Move", 1.0).unwrap();
    assert_eq!((mesh.bounds.min, mesh.bounds.max), (DVec3::ZERO, DVec3::new(3.0, 5.0, 0.0)), "the bounds follow");
}

#[test]
fn morph_targets_and_joints_follow_the_clip() {
    let mut tiny = moving("weights", "LINEAR", &[0.0, 2.0], |tiny| {
        let bytes: Vec<u8> = [0.0, 1.0, 1.0, 0.5_f32].iter().flat_map(|w| w.to_le_bytes()).collect();
        tiny.accessor(&bytes, FLOAT, "SCALAR", 4)
    });
    let [first, second] = [[1.0, 0.0, 0.0], [0.0, 0.0, 2.0]].map(|offset| tiny.floats(&[offset; 3]));
    tiny.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": first }, { "POSITION": second }]);
    assert_eq!(corners(&tiny, 0.0)[0], DVec3::new(0.0, 0.0, 2.0));
    assert_eq!(corners(&tiny, 1.0)[0], DVec3::new(0.5, 0.0, 1.5));
    // A corner each on the root, half on either joint, and on the moving joint.
    let mut tiny = moving("translation", "LINEAR", &[0.0, 1.0], |tiny| tiny.floats(&[[0.0; 3], [0.0, 8.0, 0.0]]));
    let joints = tiny.accessor(&[[0, 1, 0, 0]; 3].concat(), U8, "VEC4", 3);
    let weights = tiny.floats(&[[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]);
    let attributes = &mut tiny.json["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    tiny.json["nodes"][0]["skin"] = json!(0);
    let nodes = tiny.json["nodes"].as_array_mut().unwrap();
    nodes.extend([json!({}), json!({ "translation": [5, 5, 5] })]);
    tiny.json["skins"] = json!([{ "joints": [1, 2] }]);
    tiny.json["animations"][0]["channels"][0]["target"]["node"] = json!(2);
    // The clip replaces the translation of the joint.
    assert_eq!(corners(&tiny, 0.5), [DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0), DVec3::new(0.0, 5.0, 0.0)]);
}

#[test]
fn clips_are_listed_and_wrong_ones_are_named() {
    let mut tiny = moving("translation", "LINEAR", &[0.0, 2.5], |tiny| tiny.floats(&[[0.0; 3], [1.0, 0.0, 0.0]]));
    push(&mut tiny.json["animations"], json!({}));
    let rest = posed(&tiny, "Run", 1.0).unwrap();
    let listed: Vec<_> = rest.clips.iter().map(|clip| (clip.name.as_str(), clip.seconds)).collect();
    assert_eq!(listed, [("Move", 2.5), ("1", 0.0)]);
    assert_eq!(rest.corners(0)[0], DVec3::ZERO);
    assert_eq!(rest.warnings, ["has no clip “Run”, so the model is shown at rest; it has “Move”, “1”"]);
    let by_number = posed(&tiny, "0", 1.25).unwrap();
    assert_eq!((by_number.corners(0)[0], by_number.warnings.len()), (DVec3::X * 0.5, 0));
    let pointer = json!({ "sampler": 0, "target": { "path": "pointer" } });
    push(&mut tiny.json["animations"][0]["channels"], pointer);
    assert!(posed(&tiny, "Move", 1.0).is_ok(), "a channel without a node moves nothing");
}

#[test]
fn a_broken_clip_is_refused_where_it_is_played() {
    type Change = fn(&mut Value);
    let cases: [(Change, &str); 5] = [
        (|json| json["animations"][0]["channels"][0]["sampler"] = json!(7), "channels[0]: names sampler 7"),
        (|json| json["animations"][0]["channels"][0]["target"]["node"] = json!(7), "names node 7"),
        (|json| json["animations"][0]["samplers"][0]["input"] = json!(0), "input"),
        (|json| json["animations"][0]["samplers"][0]["output"] = json!(0), "output: has 3 entries for 2 keys of 1"),
        (|json| json["animations"][0]["samplers"][0]["output"] = json!(99), "output"),
    ];
    for (change, want) in cases {
        let mut tiny = moving("translation", "LINEAR", &[0.0, 1.0], |tiny| tiny.floats(&[[0.0; 3]; 2]));
        change(&mut tiny.json);
        let error = posed(&tiny, "Move", 0.5).unwrap_err().to_string();
        assert!(error.contains(want), "{want}: {error}");
        assert!(posed(&tiny, "Nothing", 0.5).is_ok(), "{want}: the rest pose needs no clip");
    }
    let back = moving("translation", "LINEAR", &[1.0, 0.0], |tiny| tiny.floats(&[[0.0; 3]; 2]));
    assert!(posed(&back, "Move", 0.5).unwrap_err().to_string().contains("times in their order"));
}

#[test]
fn a_node_poses_its_model_at_the_time_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let keys = [[0.0; 3], [10.0, 0.0, 0.0]];
    let tiny = moving("translation", "LINEAR", &[0.0, 10.0], |tiny| tiny.floats(&keys));
    std::fs::write(folder.path().join("walker.glb"), tiny.glb()).unwrap();
    let node = MeshNode { clip: "Move".into(), clip_time: 1.0, clip_speed: 2.0, ..MeshNode::new("walker.glb") };
    let mut scene = Scene::new();
    let id = scene.insert(None, 0, Node::new("walker", NodeKind::Mesh(node.clone()))).unwrap();
    let mut library = MeshLibrary::new(Some(folder.path().into()));
    for (time, x) in [(0.0, 1.0), (1.5, 4.0)] {
        let flat = flatten(&scene, time).unwrap();
        let (meshes, warnings) = flat.load_meshes(&mut library);
        assert!(warnings.is_empty(), "{warnings:?}");
        let at = meshes[0].as_ref().unwrap().corners(0)[0];
        assert!((at - DVec3::X * x).length() < 1e-6, "{time}: {at}");
    }
    // Until a pose is read, the nearest one stands in for it; those that nobody needs are forgotten.
    let [early, late, new] = [0.0, 1.5, 1.4].map(|time| model_pose(&node, time));
    assert!(library.known(&new).is_none());
    let near = library.nearest(&new).unwrap().clone().unwrap();
    assert!((near.corners(0)[0].x - 4.0).abs() < 1e-6);
    library.keep_poses([&late].into_iter());
    assert!(library.known(&early).is_none() && library.known(&late).is_some());
    // A wrong name is reported with the node.
    let wrong = NodeKind::Mesh(MeshNode { clip: "Swim".into(), ..node });
    let other = scene.insert(None, 1, Node::new("swimmer", wrong)).unwrap();
    let (_, warnings) = flatten(&scene, 0.0).unwrap().load_meshes(&mut library);
    assert_eq!((warnings.len(), warnings[0].node), (1, other));
    assert!(other != id && warnings[0].reason.contains("no clip “Swim”"), "{}", warnings[0].reason);
}
