//! Masks of existence: the share of the copies that stand at a place. Counterpart of `shaders/copy/masks.wgsl`.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::hash::copy_hash;
use super::instancer::{FlatInstancer, FlatMask, FlatMaskImage};
use super::mask_curve::FlatCurve;
use super::noise::{Coordinate, copy_noise_2};
use isolith_scene::{Mask, MaskJoin, MaskKind, MaskSlot, ShareImage};

impl FlatMask {
    /// A mask, ready for evaluation. Its image and its curve, if it has any, begin at these rows.
    pub fn new(slot: &MaskSlot, [first_row, curve_row]: [u32; 2]) -> Self {
        let (key, params) = match &slot.mask {
            Mask::Noise { size, threshold, softness, seed } => {
                (copy_hash(*seed, [0; 3], 0x2000)[0], [*threshold, softness.max(1e-6), 1.0 / size, 0.0])
            }
            Mask::Height { from, to, softness } => (0, [*from, *to, softness.max(1e-6), 0.0]),
            Mask::Slope { from, to } => {
                let [from, to] = [from, to].map(|angle| angle.to_radians().cos());
                (0, [from.max(to + 1e-6), to, 0.0, 0.0])
            }
            Mask::Radius { inner, outer } => (0, [*inner, outer.max(inner + 1e-6), 0.0, 0.0]),
            Mask::Image { .. } => (0, [0.0; 4]),
        };
        let mut mask = Self {
            kind: slot.mask.kind(),
            inverted: slot.inverted,
            join: slot.join,
            key,
            params,
            curve: FlatCurve::new(&slot.curve),
            curve_row,
            image: None,
        };
        if let Mask::Image { image, width, length, offset, tiled } = &slot.mask
            && let Some(image) = image.content()
        {
            mask.set_image(image.shares(), DVec2::new(*width, *length), DVec2::new(offset[0], offset[2]));
            mask.image = mask.image.map(|image| FlatMaskImage { first_row, tiled: *tiled, ..image });
        }
        mask
    }

    /// Lays an image over a rectangle of this size and middle.
    fn set_image(&mut self, shares: Arc<ShareImage>, size: DVec2, middle: DVec2) {
        let pixels = DVec2::from_array(shares.size.map(f64::from));
        let per_meter = pixels / size;
        let origin = (0.5 * size - middle) * per_meter;
        self.params = [per_meter.x, per_meter.y, pixels.x, pixels.y];
        self.image = Some(FlatMaskImage { shares, first_row: 0, origin, tiled: false });
    }

    /// Its share at a place, from 0 to 1, without inversion and curve. `up`: cosine of the slope of the ground.
    fn share(&self, at: DVec3, up: f64) -> f64 {
        let [a, b, c, _] = self.params;
        match self.kind {
            MaskKind::Noise => {
                let noise = copy_noise_2(self.key, [at.x, at.z].map(|v| Coordinate::new(v * c)));
                ((noise - a) / b + 0.5).clamp(0.0, 1.0)
            }
            MaskKind::Height => ((at.y - a) / c).clamp(0.0, 1.0) * ((b - at.y) / c).clamp(0.0, 1.0),
            // Cosines fall with the angle.
            MaskKind::Slope => ((up - b) / (a - b)).clamp(0.0, 1.0),
            MaskKind::Radius => ((b - at.x.hypot(at.z)) / (b - a)).clamp(0.0, 1.0),
            // Full without an image, of which a warning tells.
            MaskKind::Image => self.image.as_ref().map_or(1.0, |image| image.share(DVec2::new(a, b), at)),
        }
    }

    /// The least and the most that [`Self::share`] may be in a box of places.
    fn share_range(&self, center: DVec3, half: DVec3) -> [f64; 2] {
        let [a, b, c, _] = self.params;
        let range = match self.kind {
            MaskKind::Noise => {
                let off = NOISE_SLOPE * c * (half.x + half.z);
                let noise = copy_noise_2(self.key, [center.x, center.z].map(|v| Coordinate::new(v * c)));
                [noise - off, noise + off].map(|noise| (noise - a) / b + 0.5)
            }
            MaskKind::Height => {
                let [low, high] = [center.y - half.y, center.y + half.y];
                let share = |y: f64| (y / c).clamp(0.0, 1.0);
                [share(low - a) * share(b - high), share(high - a) * share(b - low)]
            }
            MaskKind::Radius => {
                let [away, half] = [DVec2::new(center.x, center.z).abs(), DVec2::new(half.x, half.z)];
                let [far, near] = [(away + half).length(), (away - half).max(DVec2::ZERO).length()];
                [far, near].map(|distance| (b - distance) / (b - a))
            }
            MaskKind::Image => match &self.image {
                Some(image) if image.is_beside(DVec2::new(a, b), center, half) => [0.0; 2],
                _ => [0.0, 1.0],
            },
            // It depends on the ground, of which a lattice has none.
            MaskKind::Slope => [0.0, 1.0],
        };
        range.map(|share: f64| share.clamp(0.0, 1.0))
    }
}

/// Upper bound of the slope of noise along an axis, per lattice point: that of t³ (6 t² − 15 t + 10).
const NOISE_SLOPE: f64 = 1.875;

