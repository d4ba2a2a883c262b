//! Light on surfaces, in f64, from the same numbers and by the same formulas as
//! `shaders/light/shade.wgsl`. Colours are linear until [`shade_encode`].

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::twin::SurfaceMaterial;
use super::{FlatLight, FlatScene};
use crate::geometry::Camera;
use crate::scene::{Attenuation, LightKind};

/// A light as the GPU reads it, relative to the eye; `shaders/common/light.wgsl` is its twin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Where it is, relative to the eye.
    pub position: [f32; 3],
    /// One of [`GpuLight::DIRECTIONAL`], [`GpuLight::POINT`], [`GpuLight::SPOT`].
    pub kind: u32,
    /// Unit vector in which the light travels.
    pub direction: [f32; 3],
    /// Nothing is lit beyond this distance.
    pub range: f32,
    /// Colour times intensity, linear.
    pub color: [f32; 3],
    /// Constant term of the attenuation.
    pub constant: f32,
    /// Per metre.
    pub linear: f32,
    /// Per square metre.
    pub quadratic: f32,
    /// Cosine of the half angle within which a spot is full; always above `cos_outer`.
    pub cos_inner: f32,
    /// Cosine of the half angle at which a spot has faded out.
    pub cos_outer: f32,
}

impl GpuLight {
    /// Parallel light.
    pub const DIRECTIONAL: u32 = 0;
    /// Light from a point into every direction.
    pub const POINT: u32 = 1;
    /// Light from a point into a cone.
    pub const SPOT: u32 = 2;

    fn new(light: &FlatLight, eye: DVec3) -> Self {
        let (kind, attenuation, [inner, outer]) = match light.light.light {
            LightKind::Directional {} => (Self::DIRECTIONAL, Attenuation::default(), [0.0, 0.0]),
            LightKind::Point { attenuation } => (Self::POINT, attenuation, [0.0, 0.0]),
            LightKind::Spot { attenuation, inner, outer } => (Self::SPOT, attenuation, [inner, outer]),
        };
        let cos_outer = outer.to_radians().cos();
        Self {
            position: (light.position - eye).as_vec3().to_array(),
            kind,
            direction: light.direction.as_vec3().to_array(),
            range: attenuation.range as f32,
            color: (DVec3::from(light.light.color) * light.light.intensity).as_vec3().to_array(),
            constant: attenuation.constant as f32,
            linear: attenuation.linear as f32,
            quadratic: attenuation.quadratic as f32,
            // A cone with a hard edge still needs a width for the fade to be defined.
            cos_inner: inner.to_radians().cos().max(cos_outer + 1e-4) as f32,
            cos_outer: cos_outer as f32,
        }
    }

    fn directional(direction: DVec3, color: DVec3) -> Self {
        Self {
            kind: Self::DIRECTIONAL,
            direction: direction.normalize().as_vec3().to_array(),
            color: color.as_vec3().to_array(),
            range: 1.0,
            constant: 1.0,
            ..Self::zeroed()
        }
    }
}

/// The lights of the scene as seen from the camera. A scene without any is lit like a studio, fixed to
/// the viewer: a key light from over the left shoulder and a weak one from the right.
pub fn gpu_lights(flat: &FlatScene, camera: &Camera) -> Vec<GpuLight> {
    if flat.lights.is_empty() {
        let world = |direction: DVec3| camera.rotation * direction;
        return vec![
            GpuLight::directional(world(DVec3::new(0.55, -0.75, -0.9)), DVec3::new(1.12, 1.08, 1.02)),
            GpuLight::directional(world(DVec3::new(-0.9, -0.1, -0.5)), DVec3::new(0.16, 0.20, 0.28)),
        ];
    }
    flat.lights.iter().map(|light| GpuLight::new(light, camera.position)).collect()
}

/// Colour of a surface point: Lambert's diffuse term, Blinn and Phong's highlight, light from
/// everywhere. `position` is relative to the eye; `normal` and `to_eye` have unit length.
pub fn shade_surface(
    material: &SurfaceMaterial,
    position: DVec3,
    normal: DVec3,
    to_eye: DVec3,
    ambient: DVec3,
    lights: &[GpuLight],
) -> DVec3 {
    let mut color = material.emission + material.albedo * shade_ambient(normal.y, ambient);
    for light in lights {
        let (to_light, share) = shade_incoming(light, position);
        let facing = normal.dot(to_light).max(0.0);
        let halfway = to_light + to_eye;
        let alignment = normal.dot(halfway).max(0.0) / halfway.length().max(1e-6);
        let highlight = material.specular * alignment.powf(material.shininess);
        color += (material.albedo + highlight) * vector(light.color) * (facing * share);
    }
    color
}

/// Unit vector towards the light, and the share of the light that arrives, shadows aside.
pub fn shade_incoming(light: &GpuLight, position: DVec3) -> (DVec3, f64) {
    if light.kind == GpuLight::DIRECTIONAL {
        return (-vector(light.direction), 1.0);
    }
    let offset = vector(light.position) - position;
    let distance = offset.length();
    let to_light = offset / distance.max(1e-6);
    let mut share = shade_attenuation(light, distance);
    if light.kind == GpuLight::SPOT {
        let (none, full) = (f64::from(light.cos_outer), f64::from(light.cos_inner));
        let x = ((-to_light.dot(vector(light.direction)) - none) / (full - none)).clamp(0.0, 1.0);
        share *= x * x * (3.0 - 2.0 * x);
    }
    (to_light, share)
}

/// Weakening with distance; fades to nothing at the light's range.
pub fn shade_attenuation(light: &GpuLight, distance: f64) -> f64 {
    let ratio = (distance / f64::from(light.range)).min(1.0);
    let window = 1.0 - ratio.powi(4);
    let [constant, linear, quadratic] = [light.constant, light.linear, light.quadratic].map(f64::from);
    window * window / (constant + (linear + quadratic * distance) * distance).max(1e-4)
}

/// Light from everywhere: full from above, half from below.
pub fn shade_ambient(normal_y: f64, ambient: DVec3) -> DVec3 {
    ambient * (0.75 + 0.25 * normal_y)
}

/// What a ray sees that hits nothing; `direction_y` is the height of its unit direction.
pub fn shade_background(direction_y: f64, sky: DVec3, horizon: DVec3) -> DVec3 {
    let height = direction_y.clamp(0.0, 1.0);
    horizon.lerp(sky, height * (2.0 - height))
}

/// Linear light to what a screen expects (IEC 61966-2-1), clamped to 0..1.
pub fn shade_encode(linear: DVec3) -> DVec3 {
    linear
        .clamp(DVec3::ZERO, DVec3::ONE)
        .map(|c| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 })
}

/// Back from [`shade_encode`]: what a byte of a texture means.
pub fn shade_decode(encoded: DVec3) -> DVec3 {
    encoded.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
