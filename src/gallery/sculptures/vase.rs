//! A vase with a carving of waves and scales.

use std::f64::consts::TAU;

use glam::DVec3;

use super::strip::Sculpture;

const AROUND: usize = 256;
const ROWS: usize = 200;
/// The outline from the middle of the foot over the lip to the middle of the hollow: radius and height in meters.
const OUTLINE: [[f64; 2]; 21] = [
    [0.0, 0.0],
    [0.13, 0.0],
    [0.145, 0.012],
    [0.14, 0.03],
    [0.11, 0.05],
    [0.105, 0.075],
    [0.15, 0.13],
    [0.215, 0.24],
    [0.25, 0.36],
    [0.25, 0.46],
    [0.215, 0.56],
    [0.15, 0.64],
    [0.108, 0.70],
    [0.10, 0.76],
    [0.115, 0.82],
    [0.155, 0.87],
    [0.165, 0.885],
    [0.15, 0.893],
    [0.11, 0.83],
    [0.08, 0.75],
    [0.0, 0.72],
];

/// A vase of 0.9 meters.
pub(super) fn vase() -> Sculpture {
    let mut points = Vec::with_capacity(AROUND * ROWS);
    for row in 0..ROWS {
        let share = row as f64 / (ROWS - 1) as f64;
        let [radius, height] = outline(share);
        for column in 0..AROUND {
            let angle = TAU * column as f64 / AROUND as f64;
            // Nothing is added where the outline ends, and within the neck.
            let carving = if share < 0.78 { carving(angle, height) * (radius / 0.1).min(1.0) } else { 0.0 };
            let radius = if radius > 0.0 { radius + carving } else { 0.0 };
            points.push(DVec3::new(radius * angle.sin(), height, radius * angle.cos()));
        }
    }
    Sculpture { name: "Vase", around: AROUND, points, look: ([0.045, 0.20, 0.22], 0.0, 0.14) }
}

/// The point of the outline at a share of its length, on a curve through its corners (Catmull and Rom, 1974).
fn outline(share: f64) -> [f64; 2] {
    let last = OUTLINE.len() - 1;
    let lengths: Vec<f64> = OUTLINE.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]) + 0.02).collect();
    let mut at = share * lengths.iter().sum::<f64>();
    let piece = lengths[..last - 1].iter().take_while(|length| {
        let is_behind = at > **length;
        at -= if is_behind { **length } else { 0.0 };
        is_behind
    });
    let piece = piece.count();
    let t = (at / lengths[piece]).clamp(0.0, 1.0);
    let corner = |i: isize| OUTLINE[(piece as isize + i).clamp(0, last as isize) as usize];
    let [p, q, r, s] = [corner(-1), corner(0), corner(1), corner(2)];
    let along = |i: usize| {
        let (a, b, c, d) = (p[i], q[i], r[i], s[i]);
        0.5 * (2.0 * b
            + (c - a) * t
            + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
            + (3.0 * b - 3.0 * c + d - a) * t.powi(3))
    };
    [if share <= 0.0 || share >= 1.0 { 0.0 } else { along(0).max(0.002) }, along(1)]
}

fn carving(angle: f64, height: f64) -> f64 {
    let within = |low: f64, high: f64| {
        let t = ((height - low) / 0.012).clamp(0.0, 1.0) * ((high - height) / 0.012).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let ring = |at: f64| 0.006 * (-((height - at) / 0.005).powi(2)).exp();
    // Petals at the foot, scales on the belly, a running wave above, flutes at the neck.
    let petal = (8.0 * angle).sin().abs();
    let petals = within(0.085, 0.215)
        * 0.012
        * petal.powf(0.6)
        * (1.0 - ((height - 0.09) / 0.13 * 1.15 - 0.15).powi(4)).max(0.0);
    let row = ((height - 0.235) / 0.022).floor();
    let turned = 24.0 * angle / TAU + 0.5 * row.rem_euclid(2.0);
    let (across, up) = (2.0 * (turned - turned.floor()) - 1.0, (height - 0.235) / 0.022 - row);
    let scale = (1.0 - across * across * 0.9 - (1.0 - up).powi(2) * 0.75).max(0.0);
    let scales = within(0.235, 0.43) * 0.009 * scale.sqrt();
    let wave = (height - 0.497 - 0.018 * (10.0 * angle).sin()) / 0.009;
    let other = (height - 0.497 + 0.018 * (10.0 * angle).sin()) / 0.009;
    let over = 0.5 + 0.5 * (10.0 * angle).cos();
    let waves = within(0.45, 0.545)
        * 0.008
        * ((-wave * wave).exp() * (0.6 + 0.4 * over)).max((-other * other).exp() * (1.0 - 0.4 * over));
    let flutes = within(0.60, 0.80) * 0.006 * (16.0 * angle + 14.0 * height).sin();
    let fine = 0.000_7 * (61.0 * angle + 9.0 * (height * 90.0).sin()).sin() * within(0.56, 0.60);
    petals + scales + waves + flutes + fine + ring(0.076) + ring(0.225) + ring(0.44) + ring(0.553) + ring(0.81)
}
