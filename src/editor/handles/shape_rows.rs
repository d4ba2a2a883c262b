//! The table of the handles of shapes.

use glam::DVec3;

use super::measures::Measures;
use super::rows::{BOTH, HandleRow, Spot, zero};
use isolith_scene::ShapeKind;

fn x(_: &Measures<'_>) -> DVec3 {
    DVec3::X
}

fn y(_: &Measures<'_>) -> DVec3 {
    DVec3::Y
}

fn z(_: &Measures<'_>) -> DVec3 {
    DVec3::Z
}

fn back_x(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_X
}

fn down(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_Y
}

fn away_z(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_Z
}

/// Toward the silhouette of a ball.
fn ball(m: &Measures<'_>) -> DVec3 {
    m.outward()
}

/// Toward the silhouette of what is turned around the Y axis.
fn turned(m: &Measures<'_>) -> DVec3 {
    m.turned()
}

fn inward(m: &Measures<'_>) -> DVec3 {
    -m.turned()
}

/// A quarter of the height below the middle: off the arrows.
fn low(m: &Measures<'_>) -> DVec3 {
    DVec3::Y * (-0.25 * m.number("height"))
}

fn bottom(m: &Measures<'_>) -> DVec3 {
    DVec3::Y * (-0.5 * m.number("height"))
}

fn top(m: &Measures<'_>) -> DVec3 {
    DVec3::Y * (0.5 * m.number("height"))
}

fn size_corner(m: &Measures<'_>) -> DVec3 {
    m.vector("size") * 0.5
}

fn ring(m: &Measures<'_>) -> DVec3 {
    m.turned() * m.number("major_radius")
}

fn on_x(m: &Measures<'_>) -> DVec3 {
    DVec3::X * m.number("major_radius")
}

fn on_z(m: &Measures<'_>) -> DVec3 {
    DVec3::Z * m.number("major_radius")
}

fn rim_of_cylinder(m: &Measures<'_>) -> DVec3 {
    m.turned() * m.number("radius") + top(m)
}

fn side_of_prism(m: &Measures<'_>) -> DVec3 {
    DVec3::X * m.number("radius") + top(m)
}

fn tip_of_star(m: &Measures<'_>) -> DVec3 {
    DVec3::X * m.number("outer_radius") + top(m)
}

fn notch(m: &Measures<'_>) -> DVec3 {
    let (sine, cosine) = (std::f64::consts::PI / m.number("points").max(1.0)).sin_cos();
    DVec3::new(cosine, 0.0, sine)
}

fn tip_of_rhombus(m: &Measures<'_>) -> DVec3 {
    DVec3::Z * (0.5 * m.number("depth")) + top(m)
}

/// The middle of the side toward −Z.
fn back_side(m: &Measures<'_>) -> DVec3 {
    DVec3::Z * (-0.5 * m.number("depth"))
}

fn front_side(m: &Measures<'_>) -> DVec3 {
    DVec3::Z * (0.5 * m.number("depth"))
}

fn middle_of_capsule(m: &Measures<'_>) -> DVec3 {
    (m.vector("start") + m.vector("end")) * 0.5
}

fn across_capsule(m: &Measures<'_>) -> DVec3 {
    m.across(m.vector("end") - m.vector("start"))
}

/// The middle of the rim of a bowl's skin.
fn rim_of_bowl(m: &Measures<'_>) -> DVec3 {
    let radius = m.number("radius");
    let cut = m.number("cut").clamp(-radius, radius);
    m.turned() * (radius * radius - cut * cut).sqrt() + DVec3::Y * cut
}

fn cutter(m: &Measures<'_>) -> DVec3 {
    DVec3::Y * m.number("distance")
}

fn first_point(m: &Measures<'_>) -> DVec3 {
    m.rows("points").first().map_or(DVec3::ZERO, |[x, y, z, radius]| DVec3::new(*x, *y, *z) + m.up * *radius)
}

fn view_up(m: &Measures<'_>) -> DVec3 {
    m.up
}

fn first_corner(m: &Measures<'_>) -> DVec3 {
    let corner = m.rows("corners").first().map_or(DVec3::ZERO, |[x, y, ..]| DVec3::new(*x, *y, 0.0));
    corner + DVec3::Z * (0.5 * m.number("depth"))
}

/// From the first corner toward the middle.
fn into_profile(m: &Measures<'_>) -> DVec3 {
    let corner = first_corner(m) - DVec3::Z * (0.5 * m.number("depth"));
    (-corner).normalize_or(DVec3::NEG_X)
}

fn middle_of_bounds(m: &Measures<'_>) -> DVec3 {
    let bounds = m.bounds();
    if bounds.is_empty() { DVec3::ZERO } else { bounds.center() * DVec3::new(1.0, 1.0, 0.0) }
}

