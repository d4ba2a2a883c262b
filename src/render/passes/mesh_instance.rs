//! Placed parts of meshes as the pass `mesh` reads them.

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DMat3, DVec3};

use isolith_field::{FlatMesh, FlatScene, MESH_BIT};
use isolith_geometry::Camera;
use isolith_mesh::{MeshPart, TextureUse};

/// A part of a placed mesh, in the layout of the shader.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Instance {
    /// First row of the matrix from mesh space to world space, relative to the eye or to the point of
    /// `ray_origin_depth`.
    pub eye_from_local_x: [f32; 4],
    /// Second row.
    pub eye_from_local_y: [f32; 4],
    /// Third row.
    pub eye_from_local_z: [f32; 4],
    /// First row of the normal matrix.
    pub normal_x: [f32; 4],
    /// Second row.
    pub normal_y: [f32; 4],
    /// Third row.
    pub normal_z: [f32; 4],
    /// Factor of the vertex colors and their opacity.
    pub color: [f32; 4],
    /// Row that computes the texture's U from the vertices' texture coordinates; at last 1 for the second coordinates
    /// of a vertex.
    pub texture_x: [f32; 4],
    /// Row that computes the texture's V.
    pub texture_y: [f32; 4],
    /// Base color, used if `overridden` is 1.
    pub base_color: [f32; 3],
    /// Value for the visibility target.
    pub visibility: u32,
    /// 1: `base_color` replaces the mesh's own colors.
    pub overridden: u32,
    /// 1: the placement mirrors the mesh, which reverses the winding of its triangles.
    pub mirrored: u32,
    /// Opacity below which there is no surface; negative: the surface is everywhere.
    pub alpha_cutoff: f32,
    /// Distance from the eye to the point that positions are relative to, see `shaders/common/ray.wgsl`.
    pub ray_origin_depth: f32,
    /// Emission, a factor of its texture.
    pub emission: [f32; 3],
    /// Index of its material among those of the meshes.
    pub material: u32,
    /// Factor of the texture.
    pub metalness: f32,
    /// Factor of the texture.
    pub roughness: f32,
    /// Factor of the normals' first two coordinates; 0 without a texture of normals.
    pub normal_scale: f32,
    /// How far the texture of occlusion takes effect.
    pub occlusion_strength: f32,
    /// 1: emits its base color, and reflects nothing.
    pub unlit: u32,
    /// 1: covers samples by its opacity, see `shaders/common/coverage.wgsl`.
    pub blended: u32,
    /// Unused.
    pub padding_1: u32,
    /// Unused.
    pub padding_2: u32,
    /// Pairs of rows as `texture_x` and `texture_y`, of the textures in the order of [`isolith_mesh::Surface::maps`].
    pub map_rows: [[f32; 4]; 8],
}

/// A copy of a mesh, in the layout of the shader: rows as those of [`Instance`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CopyInstance {
    eye_from_mesh: [[f32; 4]; 3],
    normal: [[f32; 4]; 3],
}

/// Location of the first row of a copy in the shader.
const FIRST_COPY_ROW: u32 = 8;

impl CopyInstance {
    /// Its rows as the shader takes them.
    pub fn attributes() -> [wgpu::VertexAttribute; 6] {
        [0, 1, 2, 3, 4, 5].map(|row| wgpu::VertexAttribute {
            format: wgpu::VertexFormat::Float32x4,
            offset: 16 * u64::from(row),
            shader_location: FIRST_COPY_ROW + row,
        })
    }

    /// One after the other in a buffer.
    pub fn layout(attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
        let step_mode = wgpu::VertexStepMode::Instance;
        wgpu::VertexBufferLayout { array_stride: size_of::<Self>() as u64, step_mode, attributes }
    }

    /// A copy relative to a point of the world.
    pub fn new(world_from_mesh: &DAffine3, eye: DVec3) -> Self {
        let m = DAffine3 { translation: world_from_mesh.translation - eye, ..*world_from_mesh };
        let row = |i: usize| {
            let r = m.matrix3.row(i);
            [r.x as f32, r.y as f32, r.z as f32, m.translation[i] as f32]
        };
        let n = normal_matrix(&m.matrix3);
        let normal_row = |i: usize| {
            let r = n.row(i);
            [r.x as f32, r.y as f32, r.z as f32, 0.0]
        };
        Self { eye_from_mesh: [0, 1, 2].map(row), normal: [0, 1, 2].map(normal_row) }
    }
}

