//! The triangle mesh with all data that a renderer uploads.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::bvh::{Bvh, Triangle};
use super::clip::ClipInfo;
use super::surface::{Surface, TextureUse};
use super::texture::{SharedTextures, Texture};
use isolith_geometry::{Aabb, Ray};

/// An indexed triangle mesh in one space: the file's scene with all its nodes written out.
///
/// Invariants, held by [`super::load`]: the vertex arrays are equally long; every index is inside
/// them; `indices` is a multiple of three long; the parts follow each other and cover all indices;
/// every number is finite; normals have unit length. Counter-clockwise triangles face the viewer.
#[derive(Debug)]
pub struct TriangleMesh {
    /// Positions of the vertices, in meters, relative to the origin of their part.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the vertices.
    pub normals: Vec<[f32; 3]>,
    /// Linear colors of the vertices with their opacity, multiplied with the color of the part.
    pub colors: Vec<[f32; 4]>,
    /// Two texture coordinates of each vertex, see [`TextureUse::slot`]; the origin is the upper left corner.
    pub uvs: Vec<[f32; 4]>,
    /// Unit tangents of the vertices along the first coordinate of the normal texture, and the sign of the bitangent;
    /// zero where the file has none. Empty if it has none at all.
    pub tangents: Vec<[f32; 4]>,
    /// Three vertex indices per triangle.
    pub indices: Vec<u32>,
    /// Runs of triangles with the same surface that stand near each other.
    pub parts: Vec<MeshPart>,
    /// All textures.
    pub textures: Vec<Arc<Texture>>,
    /// For each texture the image of the file.
    pub(super) images: Vec<usize>,
    /// The animation clips of the file.
    pub clips: Vec<ClipInfo>,
    /// The smallest box around all triangles.
    pub bounds: Aabb,
    /// Contents of the file that are not drawn, as texts for the user.
    pub warnings: Vec<String>,
    /// The hierarchy for rays; built on first use.
    pub(super) bvh: OnceLock<Bvh>,
}

/// A run of triangles with the same surface that stand near each other.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPart {
    /// The range in [`TriangleMesh::indices`].
    pub indices: Range<u32>,
    /// The origin of its positions: 0 unless they lie so far away that f32 would change their shape.
    pub origin: DVec3,
    /// Its appearance.
    pub surface: Surface,
}

/// The first intersection of a ray with a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// Parameter along the ray, in units of its direction's length.
    pub t: f64,
    /// Index of the triangle: its corners are `indices[3 * triangle..][..3]`.
    pub triangle: u32,
    /// Barycentric weights of the three corners; they sum to 1.
    pub weights: [f64; 3],
    /// The corners' normals interpolated with `weights`, of unit length.
    pub normal: DVec3,
}

/// The look of a surface at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshLook {
    /// Linear color and opacity.
    pub color: DVec4,
    /// 0 for a dielectric, 1 for a metal.
    pub metalness: f64,
    /// Roughness as perceived.
    pub roughness: f64,
    /// Share of the ambient light that arrives.
    pub occlusion: f64,
    /// Linear emitted light.
    pub emission: DVec3,
}

/// Most looks at a texture along each side of a square over which it is averaged.
const MOST_LOOKS: f64 = 8.0;

/// A byte of a texture of numbers.
fn plain(bytes: [u8; 4]) -> DVec4 {
    DVec4::from(bytes.map(|b| f64::from(b) / 255.0))
}

impl TriangleMesh {
    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> Triangle {
        let origin = self.part(triangle).origin;
        self.vertices(triangle).map(|v| origin + point(self.positions[v]))
    }

    /// The textures by their images, for another pose of the same file.
    pub(super) fn shared_textures(&self) -> SharedTextures {
        self.images.iter().copied().zip(self.textures.iter().cloned()).collect()
    }

    /// The part that a triangle belongs to.
    pub fn part(&self, triangle: u32) -> &MeshPart {
        let after = self.parts.partition_point(|part| part.indices.start <= 3 * triangle);
        &self.parts[after - 1]
    }

