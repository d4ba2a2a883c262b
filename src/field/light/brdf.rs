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
