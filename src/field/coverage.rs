//! What is partly transparent covers a pixel in some samples and not in others: as many as its opacity says.
//! Counterpart of `shaders/common/coverage.wgsl`, which names the sources.

/// One sample of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelSample {
    /// Column and row.
    pub pixel: [u32; 2],
    /// The number of the sample.
    pub sample: u32,
}

/// The opacity above which a layer covers this sample, strictly between 0 and 1.
pub fn coverage_threshold(PixelSample { pixel: [x, y], sample }: PixelSample, layer: u32) -> f64 {
    let from_row = y.wrapping_add(coverage_hash(layer));
    let seed = coverage_hash(x.wrapping_add(coverage_hash(from_row)));
    let shuffled = coverage_scrambled(sample.reverse_bits(), seed).reverse_bits();
    let value = coverage_scrambled(shuffled, coverage_hash(seed)).reverse_bits();
    (f64::from(value >> 9) + 0.5) / 8_388_608.0
}

/// The layer of a triangle: `code` is the value of its mesh in the visibility target, `vertex` its first vertex.
pub fn coverage_layer(code: u32, vertex: u32) -> u32 {
    vertex.wrapping_add(coverage_hash(code))
}

/// A hash of a number.
pub fn coverage_hash(from: u32) -> u32 {
    let state = from.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn coverage_scrambled(from: u32, seed: u32) -> u32 {
    let mut x = from.wrapping_add(seed);
    for factor in [0x6c50_b47c, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6_u32] {
        x ^= x.wrapping_mul(factor);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of 64 samples that two layers of these opacities cover, alone and together.
    fn covered(pixel: [u32; 2], opacities: [f64; 2]) -> [f64; 3] {
        let mut counts = [0.0; 3];
        for sample in 0..64 {
            let at = PixelSample { pixel, sample };
            let there = [0, 1].map(|layer| opacities[layer as usize] > coverage_threshold(at, layer));
            let seen = [there[0], there[1], there[0] && there[1]];
            (0..3).for_each(|i| counts[i] += f64::from(u8::from(seen[i])) / 64.0);
        }
        counts
    }

    #[test]
    fn every_pixel_is_covered_as_the_opacity_says_and_layers_are_independent() {
        for opacity in [0.0, 0.125, 0.5, 0.8, 1.0] {
            let (mut both, mut worst) = (0.0, 0.0_f64);
            for x in 0..16 {
                for y in 0..16 {
                    let [first, second, together] = covered([x, y], [opacity, 0.5]);
                    // Evenly spread: a multiple of a 64th is off by one sample at most.
                    worst = worst.max((first - opacity).abs()).max((second - 0.5).abs());
                    both += together / 256.0;
                }
            }
            assert!(worst <= 1.0 / 64.0, "{opacity}: {worst}");
            assert!((both - 0.5 * opacity).abs() < 0.01, "{opacity}: {both}");
        }
    }

    #[test]
    fn layers_are_independent_within_each_pixel() {
        // Two layers of one half leave a quarter; if they were alike or opposite, they would leave a half or nothing.
        let errors = (0..256).map(|i| (covered([i % 16, i / 16], [0.5; 2])[2] - 0.25).powi(2));
        let deviation = (errors.sum::<f64>() / 256.0).sqrt();
        assert!(deviation < 0.08, "{deviation}");
    }
}
