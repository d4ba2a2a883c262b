//! A small mesh of which all is made that bricks hold: a painted solid with edges, and a sheet beside it.

use std::sync::OnceLock;

use glam::DVec3;
use isolith_geometry::Aabb;

use super::super::{MeshPart, Surface, TriangleMesh};

/// Corners of a skewed octahedron, and three of a sheet.
const POINTS: [[f32; 3]; 9] = [
    [1.0, 0.1, 0.0],
    [-0.9, 0.0, 0.2],
    [0.0, 0.8, 0.1],
    [0.1, -0.7, 0.0],
    [0.0, 0.2, 0.9],
    [-0.2, 0.0, -1.0],
    [1.3, -0.5, 0.3],
    [1.3, 0.6, 0.1],
    [1.6, 0.0, -0.7],
];
#[rustfmt::skip]
const TRIANGLES: [u32; 27] = [
    0, 2, 4,  2, 1, 4,  1, 3, 4,  3, 0, 4,  2, 0, 5,  1, 2, 5,  3, 1, 5,  0, 3, 5,  6, 7, 8,
];

pub(super) fn sample() -> TriangleMesh {
    let bounds = Aabb::from_points(POINTS.map(|p| DVec3::from(p.map(f64::from))));
    let color = |p: &[f32; 3]| [0.5 + 0.25 * p[0], 0.5 + 0.25 * p[1], 0.5, 1.0];
    TriangleMesh {
        positions: POINTS.to_vec(),
        normals: vec![[0.0, 1.0, 0.0]; POINTS.len()],
        colors: POINTS.iter().map(color).collect(),
        uvs: vec![[0.0; 4]; POINTS.len()],
        tangents: Vec::new(),
        indices: TRIANGLES.to_vec(),
        parts: vec![MeshPart { indices: 0..TRIANGLES.len() as u32, origin: DVec3::ZERO, surface: Surface::default() }],
        textures: Vec::new(),
        images: Vec::new(),
        clips: Vec::new(),
        bounds,
        warnings: Vec::new(),
        bvh: OnceLock::new(),
    }
}
