//! Materials of the meshes, in the form that the shade pass reads.

use isolith_field::{FlatMaterial, FlatScene};

/// The material of each mesh: the one that overrides its own materials, if any. Its color is in a target.
pub fn mesh_materials(flat: &FlatScene) -> Vec<FlatMaterial> {
    let of = |material: Option<u32>| material.map_or(FlatMaterial::of_file(), |i| flat.materials[i as usize]);
    flat.meshes.iter().map(|mesh| of(mesh.material)).collect()
}
