//! Shadows and occlusion of a scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{NO_LIMITS, OCCLUSION_RADIUS, SHADOW_QUALITY, UNIT};
use super::params::{nested_params, param_struct};

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
