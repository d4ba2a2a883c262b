//! A head on shoulders on a plinth: smooth blends of simple solids, seen from inside by rays.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::strip::Sculpture;

const AROUND: usize = 240;
const ROWS: usize = 216;
/// Where rays start to sweep over the ends: the middle of the head, and of the plinth.
const ENDS: [f64; 2] = [0.075, 0.705];
/// Shares of the rows below the lower end and below the upper.
const SHARES: [f64; 2] = [0.08, 0.72];
/// How far the head sits below where it was drawn.
const HEAD_DOWN: f64 = 0.05;

/// A bust of one meter.
pub(super) fn bust() -> Sculpture {
    let mut points = Vec::with_capacity(AROUND * ROWS);
    for row in 0..ROWS {
        let share = row as f64 / (ROWS - 1) as f64;
        let (height, tilt) = if share < SHARES[0] {
            (ENDS[0], 0.5 * PI * (share / SHARES[0] - 1.0))
        } else if share < SHARES[1] {
            (ENDS[0] + (ENDS[1] - ENDS[0]) * (share - SHARES[0]) / (SHARES[1] - SHARES[0]), 0.0)
        } else {
            (ENDS[1], 0.5 * PI * (share - SHARES[1]) / (1.0 - SHARES[1]))
        };
        for column in 0..AROUND {
            // Counter-clockwise from above, from the back to the face, where they are densest.
            let turn = TAU * column as f64 / AROUND as f64 - PI;
            let angle = turn - 0.45 * turn.sin();
            let ray = DVec3::new(angle.sin() * tilt.cos(), tilt.sin(), angle.cos() * tilt.cos());
            points.push(surface(DVec3::new(0.0, height, spine(height)), ray));
        }
    }
    Sculpture { name: "Bust", around: AROUND, points, look: ([0.78, 0.75, 0.70], 0.0, 0.36) }
}

/// How far the axis stands back at a height.
fn spine(height: f64) -> f64 {
    -0.012 * smooth(0.35, 0.6, height)
}

/// Where a ray from inside leaves the solid for the last time.
fn surface(from: DVec3, ray: DVec3) -> DVec3 {
    let mut far = 0.62;
    for _ in 0..60 {
        let d = distance(from + ray * far);
        if d < 1e-5 {
            break;
        }
        far -= 0.7 * d.min(0.05);
        if far < 0.02 {
            return from + ray * 0.02;
        }
    }
    from + ray * far
}

fn distance(p: DVec3) -> f64 {
    let mirrored = DVec3::new(p.x.abs(), p.y, p.z);
    let body = blend(plinth(p), torso(p, mirrored), 0.015);
    let down = DVec3::new(0.0, HEAD_DOWN, 0.0);
    let head = head(mirrored + down);
    let neck = capsule(p, DVec3::new(0.0, 0.40, -0.03), DVec3::new(0.0, 0.61, -0.012), 0.068);
    let cords = capsule(mirrored, DVec3::new(0.012, 0.435, 0.052), DVec3::new(0.062, 0.57, -0.03), 0.013);
    let neck = blend(neck, cords, 0.025);
    let whole = blend(blend(body, neck, 0.06), head, 0.025);
    blend(whole, hair(p + down), 0.006) + 0.000_5 * grain(p)
}

fn plinth(p: DVec3) -> f64 {
    let flat = DVec2::new(p.x, p.z).length();
    let disc = |radius: f64, low: f64, high: f64| {
        let d = DVec2::new(flat - radius, (p.y - 0.5 * (low + high)).abs() - 0.5 * (high - low)) + 0.008;
        d.max(DVec2::ZERO).length() + d.max_element().min(0.0) - 0.008
    };
    let waist = 0.085 + 0.05 * ((p.y - 0.12).abs() / 0.08).powi(2).min(1.0);
    disc(0.17, 0.0, 0.04)
        .min(blend(disc(0.145, 0.03, 0.06), disc(waist, 0.05, 0.21), 0.012))
        .min(disc(0.13, 0.185, 0.21))
}