    /// The nearest hit with 0 ≤ t ≤ `max_t`, from either side; points that the opacity cuts out do not count, nor do
    /// blended ones without any. The ray is in the mesh's own space; its direction may have any length but zero, and
    /// `t` is in its units.
    pub fn hit(&self, ray_local: &Ray, max_t: f64) -> Option<MeshHit> {
        self.hit_covering(ray_local, max_t, |_, opacity| opacity > 0.0)
    }

    /// The same, with a rule for blended surfaces: whether a point covers what lies behind, by the first vertex of its
    /// triangle and its opacity.
    pub fn hit_covering(&self, ray_local: &Ray, max_t: f64, covers: impl Fn(u32, f64) -> bool) -> Option<MeshHit> {
        let is_there = |triangle, weights| self.is_there(triangle, weights, &covers);
        let corners = |triangle| self.corners(triangle);
        let (t, triangle, weights) = self.bvh().hit(ray_local, max_t, corners, is_there)?;
        Some(MeshHit { t, triangle, weights, normal: self.normal_at(triangle, weights) })
    }

    /// Color and opacity at a point of a triangle: vertex color times part color times texture. `decode` converts a
    /// texture's bytes to linear numbers.
    pub fn color(&self, triangle: u32, weights: [f64; 3], decode: impl Fn([u8; 4]) -> DVec4) -> DVec4 {
        self.color_over(triangle, weights, 0.0, decode)
    }

    /// The same, as a mean over this width.
    fn color_over(&self, triangle: u32, weights: [f64; 3], width: f64, decode: impl Fn([u8; 4]) -> DVec4) -> DVec4 {
        let Surface { color, base_color, .. } = self.part(triangle).surface;
        let corners = self.vertices(triangle);
        let own: DVec4 = (0..3).map(|i| DVec4::from(self.colors[corners[i]].map(f64::from)) * weights[i]).sum();
        let own = own * DVec4::from(color.map(f64::from));
        base_color.map_or(own, |base_color| own * self.texel(triangle, weights, width, &base_color, decode))
    }

    /// The look at a point of a triangle. `decode` converts bytes of colors to linear numbers.
    pub fn look(&self, triangle: u32, weights: [f64; 3], decode: impl Fn([u8; 4]) -> DVec4) -> MeshLook {
        self.look_over(triangle, weights, 0.0, decode)
    }

    /// The same, as a mean over this width, in meters.
    pub fn look_over(
        &self,
        triangle: u32,
        weights: [f64; 3],
        width: f64,
        decode: impl Fn([u8; 4]) -> DVec4,
    ) -> MeshLook {
        let surface = &self.part(triangle).surface;
        let sampled = |texture_use: &Option<TextureUse>| {
            let texel = |texture_use| self.texel(triangle, weights, width, texture_use, plain);
            texture_use.as_ref().map_or(DVec4::ONE, texel)
        };
        let metal_rough = sampled(&surface.metal_rough);
        let emissive =
            surface.emissive.map_or(DVec4::ONE, |emissive| self.texel(triangle, weights, width, &emissive, &decode));
        let strength = f64::from(surface.occlusion_strength);
        MeshLook {
            color: self.color_over(triangle, weights, width, &decode),
            metalness: f64::from(surface.metalness) * metal_rough.z,
            roughness: f64::from(surface.roughness) * metal_rough.y,
            occlusion: 1.0 + strength * (sampled(&surface.occlusion).x - 1.0),
            emission: point(surface.emission) * emissive.truncate(),
        }
    }

    /// The normal at a point of a triangle after the normal texture, of unit length. `normal` is the one before, also
    /// of unit length, in the space to which `from_local` leads.
    pub fn mapped_normal(&self, triangle: u32, weights: [f64; 3], normal: DVec3, from_local: &DMat3) -> DVec3 {
        self.mapped_normal_over(triangle, weights, 0.0, normal, from_local)
    }

    /// The same, as a mean over this width, in meters of the mesh.
    pub fn mapped_normal_over(
        &self,
        triangle: u32,
        weights: [f64; 3],
        width: f64,
        normal: DVec3,
        from_local: &DMat3,
    ) -> DVec3 {
        let surface = &self.part(triangle).surface;
        let Some(texture_use) = &surface.normal else { return normal };
        let frame = self.tangent_frame(triangle, weights, texture_use, normal, from_local);
        let Some([tangent, bitangent]) = frame else { return normal };
        let scale = f64::from(surface.normal_scale);
        let read = self.texel(triangle, weights, width, texture_use, plain) * 2.0 - 1.0;
        let mapped = tangent * (read.x * scale) + bitangent * (read.y * scale) + normal * read.z;
        mapped.try_normalize().unwrap_or(normal)
    }

