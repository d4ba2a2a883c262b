//! How a part of the scene is marched: in which order, between which distances, how exactly, with how many steps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{CUT_OFF, MARCH_ORDER, MARCH_STEPS, PRECISION};
use super::params::param_struct;

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
