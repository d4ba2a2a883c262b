//! Scene files: written files read back byte for byte, and no input crashes the reader.

use std::path::Path;

use isolith::scene::{Blend, BlendKernel, BlendOverride, Group, NodeId, NodeKind, Operator, RadiusUnit, Scene, file};

use crate::random_scene::{Random, random_scene};

/// Random documents whose text must survive reading and writing.
const ROUND_TRIPS: u64 = 10_000;
/// Number of scenes with a few bytes changed. The reader reads or refuses each and never panics.
const MUTATIONS: u64 = 1_000;

fn read(text: &[u8]) -> Result<Scene, file::FileError> {
    file::parse(text, Path::new("scene.json"))
}

#[test]
fn random_documents_round_trip_byte_for_byte() {
    let work = |part: u64| {
        for seed in (part..ROUND_TRIPS).step_by(2) {
            let scene = random_scene(seed, (seed % 24) as usize);
            let text = file::to_json(&scene).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
            let again = read(text.as_bytes()).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
            assert_eq!(again, scene, "seed {seed}");
            again.assert_invariants();
            assert_eq!(file::to_json(&again).as_ref(), Ok(&text), "seed {seed}");
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| work(0));
        work(1);
    });
}

#[test]
fn mutated_scenes_never_panic() {
    let mut refused = 0;
    for seed in 0..MUTATIONS {
        let mut random = Random::new(seed ^ 0xfeed);
        let text = file::to_json(&random_scene(seed, 1 + (seed % 16) as usize)).expect("random scenes are valid");
        let mut bytes = text.into_bytes();
        for _ in 0..=random.below(6) {
            let at = random.below(bytes.len());
            match random.below(5) {
                0 => bytes[at] = random.bits() as u8,
                1 => bytes[at] = random.pick(b"{}[],:\"0123456789-+.eE\\nul \n"),
                2 => drop(bytes.drain(at..(at + 1 + random.below(40)).min(bytes.len()))),
                3 => {
                    let from = random.below(bytes.len());
                    let piece = bytes[from..(from + random.below(200)).min(bytes.len())].to_vec();
                    bytes.splice(at..at, piece);
                }
                _ => bytes.truncate(bytes.len() - random.below(8).min(bytes.len() - 1)),
            }
        }
        match read(&bytes) {
            Ok(scene) => {
                scene.assert_invariants();
                let text = file::to_json(&scene).expect("what was read can be written");
                assert_eq!(read(text.as_bytes()).as_ref(), Ok(&scene), "seed {seed}");
            }
            Err(error) => {
                refused += 1;
                assert!(error.file == "scene.json" && !error.reason.is_empty(), "{error}");
                assert!(error.reason.len() < 1_000, "{error}");
            }
        }
    }
    assert!(refused > MUTATIONS / 2, "only {refused} of the mutations were noticed");
}

#[test]
fn a_changed_value_is_one_changed_line() {
    let scene = random_scene(3, 20);
    let mut changed = scene.clone();
    let mut node = (**scene.nodes().last().expect("has nodes")).clone();
    node.transform.translation = glam::DVec3::new(0.25, 1.0, -1e-7);
    changed.replace(node.clone()).expect("the node is there");
    node.transform.translation.y += 1.0;
    let mut again = changed.clone();
    again.replace(node).expect("the node is there");
    let (a, b) = (file::to_json(&changed).expect("valid"), file::to_json(&again).expect("valid"));
    assert_eq!(a.lines().count(), b.lines().count());
    let differing: Vec<&str> =
        a.lines().zip(b.lines()).filter(|(a, b)| a != b).map(|(_, b)| b.trim().trim_end_matches(',')).collect();
    assert_eq!(differing, ["\"translation\": [0.25, 2.0, -1e-7]"]);
}

