//! glTF models: their pictures on the device and in the reference.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use isolith::field::pick::pick;
use isolith::field::reference::image::render_reference;
use isolith::field::{FlatMaterial, GBuffer, NO_LEAF, Warning, flatten};
use isolith::mesh::{MeshLibrary, parse};
use isolith::render::EvalStrategy;
use isolith::scene::{Environment, LightKind, Material, file};
use serde_json::{Value, json};

use crate::gpu::BenchScene;

/// Pixels along a side of the pictures.
const SIDE: u32 = 64;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/gltf")
}

/// A case of the folder, seen by its own camera, with its warnings.
fn case(name: &str) -> (BenchScene, Vec<Warning>) {
    let scene = file::load(&folder().join(format!("{name}.json"))).unwrap_or_else(|error| panic!("{error}"));
    let flat = flatten(&scene, 0.0).unwrap();
    let (meshes, warnings) = flat.load_meshes(&mut MeshLibrary::new(Some(folder())));
    let camera = flat.cameras[0].camera;
    (BenchScene { name: name.into(), flat, meshes, camera }, warnings)
}

/// The device's picture, after a comparison with the reference: the same pixels hit, at nearly the same depth and
/// color, except for one at an edge.
fn picture(bench_scene: &BenchScene) -> GBuffer {
    let drawn = bench_scene.render(SIDE, EvalStrategy::Interpreter);
    let different = differing(&drawn, &reference(bench_scene));
    assert!(different <= 1, "{}: {different} pixels differ from the reference", bench_scene.name);
    drawn
}

fn reference(bench_scene: &BenchScene) -> GBuffer {
    render_reference(&bench_scene.flat, &bench_scene.meshes, &bench_scene.camera, [SIDE; 2], &|_| ()).unwrap().buffers
}

/// Number of pixels that differ in hit, depth or color.
fn differing(drawn: &GBuffer, right: &GBuffer) -> usize {
    let differs = |i: &usize| {
        let i = *i;
        let color = (0..3).map(|c| drawn.color[i][c].abs_diff(right.color[i][c])).max();
        let depth = (drawn.depth[i] - right.depth[i]).abs() < 1e-3 * right.depth[i];
        drawn.leaf[i] != right.leaf[i] || !(depth || right.leaf[i] == NO_LEAF) || color > Some(2)
    };
    (0..drawn.leaf.len()).filter(differs).count()
}

fn hits(picture: &GBuffer) -> usize {
    picture.leaf.iter().filter(|leaf| **leaf != NO_LEAF).count()
}

/// The color at the projection of a point, each channel as on or off beside the brightest one. `None` for a miss.
fn color_at(bench_scene: &BenchScene, picture: &GBuffer, point: DVec3) -> Option<[u8; 3]> {
    let local = point - bench_scene.camera.position;
    let half = (bench_scene.camera.fov_y * 0.5).tan() * -local.z;
    let at = (DVec2::new(local.x, -local.y) / half * 0.5 + 0.5) * f64::from(SIDE);
    let i = at.y as usize * SIDE as usize + at.x as usize;
    let [r, g, b, _] = picture.color[i];
    let most = f64::from(r.max(g).max(b));
    let channel = |c: u8| match f64::from(c) / most {
        share if share > 0.8 => 255,
        share if share < 0.1 => 0,
        _ => c,
    };
    (picture.leaf[i] != NO_LEAF).then_some([r, g, b].map(channel))
}

/// Number of pixels of a square of 2 m at 5 m: 64 / (5 · tan 20°) = 35.2 along each side, which contains the centers of
/// 36.
const SQUARE: usize = 36 * 36;

