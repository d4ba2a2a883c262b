//! Positions of vertices: distant nodes, rounded matrices, skins, morph targets, shared vertices.

use std::path::Path;

use glam::DVec3;
use isolith::geometry::Ray;
use isolith::mesh::{TriangleMesh, parse};
use serde_json::{Value, json};

use super::tiny::{FLOAT, Tiny, U8, triangle};

fn read(tiny: &Tiny) -> TriangleMesh {
    parse(&tiny.gltf(), Path::new("tiny.gltf"), None).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(tiny: &Tiny, place: &str, reason: &str) {
    let error = parse(&tiny.gltf(), Path::new("tiny.gltf"), None).expect_err(reason);
    assert!(error.place == place && error.reason.contains(reason), "{error}");
}

#[track_caller]
fn close(have: DVec3, want: [f64; 3], tolerance: f64) {
    assert!((have - DVec3::from(want)).length() <= tolerance, "{have} is not {want:?}");
}

#[test]
fn the_last_number_of_a_matrix_scales_everything() {
    let matrix = |last: f64| json!([2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 4, 0, 0, last]);
    for (last, x) in [(1.0, 6.0), (0.999_999_9, 6.000_000_6), (2.0, 3.0)] {
        let mut tiny = triangle();
        tiny.json["nodes"] = json!([{ "mesh": 0, "matrix": matrix(last) }]);
        close(read(&tiny).corners(0)[1], [x, 0.0, 0.0], 1e-6);
    }
    let mut tiny = triangle();
    // Rounded by an exporter that uses f32.
    tiny.json["nodes"][0]["matrix"] = json!([1, 0, 0, 1e-8, 0, 1, 0, -3e-8, 0, 0, 1, 0, 5, 0, 0, 1]);
    close(read(&tiny).corners(0)[0], [5.0, 0.0, 0.0], 1e-9);
}

/// Two triangles of 1 m far from the origin and from each other, and one at the origin.
#[test]
fn triangles_keep_their_shape_wherever_they_stand() {
    let places = [[500_000.3, 12.0, 4_649_776.7], [-9e8, 3e8, 0.1], [0.25, 0.0, 0.0]];
    let mut tiny = triangle();
    let nodes: Vec<_> = places.iter().map(|place| json!({ "mesh": 0, "translation": place })).collect();
    tiny.json["nodes"] = json!(nodes);
    tiny.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let mesh = read(&tiny);
    assert_eq!(mesh.parts.len(), 3);
    for (i, place) in places.into_iter().enumerate() {
        let place = DVec3::from(place);
        let [a, b, c] = mesh.corners(i as u32);
        // The remaining error is the rounding of the position itself in f64.
        let rounding = place.abs().max_element() * 1e-15 + 1e-7;
        assert!((b - a - DVec3::X).length() < rounding && (c - a - DVec3::Y).length() < rounding, "{i}: {a} {b} {c}");
        assert!((a - place).length() < rounding);
        let ray = Ray { origin: place + DVec3::new(0.2, 0.3, 5.0), direction: DVec3::NEG_Z };
        let hit = mesh.hit(&ray, 10.0).unwrap();
        assert!(hit.triangle == i as u32 && (hit.t - 5.0).abs() < 1e-6, "{i}: {hit:?}");
        assert!((hit.weights[1] - 0.2).abs() < 1e-6 && (hit.weights[2] - 0.3).abs() < 1e-6, "{i}: {hit:?}");
    }
    let size = mesh.bounds.max - mesh.bounds.min;
    assert!(size.x > 9e8 && size.y > 2e8);
}

#[test]
fn a_node_that_undoes_what_its_parent_does_leaves_the_origin_alone() {
    let mut tiny = triangle();
    tiny.json["nodes"] = json!([
        { "translation": [500_000.3, 0, 4_649_776.7], "children": [1] },
        { "translation": [-500_000.3, 0, -4_649_776.7], "mesh": 0 },
    ]);
    let mesh = read(&tiny);
    assert_eq!(mesh.parts[0].origin, DVec3::ZERO);
    close(mesh.corners(0)[1], [1.0, 0.0, 0.0], 1e-9);
}

/// A triangle with two joints and these weights at its corners.
fn skinned(weights: [[f32; 4]; 3]) -> Tiny {
    let mut tiny = triangle();
    let joints = tiny.accessor(&[0, 1, 99, 99].repeat(3), U8, "VEC4", 3);
    let weights = tiny.floats(&weights);
    let matrix = |x: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, 0.0, 0.0, 1.0];
    let bytes: Vec<u8> = [matrix(0.0), matrix(-1.0)].iter().flatten().flat_map(|v: &f32| v.to_le_bytes()).collect();
    let inverse = tiny.accessor(&bytes, FLOAT, "MAT4", 2);
    let attributes = &mut tiny.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    tiny.json["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": inverse }]);
    tiny.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [100, 100, 100] },
        { "translation": [0, 0, 7], "children": [2] },
        { "translation": [1, 4, 0] },
    ]);
    tiny
}

#[test]
fn vertices_follow_the_joints_by_their_weights() {
    let half = [0.5, 0.5, 0.0, 0.0];
    let mesh = read(&skinned([[1.0, 0.0, 0.0, 0.0], half, half]));
    // The joints move by (0, 0, 7) and (0, 4, 7); the mesh's own node has no effect.
    let want = [[0.0, 0.0, 7.0], [1.0, 2.0, 7.0], [0.0, 3.0, 7.0]];
    for (have, want) in mesh.corners(0).into_iter().zip(want) {
        close(have, want, 1e-6);
    }
    // Weights that do not sum to 1 are normalized; without weights the first joint applies.
    let mesh = read(&skinned([[0.1, 0.1, 0.0, 0.0], [0.0, 0.3, 0.0, 0.0], [0.0; 4]]));
    let want = [[0.0, 2.0, 7.0], [1.0, 4.0, 7.0], [0.0, 1.0, 7.0]];
    for (have, want) in mesh.corners(0).into_iter().zip(want) {
        close(have, want, 1e-6);
    }
}

