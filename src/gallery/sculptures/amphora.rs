//! A painted amphora with images of its colors, of its metal and of its grooves, as a glTF file: coarse triangles, so
//! that all that is fine comes from the images.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::strip::container;
use isolith_scene::{Attachment, TextureImage};

/// Triangles around and along.
const SIZE: [usize; 2] = [64, 56];
/// Pixels of the images, around and from the top to the bottom.
const PIXELS: [u32; 2] = [512, 256];
/// Radius and height, from the middle of the foot to the middle of the lid, in meters.
const OUTLINE: [[f64; 2]; 15] = [
    [0.0, 0.0],
    [0.15, 0.0],
    [0.16, 0.02],
    [0.12, 0.05],
    [0.11, 0.08],
    [0.19, 0.17],
    [0.27, 0.32],
    [0.30, 0.46],
    [0.27, 0.60],
    [0.17, 0.71],
    [0.115, 0.78],
    [0.11, 0.86],
    [0.15, 0.92],
    [0.14, 0.94],
    [0.0, 0.93],
];
/// A meander of 10 by 8 squares.
const MEANDER: [&[u8; 10]; 8] = [
    b"##########",
    b"..........",
    b".########.",
    b".#......#.",
    b".#.####.#.",
    b".#.#..#.#.",
    b".#.#.##.#.",
    b"##.#....##",
];

/// What the images show at a point.
struct Paint {
    /// Encoded as sRGB.
    color: [f64; 3],
    metalness: f64,
    roughness: f64,
}

const CLAY: [f64; 3] = [0.80, 0.44, 0.25];
const BLACK: [f64; 3] = [0.10, 0.085, 0.08];
const GOLD: [f64; 3] = [0.93, 0.76, 0.40];
const TEAL: [f64; 3] = [0.10, 0.42, 0.45];

/// The paint at shares of the way around, and from the bottom to the top.
fn paint(u: f64, v: f64) -> Paint {
    let within = |low: f64, high: f64| (low..high).contains(&v);
    let glazed = |color| Paint { color, metalness: 0.0, roughness: 0.22 };
    let matte = |color| Paint { color, metalness: 0.0, roughness: 0.62 };
    let gold = Paint { color: GOLD, metalness: 1.0, roughness: 0.26 };
    if [0.345, 0.455, 0.665, 0.79].iter().any(|at| (v - at).abs() < 0.006) {
        return gold;
    }
    if within(0.36, 0.44) {
        let column = (u * 20.0 * 10.0) as usize % 10;
        let row = ((0.44 - v) / 0.08 * 8.0) as usize;
        return if MEANDER[row.min(7)][column] == b'#' { glazed(BLACK) } else { matte(CLAY) };
    }
    if within(0.47, 0.65) {
        // Fishes in two rows, which swim against each other.
        let row = ((v - 0.47) / 0.09) as i32;
        let way = if row == 0 { 1.0 } else { -1.0 };
        let x = (u * 12.0 + 0.25 * f64::from(row)).fract() - 0.5;
        let at = DVec2::new(way * x * 2.0, ((v - 0.47) / 0.09).fract() - 0.5) * DVec2::new(1.0, 1.6);
        let body = (at * DVec2::new(1.5, 3.4) + DVec2::new(0.1, 0.0)).length() < 0.8;
        let tail = at.x > 0.35 && at.x < 0.75 && at.y.abs() < 0.9 * (at.x - 0.3);
        let eye = (at - DVec2::new(-0.36, 0.04)).length() < 0.06;
        let scale = ((at.x * 9.0).sin() * (at.y * 16.0).sin()) > 0.35;
        return match (eye, body || tail, body && scale) {
            (true, ..) => gold,
            (_, _, true) => glazed(TEAL),
            (_, true, _) => glazed(BLACK),
            _ => matte(CLAY),
        };
    }
    if within(0.12, 0.33) {
        // Rays from the foot.
        let x = ((u * 24.0).fract() - 0.5).abs() * 2.0;
        return if x < 0.85 * (0.33 - v) / 0.21 { glazed(BLACK) } else { matte(CLAY) };
    }
    if within(0.68, 0.78) {
        let tongue = ((u * 40.0).fract() - 0.5).abs() < 0.36 && ((v - 0.73) / 0.045).abs() < 1.0;
        return if tongue { glazed(TEAL) } else { matte(CLAY) };
    }
    glazed(BLACK)
}

/// The height of grooves there, in meters.
fn grooves(u: f64, v: f64) -> f64 {
    let rings = if (0.80..0.93).contains(&v) { 0.002 * (TAU * v * 60.0).sin() } else { 0.0 };
    let ribs = if (0.12..0.33).contains(&v) { 0.0035 * (TAU * u * 48.0).cos().abs() } else { 0.0 };
    let hammered = if (0.47..0.65).contains(&v) {
        0.0007 * (TAU * (u * 90.0 + 3.0 * v)).sin() * (TAU * (v * 70.0 - 5.0 * u)).sin()
    } else {
        0.0
    };
    rings + ribs + hammered
}

