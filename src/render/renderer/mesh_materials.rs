//! Materials of the meshes, in the form that the shade pass reads.

use isolith_field::{FILE_SHININESS, FILE_SPECULAR, FlatMaterial, FlatScene};

/// The material of each mesh: the one that overrides its own materials, if any. Its color is in a target.
pub fn mesh_materials(flat: &FlatScene) -> Vec<FlatMaterial> {
    let own = FlatMaterial {
        albedo: [1.0; 3],
        specular: FILE_SPECULAR as f32,
        emission: [0.0; 3],
        shininess: FILE_SHININESS as f32,
    };
    flat.meshes.iter().map(|mesh| mesh.material.map_or(own, |i| flat.materials[i as usize])).collect()
}
