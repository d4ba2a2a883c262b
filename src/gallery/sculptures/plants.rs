//! A fir, an oak and a tuft of grass. Several closed grids follow each other in one: between the end of one and the start
//! of the next there are only triangles without area.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::strip::Sculpture;

const GOLDEN: f64 = 2.399_963;

/// The needles of a fir of 3.9 meters: tiers that droop, with ragged edges.
pub(super) fn fir() -> Sculpture {
    const AROUND: usize = 96;
    const TIERS: usize = 8;
    const STEPS: usize = 12;
    let mut points = Vec::new();
    let mut row = |radius: f64, height: f64, ragged: f64, tier: usize| {
        for column in 0..AROUND {
            let angle = TAU * column as f64 / AROUND as f64;
            let turned = angle + GOLDEN * tier as f64;
            let branch = (9.0 * turned).sin() + 0.5 * (16.0 * turned + 1.3).sin() + 0.25 * (31.0 * turned).sin();
            let out = radius * (1.0 + 0.17 * ragged * branch);
            let droop = -0.06 * ragged * branch;
            points.push(DVec3::new(out * angle.sin(), height + droop * radius.min(1.0), out * angle.cos()));
        }
    };
    row(0.0, 1.15, 0.0, 0);
    for tier in 0..TIERS {
        let share = tier as f64 / TIERS as f64;
        let (radius, foot) = (1.12 * (1.0 - share).powf(0.85) + 0.06, 0.82 + 2.75 * share);
        let inner = 0.38 * radius;
        // Below: from the trunk out to the tips.
        for step in 0..STEPS / 2 {
            let t = step as f64 / (STEPS / 2) as f64;
            row(inner + (radius - inner) * t, foot + 0.18 * (1.0 - t), t, tier);
        }
        // Above: from the tips back to where the next tier begins.
        let next = 0.38 * (1.12 * (1.0 - share - 1.0 / TIERS as f64).max(0.0).powf(0.85) + 0.06);
        for step in 0..STEPS {
            let t = step as f64 / STEPS as f64;
            row(
                radius + (next - radius) * t,
                foot + 0.62 * t.powf(1.4) * (1.0 - 0.35 * share),
                (1.0 - t).powi(2),
                tier,
            );
        }
    }
    row(0.0, 3.9, 0.0, TIERS);
    Sculpture { name: "Fir", around: AROUND, points, look: ([0.025, 0.085, 0.03], 0.0, 0.75) }
}

/// Trunk and boughs of an oak.
pub(super) fn oak_wood() -> Sculpture {
    const AROUND: usize = 20;
    let mut points = Vec::new();
    tube(
        &mut points,
        AROUND,
        [DVec3::new(0.0, -0.3, 0.0), DVec3::new(0.03, 1.1, 0.02), DVec3::new(0.02, 2.3, 0.0)],
        [0.27, 0.09],
    );
    for bough in 0..7 {
        let angle = GOLDEN * f64::from(bough);
        let out = DVec3::new(angle.sin(), 0.0, angle.cos());
        let from = DVec3::Y * (1.0 + 0.13 * f64::from(bough));
        let reach = 0.95 - 0.07 * f64::from(bough);
        let to = from + out * reach + DVec3::Y * 0.75;
        tube(&mut points, AROUND, [from, from + out * (0.6 * reach) + DVec3::Y * 0.22, to], [0.1, 0.03]);
    }
    Sculpture { name: "Wood", around: AROUND, points, look: ([0.11, 0.065, 0.035], 0.0, 0.85) }
}

