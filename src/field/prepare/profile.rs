//! Profiles: closed curves in the plane as arcs that each only rise, so that evaluators can count the crossings
//! around a point.
//!
//! Rows: two for each group (its box; then the heights of its chain's start and end, its first piece, the number of
//! pieces), then two for each piece: middle and tangent; bend to the left, λ at the end, lower and upper end. All
//! pieces are written rising; λ is negative where the chain runs the other way.

use glam::DVec3;

use super::prepared_params::PreparedParams;
use isolith_geometry::{Aabb, ArcPiece};
use isolith_scene::profile_curve;
use isolith_scene::shape_params::{ExtrusionParams, RevolutionParams, TextParams};

/// The largest number of pieces in a group, which evaluators skip together.
const PROFILE_GROUP: usize = 8;

/// The parameters of an extruded profile.
pub fn extrusion(corners: &[[f64; 2]], smooth: bool, depth: f64, rounding: f64) -> PreparedParams {
    let (rows, groups) = profile(&profile_curve(corners, smooth));
    let half = 0.5 * depth;
    PreparedParams::new(&ExtrusionParams { groups, half_depth: half, rounding: rounding.min(half) }, rows)
}

/// The parameters of extruded letters. Overlapping profiles are solid.
pub fn text(arcs: &[ArcPiece], depth: f64, rounding: f64) -> PreparedParams {
    let nothing = [ArcPiece::straight(DVec3::ZERO, DVec3::ZERO)];
    let (rows, groups) = profile(if arcs.is_empty() { &nothing } else { arcs });
    let half = 0.5 * depth;
    PreparedParams::new(&TextParams { groups, half_depth: half, rounding: rounding.min(half) }, rows)
}

/// The parameters of a revolved profile.
pub fn revolution(corners: &[[f64; 2]], smooth: bool, offset: f64) -> PreparedParams {
    let mut kept = Vec::new();
    for arc in profile_curve(corners, smooth) {
        let arc = ArcPiece { middle: arc.middle + DVec3::X * offset, ..arc };
        // Revolution ignores the part behind the axis, and there is no surface on the axis.
        kept.extend(cut(arc, &arc.crossings(0, 0.0)).into_iter().filter(|piece| piece.middle.x > 0.0));
    }
    if kept.is_empty() {
        // Nothing is left: keep a point, so that the shape has a field.
        let low = profile_curve(corners, smooth).iter().fold(Aabb::EMPTY, |all, arc| all.union(&arc.bounds())).min.y;
        kept.push(ArcPiece::straight(DVec3::Y * low, DVec3::Y * low));
    }
    let (rows, groups) = profile(&kept);
    PreparedParams::new(&RevolutionParams { groups }, rows)
}

/// The pieces of an arc between positions on it.
fn cut(arc: ArcPiece, places: &[f64]) -> Vec<ArcPiece> {
    if places.is_empty() {
        return vec![arc];
    }
    let ends: Vec<f64> = [-arc.reach].into_iter().chain(places.iter().copied()).chain([arc.reach]).collect();
    ends.windows(2).map(|pair| arc.between(pair[0], pair[1])).collect()
}

/// A rising piece, in the values that evaluators read: which pieces connect is decided in f32.
struct Rising {
    middle: DVec3,
    tangent: DVec3,
    bend: f64,
    reach: f64,
    /// Lower and upper end.
    span: [f64; 2],
    /// Start and end in the direction of the chain.
    heights: [f64; 2],
    bounds: Aabb,
}

fn rising((arc, [from, to]): &(ArcPiece, [f64; 2])) -> Rising {
    let (from, to) = (*from, *to);
    let bounds = arc.bounds();
    let falls = to < from || (to == from && arc.tangent.y < 0.0);
    let up = if falls { arc.reversed() } else { *arc };
    Rising {
        middle: up.middle,
        tangent: up.tangent,
        bend: up.bend.dot(DVec3::new(-up.tangent.y, up.tangent.x, 0.0)),
        reach: if falls { -up.reach } else { up.reach },
        span: [from.min(to), from.max(to)],
        heights: [from, to],
        bounds,
    }
}

/// The heights in f32 of each piece's start and end. Where two pieces meet they have the same height, to the last
/// bit: points between two different heights would count to neither. A chain closes if its start is as near to its
/// end as the start of the next piece: curves may be so large compared to their details that all of these lie within
/// the rounding.
fn with_heights(arcs: Vec<ArcPiece>) -> Vec<(ArcPiece, [f64; 2])> {
    let size = arcs.iter().fold(0.0_f64, |most, arc| most.max(arc.middle.abs().max_element() + arc.length()));
    let height = |p: DVec3| f64::from(p.y as f32);
    let mut out: Vec<(ArcPiece, [f64; 2])> = Vec::with_capacity(arcs.len());
    // The start of the current chain, and the height of its last end.
    let mut chain: Option<(DVec3, f64, f64)> = None;
    for (i, arc) in arcs.iter().enumerate() {
        let (first, first_height, start) =
            chain.unwrap_or_else(|| (arc.start(), height(arc.start()), height(arc.start())));
        let end = arc.end();
        let away = |p: DVec3| Some(end.distance(p)).filter(|d| *d <= 1e-7 * size).unwrap_or(f64::INFINITY);
        let follows = arcs.get(i + 1).is_some_and(|next| away(next.start()) < away(first));
        let closes = !follows && away(first).is_finite();
        let end_height = if closes { first_height } else { height(end) };
        out.push((*arc, [start, end_height]));
        chain = follows.then_some((first, first_height, end_height));
    }
    out
}

/// The rows of closed curves, and the number of groups. Neighbors in `arcs` that meet form one chain.
pub fn profile(arcs: &[ArcPiece]) -> (Vec<[f64; 4]>, u32) {
    let pieces: Vec<ArcPiece> = arcs.iter().flat_map(|arc| cut(*arc, &arc.turns(1))).collect();
    let pieces: Vec<Rising> = with_heights(pieces).iter().map(rising).collect();
    let mut groups: Vec<std::ops::Range<usize>> = Vec::new();
    for (i, piece) in pieces.iter().enumerate() {
        match groups.last_mut() {
            Some(group) if group.len() < PROFILE_GROUP && pieces[i - 1].heights[1] == piece.heights[0] => {
                group.end += 1
            }
            _ => groups.push(i..i + 1),
        }
    }
    let mut rows = Vec::with_capacity(2 * (groups.len() + pieces.len()));
    for group in &groups {
        let chain = &pieces[group.clone()];
        let bounds = chain.iter().fold(Aabb::EMPTY, |all, piece| all.union(&piece.bounds));
        let room = 1e-6 * (bounds.min.abs().max(bounds.max.abs()).max_element());
        let heights = [chain[0].heights[0], chain[chain.len() - 1].heights[1]];
        rows.push([bounds.min.x - room, bounds.min.y - room, bounds.max.x + room, bounds.max.y + room]);
        rows.push([heights[0], heights[1], group.start as f64, group.len() as f64]);
    }
    for piece in &pieces {
        rows.push([piece.middle.x, piece.middle.y, piece.tangent.x, piece.tangent.y]);
        rows.push([piece.bend, piece.reach, piece.span[0], piece.span[1]]);
    }
    (rows, groups.len() as u32)
}
