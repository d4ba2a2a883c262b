//! The content read from good files.

use std::path::Path;

use glam::DVec3;
use isolith::mesh::{TriangleMesh, parse};
use serde_json::json;

use super::tiny::{Tiny, everything, triangle};

fn read(tiny: &Tiny) -> TriangleMesh {
    let mesh = parse(&tiny.gltf(), Path::new("tiny.gltf"), None).unwrap();
    let again = parse(&tiny.glb(), Path::new("tiny.glb"), None).unwrap();
    assert_eq!(mesh.positions, again.positions);
    assert_eq!(mesh.indices, again.indices);
    mesh
}

fn corner(mesh: &TriangleMesh, triangle: u32) -> [[f64; 3]; 3] {
    mesh.corners(triangle).map(|c| c.to_array())
}

fn face_normal(mesh: &TriangleMesh, triangle: u32) -> DVec3 {
    let [a, b, c] = mesh.corners(triangle);
    (b - a).cross(c - a).normalize()
}

fn normal(mesh: &TriangleMesh, vertex: usize) -> DVec3 {
    DVec3::from(mesh.normals[vertex].map(f64::from))
}

#[test]
fn a_triangle_without_normals_is_flat() {
    let mesh = read(&triangle());
    assert_eq!(corner(&mesh, 0), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.colors, [[1.0; 4]; 3]);
    assert_eq!(mesh.bounds.max, DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn strips_and_fans_keep_one_side_in_front() {
    let strip = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    let fan = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.5, 0.0]];
    for (mode, corners) in [(5, strip), (6, fan)] {
        let mut tiny = Tiny::new();
        let positions = tiny.floats(&corners);
        tiny.mesh(json!({ "attributes": { "POSITION": positions }, "mode": mode }));
        let mesh = read(&tiny);
        assert_eq!(mesh.triangle_count(), 3);
        for triangle in 0..3 {
            assert_eq!(face_normal(&mesh, triangle), DVec3::Z, "mode {mode}, triangle {triangle}");
        }
    }
}

#[test]
fn a_strip_drops_triangles_that_only_join_its_pieces() {
    let mut tiny = Tiny::new();
    let positions = tiny.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    let indices = tiny.indices(&[0, 1, 2, 2, 3, 3]);
    tiny.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices, "mode": 5 }));
    assert_eq!(read(&tiny).triangle_count(), 1);
}

#[test]
fn transforms_are_inherited_down_the_tree() {
    let mut tiny = triangle();
    let half_turn = std::f32::consts::FRAC_1_SQRT_2;
    tiny.json["nodes"] = json!([
        { "translation": [10.0, 0.0, 0.0], "children": [1] },
        { "rotation": [0.0, 0.0, half_turn, half_turn], "children": [2] },
        { "scale": [2.0, 3.0, 1.0], "mesh": 0 },
    ]);
    let mesh = read(&tiny);
    // Scaled to (2, 0) and (0, 3), rotated by 90° to (0, 2) and (−3, 0), moved by 10.
    let expected = [[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [7.0, 0.0, 0.0]].map(DVec3::from);
    for (have, want) in mesh.corners(0).into_iter().zip(expected) {
        assert!((have - want).length() < 1e-5, "{have} {want}");
    }
}

#[test]
fn a_matrix_is_a_transform_too() {
    let mut tiny = triangle();
    tiny.json["nodes"] = json!([{ "mesh": 0, "matrix": [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1] }]);
    assert_eq!(corner(&read(&tiny), 0), [[5.0, 6.0, 7.0], [7.0, 6.0, 7.0], [5.0, 7.0, 7.0]]);
}

#[test]
fn mirrored_and_skewed_nodes_keep_normals_outside_and_upright() {
    for scale in [[-1.0, 1.0, 1.0], [1.0, 3.0, 0.2], [-2.0, -1.0, -0.5]] {
        let mut tiny = Tiny::new();
        // A slope, so that an error in the scaling of normals shows.
        let positions = tiny.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]);
        let slope = std::f32::consts::FRAC_1_SQRT_2;
        let normals = tiny.floats(&[[0.0, -slope, slope]; 3]);
        tiny.mesh(json!({ "attributes": { "POSITION": positions, "NORMAL": normals } }));
        tiny.json["nodes"][0]["scale"] = json!(scale);
        let mesh = read(&tiny);
        assert!(face_normal(&mesh, 0).dot(normal(&mesh, 0)) > 1.0 - 1e-6, "{scale:?}");
    }
}

