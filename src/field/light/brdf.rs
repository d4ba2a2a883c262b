//! The light that a surface reflects toward the eye. Counterpart of `shaders/light/brdf.wgsl`.

use glam::DVec3;

use super::layers::{Layers, layers_direct, layers_of};
use crate::mixture::SurfaceMaterial;

/// A point of a surface that is lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingPoint {
    /// Its material.
    pub material: SurfaceMaterial,
    /// Its position relative to the eye.
    pub position: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Unit direction to the eye.
    pub to_eye: DVec3,
}

impl ShadingPoint {
    /// The layers of its material, seen from the eye.
    pub fn layers(&self) -> Layers {
        layers_of(&self.material, self.normal.dot(self.to_eye))
    }
}

/// Factors on the light of the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentShares {
    /// On the light that arrives from all around.
    pub diffuse: DVec3,
    /// How much more of it comes from the side of the eye: added to the mean direction.
    pub lean: DVec3,
    /// On the light from about `dominant`, blurred by `roughness`.
    pub specular: DVec3,
    /// Roughness of the specular reflection.
    pub roughness: f64,
    /// Between the mirrored ray and the normal: most of what a rough surface reflects comes from there.
    pub dominant: DVec3,
    /// Direction of the mirrored ray.
    pub direction: DVec3,
    /// On the light from about `direction`, blurred by `coat_roughness`.
    pub coat: f64,
    /// Roughness of the coat.
    pub coat_roughness: f64,
}

/// The share of the light from the unit direction `to_light` that the surface reflects toward the eye: the BRDF times
/// the cosine of the angle of incidence times π. A white Lambert surface that faces the light gives 1.
pub fn brdf_direct(point: &ShadingPoint, to_light: DVec3) -> DVec3 {
    brdf_layered(point, &point.layers(), to_light)
}

/// [`brdf_direct`] of a point whose layers are known.
pub fn brdf_layered(point: &ShadingPoint, layers: &Layers, to_light: DVec3) -> DVec3 {
    let toward = to_light + point.to_eye;
    let halfway = toward / toward.length().max(1e-6);
    let layers = layers_direct(layers, point.normal, point.to_eye, to_light, halfway);
    brdf_phong(point, to_light, halfway) + (1.0 - point.material.phong_weight) * layers
}

/// The part by Blinn and Phong. A mixture holds the highlight and its exponent times the weight.
fn brdf_phong(point: &ShadingPoint, to_light: DVec3, halfway: DVec3) -> DVec3 {
    let material = &point.material;
    let facing = point.normal.dot(to_light).max(0.0);
    let alignment = point.normal.dot(halfway).max(0.0);
    let exponent = (material.phong_shininess / material.phong_weight.max(1e-4)).max(1.0);
    let highlight = material.phong_specular * alignment.powf(exponent);
    (material.base_color * material.phong_weight + highlight) * facing
}

/// The share of light that comes equally from everywhere.
pub fn brdf_ambient(point: &ShadingPoint) -> DVec3 {
    let shares = brdf_environment(point);
    shares.diffuse + shares.specular + shares.coat
}

/// How far the mean direction of the light that a rough diffuse surface reflects leans toward the eye: a fit to integrals
/// over a studio.
const LEAN: f64 = 0.5;

/// The shares of the light of the environment: a split sum. The dominant direction is that of Lagarde and de Rousiers,
/// "Moving Frostbite to Physically Based Rendering" (2014).
pub fn brdf_environment(point: &ShadingPoint) -> EnvironmentShares {
    let (layers, weight) = (point.layers(), 1.0 - point.material.phong_weight);
    let diffuse = point.material.base_color * point.material.phong_weight;
    let ShadingPoint { normal, to_eye, .. } = *point;
    let direction = 2.0 * normal.dot(to_eye) * normal - to_eye;
    let smooth = 1.0 - layers.alpha;
    let leaning = LEAN * weight * layers.diffuse_roughness;
    EnvironmentShares {
        lean: (to_eye - normal * normal.dot(to_eye)) * leaning,
        dominant: normal.lerp(direction, smooth * (smooth.sqrt() + layers.alpha)).normalize(),
        diffuse: diffuse + weight * layers.diffuse_albedo,
        specular: weight * layers.specular_albedo,
        roughness: layers.alpha.sqrt(),
        direction,
        coat: weight * layers.coat_albedo,
        coat_roughness: layers.coat_alpha.sqrt(),
    }
}
