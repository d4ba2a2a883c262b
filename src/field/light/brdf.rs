//! The light that a surface reflects toward the eye. Counterpart of `shaders/light/brdf.wgsl`.

use glam::DVec3;

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

/// The share of the light from the unit direction `to_light` that the surface reflects toward the eye: the BRDF times
/// the cosine of the angle of incidence times π. A white Lambert surface that faces the light gives 1.
pub fn brdf_direct(point: &ShadingPoint, to_light: DVec3) -> DVec3 {
    let material = &point.material;
    let facing = point.normal.dot(to_light).max(0.0);
    let halfway = to_light + point.to_eye;
    let alignment = point.normal.dot(halfway).max(0.0) / halfway.length().max(1e-6);
    let highlight = material.phong_specular * alignment.powf(material.phong_shininess);
    (material.base_color + highlight) * facing
}

/// The share of the ambient light that the surface reflects toward the eye.
pub fn brdf_ambient(point: &ShadingPoint) -> DVec3 {
    point.material.base_color
}

/// Factors on the light of the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentShares {
    /// On the light that arrives from all around.
    pub diffuse: DVec3,
    /// On the light from about `direction`, blurred by `roughness`.
    pub specular: DVec3,
    /// Roughness of the specular reflection.
    pub roughness: f64,
    /// Direction of the mirrored ray.
    pub direction: DVec3,
    /// On the light from about `direction`, blurred by `coat_roughness`.
    pub coat: f64,
    /// Roughness of the coat.
    pub coat_roughness: f64,
}

/// The shares of the light of the environment: a split sum, with the fit of Karis, "Physically based shading on
/// mobile" (2014).
pub fn brdf_environment(point: &ShadingPoint) -> EnvironmentShares {
    let material = &point.material;
    let layered = 1.0 - material.phong_weight;
    let dielectric = ((material.ior - 1.0) / (material.ior + 1.0)).powi(2) * material.specular_weight;
    let facing = (material.specular_color * dielectric).lerp(material.base_color, material.metalness);
    let cosine = point.normal.dot(point.to_eye).max(0.0);
    let r = material.roughness;
    let smooth = 1.0 - r;
    let a = (smooth * smooth).min((-9.28 * cosine).exp2()) * smooth + 0.0425 - 0.0275 * r;
    let (scale, bias) = (1.04 - 0.572 * r - 1.04 * a, 1.04 * a + 0.022 * r - 0.04);
    EnvironmentShares {
        diffuse: material.base_color * (1.0 - material.metalness * layered),
        specular: (facing * scale + bias).max(DVec3::ZERO) * layered,
        roughness: r,
        direction: 2.0 * point.normal.dot(point.to_eye) * point.normal - point.to_eye,
        coat: 0.0,
        coat_roughness: 0.0,
    }
}
