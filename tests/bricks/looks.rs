//! What models show as fields: the looks of their triangles, the same by the device and by the reference.

use glam::{DQuat, DVec3};
use isolith::bricks::BrickLevels;
use isolith::field::GBuffer;
use isolith::field::light::model_look::model_look;
use isolith::field::reference::image::render_reference;
use isolith::gallery;
use isolith::mesh::{MeshLibrary, voxel_for, voxelized};
use isolith::render::EvalStrategy;
use isolith::scene::{
    CameraNode, Instancer, Light, Material, MaterialId, MeshNode, ModelFile, Modifier, Node, NodeKind, Object, Scene,
    Shape, ShapeKind, Variation,
};

use crate::gpu::BenchScene;

const AMPHORA: &str = "models/amphora.glb";
const SIDE: u32 = 128;

/// A folder with the model.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let (name, scene) = gallery::all().into_iter().find(|(name, _)| *name == "painted").unwrap();
    gallery::install(name, &scene, folder.path()).unwrap();
    folder
}

fn field(resolution: f64, file_materials: bool) -> NodeKind {
    let shape = Shape::MeshField {
        file: ModelFile::new(AMPHORA),
        clip: String::new(),
        clip_time: 0.0,
        resolution,
        voxel_size: 0.0,
        file_materials,
    };
    NodeKind::Object(Object { shape, material: MaterialId(1) })
}

/// A scene with a sun and a camera, `away` times as far as the model is large.
fn scene(node: Node, away: f64) -> Scene {
    let mut scene = Scene::new();
    scene.insert(None, 0, node).unwrap();
    let sun = Node::new("Sun", NodeKind::Light(Light::sun()));
    scene.insert(None, 1, sun.rotated(DQuat::from_rotation_x(-0.7) * DQuat::from_rotation_y(0.4))).unwrap();
    let camera = Node::new("Camera", NodeKind::Camera(CameraNode { fov_y: 40.0, ..CameraNode::default() }));
    scene.insert(None, 2, camera.at(DVec3::new(0.0, 0.5, 1.5 * away))).unwrap();
    scene
}

fn drawn(name: &str, scene: &Scene, folder: &tempfile::TempDir) -> (BenchScene, GBuffer) {
    let bench = BenchScene::new(name, scene, Some(folder.path().to_path_buf()));
    let picture = bench.render(SIDE, EvalStrategy::Interpreter);
    (bench, picture)
}

/// The pixels inside of what both show: where the neighbors show it, too.
fn inner(pictures: [&GBuffer; 2]) -> Vec<usize> {
    let hit = |i: usize| pictures.iter().all(|picture| picture.depth[i].is_finite());
    let side = SIDE as usize;
    let all = (side..pictures[0].depth.len() - side).filter(|i| (1..side - 1).contains(&(i % side)));
    all.filter(|i| [*i, i - 1, i + 1, i - side, i + side].into_iter().all(hit)).collect()
}

/// The mean difference of a channel, of 255.
fn apart(a: &GBuffer, b: &GBuffer, pixels: &[usize]) -> f64 {
    let of = |i: &usize| (0..3).map(|c| f64::from(a.color[*i][c].abs_diff(b.color[*i][c]))).sum::<f64>() / 3.0;
    pixels.iter().map(of).sum::<f64>() / pixels.len() as f64
}

/// How far apart the outlines of two pictures are on average, in pixels: the pixels that only one of them shows, for
/// each of the outline.
fn silhouette([a, b]: [&GBuffer; 2]) -> f64 {
    let hit = |picture: &GBuffer, i: usize| picture.depth[i].is_finite();
    let side = SIDE as usize;
    let apart = (0..a.depth.len()).filter(|i| hit(a, *i) != hit(b, *i)).count();
    let is_edge = |i: &usize| hit(a, *i) != hit(a, i - 1) || hit(a, *i) != hit(a, i - side);
    let edge = (side..a.depth.len()).filter(is_edge).count();
    println!("outlines: {apart} pixels differ of {edge}");
    apart as f64 / edge.max(1) as f64
}

