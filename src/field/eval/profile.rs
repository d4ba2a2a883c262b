//! Extruded and revolved profiles. `crate::prepare::profile` defines their payload rows.

use super::Real;
use super::sdf::{Data, extruded, length2};
use isolith_scene::shape_params::{ExtrusionParams, RevolutionParams, TextParams};

/// A profile between two faces, with rounded edges. Exact without rounding where the face is nearer than the edge.
pub fn sdf_extrusion<T: Real>(p: [T; 3], q: &ExtrusionParams, rows: Data<'_>) -> T {
    between_faces(sdf_profile([p[0], p[1]], q.groups as usize, false, rows), p[2], q.half_depth, q.rounding)
}

/// A text between two faces. Overlapping letters are solid.
pub fn sdf_text<T: Real>(p: [T; 3], q: &TextParams, rows: Data<'_>) -> T {
    between_faces(sdf_profile([p[0], p[1]], q.groups as usize, true, rows), p[2], q.half_depth, q.rounding)
}

/// A profile turned around the Y axis; exact.
pub fn sdf_revolution<T: Real>(p: [T; 3], q: &RevolutionParams, rows: Data<'_>) -> T {
    sdf_profile([length2([p[0], p[2]]), p[1]], q.groups as usize, false, rows)
}

/// The part between two faces with rounded edges, from the distance to its profile.
fn between_faces<T: Real>(profile: T, z: T, half_depth: f64, rounding: f64) -> T {
    extruded([profile + rounding, z.abs() - (half_depth - rounding)]) - rounding
}

/// The signed distance in the plane to closed curves in `groups` groups; exact. A point is inside if the curves wind
/// around it an odd number of times, or, with `any`, any number of times but zero.
pub fn sdf_profile<T: Real>(p: [T; 2], groups: usize, any: bool, rows: Data<'_>) -> T {
    let at = p.map(T::value);
    let first = 1 + 2 * groups;
    let (mut least, mut nearest, mut turns) = (f64::INFINITY, first, 0);
    for group in 0..groups {
        let [_, _, from, count] = rows.row(2 + 2 * group);
        for piece in 0..count as usize {
            let row = first + 2 * (from as usize + piece);
            let [_, reach, low, high] = rows.row(row + 1);
            let place = Place::new(at, rows.row(row), rows.row(row + 1));
            let d = place.distance();
            if d < least {
                (least, nearest) = (d, row);
            }
            if low <= at[1] && at[1] < high && place.is_left() {
                turns += if reach < 0.0 { -1 } else { 1 };
            }
        }
    }
    let place = Place::new(p, rows.row(nearest), rows.row(nearest + 1));
    let d = if place.is_between() { place.aside().abs() } else { length2(place.way_from_end()) };
    let inside = if any { turns != 0 } else { turns % 2 != 0 };
    if inside { -d } else { d }
}

/// The position of a point relative to a piece: along it and to its left, from its middle.
struct Place<T> {
    x: T,
    y: T,
    across: T,
    rise: f64,
    bend: f64,
    reach: f64,
    /// λ of the foot.
    foot: f64,
}

impl<T: Real> Place<T> {
    fn new(p: [T; 2], first: [f64; 4], second: [f64; 4]) -> Self {
        let ([mx, my, tx, ty], [bend, reach, ..]) = (first, second);
        let w = [p[0] - mx, p[1] - my];
        let (x, y) = (w[0] * tx + w[1] * ty, w[1] * tx - w[0] * ty);
        let (along, u) = (x.value(), 1.0 - bend * y.value());
        let m = u.hypot(bend * along);
        let side = if along < 0.0 { -1.0 } else { 1.0 };
        let foot =
            if u >= 0.0 { along / (m + u).max(1e-30) } else { side * (m - u) / (bend * bend * along.abs()).max(1e-30) };
        Self { x, y, across: w[0], rise: ty, bend, reach: reach.abs(), foot }
    }

    /// Whether the foot lies between the ends.
    fn is_between(&self) -> bool {
        self.foot.abs() < self.reach
    }

    /// The distance to the right of the piece, for a foot between the ends.
    fn aside(&self) -> T {
        let u = self.y * -self.bend + 1.0_f64;
        let m = (u.squared() + (self.x * self.bend).squared()).sqrt();
        ((self.x.squared() + self.y.squared()) * self.bend - self.y * 2.0_f64) / (m + 1.0_f64)
    }

    /// The vector from the nearer end.
    fn way_from_end(&self) -> [T; 2] {
        let lambda = self.foot.clamp(-self.reach, self.reach);
        let share = 2.0 * lambda / (1.0 + self.bend * self.bend * lambda * lambda);
        [self.x - share, self.y - share * self.bend * lambda]
    }

    fn distance(&self) -> f64 {
        if self.is_between() { self.aside().value().abs() } else { length2(self.way_from_end()).value() }
    }

    /// Whether a point between the piece's heights is left of it. A piece that bends to the left is the right side of
    /// a circle: points left of the center or in the circle are left of the piece.
    fn is_left(&self) -> bool {
        let (x, y) = (self.x.value(), self.y.value());
        let from_circle = self.bend * (x * x + y * y) - 2.0 * y;
        let from_center = self.bend * self.across.value() + self.rise;
        if self.bend >= 0.0 { from_center < 0.0 || from_circle < 0.0 } else { from_center > 0.0 && from_circle < 0.0 }
    }
}
