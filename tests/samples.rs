//! Accumulated samples against single ones, the reference, and areas known exactly.

use std::time::Duration;

use glam::{DVec2, DVec3};
use isolith::field::light::display::display_color;
use isolith::field::reference::image::render_reference_at;
use isolith::field::{FlatScene, GBuffer, NO_LEAF, flatten};
use isolith::gallery;
use isolith::geometry::{Camera, pixel_jitter};
use isolith::mesh::MeshLibrary;
use isolith::render::{EvalStrategy, Film, Gpu, OverlaySettings, Renderer, Slot};
use isolith::scene::{
    DisplaySettings, Material, MaterialId, Node, NodeKind, Object, Scene, Shape, ViewTransform, file,
};

use crate::gpu::BenchScene;

const SIZE: [u32; 2] = [36, 24];

fn renderer() -> Renderer {
    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&gpu).unwrap_or_else(|error| panic!("{error}"));
    renderer.set_strategy(EvalStrategy::Interpreter);
    renderer
}

/// A ball of radius 1 that glows with this light and reflects none, at the origin, before a dark sky.
fn glowing_ball(light: [f64; 3]) -> Scene {
    let mut scene = Scene::new();
    let mut glow = Material::new(MaterialId(1), "Glow", [0.0; 3]);
    (glow.specular_weight, glow.emission_luminance, glow.emission_color) = (0.0, 1.0, light);
    scene.replace_material(glow).expect("the material is there");
    let ball = Object { shape: Shape::Sphere { radius: 1.0 }, material: MaterialId(1) };
    scene.insert(None, 0, Node::new("Ball", NodeKind::Object(ball))).expect("room");
    scene
}

/// Along Z from this distance.
fn camera(distance: f64, fov_y: f64) -> Camera {
    Camera::looking_at(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, fov_y)
}

fn accumulated(
    renderer: &mut Renderer,
    flat: &FlatScene,
    camera: &Camera,
    samples: u32,
    is_transparent: bool,
) -> GBuffer {
    let film = Film { samples, is_transparent };
    renderer.render_samples(film, flat, &[], camera, SIZE, &mut |_| true).expect("a picture").0
}

#[test]
fn one_sample_is_the_single_picture_to_the_bit() {
    let mut scene = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn").1;
    let mut renderer = renderer();
    for view_transform in ViewTransform::ALL {
        scene.display = DisplaySettings { exposure: 0.5, view_transform };
        let flat = flatten(&scene, 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.5);
        let single = renderer.render(&flat, &[], &camera, SIZE, &mut |_| true).expect("a picture").0;
        let one = accumulated(&mut renderer, &flat, &camera, 1, false);
        assert!(GBuffer { radiance: Vec::new(), ..one } == single, "{view_transform:?}");
        // Numbers stay those of the first sample.
        let many = accumulated(&mut renderer, &flat, &camera, 5, false);
        assert!(many.depth == single.depth && many.normal == single.normal && many.leaf == single.leaf);
        assert!(many.color != single.color);
    }
}

/// Share of the samples that may fall on the other side of an edge than those of the reference.
fn compare(name: &str, bench_scene: &BenchScene, samples: u32) {
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let film = Film { samples, is_transparent: false };
    let drawn = renderer().render_samples(film, flat, meshes, camera, SIZE, &mut |_| true).expect("a picture").0;
    let mut sums = vec![DVec3::ZERO; drawn.depth.len()];
    for sample in 0..samples {
        let reference = render_reference_at(pixel_jitter(sample), flat, meshes, camera, SIZE, &|_| ());
        let light = reference.unwrap_or_else(|error| panic!("{error:?}")).buffers.radiance;
        for (sum, [r, g, b, _]) in sums.iter_mut().zip(light) {
            *sum += DVec3::new(r.into(), g.into(), b.into());
        }
    }
    let off = drawn.radiance.iter().zip(&sums).map(|([r, g, b, a], sum)| {
        assert_eq!(*a, 1.0, "{name}: an opaque picture");
        (DVec3::new((*r).into(), (*g).into(), (*b).into()) - *sum / f64::from(samples)).abs().max_element()
    });
    let off: Vec<f64> = off.collect();
    let at_edges = off.iter().filter(|off| **off > 2e-3).count();
    let worst = off.iter().copied().fold(0.0, f64::max);
    // A ray within rounding of an edge may miss on one side: a sample's share of the contrast.
    assert!(at_edges <= 6 && worst < 1.5 / f64::from(samples), "{name}: {at_edges} pixels, up to {worst}");
}

#[test]
fn samples_are_the_mean_of_single_pictures_beside_the_centers() {
    let pawn = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn").1;
    let flat = flatten(&pawn, 0.0).expect("within the limits");
    let seen = |name: &str, flat, camera| BenchScene { name: name.into(), flat, meshes: Vec::new(), camera };
    let camera = flat.default_camera(&[], 1.5);
    compare("pawn", &seen("pawn", flat, camera), 64);
    let ball = flatten(&glowing_ball([0.5, 0.2, 0.1]), 0.0).expect("within the limits");
    // Pixels so narrow that rays count from a plane before the ball.
    let far = Camera { far: 1e6, ..self::camera(1e5, 3e-5) };
    compare("narrow", &seen("narrow", ball, far), 16);
}

