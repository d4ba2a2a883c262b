//! Materials. Objects share them by id, so that one edit changes every object that uses a material.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::limits::{INTENSITY, IOR, LUMINANCE, NO_LIMITS, SHININESS, SPECULAR, UNIT};
use super::params::{Variants, nested_variants, param_rows, param_struct, param_variants};
use super::texture::Textures;
use super::whole;

/// Stable identity of a material; never reused within a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct MaterialId(pub u64);

impl<'de> Deserialize<'de> for MaterialId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        whole::read(deserializer).map(Self)
    }
}

impl std::fmt::Display for MaterialId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.0)
    }
}

param_struct! {
    /// The look of a surface, by the names, ranges and defaults of OpenPBR 1.1. Colors are linear Rec. 709.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default = "Material::unnamed")]
    pub struct Material [
        /// Identity.
        id: MaterialId = MaterialId(1);
        /// Name for people.
        name: String = "Clay".into();
    ] {
        /// Color of the diffuse reflection, and of the reflection of a metal.
        base_color: [f64; 3] = [0.8; 3], UNIT.color();
        /// Factor on the base color.
        base_weight: f64 = 1.0, UNIT;
        /// 0 for a dielectric such as plastic, 1 for a metal.
        base_metalness: f64 = 0.0, UNIT.labeled("Metalness");
        /// Roughness of the diffuse reflection; 0 is Lambert's.
        base_diffuse_roughness: f64 = 0.0, UNIT.labeled("Diffuse roughness");
        /// Strength of the specular reflection.
        specular_weight: f64 = 1.0, SPECULAR;
        /// Tint of the specular reflection.
        specular_color: [f64; 3] = [1.0; 3], UNIT.color();
        /// 0 is a mirror, 1 has a wide and weak highlight.
        specular_roughness: f64 = 0.3, UNIT.labeled("Roughness");
        /// Index of refraction; sets how much a dielectric reflects.
        specular_ior: f64 = 1.5, IOR.labeled("Index of refraction");
        /// Share of the surface that a clear coat covers.
        coat_weight: f64 = 0.0, UNIT;
        /// Tint of what is seen through the coat.
        coat_color: [f64; 3] = [1.0; 3], UNIT.color();
        /// Roughness of the coat.
        coat_roughness: f64 = 0.0, UNIT;
        /// Index of refraction of the coat.
        coat_ior: f64 = 1.6, IOR.labeled("Coat index of refraction");
        /// How much the light that the coat reflects back darkens what is below; 1 is physical.
        coat_darkening: f64 = 1.0, UNIT;
        /// Strength of the emitted light; 1 shows the emission color as it is.
        emission_luminance: f64 = 0.0, LUMINANCE.labeled("Emission strength");
        /// Color of the emitted light.
        emission_color: [f64; 3] = [1.0; 3], INTENSITY.color();
        /// Share of the surface that is there; what is behind shows through the rest.
        #[serde(skip_serializing_if = "is_whole")]
        geometry_opacity: f64 = 1.0, UNIT.labeled("Opacity");
        /// Cuts out what is less opaque than this, and makes the rest opaque; 0 blends.
        #[serde(skip_serializing_if = "is_nothing")]
        opacity_threshold: f64 = 0.0, UNIT.labeled("Cut-out threshold");
        /// How it reflects light.
        model: ReflectionModel = ReflectionModel::OpenPbr {}, NO_LIMITS;
        /// What varies over the surface.
        #[serde(skip_serializing_if = "Textures::is_none")]
        textures: Textures = Textures::None {}, NO_LIMITS;
    }
}

/// How a material reflects light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum ReflectionModel {
    /// The layers of OpenPBR, with GGX highlights.
    OpenPbr {},
    /// Lambert's diffuse reflection with a highlight by Blinn and Phong. Of the other parameters it uses base color
    /// and weight, and emission.
    BlinnPhong {
        /// Strength of the highlight; 0 is matte.
        specular: f64,
        /// Exponent: larger is a smaller, sharper highlight.
        shininess: f64,
    },
}

param_variants! { ReflectionModel by |model| model.table(); {
    ReflectionModel::OpenPbr {}
    ReflectionModel::BlinnPhong { specular, shininess, }
} }
nested_variants!(ReflectionModel, "Model", "How the surface reflects light.");

impl ReflectionModel {
    /// A soft highlight by Blinn and Phong.
    const BLINN_PHONG: Self = Self::BlinnPhong { specular: 0.25, shininess: 48.0 };

    /// The table of its parameters.
    fn table(&self) -> &'static [super::Param] {
        match self {
            Self::OpenPbr {} => &[],
            Self::BlinnPhong { .. } => param_rows! {
                /// Strength of the highlight; 0 is matte.
                ["specular"] f64 = 0.25, UNIT;
                /// Blinn-Phong exponent: larger is a smaller, sharper highlight.
                ["shininess"] f64 = 48.0, SHININESS.labeled("Specular exponent");
            },
        }
    }
}

impl Variants for ReflectionModel {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::OpenPbr {}, "OpenPBR", "Physically based layers."),
            (Self::BLINN_PHONG, "Blinn-Phong", "Lambert's diffuse reflection with a simple highlight."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            Self::OpenPbr {} => 0,
            Self::BlinnPhong { .. } => 1,
        }
    }
}

fn is_whole(opacity: &f64) -> bool {
    *opacity == 1.0
}

fn is_nothing(threshold: &f64) -> bool {
    *threshold == 0.0
}

impl Material {
    /// Whether a ray may pass its surface somewhere.
    pub fn is_veiled(&self) -> bool {
        self.geometry_opacity < 1.0 || self.textures.has_opacity()
    }

    /// A plastic of the given color.
    pub fn new(id: MaterialId, name: impl Into<String>, base_color: [f64; 3]) -> Self {
        Self { id, name: name.into(), base_color, ..Self::default() }
    }

    /// The defaults of fields that a file leaves out; a file must not leave out id and name, so these are invalid.
    fn unnamed() -> Self {
        Self { id: MaterialId(u64::MAX), name: String::new(), ..Self::default() }
    }
}
