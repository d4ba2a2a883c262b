//! Copies up to the horizon: what a walk looks at, and how little two neighboring frames differ.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use isolith::field::copies::{
    CopyCone, FlatInstancer, WalkCounts, copies_along, copies_along_every_cell, copy_of_cell, copy_sphere,
};
use isolith::field::pick::{self, PickedCopy};
use isolith::field::{RayLimits, flatten};
use isolith::geometry::{Camera, Ray};
use isolith::render::EvalStrategy;
use isolith::scene::{
    Attachment, CurvePreset, DynamicKind, Instancer, Lattice, Mask, MaskJoin, MaskSlot, Scene, TextureImage,
};

use crate::copies::{scene_of, varied};
use crate::gpu::{BenchScene, scenes};

/// Lattices whose masks leave large parts empty.
fn masked() -> Vec<(&'static str, Scene)> {
    let noise = |threshold| Mask::Noise { size: 200.0, threshold, softness: 0.1, seed: 5 };
    let of = |counts: [u32; 3], masks: Vec<MaskSlot>, dynamics: &[DynamicKind]| {
        let lattice = Lattice::Grid { counts, spacing: [1.5, 1.8, 1.4] };
        let copies =
            Instancer { lattice, variation: varied(), probability: 0.8, seed: 3, masks, ..Instancer::default() };
        scene_of(copies, dynamics)
    };
    let inverted = |mask| MaskSlot { inverted: true, ..MaskSlot::from(mask) };
    let ring =
        vec![Mask::Radius { inner: 60.0, outer: 70.0 }.into(), inverted(Mask::Radius { inner: 40.0, outer: 50.0 })];
    let hexagonal = Lattice::Hexagonal { counts: [0, 1, 0], spacing: 1.3, height: 1.0 };
    let hexagonal = Instancer { lattice: hexagonal, seed: 8, masks: vec![noise(0.7).into()], ..Instancer::default() };
    vec![
        ("meadow", of([0, 1, 0], vec![noise(0.65).into()], &[])),
        ("holes", of([0, 1, 0], vec![inverted(noise(0.35))], &[DynamicKind::CurlNoise])),
        ("ring", of([0, 3, 0], ring, &[])),
        ("floors", of([0, 0, 0], vec![inverted(Mask::Height { from: -9.0, to: 30.0, softness: 3.0 })], &[])),
        ("hexagonal", scene_of(hexagonal, &[])),
        ("joined", of([0, 1, 0], joined(), &[])),
    ]
}

/// Masks with curves and an image that leave much empty together, none of them alone.
fn joined() -> Vec<MaskSlot> {
    let image = Attachment::<TextureImage>::painted("disc.png", [16, 16], |x, y| {
        let off = |v: u32| f64::from(v) - 7.5;
        [if off(x).hypot(off(y)) < 7.0 { 255 } else { 0 }; 3]
    });
    let image = Mask::Image { image, width: 90.0, length: 70.0, offset: [20.0, 0.0, -30.0], tiled: false };
    let noise = Mask::Noise { size: 60.0, threshold: 0.5, softness: 0.6, seed: 5 };
    let steep = MaskSlot { join: MaskJoin::Add, curve: CurvePreset::Step.curve(), ..MaskSlot::from(noise) };
    let hole = Mask::Radius { inner: 5.0, outer: 8.0 };
    vec![image.into(), steep, MaskSlot { join: MaskJoin::Subtract, ..MaskSlot::from(hole) }]
}

/// Some numbers from 0 to 1 that fill the interval evenly.
fn spread(i: u32, by: f64) -> f64 {
    (f64::from(i) * by).fract()
}

/// The copies that a walk visits, as cells, and its work.
fn visited(every: bool, instancer: &FlatInstancer, cone: CopyCone) -> (Vec<[i32; 3]>, WalkCounts) {
    let mut cells = Vec::new();
    let walk = if every { copies_along_every_cell } else { copies_along };
    let counts = walk(instancer, cone, &mut |visit, _| {
        cells.push(visit.copy.cell);
        ControlFlow::Continue(())
    });
    (cells, counts)
}

