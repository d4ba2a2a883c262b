//! Materials as the GPU reads them. `shaders/light/material.wgsl` is the counterpart.

use bytemuck::{Pod, Zeroable};

use isolith_scene::{Material, ReflectionModel};

/// A material as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FlatMaterial {
    /// Base color times its weight.
    pub base_color: [f32; 3],
    /// 0 for a dielectric, 1 for a metal.
    pub metalness: f32,
    /// Tint of the specular reflection.
    pub specular_color: [f32; 3],
    /// Strength of the specular reflection.
    pub specular_weight: f32,
    /// Emitted color times its luminance.
    pub emission: [f32; 3],
    /// How much the coat darkens what is below.
    pub coat_darkening: f32,
    /// Tint of the coat.
    pub coat_color: [f32; 3],
    /// Share of the surface under the coat.
    pub coat_weight: f32,
    /// Roughness of the specular reflection.
    pub roughness: f32,
    /// Index of refraction.
    pub ior: f32,
    /// Roughness of the coat.
    pub coat_roughness: f32,
    /// Index of refraction of the coat.
    pub coat_ior: f32,
    /// Roughness of the diffuse reflection.
    pub diffuse_roughness: f32,
    /// 1 for a material by Blinn and Phong, 0 for the layers of OpenPBR.
    pub phong_weight: f32,
    /// Strength of the highlight by Blinn and Phong.
    pub phong_specular: f32,
    /// Its exponent.
    pub phong_shininess: f32,
    /// Share of the surface that is there.
    pub opacity: f32,
    /// What is less opaque than this is cut out, and the rest is opaque; 0 for blended opacity.
    pub opacity_threshold: f32,
    /// Padding.
    pub padding_0: f32,
    /// Padding.
    pub padding_1: f32,
}

impl FlatMaterial {
    /// The material as the GPU reads it.
    pub fn new(material: &Material) -> Self {
        let color = |c: [f64; 3], by: f64| c.map(|v| (v * by) as f32);
        let (phong_weight, [phong_specular, phong_shininess]) = match material.model {
            ReflectionModel::OpenPbr {} => (0.0, [0.0, 0.0]),
            ReflectionModel::BlinnPhong { specular, shininess } => (1.0, [specular, shininess]),
        };
        Self {
            base_color: color(material.base_color, material.base_weight),
            metalness: material.base_metalness as f32,
            specular_color: color(material.specular_color, 1.0),
            specular_weight: material.specular_weight as f32,
            emission: color(material.emission_color, material.emission_luminance),
            coat_darkening: material.coat_darkening as f32,
            coat_color: color(material.coat_color, 1.0),
            coat_weight: material.coat_weight as f32,
            roughness: material.specular_roughness as f32,
            ior: material.specular_ior as f32,
            coat_roughness: material.coat_roughness as f32,
            coat_ior: material.coat_ior as f32,
            diffuse_roughness: material.base_diffuse_roughness as f32,
            phong_weight,
            phong_specular: phong_specular as f32,
            phong_shininess: phong_shininess as f32,
            opacity: material.geometry_opacity as f32,
            opacity_threshold: material.opacity_threshold as f32,
            padding_0: 0.0,
            padding_1: 0.0,
        }
    }
}
