//! Materials: the appearance of a run of triangles.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec2;

use super::accessor::Source;
use super::error::{LoadRefusal, name};
use super::material_schema::{GltfMaterial, TextureInfo};
use super::remarks::Remarks;
use super::resolve::Reader;
use super::schema::{Primitive, Whole};
use super::texture::{Sampler, SharedTextures, Texture, Wrap, decode};

/// The appearance of a run of triangles: the metallic-roughness model of glTF with its layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear factor on the vertices' colors and opacity.
    pub color: [f32; 4],
    /// There is no surface where the opacity is below this; `None` for a surface everywhere.
    pub alpha_cutoff: Option<f32>,
    /// Covers what lies behind by its opacity.
    pub is_blended: bool,
    /// The base color texture, in sRGB; multiplied with `color` after conversion to linear.
    pub base_color: Option<TextureUse>,
    /// 0 for a dielectric, 1 for a metal.
    pub metalness: f32,
    /// Roughness as perceived: the square root of GGX's alpha.
    pub roughness: f32,
    /// Factors of the two: metalness in blue, roughness in green.
    pub metal_rough: Option<TextureUse>,
    /// Normals relative to the tangent frame.
    pub normal: Option<TextureUse>,
    /// Factor on their first two coordinates.
    pub normal_scale: f32,
    /// Share of the ambient light that arrives, in red.
    pub occlusion: Option<TextureUse>,
    /// How far the texture takes effect, from 0 to 1.
    pub occlusion_strength: f32,
    /// Linear emitted light.
    pub emission: [f32; 3],
    /// Its factor, in sRGB.
    pub emissive: Option<TextureUse>,
    /// Shows its base color as it is, without light.
    pub is_unlit: bool,
    /// Index of refraction.
    pub ior: f32,
    /// Strength of the dielectric's reflection.
    pub specular_weight: f32,
    /// Tint of the dielectric's reflection.
    pub specular_color: [f32; 3],
    /// Share of the surface under a clear coat.
    pub coat_weight: f32,
    /// Roughness of the coat.
    pub coat_roughness: f32,
}

/// How a surface looks up a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into [`super::TriangleMesh::textures`].
    pub texture: usize,
    /// The sampler.
    pub sampler: Sampler,
    /// Rows of the affine map from the vertices' texture coordinates to those of the texture.
    pub texture_from_uv: [[f32; 3]; 2],
    /// Which of the two texture coordinates of a vertex: 0 or 1.
    pub slot: usize,
}

/// No transform of texture coordinates.
const UNCHANGED: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// Texture coordinates of a vertex: surfaces use at most this many sets.
pub(super) const UV_SLOTS: usize = 2;
/// The sets of texture coordinates that a surface uses; `None` for an unused slot.
pub(super) type UvSets = [Option<u64>; UV_SLOTS];
/// Largest emission: the largest number of 16 bits.
const MAX_EMISSION: f64 = 65_504.0;
/// The limits of an index of refraction.
const IORS: [f64; 2] = [1.0, 3.0];

impl Default for Surface {
    /// glTF's default material.
    fn default() -> Self {
        Self {
            color: [1.0; 4],
            alpha_cutoff: None,
            is_blended: false,
            base_color: None,
            metalness: 1.0,
            roughness: 1.0,
            metal_rough: None,
            normal: None,
            normal_scale: 1.0,
            occlusion: None,
            occlusion_strength: 1.0,
            emission: [0.0; 3],
            emissive: None,
            is_unlit: false,
            ior: 1.5,
            specular_weight: 1.0,
            specular_color: [1.0; 3],
            coat_weight: 0.0,
            coat_roughness: 0.0,
        }
    }
}

impl TextureUse {
    /// Transforms the texture coordinates of a vertex, or of a point between vertices, to those of the texture.
    pub fn place(&self, uv: DVec2) -> DVec2 {
        let row = |[a, b, c]: [f32; 3]| f64::from(a) * uv.x + f64::from(b) * uv.y + f64::from(c);
        DVec2::new(row(self.texture_from_uv[0]), row(self.texture_from_uv[1]))
    }
}

impl Surface {
    /// The textures besides that of the base color.
    pub fn maps(&self) -> [Option<TextureUse>; 4] {
        [self.metal_rough, self.normal, self.occlusion, self.emissive]
    }

    /// Whether it has a texture besides that of the base color.
    pub fn has_maps(&self) -> bool {
        self.maps().iter().any(Option::is_some)
    }

