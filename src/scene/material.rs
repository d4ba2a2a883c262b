//! Materials: shared by id, so that one edit changes every object that uses it.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

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

/// Lambert diffuse with a Blinn-Phong highlight. Colors are linear Rec. 709.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Identity.
    pub id: MaterialId,
    /// Name for people.
    pub name: String,
    /// Diffuse reflectance, 0 to 1 per channel.
    pub albedo: [f64; 3],
    /// Strength of the highlight, 0 (Lambert) to 1.
    pub specular: f64,
    /// Blinn-Phong exponent, from 1.
    pub shininess: f64,
    /// Emitted color.
    pub emission: [f64; 3],
}

impl Material {
    /// A matte plastic of the given color.
    pub fn new(id: MaterialId, name: impl Into<String>, albedo: [f64; 3]) -> Self {
        Self { id, name: name.into(), albedo, specular: 0.25, shininess: 48.0, emission: [0.0; 3] }
    }
}