#[test]
fn walks_past_empty_blocks_visit_the_same_copies() {
    let mut sum = [0; 3];
    for (name, scene) in masked() {
        let flat = flatten(&scene, 1.7).expect("within the limits");
        let instancer = &flat.instancers[0];
        let (mut all, mut few, mut met) = (0, 0, 0);
        for i in 0..300 {
            let [a, b, c, d] = [0.618_034, 0.414_214, 0.732_051, 0.236_068].map(|by| spread(i, by) - 0.5);
            let origin = DVec3::new(160.0 * a, 6.0 * d, 160.0 * b);
            let direction = DVec3::new(c, 0.03 * a, d + 0.2).normalize();
            let spread = if i % 3 == 0 { 0.01 } else { 0.0 };
            let limits = RayLimits { near: 0.0, far: 400.0 };
            let cone = CopyCone { axis: Ray { origin, direction }, limits, spread };
            let (every, work) = visited(true, instancer, cone);
            let (quick, less) = visited(false, instancer, cone);
            assert_eq!(quick, every, "{name}: ray {i}");
            all += work.cells;
            few += less.cells + less.blocks;
            met += every.len();
        }
        println!("{name}: {few} of {all} cells and blocks, {met} copies met");
        // Blocks that are tried in vain.
        assert!(few * 100 <= all * 115, "{name}: {few} of {all}");
        sum = [sum[0] + few, sum[1] + all, sum[2] + met as u64];
    }
    assert!(sum[0] * 10 < sum[1] * 9 && sum[2] > 200, "{sum:?}");
}

/// Where copies stand at rest tells most of those that a ray cannot meet, before they are sized, turned and moved.
#[test]
fn copies_that_no_ray_can_meet_are_not_moved() {
    let all = [DynamicKind::Wind, DynamicKind::Orbit, DynamicKind::Pulse, DynamicKind::FractionalBrownianMotion];
    let lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [0.5; 3] };
    let copies = Instancer { lattice, variation: varied(), probability: 0.9, seed: 3, ..Instancer::default() };
    let flat = flatten(&scene_of(copies, &all), 1.7).expect("within the limits");
    let instancer = &flat.instancers[0];
    let half = FlatInstancer { reach_at_rest: 0.5 * instancer.reach_at_rest, ..instancer.clone() };
    let (mut moved, mut there, mut lost) = (0, 0, 0);
    for i in 0..200 {
        let [a, b, c, d] = [0.618_034, 0.414_214, 0.732_051, 0.236_068].map(|by| spread(i, by) - 0.5);
        let direction = DVec3::new(c, 0.1 * a, d + 0.2).normalize();
        let axis = Ray { origin: DVec3::new(20.0 * a, 1.0 + 2.0 * d, 20.0 * b), direction };
        let limits = RayLimits { near: 0.0, far: 40.0 };
        let cone = CopyCone { axis, limits, spread: if i % 3 == 0 { 0.01 } else { 0.0 } };
        let (every, _) = visited(true, instancer, cone);
        let (quick, work) = visited(false, instancer, cone);
        assert_eq!(quick, every, "ray {i}");
        lost += every.len() - visited(false, &half, cone).0.len();
        (moved, there) = (moved + work.moved, there + work.copies);
    }
    println!("{moved} of {there} copies moved; half of the reach loses {lost}");
    assert!(moved * 4 < there * 3 && lost > 50, "{moved} of {there}, {lost} lost");
}

