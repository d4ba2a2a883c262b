//! The shapes: exact signed distances in local space, unless a function says otherwise. Each function takes the point
//! and the parameters of its shape, by the names of the table (`scene/shape.rs`). Its value is finite for every finite point and every
//! parameter within its hard limits.

mod ball;
mod cone;
mod fractal;
mod planar;
mod prism;
mod ring;
mod sheet;

pub use ball::{sdf_cut_sphere, sdf_death_star, sdf_hollow_cut_sphere, sdf_solid_angle, sdf_vesica};
pub use cone::{sdf_cone, sdf_infinite_cylinder, sdf_pyramid};
pub use fractal::{sdf_julia, sdf_kleinian, sdf_mandelbulb, sdf_menger_sponge};
pub use planar::{Data, Payload};
pub use prism::{sdf_prism, sdf_rhombus, sdf_star, sdf_triangular_prism};
pub use ring::{sdf_capped_torus, sdf_link, sdf_polygon_ring};
pub use sheet::{sdf_quad, sdf_triangle};

use super::Real;
use super::brick_field::sdf_mesh_field;
use super::ellipsoid::sdf_ellipsoid;
use super::heightfield::{sdf_heightmap, sdf_ocean, sdf_terrain};
use super::profile::{sdf_extrusion, sdf_revolution, sdf_text};
use super::tube::sdf_tube;
use isolith_scene::shape_params::{
    self, BoxFrameParams, BoxParams, CappedConeParams, CapsuleParams, CylinderParams, HexagonalPrismParams,
    OctahedronParams, PlaneParams, RoundConeParams, SphereParams, TorusParams,
};
use isolith_scene::{EvalParams, SHAPE_FLOATS, ShapeKind, for_each_shape};
use planar::{clamp, from_segment, trapezoid};
pub(super) use planar::{extruded, length2, length3};

/// Calls the function of a shape, with the payload if it takes one.
macro_rules! call {
    ($function:ident, $p:ident, $q:expr, $rows:ident) => {
        $function($p, $q)
    };
    ($function:ident, $p:ident, $q:expr, $rows:ident, data) => {
        $function($p, $q, $rows)
    };
}

macro_rules! dispatch {
    ($( $name:ident = $function:ident($params:ident) $(with $data:ident)?, )+) => {
        /// The field of a shape, by its kind and its packed parameters ([`isolith_scene::Shape::packed`]). `rows` is its
        /// payload, see [`crate::PreparedShape`]; most shapes have none.
        pub fn shape_distance<T: Real>(kind: ShapeKind, p: [T; 3], packed: &[f64; SHAPE_FLOATS], rows: Data<'_>) -> T {
            match kind { $(
                ShapeKind::$name => call!($function, p, &shape_params::$params::read(|i| packed[i]), rows $(, $data)?),
            )+ }
        }
    };
}
for_each_shape!(dispatch);

/// A ball.
pub fn sdf_sphere<T: Real>(p: [T; 3], q: &SphereParams) -> T {
    length3(p) - q.radius
}

/// The half space below the XZ plane.
pub fn sdf_plane<T: Real>(p: [T; 3], _: &PlaneParams) -> T {
    p[1]
}

/// A cuboid with rounded edges.
pub fn sdf_box<T: Real>(p: [T; 3], q: &BoxParams) -> T {
    let half = q.size.map(|size| 0.5 * size);
    let rounding = q.rounding.min(half[0].min(half[1].min(half[2])));
    let d = [0, 1, 2].map(|i| p[i].abs() - (half[i] - rounding));
    let most = d[0].max(d[1].max(d[2]));
    (if most.value() > 0.0 { length3(d.map(T::positive)) } else { most }) - rounding
}

/// The twelve edges of a cuboid, as bars.
///
/// Symmetry maps the point into the octant of positive coordinates. `inner` is the depth of the point within the
/// bars' width along each axis; bars that reach the middle have no inner side. A point that is deep along two axes
/// lies in the solid.
pub fn sdf_box_frame<T: Real>(p: [T; 3], q: &BoxFrameParams) -> T {
    let (half, thickness) = (q.size.map(|size| 0.5 * size), q.thickness);
    let outer = [0, 1, 2].map(|i| p[i].abs() - half[i]);
    let inner = [0, 1, 2].map(|i| if half[i] <= thickness { T::constant(1e18) } else { outer[i] + thickness });
    let side = [0, 1, 2].map(|i| outer[i].max(-inner[i]).positive());
    let along = outer.map(T::positive);
    let outside = length3([along[0], side[1], side[2]])
        .min(length3([side[0], along[1], side[2]]))
        .min(length3([side[0], side[1], along[2]]));
    if outside.value() > 0.0 {
        return outside;
    }
    // The way out leads through an outer face, or along the two shallowest axes into the hollow.
    let [x, y, z] = inner;
    let least = x.min(y).min(z);
    let middle = x.min(y).max(x.max(y).min(z));
    outer[0].max(outer[1]).max(outer[2]).max(-length2([least.positive(), middle.positive()]))
}

