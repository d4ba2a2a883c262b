//! Materials: the appearance of a run of triangles.

use std::collections::HashMap;

use glam::DVec2;

use super::accessor::Source;
use super::error::{LoadRefusal, name};
use super::remarks::Remarks;
use super::resolve::Reader;
use super::schema::{GltfMaterial, Primitive, TextureInfo, Whole};
use super::texture::{Sampler, Texture, Wrap, decode};

/// The appearance of a run of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear factor on the vertices' colors and opacity.
    pub color: [f32; 4],
    /// There is no surface where the opacity is below this; `None` for a surface everywhere.
    pub alpha_cutoff: Option<f32>,
    /// Index into [`super::TriangleMesh::textures`]; multiplied with `color` after conversion to linear.
    pub texture: Option<usize>,
    /// The sampler of the texture.
    pub sampler: Sampler,
    /// Rows of the affine map from the vertices' texture coordinates to those of the texture.
    pub texture_from_uv: [[f32; 3]; 2],
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            color: [1.0; 4],
            alpha_cutoff: None,
            texture: None,
            sampler: Sampler::default(),
            texture_from_uv: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        }
    }
}

impl Surface {
    /// Transforms the texture coordinates of a vertex, or of a point between vertices, to those of the texture.
    pub fn texture_place(&self, uv: DVec2) -> DVec2 {
        let row = |[a, b, c]: [f32; 3]| f64::from(a) * uv.x + f64::from(b) * uv.y + f64::from(c);
        DVec2::new(row(self.texture_from_uv[0]), row(self.texture_from_uv[1]))
    }
}

/// Converts the materials of a document, and decodes each of its images once.
pub(super) struct Surfaces<'a> {
    source: &'a Source<'a>,
    reader: &'a Reader<'a>,
    budget: &'a mut u64,
    /// The decoded images.
    pub textures: Vec<Texture>,
    /// The index of each decoded image of the document; `None` if it cannot be used.
    decoded: HashMap<usize, Option<usize>>,
}

impl<'a> Surfaces<'a> {
    pub fn new(source: &'a Source<'a>, reader: &'a Reader<'a>, budget: &'a mut u64) -> Self {
        Self { source, reader, budget, textures: Vec::new(), decoded: HashMap::new() }
    }

    /// The surface of a primitive, with the set of texture coordinates for its texture. Leaves out what it cannot load,
    /// with a remark.
    pub fn of(&mut self, primitive: &Primitive, remarks: &mut Remarks) -> (Surface, u64) {
        let Some(index) = primitive.material else { return (Surface::default(), 0) };
        let Some(material) = self.source.root.materials.get(index.index()) else { return (Surface::default(), 0) };
        remarks.material(index.index(), material);
        let (factor, info) = base_color(material);
        let color = factor.map(|c| if c.is_finite() { c.clamp(0.0, 1.0) as f32 } else { 1.0 });
        let alpha_cutoff = (material.alpha_mode.as_deref() == Some("MASK"))
            .then(|| material.alpha_cutoff.filter(|c| c.is_finite()).unwrap_or(0.5).clamp(0.0, 2.0) as f32);
        let plain = Surface { color, alpha_cutoff, ..Surface::default() };
        let Some(info) = info else { return (plain, 0) };
        let Some((texture, sampler)) = self.texture(info.index, remarks) else { return (plain, 0) };
        let (texture_from_uv, uv_set) = transform(info);
        (Surface { texture: Some(texture), sampler, texture_from_uv, ..plain }, uv_set)
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

    fn decode(&mut self, index: Whole) -> Result<Texture, LoadRefusal> {
        let place = format!("images[{}]", index.0);
        let Some(image) = self.source.root.images.get(index.index()) else {
            return Err(LoadRefusal::at(place, "is missing"));
        };
        let decoded = match (image.buffer_view, &image.uri) {
            (Some(view), _) => decode(self.source.view(view)?, self.budget),
            (None, Some(uri)) => self.reader.uri(uri).and_then(|bytes| decode(&bytes, self.budget)),
            (None, None) => Err("has no data".into()),
        };
        decoded.map_err(|reason| LoadRefusal::at(place, reason))
    }
}

/// The base color of a material. The older specular-glossiness extension calls it diffuse; it takes precedence if
/// present.
fn base_color(material: &GltfMaterial) -> ([f64; 4], Option<&TextureInfo>) {
    match &material.extensions.specular_glossiness {
        Some(older) => (older.diffuse_factor.unwrap_or([1.0; 4]), older.diffuse_texture.as_ref()),
        None => {
            let pbr = &material.pbr_metallic_roughness;
            (pbr.base_color_factor.unwrap_or([1.0; 4]), pbr.base_color_texture.as_ref())
        }
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
        return (Surface::default().texture_from_uv, info.tex_coord.0);
    };
    let (sin, cos) = transform.rotation.sin_cos();
    let ([x, y], [u, v]) = (transform.scale, transform.offset);
    let rows = [[cos * x, sin * y, u], [-sin * x, cos * y, v]];
    let rows = rows.map(|row| row.map(|v| v as f32));
    let rows = if rows.iter().flatten().all(|v| v.is_finite()) { rows } else { Surface::default().texture_from_uv };
    (rows, transform.tex_coord.unwrap_or(info.tex_coord).0)
}
