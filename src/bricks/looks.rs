//! The looks of a surface, beside its distances.
//!
//! Texels of four words hold, one after the other:
//!
//! | texels | hold |
//! |---|---|
//! | 8 per brick with samples, in their order | words 0–15: which of its samples have a look, x fastest; 16–23: for each of these words the number of looks before it in the brick, 16 bits each; 24: the number of the brick's first look |
//! | one per two looks | two words for each look |
//!
//! | bits of a look | hold |
//! |---|---|
//! | first word 0–23 | red, green and blue as sRGB, 8 bits each |
//! | 24–31 | emission in the same color: 0 for none, or its factor is 2^((n − 128) / 8) |
//! | second word 0–6, 7–13, 14–20 | by how much the normal is bent along each axis: the square of (n − 64) / 63, with its sign |
//! | 22–27 | roughness in 1/63 |
//! | 28–31 | metalness in 1/15 |
//!
//! All corners of a voxel that the surface passes have a look, so that looks are interpolated as distances are. Normals
//! themselves are those of the field: bends are what a texture of normals adds, so that they hold in blends too.

use glam::DVec3;

use super::decode::BrickKind;
use super::{BRICK_SAMPLES, BRICK_VOLUME, BRICK_VOXELS, Bricks};

/// Texels of a brick before the looks.
pub const LOOK_HEADER: usize = 8;

/// The looks; see the module.
#[derive(Clone, PartialEq)]
pub struct Looks {
    /// The first texel of the looks themselves.
    pub first_look: u32,
    /// The texels.
    pub texels: Vec<[u32; 4]>,
}

/// The look of a surface at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoxelLook {
    /// Linear color.
    pub color: DVec3,
    /// 0 for a dielectric, 1 for a metal.
    pub metalness: f64,
    /// Roughness as perceived.
    pub roughness: f64,
    /// Emitted light as a factor of the color.
    pub emission: f64,
    /// What is added to the unit normal of the surface.
    pub bend: DVec3,
}

/// Looks with their weights, summed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LookSum {
    /// Linear color.
    pub color: DVec3,
    /// Emitted light.
    pub emission: DVec3,
    /// Metalness.
    pub metalness: f64,
    /// Roughness.
    pub roughness: f64,
    /// Bends of the normal.
    pub bend: DVec3,
    /// The sum of the weights: 1 where everything around has a look, 0 where nothing has.
    pub share: f64,
}

impl std::fmt::Debug for Looks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Looks").field("texels", &self.texels.len()).finish_non_exhaustive()
    }
}

/// Whether each sample of a brick is the corner of a voxel that the surface passes.
pub fn surface_samples(samples: &[u8; BRICK_VOLUME]) -> [bool; BRICK_VOLUME] {
    let mut out = [false; BRICK_VOLUME];
    let last = BRICK_VOXELS as usize;
    let corner = |first: usize, i: usize| {
        first + (i & 1) + BRICK_SAMPLES * (i >> 1 & 1) + BRICK_SAMPLES * BRICK_SAMPLES * (i >> 2)
    };
    for z in 0..last {
        for y in 0..last {
            for x in 0..last {
                let first = x + BRICK_SAMPLES * (y + BRICK_SAMPLES * z);
                let is = |side: fn(u8) -> bool| (0..8).any(|i| side(samples[corner(first, i)]));
                if is(|byte| byte <= 128) && is(|byte| byte >= 128) {
                    (0..8).for_each(|i| out[corner(first, i)] = true);
                }
            }
        }
    }
    out
}

impl Looks {
    /// Packs the looks of all bricks, in their order: which samples have some, and these.
    pub fn new(bricks: impl ExactSizeIterator<Item = ([bool; BRICK_VOLUME], Vec<VoxelLook>)>) -> Self {
        let mut texels = Vec::new();
        let mut words: Vec<[u32; 2]> = Vec::new();
        let first_look = (LOOK_HEADER * bricks.len()) as u32;
        for (marks, looks) in bricks {
            let mut header = [0_u32; 4 * LOOK_HEADER];
            header[24] = words.len() as u32;
            let mut before = 0;
            for (i, run) in marks.chunks(32).enumerate() {
                header[i] = run.iter().enumerate().fold(0, |bits, (bit, is)| bits | u32::from(*is) << bit);
                header[16 + i / 2] |= before << (16 * (i % 2));
                before += header[i].count_ones();
            }
            debug_assert_eq!(before as usize, looks.len());
            texels.extend_from_slice(header.as_chunks::<4>().0);
            words.extend(looks.iter().map(VoxelLook::packed));
        }
        let pairs = words.chunks(2).map(|pair| {
            let second = pair.get(1).copied().unwrap_or_default();
            [pair[0][0], pair[0][1], second[0], second[1]]
        });
        texels.extend(pairs);
        Self { first_look, texels }
    }

