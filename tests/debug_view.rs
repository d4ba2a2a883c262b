//! Counters per pixel, and the view modes that show them: they are free unless requested, add up, and show correct
//! values.

use glam::{DVec3, Vec3};
use isolith::field::debug_view::{
    DEBUG_VIEW_NOTHING, DepthRange, ViewMode, debug_view_count, debug_view_distance, debug_view_lit, debug_view_normal,
    debug_view_slope, id_color,
};
use isolith::field::{GBuffer, HitTarget};
use isolith::gallery;
use isolith::geometry::Camera;
use isolith::render::{EvalStrategy, Frame, OverlaySettings, PixelCounts, Renderer, Slot};
use isolith::scene::{MaterialId, Node, NodeKind, Object, Scene, Shape};
use isolith::wgsl::Options;

use crate::gpu::{BenchScene, shared};

/// Width and height of the pictures, in pixels: not a multiple of a tile's.
const SIDE: u32 = 90;

/// A blended crowd, which has tapes.
fn crowd() -> BenchScene {
    BenchScene::new("crowd", &gallery::crowd(150, true, 2), None)
}

/// A ball and a stretched one, whose field is flatter, with background between them.
fn balls() -> BenchScene {
    let mut scene = Scene::new();
    for (x, scale) in [(-1.0, DVec3::ONE), (1.0, DVec3::new(1.0, 0.4, 1.0))] {
        let object = Object { shape: Shape::Sphere { radius: 0.5 }, material: MaterialId(1) };
        let mut node = Node::new("ball", NodeKind::Object(object)).at(DVec3::new(x, 0.0, 0.0));
        node.transform.scale = scale;
        scene.insert(None, usize::MAX, node).expect("the scene has room");
    }
    let mut bench_scene = BenchScene::new("balls", &scene, None);
    bench_scene.camera = Camera::looking_at(DVec3::new(0.0, 0.3, 5.0), DVec3::ZERO, 0.7);
    bench_scene
}

fn renderer(counting: bool) -> Renderer {
    let gpu = shared().gpu.clone();
    let options = Options { counting, ..Renderer::options(&gpu) };
    let mut renderer = Renderer::with_options(&gpu, options).expect("a renderer");
    renderer.set_strategy(EvalStrategy::Tape);
    renderer
}

/// Draws the bench_scene in this view mode.
fn draw(renderer: &mut Renderer, bench_scene: &BenchScene, view_mode: ViewMode) -> (Frame, GBuffer) {
    let BenchScene { flat, meshes, camera, .. } = bench_scene;
    let overlay = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, flat, meshes, camera, [SIDE, SIDE], overlay).expect("a frame");
    renderer.debug_view(&mut frame, view_mode, flat, &depth_range(bench_scene)).expect("a view mode");
    renderer.advance(&mut frame, std::time::Duration::MAX).expect("a picture");
    let buffers = renderer.read(&frame).expect("buffers");
    (frame, buffers)
}

fn depth_range(bench_scene: &BenchScene) -> DepthRange {
    DepthRange::of(&bench_scene.flat.content(&bench_scene.meshes), bench_scene.camera.position)
}

#[test]
fn without_counting_there_is_no_room_for_counts_and_with_it_the_same_picture() {
    let bench_scene = crowd();
    let (mut plain, mut counting) = (renderer(false), renderer(true));
    let (frame, picture) = draw(&mut plain, &bench_scene, ViewMode::Shaded);
    let (_, counted) = draw(&mut counting, &bench_scene, ViewMode::Shaded);
    assert!(picture == counted, "counting changes the picture");
    assert_eq!(plain.uploaded(), counting.uploaded());
    assert_eq!(plain.pixel_counts(&frame).expect("counts").pixels, []);
    let pixels = u64::from(SIDE * SIDE);
    assert!(plain.counts_bytes() < pixels, "{} bytes", plain.counts_bytes());
    assert!(counting.counts_bytes() > pixels * 16, "{} bytes", counting.counts_bytes());
}

#[test]
fn pixels_and_tiles_add_up_to_components() {
    for bench_scene in [crowd(), balls()] {
        let mut renderer = renderer(true);
        // Draw twice: the renderer must forget the counts of the first picture.
        draw(&mut renderer, &bench_scene, ViewMode::Shaded);
        let (frame, _) = draw(&mut renderer, &bench_scene, ViewMode::Shaded);
        let (counts, pixels) =
            (renderer.counts(&frame).expect("counts"), renderer.pixel_counts(&frame).expect("counts"));
        let PixelCounts { pixels: rays, tiles: cones, .. } = &pixels;
        let side = SIDE.div_ceil(8);
        assert_eq!((rays.len(), cones.len()), ((SIDE * SIDE) as usize, (side * side) as usize));
        let sum = |of: &dyn Fn(&isolith::render::TraceCounts) -> u32, both: bool| -> u64 {
            let cones = cones.iter().filter(|_| both);
            rays.iter().chain(cones).map(|counted| u64::from(of(counted))).sum()
        };
        assert_eq!(sum(&|t| t.evaluations, false), counts.steps, "{}", bench_scene.name);
        assert_eq!(sum(&|t| t.evaluations, true), counts.of_components.iter().sum::<u64>(), "{}", bench_scene.name);
        assert_eq!(sum(&|t| t.rays, true), counts.rays, "{}", bench_scene.name);
        assert_eq!(sum(&|t| t.cells, true), counts.cells.iter().sum::<u64>(), "{}", bench_scene.name);
        assert_eq!(sum(&|t| t.entries, true), counts.entries.iter().sum::<u64>(), "{}", bench_scene.name);
        assert!(counts.steps > 0 && counts.rays > 0 && pixels.steps().max >= pixels.steps().p99);
        let mean = counts.steps as f64 / f64::from(SIDE * SIDE);
        assert!((pixels.steps().mean - mean).abs() < 1e-9);
        if bench_scene.name == "crowd" {
            // At least one cell per evaluation.
            assert!(sum(&|t| t.cells, true) >= sum(&|t| t.evaluations, true) && counts.entries[0] > 0);
        }
    }
}