#[test]
fn meshes_move_with_the_samples_as_fields_do() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/gltf");
    let scene = file::load(&folder.join("transform.json")).unwrap_or_else(|error| panic!("{error}"));
    let flat = flatten(&scene, 0.0).expect("within the limits");
    let (meshes, _) = flat.load_meshes(&mut MeshLibrary::new(Some(folder)));
    let camera = flat.cameras[0].camera;
    compare("mesh", &BenchScene { name: "mesh".into(), flat, meshes, camera }, 16);
}

/// The share of each pixel that a ball of radius 1 covers, seen from this distance along its middle.
fn covered(camera: &Camera, distance: f64) -> Vec<f64> {
    let [width, height] = SIZE.map(f64::from);
    let least = (1.0 - 1.0 / (distance * distance)).sqrt();
    let fine = |x: u32, y: u32, i: u32| DVec2::new(f64::from(x), f64::from(y)) + place(i);
    let hits = |x: u32, y: u32| {
        let rays = (0..1024).map(move |i| camera.ray(fine(x, y, i), DVec2::new(width, height)));
        rays.filter(|ray| -ray.direction.z > least).count() as f64 / 1024.0
    };
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| hits(x, y)).collect()
}

/// A place in the pixel, on a grid of 32 by 32.
fn place(i: u32) -> DVec2 {
    DVec2::new(f64::from(i % 32) + 0.5, f64::from(i / 32) + 0.5) / 32.0
}

#[test]
fn alpha_is_the_share_of_the_pixel_that_is_covered() {
    let light = [0.5, 0.25, 0.125];
    let flat = flatten(&glowing_ball(light), 0.0).expect("within the limits");
    let camera = camera(4.0, 0.7);
    let areas = covered(&camera, 4.0);
    let mut renderer = renderer();
    for (samples, most) in [(16, 3.0 / 16.0), (64, 4.5 / 64.0)] {
        let picture = accumulated(&mut renderer, &flat, &camera, samples, true);
        let shown = display_color(light.into(), &flat.display) * 255.0;
        let (mut edges, mut squares) = (0, 0.0);
        for ((area, color), light_there) in areas.iter().zip(&picture.color).zip(&picture.radiance) {
            let coverage = f64::from(light_there[3]);
            assert!((coverage - area).abs() <= most, "{samples} samples: {coverage} of {area}");
            assert!((f64::from(color[3]) / 255.0 - coverage).abs() < 3e-3);
            // Linear light is multiplied by coverage; the picture's colors are not.
            assert!((f64::from(light_there[0]) - light[0] * coverage).abs() < 1e-5);
            let is_right = |c: usize| (f64::from(color[c]) - shown[c]).abs() < 1.0;
            assert!(if coverage > 0.0 { (0..3).all(is_right) } else { *color == [0; 4] }, "{color:?} {shown}");
            if (0.01..0.99).contains(area) {
                edges += 1;
                squares += (coverage - area).powi(2);
            }
        }
        let root_mean_square = (squares / f64::from(edges)).sqrt();
        assert!(edges > 30 && root_mean_square < 1.2 / f64::from(samples), "{edges} pixels, {root_mean_square}");
    }
}

/// What the transforms show on the device is what their twins in f64 say.
#[test]
fn the_device_and_its_twin_show_the_same_colors() {
    let camera = camera(4.0, 0.7);
    let mut renderer = renderer();
    for light in [[0.02, 0.3, 0.1], [0.7, 0.75, 0.8], [4.0, 0.5, 0.0], [60.0, 70.0, 9.0]] {
        let mut scene = glowing_ball(light);
        for view_transform in ViewTransform::ALL {
            for exposure in [-2.0, 0.0, 1.5] {
                scene.display = DisplaySettings { exposure, view_transform };
                let flat = flatten(&scene, 0.0).expect("within the limits");
                let drawn = renderer.render(&flat, &[], &camera, SIZE, &mut |_| true).expect("a picture").0;
                let [r, g, b, _] = drawn.color[drawn.index(SIZE[0] / 2, SIZE[1] / 2)].map(f64::from);
                let shown = display_color(light.into(), &flat.display) * 255.0;
                let off = (DVec3::new(r, g, b) - shown).abs().max_element();
                assert!(off < 0.6, "{light:?} {:?}: {r} {g} {b}, not {shown}", scene.display);
            }
        }
    }
}

#[test]
fn a_sample_uploads_no_scene_and_needs_no_time_to_plan() {
    let flat = flatten(&gallery::random(64, 3), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.5);
    let mut renderer = renderer();
    let none = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, &flat, &[], &camera, SIZE, none).expect("a frame");
    renderer.accumulate(&mut frame, false);
    renderer.advance(&mut frame, Duration::MAX).expect("a picture");
    let uploaded = renderer.uploaded();
    for sample in 1..4 {
        renderer.next_sample(&mut frame).expect("a sample");
        assert_eq!((frame.samples(), frame.is_done()), (sample, false));
        renderer.advance(&mut frame, Duration::MAX).expect("a picture");
        assert_eq!((frame.samples(), frame.is_done()), (sample + 1, true));
    }
    assert_eq!(renderer.uploaded(), uploaded);
    let buffers = renderer.read(&frame).expect("read");
    assert!(buffers.leaf.iter().any(|leaf| *leaf != NO_LEAF));
}