#[test]
fn what_says_nothing_of_the_shape_does_not_hide_it() {
    for name in ["feature-id", "matrix-w", "texture-without-source", "zero-morph-target", "hash"] {
        let (bench_scene, warnings) = case(name);
        let picture = picture(&bench_scene);
        assert_eq!(hits(&picture), SQUARE, "{name}");
        let said: Vec<_> = warnings.iter().map(|w| w.reason.as_str()).collect();
        match name {
            "texture-without-source" => {
                assert!(
                    said.iter().any(|s| s.starts_with("textures[0]") && s.contains("KHR_texture_basisu")),
                    "{said:?}"
                );
                assert!(said.iter().any(|s| s.starts_with("KHR_texture_basisu: not supported")), "{said:?}");
            }
            _ => assert!(said.is_empty(), "{name}: {said:?}"),
        }
    }
}

const RED: Option<[u8; 3]> = Some([255, 0, 0]);
const GREEN: Option<[u8; 3]> = Some([0, 255, 0]);
const BLUE: Option<[u8; 3]> = Some([0, 0, 255]);
const WHITE: Option<[u8; 3]> = Some([255, 255, 255]);

/// The colors at four points of the square: upper left, upper right, lower left, lower right.
fn quarters(name: &str, offset: f64) -> [Option<[u8; 3]>; 4] {
    let (bench_scene, warnings) = case(name);
    assert!(warnings.is_empty(), "{name}: {warnings:?}");
    let picture = picture(&bench_scene);
    let points = [[-offset, offset], [offset, offset], [-offset, -offset], [offset, -offset]];
    points.map(|[x, y]| color_at(&bench_scene, &picture, DVec3::new(x, y, 0.0)))
}

#[test]
fn a_clamped_texture_keeps_the_color_of_its_edge() {
    // The texture fills the middle third.
    for offset in [0.2, 0.5, 0.9] {
        assert_eq!(quarters("clamp", offset), [RED, GREEN, BLUE, WHITE], "{offset}");
    }
}

#[test]
fn texture_coordinates_are_transformed() {
    // With scale 1/2 and offset (1/2, 0), only the upper right quarter of the texture is visible.
    for offset in [0.2, 0.5, 0.8] {
        assert_eq!(quarters("transform", offset), [GREEN; 4], "{offset}");
    }
}

#[test]
fn what_is_masked_is_cut_out_and_cannot_be_picked() {
    assert_eq!(quarters("mask", 0.5), [RED, None, RED, None]);
    let (bench_scene, _) = case("mask");
    let size = DVec2::splat(f64::from(SIDE));
    let picked = |x: f64| {
        let ray = bench_scene.camera.ray(DVec2::new(x, 32.0), size);
        pick(&bench_scene.flat, &bench_scene.meshes, &ray, bench_scene.camera.near, bench_scene.camera.far)
    };
    assert_eq!((picked(24.0), picked(40.0)), (Some(bench_scene.flat.meshes[0].id), None));
}

#[test]
fn a_skin_stands_where_its_joints_are() {
    let (bench_scene, warnings) = case("skin");
    assert!(warnings.is_empty(), "{warnings:?}");
    let mesh = bench_scene.meshes[0].as_ref().unwrap();
    assert_eq!((mesh.bounds.min, mesh.bounds.max), (DVec3::new(1.0, -1.0, 0.0), DVec3::new(3.0, 1.0, 0.0)));
    let picture = picture(&bench_scene);
    assert!(color_at(&bench_scene, &picture, DVec3::X * 2.0).is_some());
    assert!(color_at(&bench_scene, &picture, DVec3::ZERO).is_none());
}

#[test]
fn a_cube_far_from_its_origin_is_a_cube() {
    let (bench_scene, warnings) = case("utm");
    assert!(warnings.is_empty(), "{warnings:?}");
    let mesh = bench_scene.meshes[0].as_ref().unwrap();
    let size = mesh.bounds.max - mesh.bounds.min;
    assert!((size - 0.74).abs().max_element() < 1e-6, "{size}");
    // Identical to a cube near the origin.
    let drawn = picture(&bench_scene);
    let side = 0.74_f64;
    let width = f64::from(SIDE) / (2.0 * 20_f64.to_radians().tan());
    let distance = bench_scene.camera.position.length();
    // A cube at an angle shows between one and √3 times the area of a side.
    let least = (side * width / (distance + side)).powi(2);
    let most = 3_f64.sqrt() * (side * width / (distance - side)).powi(2);
    assert!((least..most).contains(&(hits(&drawn) as f64)), "{} pixels, {least} to {most}", hits(&drawn));
    let normals: std::collections::HashSet<_> =
        drawn.normal.iter().map(|n| n.map(|c| (c * 1e4).round() as i32)).filter(|n| *n != [0; 3]).collect();
    assert!(normals.len() <= 3, "faces of a cube have three directions that can be seen: {normals:?}");
}

