//! A second definition of the shapes with a payload: see `surfaces`. Samples their curves by arcs, which the tests of
//! `geometry` check.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use isolith::field::PreparedShape;
use isolith::field::eval::{heightmap_height, ocean_height, terrain_height};
use isolith::geometry::ArcPiece;
use isolith::scene::shape_params::{HeightmapParams, OceanParams, TerrainParams};
use isolith::scene::{EvalParams, Shape, ShapeKind, profile_curve, text_profile, tube_curve};

use super::bricks;
use super::samples::evaluate;
use super::surfaces::{Patch, outside_of, sphere, turned};

/// An arc with the radii at its ends.
type Piece = (ArcPiece, [f64; 2]);

fn pieces(points: &[[f64; 4]], radius: f64, closed: bool) -> Vec<Piece> {
    let mut out = Vec::new();
    for (i, span) in tube_curve(points, closed).into_iter().enumerate() {
        let (from, to) = (points[i][3] + radius, points[(i + 1) % points.len()][3] + radius);
        let whole: f64 = span.iter().map(ArcPiece::length).sum();
        let mut way = 0.0;
        for arc in span {
            let at = |way: f64| if whole > 0.0 { from + (to - from) * way / whole } else { from.max(to) };
            out.push((arc, [at(way), at(way + arc.length())]));
            way += arc.length();
        }
    }
    out
}

/// The radius at λ, linear in the arc length.
fn radius_at((arc, [from, to]): &Piece, lambda: f64) -> f64 {
    let share = if arc.length() > 0.0 { 0.5 + arc.way(lambda) / arc.length() } else { 0.0 };
    from + (to - from) * share
}

/// Distance to the nearest ball of a piece: the best of some samples, refined by ternary search.
fn to_piece(piece: &Piece, p: DVec3) -> f64 {
    const SAMPLES: i32 = 16;
    let reach = piece.0.reach;
    let f = |lambda: f64| p.distance(piece.0.at(lambda)) - radius_at(piece, lambda);
    let place = |i: i32| reach * (2.0 * f64::from(i) / f64::from(SAMPLES) - 1.0);
    let best = (0..=SAMPLES).min_by(|a, b| f(place(*a)).total_cmp(&f(place(*b)))).unwrap();
    let (mut low, mut high) = (place((best - 1).max(0)), place((best + 1).min(SAMPLES)));
    for _ in 0..40 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { high = b } else { low = a }
    }
    f(0.5 * (low + high)).min(f(place(best)))
}

/// Whether a ball of one of the pieces contains the point. A bounding sphere rejects most pieces.
fn any_holds(pieces: &[Piece], p: DVec3) -> bool {
    let is_near = |(arc, radii): &&Piece| p.distance(arc.at(0.0)) <= 0.5 * arc.length() + radii[0].max(radii[1]);
    pieces.iter().filter(is_near).any(|piece| to_piece(piece, p) < 0.0)
}

/// The distance from outside to a tube: to the nearest of its balls.
pub fn tube_distance(shape: &Shape, p: DVec3) -> f64 {
    let Shape::Tube { points, radius, closed } = shape else { panic!("a tube") };
    pieces(points, *radius, *closed).iter().fold(f64::INFINITY, |least, piece| least.min(to_piece(piece, p)))
}

/// λ at this fraction of the length of an arc from its start.
fn lambda_at(arc: &ArcPiece, share: f64) -> f64 {
    arc.reach * (2.0 * share - 1.0)
}

/// A curve as chords, for a crossing test with an upward ray.
struct Chords(Vec<[DVec2; 2]>);

impl Chords {
    fn new(arcs: &[ArcPiece]) -> Self {
        // Letters have many short arcs.
        let per_arc = if arcs.len() > 20 { 40 } else { 400 };
        let mut chords = Vec::new();
        for arc in arcs {
            let count = if arc.bend == DVec3::ZERO { 1 } else { per_arc };
            // Round, so that two adjoining arcs end in one point: a ray could pass between two points.
            let tidy = |v: f64| (v * 1e12).round() / 1e12;
            let at = |i: i32| arc.at(lambda_at(arc, f64::from(i) / f64::from(count))).truncate().map(tidy);
            chords.extend((0..count).map(|i| [at(i), at(i + 1)]));
        }
        Self(chords)
    }

