//! Accumulated samples against single ones, the reference, and areas known exactly.

use std::time::Duration;

use glam::{DVec2, DVec3};
use isolith::export::{StillSettings, Stills};
use isolith::field::debug_view::ViewMode;
use isolith::field::light::display::display_color;
use isolith::field::reference::image::render_reference_at;
use isolith::field::{FlatScene, GBuffer, NO_LEAF, Shading, flatten};
use isolith::gallery;
use isolith::geometry::{Camera, Lens, SampleView};
use isolith::jobs::Task;
use isolith::mesh::MeshLibrary;
use isolith::render::{EvalStrategy, Film, Gpu, OverlaySettings, Renderer, Slot, StillWatch};
use isolith::scene::{
    CameraNode, DisplaySettings, KeyInterpolation, Keyframe, Material, MaterialId, Node, NodeKind, Object, ParamPath,
    ParamValue, Part, Scene, Shape, Track, ViewTransform, file,
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
    let film = Film { samples, is_transparent, lens: Lens::default() };
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
fn compare(name: &str, bench_scene: &BenchScene, samples: u32, lens: Lens) {
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let film = Film { samples, is_transparent: false, lens };
    let drawn = renderer().render_samples(film, flat, meshes, camera, SIZE, &mut |_| true).expect("a picture").0;
    let mut sums = vec![DVec3::ZERO; drawn.depth.len()];
    for sample in 0..samples {
        let SampleView { camera, offset } = lens.view(camera, SIZE[1], sample, samples);
        let reference = render_reference_at(offset, flat, meshes, &camera, SIZE, &|_| ());
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
    compare("pawn", &seen("pawn", flat, camera), 64, Lens::default());
    let ball = flatten(&glowing_ball([0.5, 0.2, 0.1]), 0.0).expect("within the limits");
    // Pixels so narrow that rays count from a plane before the ball.
    let far = Camera { far: 1e6, ..self::camera(1e5, 3e-5) };
    compare("narrow", &seen("narrow", ball, far), 16, Lens::default());
}

#[test]
fn meshes_move_with_the_samples_as_fields_do() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/gltf");
    let scene = file::load(&folder.join("transform.json")).unwrap_or_else(|error| panic!("{error}"));
    let flat = flatten(&scene, 0.0).expect("within the limits");
    let (meshes, _) = flat.load_meshes(&mut MeshLibrary::new(Some(folder)));
    let camera = flat.cameras[0].camera;
    let mesh = BenchScene { name: "mesh".into(), flat, meshes, camera };
    compare("mesh", &mesh, 16, Lens::default());
    compare("mesh out of focus", &mesh, 8, Lens { aperture: 0.1, focus_distance: 1.5, shutter: 0.0 });
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

#[test]
fn a_lens_blurs_what_is_not_in_focus() {
    let pawn = gallery::all().into_iter().find(|(name, _)| *name == "pawn").expect("the pawn").1;
    let flat = flatten(&pawn, 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.5);
    let pawn = BenchScene { name: "pawn".into(), flat, meshes: Vec::new(), camera };
    compare("pawn out of focus", &pawn, 24, Lens { aperture: 0.3, focus_distance: 2.0, shutter: 0.0 });
}

/// Variance along X of the alpha of a small ball 4 m away, in square pixels.
fn spread(renderer: &mut Renderer, lens: Lens) -> f64 {
    let mut scene = glowing_ball([1.0; 3]);
    let mut ball = (*scene.nodes()[0]).clone();
    ball.transform.scale = DVec3::splat(0.1);
    scene.replace(ball).expect("the ball is there");
    let flat = flatten(&scene, 0.0).expect("within the limits");
    let film = Film { samples: 64, is_transparent: true, lens };
    let camera = camera(4.0, 0.2);
    let picture = renderer.render_samples(film, &flat, &[], &camera, SIZE, &mut |_| true).expect("a picture").0;
    let middle = f64::from(SIZE[0]) * 0.5;
    let weights = picture
        .radiance
        .iter()
        .zip(0..)
        .map(|([.., a], i)| (f64::from(*a), (f64::from(i % SIZE[0]) + 0.5 - middle).powi(2)));
    let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), (a, square)| (sum + a, squares + a * square));
    squares / sum
}