#[test]
fn colors_textures_and_sparse_accessors() {
    let mesh = read(&everything());
    assert_eq!((mesh.triangle_count(), mesh.textures.len()), (4, 1));
    assert_eq!((mesh.textures[0].width, mesh.textures[0].height), (2, 2));
    assert_eq!(&mesh.textures[0].rgba[..4], [200, 100, 50, 255]);
    let textures: Vec<_> =
        mesh.parts.iter().map(|p| (p.indices.clone(), p.surface.base_color.map(|used| used.texture))).collect();
    assert_eq!(textures, [(0..6, Some(0)), (6..12, None)]);
    assert_eq!(mesh.uvs[1], [1.0, 1.0, 0.0, 0.0]);
    let [r, g, b, a] = mesh.colors[0];
    assert_eq!((r, b, a), (1.0, 0.0, 1.0));
    assert_eq!(mesh.parts[0].surface.color, [0.5, 1.0, 1.0, 1.0]);
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert!((g - 128.0 / 255.0).abs() < 1e-6);
    // The sparse corner: its node's scale doubles the height, and the parent's position moves it by one.
    assert_eq!(mesh.bounds.max, DVec3::new(2.0, 4.0, 1.5));
}

#[test]
fn the_same_mesh_twice_is_written_out_twice() {
    let mut tiny = triangle();
    tiny.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [0, 0, 5] }]);
    tiny.json["scenes"][0]["nodes"] = json!([0, 1]);
    let mesh = read(&tiny);
    assert_eq!(mesh.triangle_count(), 2);
    assert_eq!(mesh.parts.len(), 1, "runs of one texture are one part");
    assert_eq!(mesh.bounds.max.z, 5.0);
}

#[test]
fn only_the_default_scene_is_shown_and_without_scenes_all() {
    let mut tiny = triangle();
    tiny.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [0, 0, 5] }]);
    tiny.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }]);
    tiny.json["scene"] = json!(1);
    assert_eq!(read(&tiny).bounds.min.z, 5.0);
    let json = tiny.json.as_object_mut().unwrap();
    json.remove("scene");
    json.remove("scenes");
    assert_eq!(read(&tiny).triangle_count(), 2);
}

#[test]
fn quantized_positions_are_read_as_shares() {
    let mut tiny = Tiny::new();
    let corners: [i8; 12] = [0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0, 0];
    let positions = tiny.accessor(&corners.map(|c| c as u8), 5120, "VEC3", 3);
    tiny.json["bufferViews"][0]["byteStride"] = json!(4);
    let accessor = &mut tiny.json["accessors"][positions];
    accessor["normalized"] = json!(true);
    accessor["min"] = json!([0, -1, 0]);
    accessor["max"] = json!([1, 0, 0]);
    tiny.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    tiny.mesh(json!({ "attributes": { "POSITION": positions } }));
    assert_eq!(corner(&read(&tiny), 0), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
}

#[test]
fn a_deep_tree_is_no_danger() {
    let mut tiny = triangle();
    let depth = 50_000;
    let nodes: Vec<_> =
        (0..depth).map(|i| if i + 1 < depth { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) }).collect();
    tiny.json["nodes"] = json!(nodes);
    assert_eq!(read(&tiny).triangle_count(), 1);
}

#[test]
fn whole_numbers_may_be_written_with_a_point() {
    let mut tiny = triangle();
    tiny.json["nodes"][0]["mesh"] = json!(0.0);
    tiny.json["accessors"][0]["count"] = json!(3.0);
    assert_eq!(read(&tiny).triangle_count(), 1);
}
