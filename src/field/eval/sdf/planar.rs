//! Distances in the plane, for solids of revolution and prisms, and the payload type of shapes.

use crate::eval::Real;
use isolith_scene::PolygonSides;

/// The payload of a shape.
pub trait Payload {
    /// The row at an index.
    fn row(&self, index: usize) -> [f64; 4];
    /// The texel at an index, of shapes made of bricks.
    fn texel(&self, index: usize) -> [u32; 4];
}

/// A payload of rows only.
impl<F: Fn(usize) -> [f64; 4]> Payload for F {
    fn row(&self, index: usize) -> [f64; 4] {
        self(index)
    }
    fn texel(&self, _: usize) -> [u32; 4] {
        [0; 4]
    }
}

/// The payload of a shape, as its function gets it.
pub type Data<'a> = &'a dyn Payload;

/// Distance to a prism or a solid of revolution, from the distances to its profile and to its caps.
pub fn extruded<T: Real>(d: [T; 2]) -> T {
    let most = d[0].max(d[1]);
    if most.value() > 0.0 { length2(d.map(T::positive)) } else { most }
}

/// The vector from the nearest point of a segment to a point, which is given relative to the segment's start.
pub fn from_segment<T: Real, const N: usize>(from_start: [T; N], axis: [f64; N]) -> [T; N] {
    let t = along_segment(from_start, axis);
    std::array::from_fn(|i| from_start[i] - t * axis[i])
}

/// The position of the nearest point of a segment, as a fraction of its length: 0 and 1 at the ends.
fn along_segment<T: Real, const N: usize>(from_start: [T; N], axis: [f64; N]) -> T {
    let square: f64 = axis.iter().map(|a| a * a).sum();
    let dot = from_start.iter().zip(axis).fold(T::constant(0.0), |sum, (p, a)| sum + *p * a);
    clamp(dot * square.max(LEAST_SQUARE).recip(), 0.0, 1.0)
}

/// The least squared length of a segment; shorter ones are points.
const LEAST_SQUARE: f64 = 1e-30;

/// The position of a point of the plane, given relative to a segment's start: the vector from the nearest point, the
/// distance to the right of the segment's line, and whether the nearest point lies between the ends.
///
/// Between the ends that vector is along the line's normal. Close to the segment only rounding remains of it, so
/// neither its direction nor its side is meaningful there: both follow from the line.
fn beside_segment<T: Real>(from_start: [T; 2], axis: [f64; 2]) -> ([T; 2], T, bool) {
    let t = along_segment(from_start, axis);
    let side = [0, 1].map(|i| from_start[i] - t * axis[i]);
    let length = axis[0].hypot(axis[1]).max(1e-300);
    let over = from_start[0] * (axis[1] / length) - from_start[1] * (axis[0] / length);
    // For a segment below the least square, rounding dominates the nearest point.
    let is_line = axis[0] * axis[0] + axis[1] * axis[1] > LEAST_SQUARE;
    (side, over, is_line && t.value() > 0.0 && t.value() < 1.0)
}

/// The value within limits, constant beyond them.
pub fn clamp<T: Real>(v: T, low: f64, high: f64) -> T {
    if v.value() < low {
        T::constant(low)
    } else if v.value() > high {
        T::constant(high)
    } else {
        v
    }
}

/// Length of a vector of the plane.
pub fn length2<T: Real>(v: [T; 2]) -> T {
    (v[0].squared() + v[1].squared()).sqrt()
}

/// Length of a vector.
pub fn length3<T: Real>(v: [T; 3]) -> T {
    (v[0].squared() + v[1].squared() + v[2].squared()).sqrt()
}

/// The trapezoid between the half widths `bottom` and `top`; by symmetry `at[0]` is positive.
///
/// The nearest point lies on the nearer cap or on the slanted side (idea: Quilez, "distance functions").
pub fn trapezoid<T: Real>(at: [T; 2], bottom: f64, top: f64, height: f64) -> T {
    let half_height = 0.5 * height;
    let cap_radius = if at[1].value() < 0.0 { bottom } else { top };
    let cap = [(at[0] - cap_radius).positive(), at[1].abs() - half_height];
    // From top to bottom, the inside lies on the right.
    let (side, over, between) = beside_segment([at[0] - top, at[1] - half_height], [bottom - top, -height]);
    let over = -over;
    let inside = (if between { over } else { side[0] }).value() < 0.0 && cap[1].value() < 0.0;
    // Within the cap's radius the vector to the cap is vertical: its absolute value keeps a derivative at 0.
    let to_cap = if cap[0].value() > 0.0 { length2(cap) } else { cap[1].abs() };
    let to_side = if between { over.abs() } else { length2(side) };
    let least = if to_cap.value() <= to_side.value() { to_cap } else { to_side };
    if inside { -least } else { least }
}

/// Distance to a segment, negative on its left.
pub fn edge<T: Real>(at: [T; 2], start: [f64; 2], end: [f64; 2]) -> T {
    let axis = [end[0] - start[0], end[1] - start[1]];
    let (side, over, between) = beside_segment([at[0] - start[0], at[1] - start[1]], axis);
    let distance = if between { over.abs() } else { length2(side) };
    if over.value() < 0.0 { -distance } else { distance }
}

/// Turns and mirrors the plane so that all sides of a regular polygon coincide with half of the one that faces X.
pub fn sector<T: Real>(at: [T; 2], PolygonSides { count, cosine, sine }: PolygonSides) -> [T; 2] {
    let step = std::f64::consts::TAU / count;
    let (s, c) = (step * (at[1].value().atan2(at[0].value()) / step).round()).sin_cos();
    let (x, y) = (at[0] * c + at[1] * s, (at[1] * c - at[0] * s).abs());
    // Rounding may leave the point behind the mirror: reflect it back.
    let behind = (y * cosine - x * sine).positive() * 2.0_f64;
    [x + behind * sine, y - behind * cosine]
}

/// A regular polygon, `radius` from its center to the middle of a side; one side faces X.
pub fn polygon<T: Real>(at: [T; 2], sides: PolygonSides, radius: f64) -> T {
    let [x, y] = sector(at, sides);
    let beside = [x - radius, (y - radius * sides.sine / sides.cosine).positive()];
    if beside[0].value() > 0.0 { length2(beside) } else { beside[0] }
}
