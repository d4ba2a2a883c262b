//! Response curves of masks, sampled. Counterpart of `copy_mask_response` in `shaders/copy/masks.wgsl`.

use std::sync::Arc;

use isolith_scene::ResponseCurve;

/// Intervals of a sampled curve. Halves, thirds, quarters and tenths lie between two of them.
const CURVE_INTERVALS: usize = 60;

/// A curve, ready for evaluation: straight between its samples. The numbers are those that the GPU reads.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatCurve {
    /// Its heights at equal distances, and some zeros.
    pub samples: [f32; 64],
    /// Its greatest slope.
    pub slope: f64,
    /// It is 0 up to the first of these shares, and from the second one on.
    pub empty: [f64; 2],
}

impl FlatCurve {
    /// Samples a curve; `None` for one that changes nothing.
    pub fn new(curve: &ResponseCurve) -> Option<Arc<Self>> {
        if curve.is_identity() {
            return None;
        }
        let mut samples = [0.0; 64];
        let used = &mut samples[..=CURVE_INTERVALS];
        for (at, sample) in used.iter_mut().enumerate() {
            *sample = curve.value(at as f64 / CURVE_INTERVALS as f64) as f32;
        }
        let steepest = used.windows(2).map(|pair| f64::from((pair[1] - pair[0]).abs())).fold(0.0, f64::max);
        let share = |samples: usize| samples as f64 / CURVE_INTERVALS as f64;
        // No share is below 0 or above 1, so that -1 and 2 mean never.
        let below = used.iter().position(|sample| *sample > 0.0).unwrap_or(used.len());
        let above = used.iter().rposition(|sample| *sample > 0.0).map_or(0, |last| last + 1);
        let empty = [
            if below == 0 { -1.0 } else { share(below - 1) },
            if above > CURVE_INTERVALS { 2.0 } else { share(above) },
        ];
        Some(Arc::new(Self { samples, slope: steepest * CURVE_INTERVALS as f64, empty }))
    }

    /// Its height at a share from 0 to 1.
    pub fn value(&self, share: f64) -> f64 {
        let at = share * CURVE_INTERVALS as f64;
        let left = (at as usize).min(CURVE_INTERVALS - 1);
        let [low, high] = [self.samples[left], self.samples[left + 1]].map(f64::from);
        low + (high - low) * (at - left as f64)
    }

    /// The least and the most between two shares.
    pub fn range(&self, [least, most]: [f64; 2]) -> [f64; 2] {
        if most <= self.empty[0] || least >= self.empty[1] {
            return [0.0; 2];
        }
        let (middle, off) = (self.value(0.5 * (least + most)), self.slope * 0.5 * (most - least));
        [middle - off, middle + off].map(|share| share.clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::CurvePreset;

    #[test]
    fn sampled_curves_are_those_of_the_artist() {
        for preset in CurvePreset::ALL.into_iter().filter(|preset| *preset != CurvePreset::Linear) {
            let curve = preset.curve();
            let flat = FlatCurve::new(&curve).expect("it changes something");
            for i in 0..=1_000 {
                let share = f64::from(i) / 1_000.0;
                assert!((flat.value(share) - curve.value(share)).abs() < 0.03, "{preset:?} at {share}");
            }
            assert!(flat.value(flat.empty[0].max(0.0)) <= 0.0 || flat.empty[0] < 0.0, "{preset:?}");
        }
        assert!(FlatCurve::new(&CurvePreset::Linear.curve()).is_none());
    }
}
