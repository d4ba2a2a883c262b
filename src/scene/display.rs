//! How the light of a scene becomes the colors of a screen.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{EXPOSURE, NO_LIMITS};
use super::params::{choices, param_struct};

/// From the light of a scene, which has no upper limit, to that of a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ViewTransform {
    /// None: light above 1 is cut off.
    #[default]
    None,
    /// AgX by Troy Sobotka.
    Agx,
    /// Khronos PBR Neutral.
    PbrNeutral,
}

impl ViewTransform {
    /// Every view transform, in the order of the user interface.
    pub const ALL: [Self; 3] = [Self::None, Self::Agx, Self::PbrNeutral];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::None => "None",
            Self::Agx => "AgX",
            Self::PbrNeutral => "Khronos PBR Neutral",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::None => "Colors as they are; bright light is cut off",
            Self::Agx => "Like film: bright colors turn white softly, contrast is low",
            Self::PbrNeutral => "Base colors stay as they are; only bright light is compressed",
        }
    }
}

choices!(ViewTransform);

param_struct! {
    /// How the light of a scene becomes the colors of a screen.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct DisplaySettings {
        /// Stops of exposure: each one more doubles the light.
        exposure: f64 = 0.0, EXPOSURE;
        /// From the light of the scene to that of a screen.
        view_transform: ViewTransform = ViewTransform::None, NO_LIMITS;
    }
}
