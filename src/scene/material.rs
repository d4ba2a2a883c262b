//! Materials. Objects share them by id, so that one edit changes every object that uses a material.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::limits::{INTENSITY, SHININESS, UNIT};
use super::params::param_struct;
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
    /// Lambert diffuse with a Blinn-Phong highlight. Colors are linear Rec. 709.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Material [
        /// Identity.
        id: MaterialId = MaterialId(1);
        /// Name for people.
        name: String = "Clay".into();
    ] {
        /// Diffuse reflectance, 0 to 1 per channel.
        albedo: [f64; 3] = [0.6; 3], UNIT.color().labeled("Base color");
        /// Strength of the highlight; 0 is matte.
        specular: f64 = 0.25, UNIT;
        /// Blinn-Phong exponent: larger is a smaller, sharper highlight.
        shininess: f64 = 48.0, SHININESS.labeled("Specular exponent");
        /// Light that it emits.
        emission: [f64; 3] = [0.0; 3], INTENSITY.color();
    }
}

impl Material {
    /// A matte plastic of the given color.
    pub fn new(id: MaterialId, name: impl Into<String>, albedo: [f64; 3]) -> Self {
        Self { id, name: name.into(), albedo, ..Self::default() }
    }
}
