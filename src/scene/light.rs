//! Lights and the world. A light shines along its node's local −Z.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a point or spot light weakens with distance d:
/// 1 / (constant + linear d + quadratic d²), faded to zero at `range`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attenuation {
    /// Constant term.
    pub constant: f64,
    /// Per meter.
    pub linear: f64,
    /// Per square meter.
    pub quadratic: f64,
    /// Nothing is lit beyond this distance, in meters.
    pub range: f64,
}

impl Default for Attenuation {
    fn default() -> Self {
        Self { constant: 1.0, linear: 0.0, quadratic: 0.1, range: 50.0 }
    }
}

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

/// A light source.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Linear color.
    pub color: [f64; 3],
    /// Factor on the color.
    pub intensity: f64,
    /// Sun, point or spot.
    pub light: LightKind,
}

impl Light {
    /// White, of intensity 2.
    pub fn sun() -> Self {
        Self { color: [1.0; 3], intensity: 2.0, light: LightKind::Sun {} }
    }
}

/// What surrounds the scene. Colors are linear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Background above, at the zenith.
    pub sky: [f64; 3],
    /// Background at and below the horizon.
    pub horizon: [f64; 3],
    /// Light from everywhere, times the albedo; from above in full, from below at half strength.
    pub ambient: [f64; 3],
}

impl Default for Environment {
    fn default() -> Self {
        Self { sky: [0.055, 0.07, 0.095], horizon: [0.16, 0.175, 0.20], ambient: [0.26, 0.28, 0.32] }
    }
}
