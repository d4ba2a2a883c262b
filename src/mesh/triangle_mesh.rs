//! Triangles with everything that a renderer uploads.

use std::ops::Range;
use std::sync::OnceLock;

use glam::DVec3;

use super::bvh::{Bvh, Triangle};
use crate::geometry::{Aabb, Ray};

/// An indexed triangle mesh in one space: the file's scene with all its nodes written out.
///
/// Invariants, held by [`super::load`]: the four vertex arrays are equally long; every index is inside
/// them; `indices` is a multiple of three long; the parts follow each other and cover all indices;
/// every number is finite; normals have unit length. Counter-clockwise triangles face the viewer.
#[derive(Debug)]
pub struct TriangleMesh {
    /// Places of the vertices, in metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the vertices.
    pub normals: Vec<[f32; 3]>,
    /// Linear albedo of the vertices: the material's base colour factor times the vertex colour.
    pub colors: Vec<[f32; 3]>,
    /// Texture coordinates of the vertices; the origin is the upper left corner, textures repeat.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertices per triangle.
    pub indices: Vec<u32>,
    /// Runs of triangles that wear the same texture.
    pub parts: Vec<Part>,
    /// Base colour textures, to be multiplied with `colors` after conversion to linear.
    pub textures: Vec<Texture>,
    /// The smallest box around all triangles.
    pub bounds: Aabb,
    /// For rays; built by the first one.
    pub(super) bvh: OnceLock<Bvh>,
}

/// A run of triangles that wear the same texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Which of [`TriangleMesh::indices`].
    pub indices: Range<u32>,
    /// Index into [`TriangleMesh::textures`].
    pub base_color_texture: Option<usize>,
}

/// A picture.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Rows from the top, four bytes per pixel, sRGB with straight alpha.
    pub rgba: Vec<u8>,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Texture({} × {})", self.width, self.height)
    }
}

/// Where a ray meets a mesh first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// Parameter along the ray, in units of its direction's length.
    pub t: f64,
    /// Which triangle: its corners are `indices[3 * triangle..][..3]`.
    pub triangle: u32,
    /// Barycentric weights of the three corners; they sum to 1.
    pub weights: [f64; 3],
    /// The corners' normals mixed by `weights`, of unit length.
    pub normal: DVec3,
}

impl TriangleMesh {
    /// How many triangles.
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> Triangle {
        self.vertices(triangle).map(|v| point(self.positions[v]))
    }

    /// The nearest triangle that the ray meets with 0 ≤ t ≤ `max_t`, from either side. The ray is in
    /// the mesh's own space; its direction may have any length but zero, and `t` is in its units.
    pub fn hit(&self, ray_local: &Ray, max_t: f64) -> Option<MeshHit> {
        let (t, triangle, weights) = self.bvh().hit(ray_local, max_t, |triangle| self.corners(triangle))?;
        Some(MeshHit { t, triangle, weights, normal: self.normal_at(triangle, weights) })
    }

    /// The tree over the triangles, built on first use.
    pub fn bvh(&self) -> &Bvh {
        self.bvh.get_or_init(|| Bvh::build(self.triangle_count(), |triangle| self.corners(triangle)))
    }

    /// The normal of the triangle itself, outwards; not of unit length, zero where the triangle has no area.
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
