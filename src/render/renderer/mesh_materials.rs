//! Materials of the meshes, as the shade pass reads them.

use isolith_field::{FILE_SHININESS, FILE_SPECULAR, FlatMaterial, FlatScene};

/// What each mesh is made of: the material that stands for its own ones, where there is one. Its color stands in a target.
pub fn mesh_materials(flat: &FlatScene) -> Vec<FlatMaterial> {
    let own = FlatMaterial {
        albedo: [1.0; 3],
        specular: FILE_SPECULAR as f32,
        emission: [0.0; 3],
        shininess: FILE_SHININESS as f32,
    };
    flat.meshes.iter().map(|mesh| mesh.material.map_or(own, |i| flat.materials[i as usize])).collect()
}
