//! Lights. A light shines along its node's local −Z.
//!
//! Units are those of Blender: a sun's strength is its irradiance in W/m², the power of all others is in W. A white
//! Lambert surface that a sun of strength π meets head-on has a radiance of 1.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{
    ATTENUATION, CONE, INTENSITY, IRRADIANCE, LIGHT_POWER, LIGHT_RADIUS, LIGHT_SIDE, NO_LIMITS, RANGE, SUN_ANGLE,
};
use super::params::{Variants, nested_variants, param_rows, param_struct, param_variants};

/// How a light weakens with distance d.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Falloff {
    /// By 1 / d², as light does.
    InverseSquare {},
    /// By 1 / (constant + linear d + quadratic d²), faded to zero at `range`. Equal to the inverse square where that
    /// expression is d².
    Attenuation {
        /// Constant term.
        constant: f64,
        /// Linear term, per meter.
        linear: f64,
        /// Quadratic term, per square meter.
        quadratic: f64,
        /// Nothing is lit beyond this distance.
        range: f64,
    },
}

param_variants! { Falloff by |falloff| falloff.table(); {
    Falloff::InverseSquare {}
    Falloff::Attenuation { constant, linear, quadratic, range, }
} }
nested_variants!(Falloff, "Falloff", "How the light weakens with distance.");

impl Falloff {
    /// A gentle attenuation.
    const ATTENUATION: Self = Self::Attenuation { constant: 1.0, linear: 0.0, quadratic: 0.1, range: 50.0 };

    /// The table of its parameters.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::InverseSquare {} => &[],
            Self::Attenuation { .. } => param_rows! {
                /// Constant term of 1 / (constant + linear d + quadratic d²).
                ["constant"] f64 = 1.0, ATTENUATION;
                /// Weakening per meter.
                ["linear"] f64 = 0.0, ATTENUATION;
                /// Weakening per square meter.
                ["quadratic"] f64 = 0.1, ATTENUATION;
                /// Nothing is lit beyond this distance.
                ["range"] f64 = 50.0, RANGE;
            },
        }
    }
}

impl Variants for Falloff {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::InverseSquare {}, "Inverse square", "By the square of the distance, as light does."),
            (Self::ATTENUATION, "Attenuation", "By a polynomial of the distance, with an end."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            Self::InverseSquare {} => 0,
            Self::Attenuation { .. } => 1,
        }
    }
}

/// What kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum LightKind {
    /// Parallel light, like the sun's.
    Sun {
        /// Irradiance of a surface that faces it, in W/m².
        strength: f64,
        /// Its angular diameter, in degrees.
        angle: f64,
    },
    /// From a sphere into every direction.
    Point {
        /// Emitted power in W.
        power: f64,
        /// Radius of the sphere; 0 is a point.
        radius: f64,
        /// Weakening with distance.
        falloff: Falloff,
    },
    /// From a sphere into a cone.
    Spot {
        /// Power that a point light of the same brightness would emit, in W.
        power: f64,
        /// Radius of the sphere; 0 is a point.
        radius: f64,
        /// Weakening with distance.
        falloff: Falloff,
        /// Half angle, in degrees, within which the light is full.
        inner: f64,
        /// Half angle, in degrees, at which it has faded out; at least `inner`.
        outer: f64,
    },
    /// From one side of a rectangle.
    Rectangle {
        /// Emitted power in W.
        power: f64,
        /// Size along the node's X axis.
        width: f64,
        /// Size along the node's Y axis.
        height: f64,
    },
}

param_variants! { LightKind by |light| light.table(); {
    LightKind::Sun { strength, angle, }
    LightKind::Point { power, radius, falloff, }
    LightKind::Spot { power, radius, falloff, inner, outer, }
    LightKind::Rectangle { power, width, height, }
} }
nested_variants!(LightKind, "Type", "Where the light comes from; it shines along the node's −Z.");

/// The power of a new light, in W.
const NEW_POWER: f64 = 100.0;
/// The radius of a new light.
const NEW_RADIUS: f64 = 0.1;

impl LightKind {
    /// The sun as seen from Earth, with a strength that shows a white surface nearly white.
    pub const SUN: Self = Self::Sun { strength: 3.0, angle: 0.53 };
    /// A small sphere.
    pub const POINT: Self = Self::Point { power: NEW_POWER, radius: NEW_RADIUS, falloff: Falloff::InverseSquare {} };
    /// A small sphere that shines into a cone.
    pub const SPOT: Self = Self::Spot {
        power: NEW_POWER,
        radius: NEW_RADIUS,
        falloff: Falloff::InverseSquare {},
        inner: 20.0,
        outer: 30.0,
    };
    /// A square of one meter.
    pub const RECTANGLE: Self = Self::Rectangle { power: NEW_POWER, width: 1.0, height: 1.0 };

    /// The table of its parameters; [`Falloff`] has its own table.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::Sun { .. } => param_rows! {
                /// Irradiance of a surface that faces the sun; π shows a white one as white.
                ["strength"] f64 = 3.0, IRRADIANCE;
                /// Angular diameter of the sun; 0.53° as seen from Earth.
                ["angle"] f64 = 0.53, SUN_ANGLE.labeled("Angular size");
            },
            Self::Point { .. } => param_rows! {
                /// Emitted power.
                ["power"] f64 = NEW_POWER, LIGHT_POWER;
                /// Radius of the light; 0 is a point. Larger lights cast softer shadows and broader highlights.
                ["radius"] f64 = NEW_RADIUS, LIGHT_RADIUS;
            },
            Self::Spot { .. } => param_rows! {
                /// Power that a point light of the same brightness would emit.
                ["power"] f64 = NEW_POWER, LIGHT_POWER;
                /// Radius of the light; 0 is a point. Larger lights cast softer shadows and broader highlights.
                ["radius"] f64 = NEW_RADIUS, LIGHT_RADIUS;
                /// Half angle within which the light is full.
                ["inner"] f64 = 20.0, CONE.labeled("Inner angle");
                /// Half angle at which the light has faded out; at least the inner angle.
                ["outer"] f64 = 30.0, CONE.labeled("Outer angle");
            },
            Self::Rectangle { .. } => param_rows! {
                /// Emitted power.
                ["power"] f64 = NEW_POWER, LIGHT_POWER;
                /// Size along the node's X axis.
                ["width"] f64 = 1.0, LIGHT_SIDE;
                /// Size along the node's Y axis.
                ["height"] f64 = 1.0, LIGHT_SIDE;
            },
        }
    }
}

impl Variants for LightKind {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::SUN, "Sun", "Parallel light, like the sun's."),
            (Self::POINT, "Point", "From a sphere into every direction; with radius 0 from a point."),
            (Self::SPOT, "Spot", "From a sphere into a cone."),
            (Self::RECTANGLE, "Rectangle", "From one side of a rectangle, like a softbox."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            Self::Sun { .. } => 0,
            Self::Point { .. } => 1,
            Self::Spot { .. } => 2,
            Self::Rectangle { .. } => 3,
        }
    }
}

param_struct! {
    /// A light source.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct Light {
        /// Linear color of the light, a factor on its strength.
        color: [f64; 3] = [1.0; 3], INTENSITY.color();
        /// Whether what it does not reach is dark.
        cast_shadows: bool = true, NO_LIMITS;
        /// Sun, point, spot or rectangle.
        light: LightKind = LightKind::SUN, NO_LIMITS;
    }
}

impl Light {
    /// A white light of this kind.
    pub fn new(light: LightKind) -> Self {
        Self { light, ..Self::default() }
    }

    /// A white sun.
    pub fn sun() -> Self {
        Self::default()
    }
}
