//! Shapes, each with its named parameters. The table below is the only list of them: the enum, the
//! file format, the inspector, the packing for the GPU, the tests and the golden sheet follow from it.
//!
//! To add one: an entry with its bounds here, `sdf_name` in `flat/twin/sdf.rs`, `sdf_name` in `shaders/sdf/`.
//! One `with data` is evaluated from numbers that `flat::Body` makes of its parameters.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::drawn::{Corners, Points, profile_bounds, tube_bounds};
use super::limits::{COUNT, Limits, OCTAVES, POSITION, SEED, SIZE, THICKNESS, TURN, UNIT, WAVELENGTH};
use super::param::{ParamField, ParamValue};
use crate::geometry::Aabb;

/// Most numbers that the parameters of one shape may take.
pub const SHAPE_FLOATS: usize = 8;

/// Rows of the parameters of a shape with data.
const DATA_PARAMETER_ROWS: usize = 2;

/// What is known about a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Its name in files and, with spaces for underscores, in the inspector.
    pub name: &'static str,
    /// One sentence for people.
    pub help: &'static str,
    /// Accepted and offered ranges.
    pub limits: Limits,
}

macro_rules! shapes {
    ($( $(#[doc = $doc:literal])+ $name:ident = $function:ident $(with $data:ident)?, $label:literal {
        $( $(#[doc = $help:literal])+ $param:ident: $type:ty = $default:expr, $limits:expr; )*
    } )+) => {
        /// A shape with its parameters, in metres, in local space.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
        pub enum Shape {
            $( $(#[doc = $doc])+ $name { $( $(#[doc = $help])+ $param: $type, )* }, )+
        }

        /// Which shape, without its parameters. The number is the code that the GPU reads.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u32)]
        pub enum ShapeKind { $( $(#[doc = $doc])+ $name, )+ }

        impl ShapeKind {
            /// Every kind, in the order of the user interface.
            pub const ALL: &[Self] = &[$( Self::$name, )+];

            /// Name for people.
            pub fn label(self) -> &'static str {
                match self { $( Self::$name => $label, )+ }
            }

            /// What it is, for people.
            pub fn help(self) -> &'static str {
                match self { $( Self::$name => concat!($( $doc, )+).trim_ascii(), )+ }
            }

            /// The function that computes its field, on the CPU and on the GPU.
            pub fn function(self) -> &'static str {
                match self { $( Self::$name => stringify!($function), )+ }
            }

            /// Its parameters in order.
            pub fn params(self) -> &'static [Param] {
                match self { $( Self::$name => const { &[$( Param {
                    name: stringify!($param),
                    help: concat!($( $help, )+).trim_ascii(),
                    limits: $limits,
                }, )*] }, )+ }
            }

            /// How many rows of four numbers its parameters take, see [`Shape::packed`].
            pub fn rows(self) -> usize {
                if self.has_data() {
                    return DATA_PARAMETER_ROWS;
                }
                match self { $( Self::$name => const { (0_usize $( + <$type as ParamField>::FLOATS )*).div_ceil(4) }, )+ }
            }

            /// Whether it is evaluated from numbers made of its parameters, with further rows behind them.
            pub fn has_data(self) -> bool {
                match self { $( Self::$name => false $( || stringify!($data) == "data" )?, )+ }
            }

            /// The shape with its default parameters.
            pub fn default_shape(self) -> Shape {
                match self { $( Self::$name => Shape::$name { $( $param: $default, )* }, )+ }
            }
        }

        impl Shape {
            /// Which shape it is.
            pub fn kind(&self) -> ShapeKind {
                match self { $( Self::$name { .. } => ShapeKind::$name, )+ }
            }

            /// The parameters' values, in the order of [`ShapeKind::params`].
            pub fn values(&self) -> Vec<ParamValue> {
                match self { $( Self::$name { $( $param, )* } => vec![$( $param.to_value(), )*], )+ }
            }

            /// Sets the parameter at `index`; false, and nothing changed, where there is none or the
            /// value is of the other type.
            #[allow(unused_assignments, unused_mut, unused_variables, reason = "shapes without parameters")]
            pub fn set_value(&mut self, index: usize, value: ParamValue) -> bool {
                match self { $( Self::$name { $( $param, )* } => {
                    let mut i = 0;
                    $( if i == index {
                        let Some(v) = ParamField::from_value(value) else { return false };
                        *$param = v;
                        return true;
                    }
                    i += 1; )*
                    false
                } )+ }
            }
        }

        /// Calls `$callback!(Name = sdf_name, …)` with every shape; `with data` behind those that have data.
        macro_rules! for_each_shape {
            ($callback:ident) => { $callback! { $( $name = $function $(with $data)?, )+ } };
        }
        pub(crate) use for_each_shape;
    };
}

shapes! {
    /// A ball.
    Sphere = sdf_sphere, "Sphere" {
        /// Distance from the centre to the surface.
        radius: f64 = 0.5, SIZE;
    }
    /// A ball stretched along its axes; exact distance.
    Ellipsoid = sdf_ellipsoid, "Ellipsoid" {
        /// Half axes along X, Y and Z.
        radii: [f64; 3] = [0.7, 0.4, 0.5], SIZE;
    }
    /// A cuboid, its edges rounded inwards so that its size stays.
    Box = sdf_box, "Box" {
        /// Edge lengths.
        size: [f64; 3] = [1.0; 3], SIZE;
        /// Radius of the edges; at most half the shortest edge takes effect.
        rounding: f64 = 0.0, THICKNESS;
    }
    /// The twelve edges of a cuboid, as bars.
    BoxFrame = sdf_box_frame, "Box frame" {
        /// Outer edge lengths.
        size: [f64; 3] = [1.0; 3], SIZE;
        /// Width of the bars.
        thickness: f64 = 0.1, THICKNESS;
    }
    /// A ring around the Y axis.
    Torus = sdf_torus, "Torus" {
        /// From the axis to the middle of the tube.
        major_radius: f64 = 0.5, SIZE;
        /// Of the tube.
        minor_radius: f64 = 0.15, SIZE;
    }
    /// A cylinder along the Y axis, its edges rounded inwards.
    Cylinder = sdf_cylinder, "Cylinder" {
        /// From the axis to the side.
        radius: f64 = 0.5, SIZE;
        /// From cap to cap.
        height: f64 = 1.0, SIZE;
        /// Radius of the edges; at most the radius and half the height take effect.
        rounding: f64 = 0.0, THICKNESS;
    }
    /// A cone along the Y axis, cut flat at both ends.
    CappedCone = sdf_capped_cone, "Capped cone" {
        /// Radius of the lower cap.
        bottom_radius: f64 = 0.5, SIZE;
        /// Radius of the upper cap.
        top_radius: f64 = 0.2, SIZE;
        /// From cap to cap.
        height: f64 = 1.0, SIZE;
    }
    /// The hull of two balls on the Y axis.
    RoundCone = sdf_round_cone, "Round cone" {
        /// Radius of the lower ball, whose centre is the lower end.
        bottom_radius: f64 = 0.4, SIZE;
        /// Radius of the upper ball.
        top_radius: f64 = 0.2, SIZE;
        /// Between the centres of the balls; the origin is half-way.
        height: f64 = 0.8, SIZE;
    }
    /// Everything within a distance of a segment.
    Capsule = sdf_capsule, "Capsule" {
        /// One end of the segment.
        start: [f64; 3] = [0.0, -0.4, 0.0], POSITION;
        /// The other end.
        end: [f64; 3] = [0.0, 0.4, 0.0], POSITION;
        /// From the segment to the surface.
        radius: f64 = 0.25, SIZE;
    }
    /// Everything below the XZ plane; has no end.
    Plane = sdf_plane, "Plane" {}
    /// A hexagonal prism along the Y axis.
    HexagonalPrism = sdf_hexagonal_prism, "Hexagonal prism" {
        /// From the axis to the middle of a side; two sides face along X.
        radius: f64 = 0.5, SIZE;
        /// From cap to cap.
        height: f64 = 0.5, SIZE;
    }
    /// A regular octahedron with its corners on the axes.
    Octahedron = sdf_octahedron, "Octahedron" {
        /// From the centre to a corner.
        radius: f64 = 0.6, SIZE;
    }
    /// A round tube along a smooth curve through points; its ends are balls.
    Tube = sdf_tube with data, "Tube" {
        /// Points of the curve, each with a radius.
        points: Points = Points::new([[-0.6, -0.2, 0.0, 0.0], [-0.2, 0.25, 0.15, 0.0], [0.2, -0.25, -0.15, 0.0], [0.6, 0.2, 0.0, 0.0]]), POSITION;
        /// Added to the radius of each point.
        radius: f64 = 0.12, SIZE;
        /// Whether the curve returns to its first point.
        closed: bool = false, COUNT;
    }
    /// A drawn outline in the XY plane, as thick as its depth along Z.
    Extrusion = sdf_extrusion with data, "Extrusion" {
        /// Corners of the outline; the last is joined to the first.
        corners: Corners = Corners::star(5, 0.6, 0.28), POSITION;
        /// Whether the outline is a smooth curve through the corners.
        smooth: bool = false, COUNT;
        /// From face to face.
        depth: f64 = 0.3, SIZE;
        /// Radius of the edges of the faces, inwards.
        rounding: f64 = 0.0, THICKNESS;
    }
    /// A drawn outline in the XY plane, turned around the Y axis; what lies on the other side of the axis is left out.
    Revolution = sdf_revolution with data, "Revolution" {
        /// Corners of the outline; the last is joined to the first.
        corners: Corners = Corners::vase(), POSITION;
        /// Whether the outline is a smooth curve through the corners.
        smooth: bool = false, COUNT;
        /// How far the outline is moved away from the axis.
        offset: f64 = 0.0, POSITION;
    }
    /// Hills: fractal noise over a rectangle, solid down to a flat bottom.
    Terrain = sdf_terrain with data, "Terrain" {
        /// Width, depth of the ground below the mean height, length.
        size: [f64; 3] = [2.0, 0.4, 2.0], SIZE;
        /// Greatest height above and below the mean.
        amplitude: f64 = 0.35, SIZE;
        /// Size of the largest hills.
        wavelength: f64 = 0.8, WAVELENGTH;
        /// How many layers of ever finer noise.
        octaves: f64 = 5.0, OCTAVES;
        /// How high each layer is relative to the one before it.
        roughness: f64 = 0.45, UNIT;
        /// Another number, another landscape.
        seed: f64 = 1.0, SEED;
    }
    /// Water with waves over a rectangle, solid down to a flat bottom.
    Ocean = sdf_ocean with data, "Ocean" {
        /// Width, depth of the water, length.
        size: [f64; 3] = [2.0, 0.3, 2.0], SIZE;
        /// Height of the waves above and below the mean, all together.
        amplitude: f64 = 0.08, SIZE;
        /// Length of the longest wave.
        wavelength: f64 = 0.9, WAVELENGTH;
        /// How many waves.
        waves: f64 = 6.0, OCTAVES;
        /// Where they run to, seen from above: 0 is along X, 90 along Z.
        direction: f64 = 30.0, TURN;
        /// How far the waves run apart, to either side of the direction.
        spread: f64 = 50.0, TURN;
        /// How pointed the crests are.
        sharpness: f64 = 0.5, UNIT;
        /// Where the waves are in their motion: 360 is a whole turn of the longest.
        phase: f64 = 0.0, TURN;
    }
}

impl Shape {
    /// The parameters in order, as the evaluators read them; unused places are 0. Of a shape with data `flat::Body`
    /// makes what is read instead.
    pub fn packed(&self) -> [f64; SHAPE_FLOATS] {
        let mut out = [0.0; SHAPE_FLOATS];
        let mut at = 0;
        for value in self.values() {
            match value {
                ParamValue::Scalar(v) => {
                    out[at] = v;
                    at += 1;
                }
                ParamValue::Vector(v) => {
                    out[at..at + 3].copy_from_slice(&v.to_array());
                    at += 3;
                }
                ParamValue::Flag(_) | ParamValue::List(_) => {}
            }
        }
        out
    }

    /// A box around the surface, in local space.
    pub fn bounds(&self) -> Aabb {
        let around = |half: DVec3| Aabb::from_center_half(DVec3::ZERO, half);
        match *self {
            Self::Tube { ref points, radius, closed } => tube_bounds(points, radius, closed),
            Self::Extrusion { ref corners, smooth, depth, .. } => {
                let flat = profile_bounds(corners, smooth);
                let half = DVec3::Z * (0.5 * depth);
                Aabb::new(flat.min - half, flat.max + half)
            }
            Self::Revolution { ref corners, smooth, offset } => {
                let flat = profile_bounds(corners, smooth);
                let r = (flat.max.x + offset).max(0.0);
                Aabb::new(DVec3::new(-r, flat.min.y, -r), DVec3::new(r, flat.max.y, r))
            }
            Self::Terrain { size, amplitude, .. } | Self::Ocean { size, amplitude, .. } => {
                let [x, depth, z] = size;
                Aabb::new(DVec3::new(-0.5 * x, -depth, -0.5 * z), DVec3::new(0.5 * x, amplitude, 0.5 * z))
            }
            Self::Sphere { radius } | Self::Octahedron { radius } => around(DVec3::splat(radius)),
            Self::Ellipsoid { radii } => around(radii.into()),
            Self::Box { size, .. } | Self::BoxFrame { size, .. } => around(DVec3::from(size) * 0.5),
            Self::Torus { major_radius, minor_radius } => {
                let r = major_radius + minor_radius;
                around(DVec3::new(r, minor_radius, r))
            }
            Self::Cylinder { radius, height, .. } => around(DVec3::new(radius, height * 0.5, radius)),
            Self::CappedCone { bottom_radius, top_radius, height } => {
                let r = bottom_radius.max(top_radius);
                around(DVec3::new(r, height * 0.5, r))
            }
            Self::RoundCone { bottom_radius, top_radius, height } => {
                let r = bottom_radius.max(top_radius);
                let low = (-0.5 * height - bottom_radius).min(0.5 * height - top_radius);
                let high = (0.5 * height + top_radius).max(-0.5 * height + bottom_radius);
                Aabb::new(DVec3::new(-r, low, -r), DVec3::new(r, high, r))
            }
            Self::Capsule { start, end, radius } => Aabb::from_points([start.into(), end.into()]).expanded(radius),
            Self::Plane {} => Aabb::new(DVec3::NEG_INFINITY, DVec3::new(f64::INFINITY, 0.0, f64::INFINITY)),
            Self::HexagonalPrism { radius, height } => {
                // Two sides face along X, so corners lie on Z, 2/√3 farther out than the sides.
                around(DVec3::new(radius, height * 0.5, radius * 2.0 / 3.0_f64.sqrt()))
            }
        }
    }

    /// The shape whose field is exactly that of this one scaled by `s` (all positive) along its own
    /// axes, where there is one: non-uniform scale then costs nothing and loosens nothing.
    pub fn absorb_scale(&self, s: DVec3) -> Option<Self> {
        let uniform = s.x == s.y && s.y == s.z;
        let round = s.x == s.z;
        let times = |v: [f64; 3]| (DVec3::from(v) * s).to_array();
        Some(match *self {
            Self::Sphere { radius } if uniform => Self::Sphere { radius: radius * s.x },
            Self::Sphere { radius } => Self::Ellipsoid { radii: (s * radius).to_array() },
            Self::Ellipsoid { radii } => Self::Ellipsoid { radii: times(radii) },
            Self::Box { size, rounding } if uniform || rounding == 0.0 => {
                Self::Box { size: times(size), rounding: rounding * s.x }
            }
            Self::BoxFrame { size, thickness } if uniform => {
                Self::BoxFrame { size: times(size), thickness: thickness * s.x }
            }
            Self::Torus { major_radius, minor_radius } if uniform => {
                Self::Torus { major_radius: major_radius * s.x, minor_radius: minor_radius * s.x }
            }
            Self::Cylinder { radius, height, rounding } if uniform || (round && rounding == 0.0) => {
                Self::Cylinder { radius: radius * s.x, height: height * s.y, rounding: rounding * s.x }
            }
            Self::CappedCone { bottom_radius, top_radius, height } if round => Self::CappedCone {
                bottom_radius: bottom_radius * s.x,
                top_radius: top_radius * s.x,
                height: height * s.y,
            },
            Self::RoundCone { bottom_radius, top_radius, height } if uniform => Self::RoundCone {
                bottom_radius: bottom_radius * s.x,
                top_radius: top_radius * s.x,
                height: height * s.y,
            },
            Self::Capsule { start, end, radius } if uniform => {
                Self::Capsule { start: times(start), end: times(end), radius: radius * s.x }
            }
            Self::Plane {} => Self::Plane {},
            Self::HexagonalPrism { radius, height } if round => {
                Self::HexagonalPrism { radius: radius * s.x, height: height * s.y }
            }
            Self::Octahedron { radius } if uniform => Self::Octahedron { radius: radius * s.x },
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LIST_COLUMNS;

    #[test]
    fn every_parameter_can_be_read_written_and_packed() {
        for &kind in ShapeKind::ALL {
            let mut shape = kind.default_shape();
            assert_eq!(shape.kind(), kind);
            let values = shape.values();
            assert_eq!(values.len(), kind.params().len());
            let floats: usize = values.iter().map(|v| if matches!(v, ParamValue::Vector(_)) { 3 } else { 1 }).sum();
            assert!(kind.has_data() || floats <= SHAPE_FLOATS);
            for (i, value) in values.iter().enumerate() {
                let changed = match value {
                    ParamValue::Scalar(v) => ParamValue::Scalar(v + 0.25),
                    ParamValue::Vector(v) => ParamValue::Vector(*v + 0.25),
                    ParamValue::Flag(v) => ParamValue::Flag(!v),
                    ParamValue::List(list) => {
                        let mut list = list.clone();
                        list.rows.push([0.0; LIST_COLUMNS]);
                        ParamValue::List(list)
                    }
                };
                assert!(shape.set_value(i, changed.clone()));
                assert_eq!(shape.values()[i], changed);
            }
            assert!(!shape.set_value(values.len(), ParamValue::Scalar(1.0)));
        }
    }
}