/// The leaves of an oak: lobes with a surface of leaves.
pub(super) fn oak_leaves() -> Sculpture {
    const AROUND: usize = 56;
    const ROWS: usize = 36;
    let mut points = Vec::new();
    for lobe in 0..10 {
        let at = f64::from(lobe);
        let angle = GOLDEN * at;
        let out = if lobe == 0 { 0.0 } else { 0.55 + 0.045 * at };
        let middle = DVec3::new(out * angle.sin(), 2.75 - 0.085 * at, out * angle.cos());
        let radius = if lobe == 0 { 0.8 } else { 0.62 - 0.02 * at };
        for row in 0..ROWS {
            let polar = 0.5 * TAU * row as f64 / (ROWS - 1) as f64;
            for column in 0..AROUND {
                let around = TAU * column as f64 / AROUND as f64;
                let is_end = row == 0 || row == ROWS - 1;
                let sine = if is_end { 0.0 } else { polar.sin() };
                let direction = DVec3::new(sine * around.sin(), -polar.cos(), sine * around.cos());
                points.push(middle + direction * DVec3::new(1.0, 0.82, 1.0) * (radius * leafy(direction * radius, at)));
            }
        }
    }
    Sculpture { name: "Leaves", around: AROUND, points, look: ([0.07, 0.16, 0.025], 0.0, 0.7) }
}

/// How far leaves stand out, times the radius: sums of waves that do not repeat.
fn leafy(p: DVec3, seed: f64) -> f64 {
    let wave = |scale: f64, turn: f64| {
        let q = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), turn + seed) * p * scale;
        q.x.sin() * q.y.sin() + q.y.cos() * q.z.sin() + q.z.cos() * q.x.cos()
    };
    1.0 + 0.09 * wave(6.0, 0.0) + 0.05 * wave(13.0, 1.0) + 0.035 * wave(27.0, 2.0)
}

/// A tuft of bent blades of grass, 0.36 meters high.
pub(super) fn tuft() -> Sculpture {
    const AROUND: usize = 8;
    const ROWS: usize = 10;
    let mut points = Vec::new();
    for blade in 0..22 {
        let at = f64::from(blade);
        let angle = GOLDEN * at;
        let (out, side) = (DVec3::new(angle.sin(), 0.0, angle.cos()), DVec3::new(angle.cos(), 0.0, -angle.sin()));
        let foot = out * (0.012 * at.sqrt());
        let height = 0.36 - 0.1 * (at * 0.618).fract();
        let bend = 0.08 + 0.16 * (at * 0.382).fract();
        for row in 0..ROWS {
            let t = row as f64 / (ROWS - 1) as f64;
            let middle = foot + DVec3::Y * (height * (t - 0.25 * t * t) - 0.04) + out * (bend * t * t);
            let is_end = row == 0 || row == ROWS - 1;
            let width = if is_end { 0.0 } else { 0.012 * (1.0 - t).powf(0.6) + 0.002 };
            for column in 0..AROUND {
                let around = TAU * column as f64 / AROUND as f64;
                points.push(middle + side * (width * around.sin()) + out * (0.45 * width * around.cos()));
            }
        }
    }
    Sculpture { name: "Tuft", around: AROUND, points, look: ([0.14, 0.24, 0.05], 0.0, 0.6) }
}

/// A tube along a bent line that gets thinner, closed at both ends.
fn tube(points: &mut Vec<DVec3>, around: usize, [a, b, c]: [DVec3; 3], [thick, thin]: [f64; 2]) {
    const ROWS: usize = 14;
    for row in 0..ROWS {
        let t = row as f64 / (ROWS - 1) as f64;
        let middle = a * ((1.0 - t) * (1.0 - t)) + b * (2.0 * t * (1.0 - t)) + c * (t * t);
        let along = ((b - a) * (1.0 - t) + (c - b) * t).normalize();
        let (x, z) = along.any_orthonormal_pair();
        // Counter-clockwise from above.
        let z = if x.cross(z).dot(along) > 0.0 { -z } else { z };
        let is_end = row == 0 || row == ROWS - 1;
        let radius = if is_end { 0.0 } else { thick + (thin - thick) * t.sqrt() };
        for column in 0..around {
            let angle = TAU * column as f64 / around as f64;
            let bark = 1.0 + 0.06 * (5.0 * angle + 9.0 * t).sin() + 0.04 * (11.0 * angle - 4.0 * t).sin();
            points.push(middle + (x * angle.sin() + z * angle.cos()) * (radius * bark));
        }
    }
}
