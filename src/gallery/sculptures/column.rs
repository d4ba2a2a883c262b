//! A twisted column around which three bands run over and under each other.

use std::f64::consts::TAU;

use glam::DVec3;

use super::strip::Sculpture;

const AROUND: usize = 200;
const ROWS: usize = 252;
/// Height in meters.
const HEIGHT: f64 = 1.6;

/// A column of 1.6 meters.
pub(super) fn column() -> Sculpture {
    let mut points = Vec::with_capacity(AROUND * ROWS);
    for row in 0..ROWS {
        // The two rows at each end close it.
        let share = ((row as f64 - 1.0) / (ROWS - 3) as f64).clamp(0.0, 1.0);
        let height = HEIGHT * share;
        for column in 0..AROUND {
            let angle = TAU * column as f64 / AROUND as f64;
            let is_end = row == 0 || row == ROWS - 1;
            let radius = if is_end { 0.0 } else { radius(angle, height) };
            let twist = 1.3 * share;
            points.push(DVec3::new(radius * (angle + twist).sin(), height, radius * (angle + twist).cos()));
        }
    }
    Sculpture { name: "Column", around: AROUND, points, look: ([0.62, 0.42, 0.18], 1.0, 0.30) }
}

fn radius(angle: f64, height: f64) -> f64 {
    let step = |from: f64, to: f64| {
        let t = ((height - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    // Base and capital widen in steps, which are square for a corner of the plate.
    let (down, up) = (1.0 - step(0.07, 0.16), step(HEIGHT - 0.22, HEIGHT - 0.06));
    let plate = (1.0 - step(0.045, 0.055)).max(step(HEIGHT - 0.045, HEIGHT - 0.035));
    let turned = (angle + TAU / 8.0).rem_euclid(TAU / 4.0) - TAU / 8.0;
    let square = 0.175 / turned.cos().max(0.75);
    let shaft = 0.1 + 0.006 * (TAU * height / HEIGHT * 0.5).sin();
    let leaf = 0.5 + 0.5 * (8.0 * angle).cos();
    let round = shaft + 0.05 * down + up * (0.045 + 0.022 * leaf * (1.0 - up));
    let ring = |at: f64| 0.011 * (-((height - at) / 0.009).powi(2)).exp();
    let within = step(0.19, 0.22) * (1.0 - step(HEIGHT - 0.28, HEIGHT - 0.25));
    let flutes = -0.008 * (0.5 + 0.5 * (12.0 * angle).cos()).powi(2) * within;
    let mut carving = flutes + ring(0.17) + ring(0.19) + ring(HEIGHT - 0.235);
    for band in 0..6 {
        let way = if band % 2 == 0 { 1.0 } else { -1.0 };
        let at = TAU * f64::from(band / 2) / 3.0 + way * height * 7.0;
        let off = (angle - at + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        // Each band passes over the first it meets and under the next.
        let over = 0.010 * way * (3.0 * (angle + way * at) * 0.5).sin();
        let across = off / 0.2;
        if across.abs() < 1.0 {
            let braid = 0.0022 * (way * height * 160.0 + 14.0 * off).sin().abs();
            let cord = (0.022 + over) * (1.0 - across * across).sqrt() + braid;
            carving = carving.max(cord * within);
        }
    }
    let body = round + carving;
    body + (square - body) * plate
}