/// The point at a share of the way up the outline, on a curve through its corners (Catmull and Rom, 1974).
fn outline(share: f64) -> [f64; 2] {
    let last = OUTLINE.len() - 1;
    let at = share.clamp(0.0, 1.0) * last as f64;
    let piece = (at as usize).min(last - 1);
    let t = at - piece as f64;
    let corner = |i: isize| OUTLINE[(piece as isize + i).clamp(0, last as isize) as usize];
    let [p, q, r, s] = [corner(-1), corner(0), corner(1), corner(2)];
    [0, 1].map(|i| {
        let (a, b, c, d) = (p[i], q[i], r[i], s[i]);
        let curved = (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t + (3.0 * (b - c) + d - a) * t.powi(3);
        (b + 0.5 * curved).max(0.0)
    })
}

/// The image of these channels, as a PNG file.
fn image(channels: impl Fn(f64, f64) -> [f64; 3]) -> Vec<u8> {
    let [width, height] = PIXELS.map(f64::from);
    let painted = Attachment::<TextureImage>::painted("amphora.png", PIXELS, |x, y| {
        // Means of 3 by 3 points, so that edges are smooth.
        let mut sum = DVec3::ZERO;
        for i in 0..9_u32 {
            let [dx, dy] = [i % 3, i / 3].map(|n| (f64::from(n) + 0.5) / 3.0);
            sum += DVec3::from(channels((f64::from(x) + dx) / width, 1.0 - (f64::from(y) + dy) / height));
        }
        (sum / 9.0).to_array().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8)
    });
    painted.bytes().to_vec()
}

/// The bytes of a .glb file.
pub(super) fn amphora() -> Vec<u8> {
    let [around, along] = SIZE;
    let (mut positions, mut normals, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for row in 0..=along {
        let share = row as f64 / along as f64;
        let [radius, height] = outline(share);
        let ([below, low], [above, high]) = (outline(share - 0.004), outline(share + 0.004));
        for column in 0..=around {
            let u = column as f64 / around as f64;
            let (sine, cosine) = (TAU * u).sin_cos();
            let side =
                DVec2::new(high - low, below - above).normalize_or(DVec2::new(0.0, share - 0.5).normalize_or_zero());
            positions.extend([radius * sine, height, radius * cosine].map(|v| v as f32));
            normals.extend([side.x * sine, side.y, side.x * cosine].map(|v| v as f32));
            uvs.extend([u, 1.0 - share].map(|v| v as f32));
        }
    }
    for (row, column) in (0..along).flat_map(|row| (0..around).map(move |column| (row, column))) {
        let at = |r: usize, c: usize| ((row + r) * (around + 1) + column + c) as u16;
        indices.extend([at(0, 0), at(0, 1), at(1, 1), at(0, 0), at(1, 1), at(1, 0)]);
    }
    let images = [
        image(|u, v| paint(u, v).color),
        image(|u, v| [0.0, paint(u, v).roughness, paint(u, v).metalness]),
        image(|u, v| {
            let step = 1e-3;
            // Meters around and along at the belly.
            let slope = |du: f64, dv: f64, meters: f64| {
                (grooves(u + du, v + dv) - grooves(u - du, v - dv)) / (2.0 * step * meters)
            };
            let normal = DVec3::new(-slope(step, 0.0, 1.7), -slope(0.0, step, 1.4), 1.0).normalize();
            (normal * 0.5 + 0.5).to_array()
        }),
    ];
    file(&positions, &normals, &uvs, &indices, &images)
}

fn file(positions: &[f32], normals: &[f32], uvs: &[f32], indices: &[u16], images: &[Vec<u8>; 3]) -> Vec<u8> {
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let indices: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
    let (count, corners) = (positions.len() / 3, indices.len() / 2);
    let runs = [floats(positions), floats(normals), floats(uvs), indices];
    let (mut bytes, mut views) = (Vec::new(), Vec::new());
    for run in runs.iter().chain(images) {
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, bytes.len(), run.len()));
        bytes.extend(run);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    let edge = |fold: fn(f32, f32) -> f32| {
        let along = |i: usize| positions.iter().skip(i).step_by(3).copied().reduce(fold).unwrap_or(0.0).to_string();
        [0, 1, 2].map(along).join(",")
    };
    let image = |at: usize| format!(r#"{{"bufferView":{at},"mimeType":"image/png"}}"#);
    let float = |at: usize, kind: &str| {
        format!(r#"{{"bufferView":{at},"componentType":5126,"type":"{kind}","count":{count}}}"#)
    };
    let parts = [
        r#"{"asset":{"version":"2.0","generator":"Isolith"},"scene":0,"scenes":[{"nodes":[0]}],"#.to_owned(),
        r#""nodes":[{"name":"Amphora","mesh":0}],"#.to_owned(),
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"#.to_owned(),
        r#""indices":3,"material":0}]}],"materials":[{"name":"Amphora","normalTexture":{"index":2},"#.to_owned(),
        r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0},"#.to_owned(),
        r#""metallicRoughnessTexture":{"index":1}}}],"#.to_owned(),
        r#""textures":[{"source":0},{"source":1},{"source":2}],"#.to_owned(),
        format!(r#""images":[{}],"#, [4, 5, 6].map(image).join(",")),
        format!(r#""accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count},"#),
        format!(r#""min":[{}],"max":[{}]}},"#, edge(f32::min), edge(f32::max)),
        format!("{},{},", float(1, "VEC3"), float(2, "VEC2")),
        format!(r#"{{"bufferView":3,"componentType":5123,"type":"SCALAR","count":{corners}}}],"#),
        format!(r#""bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#, views.join(","), bytes.len()),
    ];
    container(parts.concat().as_bytes(), &bytes)
}
