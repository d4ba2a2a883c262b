//! How wrong a picture is, measured against the truth on the same rays.

use super::Buffers;
use super::truth::Truth;

/// Most pixels that may differ in hit or miss, as a share of all.
pub const MAX_HIT_MISS_SHARE: f64 = 1e-4;
/// Largest error of the depth at the 99th percentile, in pixel footprints.
pub const MAX_DEPTH_P99: f64 = 0.05;
/// Largest median error of the normal, in degrees.
pub const MAX_NORMAL_P50: f64 = 0.1;

/// Rays that pass a surface's edge at a smaller angle, in radians, are grazing: the eye, the direction, their
/// product and their sum are each rounded to 24 bits.
pub const GRAZING_ANGLE: f64 = 4.0 * f32::EPSILON as f64;

/// The errors of a picture. Depth and normal are compared where both pictures hit something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// Pixels in the picture.
    pub pixels: usize,
    /// Pixels where one picture hits something and the other does not, or where the measured depth is
    /// no number; those in `grazing` are not among them.
    pub hit_miss_differs: usize,
    /// Pixels that differ like that, but whose ray passes the surface's edge so closely that 32-bit
    /// numbers cannot tell the sides apart.
    pub grazing: usize,
    /// Median error of the depth, in footprints of the pixel at the true depth.
    pub depth_p50: f64,
    /// The same, 99th percentile.
    pub depth_p99: f64,
    /// The same, maximum.
    pub depth_max: f64,
    /// Median angle between the normals, in degrees.
    pub normal_p50: f64,
    /// The same, 99th percentile.
    pub normal_p99: f64,
}

impl Accuracy {
    /// The errors against the truth. `footprint` is the width of a pixel at distance 1, see
    /// [`crate::geometry::Camera::footprint`].
    pub fn against(measured: &Buffers, truth: &Truth, footprint: f64) -> Self {
        let grazing = GRAZING_ANGLE / footprint;
        Self::of(measured, &truth.buffers, footprint, |i| f64::from(truth.margin[i]) <= grazing)
    }

    /// Compares pixel by pixel. `is_grazing` is asked about pixels that differ in hit or miss. Pictures of
    /// different sizes differ in every pixel.
    pub fn of(measured: &Buffers, truth: &Buffers, footprint: f64, mut is_grazing: impl FnMut(usize) -> bool) -> Self {
        let pixels = truth.depth.len();
        if (measured.width, measured.height) != (truth.width, truth.height) {
            return Self { pixels, hit_miss_differs: pixels, ..Self::default() };
        }
        let mut found = Self { pixels, ..Self::default() };
        let (mut depths, mut normals) = (Vec::new(), Vec::new());
        for (i, (m, t)) in measured.depth.iter().zip(&truth.depth).enumerate() {
            let (m, t) = (f64::from(*m), f64::from(*t));
            if m.is_nan() {
                found.hit_miss_differs += 1;
            } else if m.is_finite() != t.is_finite() {
                if is_grazing(i) {
                    found.grazing += 1;
                } else {
                    found.hit_miss_differs += 1;
                }
            } else if t.is_finite() {
                depths.push((m - t).abs() / (footprint * t));
                normals.push(angle(measured.normal[i], truth.normal[i]).to_degrees());
            }
        }
        depths.sort_by(f64::total_cmp);
        normals.sort_by(f64::total_cmp);
        [found.depth_p50, found.depth_p99, found.depth_max] = [0.5, 0.99, 1.0].map(|q| quantile(&depths, q));
        [found.normal_p50, found.normal_p99] = [0.5, 0.99].map(|q| quantile(&normals, q));
        found
    }

    /// Share of the pixels that differ in hit or miss.
    pub fn hit_miss_share(&self) -> f64 {
        self.hit_miss_differs as f64 / self.pixels.max(1) as f64
    }

    /// What is beyond the limits above, in words; nothing where all is well.
    pub fn faults(&self) -> Vec<String> {
        let checks = [
            ("share of pixels that differ in hit or miss", self.hit_miss_share(), MAX_HIT_MISS_SHARE),
            ("depth error, 99th percentile, in footprints", self.depth_p99, MAX_DEPTH_P99),
            ("normal error, median, in degrees", self.normal_p50, MAX_NORMAL_P50),
        ];
        // An error that is no number is a fault too.
        let beyond = checks.into_iter().filter(|(_, value, limit)| value.is_nan() || value > limit);
        beyond.map(|(what, value, limit)| format!("{what}: {value}, allowed {limit}")).collect()
    }
}