/// The chest, with the folds of a cloth over one shoulder.
fn torso(p: DVec3, mirrored: DVec3) -> f64 {
    let chest = ellipsoid(p, DVec3::new(0.0, 0.34, -0.02), DVec3::new(0.225, 0.155, 0.135));
    let shoulder = ellipsoid(mirrored, DVec3::new(0.185, 0.385, -0.025), DVec3::new(0.095, 0.085, 0.085));
    let breast = ellipsoid(mirrored, DVec3::new(0.085, 0.345, 0.085), DVec3::new(0.085, 0.062, 0.05));
    let collar = capsule(mirrored, DVec3::new(0.02, 0.425, 0.075), DVec3::new(0.17, 0.445, 0.01), 0.012);
    let body = blend(blend(blend(chest, shoulder, 0.07), breast, 0.04), collar, 0.03);
    // Cloth follows lines that hang between the shoulders.
    let along = p.y + 0.55 * p.x + 0.9 * p.x * p.x;
    let edge = smooth(0.385, 0.372, along + 0.006 * (p.x * 40.0).sin());
    let fold = (along * 88.0 + 1.5 * (p.x * 13.0).sin() + 0.9 * (p.z * 19.0).sin()).sin();
    let cloth = edge * (0.011 + 0.0075 * (1.0 - fold.abs()).powi(2) + 0.002 * (along * 61.0 - p.x * 30.0).sin());
    let cut = 0.215 - p.y + 0.02 * smooth(0.1, 0.3, mirrored.x);
    smooth_max(body - cloth, cut, 0.02)
}

fn head(p: DVec3) -> f64 {
    let skull = ellipsoid(p, DVec3::new(0.0, 0.785, -0.022), DVec3::new(0.097, 0.118, 0.125));
    let face = ellipsoid(p, DVec3::new(0.0, 0.725, 0.032), DVec3::new(0.077, 0.115, 0.083));
    let jaw = ellipsoid(p, DVec3::new(0.0, 0.655, 0.052), DVec3::new(0.05, 0.042, 0.05));
    let corner = sphere(p, DVec3::new(0.055, 0.672, 0.008), 0.026);
    let chin = sphere(p, DVec3::new(0.0, 0.627, 0.086), 0.017);
    let cheek = ellipsoid(p, DVec3::new(0.05, 0.716, 0.078), DVec3::new(0.026, 0.02, 0.022));
    let brow = capsule(p, DVec3::new(0.012, 0.768, 0.109), DVec3::new(0.058, 0.773, 0.082), 0.011);
    let mut d = blend(blend(skull, face, 0.05), blend(jaw, chin, 0.03), 0.035);
    d = blend(blend(d, corner, 0.04), blend(cheek, brow, 0.01), 0.022);
    let socket = ellipsoid(p, DVec3::new(0.034, 0.751, 0.123), DVec3::new(0.023, 0.013, 0.02));
    d = smooth_max(d, -socket, 0.014);
    let eye = sphere(p, DVec3::new(0.034, 0.749, 0.088), 0.0195);
    let lid = sphere(p, DVec3::new(0.034, 0.7505, 0.0885), 0.0215);
    let opening = (p.y - 0.748).abs() - 0.0065 + 0.14 * (p.x - 0.034).abs().powf(1.5);
    d = blend(d, smooth_max(lid, -opening, 0.002), 0.004).min(eye);
    let bridge = capsule(p, DVec3::new(0.0, 0.762, 0.108), DVec3::new(0.0, 0.706, 0.138), 0.0098);
    let tip = sphere(p, DVec3::new(0.0, 0.703, 0.137), 0.0128);
    let wing = sphere(p, DVec3::new(0.0125, 0.699, 0.122), 0.0088);
    d = blend(d, blend(bridge, blend(tip, wing, 0.008), 0.01), 0.012);
    let groove = capsule(p, DVec3::new(0.0, 0.69, 0.128), DVec3::new(0.0, 0.679, 0.126), 0.003);
    d = smooth_max(d, -groove, 0.006);
    let upper = capsule(p, DVec3::new(0.004, 0.6745, 0.1115), DVec3::new(0.0245, 0.668, 0.0985), 0.0065);
    let lower = capsule(p, DVec3::new(0.0, 0.6605, 0.1095), DVec3::new(0.019, 0.663, 0.1005), 0.0075);
    let gap = capsule(p, DVec3::new(0.0, 0.6685, 0.122), DVec3::new(0.027, 0.6665, 0.104), 0.0022);
    d = smooth_max(blend(d, blend(upper, lower, 0.003), 0.006), -gap, 0.004);
    let ear = ellipsoid(p, DVec3::new(0.094, 0.738, -0.012), DVec3::new(0.013, 0.032, 0.02));
    let hollow = ellipsoid(p, DVec3::new(0.106, 0.741, -0.006), DVec3::new(0.008, 0.019, 0.011));
    blend(d, smooth_max(ear, -hollow, 0.006), 0.008)
}