    /// Whether an upward ray from the point crosses the curves an odd number of times.
    fn hold(&self, p: DVec2) -> bool {
        let is_above =
            |[a, b]: &&[DVec2; 2]| (a.x > p.x) != (b.x > p.x) && a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x) > p.y;
        self.0.iter().filter(is_above).count() % 2 == 1
    }
}

/// A profile as a very long prism, whose field at the middle is the depth of a point in the profile.
fn endless(shape: &Shape) -> PreparedShape {
    let mut prism = shape.clone();
    match &mut prism {
        Shape::Extrusion { depth, rounding, .. } | Shape::Text { depth, rounding, .. } => {
            (*depth, *rounding) = (1e4, 0.0);
        }
        _ => panic!("a profile"),
    }
    PreparedShape::new(&prism)
}

fn depth_in(endless: &PreparedShape, p: DVec2) -> f64 {
    evaluate(endless, [p.x, p.y, 0.0])
}

fn height(prepared: &PreparedShape, x: f64, z: f64) -> f64 {
    let rows = |row: usize| prepared.payload[row];
    let number = |i: usize| prepared.parameters[i];
    match prepared.kind {
        ShapeKind::Ocean => ocean_height(x, z, &OceanParams::read(number), &rows),
        ShapeKind::Heightmap => heightmap_height(x, z, &HeightmapParams::read(number), &rows),
        _ => terrain_height(x, z, &TerrainParams::read(number), &rows),
    }
}

pub fn inside(shape: &Shape, p: DVec3) -> bool {
    match shape {
        Shape::Tube { points, radius, closed } => any_holds(&pieces(points, *radius, *closed), p),
        Shape::Extrusion { depth, rounding, .. } | Shape::Text { depth, rounding, .. } => {
            let half = 0.5 * depth;
            let rounding = rounding.min(half);
            if rounding == 0.0 {
                return p.z.abs() < half && Chords::new(&profile_of(shape)).hold(p.truncate());
            }
            let d = DVec2::new(depth_in(&endless(shape), p.truncate()) + rounding, p.z.abs() - half + rounding);
            d.max(DVec2::ZERO).length() < rounding
        }
        Shape::Revolution { corners, smooth, offset } => {
            Chords::new(&profile_curve(corners, *smooth)).hold(DVec2::new(p.x.hypot(p.z) - offset, p.y))
        }
        Shape::Terrain { size, .. } | Shape::Ocean { size, .. } | Shape::Heightmap { size, .. } => {
            let [x, depth, z] = *size;
            let is_below = || p.y < height(&PreparedShape::new(shape), p.x, p.z);
            p.x.abs() < 0.5 * x && p.z.abs() < 0.5 * z && p.y > -depth && is_below()
        }
        Shape::MeshField { file, .. } => bricks::interpolated(file.bricks().finest(), p) < 0.0,
        _ => panic!("stands in `surfaces`"),
    }
}

pub fn patches(shape: &Shape) -> Vec<Patch> {
    match shape {
        Shape::Tube { points, radius, closed } => tube(pieces(points, *radius, *closed)),
        Shape::Extrusion { depth, rounding, .. } | Shape::Text { depth, rounding, .. } => {
            extrusion(shape, 0.5 * depth, rounding.min(0.5 * depth))
        }
        Shape::Revolution { corners, smooth, offset } => {
            let offset = *offset;
            let turn = |arc: ArcPiece| -> Patch {
                Box::new(move |u, v| {
                    let at = arc.at(lambda_at(&arc, v));
                    // Points on the axis do not bound anything.
                    (at.x + offset > 1e-12).then(|| turned(at.x + offset, at.y, u))
                })
            };
            profile_curve(corners, *smooth).into_iter().map(turn).collect()
        }
        Shape::Terrain { size, .. } | Shape::Ocean { size, .. } | Shape::Heightmap { size, .. } => {
            heightfield(shape, *size)
        }
        Shape::MeshField { file, .. } => bricks::patches(&file.bricks().all()[0]),
        _ => panic!("stands in `surfaces`"),
    }
}