    /// Everything but the textures.
    fn plain(material: &GltfMaterial) -> Self {
        let extensions = &material.extensions;
        let pbr = &material.pbr_metallic_roughness;
        let ior = extensions.ior.as_ref().and_then(|e| e.ior);
        let coat = extensions.clearcoat.as_ref();
        let specular = extensions.specular.as_ref();
        let strength = extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength);
        let strength = strength.filter(|s| s.is_finite()).unwrap_or(1.0).max(0.0);
        let emission = material.emissive_factor.unwrap_or([0.0; 3]).map(|c| f64::from(share(Some(c), 0.0)) * strength);
        let (color, [metalness, roughness]) = match &extensions.specular_glossiness {
            Some(older) => {
                let gloss = older.glossiness_factor.filter(|_| older.specular_glossiness_texture.is_none());
                (older.diffuse_factor, [0.0, 1.0 - share(gloss, 0.5)])
            }
            None => (pbr.base_color_factor, [share(pbr.metallic_factor, 1.0), share(pbr.roughness_factor, 1.0)]),
        };
        let alpha_cutoff = (material.alpha_mode.as_deref() == Some("MASK"))
            .then(|| material.alpha_cutoff.filter(|c| c.is_finite()).unwrap_or(0.5).clamp(0.0, 2.0) as f32);
        Self {
            color: color.unwrap_or([1.0; 4]).map(|c| share(Some(c), 1.0)),
            alpha_cutoff,
            is_blended: material.alpha_mode.as_deref() == Some("BLEND"),
            metalness,
            roughness,
            emission: emission.map(|c| c.min(MAX_EMISSION) as f32),
            is_unlit: extensions.unlit.is_some(),
            ior: ior.filter(|ior| ior.is_finite()).unwrap_or(1.5).clamp(IORS[0], IORS[1]) as f32,
            specular_weight: share(specular.and_then(|s| s.specular_factor), 1.0),
            specular_color: specular
                .and_then(|s| s.specular_color_factor)
                .unwrap_or([1.0; 3])
                .map(|c| share(Some(c), 1.0)),
            coat_weight: share(coat.and_then(|c| c.clearcoat_factor), 0.0),
            coat_roughness: share(coat.and_then(|c| c.clearcoat_roughness_factor), 0.0),
            ..Self::default()
        }
    }
}

/// A number from 0 to 1; `default` replaces one that is missing or not finite.
fn share(value: Option<f64>, default: f32) -> f32 {
    value.filter(|v| v.is_finite()).map_or(default, |v| v.clamp(0.0, 1.0) as f32)
}

/// Converts the materials of a document, and decodes each of its images once.
pub(super) struct Surfaces<'a> {
    source: &'a Source<'a>,
    reader: &'a Reader<'a>,
    budget: &'a mut u64,
    /// The decoded images.
    textures: Vec<Arc<Texture>>,
    /// Images decoded before, by their index.
    shared: SharedTextures,
    /// The index of each decoded image of the document; `None` if it cannot be used.
    decoded: HashMap<usize, Option<usize>>,
}

impl<'a> Surfaces<'a> {
    /// `shared` are the textures of the same file in another pose.
    pub fn new(source: &'a Source<'a>, reader: &'a Reader<'a>, budget: &'a mut u64, shared: SharedTextures) -> Self {
        Self { source, reader, budget, textures: Vec::new(), decoded: HashMap::new(), shared }
    }

    /// The textures, and for each the image of the document.
    pub fn into_textures(self) -> (Vec<Arc<Texture>>, Vec<usize>) {
        let mut images = vec![0; self.textures.len()];
        for (image, texture) in self.decoded.into_iter().filter_map(|(image, texture)| Some((image, texture?))) {
            images[texture] = image;
        }
        (self.textures, images)
    }

    /// The surface of a primitive, with the sets of texture coordinates for its textures. Leaves out what it cannot
    /// load, with a remark.
    pub fn of(&mut self, primitive: &Primitive, remarks: &mut Remarks) -> (Surface, UvSets) {
        let mut sets = UvSets::default();
        let Some(index) = primitive.material else { return (Surface::default(), sets) };
        let Some(material) = self.source.root.materials.get(index.index()) else { return (Surface::default(), sets) };
        remarks.material(index.index(), material);
        let plain = Surface::plain(material);
        let pbr = &material.pbr_metallic_roughness;
        let older = material.extensions.specular_glossiness.as_ref();
        let base = older.map_or(pbr.base_color_texture.as_ref(), |older| older.diffuse_texture.as_ref());
        let mut look_up = |info: Option<&TextureInfo>| self.look_up(info?, &mut sets, remarks);
        let mut surface = Surface { base_color: look_up(base), ..plain };
        if surface.is_unlit {
            return (surface, sets);
        }
        if older.is_none() {
            surface.metal_rough = look_up(pbr.metallic_roughness_texture.as_ref());
        }
        if let Some(normal) = &material.normal_texture {
            surface.normal = look_up(Some(&normal.info));
            surface.normal_scale = normal.scale.filter(|s| s.is_finite()).map_or(1.0, |s| s.clamp(-1e3, 1e3) as f32);
        }
        if let Some(occlusion) = &material.occlusion_texture {
            surface.occlusion = look_up(Some(&occlusion.info));
            surface.occlusion_strength = share(occlusion.strength, 1.0);
        }
        if surface.emission != [0.0; 3] {
            surface.emissive = look_up(material.emissive_texture.as_ref());
        }
        (surface, sets)
    }

