//! A tube: balls along arcs, with a radius that changes linearly along the arc.
//!
//! Rows: a bounding ball for each group of pieces (with all of their balls), then three for each piece: middle and λ
//! at the end, see [`ArcPiece`]; tangent and radius in the middle; bend and growth of the radius per length.

use glam::DVec3;

use super::prepared_params::{PreparedParams, bounding_sphere};
use isolith_geometry::{Aabb, ArcPiece};
use isolith_scene::shape_params::TubeParams;
use isolith_scene::tube_curve;

/// The number of pieces in a group, which evaluators skip together.
pub const TUBE_GROUP: usize = 8;

/// A piece with its balls.
struct Piece {
    arc: ArcPiece,
    radius: f64,
    growth: f64,
}

impl Piece {
    fn between(arc: ArcPiece, [from, to]: [f64; 2]) -> Self {
        let length = arc.length();
        let growth = if length > 0.0 { (to - from) / length } else { 0.0 };
        // A radius that grows faster than the length belongs to balls that contain each other.
        Self { arc, radius: 0.5 * (from + to), growth: if growth.is_finite() { growth } else { 0.0 } }
    }

    fn rows(&self) -> [[f64; 4]; 3] {
        let row = |v: DVec3, w: f64| [v.x, v.y, v.z, w];
        let ArcPiece { middle, tangent, bend, reach } = self.arc;
        [row(middle, reach), row(tangent, self.radius), row(bend, self.growth)]
    }

    fn bounds(&self) -> Aabb {
        self.arc.bounds().expanded(self.radius + 0.5 * self.growth.abs() * self.arc.length())
    }
}

/// The parameters of a tube.
pub fn tube(points: &[[f64; 4]], radius: f64, closed: bool) -> PreparedParams {
    let mut pieces = Vec::new();
    for (i, span) in tube_curve(points, closed).into_iter().enumerate() {
        let ends = [i, (i + 1) % points.len()].map(|at| radius + points[at][3]);
        let whole: f64 = span.iter().map(ArcPiece::length).sum();
        let (mut way, mut from) = (0.0, ends[0]);
        for arc in span {
            way += arc.length();
            let to = if whole > 0.0 { ends[0] + (ends[1] - ends[0]) * (way / whole).min(1.0) } else { ends[1] };
            pieces.push(Piece::between(arc, [from, to]));
            from = to;
        }
        // A piece without length: two balls at the same place.
        if whole == 0.0 {
            let place = DVec3::from_slice(&points[i][..3]);
            pieces.push(Piece::between(ArcPiece::straight(place, place), [ends[0].max(ends[1]); 2]));
        }
    }
    if !closed && let Some([x, y, z, r]) = points.last() {
        // Every piece represents the ball at its start; this one represents the last ball.
        let place = DVec3::new(*x, *y, *z);
        pieces.push(Piece::between(ArcPiece::straight(place, place), [radius + r; 2]));
    }
    let mut rows: Vec<[f64; 4]> = pieces
        .chunks(TUBE_GROUP)
        .map(|group| {
            let bounds = group.iter().fold(Aabb::EMPTY, |all, piece| all.union(&piece.bounds()));
            let center = bounds.center();
            let reach = |p: &Piece| {
                let far = p.arc.middle.distance(center) + p.arc.middle.distance(p.arc.end());
                far + p.radius + 0.5 * p.growth.abs() * p.arc.length()
            };
            bounding_sphere(center, group.iter().map(reach).fold(0.0, f64::max))
        })
        .collect();
    let groups = rows.len();
    rows.extend(pieces.iter().flat_map(Piece::rows));
    PreparedParams::new(&TubeParams { pieces: pieces.len() as u32, groups: groups as u32 }, rows)
}
