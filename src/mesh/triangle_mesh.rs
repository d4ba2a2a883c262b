//! The triangle mesh with all data that a renderer uploads.

use std::ops::Range;
use std::sync::OnceLock;

use glam::{DVec2, DVec3, DVec4};

use super::bvh::{Bvh, Triangle};
use super::surface::Surface;
use super::texture::Texture;
use isolith_geometry::{Aabb, Ray};

/// An indexed triangle mesh in one space: the file's scene with all its nodes written out.
///
/// Invariants, held by [`super::load`]: the four vertex arrays are equally long; every index is inside
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
    /// Texture coordinates of the vertices; the origin is the upper left corner.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertex indices per triangle.
    pub indices: Vec<u32>,
    /// Runs of triangles with the same surface that stand near each other.
    pub parts: Vec<MeshPart>,
    /// Base color textures.
    pub textures: Vec<Texture>,
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

    /// The part that a triangle belongs to.
    pub fn part(&self, triangle: u32) -> &MeshPart {
        let after = self.parts.partition_point(|part| part.indices.start <= 3 * triangle);
        &self.parts[after - 1]
    }

    /// The nearest hit with 0 ≤ t ≤ `max_t`, from either side; points that the opacity cuts out do not count. The ray
    /// is in the mesh's own space; its direction may have any length but zero, and `t` is in its units.
    pub fn hit(&self, ray_local: &Ray, max_t: f64) -> Option<MeshHit> {
        let is_there = |triangle, weights| !self.is_cut_out(triangle, weights);
        let corners = |triangle| self.corners(triangle);
        let (t, triangle, weights) = self.bvh().hit(ray_local, max_t, corners, is_there)?;
        Some(MeshHit { t, triangle, weights, normal: self.normal_at(triangle, weights) })
    }

    /// Color and opacity at a point of a triangle: vertex color times part color times texture. `decode` converts a
    /// texture's bytes to linear numbers.
    pub fn color(&self, triangle: u32, weights: [f64; 3], decode: impl Fn([u8; 4]) -> DVec4) -> DVec4 {
        let Surface { color, texture, sampler, .. } = self.part(triangle).surface;
        let corners = self.vertices(triangle);
        let own: DVec4 = (0..3).map(|i| DVec4::from(self.colors[corners[i]].map(f64::from)) * weights[i]).sum();
        let own = own * DVec4::from(color.map(f64::from));
        let Some(texture) = texture else { return own };
        let uv: DVec2 = (0..3).map(|i| DVec2::from(self.uvs[corners[i]].map(f64::from)) * weights[i]).sum();
        let at = self.part(triangle).surface.texture_place(uv);
        own * self.textures[texture].sample(sampler, at.x, at.y, decode)
    }

    fn is_cut_out(&self, triangle: u32, weights: [f64; 3]) -> bool {
        let Some(cutoff) = self.part(triangle).surface.alpha_cutoff else { return false };
        let opacity = self.color(triangle, weights, |[.., a]| DVec4::splat(f64::from(a) / 255.0)).w;
        opacity < f64::from(cutoff)
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

    fn normal_at(&self, triangle: u32, weights: [f64; 3]) -> DVec3 {
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