/// What the rays of a camera's picture look at, up to the first sphere that they meet, per pixel.
fn work_per_pixel(scene: &BenchScene, every: bool) -> [f64; 5] {
    const SIZE: [u32; 2] = [96, 54];
    let size = DVec2::new(SIZE[0].into(), SIZE[1].into());
    let mut sum = [0; 5];
    for at in 0..SIZE[0] * SIZE[1] {
        let pixel = DVec2::new(f64::from(at % SIZE[0]) + 0.5, f64::from(at / SIZE[0]) + 0.5);
        let ray = scene.camera.ray(pixel, size);
        for instancer in &scene.flat.instancers {
            let from_world = instancer.world_from_local.inverse();
            let axis = Ray {
                origin: from_world.transform_point3(ray.origin),
                direction: from_world.transform_vector3(ray.direction),
            };
            let limits = RayLimits { near: scene.camera.near, far: scene.camera.far };
            let cone = CopyCone { axis, limits, spread: 0.0 };
            let walk = if every { copies_along_every_cell } else { copies_along };
            // A copy fills about half of its sphere: every second one that is met ends the way.
            let mut met = 0;
            let work = walk(instancer, cone, &mut |_, _| {
                met += 1;
                if met == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            for (sum, more) in sum.iter_mut().zip([work.blocks, work.cells, work.copies, work.met, work.moved]) {
                *sum += more;
            }
        }
    }
    sum.map(|sum| sum as f64 / f64::from(SIZE[0] * SIZE[1]))
}

/// Where masks leave no block empty, trying them costs little.
#[test]
fn shipped_scenes_look_at_no_more_cells_than_before() {
    for scene in scenes().filter(|scene| !scene.flat.instancers.is_empty()) {
        let [before, after] = [true, false].map(|every| work_per_pixel(&scene, every));
        println!("{}: blocks, cells, copies, met, moved per pixel: {before:.2?} before, {after:.2?}", scene.name);
        assert!(after[3] == before[3] && after[2] <= before[2] && after[4] <= before[4], "{}", scene.name);
        assert!(after[0] + after[1] <= 1.25 * before[1] + 0.5, "{}", scene.name);
    }
}

/// A slow flight over an endless lattice toward the horizon: the camera moves by this much a frame, in meters.
const FLIGHT_STEP: f64 = 0.002;
/// Greatest difference of a channel that is none, of 255.
const FLIGHT_TOLERANCE: u8 = 4;
/// Most pixels that differ by more, beside those at an edge.
const FLIGHT_SHARE: f64 = 0.004;

#[test]
fn neighboring_frames_of_a_flight_to_the_horizon_differ_at_edges_only() {
    const SIDE: u32 = 160;
    let lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [1.5, 1.0, 1.5] };
    let masks = vec![Mask::Noise { size: 20.0, threshold: 0.5, softness: 0.4, seed: 5 }.into()];
    let copies = Instancer { lattice, variation: varied(), masks, probability: 0.9, seed: 5, ..Instancer::default() };
    let mut scene = BenchScene::new("flight", &scene_of(copies, &[]), None);
    let frames: Vec<_> = (0..6)
        .map(|frame| {
            let eye = DVec3::new(0.3, 2.5, 6.0 - FLIGHT_STEP * f64::from(frame));
            scene.camera = Camera { far: 2_000.0, ..Camera::looking_at(eye, eye + DVec3::new(0.1, -0.12, -1.0), 0.8) };
            scene.render(SIDE, EvalStrategy::Tape)
        })
        .collect();
    let hits = frames[0].depth.iter().filter(|depth| depth.is_finite()).count();
    let farthest = frames[0].depth.iter().filter(|depth| depth.is_finite()).fold(0.0, |a: f32, b| a.max(*b));
    assert!(hits > 5_000 && farthest > 300.0, "{hits} hits, up to {farthest} m");
    for pair in frames.windows(2) {
        let side = SIDE as usize;
        // An edge: a neighbor shows something else in either frame.
        let is_edge = |at: usize| {
            let near = [at.wrapping_sub(1), at + 1, at.wrapping_sub(side), at + side];
            let jumps = |depth: &[f32], other: usize| {
                depth.get(other).is_none_or(|there| {
                    (there - depth[at]).abs() > 0.02 * depth[at].min(*there)
                        || there.is_finite() != depth[at].is_finite()
                })
            };
            pair.iter().any(|frame| near.iter().any(|other| jumps(&frame.depth, *other)))
        };
        let differs =
            |at: &usize| (0..3).any(|c| pair[0].color[*at][c].abs_diff(pair[1].color[*at][c]) > FLIGHT_TOLERANCE);
        let other: Vec<usize> = (0..side * side).filter(differs).collect();
        let beside = other.iter().filter(|at| !is_edge(**at)).count();
        println!("{} of {} pixels differ, {beside} of them not at an edge", other.len(), side * side);
        assert!((beside as f64) < FLIGHT_SHARE * (side * side) as f64, "{beside} pixels flicker");
    }
}

#[test]
fn picking_tells_which_copy_of_which_instancer() {
    let lattice = Lattice::Grid { counts: [0, 1, 0], spacing: [4.0; 3] };
    let copies = Instancer { lattice, variation: varied(), probability: 0.7, seed: 3, ..Instancer::default() };
    let flat = flatten(&scene_of(copies, &[]), 0.0).expect("within the limits");
    let instancer = &flat.instancers[0];
    let mut found = 0;
    for cell in (-6..6).flat_map(|x| (-6..6).map(move |z| [x, 0, z])) {
        let Some(copy) = copy_of_cell(instancer, cell) else { continue };
        let (center, _) = copy_sphere(instancer, &copy);
        let center = instancer.world_from_local.transform_point3(center);
        let ray = Ray { origin: center + DVec3::Y * 5.0, direction: DVec3::NEG_Y };
        let picked = pick::pick_copy(&flat, &[], &ray, 1e-3, 1e3).expect("the middle of a copy");
        assert_eq!(picked.copy, Some(PickedCopy { instancer: instancer.id, cell }));
        found += 1;
    }
    assert!(found > 50, "{found} copies");
    let beside = Ray { origin: DVec3::new(2.0, 50.0, 0.0), direction: DVec3::Y };
    assert_eq!(pick::pick_copy(&flat, &[], &beside, 1e-3, 1e3), None);
}