    /// Bytes of the texels.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.texels)
    }

    /// The look of a sample.
    pub fn of(&self, brick: usize, sample: usize) -> Option<VoxelLook> {
        let header = self.texels.get(LOOK_HEADER * brick..LOOK_HEADER * (brick + 1))?;
        let word = |i: usize| header[i / 4][i % 4];
        let (own, bit) = (word(sample / 32), sample % 32);
        if own >> bit & 1 == 0 {
            return None;
        }
        let before =
            (word(16 + sample / 64) >> (16 * (sample / 32 % 2)) & 0xffff) + (own & ((1 << bit) - 1)).count_ones();
        let index = word(24) as usize + before as usize;
        let texel = self.texels.get(self.first_look as usize + index / 2)?;
        Some(VoxelLook::unpacked([texel[2 * (index % 2)], texel[2 * (index % 2) + 1]]))
    }

    /// Checks that all looks of this many bricks are there.
    pub(super) fn check(&self, bricks: usize) -> Result<(), &'static str> {
        if self.first_look as usize != LOOK_HEADER * bricks || self.texels.len() < LOOK_HEADER * bricks {
            return Err("its looks start elsewhere");
        }
        let there = 2 * (self.texels.len() - LOOK_HEADER * bricks) as u64;
        for brick in self.texels[..LOOK_HEADER * bricks].chunks(LOOK_HEADER) {
            let mut before = 0;
            for i in 0..16 {
                if brick[4 + i / 8][i / 2 % 4] >> (16 * (i % 2)) & 0xffff != before {
                    return Err("its looks are counted wrongly");
                }
                before += brick[i / 4][i % 4].count_ones();
            }
            if u64::from(brick[6][0]) + u64::from(before) > there {
                return Err("a look is nowhere");
            }
        }
        Ok(())
    }
}

impl Bricks {
    /// The looks of the samples around a point. On the surface all have one.
    pub fn looks_at(&self, p: DVec3) -> LookSum {
        let mut sum = LookSum::default();
        let around = self.looks.as_ref().zip(self.voxel_around(p));
        let Some((looks, (BrickKind::Samples(brick), voxel, part))) = around else { return sum };
        for i in 0..8 {
            let corner = [0, 1, 2].map(|axis| voxel[axis] + (i >> axis & 1));
            let share = |axis: usize| if i >> axis & 1 == 1 { part[axis] } else { 1.0 - part[axis] };
            let weight = share(0) * share(1) * share(2);
            let sample = corner[0] + BRICK_SAMPLES * (corner[1] + BRICK_SAMPLES * corner[2]);
            if let Some(look) = looks.of(brick, sample) {
                sum.add(&look.into(), weight);
            }
        }
        sum
    }
}

impl LookSum {
    /// Adds looks with a weight.
    pub fn add(&mut self, other: &Self, weight: f64) {
        self.color += other.color * weight;
        self.emission += other.emission * weight;
        self.metalness += other.metalness * weight;
        self.roughness += other.roughness * weight;
        self.bend += other.bend * weight;
        self.share += other.share * weight;
    }
}

impl From<VoxelLook> for LookSum {
    fn from(look: VoxelLook) -> Self {
        let VoxelLook { color, metalness, roughness, emission, bend } = look;
        Self { color, emission: color * emission, metalness, roughness, bend, share: 1.0 }
    }
}

