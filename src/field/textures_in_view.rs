//! The places of textures relative to the eye, as the GPU and the reference renderer read them.

use super::arrays::FlatScene;
use super::flat_texture::GpuPlacedTextures;
use isolith_geometry::Camera;

/// The places of the textures of all materials as seen from the camera, parallel to the materials; empty for a scene
/// without textures.
pub fn gpu_textures(flat: &FlatScene, camera: &Camera) -> Vec<GpuPlacedTextures> {
    let textures = &flat.textures;
    if textures.sets.is_empty() {
        return Vec::new();
    }
    let of = |at: usize| {
        let placed = textures.placed.get(at).copied().flatten();
        placed.map_or_else(GpuPlacedTextures::none, |placed| GpuPlacedTextures::new(&placed, camera.position))
    };
    (0..flat.materials.len()).map(of).collect()
}
