//! The environment of a scene: what is seen behind it, and the light from there. Colors are linear.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use super::environment_image::EnvironmentImage;
use super::limits::{ENVIRONMENT_STRENGTH, INTENSITY, NO_LIMITS, TURN};
use super::params::{Variants, nested_variants, param_rows, param_struct, param_variants};

/// What kind of environment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum EnvironmentKind {
    /// The same light from everywhere.
    Color {
        /// Color of the background, and of the light.
        color: [f64; 3],
    },
    /// A sky, with ambient light that does not depend on its colors.
    Gradient {
        /// Background above, at the zenith.
        sky: [f64; 3],
        /// Background at and below the horizon.
        horizon: [f64; 3],
        /// Light from everywhere, times the albedo; from above in full, from below at half strength.
        ambient: [f64; 3],
    },
    /// An image of everything around the scene, which also lights it.
    Image {
        /// Its middle is in the direction −Z, its upper edge above.
        #[serde(default)]
        image: Attachment<EnvironmentImage>,
        /// Factor on its colors.
        strength: f64,
        /// Turn about the vertical axis, in degrees: counterclockwise as seen from above.
        rotation: f64,
    },
}

param_variants! { EnvironmentKind by |environment| environment.table(); {
    EnvironmentKind::Color { color, }
    EnvironmentKind::Gradient { sky, horizon, ambient, }
    EnvironmentKind::Image { image, strength, rotation, }
} }
nested_variants!(EnvironmentKind, "Background", "What is seen behind the scene, and lights it.");

impl EnvironmentKind {
    /// A gray sky.
    pub const SKY: Self =
        Self::Gradient { sky: [0.055, 0.07, 0.095], horizon: [0.16, 0.175, 0.20], ambient: [0.26, 0.28, 0.32] };

    /// The table of its parameters.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::Color { .. } => param_rows! {
                /// Color of the background, and of the light from there.
                ["color"] [f64; 3] = [0.2; 3], INTENSITY.color();
            },
            Self::Gradient { .. } => param_rows! {
                /// Background above, at the zenith.
                ["sky"] [f64; 3] = [0.055, 0.07, 0.095], INTENSITY.color();
                /// Background at and below the horizon.
                ["horizon"] [f64; 3] = [0.16, 0.175, 0.20], INTENSITY.color();
                /// Light from everywhere, times the albedo; from above in full, from below at half strength.
                ["ambient"] [f64; 3] = [0.26, 0.28, 0.32], INTENSITY.color();
            },
            Self::Image { .. } => param_rows! {
                /// Image of everything around the scene, twice as wide as high; its middle is in the direction −Z.
                ["image"] Attachment<EnvironmentImage> = Attachment::NONE, NO_LIMITS;
                /// Factor on the colors of the image.
                ["strength"] f64 = 1.0, ENVIRONMENT_STRENGTH;
                /// Turn about the vertical axis, counterclockwise as seen from above.
                ["rotation"] f64 = 0.0, TURN;
            },
        }
    }
}

impl Variants for EnvironmentKind {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        let image = Self::Image { image: Attachment::NONE, strength: 1.0, rotation: 0.0 };
        vec![
            (Self::Color { color: [0.2; 3] }, "Color", "The same light from everywhere."),
            (Self::SKY, "Sky", "A gradient, with ambient light of its own color."),
            (image, "Image", "An image of everything around the scene."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            Self::Color { .. } => 0,
            Self::Gradient { .. } => 1,
            Self::Image { .. } => 2,
        }
    }
}

param_struct! {
    /// The environment of a scene.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Environment {
        /// What is seen behind the scene, and lights it.
        background: EnvironmentKind = EnvironmentKind::SKY, NO_LIMITS;
    }
}

impl Environment {
    /// A sky with these colors.
    pub fn sky(sky: [f64; 3], horizon: [f64; 3], ambient: [f64; 3]) -> Self {
        Self { background: EnvironmentKind::Gradient { sky, horizon, ambient } }
    }

    /// Its image, if it has one.
    pub fn image(&self) -> Option<&Attachment<EnvironmentImage>> {
        match &self.background {
            EnvironmentKind::Image { image, .. } => Some(image),
            _ => None,
        }
    }

    /// The colors of sky, horizon and ambient light; of other kinds a color that stands for them, and no light.
    pub fn gradient(&self) -> [[f64; 3]; 3] {
        match &self.background {
            EnvironmentKind::Color { color } => [*color, *color, [0.0; 3]],
            EnvironmentKind::Gradient { sky, horizon, ambient } => [*sky, *horizon, *ambient],
            EnvironmentKind::Image { .. } => [[0.1; 3], [0.1; 3], [0.0; 3]],
        }
    }
}