/// Curls, which leave the face free and end in a band.
fn hair(p: DVec3) -> f64 {
    let cap = ellipsoid(p, DVec3::new(0.0, 0.792, -0.03), DVec3::new(0.108, 0.122, 0.133));
    let line = p.z - 0.062 + 0.55 * (p.y - 0.83).min(0.0).abs() - 0.35 * (p.y - 0.83).max(0.0);
    let free = smooth_max(line, 0.69 - p.y + 0.35 * (p.z + 0.06).max(-0.05), 0.02);
    let at = (p - DVec3::new(0.0, 0.79, -0.03)).normalize_or_zero();
    let (down, around) = (at.y.clamp(-1.0, 1.0).acos(), at.x.atan2(at.z));
    let swirl = 5.0 * down + 0.9 * (3.0 * around).sin();
    let curl = (around * 9.0 + 1.4 * (down * 11.0).sin()).sin() * (down * 13.0 + 1.2 * (around * 7.0).sin()).sin();
    let strand = (swirl * 9.0 + around * 22.0 + 3.0 * curl).sin();
    let carving = 0.007 * curl.abs().sqrt() * curl.signum() + 0.0016 * strand;
    let band = capsule_ring(p);
    smooth_max(cap - carving * smooth(0.0, -0.02, free), free, 0.012).min(band)
}

fn capsule_ring(p: DVec3) -> f64 {
    let q = DVec3::new(p.x / 0.104, (p.y - 0.822 + 0.28 * (p.z + 0.03)) / 0.1, (p.z + 0.026) / 0.127);
    let flat = DVec2::new(q.x, q.z).length() - 1.0;
    let d = DVec2::new(flat * 0.108, q.y * 0.1);
    let twist = 0.0012 * (q.x.atan2(q.z) * 60.0 + d.y * 500.0).sin();
    d.length() - 0.0095 - twist
}

/// Small bumps of chiseled stone.
fn grain(p: DVec3) -> f64 {
    let wave = |q: DVec3, k: f64| (k * q.x).sin() * (k * q.y + 1.3).sin() * (k * q.z + 2.1).sin();
    let turned = DVec3::new(0.8 * p.x + 0.6 * p.z, p.y + 0.3 * p.x, 0.8 * p.z - 0.6 * p.x);
    wave(p, 190.0) + 0.5 * wave(turned, 410.0)
}

fn sphere(p: DVec3, center: DVec3, radius: f64) -> f64 {
    p.distance(center) - radius
}

/// Near the surface the distance to first order (Quilez, "Ellipsoid SDF").
fn ellipsoid(p: DVec3, center: DVec3, radii: DVec3) -> f64 {
    let q = p - center;
    let (near, steep) = ((q / radii).length(), (q / (radii * radii)).length());
    if steep > 0.0 { near * (near - 1.0) / steep } else { -radii.min_element() }
}

fn capsule(p: DVec3, a: DVec3, b: DVec3, radius: f64) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t) - radius
}

/// A union whose seam is rounded by the polynomial kernel of second order.
fn blend(a: f64, b: f64, width: f64) -> f64 {
    let h = (width - (a - b).abs()).max(0.0) / width;
    a.min(b) - 0.25 * h * h * width
}

fn smooth_max(a: f64, b: f64, width: f64) -> f64 {
    -blend(-a, -b, width)
}

fn smooth(from: f64, to: f64, v: f64) -> f64 {
    let t = ((v - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