/// The blur of a point is a disk as wide as the lens is, seen through the sharp plane.
#[test]
fn the_circle_of_confusion_has_its_size() {
    let mut renderer = renderer();
    let footprint = camera(4.0, 0.2).footprint(SIZE[1].into());
    let sharp = spread(&mut renderer, Lens::default());
    let in_focus = spread(&mut renderer, Lens { aperture: 0.2, focus_distance: 4.0, shutter: 0.0 });
    assert!((in_focus - sharp).abs() < 0.05, "{in_focus} {sharp}");
    for (focus_distance, diameter) in [(2.0, 0.2), (8.0, 0.1)] {
        let blurred = spread(&mut renderer, Lens { aperture: 0.2, focus_distance, shutter: 0.0 });
        let radius: f64 = 0.5 * diameter / (4.0 * footprint);
        let expected = 0.25 * radius * radius;
        assert!((blurred - sharp - expected).abs() < 0.06 * expected, "{focus_distance}: {blurred} {sharp} {expected}");
    }
}

/// Horizontal variance of a picture's alpha, in square pixels.
fn variance(picture: &GBuffer) -> f64 {
    let xs = (0..).map(|i: u32| f64::from(i % SIZE[0]) + 0.5);
    let weights: Vec<_> = picture.radiance.iter().map(|[.., a]| f64::from(*a)).zip(xs).collect();
    let sum: f64 = weights.iter().map(|(a, _)| a).sum();
    let mean = weights.iter().map(|(a, x)| a * x).sum::<f64>() / sum;
    weights.iter().map(|(a, x)| a * (x - mean).powi(2)).sum::<f64>() / sum
}

/// A ball that crosses the view is blurred by its way while the shutter is open, and the rest stays as it is.
#[test]
fn a_shutter_blurs_what_moves() {
    let mut scene = glowing_ball([1.0; 3]);
    let mut ball = (*scene.nodes()[0]).clone();
    ball.transform.scale = DVec3::splat(0.1);
    let path = ParamPath::of_node(ball.id, Part::Transform, "translation");
    scene.replace(ball).expect("the ball is there");
    // 2 m/s along X.
    let key = |time: f64| Keyframe {
        time,
        value: ParamValue::Vector(DVec3::X * (2.0 * time - 2.0)),
        interpolation: KeyInterpolation::Linear,
    };
    scene.set_tracks([Track { path, keys: vec![key(0.0), key(2.0)] }]).expect("a track");
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let of_shutter = |shutter: f64, samples: u32| {
        let mut scene = scene.clone();
        let camera = CameraNode { shutter, fov_y: 14.0, ..CameraNode::default() };
        scene.insert(None, usize::MAX, Node::new("Camera", NodeKind::Camera(camera)).at(eye)).expect("room");
        let settings = StillSettings {
            size: SIZE,
            camera: None,
            view_mode: ViewMode::Shaded,
            shading: Shading::Rendered,
            film: Film { samples, is_transparent: true, lens: Lens::default() },
            is_linear: true,
            has_layers: false,
            passes: None,
        };
        let still = Stills::new(scene, None, settings).at(1.0, &Task::without_cancel("a test")).expect("a still");
        assert_eq!(still.moments.len(), if shutter > 0.0 { samples as usize - 1 } else { 0 });
        let all: Vec<_> = still.all_moments().collect();
        let watch = &mut Silent;
        (still.camera, renderer().render_moments_for(still.film, &all, SIZE, watch).expect("a picture").0)
    };
    let (camera, sharp) = of_shutter(0.0, 32);
    let (_, blurred) = of_shutter(0.25, 32);
    let way = 2.0 * 0.25 / (4.0 * camera.footprint(SIZE[1].into()));
    let (found, expected) = (variance(&blurred) - variance(&sharp), way * way / 12.0);
    assert!((found - expected).abs() < 0.06 * expected, "{found} {expected}");
    // Numbers are those of the moment itself.
    assert!(sharp.depth == blurred.depth && sharp.normal == blurred.normal);
}

/// Shows nothing.
struct Silent;

impl StillWatch for Silent {
    fn progress(&mut self, _share: f32) -> bool {
        true
    }
}