#[test]
fn skins_that_are_broken_are_refused() {
    let primitive = "meshes[0].primitives[0].attributes";
    let good = || skinned([[1.0, 0.0, 0.0, 0.0]; 3]);
    read(&good());
    refused(&skinned([[0.0, 0.0, 1.0, 0.0]; 3]), &format!("{primitive}.JOINTS_0"), "joint that is missing at vertex 0");
    refused(&skinned([[-1.0, 0.0, 0.0, 0.0]; 3]), &format!("{primitive}.WEIGHTS_0"), "no share at vertex 0");
    refused(&skinned([[f32::NAN, 0.0, 0.0, 0.0]; 3]), &format!("{primitive}.WEIGHTS_0"), "no share");
    let broken = |pointer: &str, value: Value, place: &str, reason: &str| {
        let mut tiny = good();
        *tiny.json.pointer_mut(pointer).unwrap() = value;
        refused(&tiny, place, reason);
    };
    broken("/skins/0/joints", json!([1, 9]), "skins[0].joints[1]", "node 9, which is missing");
    broken("/skins/0/joints", json!([]), "skins[0].joints", "0 entries");
    broken("/skins/0/joints", json!([1, 2, 0]), "skins[0].inverseBindMatrices", "2 entries for 3 joints");
    broken("/skins/0/inverseBindMatrices", json!(0), "skins[0].inverseBindMatrices", "matrices");
    broken("/nodes/0/skin", json!(5), "nodes[0].skin", "skin 5, which is missing");
}

#[test]
fn morph_targets_are_applied_by_their_weights_at_rest() {
    let mut tiny = triangle();
    let targets = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|offset| json!({ "POSITION": tiny.floats(&[offset; 3]) }));
    tiny.json["meshes"][0]["primitives"][0]["targets"] = json!(targets);
    close(read(&tiny).corners(0)[0], [0.0; 3], 0.0);
    tiny.json["meshes"][0]["weights"] = json!([0.5, 2]);
    close(read(&tiny).corners(0)[0], [0.5, 2.0, 0.0], 0.0);
    // Weights of the node override those of the mesh; missing ones are 0.
    tiny.json["nodes"][0]["weights"] = json!([-1]);
    close(read(&tiny).corners(0)[0], [-1.0, 0.0, 0.0], 0.0);
    // A target without data has no effect.
    tiny.json["accessors"][2].as_object_mut().unwrap().remove("bufferView");
    close(read(&tiny).corners(0)[0], [0.0; 3], 0.0);
    tiny.json["accessors"][2]["count"] = json!(4);
    tiny.json["accessors"][2]["bufferView"] = json!(0);
    refused(&tiny, "meshes[0].primitives[0].targets[0].POSITION", "4 entries for 3 vertices");
}

/// Slices of one large accessor, as primitives of one mesh or as separate meshes.
fn pieces(count: usize, meshes: bool) -> TriangleMesh {
    let mut tiny = Tiny::new();
    let vertices: Vec<[f32; 3]> =
        (0..count).flat_map(|i| [[i as f32, 0.0, 0.0], [i as f32 + 1.0, 0.0, 0.0], [i as f32, 1.0, 0.0]]).collect();
    let positions = tiny.floats(&vertices);
    let normals = tiny.floats(&vec![[0.0, 0.0, 1.0]; vertices.len()]);
    let primitives: Vec<Value> = (0..count as u16)
        .map(|i| {
            let indices = tiny.indices(&[3 * i, 3 * i + 1, 3 * i + 2]);
            json!({ "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices, "material": i })
        })
        .collect();
    let materials: Vec<_> = (0..count)
        .map(|i| json!({ "pbrMetallicRoughness": { "baseColorFactor": [i as f64 / 100.0, 0, 0, 1] } }))
        .collect();
    tiny.json["materials"] = json!(materials);
    let lists = if meshes { primitives.into_iter().map(|p| vec![p]).collect() } else { vec![primitives] };
    tiny.json["nodes"] = json!((0..lists.len()).map(|i| json!({ "mesh": i })).collect::<Vec<_>>());
    tiny.json["scenes"][0]["nodes"] = json!((0..lists.len()).collect::<Vec<_>>());
    tiny.json["meshes"] = json!(lists.into_iter().map(|p| json!({ "primitives": p })).collect::<Vec<_>>());
    read(&tiny)
}

#[test]
fn vertices_are_shared_and_only_those_that_are_used_are_written() {
    for meshes in [false, true] {
        let mesh = pieces(50, meshes);
        assert_eq!((mesh.positions.len(), mesh.triangle_count(), mesh.parts.len()), (150, 50, 50), "{meshes}");
        for t in 0..50 {
            close(mesh.corners(t)[1], [f64::from(t) + 1.0, 0.0, 0.0], 0.0);
            assert_eq!(mesh.part(t).surface.color[0], (f64::from(t) / 100.0) as f32);
        }
    }
}

#[test]
fn normals_without_data_are_those_of_the_faces() {
    let mut tiny = triangle();
    let normals = tiny.floats(&[[0.0; 3]; 3]);
    tiny.json["accessors"][normals].as_object_mut().unwrap().remove("bufferView");
    tiny.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    assert_eq!(read(&tiny).normals, [[0.0, 0.0, 1.0]; 3]);
}
