//! Lights as the evaluators read them, on the CPU and on the GPU alike.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::FlatScene;
use crate::geometry::Camera;
use crate::scene::{Attenuation, LightKind};

/// A light relative to the eye; twin of `Light` in `shaders/common/light.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Place, relative to the eye.
    pub position: [f32; 3],
    /// 0 directional, 1 point, 2 spot.
    pub kind: u32,
    /// Unit vector in which the light travels.
    pub direction: [f32; 3],
    /// Nothing is lit beyond this distance.
    pub range: f32,
    /// Colour times intensity, linear.
    pub color: [f32; 3],
    /// Attenuation: constant term.
    pub constant: f32,
    /// Attenuation: per metre.
    pub linear: f32,
    /// Attenuation: per square metre.
    pub quadratic: f32,
    /// Cosine of the half angle of full light.
    pub cos_inner: f32,
    /// Cosine of the half angle of none; less than `cos_inner`.
    pub cos_outer: f32,
}

/// The scene's lights as seen by `camera`. A scene without lights gets one over the viewer's left
/// shoulder, so that nothing is black before the artist has thought of light.
pub fn gpu_lights(flat: &FlatScene, camera: &Camera) -> Vec<GpuLight> {
    if flat.lights.is_empty() {
        let direction = camera.rotation * DVec3::new(0.45, -0.6, -0.66).normalize();
        return vec![GpuLight { color: [1.6; 3], direction: direction.as_vec3().to_array(), ..DIRECTIONAL }];
    }
    flat.lights
        .iter()
        .map(|placed| {
            let light = &placed.light;
            let base = GpuLight {
                position: (placed.position - camera.position).as_vec3().to_array(),
                direction: placed.direction.as_vec3().to_array(),
                color: light.color.map(|c| (c * light.intensity) as f32),
                ..DIRECTIONAL
            };
            match light.light {
                LightKind::Directional {} => base,
                LightKind::Point { attenuation } => attenuated(GpuLight { kind: 1, ..base }, &attenuation),
                LightKind::Spot { attenuation, inner, outer } => {
                    // The fade must have a width, or its edge would divide by zero.
                    let cos_outer = outer.to_radians().cos() as f32;
                    let cos_inner = (inner.to_radians().cos() as f32).max(cos_outer + 1e-5);
                    attenuated(GpuLight { kind: 2, cos_inner, cos_outer, ..base }, &attenuation)
                }
            }
        })
        .collect()
}

const DIRECTIONAL: GpuLight = GpuLight {
    position: [0.0; 3],
    kind: 0,
    direction: [0.0, -1.0, 0.0],
    range: 1.0,
    color: [1.0; 3],
    constant: 1.0,
    linear: 0.0,
    quadratic: 0.0,
    cos_inner: 1.0,
    cos_outer: 0.0,
};

fn attenuated(light: GpuLight, attenuation: &Attenuation) -> GpuLight {
    GpuLight {
        range: attenuation.range as f32,
        constant: attenuation.constant as f32,
        linear: attenuation.linear as f32,
        quadratic: attenuation.quadratic as f32,
        ..light
    }
}