    /// Directions in which the coordinates of a texture of normals grow: to the right and upward. Given by the file, or
    /// by the triangle's texture coordinates; `None` if neither tells.
    fn tangent_frame(
        &self,
        triangle: u32,
        weights: [f64; 3],
        texture_use: &TextureUse,
        normal: DVec3,
        from_local: &DMat3,
    ) -> Option<[DVec3; 2]> {
        let corners = self.vertices(triangle);
        if let Some(first) = self.tangents.get(corners[0]).filter(|tangent| tangent[3] != 0.0) {
            let given = |i: usize| {
                let [x, y, z, _] = self.tangents[corners[i]];
                point([x, y, z]) * weights[i]
            };
            let tangent = (*from_local * (0..3).map(given).sum::<DVec3>()).try_normalize()?;
            let sign = f64::from(first[3]) * from_local.determinant().signum();
            return Some([tangent, normal.cross(tangent) * sign]);
        }
        let [a, b, c] = self.corners(triangle);
        let [at_a, at_b, at_c] = [0, 1, 2].map(|i| texture_use.place(self.uv(corners[i], texture_use.slot)));
        let (ab, ac, by_b, by_c) = (*from_local * (b - a), *from_local * (c - a), at_b - at_a, at_c - at_a);
        let area = by_b.perp_dot(by_c);
        if area == 0.0 {
            return None;
        }
        // By Cramer's rule; V points down.
        let across = (ab * by_c.y - ac * by_b.y) * area.signum();
        let up = (ab * by_c.x - ac * by_b.x) * area.signum();
        let tangent = (across - normal * normal.dot(across)).try_normalize()?;
        let bitangent = normal.cross(tangent);
        Some([tangent, if bitangent.dot(up) < 0.0 { -bitangent } else { bitangent }])
    }

    /// A texture at a point of a triangle: the mean over a square of this width in meters, of as many looks as it has
    /// pixels, but no more than [`MOST_LOOKS`] along each side.
    fn texel(
        &self,
        triangle: u32,
        weights: [f64; 3],
        width: f64,
        texture_use: &TextureUse,
        decode: impl Fn([u8; 4]) -> DVec4,
    ) -> DVec4 {
        let corners = self.vertices(triangle);
        let uv: DVec2 = (0..3).map(|i| self.uv(corners[i], texture_use.slot) * weights[i]).sum();
        let at = texture_use.place(uv);
        let texture = &self.textures[texture_use.texture];
        let sample = |at: DVec2| texture.sample(texture_use.sampler, at.x, at.y, &decode);
        if width <= 0.0 {
            return sample(at);
        }
        let [a, b, c] = corners.map(|corner| texture_use.place(self.uv(corner, texture_use.slot)));
        let (size, area) = (f64::from(texture.width) * f64::from(texture.height), self.face_normal(triangle).length());
        let side = width * ((b - a).perp_dot(c - a).abs() / area.max(f64::MIN_POSITIVE)).sqrt();
        let looks = (side * size.sqrt()).ceil().clamp(1.0, MOST_LOOKS);
        let offset = |i: f64| side * ((i + 0.5) / looks - 0.5);
        let all = (0..(looks * looks) as usize).map(|i| {
            let (x, y) = (i % looks as usize, i / looks as usize);
            sample(at + DVec2::new(offset(x as f64), offset(y as f64)))
        });
        all.sum::<DVec4>() / (looks * looks)
    }

    /// Whether it says anything of its look.
    pub fn has_looks(&self) -> bool {
        let is_usual = |part: &MeshPart| part.surface == Surface::default();
        !self.parts.iter().all(is_usual) || self.colors.iter().any(|color| *color != [1.0; 4])
    }