#[test]
fn shared_vertices_are_written_once() {
    let (bench_scene, warnings) = case("grid");
    assert!(warnings.is_empty(), "{warnings:?}");
    let mesh = bench_scene.meshes[0].as_ref().unwrap();
    assert!(mesh.positions.len() <= 10_000, "{} vertices", mesh.positions.len());
    assert_eq!(mesh.parts.len(), 1);
    assert_eq!(hits(&picture(&bench_scene)), SQUARE);
}

/// The case `clamp` with its JSON changed.
fn changed(change: impl Fn(&mut Value)) -> BenchScene {
    let (mut bench_scene, _) = case("clamp");
    let text = std::fs::read(folder().join("clamp.gltf")).unwrap();
    let mut json: Value = serde_json::from_slice(&text).unwrap();
    change(&mut json);
    let mesh = parse(&serde_json::to_vec(&json).unwrap(), Path::new("changed"), None).unwrap();
    bench_scene.meshes = vec![Some(Arc::new(mesh))];
    bench_scene
}

#[test]
fn textures_are_looked_up_as_the_reference_does() {
    let transform = |json: &mut Value, transform: Value| {
        json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
            json!({ "KHR_texture_transform": transform });
    };
    let mut pictures = vec![
        picture(&changed(|_| ())),
        picture(&changed(|json| json["samplers"][0] = json!({ "wrapS": 33648, "wrapT": 10497, "magFilter": 9728 }))),
        picture(&changed(|json| json["samplers"][0] = json!({ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }))),
        picture(&changed(|json| transform(json, json!({ "rotation": 0.5, "offset": [0.3, 0.1] })))),
        picture(&changed(|json| transform(json, json!({ "rotation": -0.5, "scale": [0.5, 2], "offset": [0.3, 0.1] })))),
        picture(&changed(|json| {
            json["samplers"][0] = json!({ "wrapS": 33648 });
            json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 1, 0.25, 1]);
        })),
    ];
    // Each shows something else, and the comparison detects it.
    while let Some(one) = pictures.pop() {
        assert!(pictures.iter().all(|other| differing(&one, other) > 50));
    }
}

/// The case `clamp` with another material, under a lamp from above. Its image serves all textures.
fn lit(material: Value) -> BenchScene {
    let mut bench_scene = changed(|json| {
        json["materials"][0] = material.clone();
        json["samplers"][0] = json!({ "wrapS": 10497, "wrapT": 33648 });
    });
    let light = &mut bench_scene.flat.lights[0];
    light.direction = DVec3::new(0.3, -0.8, -0.6).normalize();
    light.light.light = LightKind::Sun { strength: 0.4 * std::f64::consts::PI, angle: 0.0 };
    bench_scene.flat.environment = Environment::sky([0.1; 3], [0.2; 3], [0.3; 3]);
    bench_scene
}