/// Later additions to the format are optional: an older file reads as before.
#[test]
fn files_of_the_first_program_mean_what_they_meant() {
    let text = r#"{"isolith": 1, "nodes": [
        {"id": 1, "group": {"operator": "difference", "blend": {"kernel": "cubic", "radius": 0.25}}},
        {"id": 2, "parent": 1, "negative": true, "group": {"operator": "union", "blend": {"kernel": "circular", "radius": 0}}}
    ]}"#;
    let scene = read(text.as_bytes()).expect("the first version");
    let node = scene.node(NodeId(1)).expect("is there");
    let group = Group::new(Operator::Difference, Blend::new(BlendKernel::Cubic, 0.25));
    assert_eq!(
        (&node.kind, node.blend_override, node.apart.len()),
        (&NodeKind::Group(group), BlendOverride::Inherit, 0)
    );
    let written = file::to_json(&scene).expect("valid");
    let added = ["unit", "steps", "width", "depth", "share", "joining", "apart"];
    assert!(added.iter().all(|name| !written.contains(&format!("{name:?}:"))), "{written}");
}

#[test]
fn blends_are_written_by_name() {
    let text = r#"{"isolith": 1, "nodes": [
        {"id": 1, "group": {"operator": "engrave", "blend": {"kernel": "stairs", "radius": 0.5, "unit": "size", "steps": 3}, "depth": 0.2}},
        {"id": 2, "parent": 1, "joining": "hard", "apart": [3], "camera": {"fov_y": 40, "near": 0.1, "far": 10}},
        {"id": 3, "parent": 1, "joining": {"radius": 0.1}, "camera": {"fov_y": 40, "near": 0.1, "far": 10}}
    ]}"#;
    let scene = read(text.as_bytes()).expect("valid");
    let blend = Blend { unit: RadiusUnit::Size, steps: 3, ..Blend::new(BlendKernel::Stairs, 0.5) };
    let group = Group { depth: 0.2, ..Group::new(Operator::Engrave, blend) };
    assert_eq!(scene.nodes()[0].kind, NodeKind::Group(group));
    assert_eq!((scene.nodes()[1].blend_override, &scene.nodes()[1].apart[..]), (BlendOverride::Hard, &[NodeId(3)][..]));
    assert_eq!(scene.nodes()[2].blend_override, BlendOverride::Radius(0.1));
}

#[test]
fn the_former_name_of_the_smooth_chamfer_is_read_and_not_written() {
    let text = r#"{"isolith": 1, "nodes": [
        {"id": 1, "group": {"operator": "union", "blend": {"kernel": "lean", "radius": 0.5}}}
    ]}"#;
    let scene = read(text.as_bytes()).expect("valid");
    let group = Group::new(Operator::Union, Blend::new(BlendKernel::SmoothChamfer, 0.5));
    assert_eq!(scene.nodes()[0].kind, NodeKind::Group(group));
    let written = file::to_json(&scene).expect("valid");
    assert!(written.contains(r#""kernel": "smooth_chamfer""#) && !written.contains("lean"), "{written}");
}

#[test]
fn children_before_their_parents_are_put_in_order() {
    let text = r#"{"isolith": 1, "nodes": [
        {"id": 5, "parent": 2, "name": "c", "camera": {"fov_y": 40, "near": 0.1, "far": 10}},
        {"id": 3, "name": "z", "group": {"operator": "union", "blend": {"kernel": "cubic", "radius": 0}}},
        {"id": 2, "parent": 1, "name": "b", "group": {"operator": "union", "blend": {"kernel": "cubic", "radius": 0}}},
        {"id": 4, "parent": 1, "name": "d", "light": {"color": [1, 1, 1], "intensity": 1, "light": {"type": "directional"}}},
        {"id": 1, "name": "a", "group": {"operator": "union", "blend": {"kernel": "cubic", "radius": 0}}}
    ]}"#;
    let scene = read(text.as_bytes()).expect("a forest");
    scene.assert_invariants();
    let order: Vec<&str> = scene.nodes().iter().map(|n| n.name.as_str()).collect();
    assert_eq!(order, ["z", "a", "b", "c", "d"]);
    assert_eq!(scene.next_id(), 6);
}