fn above_lathe(m: &Measures<'_>) -> DVec3 {
    let bounds = m.bounds();
    if bounds.is_empty() { DVec3::ZERO } else { DVec3::Y * (bounds.max.y + 0.15 * m.reach) }
}

fn shifted_corners(m: &Measures<'_>) -> DVec3 {
    DVec3::X * m.number("offset")
}

fn end_of_text(m: &Measures<'_>) -> DVec3 {
    let bounds = m.bounds();
    if bounds.is_empty() { DVec3::ZERO } else { DVec3::new(bounds.max.x, 0.0, 0.0) }
}

fn corner_of_text(m: &Measures<'_>) -> DVec3 {
    end_of_text(m) + DVec3::Z * (0.5 * m.number("depth"))
}

fn height_of_text(m: &Measures<'_>) -> f64 {
    let (size, bounds) = (m.number("size"), m.bounds());
    if size > 0.0 && !bounds.is_empty() && bounds.max.y > 0.0 { bounds.max.y / size } else { 0.7 }
}

fn corner_of_land(m: &Measures<'_>) -> DVec3 {
    let size = m.vector("size");
    DVec3::new(-0.5 * size.x, m.number("amplitude"), 0.5 * size.z)
}

fn half(_: &Measures<'_>) -> f64 {
    0.5
}

fn radius(m: &Measures<'_>) -> f64 {
    m.number("radius")
}

fn major_radius(m: &Measures<'_>) -> f64 {
    m.number("major_radius")
}

fn reach(m: &Measures<'_>) -> f64 {
    m.reach
}

fn least_half_size(m: &Measures<'_>) -> f64 {
    0.5 * m.vector("size").min_element()
}

fn least_half(m: &Measures<'_>) -> f64 {
    m.number("radius").min(0.5 * m.number("height"))
}

fn half_height(m: &Measures<'_>) -> f64 {
    0.5 * m.number("height")
}

fn half_depth(m: &Measures<'_>) -> f64 {
    0.5 * m.number("depth")
}

const fn size(axis: usize) -> HandleRow {
    HandleRow::extent("size", axis).element(axis)
}

const fn along(param: &'static str, origin: Spot, direction: Spot) -> HandleRow {
    HandleRow::along(param, origin, direction)
}

const fn half_axis(axis: usize) -> HandleRow {
    HandleRow::extent("radii", axis).element(axis).shaped(1.0, zero, BOTH)
}

const HEIGHT: HandleRow = HandleRow::extent("height", 1);
const DEPTH: HandleRow = HandleRow::extent("depth", 2);
const BALL: &[HandleRow] = &[along("radius", zero, ball)];
const SIDE: HandleRow = along("radius", low, turned);
const GROUND: [HandleRow; 3] = [size(0), along("size", zero, down).element(1), size(2)];

const BOX: &[HandleRow] = &[size(0), size(1), size(2), along("rounding", size_corner, back_x).at_most(least_half_size)];
const BOX_FRAME: &[HandleRow] =
    &[size(0), size(1), size(2), along("thickness", size_corner, back_x).at_most(least_half_size)];
const TORUS: &[HandleRow] = &[along("major_radius", zero, turned), along("minor_radius", ring, y)];
const CYLINDER: &[HandleRow] = &[SIDE, HEIGHT, along("rounding", rim_of_cylinder, inward).at_most(least_half)];
const CONES: &[HandleRow] = &[along("bottom_radius", bottom, turned), along("top_radius", top, turned), HEIGHT];
const CAPSULE: &[HandleRow] =
    &[HandleRow::point("start"), HandleRow::point("end"), along("radius", middle_of_capsule, across_capsule)];
const HEXAGON: &[HandleRow] = &[along("radius", low, x), HEIGHT];
const CAPPED_TORUS: &[HandleRow] = &[
    along("major_radius", zero, x),
    along("minor_radius", on_x, y),
    HandleRow::angle("half_angle", x, z, major_radius, 1.0),
];
const LINK: &[HandleRow] =
    &[HandleRow::extent("length", 0), along("major_radius", zero, z), along("minor_radius", on_z, y)];
const INFINITE_CONE: &[HandleRow] = &[HandleRow::angle("half_angle", down, turned, reach, 1.0)];
const TRIANGULAR_PRISM: &[HandleRow] = &[HandleRow::extent("width", 0).shaped(0.5, back_side, BOTH), DEPTH, HEIGHT];
const PRISM: &[HandleRow] =
    &[along("radius", low, x), HEIGHT, along("rounding", side_of_prism, back_x).at_most(least_half)];
const PYRAMID: &[HandleRow] = &[HandleRow::extent("width", 0).shaped(0.5, bottom, BOTH), HEIGHT];
const RHOMBUS: &[HandleRow] =
    &[HandleRow::extent("width", 0), DEPTH, HEIGHT, along("rounding", tip_of_rhombus, away_z).at_most(half_height)];
