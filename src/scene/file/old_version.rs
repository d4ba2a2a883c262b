//! Older versions of the file format, and their conversion to the present one.
//!
//! Version 1 had materials by Blinn and Phong only. They become materials of that model, which look the same.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::format::{NodeFile, SceneFile, VERSION};
use crate::check::{self, Fault};
use crate::limits::{INTENSITY, SHININESS, UNIT};
use crate::params::param_struct;
use crate::{Environment, Light, Material, MaterialId, ReflectionModel};

/// A scene of version 1.
pub(super) type SceneV1 = SceneFile<MaterialV1, Environment, Light>;

param_struct! {
    /// A material of version 1.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub(super) struct MaterialV1 [
        /// Identity.
        id: MaterialId = MaterialId(1);
        /// Name for people.
        name: String = String::new();
    ] {
        /// Diffuse reflectance.
        albedo: [f64; 3] = [0.6; 3], UNIT.color();
        /// Strength of the highlight.
        specular: f64 = 0.25, UNIT;
        /// Blinn-Phong exponent.
        shininess: f64 = 48.0, SHININESS;
        /// Light that it emits.
        emission: [f64; 3] = [0.0; 3], INTENSITY.color();
    }
}

/// A material as a file holds it.
pub(super) trait FileMaterial {
    /// Its identity.
    fn id(&self) -> MaterialId;

    /// Checks every value.
    fn check(&self) -> Result<(), Fault>;
}

impl FileMaterial for Material {
    fn id(&self) -> MaterialId {
        self.id
    }

    fn check(&self) -> Result<(), Fault> {
        check::material(self)
    }
}

impl FileMaterial for MaterialV1 {
    fn id(&self) -> MaterialId {
        self.id
    }

    fn check(&self) -> Result<(), Fault> {
        check::named(&self.name, self)
    }
}

impl MaterialV1 {
    /// The material that looks the same.
    fn converted(self) -> Material {
        let strength = self.emission.into_iter().fold(0.0, f64::max);
        Material {
            id: self.id,
            name: self.name,
            base_color: self.albedo,
            emission_luminance: if strength > 0.0 { 1.0 } else { 0.0 },
            emission_color: if strength > 0.0 { self.emission } else { [1.0; 3] },
            model: ReflectionModel::BlinnPhong { specular: self.specular, shininess: self.shininess },
            ..Material::default()
        }
    }
}

impl SceneV1 {
    /// The scene in the present version.
    pub fn converted(self) -> SceneFile {
        let node = |node: NodeFile| node;
        SceneFile {
            schema: self.schema,
            isolith: VERSION,
            environment: self.environment,
            display: self.display,
            materials: self.materials.into_iter().map(MaterialV1::converted).collect(),
            next_id: self.next_id,
            nodes: self.nodes.into_iter().map(node).collect(),
        }
    }
}
