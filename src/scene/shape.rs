//! Shapes, each with its named parameters. The table below is the only list of them: the enum, the
//! file format, the inspector, the packing for the GPU, the tests and the golden sheet follow from it.
//!
//! To add one: an entry with its bounds here, `sdf_name` in `flat/twin/sdf.rs`, `sdf_name` in `shaders/sdf/`.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{Limits, POSITION, SIZE, THICKNESS};
use crate::geometry::Aabb;

/// Most numbers that the parameters of one shape may take.
pub const SHAPE_FLOATS: usize = 8;

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamValue {
    /// One number.
    Scalar(f64),
    /// Three numbers: a size or a point.
    Vector(DVec3),
}

/// A Rust type that a parameter can have.
trait ParamField: Copy {
    /// How many numbers it takes.
    const FLOATS: usize;
    fn to_value(self) -> ParamValue;
    fn from_value(value: ParamValue) -> Option<Self>;
}

impl ParamField for f64 {
    const FLOATS: usize = 1;
    fn to_value(self) -> ParamValue {
        ParamValue::Scalar(self)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Scalar(v) = value { Some(v) } else { None }
    }
}

impl ParamField for [f64; 3] {
    const FLOATS: usize = 3;
    fn to_value(self) -> ParamValue {
        ParamValue::Vector(self.into())
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Vector(v) = value { Some(v.to_array()) } else { None }
    }
}

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
    ($( $(#[doc = $doc:literal])+ $name:ident = $function:ident, $label:literal {
        $( $(#[doc = $help:literal])+ $param:ident: $type:ty = $default:expr, $limits:expr; )*
    } )+) => {
        /// A shape with its parameters, in metres, in local space.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
                match self { $( Self::$name => const { (0_usize $( + <$type as ParamField>::FLOATS )*).div_ceil(4) }, )+ }
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
                match *self { $( Self::$name { $( $param, )* } => vec![$( $param.to_value(), )*], )+ }
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

        /// Calls `$callback!(Name = sdf_name, …)` with every shape.
        macro_rules! for_each_shape {
            ($callback:ident) => { $callback! { $( $name = $function, )+ } };
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
}

impl Shape {
    /// The parameters in order, as the evaluators read them; unused places are 0.
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
            }
        }
        out
    }

    /// A box around the surface, in local space.
    pub fn bounds(&self) -> Aabb {
        let around = |half: DVec3| Aabb::from_center_half(DVec3::ZERO, half);
        match *self {
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

    #[test]
    fn every_parameter_can_be_read_written_and_packed() {
        for &kind in ShapeKind::ALL {
            let mut shape = kind.default_shape();
            assert_eq!(shape.kind(), kind);
            let values = shape.values();
            assert_eq!(values.len(), kind.params().len());
            let floats: usize = values.iter().map(|v| if matches!(v, ParamValue::Vector(_)) { 3 } else { 1 }).sum();
            assert!(floats <= SHAPE_FLOATS);
            for (i, value) in values.iter().enumerate() {
                let changed = match *value {
                    ParamValue::Scalar(v) => ParamValue::Scalar(v + 0.25),
                    ParamValue::Vector(v) => ParamValue::Vector(v + 0.25),
                };
                assert!(shape.set_value(i, changed));
                assert_eq!(shape.values()[i], changed);
            }
            assert!(!shape.set_value(values.len(), ParamValue::Scalar(1.0)));
        }
    }
}
