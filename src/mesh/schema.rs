//! The supported part of a glTF file's JSON. Other contents are ignored.
//!
//! Numbers are f64, as JSON has them: a node in national grid coordinates needs more precision than f32.

use std::collections::BTreeMap;

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, Visitor};

/// A whole number that is not negative. `5.0` counts as one, too: some exporters write it so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Whole(pub u64);

impl Whole {
    /// The number as an index; one beyond the address space becomes an index that no list has.
    pub fn index(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WholeVisitor)
    }
}

struct WholeVisitor;

/// Above this f64 cannot represent every whole number.
const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

impl Visitor<'_> for WholeVisitor {
    type Value = Whole;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a whole number that is not negative")
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Whole, E> {
        Ok(Whole(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Whole, E> {
        u64::try_from(value).map(Whole).map_err(|_| E::custom(format!("{value} is negative")))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Whole, E> {
        if (0.0..LARGEST_EXACT).contains(&value) && value.fract() == 0.0 {
            return Ok(Whole(value as u64));
        }
        Err(E::custom(format!("{value} is not a whole number")))
    }
}

/// The fields that tell whether the rest can be understood.
#[derive(Debug, serde::Deserialize)]
pub(super) struct Versioned {
    pub asset: Option<Asset>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Asset {
    pub version: Option<String>,
    pub min_version: Option<String>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Root {
    #[serde(default)]
    pub extensions_used: Vec<String>,
    #[serde(default)]
    pub extensions_required: Vec<String>,
    pub scene: Option<Whole>,
    #[serde(default)]
    pub scenes: Vec<GltfScene>,
    #[serde(default)]
    pub nodes: Vec<GltfNode>,
    #[serde(default)]
    pub meshes: Vec<GltfMesh>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<GltfBufferView>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    pub images: Vec<Image>,
    #[serde(default)]
    pub textures: Vec<GltfTexture>,
    #[serde(default)]
    pub samplers: Vec<GltfSampler>,
    #[serde(default)]
    pub materials: Vec<GltfMaterial>,
    #[serde(default)]
    pub skins: Vec<Skin>,
    /// Only the count matters.
    #[serde(default)]
    pub animations: Vec<IgnoredAny>,
    /// Only the count matters.
    #[serde(default)]
    pub cameras: Vec<IgnoredAny>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct GltfScene {
    pub name: Option<String>,
    #[serde(default)]
    pub nodes: Vec<Whole>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct GltfNode {
    pub mesh: Option<Whole>,
    pub skin: Option<Whole>,
    #[serde(default)]
    pub children: Vec<Whole>,
    pub matrix: Option<Box<[f64; 16]>>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub weights: Option<Vec<f64>>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct GltfMesh {
    #[serde(default)]
    pub primitives: Vec<Primitive>,
    pub weights: Option<Vec<f64>>,
}

/// Attributes by their names.
pub(super) type Attributes = BTreeMap<String, Whole>;

#[derive(Debug, serde::Deserialize)]
pub(super) struct Primitive {
    #[serde(default)]
    pub attributes: Attributes,
    pub indices: Option<Whole>,
    pub material: Option<Whole>,
    pub mode: Option<Whole>,
    #[serde(default)]
    pub targets: Vec<Attributes>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<Whole>,
    #[serde(default)]
    pub byte_offset: Whole,
    pub component_type: Whole,
    #[serde(default)]
    pub normalized: bool,
    pub count: Whole,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<Box<Sparse>>,
}

#[derive(Debug, serde::Deserialize)]
pub(super) struct Sparse {
    pub count: Whole,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: Whole,
    #[serde(default)]
    pub byte_offset: Whole,
    pub component_type: Whole,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: Whole,
    #[serde(default)]
    pub byte_offset: Whole,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfBufferView {
    pub buffer: Whole,
    #[serde(default)]
    pub byte_offset: Whole,
    pub byte_length: Whole,
    pub byte_stride: Option<Whole>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub byte_length: Whole,
    pub uri: Option<String>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub buffer_view: Option<Whole>,
    pub uri: Option<String>,
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

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct GltfMaterial {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: Pbr,
    pub normal_texture: Option<IgnoredAny>,
    pub occlusion_texture: Option<IgnoredAny>,
    pub emissive_factor: Option<[f64; 3]>,
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
    pub metallic_roughness_texture: Option<IgnoredAny>,
}

#[derive(Debug, Default, serde::Deserialize)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_pbrSpecularGlossiness")]
    pub specular_glossiness: Option<SpecularGlossiness>,
}

#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpecularGlossiness {
    pub diffuse_factor: Option<[f64; 4]>,
    pub diffuse_texture: Option<TextureInfo>,
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
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub inverse_bind_matrices: Option<Whole>,
    #[serde(default)]
    pub joints: Vec<Whole>,
}
