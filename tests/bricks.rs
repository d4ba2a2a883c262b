//! Distance bricks of meshes: against the distances and winding numbers of the triangles themselves.

#![allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]

mod baked;
mod budget;
mod detail;
mod exact;
mod looks;
mod making;
mod shapes;

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use isolith::bricks::{
    BAND, BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, BrickContent, Bricks, COARSER, CodecError, DETAIL, SAMPLE_REACH,
    from_bytes, to_bytes,
};
use isolith::mesh::{bricks_key, bricks_of, voxel_for, voxelized};
use shapes::{Soup, ten};

/// Numbers from 0 to 1, always the same.
pub struct Dice(u64);

impl Dice {
    pub fn next(&mut self) -> f64 {
        // SplitMix64 (Steele, Lea and Flood, 2014).
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ z >> 31) as f64 / u64::MAX as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f64) as usize).min(n - 1)
    }
}

fn made(soup: &Soup, resolution: f64) -> Bricks {
    let mesh = soup.mesh();
    bricks_of(&mesh, voxel_for(&mesh.bounds, resolution), &mut |_| true).unwrap()
}

/// The same with all coarser levels, and without what those tell.
fn levels(soup: &Soup, resolution: f64) -> Arc<Bricks> {
    let mesh = soup.mesh();
    voxelized(&mesh, voxel_for(&mesh.bounds, resolution), &mut |_| true).unwrap().bricks
}

/// Points on the surface of the solid: on triangles with the solid on one side only.
fn on_surface(soup: &Soup, count: usize, dice: &mut Dice) -> Vec<DVec3> {
    let corners: Vec<_> = soup.corners().collect();
    let area = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).length();
    let mut sums = vec![0.0];
    corners.iter().for_each(|corners| sums.push(sums[sums.len() - 1] + area(corners)));
    let mut out = Vec::new();
    while out.len() < count {
        let at = dice.next() * sums[corners.len()];
        let [a, b, c] = corners[(sums.partition_point(|sum| *sum <= at) - 1).min(corners.len() - 1)];
        let (root, v) = (dice.next().sqrt(), dice.next());
        let p = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
        let beside = (b - a).cross(c - a).normalize() * 1e-4;
        if soup.is_inside(p - beside) != soup.is_inside(p + beside) {
            out.push(p);
        }
    }
    out
}

/// The errors at the shares 0.5, 0.99 and 1 of them, in voxels.
fn errors(bricks: &Bricks, points: &[DVec3]) -> [f64; 3] {
    let error = |p: &DVec3| bricks.interpolated(*p).map_or(f64::INFINITY, |d| d.abs() / bricks.voxel());
    let mut all: Vec<f64> = points.iter().map(error).collect();
    all.sort_by(f64::total_cmp);
    [0.5, 0.99, 1.0].map(|share| all[((all.len() - 1) as f64 * share) as usize])
}

/// What the bricks say of a point: the distance, or a bound of it with the same sign.
fn said(bricks: &Bricks, p: DVec3) -> f64 {
    let voxel = ((p - bricks.origin()) / bricks.voxel()).floor().to_array().map(|v| v as u32);
    match bricks.content(voxel.map(|n| n / BRICK_VOXELS)).unwrap() {
        BrickContent::Empty { is_inside: true } => -BAND * bricks.voxel(),
        BrickContent::Empty { .. } => BAND * bricks.voxel(),
        BrickContent::Samples(_) | BrickContent::Coarser => bricks.interpolated(p).unwrap(),
    }
}

