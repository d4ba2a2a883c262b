//! How a part of the scene is marched: in which order, between which distances, how exactly, with how many steps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{CUT_OFF, MARCH_ORDER, MARCH_STEPS, NO_LIMITS, PRECISION};
use super::params::{choices, param_struct};

/// How many pixels of a part are traced; those between take the distances of their neighbors where these show the same
/// surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MarchResolution {
    /// All.
    #[default]
    Full,
    /// Every second one along each axis.
    Half,
    /// Every fourth one along each axis.
    Quarter,
}

impl MarchResolution {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Full, Self::Half, Self::Quarter];

    fn label(self) -> &'static str {
        match self {
            Self::Full => "Full",
            Self::Half => "1/2",
            Self::Quarter => "1/4",
        }
    }

    fn help(self) -> &'static str {
        match self {
            Self::Full => "A ray for each pixel.",
            Self::Half => "A ray for every second pixel along each axis, and for those at edges.",
            Self::Quarter => "A ray for every fourth pixel along each axis, and for those at edges.",
        }
    }

    /// Pixels from one ray to the next.
    pub fn spacing(self) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }
}

choices!(MarchResolution);

param_struct! {
    /// How the parts below a node are marched by the rays of the eye. Their shadows do not change.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    pub struct MarchSettings {
        /// Parts with a lower number are marched before all others; those with the same from front to back.
        order: u32 = 0, MARCH_ORDER;
        /// Nearer to the eye nothing of it is drawn.
        near: f64 = 0.0, CUT_OFF.labeled("Draw from");
        /// Farther from the eye nothing of it is drawn; 0 for no limit.
        far: f64 = 0.0, CUT_OFF.labeled("Draw up to");
        /// How exactly rays close in on its surface; at 0.1 with ten times the error of 1, a hundredth of a pixel.
        precision: f64 = 1.0, PRECISION;
        /// Most steps of a ray through it, or through one of its copies; rays that need more pass it. 0 for no limit.
        steps: u32 = 0, MARCH_STEPS.labeled("Most steps");
        /// How many of its pixels get rays of their own. Those between take their distances from their neighbors where
        /// these show one smooth surface; what is smaller than the gaps may be missed. Parts that rays may pass ignore it.
        resolution: MarchResolution = MarchResolution::Full, NO_LIMITS;
    }
}

impl MarchSettings {
    /// Whether all settings are the usual ones.
    pub fn is_usual(&self) -> bool {
        *self == Self::default()
    }

    /// Where it ends, in meters from the eye; infinite without a limit.
    pub fn end(&self) -> f64 {
        if self.far > 0.0 { self.far } else { f64::INFINITY }
    }
}
