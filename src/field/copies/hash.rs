//! Random numbers of copies: a hash of seed, cell and channel, with the same bits on the GPU. Counterpart of
//! `shaders/copy/hash.wgsl`.

/// What a random number is for. Each has numbers of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Channel {
    /// Whether the copy exists, its type, its material of the palette.
    Choice,
    /// Where it stands in its cell.
    Place,
    /// Its displacement.
    Offset,
    /// Its rotation.
    Rotation,
    /// Its scale.
    Scale,
    /// Hue, saturation and value of its color.
    Color,
    /// Roughness and emission.
    Surface,
    /// Dynamics: this plus the index of the motion.
    Dynamics,
}

/// Three random words (pcg3d: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020).
pub fn copy_hash(seed: u32, cell: [i32; 3], channel: u32) -> [u32; 3] {
    let mut v = cell.map(|i| i as u32);
    v[0] = v[0].wrapping_add(seed.wrapping_mul(0x9e37_79b9));
    v[1] = v[1].wrapping_add(channel.wrapping_mul(0x85eb_ca6b));
    v[2] ^= seed.wrapping_add(channel << 16);
    v = v.map(|x| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[2]));
        v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
        v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
        if round == 0 {
            v = v.map(|x| x ^ (x >> 16));
        }
    }
    v
}

/// A number from 0 to below 1 with 24 bits, which f32 holds exactly.
pub fn copy_random(word: u32) -> f64 {
    f64::from(word >> 8) / f64::from(1 << 24)
}

/// Three such numbers.
pub fn copy_randoms(seed: u32, cell: [i32; 3], channel: u32) -> [f64; 3] {
    copy_hash(seed, cell, channel).map(copy_random)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_spread_evenly_and_independently() {
        let (mut sums, mut products, count) = ([0.0; 3], [0.0; 3], 40_000);
        for i in 0..count {
            let cell = [i % 200 - 100, 0, i / 200];
            let [x, y, z] = copy_randoms(7, cell, 3).map(|v| v - 0.5);
            let [next, ..] = copy_randoms(7, [cell[0] + 1, 0, cell[2]], 3).map(|v| v - 0.5);
            for (sum, v) in sums.iter_mut().zip([x, y, z]) {
                *sum += v;
            }
            for (sum, v) in products.iter_mut().zip([x * y, y * z, x * next]) {
                *sum += v;
            }
        }
        // Standard deviations: 0.289 / 200 and 0.083 / 200.
        assert!(sums.iter().all(|s| (s / f64::from(count)).abs() < 0.006), "{sums:?}");
        assert!(products.iter().all(|s| (s / f64::from(count)).abs() < 0.0018), "{products:?}");
    }

    #[test]
    fn seeds_and_channels_give_other_numbers() {
        let numbers: std::collections::HashSet<[u32; 3]> =
            (0..4).flat_map(|seed| (0..8).map(move |channel| copy_hash(seed, [3, -2, 9], channel))).collect();
        assert_eq!(numbers.len(), 32);
    }
}
