//! The images of textures in words, as the GPU reads them.

use super::flat_texture::{FlatImage, IMAGE_HEADER};

/// All images in words, as the GPU reads them: their headers, then the texels of their levels.
pub fn texel_words(images: &[FlatImage]) -> Vec<u32> {
    let mut words = vec![0; images.len() * IMAGE_HEADER];
    for (at, image) in images.iter().enumerate() {
        let levels = &image.pyramid.levels[image.skipped..];
        let [width, height] = levels[0].size;
        let mut header = vec![width, height, levels.len() as u32, image.pyramid.form as u32];
        for level in levels {
            header.push(words.len() as u32);
            words.extend(&level.texels);
        }
        words[at * IMAGE_HEADER..][..header.len()].copy_from_slice(&header);
    }
    words
}
