//! Older versions of the file format, and their conversion to the present one.
//!
//! Version 1 had materials by Blinn and Phong only. They become materials of that model, which look the same. Its lights
//! had an intensity: the radiance of a white surface that faces them, where their attenuation is 1. They become lights
//! of the same attenuation with the strength that gives this radiance.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::format::{NodeFile, SceneFile, VERSION};
use crate::check::{self, Fault};
use crate::limits::{ATTENUATION, CONE, INTENSITY, NO_LIMITS, RANGE, SHININESS, UNIT};
use crate::params::{Variants, nested_params, nested_variants, param_rows, param_struct, param_variants};
use crate::{Environment, Falloff, Light, LightKind, Material, MaterialId, ReflectionModel};

/// A scene of version 1.
pub(super) type SceneV1 = SceneFile<MaterialV1, EnvironmentV1, LightV1>;

param_struct! {
    /// The environment of version 1.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub(super) struct EnvironmentV1 {
        /// Background above.
        sky: [f64; 3] = [0.055, 0.07, 0.095], INTENSITY.color();
        /// Background at and below the horizon.
        horizon: [f64; 3] = [0.16, 0.175, 0.20], INTENSITY.color();
        /// Light from everywhere.
        ambient: [f64; 3] = [0.26, 0.28, 0.32], INTENSITY.color();
    }
}

impl EnvironmentV1 {
    /// Checks every value.
    pub(super) fn check(&self) -> Result<(), Fault> {
        check::values(self)
    }
}

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

param_struct! {
    /// The attenuation of a light of version 1.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub(super) struct AttenuationV1 {
        /// Constant term.
        constant: f64 = 1.0, ATTENUATION;
        /// Linear term.
        linear: f64 = 0.0, ATTENUATION;
        /// Quadratic term.
        quadratic: f64 = 0.1, ATTENUATION;
        /// Nothing is lit beyond this distance.
        range: f64 = 50.0, RANGE;
    }
}
nested_params!(AttenuationV1);

/// A kind of light of version 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum LightKindV1 {
    /// Parallel light.
    Directional {},
    /// From a point into every direction.
    Point {
        /// Weakening with distance.
        attenuation: AttenuationV1,
    },
    /// From a point into a cone.
    Spot {
        /// Weakening with distance.
        attenuation: AttenuationV1,
        /// Half angle of full light, in degrees.
        inner: f64,
        /// Half angle of no light, in degrees.
        outer: f64,
    },
}

param_variants! { LightKindV1 by |light| light.table(); {
    LightKindV1::Directional {}
    LightKindV1::Point { attenuation, }
    LightKindV1::Spot { attenuation, inner, outer, }
} }
nested_variants!(LightKindV1, "Type", "Where the light comes from.");

impl LightKindV1 {
    fn table(&self) -> &'static [crate::Param] {
        match self {
            Self::Spot { .. } => param_rows! {
                /// Half angle of full light.
                ["inner"] f64 = 20.0, CONE;
                /// Half angle of no light.
                ["outer"] f64 = 30.0, CONE;
            },
            _ => &[],
        }
    }
}

impl Variants for LightKindV1 {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        let attenuation = AttenuationV1::default();
        vec![
            (Self::Directional {}, "Sun", "Parallel light."),
            (Self::Point { attenuation }, "Point", "From a point."),
            (Self::Spot { attenuation, inner: 20.0, outer: 30.0 }, "Spot", "From a point into a cone."),
        ]
    }

    fn variant(&self) -> usize {
        match self {
            Self::Directional {} => 0,
            Self::Point { .. } => 1,
            Self::Spot { .. } => 2,
        }
    }
}

param_struct! {
    /// A light of version 1.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub(super) struct LightV1 {
        /// Linear color of the light.
        color: [f64; 3] = [1.0; 3], INTENSITY.color();
        /// Factor on the color.
        intensity: f64 = 2.0, INTENSITY;
        /// Sun, point or spot.
        light: LightKindV1 = LightKindV1::Directional {}, NO_LIMITS;
    }
}

impl LightV1 {
    /// Checks every value.
    pub(super) fn check(&self) -> Result<(), Fault> {
        check::values(self)?;
        let attenuation =
            |a: AttenuationV1| check::attenuation("light.attenuation.constant", [a.constant, a.linear, a.quadratic]);
        match self.light {
            LightKindV1::Directional {} => Ok(()),
            LightKindV1::Point { attenuation: a } => attenuation(a),
            LightKindV1::Spot { attenuation: a, inner, outer } => {
                attenuation(a)?;
                check::cone([inner, outer])
            }
        }
    }

    /// The light that looks the same.
    fn converted(self) -> Light {
        // The irradiance of a surface with the radiance 1 is π. A light of the power 4π² W gives it at 1 m.
        let power = self.intensity * (4.0 * PI * PI);
        let falloff = |AttenuationV1 { constant, linear, quadratic, range }| Falloff::Attenuation {
            constant,
            linear,
            quadratic,
            range,
        };
        let light = match self.light {
            LightKindV1::Directional {} => LightKind::Sun { strength: self.intensity * PI, angle: 0.0 },
            LightKindV1::Point { attenuation } => {
                LightKind::Point { power, radius: 0.0, falloff: falloff(attenuation) }
            }
            LightKindV1::Spot { attenuation, inner, outer } => {
                LightKind::Spot { power, radius: 0.0, falloff: falloff(attenuation), inner, outer }
            }
        };
        Light { color: self.color, light, ..Light::default() }
    }
}

impl NodeFile<LightV1> {
    /// The node in the present version.
    fn converted(self) -> NodeFile {
        NodeFile {
            light: self.light.map(LightV1::converted),
            id: self.id,
            parent: self.parent,
            name: self.name,
            visible: self.visible,
            locked: self.locked,
            operation: self.operation,
            joining: self.joining,
            apart: self.apart,
            linked: self.linked,
            transform: self.transform,
            weight: self.weight,
            dynamics: self.dynamics,
            modifiers: self.modifiers,
            march: self.march,
            group: self.group,
            object: self.object,
            instancer: self.instancer,
            mesh: self.mesh,
            camera: self.camera,
        }
    }
}

impl SceneV1 {
    /// The scene in the present version.
    pub fn converted(self) -> SceneFile {
        SceneFile {
            schema: self.schema,
            isolith: VERSION,
            environment: Environment::sky(self.environment.sky, self.environment.horizon, self.environment.ambient),
            display: self.display,
            materials: self.materials.into_iter().map(MaterialV1::converted).collect(),
            next_id: self.next_id,
            nodes: self.nodes.into_iter().map(NodeFile::converted).collect(),
            timeline: self.timeline,
            tracks: self.tracks,
            bookmarks: self.bookmarks,
            packed: self.packed,
        }
    }
}