/// Normals transform by the inverse transpose; only their direction matters.
fn normal_matrix(m: &DMat3) -> DMat3 {
    let n = m.inverse().transpose();
    n * (1.0 / n.x_axis.abs().max(n.y_axis.abs()).max(n.z_axis.abs()).max_element())
}

/// A placed mesh: the data that its parts share.
pub(super) struct PlacedInstance {
    eye_from_local: DAffine3,
    /// The instance of a part at the mesh's own origin with default appearance.
    common: Instance,
}

impl PlacedInstance {
    /// `index` is that of the mesh in the scene.
    pub fn new(flat: &FlatScene, placed: &FlatMesh, index: usize, camera: &Camera, ray_origin_depth: f64) -> Self {
        let eye = camera.position + camera.rotation * DVec3::NEG_Z * ray_origin_depth;
        let m = DAffine3 { translation: placed.world_from_local.translation - eye, ..placed.world_from_local };
        let n = normal_matrix(&m.matrix3);
        let normal_row = |i: usize| {
            let r = n.row(i);
            [r.x as f32, r.y as f32, r.z as f32, 0.0]
        };
        let material = placed.material.map(|i| flat.materials[i as usize]);
        let common = Instance {
            normal_x: normal_row(0),
            normal_y: normal_row(1),
            normal_z: normal_row(2),
            base_color: material.map_or([1.0; 3], |m| m.base_color),
            emission: material.map_or([0.0; 3], |m| m.emission),
            metalness: material.map_or(0.0, |m| m.metalness),
            roughness: material.map_or(0.0, |m| m.roughness),
            visibility: MESH_BIT | index as u32,
            overridden: u32::from(material.is_some()),
            mirrored: u32::from(m.matrix3.determinant() < 0.0),
            ray_origin_depth: ray_origin_depth as f32,
            ..Instance::zeroed()
        };
        Self { eye_from_local: m, common }
    }

    /// The same for a type whose copies have places of their own, of which the first is like all in being mirrored.
    pub fn of_copies(
        flat: &FlatScene,
        placed: &FlatMesh,
        index: usize,
        first: &DAffine3,
        (camera, ray_origin_depth): (&Camera, f64),
    ) -> Self {
        let placed = FlatMesh { world_from_local: *first, ..placed.clone() };
        let Self { common, .. } = Self::new(flat, &placed, index, camera, ray_origin_depth);
        Self { eye_from_local: DAffine3::IDENTITY, common }
    }

    /// The instance of a part, whose material has this index.
    pub fn of_part(&self, part: &MeshPart, material: u32) -> Instance {
        let MeshPart { origin, surface, .. } = part;
        let m = &self.eye_from_local;
        let translation = m.translation + m.matrix3 * *origin;
        let row = |i: usize| {
            let r = m.matrix3.row(i);
            [r.x as f32, r.y as f32, r.z as f32, translation[i] as f32]
        };
        let [texture_x, texture_y] = rows(surface.base_color);
        let placed = Instance {
            eye_from_local_x: row(0),
            eye_from_local_y: row(1),
            eye_from_local_z: row(2),
            color: surface.color,
            texture_x,
            texture_y,
            alpha_cutoff: surface.alpha_cutoff.unwrap_or(-1.0),
            blended: u32::from(surface.is_blended),
            material,
            ..self.common
        };
        if placed.overridden == 1 {
            return placed;
        }
        let [[a, b], [c, d], [e, f], [g, h]] = surface.maps().map(rows);
        Instance {
            emission: surface.emission,
            metalness: surface.metalness,
            roughness: surface.roughness,
            normal_scale: if surface.normal.is_some() { surface.normal_scale } else { 0.0 },
            occlusion_strength: surface.occlusion_strength,
            unlit: u32::from(surface.is_unlit),
            map_rows: [a, b, c, d, e, f, g, h],
            ..placed
        }
    }
}

/// The rows that lead to a place in a texture.
fn rows(texture_use: Option<TextureUse>) -> [[f32; 4]; 2] {
    let Some(TextureUse { texture_from_uv, slot, .. }) = texture_use else { return [[0.0; 4]; 2] };
    texture_from_uv.map(|[a, b, c]| [a, b, c, slot as f32])
}
