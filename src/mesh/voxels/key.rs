//! What bricks are made of, as a key for their files.

use isolith_bricks::{ContentHash, ContentKey};

use super::super::TriangleMesh;

/// Changes with what is made of the same mesh.
const MAKER: u64 = 3;

/// The key of the bricks of a mesh: its triangles, its looks and the size of voxels.
pub fn bricks_key(mesh: &TriangleMesh, voxel: f64) -> ContentKey {
    let mut hash = ContentHash::default();
    hash.word(MAKER);
    hash.word(voxel.to_bits());
    floats(&mut hash, &mesh.positions);
    floats(&mut hash, &mesh.normals);
    floats(&mut hash, &mesh.colors);
    floats(&mut hash, &mesh.uvs);
    floats(&mut hash, &mesh.tangents);
    hash.word(mesh.indices.len() as u64);
    mesh.indices.iter().for_each(|index| hash.word(u64::from(*index)));
    for part in &mesh.parts {
        // All its numbers, written so that equal ones read equal.
        hash.bytes(format!("{part:?}").as_bytes());
    }
    for texture in &mesh.textures {
        hash.word(u64::from(texture.width) << 32 | u64::from(texture.height));
        hash.bytes(&texture.rgba);
    }
    hash.key()
}

fn floats<const N: usize>(hash: &mut ContentHash, values: &[[f32; N]]) {
    hash.word(values.len() as u64);
    values.iter().flatten().for_each(|value| hash.word(u64::from(value.to_bits())));
}