    /// A texture with the slot of its coordinates.
    fn look_up(&mut self, info: &TextureInfo, sets: &mut UvSets, remarks: &mut Remarks) -> Option<TextureUse> {
        let (texture_from_uv, set) = transform(info);
        let Some(slot) = sets.iter().position(|held| held.is_none_or(|held| held == set)) else {
            let all = UV_SLOTS;
            remarks.add(format!(
                "textures[{}] needs more than {all} sets of texture coordinates in a material; it is not drawn",
                info.index.0
            ));
            return None;
        };
        let (texture, sampler) = self.texture(info.index, remarks)?;
        sets[slot] = Some(set);
        Some(TextureUse { texture, sampler, texture_from_uv, slot })
    }

    fn texture(&mut self, index: Whole, remarks: &mut Remarks) -> Option<(usize, Sampler)> {
        let root = self.source.root;
        let texture = root.textures.get(index.index())?;
        let Some(image) = texture.source else {
            let needed: Vec<String> = texture.extensions.keys().take(3).map(|key| name(key)).collect();
            let needed = if needed.is_empty() { String::new() } else { format!(": it needs {}", needed.join(" or ")) };
            remarks.add(format!("textures[{}] has no image that can be read{needed}; it is not drawn", index.0));
            return None;
        };
        let sampler = texture.sampler.and_then(|sampler| root.samplers.get(sampler.index()));
        let sampler = sampler.map_or(Sampler::default(), |sampler| Sampler {
            wrap: [sampler.wrap_s, sampler.wrap_t].map(wrap),
            nearest: is_nearest(sampler.mag_filter.or(sampler.min_filter)),
        });
        let number = match self.decoded.get(&image.index()) {
            Some(known) => *known,
            None => {
                let number = match self.decode(image) {
                    Ok(texture) => {
                        self.textures.push(texture);
                        Some(self.textures.len() - 1)
                    }
                    Err(refusal) => {
                        remarks.add(format!("{}; it is not drawn", refusal.into_warning()));
                        None
                    }
                };
                self.decoded.insert(image.index(), number);
                number
            }
        };
        number.map(|number| (number, sampler))
    }

    fn decode(&mut self, index: Whole) -> Result<Arc<Texture>, LoadRefusal> {
        if let Some(texture) = self.shared.get(&index.index()) {
            return Ok(texture.clone());
        }
        let place = format!("images[{}]", index.0);
        let Some(image) = self.source.root.images.get(index.index()) else {
            return Err(LoadRefusal::at(place, "is missing"));
        };
        let decoded = match (image.buffer_view, &image.uri) {
            (Some(view), _) => decode(self.source.view(view)?, self.budget),
            (None, Some(uri)) => self.reader.uri(uri).and_then(|bytes| decode(&bytes, self.budget)),
            (None, None) => Err("has no data".into()),
        };
        decoded.map(Arc::new).map_err(|reason| LoadRefusal::at(place, reason))
    }
}

fn wrap(code: Option<Whole>) -> Wrap {
    match code.map_or(10_497, |code| code.0) {
        33_071 => Wrap::Clamp,
        33_648 => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// `NEAREST` and the two mipmap modes with a nearest filter.
fn is_nearest(code: Option<Whole>) -> bool {
    code.is_some_and(|code| matches!(code.0, 9_728 | 9_984 | 9_986))
}

/// The map of texture coordinates (extension KHR_texture_transform: scale, then a rotation that is counter-clockwise
/// with V pointing down, then offset), and the set that it applies to.
fn transform(info: &TextureInfo) -> ([[f32; 3]; 2], u64) {
    let Some(transform) = &info.extensions.transform else {
        return (UNCHANGED, info.tex_coord.0);
    };
    let (sin, cos) = transform.rotation.sin_cos();
    let ([x, y], [u, v]) = (transform.scale, transform.offset);
    let rows = [[cos * x, sin * y, u], [-sin * x, cos * y, v]];
    let rows = rows.map(|row| row.map(|v| v as f32));
    let rows = if rows.iter().flatten().all(|v| v.is_finite()) { rows } else { UNCHANGED };
    (rows, transform.tex_coord.unwrap_or(info.tex_coord).0)
}
