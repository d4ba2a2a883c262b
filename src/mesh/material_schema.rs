//! The materials of a glTF file's JSON.

use std::collections::BTreeMap;

use serde::de::IgnoredAny;

use super::whole::Whole;

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfMaterial {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: Pbr,
    pub normal_texture: Option<NormalTexture>,
    pub occlusion_texture: Option<OcclusionTexture>,
    pub emissive_factor: Option<[f64; 3]>,
    pub emissive_texture: Option<TextureInfo>,
    pub alpha_mode: Option<String>,
    pub alpha_cutoff: Option<f64>,
    #[serde(default)]
    pub extensions: MaterialExtensions,
}

#[derive(Debug, Default, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Pbr {
    pub base_color_factor: Option<[f64; 4]>,
    pub base_color_texture: Option<TextureInfo>,
    pub metallic_factor: Option<f64>,
    pub roughness_factor: Option<f64>,
    pub metallic_roughness_texture: Option<TextureInfo>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct NormalTexture {
    #[serde(flatten)]
    pub info: TextureInfo,
    pub scale: Option<f64>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct OcclusionTexture {
    #[serde(flatten)]
    pub info: TextureInfo,
    pub strength: Option<f64>,
}

#[derive(Debug, Default, serde::Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<SpecularGlossiness>,
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub emissive_strength: Option<EmissiveStrength>,
    #[serde(rename = "KHR_materials_ior")]
    pub ior: Option<Ior>,
    #[serde(rename = "KHR_materials_specular")]
    pub specular: Option<Specular>,
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Clearcoat>,
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpecularGlossiness {
    pub diffuse_factor: Option<[f64; 4]>,
    pub diffuse_texture: Option<TextureInfo>,
    pub glossiness_factor: Option<f64>,
    pub specular_glossiness_texture: Option<IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub emissive_strength: Option<f64>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct Ior {
    pub ior: Option<f64>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    pub specular_factor: Option<f64>,
    pub specular_color_factor: Option<[f64; 3]>,
    pub specular_texture: Option<IgnoredAny>,
    pub specular_color_texture: Option<IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Clearcoat {
    pub clearcoat_factor: Option<f64>,
    pub clearcoat_roughness_factor: Option<f64>,
    pub clearcoat_texture: Option<IgnoredAny>,
    pub clearcoat_roughness_texture: Option<IgnoredAny>,
    pub clearcoat_normal_texture: Option<IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub index: Whole,
    #[serde(default)]
    pub tex_coord: Whole,
    #[serde(default)]
    pub extensions: TextureInfoExtensions,
}

#[derive(Debug, Default, serde::Deserialize)]
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    #[serde(default)]
    pub offset: [f64; 2],
    #[serde(default)]
    pub rotation: f64,
    #[serde(default = "one")]
    pub scale: [f64; 2],
    pub tex_coord: Option<Whole>,
}

fn one() -> [f64; 2] {
    [1.0; 2]
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct GltfTexture {
    pub source: Option<Whole>,
    pub sampler: Option<Whole>,
    /// Alternative sources of the image; only the names matter.
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfSampler {
    pub mag_filter: Option<Whole>,
    pub min_filter: Option<Whole>,
    pub wrap_s: Option<Whole>,
    pub wrap_t: Option<Whole>,
}

impl GltfMaterial {
    /// All textures of which the image is read, each with its place in the material.
    pub fn textures(&self) -> [(Option<&TextureInfo>, &'static str); 6] {
        let pbr = &self.pbr_metallic_roughness;
        let diffuse = self.extensions.specular_glossiness.as_ref().and_then(|older| older.diffuse_texture.as_ref());
        [
            (pbr.base_color_texture.as_ref(), "pbrMetallicRoughness.baseColorTexture"),
            (pbr.metallic_roughness_texture.as_ref(), "pbrMetallicRoughness.metallicRoughnessTexture"),
            (self.normal_texture.as_ref().map(|texture| &texture.info), "normalTexture"),
            (self.occlusion_texture.as_ref().map(|texture| &texture.info), "occlusionTexture"),
            (self.emissive_texture.as_ref(), "emissiveTexture"),
            (diffuse, "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture"),
        ]
    }
}
