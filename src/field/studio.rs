//! Studios for solid shading: one material for everything, and lights that are fixed to the viewer. What a surface looks
//! like depends on its normal in the view, as by a material capture.

use super::flat_material::FlatMaterial;
use isolith_scene::{Environment, Material};

/// A light of a studio: where its light goes in the view (right, up, back), its color, and the sine of its angular radius.
pub type StudioLight = ([f64; 3], [f64; 3], f64);

/// What lights a scene without lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StudioLook {
    /// A key light from over the left shoulder and a weak one from the right.
    #[default]
    Clay,
    /// Large soft lights, which glaze mirrors.
    Porcelain,
    /// A hard key light and a cool rim from behind.
    Bronze,
    /// A warm key light, and a rim all around that looks as if light came through.
    Wax,
    /// Light surroundings, for the materials of the scene itself.
    Preview,
}

impl StudioLook {
    /// Its lights.
    pub(super) fn lights(self) -> &'static [StudioLight] {
        match self {
            Self::Clay | Self::Preview => {
                &[([0.55, -0.75, -0.9], [1.12, 1.08, 1.02], 0.0), ([-0.9, -0.1, -0.5], [0.16, 0.20, 0.28], 0.0)]
            }
            Self::Porcelain => &[
                ([0.6, -0.75, -0.8], [0.78, 0.77, 0.75], 0.3),
                ([-0.95, -0.15, -0.45], [0.20, 0.22, 0.26], 0.35),
                ([0.1, -0.5, 0.9], [0.42, 0.44, 0.48], 0.25),
            ],
            Self::Bronze => &[
                ([0.5, -0.8, -0.75], [1.9, 1.75, 1.5], 0.16),
                ([-0.9, 0.1, 0.35], [0.55, 0.75, 1.1], 0.3),
                ([-0.5, -0.6, -0.4], [0.4, 0.38, 0.36], 0.35),
            ],
            Self::Wax => &[
                ([0.55, -0.7, -0.85], [1.25, 1.12, 1.0], 0.12),
                ([0.9, 0.25, 0.45], [0.9, 0.55, 0.45], 0.35),
                ([-0.9, -0.2, 0.5], [1.0, 0.66, 0.52], 0.35),
            ],
        }
    }

    /// The one material of a solid shading.
    pub(super) fn material(self) -> FlatMaterial {
        let plain = Material::default();
        FlatMaterial::new(&match self {
            Self::Porcelain => Material {
                base_color: [0.74, 0.73, 0.70],
                specular_roughness: 0.5,
                coat_weight: 1.0,
                coat_roughness: 0.08,
                ..plain
            },
            Self::Bronze => {
                Material { base_color: [0.78, 0.45, 0.21], base_metalness: 1.0, specular_roughness: 0.36, ..plain }
            }
            Self::Wax => Material { base_color: [0.50, 0.085, 0.05], specular_roughness: 0.34, ..plain },
            // A warm gray between dark and light, so that both lights and shades show.
            Self::Clay | Self::Preview => {
                Material { base_color: [0.46, 0.45, 0.435], specular_roughness: 0.55, ..plain }
            }
        })
    }

    /// Its surroundings. Those of solid shadings are dark, so that the outline of a shape shows.
    pub(super) fn environment(self) -> Environment {
        let gray = |v: f64| [v, v * 1.02, v * 1.06];
        match self {
            Self::Preview => Environment::sky(gray(0.11), gray(0.32), gray(0.34)),
            Self::Bronze => Environment::sky(gray(0.03), gray(0.065), gray(0.30)),
            Self::Wax => Environment::sky(gray(0.03), gray(0.065), [0.34, 0.20, 0.18]),
            Self::Clay | Self::Porcelain => Environment::sky(gray(0.03), gray(0.065), gray(0.22)),
        }
    }
}
