//! The lights of a scene as the GPU and the reference renderer read them.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::arrays::{FlatLight, FlatScene};
use isolith_geometry::Camera;
use isolith_scene::{Attenuation, LightKind};

/// A light as the GPU reads it, relative to the eye; `shaders/common/light.wgsl` is its counterpart.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Position relative to the eye.
    pub position: [f32; 3],
    /// One of [`GpuLight::DIRECTIONAL`], [`GpuLight::POINT`], [`GpuLight::SPOT`].
    pub kind: u32,
    /// Unit direction in which the light travels.
    pub direction: [f32; 3],
    /// Distance beyond which it lights nothing.
    pub range: f32,
    /// Color times intensity, linear.
    pub color: [f32; 3],
    /// Constant term of the attenuation.
    pub constant: f32,
    /// Linear term of the attenuation, per meter.
    pub linear: f32,
    /// Quadratic term of the attenuation, per square meter.
    pub quadratic: f32,
    /// Cosine of the half angle of full intensity of a spot; always above `cos_outer`.
    pub cos_inner: f32,
    /// Cosine of the half angle at which a spot has faded out.
    pub cos_outer: f32,
}

impl GpuLight {
    /// Parallel light.
    pub const DIRECTIONAL: u32 = 0;
    /// Light from a point in all directions.
    pub const POINT: u32 = 1;
    /// Light from a point into a cone.
    pub const SPOT: u32 = 2;

    /// The light as seen from `eye`.
    pub fn new(light: &FlatLight, eye: DVec3) -> Self {
        let (kind, attenuation, [inner, outer]) = match light.light.light {
            LightKind::Sun {} => (Self::DIRECTIONAL, Attenuation::default(), [0.0, 0.0]),
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

/// The lights of the scene as seen from the camera. A scene without lights gets a studio setup that is fixed to the
/// viewer: a key light from over the left shoulder and a weak one from the right.
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