impl FlatMaskImage {
    /// Brightness at a place, between four pixels; 0 beside the image.
    fn share(&self, per_meter: DVec2, at: DVec3) -> f64 {
        let size = DVec2::from_array(self.shares.size.map(f64::from));
        let mut place = self.origin + DVec2::new(at.x, at.z) * per_meter;
        if self.tiled {
            place -= size * (place / size).floor();
        } else if place.cmplt(DVec2::ZERO).any() || place.cmpgt(size).any() {
            return 0.0;
        }
        // Pixels have their values in their middles.
        let corner = (place - 0.5).floor();
        let part = place - 0.5 - corner;
        let pixel = |x: f64, y: f64| {
            let [x, y] = [(corner.x + x, size.x), (corner.y + y, size.y)].map(|(at, count)| {
                if self.tiled { at - count * (at / count).floor() } else { at.clamp(0.0, count - 1.0) }
            });
            self.shares.at(x as u32, y as u32)
        };
        let row = |y: f64| pixel(0.0, y) * (1.0 - part.x) + pixel(1.0, y) * part.x;
        row(0.0) * (1.0 - part.y) + row(1.0) * part.y
    }

    /// Whether no place of a box is on it.
    fn is_beside(&self, per_meter: DVec2, center: DVec3, half: DVec3) -> bool {
        let size = DVec2::from_array(self.shares.size.map(f64::from));
        let place = self.origin + DVec2::new(center.x, center.z) * per_meter;
        let half = DVec2::new(half.x, half.z) * per_meter;
        !self.tiled && ((place + half).cmplt(DVec2::ZERO).any() || (place - half).cmpgt(size).any())
    }
}

/// The share of a mask at a place, from 0 to 1.
pub fn copy_mask(mask: &FlatMask, at: DVec3, up: f64) -> f64 {
    let share = mask.share(at, up);
    let share = if mask.inverted { 1.0 - share } else { share };
    mask.curve.as_ref().map_or(share, |curve| curve.value(share))
}

/// The share of all masks together.
pub fn copy_masks(masks: &[FlatMask], at: DVec3, up: f64) -> f64 {
    let mut shares = masks.iter().map(|mask| (mask.join, copy_mask(mask, at, up)));
    let Some((_, first)) = shares.next() else { return 1.0 };
    shares.fold(first, |share, (join, next)| join.joined(share, next))
}

/// The most that all masks together may be in a box of places.
pub(super) fn copy_masks_most(instancer: &FlatInstancer, center: DVec3, half: DVec3) -> f64 {
    let mut all = [1.0, 1.0];
    for (at, mask) in instancer.masks.iter().enumerate() {
        let range = mask.share_range(center, half);
        let range = if mask.inverted { [1.0 - range[1], 1.0 - range[0]] } else { range };
        let range = mask.curve.as_ref().map_or(range, |curve| curve.range(range));
        // What is taken away is least where most is left.
        let other = if mask.join == MaskJoin::Subtract { [range[1], range[0]] } else { range };
        all = if at == 0 { range } else { [0, 1].map(|end| mask.join.joined(all[end], other[end])) };
    }
    all[1]
}

/// What of a lattice may be full: whether the mask at `at` and those behind it leave nothing where it is empty.
pub(super) fn mask_cuts(masks: &[MaskSlot], at: usize) -> bool {
    let keeps_empty = !masks[at].inverted && masks[at].curve.value(0.0) <= 0.0;
    keeps_empty && (at == 0 || masks[at].join.only_cuts()) && masks[at + 1..].iter().all(|later| later.join.only_cuts())
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Attachment, TextureImage};

    fn image(tiled: bool) -> MaskSlot {
        let image = Attachment::<TextureImage>::painted("x.png", [4, 2], |x, y| [(64 * x + 30 * y) as u8; 3]);
        Mask::Image { image, width: 8.0, length: 4.0, offset: [1.0, 7.0, -2.0], tiled }.into()
    }

    #[test]
    fn an_image_lies_where_it_is_put_and_ends_or_repeats() {
        let at = |mask: &FlatMask, x: f64, z: f64| copy_mask(mask, DVec3::new(x, 50.0, z), 1.0);
        let plain = FlatMask::new(&image(false), [0; 2]);
        // The middles of pixels: the first one is at the corner of least X and Z.
        for (x, y) in (0..4).flat_map(|x| (0..2).map(move |y| (x, y))) {
            let place = [-3.0 + 2.0 * f64::from(x) + 1.0, -4.0 + 2.0 * f64::from(y) + 1.0];
            let wanted = f64::from(64 * x + 30 * y) / 255.0;
            assert!((at(&plain, place[0], place[1]) - wanted).abs() < 2e-3, "{x}, {y}");
        }
        assert_eq!((at(&plain, -3.1, -2.0), at(&plain, 1.0, 0.1)), (0.0, 0.0));
        let tiled = FlatMask::new(&image(true), [0; 2]);
        for [x, z] in [[-2.0, -3.0], [0.3, -1.7], [4.9, -0.2]] {
            let [here, there] = [[x, z], [x + 8e6, z - 4e6]].map(|[x, z]| at(&tiled, x, z));
            assert!((here - there).abs() < 1e-6, "{here}, {there}");
        }
        let none = MaskSlot::from(MaskKind::Image.default_mask());
        assert_eq!(at(&FlatMask::new(&none, [0; 2]), 0.0, 0.0), 1.0, "a missing image hides nothing");
    }
}