/// The mean color of these pixels.
fn mean(picture: &GBuffer, pixels: &[usize]) -> DVec3 {
    let color = |i: &usize| DVec3::from([0, 1, 2].map(|c| f64::from(picture.color[*i][c])));
    pixels.iter().map(color).sum::<DVec3>() / pixels.len() as f64
}

/// What remains near is that the triangles are coarse, and drawn with smooth normals: the field has edges there. Far
/// away a pixel of the triangles shows one point of the image, and one of the field a mean: only means are compared.
#[test]
fn a_field_looks_as_the_triangles_of_its_file() {
    let folder = folder();
    for away in [1.0, 6.0] {
        let mesh = scene(Node::new("Mesh", NodeKind::Mesh(MeshNode::new(AMPHORA))), away);
        let (_, triangles) = drawn("mesh", &mesh, &folder);
        let differences = [true, false].map(|own| {
            let (bench, field) = drawn("field", &scene(Node::new("Field", field(256.0, own)), away), &folder);
            assert_eq!(bench.flat.textures.looks.len(), usize::from(own));
            let pixels = inner([&triangles, &field]);
            assert!(pixels.len() > if away < 2.0 { 2_000 } else { 60 }, "{}", pixels.len());
            let outlines = silhouette([&triangles, &field]);
            assert!(outlines < 0.3, "{away}: the outlines are {outlines} pixels apart");
            let of_means = (mean(&triangles, &pixels) - mean(&field, &pixels)).abs().max_element();
            [apart(&triangles, &field, &pixels), of_means]
        });
        let [[own, own_mean], [plain, plain_mean]] = differences;
        println!(
            "{away} times as far: {own:.2} of 255, means {own_mean:.2}; in another material {plain:.2}, {plain_mean:.2}"
        );
        // Far away the mean over 150 pixels of an image of black and clay is itself uncertain by 5.
        let most = if away > 2.0 { 20.0 } else { 12.0 };
        assert!(own_mean < most && plain_mean > 4.0 * most, "{away}: {own_mean} and {plain_mean}");
        assert!(away > 2.0 || (own < 12.0 && plain > 4.0 * own), "{away}: {own} and {plain}");
    }
}

