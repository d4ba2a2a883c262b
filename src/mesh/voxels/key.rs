//! What bricks are made of, as a key for their files.

use std::sync::LazyLock;

use isolith_bricks::{ContentHash, ContentKey, to_bytes};

use super::super::TriangleMesh;
use super::{sample::sample, voxelized};

/// Changes with what is made of the same mesh.
const MAKER: u64 = 4;
/// Voxels of the sample: enough for three levels.
const SAMPLE_VOXEL: f64 = 1.0 / 32.0;

/// What this program makes of a small mesh: bricks that an earlier one made otherwise are not taken for its own, even if
/// nobody thought of [`MAKER`].
static MADE: LazyLock<ContentKey> = LazyLock::new(|| {
    let mut hash = ContentHash::default();
    hash.word(MAKER);
    let made = voxelized(&sample(), SAMPLE_VOXEL, &mut |_| true).expect("it has a surface and few voxels");
    hash.bytes(&to_bytes(&made.bricks, ContentKey([0; 2])));
    hash.key()
});

/// The key of what is made into bricks, whatever it is made of.
pub fn maker_key() -> ContentKey {
    *MADE
}

/// The key of the bricks of a mesh: its triangles, its looks and the size of voxels.
pub fn bricks_key(mesh: &TriangleMesh, voxel: f64) -> ContentKey {
    let mut hash = ContentHash::default();
    maker_key().0.into_iter().chain([voxel.to_bits()]).for_each(|word| hash.word(word));
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

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_bricks::COARSER;

    /// Whatever of it were missing could change without another key.
    #[test]
    fn the_sample_is_made_into_all_that_bricks_hold() {
        let made = voxelized(&sample(), SAMPLE_VOXEL, &mut |_| true).unwrap();
        assert!(!made.remarks.is_empty(), "it has a sheet");
        let levels: Vec<_> = std::iter::successors(Some(&*made.bricks), |level| level.coarser.as_deref()).collect();
        assert!(levels.len() >= 3 && levels.iter().all(|level| level.looks.is_some()), "{}", levels.len());
        assert!(levels[0].texels.iter().flatten().any(|word| *word == COARSER), "a coarser level stands in for some");
        assert!(levels[0].count() > 8);
    }
}