/// The angle between two directions in radians, accurate for small ones, where the arc cosine is not.
/// π where one of them is no direction.
fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|v| glam::Vec3::from(v).as_dvec3());
    let (sine, cosine) = (a.cross(b).length(), a.dot(b));
    if sine + cosine.abs() > 0.0 { sine.atan2(cosine) } else { std::f64::consts::PI }
}

/// The value that a share `q` of the sorted values does not exceed; 0 for none.
fn quantile(sorted: &[f64], q: f64) -> f64 {
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flat::NO_LEAF;

    const FOOTPRINT: f64 = 0.01;

    /// A 10 by 20 picture: its upper half shows a wall that faces the eye at distance 4.
    fn wall() -> Buffers {
        let hit = |i: usize| i < 100;
        Buffers {
            width: 10,
            height: 20,
            depth: (0..200).map(|i| if hit(i) { 4.0 } else { f32::INFINITY }).collect(),
            leaf: (0..200).map(|i| if hit(i) { 0 } else { NO_LEAF }).collect(),
            normal: vec![[0.0, 0.0, 1.0]; 200],
            color: vec![[0; 4]; 200],
        }
    }

    fn compare(change: impl Fn(&mut Buffers)) -> Accuracy {
        let mut measured = wall();
        change(&mut measured);
        Accuracy::of(&measured, &wall(), FOOTPRINT, |_| false)
    }

    #[test]
    fn the_truth_itself_has_no_error() {
        let same = compare(|_| {});
        assert_eq!(same, Accuracy { pixels: 200, ..Accuracy::default() });
        assert!(same.faults().is_empty());
    }

    #[test]
    fn one_pixel_of_hit_or_miss_is_seen_and_refused() {
        for i in [0, 150] {
            let flipped = compare(|b| b.depth[i] = if b.depth[i].is_finite() { f32::INFINITY } else { 4.0 });
            assert_eq!(flipped.hit_miss_differs, 1);
            assert_eq!(flipped.faults().len(), 1);
        }
    }

    #[test]
    fn grazing_pixels_are_counted_apart() {
        let mut measured = wall();
        measured.depth[7] = f32::INFINITY;
        measured.depth[8] = f32::INFINITY;
        let found = Accuracy::of(&measured, &wall(), FOOTPRINT, |i| i == 7);
        assert_eq!((found.hit_miss_differs, found.grazing), (1, 1));
    }

    #[test]
    fn depth_is_measured_in_footprints() {
        let shifted = compare(|b| b.depth.iter_mut().for_each(|d| *d += 0.1 * 4.0 * 0.01));
        assert!((shifted.depth_p50 - 0.1).abs() < 1e-4 && (shifted.depth_max - 0.1).abs() < 1e-4, "{shifted:?}");
        assert_eq!(shifted.faults().len(), 1);
        let one = compare(|b| b.depth[3] = 5.0);
        assert_eq!((one.depth_p50, one.depth_p99), (0.0, 0.0));
        assert!((one.depth_max - 25.0).abs() < 1e-9);
    }

    #[test]
    fn normals_are_measured_in_degrees() {
        let tilt = |degrees: f32| {
            let (s, c) = degrees.to_radians().sin_cos();
            compare(move |b| b.normal.iter_mut().for_each(|n| *n = [s, 0.0, c]))
        };
        let slightly = tilt(0.02);
        assert!((slightly.normal_p50 - 0.02).abs() < 1e-5 && slightly.faults().is_empty(), "{slightly:?}");
        assert_eq!(tilt(0.2).faults().len(), 1);
        assert!(!compare(|b| b.normal.iter_mut().for_each(|n| *n = [0.0; 3])).faults().is_empty());
    }

    #[test]
    fn what_is_no_number_is_never_let_through() {
        assert_eq!(compare(|b| b.depth[0] = f32::NAN).hit_miss_differs, 1);
        assert_eq!(compare(|b| b.depth[199] = f32::NAN).hit_miss_differs, 1);
        assert!(!compare(|b| b.normal.iter_mut().for_each(|n| *n = [f32::NAN; 3])).faults().is_empty());
        let small = Buffers { width: 20, height: 10, ..wall() };
        assert_eq!(Accuracy::of(&small, &wall(), FOOTPRINT, |_| true).hit_miss_differs, 200);
    }
}
