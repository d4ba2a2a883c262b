//! Lights and the environment. A light shines along its node's local −Z.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{ATTENUATION, CONE, INTENSITY, NO_LIMITS, OCCLUSION_RADIUS, RANGE, SHADOW_QUALITY, UNIT};
use super::params::{Variants, nested_params, nested_variants, param_rows, param_struct, param_variants};

param_struct! {
    /// How a point or spot light weakens with distance d:
    /// 1 / (constant + linear d + quadratic d²), faded to zero at `range`.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Attenuation {
        /// Constant term of 1 / (constant + linear d + quadratic d²).
        constant: f64 = 1.0, ATTENUATION;
        /// Weakening per meter.
        linear: f64 = 0.0, ATTENUATION;
        /// Weakening per square meter.
        quadratic: f64 = 0.1, ATTENUATION;
        /// Nothing is lit beyond this distance.
        range: f64 = 50.0, RANGE;
    }
}
nested_params!(Attenuation);

/// What kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum LightKind {
    /// Parallel light, like the sun's.
    #[serde(rename = "directional")]
    Sun {},
    /// From a point into every direction.
    Point {
        /// Weakening with distance.
        attenuation: Attenuation,
    },
    /// From a point into a cone.
    Spot {
        /// Weakening with distance.
        attenuation: Attenuation,
        /// Half angle, in degrees, within which the light is full.
        inner: f64,
        /// Half angle, in degrees, at which it has faded out; at least `inner`.
        outer: f64,
    },
}

param_variants! { LightKind by |light| light.table(); {
    LightKind::Sun {}
    LightKind::Point { attenuation, }
    LightKind::Spot { attenuation, inner, outer, }
} }
nested_variants!(LightKind, "Type", "Where the light comes from; it shines along the node's −Z.");

impl LightKind {
    /// A spot light with default parameters.
    fn spot() -> Self {
        Self::Spot { attenuation: Attenuation::default(), inner: 20.0, outer: 30.0 }
    }

    /// The table of its parameters; [`Attenuation`] has its own table.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::Spot { .. } => param_rows! {
                /// Half angle within which the light is full.
                ["inner"] f64 = 20.0, CONE.labeled("Inner angle");
                /// Half angle at which the light has faded out; at least the inner angle.
                ["outer"] f64 = 30.0, CONE.labeled("Outer angle");
            },
            _ => &[],
        }
    }
}

impl Variants for LightKind {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (LightKind::Sun {}, "Sun", "Parallel light, like the sun's."),
            (LightKind::Point { attenuation: Attenuation::default() }, "Point", "From a point into every direction."),
            (LightKind::spot(), "Spot", "From a point into a cone."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            LightKind::Sun {} => 0,
            LightKind::Point { .. } => 1,
            LightKind::Spot { .. } => 2,
        }
    }
}

param_struct! {
    /// A light source.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Light {
        /// Linear color of the light.
        color: [f64; 3] = [1.0; 3], INTENSITY.color();
        /// Factor on the color.
        intensity: f64 = 2.0, INTENSITY;
        /// Sun, point or spot.
        light: LightKind = LightKind::Sun {}, NO_LIMITS;
    }
}

impl Light {
    /// White, of intensity 2.
    pub fn sun() -> Self {
        Self::default()
    }
}

param_struct! {
    /// The environment of a scene. Colors are linear.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Environment {
        /// Background above, at the zenith.
        sky: [f64; 3] = [0.055, 0.07, 0.095], INTENSITY.color();
        /// Background at and below the horizon.
        horizon: [f64; 3] = [0.16, 0.175, 0.20], INTENSITY.color();
        /// Light from everywhere, times the albedo; from above in full, from below at half strength.
        ambient: [f64; 3] = [0.26, 0.28, 0.32], INTENSITY.color();
        /// Shadows and occlusion.
        #[serde(default = "Shadowing::off")]
        shadowing: Shadowing = Shadowing::off(), NO_LIMITS;
    }
}

param_struct! {
    /// How objects of a scene take light from each other.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Shadowing {
        /// Lights cast shadows.
        shadows: bool = true, NO_LIMITS;
        /// Quality of soft shadows while the picture moves; the highest costs up to twice as much as the lowest.
        shadow_quality: f64 = 2.0, SHADOW_QUALITY;
        /// Light from everywhere reaches hollows and contacts less.
        occlusion: bool = true, NO_LIMITS;
        /// Nothing farther away occludes.
        occlusion_radius: f64 = 1.0, OCCLUSION_RADIUS;
        /// 1 for the occlusion that the shapes cause, 0 for none.
        occlusion_strength: f64 = 1.0, UNIT;
    }
}
nested_params!(Shadowing);

impl Shadowing {
    /// Neither shadows nor occlusion, as in scenes of version 1.
    pub fn off() -> Self {
        Self { shadows: false, occlusion: false, ..Self::default() }
    }

    /// Whether anything is on.
    pub fn is_on(&self) -> bool {
        self.shadows || self.occlusion
    }
}
