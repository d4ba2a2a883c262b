//! Shapes drawn point by point: the curve of a tube, the curve of a profile.

use std::f64::consts::TAU;
use std::ops::Deref;
use std::sync::Arc;

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use isolith_font::{Face, text_curve};
use isolith_geometry::{Aabb, ArcPiece, smooth_curve, straight_curve};

/// Letters smaller than this are not drawn, in meters.
const LEAST_TEXT: f64 = 1e-6;

/// Points of a curve in space: x, y, z, radius. Clones share them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Points(Arc<Vec<[f64; 4]>>);

/// Corners of a profile in the XY plane. Clones share them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Corners(Arc<Vec<[f64; 2]>>);

impl Points {
    /// A curve through these points.
    pub fn new(points: impl Into<Vec<[f64; 4]>>) -> Self {
        Self(Arc::new(points.into()))
    }
}

impl Deref for Points {
    type Target = [[f64; 4]];
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl Corners {
    /// A profile with these corners.
    pub fn new(corners: impl Into<Vec<[f64; 2]>>) -> Self {
        Self(Arc::new(corners.into()))
    }

    /// A star with one of its tips upward; the radii are those of the tips and of the notches, in meters.
    pub fn star(tips: u32, outer: f64, inner: f64) -> Self {
        let corner = |i: u32| {
            let (s, c) = (TAU * f64::from(i) / f64::from(2 * tips)).sin_cos();
            let r = if i.is_multiple_of(2) { outer } else { inner };
            // Rounded to a micrometer, so that files show tidy numbers.
            [-r * s, r * c].map(|v| (v * 1e6).round() / 1e6 + 0.0)
        };
        Self::new((0..2 * tips).map(corner).collect::<Vec<_>>())
    }

    /// The half profile of a bowl on a foot, to be revolved around the Y axis.
    pub fn vase() -> Self {
        Self::new([
            [0.0, -0.6],
            [0.3, -0.6],
            [0.14, -0.5],
            [0.42, -0.1],
            [0.25, 0.35],
            [0.36, 0.6],
            [0.3, 0.6],
            [0.18, 0.35],
            [0.34, -0.1],
            [0.0, -0.4],
        ])
    }
}

impl Deref for Corners {
    type Target = [[f64; 2]];
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// The curve of a tube as arcs; the arcs between two neighboring points form one group.
pub fn tube_curve(points: &[[f64; 4]], closed: bool) -> Vec<Vec<ArcPiece>> {
    let places: Vec<DVec3> = points.iter().map(|[x, y, z, _]| DVec3::new(*x, *y, *z)).collect();
    smooth_curve(&places, closed)
}

/// A profile as arcs.
pub fn profile_curve(corners: &[[f64; 2]], smooth: bool) -> Vec<ArcPiece> {
    let places: Vec<DVec3> = corners.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
    let spans = if smooth { smooth_curve(&places, true) } else { straight_curve(&places) };
    spans.into_iter().flatten().collect()
}

/// A box around a tube.
pub(super) fn tube_bounds(points: &[[f64; 4]], radius: f64, closed: bool) -> Aabb {
    let mut bounds = Aabb::EMPTY;
    for (i, span) in tube_curve(points, closed).iter().enumerate() {
        let radius = radius + points[i][3].max(points[(i + 1) % points.len()][3]);
        for arc in span {
            bounds = bounds.union(&arc.bounds().expanded(radius));
        }
    }
    points.iter().fold(bounds, |all, [x, y, z, r]| {
        all.union(&Aabb::from_center_half(DVec3::new(*x, *y, *z), DVec3::splat(radius + r)))
    })
}

/// The profiles of a text whose font is `size` meters high; empty where `text_fault` reports a fault.
pub fn text_profile(text: &str, font: &Attachment<Face>, size: f64) -> Vec<ArcPiece> {
    // A text without size or without ink becomes a point.
    if size < LEAST_TEXT {
        return Vec::new();
    }
    let sized =
        |arc: &ArcPiece| ArcPiece { middle: arc.middle * size, bend: arc.bend / size, reach: arc.reach * size, ..*arc };
    text_curve(text, font.content()).map(|arcs| arcs.iter().map(sized).collect()).unwrap_or_default()
}

/// Why a text cannot be drawn with its font: it would exceed a limit.
pub(super) fn text_fault(text: &str, font: &Attachment<Face>) -> Option<String> {
    let reason = text_curve(text, font.content()).err()?;
    Some(match font.name() {
        Some(name) => format!("{name:?} cannot draw this text: {reason}"),
        None => reason,
    })
}

/// A box around a text; flat along Z.
pub(super) fn text_bounds(text: &str, font: &Attachment<Face>, size: f64) -> Aabb {
    let arcs = text_profile(text, font, size);
    if arcs.is_empty() { Aabb::from_points([DVec3::ZERO]) } else { around(&arcs) }
}

/// A box around a profile; flat along Z.
pub(super) fn profile_bounds(corners: &[[f64; 2]], smooth: bool) -> Aabb {
    around(&profile_curve(corners, smooth))
}

fn around(arcs: &[ArcPiece]) -> Aabb {
    arcs.iter().fold(Aabb::EMPTY, |all, arc| all.union(&arc.bounds()))
}