fn all_bricks(bricks: &Bricks) -> impl Iterator<Item = [u32; 3]> {
    let [nx, ny, nz] = bricks.grid.bricks();
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

fn near(bricks: &Bricks) -> Vec<([u32; 3], Box<[u8; BRICK_VOLUME]>)> {
    let samples = |brick| match bricks.content(brick) {
        Some(BrickContent::Samples(samples)) => Some((brick, samples)),
        _ => None,
    };
    all_bricks(bricks).filter_map(samples).collect()
}

#[test]
fn the_surface_of_bricks_is_that_of_the_mesh() {
    let mut dice = Dice(1);
    let is_measured = std::env::var_os("ISOLITH_MEASURE_BRICKS").is_some();
    let resolutions: &[f64] = if is_measured { &[128.0, 256.0, 512.0] } else { &[128.0, 256.0] };
    for (name, soup, is_smooth) in ten() {
        let points = on_surface(&soup, 200, &mut dice);
        for &resolution in resolutions {
            let [middle, most, worst] = errors(&levels(&soup, resolution), &points);
            let told = format!("{name} at {resolution}: p50 {middle:.4}, p99 {most:.4}, max {worst:.4} voxels");
            println!("{told}");
            // Edges are rounded by less than half the diagonal of a voxel.
            assert!(middle < DETAIL && worst < 0.87, "{told}");
            assert!(!is_smooth || most < if resolution > 200.0 { 0.1 } else { 0.15 }, "{told}");
        }
    }
}

#[test]
fn signs_are_those_of_the_winding_number() {
    let mut dice = Dice(2);
    for (name, soup, _) in ten() {
        let bricks = made(&soup, 128.0);
        let grid = bricks.grid.bounds();
        let (mut inside, mut checked) = (0, 0);
        for round in 0..400 {
            // Half of them near the surface.
            let somewhere = grid.min + (grid.max - grid.min) * dice.point();
            let corner = soup.points[dice.below(soup.points.len())];
            let p = if round % 2 == 0 { somewhere } else { corner + (dice.point() - 0.5) * 8.0 * bricks.voxel() };
            let p = p.clamp(grid.min, grid.max - 0.01 * bricks.voxel());
            if soup.distance(p) < bricks.voxel() || (soup.winding(p).abs() - 0.5).abs() < 0.02 {
                continue;
            }
            let is_inside = soup.is_inside(p);
            assert_eq!(said(&bricks, p) < 0.0, is_inside, "{name}: {p} of winding number {}", soup.winding(p));
            (inside, checked) = (inside + usize::from(is_inside), checked + 1);
        }
        assert!(checked > 150 && (inside > 10 || name == "plate"), "{name}: {inside} of {checked}");
    }
}

#[test]
fn neighbors_share_their_faces_and_no_slope_is_steeper_than_told() {
    for (name, soup, _) in ten() {
        let bricks = made(&soup, 64.0);
        let (all, slope) = (near(&bricks), bricks.slope());
        assert!(!all.is_empty() && (1.0..1.9).contains(&slope), "{name}: {slope}");
        let known: HashMap<[u32; 3], &[u8; BRICK_VOLUME]> = all.iter().map(|(brick, own)| (*brick, &**own)).collect();
        for (brick, samples) in &all {
            assert!(BrickContent::slope(samples) <= slope + 1e-9, "{name}: {brick:?}");
            // Neighbors on the right share their first samples.
            let Some(theirs) = known.get(&[brick[0] + 1, brick[1], brick[2]]) else { continue };
            let face = |of: &[u8; BRICK_VOLUME], x: usize| -> Vec<u8> {
                of.iter().skip(x).step_by(BRICK_SAMPLES).copied().collect()
            };
            assert_eq!(face(samples, BRICK_SAMPLES - 1), face(theirs, 0), "{name}: {brick:?}");
        }
    }
}

/// Distances at points of bricks: with samples within the slope, the others at least as far as the band.
#[test]
fn what_bricks_say_is_a_lower_bound() {
    let mut dice = Dice(3);
    for (name, soup, _) in ten() {
        let bricks = made(&soup, 64.0);
        let (voxel, slope) = (bricks.voxel(), bricks.slope());
        let (mut far_ones, mut near_ones) = (0, 0);
        let all: Vec<_> = all_bricks(&bricks).filter_map(|brick| Some((brick, bricks.content(brick)?))).collect();
        for _ in 0..300 {
            let (brick, content) = &all[dice.below(all.len())];
            let first = brick.map(|n| n * BRICK_VOXELS);
            let p = bricks.grid.sample(first) + dice.point() * f64::from(BRICK_VOXELS) * voxel;
            let exact = soup.distance(p) / voxel;
            match content {
                BrickContent::Empty { .. } => {
                    far_ones += 1;
                    assert!(exact >= BAND - 1e-3, "{name}: {exact} at {p}");
                }
                BrickContent::Samples(_) => {
                    near_ones += 1;
                    let value = bricks.interpolated(p).unwrap() / voxel;
                    assert!(value.is_finite() && value.abs() <= SAMPLE_REACH);
                    // Where nothing is closed or hidden the triangles are the surface.
                    if !["open", "crossing"].contains(&name) {
                        assert!(value.abs() / slope <= exact + 0.9, "{name}: {value} for {exact} at {p}");
                    }
                }
                BrickContent::Coarser => unreachable!("there is no coarser level"),
            }
        }
        let has_far_ones = far_ones > 10 || ["plate", "box"].contains(&name);
        assert!(has_far_ones && near_ones > 30, "{name}: {far_ones} and {near_ones}");
    }
}

#[test]
fn bricks_without_samples_lie_on_their_side_and_far_from_the_surface() {
    let mut dice = Dice(4);
    for (name, soup, _) in ten() {
        let bricks = made(&soup, 96.0);
        for _ in 0..60 {
            let brick = bricks.grid.bricks().map(|n| dice.below(n as usize) as u32);
            let Some(BrickContent::Empty { is_inside }) = bricks.content(brick) else { continue };
            let inner = dice.point() * f64::from(BRICK_VOXELS) * bricks.voxel();
            let p = bricks.grid.sample(brick.map(|n| n * BRICK_VOXELS)) + inner;
            let exact = soup.distance(p);
            assert!(exact >= (BAND - 0.5) * bricks.voxel(), "{name}: {exact} at {p}");
            assert!(name == "open" || is_inside == soup.is_inside(p), "{name}: {p}");
        }
    }
}

/// Samples hold the distance from the triangles to half a step.
#[test]
fn samples_are_the_distances_of_the_triangles() {
    let mut dice = Dice(5);
    // Where nothing is closed, hidden or thin the triangles are the surface.
    let plain = ten().into_iter().filter(|(name, ..)| !["open", "crossing", "plate"].contains(name));
    for (name, soup, _) in plain {
        let bricks = made(&soup, 64.0);
        let all = near(&bricks);
        let mut worst = 0.0_f64;
        for _ in 0..500 {
            let (brick, samples) = &all[dice.below(all.len())];
            let i = dice.below(BRICK_VOLUME);
            let own = [i % BRICK_SAMPLES, i / BRICK_SAMPLES % BRICK_SAMPLES, i / (BRICK_SAMPLES * BRICK_SAMPLES)];
            let p = bricks.grid.sample([0, 1, 2].map(|a| brick[a] * BRICK_VOXELS + own[a] as u32));
            let exact = (soup.distance(p) / bricks.voxel()).min(SAMPLE_REACH);
            let held = BrickContent::sample_voxels(samples[i]).abs();
            // A sample of less than a voxel whose neighbors lie on the same side holds a voxel.
            let is_raised = exact < 1.0 && held == 1.0;
            worst = worst.max(if is_raised { 0.0 } else { (held - exact).abs() });
        }
        // The greatest is one step less than the reach.
        assert!(worst < 0.033, "{name}: {worst:?}");
    }
}

/// Numbers for the report: bytes and seconds. In the suite for two meshes at resolutions that take no time; for the one
/// that `ISOLITH_MEASURE_BRICKS` names, or for `all`, at all.
#[test]
fn bricks_take_few_bytes_and_little_time() {
    let wanted = std::env::var("ISOLITH_MEASURE_BRICKS").ok();
    let is_wanted = |name: &str| wanted.as_ref().is_some_and(|wanted| wanted == "all" || wanted == name);
    let resolutions: &[f64] = if wanted.is_some() { &[128.0, 256.0, 512.0] } else { &[128.0, 256.0] };
    let mut meshes: Vec<(&str, Soup)> = ten().into_iter().map(|(name, soup, _)| (name, soup)).collect();
    if is_wanted("million") {
        meshes.push(("million", Soup::knot(354)));
    }
    let usual = |name: &str| wanted.is_none() && ["knot", "open"].contains(&name);
    for (name, soup) in meshes.into_iter().filter(|(name, _)| is_wanted(name) || usual(name)) {
        let mesh = soup.mesh();
        for &resolution in resolutions {
            let voxel = voxel_for(&mesh.bounds, resolution);
            let started = std::time::Instant::now();
            let bricks = voxelized(&mesh, voxel, &mut |_| true).unwrap().bricks;
            let seconds = started.elapsed().as_secs_f64();
            let area: f64 = soup.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
            let all = bricks.levels().map(|level| level.bytes()).sum::<usize>();
            let bytes = all as f64 / (area / (voxel * voxel));
            let counts: Vec<usize> = bricks.levels().map(|level| level.count()).collect();
            println!(
                "| {name} | {} | {resolution} | {counts:?} | {:.2} | {bytes:.1} | {seconds:.2} |",
                mesh.triangle_count(),
                all as f64 / f64::from(1 << 20),
            );
            assert!(bytes < 36.0, "{name}: {bytes} bytes for each square voxel");
            assert!(seconds < 30.0 || wanted.is_some(), "{name}: {seconds} s");
        }
    }
}

/// Ranges of shares that a progress may report.
const SHARES: Range<f32> = 0.0..1.000_1;

/// Looks are those of the mesh, at any point of its surface.
#[test]
fn looks_are_those_of_the_mesh() {
    let mut dice = Dice(6);
    let ball = Soup::sphere(64, 1.0);
    for soup in [ball.clone(), ball.inverted()] {
        // Without a material there is nothing to keep.
        assert!(made(&soup, 64.0).looks.is_none());
        let mut mesh = soup.mesh();
        for part in &mut mesh.parts {
            (part.surface.color, part.surface.metalness) = ([0.5, 0.25, 0.125, 1.0], 0.4);
            (part.surface.roughness, part.surface.emission) = (0.3, [1.0, 0.5, 0.25]);
        }
        let bricks = bricks_of(&mesh, voxel_for(&mesh.bounds, 64.0), &mut |_| true).unwrap();
        let looks = bricks.looks.as_ref().unwrap();
        assert!(bricks.check().is_ok() && looks.bytes() < 4 * bricks.bytes());
        for p in on_surface(&soup, 200, &mut dice) {
            let look = bricks.looks_at(p);
            // The color is that of the light where that is brighter.
            let off = |found: DVec3, meant: f64| (found - meant * DVec3::new(1.0, 0.5, 0.25)).abs().max_element();
            assert!((look.share - 1.0).abs() < 1e-9 && look.bend == DVec3::ZERO, "{look:?}");
            assert!(off(look.color, 1.0) < 0.005 && off(look.emission, 1.0) < 0.03, "{look:?}");
            assert!((look.metalness - 0.4).abs() < 0.034 && (look.roughness - 0.3).abs() < 0.008, "{look:?}");
        }
        assert!(bricks.looks_at(DVec3::ZERO).share == 0.0 && bricks.looks_at(DVec3::NAN).share == 0.0);
    }
}

#[test]
fn bricks_survive_as_bytes() {
    let mut mesh = Soup::torus(16).mesh();
    mesh.parts[0].surface.metalness = 0.0;
    let bricks = Bricks::clone(&voxelized(&mesh, 0.05, &mut |_| true).unwrap().bricks);
    let key = bricks_key(&mesh, 0.05);
    let bytes = to_bytes(&bricks, key);
    assert!(from_bytes(&bytes, key).unwrap() == bricks);
    let others = [bricks_key(&mesh, 0.051), bricks_key(&Soup::torus(17).mesh(), 0.05)];
    assert!(others.iter().all(|other| from_bytes(&bytes, *other) == Err(CodecError::Stale)));
    // Whatever a maker of such bytes writes: no place is outside.
    let broken = |change: &dyn Fn(&mut Bricks)| {
        let mut bricks = bricks.clone();
        change(&mut bricks);
        from_bytes(&to_bytes(&bricks, key), key).unwrap_err()
    };
    let entries = bricks.grid.cell_count().div_ceil(4);
    let changes: [&dyn Fn(&mut Bricks); 9] = [
        &|b| b.texels[0][0] = 1 << 20,
        &|b| b.texels[entries].fill(u32::MAX),
        &|b| b.first_brick += 1,
        &|b| b.first_brick = u32::MAX,
        &|b| b.grid.cells = [u32::MAX; 3],
        &|b| b.grid.voxel = f64::NAN,
        &|b| b.looks.as_mut().unwrap().texels[6][0] = u32::MAX,
        &|b| b.texels[0][0] = COARSER - 1,
        &|b| b.coarser = Some(Arc::new(Bricks { coarser: None, ..b.clone() })),
    ];
    for (i, change) in changes.into_iter().enumerate() {
        assert!(matches!(broken(change), CodecError::Inconsistent(_)), "change {i}");
    }
}
