//! Tiles that know which lights may reach them: when they are worth the pass `lights`, and how much room they take.

/// Side of a tile, in pixels.
pub const LIGHT_TILE: u32 = 8;
/// Lights from which on the bits of tiles are worth the pass.
const LEAST_LIGHTS: usize = 8;
/// Lights that are expected to reach a tile, if there are many.
const LIGHTS_OF_TILE: usize = 16;

/// Bytes of the bits of all tiles in a picture of this size; `None` if there are too few lights or no buffer for so
/// many, and each pixel visits all of them.
pub fn bytes_of_light_tiles(lights: usize, size: [u32; 2], limit: u64) -> Option<u64> {
    let tiles = size.iter().map(|side| u64::from(side.div_ceil(LIGHT_TILE))).product::<u64>();
    let bytes = tiles * lights.div_ceil(32) as u64 * 4;
    (lights >= LEAST_LIGHTS && bytes <= limit).then_some(bytes)
}

/// The work for the light of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelLight {
    /// Number of lights.
    pub lights: usize,
    /// Whether tiles know which of them may reach their surfaces.
    pub tiled: bool,
    /// Expected number of leaves evaluated for shadows and occlusion; 0 without them.
    pub shadows: f64,
}

impl PixelLight {
    /// Expected cost of a pixel in the pass `shade`, in leaves.
    pub fn of_shading(&self) -> f64 {
        let lights = if self.tiled { self.lights.min(LIGHTS_OF_TILE) } else { self.lights };
        0.3 + 0.2 * lights as f64
    }

    /// The same in the pass `lights`, where a tile compares all lights once.
    pub fn of_tiles(&self) -> f64 {
        0.05 + 0.002 * self.lights as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_lights_and_very_many_have_no_tiles() {
        assert_eq!(bytes_of_light_tiles(LEAST_LIGHTS - 1, [64, 64], 1 << 20), None);
        assert_eq!(bytes_of_light_tiles(33, [65, 8], 1 << 20), Some(9 * 8));
        assert_eq!(bytes_of_light_tiles(33, [65, 8], 70), None);
    }
}