#[test]
fn deep_and_wide_scenes_are_read_without_recursion() {
    use isolith::scene::{Group, Material, MaterialId, Node, NodeId, NodeKind, limits};
    let deep = |depth: u64| -> Vec<Node> {
        let group = |i| Node {
            id: NodeId(i),
            parent: (i > 1).then(|| NodeId(i - 1)),
            ..Node::new("g", NodeKind::Group(Group::UNION))
        };
        (1..=depth).map(group).collect()
    };
    let clay = || vec![Material::new(MaterialId(1), "Clay", [0.5; 3])];
    let most = limits::MAX_DEPTH as u64;
    let scene = Scene::from_tables(deep(most), clay(), Default::default(), 1).expect("as deep as allowed");
    let text = file::to_json(&scene).expect("valid");
    assert_eq!(read(text.as_bytes()), Ok(scene));
    let camera = r#""camera": {"fov_y": 40, "near": 1, "far": 2}"#;
    let one_more = format!("}},\n{{\"id\": {}, \"parent\": {most}, \"name\": \"low\", {camera}}}\n]\n}}", most + 1);
    let too_deep = text.strip_suffix("}\n  ]\n}\n").expect("ends with the last node").to_owned() + &one_more;
    let error = read(too_deep.as_bytes()).expect_err("too deep");
    assert_eq!(error.node.as_deref(), Some(format!("low #{}", most + 1).as_str()), "{error}");
    assert!(error.reason.contains("deeper than 1024"), "{error}");
}

#[test]
fn rotations_that_are_nearly_unit_are_settled_once() {
    let text = |q: &str| {
        format!(
            "{{\"isolith\": 1, \"nodes\": [{{\"id\": 1, \"transform\": {{\"rotation\": {q}}}, \
             \"camera\": {{\"fov_y\": 40, \"near\": 1, \"far\": 2}}}}]}}"
        )
    };
    let scene = read(text("[0.0, 0.0, 0.6, 0.8003]").as_bytes()).expect("nearly unit");
    let rotation = scene.nodes()[0].transform.rotation;
    assert!((rotation.length() - 1.0).abs() < 1e-15 && (rotation.w - 0.8003).abs() > 1e-5, "{rotation}");
    let once = file::to_json(&scene).expect("valid");
    assert_eq!(file::to_json(&read(once.as_bytes()).expect("valid")), Ok(once));
}

#[test]
fn the_schema_describes_the_format() {
    let schema = file::schema();
    assert_eq!(schema["properties"]["isolith"]["const"], 2);
    assert_eq!(schema["additionalProperties"], false);
    let node = &schema["$defs"]["NodeFile"];
    assert_eq!(node["additionalProperties"], false);
    assert_eq!(node["oneOf"].as_array().map(Vec::len), Some(6));
    // The schema describes every written file.
    let written = file::to_json(&random_scene(4, 40)).expect("valid");
    let written: serde_json::Value = serde_json::from_str(&written).expect("JSON");
    for entry in written["nodes"].as_array().expect("a list") {
        for key in entry.as_object().expect("an object").keys() {
            assert!(node["properties"].get(key).is_some(), "{key}");
        }
    }
    let text = schema.to_string();
    for word in ["hexagonal_prism", "quadratic", "next_id", "fov_y", "attenuation", "rotation"] {
        assert!(text.contains(word), "{word}");
    }
}

#[test]
fn what_could_not_be_read_is_not_written() {
    use isolith::scene::{Group, Node, NodeKind};
    let mut scene = Scene::new();
    let node = Node::new("Far", NodeKind::Group(Group::UNION)).at(glam::DVec3::new(0.0, f64::NAN, 0.0));
    scene.insert(None, 0, node).expect("the table does not look at values");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    let error = file::save(&scene, &path).expect_err("not a number");
    assert_eq!(error.node.as_deref(), Some("Far #1"));
    assert_eq!(error.field.as_deref(), Some("nodes[0].transform.translation[1]"));
    assert!(!path.exists() && error.file.ends_with("scene.json"), "{error}");
}