fn tube(pieces: Vec<Piece>) -> Vec<Patch> {
    let pieces = Arc::new(pieces);
    let mut patches: Vec<Patch> = Vec::new();
    let mut push = |patch: Patch| {
        let pieces = pieces.clone();
        patches.push(outside_of(patch, move |p| any_holds(&pieces, p)));
    };
    for index in 0..pieces.len() {
        let (arc, radii) = pieces[index];
        for (place, radius) in [(arc.start(), radii[0]), (arc.end(), radii[1])] {
            push(sphere(place, DVec3::splat(radius)));
        }
        let growth = if arc.length() > 0.0 { (radii[1] - radii[0]) / arc.length() } else { 1.0 };
        if growth.abs() >= 1.0 {
            // One of the balls at its ends contains all others.
            continue;
        }
        let across = arc.tangent.cross(arc.bend).try_normalize().unwrap_or(arc.tangent.any_orthonormal_vector());
        let side: Patch = Box::new(move |u, v| {
            let lambda = lambda_at(&arc, v);
            let (along, r) = (arc.direction(lambda), radius_at(&(arc, radii), lambda));
            let around = turned(1.0, 0.0, u);
            let out = across * around.x + across.cross(along) * around.z;
            Some(arc.at(lambda) + (out * (1.0 - growth * growth).sqrt() - along * growth) * r)
        });
        push(side);
    }
    patches
}

/// The arcs of a profile. Profiles of letters do not overlap.
fn profile_of(shape: &Shape) -> Vec<ArcPiece> {
    match shape {
        Shape::Extrusion { corners, smooth, .. } => profile_curve(corners, *smooth),
        Shape::Text { text, font, size, .. } => text_profile(text, font, *size),
        _ => panic!("a profile"),
    }
}

fn extrusion(shape: &Shape, half: f64, rounding: f64) -> Vec<Patch> {
    let mut patches: Vec<Patch> = Vec::new();
    let mut arcs = profile_of(shape);
    if arcs.is_empty() {
        arcs.push(ArcPiece::straight(DVec3::ZERO, DVec3::ZERO));
    }
    for &arc in &arcs {
        patches.push(Box::new(move |u, v| {
            Some(arc.at(lambda_at(&arc, u)) + DVec3::Z * (2.0 * v - 1.0) * (half - rounding))
        }));
    }
    let bounds = shape.bounds();
    // Split faces into tiles, so that the grid of each resolves the strokes of letters.
    const TILES: [u32; 2] = [8, 3];
    for tile in 0..2 * TILES[0] * TILES[1] {
        let side = if tile % 2 == 0 { -1.0 } else { 1.0 };
        let corner = DVec2::new(f64::from(tile / 2 % TILES[0]), f64::from(tile / 2 / TILES[0]));
        let (endless, chords) = (endless(shape), Chords::new(&arcs));
        patches.push(Box::new(move |u, v| {
            let part = (corner + DVec2::new(u, v)) / DVec2::from(TILES.map(f64::from));
            let p = bounds.min.truncate() + (bounds.max - bounds.min).truncate() * part;
            if rounding == 0.0 {
                return chords.hold(p).then(|| p.extend(side * half));
            }
            let depth = depth_in(&endless, p);
            let rise = (rounding * rounding - (depth + rounding).max(0.0).powi(2)).max(0.0).sqrt();
            (depth < 0.0).then(|| p.extend(side * (half - rounding + rise)))
        }));
    }
    patches
}

fn heightfield(shape: &Shape, [x, depth, z]: [f64; 3]) -> Vec<Patch> {
    let at = move |u: f64, v: f64| ((u - 0.5) * x, (v - 0.5) * z);
    let mut patches: Vec<Patch> = Vec::new();
    for top in [false, true] {
        let prepared = PreparedShape::new(shape);
        patches.push(Box::new(move |u, v| {
            let (x, z) = at(u, v);
            let h = height(&prepared, x, z);
            (h >= -depth).then(|| DVec3::new(x, if top { h } else { -depth }, z))
        }));
    }
    for side in 0..4 {
        let prepared = PreparedShape::new(shape);
        patches.push(Box::new(move |u, v| {
            let end = f64::from(side % 2);
            let (x, z) = if side < 2 { at(u, end) } else { at(end, u) };
            let h = height(&prepared, x, z);
            (h >= -depth).then(|| DVec3::new(x, -depth + (h + depth) * v, z))
        }));
    }
    patches
}
