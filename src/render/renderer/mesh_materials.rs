//! Materials of the meshes, in the form that the shade pass reads.

use std::collections::HashMap;
use std::sync::Arc;

use isolith_field::{FlatMaterial, FlatScene, mesh_material};
use isolith_mesh::TriangleMesh;

/// The materials of all parts of the meshes, each once.
#[derive(Debug, Default)]
pub struct MeshMaterials {
    /// The materials, without what textures change.
    pub all: Vec<FlatMaterial>,
    /// For each mesh of the scene the index of the material of each part.
    pub of_parts: Vec<Vec<u32>>,
}

impl MeshMaterials {
    /// The materials of a scene: those that override the files' own, or the files' own. `meshes` is parallel to
    /// `flat.meshes`.
    pub fn new(flat: &FlatScene, meshes: &[Option<Arc<TriangleMesh>>]) -> Self {
        let mut all = Vec::new();
        let mut known: HashMap<[u8; size_of::<FlatMaterial>()], u32> = HashMap::new();
        let mut index = |material: FlatMaterial| {
            *known.entry(bytemuck::cast(material)).or_insert_with(|| {
                all.push(material);
                all.len() as u32 - 1
            })
        };
        let mut of_parts = Vec::with_capacity(flat.meshes.len());
        for (placed, mesh) in flat.meshes.iter().zip(meshes) {
            let own = placed.material.map(|material| flat.materials[material as usize]);
            let parts = mesh.iter().flat_map(|mesh| &mesh.parts);
            of_parts.push(parts.map(|part| index(own.unwrap_or_else(|| mesh_material(&part.surface)))).collect());
        }
        Self { all, of_parts }
    }
}