    /// The surface and the color of a triangle that looks the same all over; `None` for one with textures or several colors.
    pub(super) fn plain_look(&self, triangle: u32) -> Option<(Surface, [f32; 4])> {
        let surface = self.part(triangle).surface;
        let textures = [surface.base_color, surface.metal_rough, surface.normal, surface.occlusion, surface.emissive];
        let [a, b, c] = self.vertices(triangle).map(|vertex| self.colors[vertex]);
        (textures.iter().all(Option::is_none) && a == b && a == c).then_some((surface, a))
    }

    /// What its surfaces have and bricks do not keep.
    pub fn unkept_looks(&self) -> Vec<&'static str> {
        type Has = fn(&Surface) -> bool;
        let any = |has: Has| self.parts.iter().any(|part| has(&part.surface));
        let all: [(&str, Has); 5] = [
            ("clear coats", |s| s.coat_weight > 0.0),
            ("textures of occlusion", |s| s.occlusion.is_some()),
            ("masks and opacity", |s| s.is_blended || s.alpha_cutoff.is_some()),
            ("surfaces without light", |s| s.is_unlit),
            ("other reflection than of index 1.5", |s| {
                (s.ior, s.specular_weight, s.specular_color) != (1.5, 1.0, [1.0; 3])
            }),
        ];
        all.into_iter().filter(|(_, has)| any(*has)).map(|(name, _)| name).collect()
    }

    fn uv(&self, vertex: usize, slot: usize) -> DVec2 {
        let [u, v, u2, v2] = self.uvs[vertex].map(f64::from);
        if slot == 0 { DVec2::new(u, v) } else { DVec2::new(u2, v2) }
    }

    /// The nearest hit with 0 ≤ t ≤ `max_t` on a surface that stops light: blended ones let all of it pass, and masks
    /// are not read. As the rays on the GPU have it.
    pub fn hit_solid(&self, ray_local: &Ray, max_t: f64) -> Option<MeshHit> {
        let corners = |triangle| self.corners(triangle);
        let is_solid = |triangle, _| !self.part(triangle).surface.is_blended;
        let (t, triangle, weights) = self.bvh().hit(ray_local, max_t, corners, is_solid)?;
        Some(MeshHit { t, triangle, weights, normal: self.normal_at(triangle, weights) })
    }

    /// Distance in meters from a point to the nearest triangle that stops light; `within` if there is none so near.
    pub fn distance_to_solid(&self, p_local: DVec3, world_from_local: &DMat3, within: f64) -> f64 {
        let corners = |triangle| self.corners(triangle);
        let is_solid = |triangle| !self.part(triangle).surface.is_blended;
        self.bvh().distance(p_local, world_from_local, within, corners, is_solid)
    }

    fn is_there(&self, triangle: u32, weights: [f64; 3], covers: &impl Fn(u32, f64) -> bool) -> bool {
        let opacity = || self.color(triangle, weights, |[.., a]| DVec4::splat(f64::from(a) / 255.0)).w;
        match self.part(triangle).surface {
            Surface { is_blended: true, .. } => covers(self.indices[3 * triangle as usize], opacity()),
            Surface { alpha_cutoff: Some(cutoff), .. } => opacity() >= f64::from(cutoff),
            _ => true,
        }
    }

    /// The hierarchy over the triangles, built on first use.
    pub fn bvh(&self) -> &Bvh {
        self.bvh.get_or_init(|| Bvh::build(self.triangle_count(), |triangle| self.corners(triangle)))
    }

    /// The outward normal of the triangle itself; not of unit length, zero if the triangle has no area.
    pub fn face_normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    /// The normals of the corners, mixed; of unit length.
    pub(super) fn normal_at(&self, triangle: u32, weights: [f64; 3]) -> DVec3 {
        let corners = self.vertices(triangle);
        let mixed: DVec3 = (0..3).map(|i| point(self.normals[corners[i]]) * weights[i]).sum();
        mixed.try_normalize().or_else(|| self.face_normal(triangle).try_normalize()).unwrap_or(DVec3::Y)
    }

    fn vertices(&self, triangle: u32) -> [usize; 3] {
        let at = triangle as usize * 3;
        [0, 1, 2].map(|i| self.indices[at + i] as usize)
    }
}

fn point(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}