/// The device against the reference: plain, in a blend, under modifiers, and in copies that are turned and stretched.
#[test]
fn looks_are_the_same_on_the_device_and_in_the_reference() {
    let folder = folder();
    let plain = Node::new("Field", field(96.0, true));
    let ball = |x: f64| {
        let object = Object { shape: Shape::Sphere { radius: 0.25 }, material: MaterialId(2) };
        Node::new("Ball", NodeKind::Object(object)).at(DVec3::new(x, 0.4, 0.15))
    };
    let blended = |scene: &mut Scene| {
        scene.insert_material(Material::new(MaterialId(2), "Red", [0.8, 0.1, 0.1])).unwrap();
        let group = isolith::scene::Group::new(
            isolith::scene::Operator::Union,
            isolith::scene::Blend::new(isolith::scene::BlendKernel::Quadratic, 0.15),
        );
        let group = scene.insert(None, 0, Node::new("Group", NodeKind::Group(group))).unwrap();
        scene.insert(Some(group), 0, plain.clone()).unwrap();
        scene.insert(Some(group), 1, ball(0.25)).unwrap();
    };
    let copied = |scene: &mut Scene| {
        let mut instancer = Instancer::grid([3, 1, 2], [0.7, 1.0, 0.9]);
        instancer.variation = Variation {
            rotation_min: [-20.0, -180.0, 0.0],
            rotation_max: [20.0, 180.0, 0.0],
            scale_min: [0.7; 3],
            scale_max: [1.0; 3],
            ..Variation::default()
        };
        let id = scene.insert(None, 0, Node::new("Copies", NodeKind::Instancer(Box::new(instancer)))).unwrap();
        scene.insert(Some(id), 0, plain.clone()).unwrap();
    };
    let twisted = plain.clone().modified(Modifier::Onion { thickness: 0.03, walls: 1, spacing: 0.2 });
    let sheet = Node::new(
        "Floor",
        NodeKind::Object(Object { shape: ShapeKind::Sphere.default_shape(), material: MaterialId(1) }),
    );
    let base = || scene(sheet.clone().at(DVec3::new(0.0, -3.0, -3.0)), 1.0);
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = base();
        change(&mut scene);
        scene
    };
    let cases = [
        ("plain", scene(plain.clone(), 1.0)),
        ("far", scene(plain.clone(), 5.0)),
        ("modified", scene(twisted, 1.0)),
        ("blended", with(&blended)),
        ("copied", with(&copied)),
    ];
    for (name, scene) in cases {
        let (bench, picture) = drawn(name, &scene, &folder);
        let truth = render_reference(&bench.flat, &bench.meshes, &bench.camera, [SIDE, SIDE], &|_| ()).unwrap();
        let pixels = inner([&picture, &truth.buffers]);
        let same = |i: &&usize| picture.leaf[**i] == truth.buffers.leaf[**i] && !truth.turned.contains_key(*i);
        let pixels: Vec<usize> = pixels.iter().filter(same).copied().collect();
        let off = |i: &usize| (0..3).map(|c| picture.color[*i][c].abs_diff(truth.buffers.color[*i][c])).max().unwrap();
        let wrong = pixels.iter().filter(|i| off(i) > 3).count();
        println!("{name}: {wrong} of {} pixels differ", pixels.len());
        assert!(pixels.len() > 90 && wrong as f64 <= 0.01 * pixels.len() as f64, "{name}: {wrong} of {}", pixels.len());
    }
}

/// Far away a pixel shows the mean of what is below it, and beside the surface coarser levels stand in.
#[test]
fn looks_are_means_over_the_footprint_and_reach_beyond_the_surface() {
    let folder = folder();
    let mut library = MeshLibrary::new(Some(folder.path().to_path_buf()));
    let mesh = library.get(AMPHORA).unwrap();
    let voxel = voxel_for(&mesh.bounds, 128.0);
    let levels = BrickLevels::new(&voxelized(&mesh, voxel, &mut |_| true).unwrap().bricks);
    assert!(levels.has_looks() && !levels.without_looks().has_looks());
    assert!(levels.without_looks().texels() < levels.texels());
    let (center, unit) = levels.look_space();
    // Through the meander, where black and clay change often.
    let at = |turn: f64, away: f64| {
        let p = DVec3::new((0.2473 + away) * turn.sin(), 0.2691, (0.2473 + away) * turn.cos());
        (p - center) / unit
    };
    let spread = |width: f64, away: f64| {
        let looks: Vec<f64> =
            (0..200).map(|i| model_look(&levels, at(f64::from(i) * 0.031, away), width).color.x).collect();
        let mean = looks.iter().sum::<f64>() / looks.len() as f64;
        (mean, (looks.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / looks.len() as f64).sqrt())
    };
    let (near, far) = (spread(0.0, 0.0), spread(0.2, 0.0));
    println!("near {near:?}, far {far:?}");
    assert!(far.1 < 0.1 * near.1 && (far.0 - near.0).abs() < 0.15, "{near:?} {far:?}");
    // The share falls only beyond what the coarsest level reaches.
    for away in [0.0, 0.02, 0.05, 0.1] {
        let look = model_look(&levels, at(1.0, away), 0.0);
        assert!(look.share > 0.95 && look.share < 1.001, "{away}: {look:?}");
    }
    assert!(model_look(&levels, DVec3::splat(40.0), 0.0).share == 0.0);
}