impl VoxelLook {
    /// The two words of the look.
    pub fn packed(&self) -> [u32; 2] {
        let whole = |v: f64, most: u32| (v.clamp(0.0, 1.0) * f64::from(most)).round() as u32;
        let [r, g, b] = self.color.to_array().map(|v| whole(srgb_from_linear(v.clamp(0.0, 1.0)), 255));
        let emission =
            if self.emission > 0.0 { (self.emission.log2() * 8.0 + 128.0).round().clamp(1.0, 255.0) as u32 } else { 0 };
        let steps = |v: f64| (64.0 + (v.abs().min(1.0).sqrt() * 63.0).round().copysign(v)) as u32;
        let [x, y, z] = self.bend.to_array().map(steps);
        [
            r | g << 8 | b << 16 | emission << 24,
            x | y << 7 | z << 14 | whole(self.roughness, 63) << 22 | whole(self.metalness, 15) << 28,
        ]
    }

    /// The look that two words hold.
    pub fn unpacked([first, second]: [u32; 2]) -> Self {
        let share = |word: u32, shift: u32, most: u32| f64::from(word >> shift & most) / f64::from(most);
        let bend = |shift: u32| {
            let root = (f64::from(second >> shift & 127) - 64.0) / 63.0;
            root * root.abs()
        };
        let emission = first >> 24;
        Self {
            color: DVec3::from([0, 8, 16].map(|shift| linear_from_srgb(share(first, shift, 255)))),
            metalness: share(second, 28, 15),
            roughness: share(second, 22, 63),
            emission: if emission == 0 { 0.0 } else { ((f64::from(emission) - 128.0) / 8.0).exp2() },
            bend: DVec3::new(bend(0), bend(7), bend(14)),
        }
    }
}

/// The transfer function of sRGB (IEC 61966-2-1).
fn srgb_from_linear(v: f64) -> f64 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// Its inverse.
pub fn linear_from_srgb(v: f64) -> f64 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_survive_their_two_words() {
        for i in 0..2_000 {
            let share = |k: u32| f64::from((i * 7_919 + k * 104_729) % 1_009) / 1_008.0;
            let bend = DVec3::new(share(1), share(2), share(3)) * 2.0 - 1.0;
            let look = VoxelLook {
                color: DVec3::new(share(4), share(5), share(6)),
                metalness: share(7),
                roughness: share(8),
                emission: if i % 3 == 0 { 0.0 } else { 20.0 * share(9) + 0.01 },
                bend: if i % 5 == 0 { DVec3::ZERO } else { bend },
            };
            let again = VoxelLook::unpacked(look.packed());
            for (found, meant) in again.bend.to_array().into_iter().zip(look.bend.to_array()) {
                assert!((found - meant).abs() <= meant.abs().sqrt() / 63.0 + 1e-4, "{look:?} became {again:?}");
            }
            assert!((again.color - look.color).abs().max_element() < 0.005, "{look:?} became {again:?}");
            assert!(
                (again.metalness - look.metalness).abs() < 0.034 && (again.roughness - look.roughness).abs() < 0.008
            );
            assert!((again.emission - look.emission).abs() <= 0.045 * look.emission, "{look:?} became {again:?}");
        }
    }

    #[test]
    fn the_looks_of_a_brick_stand_where_its_marks_are() {
        let mut samples = [255; BRICK_VOLUME];
        samples[100] = 100;
        let marks = surface_samples(&samples);
        assert_eq!(marks.iter().filter(|is| **is).count(), 27, "all neighbors of the one inside");
        let (color, bend) = (DVec3::ONE, DVec3::ZERO);
        let look =
            |i: usize| VoxelLook { color, bend, metalness: 0.0, roughness: (i % 64) as f64 / 63.0, emission: 0.0 };
        let of = |shift: usize| (marks, (0..BRICK_VOLUME).filter(|i| marks[*i]).map(|i| look(i + shift)).collect());
        let looks = Looks::new(vec![of(0), ([false; BRICK_VOLUME], Vec::new()), of(5)].into_iter());
        for i in 0..BRICK_VOLUME {
            let roughness = |brick| looks.of(brick, i).map(|look| (look.roughness * 63.0).round() as usize);
            let expected = |shift: usize| marks[i].then_some((i + shift) % 64);
            assert_eq!([roughness(0), roughness(1), roughness(2)], [expected(0), None, expected(5)], "{i}");
        }
        assert_eq!((looks.check(3), looks.check(2).is_err()), (Ok(()), true));
        let mut broken = looks.clone();
        broken.texels[6][0] = 1_000;
        assert!(broken.check(3).is_err());
    }
}