#[test]
fn materials_of_files_are_drawn_as_the_reference_does() {
    let pbr = |color: [f64; 4]| json!({ "baseColorFactor": color, "metallicFactor": 0 });
    let gray = pbr([0.5, 0.4, 0.3, 1.0]);
    let [map, moved] = [
        json!({ "index": 0 }),
        json!({ "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.3, 0.2], "scale": [2, 1.5], "rotation": 0.4 } } }),
    ];
    let with = |info: &Value, key: &str, value: f64| {
        let mut info = info.clone();
        info[key] = json!(value);
        info
    };
    let mut pictures: Vec<GBuffer> = [
        json!({ "pbrMetallicRoughness": gray }),
        json!({ "pbrMetallicRoughness": gray, "normalTexture": map }),
        json!({ "pbrMetallicRoughness": gray, "normalTexture": with(&moved, "scale", 0.5) }),
        json!({ "pbrMetallicRoughness": gray, "occlusionTexture": moved }),
        json!({ "pbrMetallicRoughness": gray, "occlusionTexture": with(&map, "strength", 0.5) }),
        json!({ "pbrMetallicRoughness": gray, "emissiveFactor": [0.1, 0.2, 0.3], "emissiveTexture": moved }),
        json!({
            "pbrMetallicRoughness": gray, "emissiveFactor": [0.1, 0.2, 0.3],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 3 } },
        }),
        json!({ "pbrMetallicRoughness": gray, "extensions": { "KHR_materials_unlit": {} } }),
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": moved, "metallicRoughnessTexture": map, "metallicFactor": 0.9, "roughnessFactor": 0.8,
            },
            "normalTexture": with(&moved, "scale", 0.3), "occlusionTexture": map, "emissiveFactor": [0.2, 0, 0.1],
            "emissiveTexture": map,
            "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 0.5 }, "KHR_materials_ior": { "ior": 1.3 } },
        }),
    ]
    .into_iter()
    .map(|material| picture(&lit(material)))
    .collect();
    // Each shows something else, and the comparison detects it.
    while let Some(one) = pictures.pop() {
        for (i, other) in pictures.iter().enumerate() {
            assert!(differing(&one, other) > 200, "{} and {i}", pictures.len());
        }
    }
}

#[test]
fn a_material_of_the_scene_replaces_all_of_the_file_s() {
    let full = json!({
        "normalTexture": { "index": 0 }, "occlusionTexture": { "index": 0 }, "emissiveFactor": [1, 1, 1],
        "emissiveTexture": { "index": 0 },
    });
    let mut bench_scene = lit(full);
    let own = picture(&bench_scene);
    bench_scene.flat.meshes[0].material = Some(0);
    bench_scene.flat.materials.push(FlatMaterial::new(&Material::default()));
    let replaced = picture(&bench_scene);
    assert!(differing(&own, &replaced) > 200);
    let colors: std::collections::HashSet<_> =
        (0..replaced.leaf.len()).filter(|i| replaced.leaf[*i] != NO_LEAF).map(|i| replaced.color[i]).collect();
    assert!(colors.len() < 40, "the textures of the file are gone: {} colors", colors.len());
}

#[test]
fn what_is_blended_covers_as_many_pixels_as_its_opacity_says() {
    let glass = |opacity: f64| {
        json!({
            "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, opacity], "metallicFactor": 0 }, "alphaMode": "BLEND",
        })
    };
    for opacity in [0.0, 0.25, 0.5, 0.9, 1.0] {
        let bench_scene = lit(glass(opacity));
        let share = hits(&picture(&bench_scene)) as f64 / SQUARE as f64;
        // Random per pixel: of 1 296 pixels a share deviates by at most 0.014 in the mean.
        assert!((share - opacity).abs() < 0.05, "{share} of {opacity}");
        let exact = opacity == 0.0 || opacity == 1.0;
        assert!(!exact || share == opacity, "{share} of {opacity}");
        let ray = bench_scene.camera.ray(DVec2::splat(32.0), DVec2::splat(64.0));
        let picked = pick(&bench_scene.flat, &bench_scene.meshes, &ray, 0.01, 100.0);
        assert_eq!(picked.is_some(), opacity > 0.0, "all that has opacity can be picked");
    }
    // Two layers of one half, of the same triangles, leave a quarter.
    let mut twice = lit(glass(0.5));
    let mut behind = twice.flat.meshes[0].clone();
    behind.world_from_local.translation.z -= 1e-3;
    twice.flat.meshes.push(behind);
    twice.meshes.push(twice.meshes[0].clone());
    let share = hits(&picture(&twice)) as f64 / SQUARE as f64;
    assert!((share - 0.75).abs() < 0.05, "{share}");
}
