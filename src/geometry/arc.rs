//! Circular arcs in space, straight pieces among them, and smooth curves made of arcs.
//!
//! An arc is represented from its middle, in a form that stays exact while its radius grows without limit: λ =
//! tan(θ/2) / κ gives a position on it, where θ is the angle from the middle and κ the curvature. On a straight piece
//! 2λ is the length from the middle.

use glam::DVec3;

use super::Aabb;

/// A piece of a circle, or of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcPiece {
    /// Its middle, in meters.
    pub middle: DVec3,
    /// Unit direction in the middle.
    pub tangent: DVec3,
    /// The vector toward the center with the length of one over the radius, perpendicular to the tangent; zero for a
    /// straight piece.
    pub bend: DVec3,
    /// λ at its end; the negative at its start.
    pub reach: f64,
}

/// An arc that leaves its chord by less than this fraction of the chord's length counts as straight.
const STRAIGHT: f64 = 1e-9;
/// The limit on the turn of an arc, just below a full turn, as cosine of half its turn plus one.
const LEAST_OPENING: f64 = 1e-2;

impl ArcPiece {
    /// The straight piece between two points, which may coincide.
    pub fn straight(from: DVec3, to: DVec3) -> Self {
        let chord = to - from;
        let tangent = chord.try_normalize().unwrap_or(DVec3::X);
        Self { middle: from + 0.5 * chord, tangent, bend: DVec3::ZERO, reach: 0.25 * chord.length() }
    }

    /// The arc from one point to another that leaves the first along the unit `direction`. Straight if it would be
    /// nearly a full circle.
    pub fn leaving(from: DVec3, direction: DVec3, to: DVec3) -> Self {
        let chord = to - from;
        let length = chord.length();
        let along = chord / length.max(f64::MIN_POSITIVE);
        // The turn is twice the angle between the direction and the chord.
        let cosine = along.dot(direction);
        let bow = (along * cosine - direction) / (1.0 + cosine).max(f64::MIN_POSITIVE);
        if length == 0.0 || 1.0 + cosine < LEAST_OPENING || bow.length() < STRAIGHT {
            return Self::straight(from, to);
        }
        Self {
            middle: from + 0.5 * chord - bow * (0.5 * length),
            tangent: along,
            bend: 2.0 * (along * cosine - direction) / length,
            reach: length / (2.0 * (1.0 + cosine)),
        }
    }

    /// The arc in the opposite direction.
    pub fn reversed(self) -> Self {
        Self { tangent: -self.tangent, ..self }
    }

    /// The point at λ.
    pub fn at(&self, lambda: f64) -> DVec3 {
        let share = 2.0 * lambda / (1.0 + self.bend.length_squared() * lambda * lambda);
        self.middle + (self.tangent + self.bend * lambda) * share
    }

    /// The start point.
    pub fn start(&self) -> DVec3 {
        self.at(-self.reach)
    }

    /// The end point.
    pub fn end(&self) -> DVec3 {
        self.at(self.reach)
    }

    /// The unit direction at λ.
    pub fn direction(&self, lambda: f64) -> DVec3 {
        let square = self.bend.length_squared() * lambda * lambda;
        (self.tangent * (1.0 - square) + self.bend * (2.0 * lambda)) / (1.0 + square)
    }

    /// Its length, in meters.
    pub fn length(&self) -> f64 {
        2.0 * self.way(self.reach)
    }

    /// The length along it from its middle to λ.
    pub fn way(&self, lambda: f64) -> f64 {
        let slope = self.bend.length() * lambda;
        if slope.abs() < 1e-4 {
            // The first terms of the series of the arc tangent.
            return 2.0 * lambda * (1.0 - slope * slope / 3.0 + slope.powi(4) / 5.0);
        }
        2.0 * lambda * slope.atan() / slope
    }

    /// The piece of it between two positions.
    pub fn between(&self, from: f64, to: f64) -> Self {
        Self::leaving(self.at(from), self.direction(from), self.at(to))
    }

    /// The interior positions where the coordinate along an axis is greatest or least; ascending.
    pub fn turns(&self, axis: usize) -> Vec<f64> {
        let (t, n, square) = (self.tangent[axis], self.bend[axis], self.bend.length_squared());
        // t (1 - κ²λ²) + 2 n λ = 0
        self.within(roots(t * square, -n, -t))
    }

    /// The positions where it crosses the plane perpendicular to an axis at `value`; ascending.
    pub fn crossings(&self, axis: usize, value: f64) -> Vec<f64> {
        let (m, t, n) = (self.middle[axis] - value, self.tangent[axis], self.bend[axis]);
        self.within(roots(m * self.bend.length_squared() + 2.0 * n, t, m))
    }

    fn within(&self, roots: [f64; 2]) -> Vec<f64> {
        let mut found: Vec<f64> = roots.into_iter().filter(|r| r.abs() < self.reach).collect();
        found.sort_by(f64::total_cmp);
        found
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        let turns = (0..3).flat_map(|axis| self.turns(axis)).map(|lambda| self.at(lambda));
        Aabb::from_points([self.start(), self.end()].into_iter().chain(turns))
    }
}

/// The roots of a x² + 2 b x + c; missing roots are infinite.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let square = b * b - a * c;
    if square < 0.0 {
        return [f64::INFINITY; 2];
    }
    let q = -(b + square.sqrt().copysign(b));
    let over = |v: f64, w: f64| if w == 0.0 { f64::INFINITY } else { v / w };
    [over(q, a), over(c, q)]
}