const DOME: &[HandleRow] = &[along("radius", zero, ball), along("cut", zero, y).at_most(radius)];
const BOWL: &[HandleRow] = &[
    along("radius", zero, down),
    along("cut", zero, y).at_most(radius),
    HandleRow::part_along("thickness", rim_of_bowl, turned, half),
];
const DEATH_STAR: &[HandleRow] =
    &[along("radius", zero, ball), along("distance", zero, y), along("cut_radius", cutter, turned)];
const SOLID_ANGLE: &[HandleRow] = &[along("radius", zero, y), HandleRow::angle("half_angle", y, turned, radius, 1.0)];
const SPINDLE: &[HandleRow] = &[HEIGHT, HandleRow::part_along("width", zero, turned, half)];
const TRIANGLE: &[HandleRow] = &[
    HandleRow::extent("width", 0).shaped(0.5, back_side, BOTH),
    DEPTH.shaped(0.5, zero, &[-1.0]),
    along("skew", front_side, x),
    HandleRow::part_along("thickness", zero, y, half),
];
const QUAD: &[HandleRow] = &[
    HandleRow::extent("width", 0),
    DEPTH.shaped(0.5, zero, &[-1.0]),
    along("skew", front_side, x),
    HandleRow::part_along("thickness", zero, y, half),
];
const STAR: &[HandleRow] = &[
    along("outer_radius", zero, x),
    along("inner_radius", zero, notch),
    HEIGHT,
    along("rounding", tip_of_star, back_x).at_most(half_height),
];
const POLYGON_RING: &[HandleRow] = &[along("major_radius", zero, x), along("minor_radius", on_x, x)];
const SPONGE: &[HandleRow] = &[HandleRow::part_along("size", zero, x, half)];
const TUBE: &[HandleRow] = &[HandleRow::list("points", false, zero), along("radius", first_point, view_up)];
const EXTRUSION: &[HandleRow] = &[
    HandleRow::list("corners", true, zero),
    DEPTH.shaped(0.5, middle_of_bounds, BOTH),
    along("rounding", first_corner, into_profile).at_most(half_depth),
];
const LATHE: &[HandleRow] = &[HandleRow::list("corners", true, shifted_corners), along("offset", above_lathe, x)];
const TEXT: &[HandleRow] = &[
    HandleRow::part_along("size", end_of_text, y, height_of_text),
    DEPTH.shaped(0.5, middle_of_bounds, BOTH),
    along("rounding", corner_of_text, back_x).at_most(half_depth),
];
const AMPLITUDE: HandleRow = along("amplitude", zero, y);
const WAVELENGTH: HandleRow = along("wavelength", corner_of_land, x);
const TERRAIN: &[HandleRow] = &[GROUND[0], GROUND[1], GROUND[2], AMPLITUDE, WAVELENGTH];
const HEIGHTMAP: &[HandleRow] = &[GROUND[0], GROUND[1], GROUND[2], along("height", zero, y)];

/// The rows of a shape; the tests ask for one for every length and angle.
pub fn rows(kind: ShapeKind) -> &'static [HandleRow] {
    use ShapeKind as Of;
    match kind {
        Of::Sphere | Of::Julia | Of::Kleinian | Of::Mandelbulb => BALL,
        Of::Ellipsoid => const { &[half_axis(0), half_axis(1), half_axis(2)] },
        Of::Box => BOX,
        Of::BoxFrame => BOX_FRAME,
        Of::Torus => TORUS,
        Of::Cylinder => CYLINDER,
        Of::CappedCone | Of::RoundCone => CONES,
        Of::Capsule => CAPSULE,
        Of::Plane | Of::MeshField => &[],
        Of::HexagonalPrism => HEXAGON,
        Of::Octahedron => const { &[along("radius", zero, y)] },
        Of::CappedTorus => CAPPED_TORUS,
        Of::Link => LINK,
        Of::Cone => INFINITE_CONE,
        Of::InfiniteCylinder => const { &[along("radius", zero, turned)] },
        Of::TriangularPrism => TRIANGULAR_PRISM,
        Of::Prism => PRISM,
        Of::Pyramid => PYRAMID,
        Of::Rhombus => RHOMBUS,
        Of::CutSphere => DOME,
        Of::HollowCutSphere => BOWL,
        Of::DeathStar => DEATH_STAR,
        Of::SolidAngle => SOLID_ANGLE,
        Of::Vesica => SPINDLE,
        Of::Triangle => TRIANGLE,
        Of::Quad => QUAD,
        Of::Star => STAR,
        Of::PolygonRing => POLYGON_RING,
        Of::MengerSponge => SPONGE,
        Of::Tube => TUBE,
        Of::Extrusion => EXTRUSION,
        Of::Revolution => LATHE,
        Of::Text => TEXT,
        Of::Terrain | Of::Ocean => TERRAIN,
        Of::Heightmap => HEIGHTMAP,
    }
}