/// A ring around the Y axis. Inside a ring that closes its hole the value is a lower bound.
pub fn sdf_torus<T: Real>(p: [T; 3], q: &TorusParams) -> T {
    length2([length2([p[0], p[2]]) - q.major_radius, p[1]]) - q.minor_radius
}

/// A cylinder along the Y axis with rounded edges.
pub fn sdf_cylinder<T: Real>(p: [T; 3], q: &CylinderParams) -> T {
    let (radius, half_height) = (q.radius, 0.5 * q.height);
    let rounding = q.rounding.min(radius.min(half_height));
    let d = [length2([p[0], p[2]]) - (radius - rounding), p[1].abs() - (half_height - rounding)];
    extruded(d) - rounding
}

/// A cone along the Y axis, cut flat at both ends.
pub fn sdf_capped_cone<T: Real>(p: [T; 3], q: &CappedConeParams) -> T {
    trapezoid([length2([p[0], p[2]]), p[1]], q.bottom_radius, q.top_radius, q.height)
}

/// The hull of two balls on the Y axis.
pub fn sdf_round_cone<T: Real>(p: [T; 3], q: &RoundConeParams) -> T {
    let RoundConeParams { bottom_radius, top_radius, height } = *q;
    let narrowing = bottom_radius - top_radius;
    let at = [length2([p[0], p[2]]), p[1] + 0.5 * height];
    let bottom = length2(at) - bottom_radius;
    let top = length2([at[0], at[1] - height]) - top_radius;
    if narrowing.abs() >= height {
        // One ball holds the other.
        return if narrowing >= 0.0 { bottom } else { top };
    }
    // The unit normal of the slanted side; the balls touch it at `along` 0 and `cosine * height`.
    let sine = narrowing / height;
    let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
    let along = at[1] * cosine - at[0] * sine;
    if along.value() < 0.0 {
        bottom
    } else if along.value() > cosine * height {
        top
    } else {
        at[0] * cosine + at[1] * sine - bottom_radius
    }
}

/// All points within a distance of a segment.
pub fn sdf_capsule<T: Real>(p: [T; 3], q: &CapsuleParams) -> T {
    let from_start = [0, 1, 2].map(|i| p[i] - q.start[i]);
    let axis = [0, 1, 2].map(|i| q.end[i] - q.start[i]);
    length3(from_segment(from_start, axis)) - q.radius
}

/// A hexagonal prism along the Y axis; two sides face along X.
pub fn sdf_hexagonal_prism<T: Real>(p: [T; 3], q: &HexagonalPrismParams) -> T {
    let (radius, half_height) = (q.radius, 0.5 * q.height);
    // Fold the plane at its mirror lines until only the side that faces X remains.
    let (x, z) = (p[0].abs(), p[2].abs());
    let mirror = [-0.5, 0.75_f64.sqrt()];
    let behind = (x * mirror[0] + z * mirror[1]).positive() * 2.0_f64;
    let (x, z) = (x - behind * mirror[0], z - behind * mirror[1]);
    let half_side = radius / 3.0_f64.sqrt();
    let beside = [x - radius, (z.abs() - half_side).positive()];
    let d = if beside[0].value() > 0.0 { length2(beside) } else { beside[0] };
    extruded([d, p[1].abs() - half_height])
}

/// A regular octahedron with its corners on the axes.
///
/// In the positive octant the nearest point lies on the face if the foot on the plane lies within it, else on the
/// nearest edge (idea: Quilez, "octahedron distance").
pub fn sdf_octahedron<T: Real>(p: [T; 3], q: &OctahedronParams) -> T {
    let radius = q.radius;
    let [x, y, z] = p.map(T::abs);
    let excess = x + y + z - radius;
    let least = x.min(y).min(z);
    if 3.0 * least.value() >= excess.value() {
        return excess * (1.0 / 3.0_f64.sqrt());
    }
    // The foot on the plane has a negative least coordinate: the nearest edge is that of the two other axes.
    let edge = if x.value() == least.value() {
        [y, z]
    } else if y.value() == least.value() {
        [x, z]
    } else {
        [x, y]
    };
    let t = clamp((edge[1] - edge[0] + radius) * 0.5_f64, 0.0, radius);
    length3([least, edge[0] - radius + t, edge[1] - t])
}