/// A smooth curve through points: two arcs with a common tangent (a biarc) between two neighbors. At a point the
/// curve has the direction from the point before it to the point after it (Catmull-Rom). One list of arcs for each
/// pair of neighbors; coinciding points have an arc without length between them.
pub fn smooth_curve(points: &[DVec3], closed: bool) -> Vec<Vec<ArcPiece>> {
    let count = points.len();
    let spans = if closed { count } else { count.saturating_sub(1) };
    let at = |i: usize| points[i % count];
    let inner = |i: usize| -> Option<DVec3> {
        if !closed && (i == 0 || i + 1 == count) {
            return None;
        }
        (at(i + 1) - at(i + count - 1)).try_normalize()
    };
    let tangents: Vec<Option<DVec3>> = (0..count).map(inner).collect();
    let span = |i: usize| {
        let (from, to) = (at(i), at(i + 1));
        let chord = to - from;
        let Some(along) = chord.try_normalize() else { return vec![ArcPiece::straight(from, to)] };
        match (tangents[i], tangents[(i + 1) % count]) {
            (Some(leaving), Some(arriving)) => biarc(from, leaving, to, arriving),
            (Some(leaving), None) => vec![ArcPiece::leaving(from, leaving, to)],
            // The last point's direction is known: the first piece is one arc.
            (None, Some(arriving)) => vec![ArcPiece::leaving(to, -arriving, from).reversed()],
            (None, None) => vec![ArcPiece::leaving(from, along, to)],
        }
    };
    (0..spans).map(span).collect()
}

/// A closed polygon through points.
pub fn straight_curve(points: &[DVec3]) -> Vec<Vec<ArcPiece>> {
    (0..points.len()).map(|i| vec![ArcPiece::straight(points[i], points[(i + 1) % points.len()])]).collect()
}

/// Two arcs from point to point with these unit directions at the ends. They join where both tangents are equally
/// long (Bolton, "Biarc curves", 1975).
pub fn biarc(from: DVec3, leaving: DVec3, to: DVec3, arriving: DVec3) -> Vec<ArcPiece> {
    let chord = to - from;
    // 2 (1 - a·b) d² + 2 v·(a + b) d - v² = 0
    let curve = 2.0 * (1.0 - leaving.dot(arriving));
    let half = chord.dot(leaving + arriving);
    let square = chord.length_squared();
    let below = half + (half * half + curve * square).max(0.0).sqrt();
    let length = square / below.max(f64::MIN_POSITIVE);
    if length.is_nan() || length > 8.0 * square.sqrt() {
        return vec![ArcPiece::straight(from, to)];
    }
    let joint = 0.5 * (from + leaving * length + to - arriving * length);
    vec![ArcPiece::leaving(from, leaving, joint), ArcPiece::leaving(to, -arriving, joint).reversed()]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn a_quarter_circle_is_what_it_should_be() {
        let arc = ArcPiece::leaving(DVec3::X, DVec3::Y, DVec3::Y);
        assert!((arc.length() - FRAC_PI_2).abs() < 1e-12);
        assert!((arc.bend.length() - 1.0).abs() < 1e-12);
        for i in 0..=10 {
            let lambda = arc.reach * (f64::from(i) * 0.2 - 1.0);
            assert!((arc.at(lambda).length() - 1.0).abs() < 1e-12);
            assert!(arc.at(lambda).dot(arc.direction(lambda)).abs() < 1e-12);
        }
        let half = ArcPiece::leaving(DVec3::X, DVec3::Y, -DVec3::X);
        assert!((half.length() - PI).abs() < 1e-12);
        assert!((half.bounds().max - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12, "{:?}", half.bounds());
        let crossing = half.crossings(0, 0.5);
        assert_eq!(crossing.len(), 1);
        assert!((half.at(crossing[0]) - DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)).length() < 1e-12);
    }

    #[test]
    fn smooth_curves_go_through_their_points_without_a_kink() {
        let points = [
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(1.0, 0.5, -0.3),
            DVec3::new(1.5, -0.7, 0.4),
            DVec3::new(0.2, -0.9, 1.0),
            DVec3::new(-0.8, 0.1, 0.6),
        ];
        for closed in [false, true] {
            let spans = smooth_curve(&points, closed);
            assert_eq!(spans.len(), if closed { 5 } else { 4 });
            let arcs: Vec<ArcPiece> = spans.iter().flatten().copied().collect();
            for pair in arcs.windows(2) {
                assert!(pair[0].end().distance(pair[1].start()) < 1e-9);
                let (a, b) = (pair[0].direction(pair[0].reach), pair[1].direction(-pair[1].reach));
                assert!(a.distance(b) < 1e-9, "{a} {b}");
            }
            for (span, point) in spans.iter().zip(points) {
                assert!(span[0].start().distance(point) < 1e-9);
            }
        }
    }

    #[test]
    fn odd_points_give_finite_arcs() {
        let odd = [DVec3::ZERO, DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::X * 1e9, DVec3::X * 1e9, DVec3::Y * 1e-30];
        for closed in [false, true] {
            for arc in smooth_curve(&odd, closed).iter().flatten() {
                assert!(arc.middle.is_finite() && arc.bend.is_finite() && arc.reach.is_finite(), "{arc:?}");
                assert!((arc.tangent.length() - 1.0).abs() < 1e-9 && arc.bounds().is_finite());
            }
        }
    }
}