/// The color of a pixel, from 0 to 1.
fn color(buffers: &GBuffer, at: usize) -> Vec3 {
    let [r, g, b, a] = buffers.color[at];
    assert_eq!(a, 255);
    Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0
}

/// Asserts that every pixel has the color that `expected` gives, to within one step of 8 bits and the rounding of
/// logarithms.
fn assert_colors(buffers: &GBuffer, what: &str, expected: impl Fn(usize) -> Option<Vec3>) {
    for at in 0..buffers.color.len() {
        let Some(expected) = expected(at) else { continue };
        let apart = (color(buffers, at) - expected).abs().max_element();
        assert!(apart <= 1.5 / 255.0, "{what}, pixel {at}: {} instead of {expected}", color(buffers, at));
    }
}

#[test]
fn view_modes_that_count_show_the_counts() {
    for bench_scene in [crowd(), balls()] {
        let mut renderer = renderer(true);
        for view_mode in ViewMode::ALL.into_iter().filter(|view_mode| view_mode.counts()) {
            let (frame, buffers) = draw(&mut renderer, &bench_scene, view_mode);
            let counts = renderer.pixel_counts(&frame).expect("counts");
            assert_colors(&buffers, view_mode.name(), |at| {
                let (x, y) = (at as u32 % SIDE, at as u32 / SIDE);
                let count = match view_mode {
                    ViewMode::Steps => f64::from(counts.pixels[at].evaluations),
                    ViewMode::Evaluations => counts.with_cones(x, y, |t| t.evaluations),
                    ViewMode::Cells => counts.with_cones(x, y, |t| t.cells),
                    _ => counts.with_cones(x, y, |t| t.entries),
                };
                Some(debug_view_count(count as f32, view_mode.top()))
            });
            if bench_scene.name == "balls" {
                assert_eq!(counts.pixels[0].evaluations, 0, "the background in the corner takes nothing");
            }
        }
    }
}

#[test]
fn what_is_found_is_shown_as_the_cpu_says() {
    let bench_scene = balls();
    let mut renderer = renderer(false);
    let depth_range = depth_range(&bench_scene);
    for view_mode in ViewMode::ALL.into_iter().filter(|view_mode| !view_mode.counts() && *view_mode != ViewMode::Shaded)
    {
        let (_, buffers) = draw(&mut renderer, &bench_scene, view_mode);
        let hits = (0..buffers.depth.len()).filter(|at| buffers.depth[*at].is_finite()).count();
        assert!(hits > 300 && hits < buffers.depth.len() / 2, "{hits} pixels show something");
        let facing = |at: usize| {
            let pixel = glam::DVec2::new((at as u32 % SIDE) as f64 + 0.5, (at as u32 / SIDE) as f64 + 0.5);
            let ray = bench_scene.camera.ray(pixel, glam::DVec2::splat(f64::from(SIDE)));
            Vec3::from(buffers.normal[at]).dot(ray.direction.as_vec3()).abs()
        };
        assert_colors(&buffers, view_mode.name(), |at| {
            let HitTarget::Leaf(leaf) = buffers.hit_target(at) else { return Some(DEBUG_VIEW_NOTHING) };
            let of_id = |id: isolith::scene::NodeId| Vec3::from(id_color(id.0).map(|v| f32::from(v) / 255.0));
            match view_mode {
                ViewMode::Normals => Some(debug_view_normal(buffers.normal[at].into())),
                ViewMode::Distance => {
                    let share =
                        (buffers.depth[at] - depth_range.bottom as f32) / (depth_range.top - depth_range.bottom) as f32;
                    let plain = debug_view_distance(share);
                    let is_line = (color(&buffers, at) - plain * 0.5).abs().max_element() < 1.5 / 255.0;
                    Some(if is_line { plain * 0.5 } else { plain })
                }
                // Nothing blends between the two balls: the leaf is the component's first entry.
                ViewMode::Nodes | ViewMode::Components => {
                    Some(debug_view_lit(of_id(bench_scene.flat.ids[leaf]), facing(at)))
                }
                _ if leaf == 0 => Some(debug_view_lit(debug_view_slope(1.0), facing(at))),
                _ => None,
            }
        });
        if view_mode == ViewMode::Slope {
            let flat = (0..buffers.color.len()).filter(|at| buffers.hit_target(*at) == HitTarget::Leaf(1));
            assert!(flat.clone().count() > 100);
            for at in flat {
                let shown = color(&buffers, at);
                assert!(shown.x <= shown.z + 0.03, "no slope of a stretched ball is above 1: {shown} at {at}");
            }
        }
    }
}

#[test]
fn lines_of_equal_distance_are_drawn() {
    let bench_scene = balls();
    let (_, buffers) = draw(&mut renderer(false), &bench_scene, ViewMode::Distance);
    let dark = |at: &usize| {
        buffers.depth[*at].is_finite() && {
            let depth_range = depth_range(&bench_scene);
            let share =
                (buffers.depth[*at] - depth_range.bottom as f32) / (depth_range.top - depth_range.bottom) as f32;
            (color(&buffers, *at) - debug_view_distance(share) * 0.5).abs().max_element() < 1.5 / 255.0
        }
    };
    let lines = (0..buffers.depth.len()).filter(dark).count();
    let seen = buffers.depth.iter().filter(|depth| depth.is_finite()).count();
    assert!(lines > 20 && lines < seen / 2, "{lines} of {seen}");
}
