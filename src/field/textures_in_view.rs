//! The places of textures relative to the eye, as the GPU and the reference renderer read them.

use super::arrays::FlatScene;
use super::flat_texture::GpuPlacedTextures;
use glam::DVec3;
use isolith_geometry::Camera;

/// The places of the textures of all materials as seen from the camera, parallel to the materials; empty for a scene
/// without textures.
pub fn gpu_textures(flat: &FlatScene, camera: &Camera) -> Vec<GpuPlacedTextures> {
    textures_from(flat, camera.position)
}

/// The same for an eye at this place.
pub(super) fn textures_from(flat: &FlatScene, eye: DVec3) -> Vec<GpuPlacedTextures> {
    let textures = &flat.textures;
    if textures.sets.is_empty() {
        return Vec::new();
    }
    let of = |at: usize| {
        let placed = textures.placed.get(at).copied().flatten();
        placed.map_or_else(GpuPlacedTextures::none, |placed| GpuPlacedTextures::new(&placed, eye))
    };
    (0..flat.materials.len()).map(of).collect()
}
