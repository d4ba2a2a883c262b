//! Curves from 0–1 to 0–1 through points that an artist sets: how a mask responds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fewest points of a curve.
pub const MIN_CURVE_POINTS: usize = 2;
/// Most points of a curve.
pub const MAX_CURVE_POINTS: usize = 8;
/// Least distance of two points along X.
pub const MIN_CURVE_GAP: f64 = 1e-3;

/// A curve through points. Before the first and after the last one it is level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseCurve {
    /// The points, from left to right, each from 0 to 1 along both axes: 2 to 8 of them.
    pub points: Vec<[f64; 2]>,
    /// Whether it is smooth; else it is straight from point to point.
    #[serde(default)]
    pub smooth: bool,
}

impl Default for ResponseCurve {
    fn default() -> Self {
        CurvePreset::Linear.curve()
    }
}

impl ResponseCurve {
    /// Whether it changes nothing.
    pub fn is_identity(&self) -> bool {
        let [Some(first), Some(last)] = [self.points.first(), self.points.last()] else { return false };
        *first == [0.0; 2] && *last == [1.0; 2] && self.points.iter().all(|[x, y]| x == y)
    }

    /// What is wrong with its points, if anything is.
    pub fn fault(&self) -> Option<String> {
        let count = self.points.len();
        if !(MIN_CURVE_POINTS..=MAX_CURVE_POINTS).contains(&count) {
            return Some(format!("must have {MIN_CURVE_POINTS} to {MAX_CURVE_POINTS} points, not {count}"));
        }
        let outside = |value: &f64| !(0.0..=1.0).contains(value);
        if let Some(value) = self.points.iter().flatten().find(|value| outside(value)) {
            return Some(format!("must stay from 0 to 1, not {value}"));
        }
        let near = self.points.windows(2).find(|pair| pair[1][0] - pair[0][0] < MIN_CURVE_GAP);
        near.map(|pair| {
            format!(
                "must go from left to right, each point {MIN_CURVE_GAP} on, not {} after {}",
                pair[1][0], pair[0][0]
            )
        })
    }

    /// Its height at `x`.
    pub fn value(&self, x: f64) -> f64 {
        let points = &self.points;
        let next = points.partition_point(|point| point[0] <= x);
        let (Some(before), Some([right, high])) = (next.checked_sub(1), points.get(next)) else {
            return if next == 0 { points.first() } else { points.last() }.map_or(x, |point| point[1]);
        };
        let [left, low] = points[before];
        let width = right - left;
        let t = (x - left) / width;
        if !self.smooth {
            return low + (high - low) * t;
        }
        // Cubic Hermite: within the heights of both points, since the slopes are.
        let [from, to] = [self.slope(before) * width, self.slope(next) * width];
        let (a, b) = (t * t, t * t * t);
        let value =
            low * (2.0 * b - 3.0 * a + 1.0) + high * (3.0 * a - 2.0 * b) + from * (b - 2.0 * a + t) + to * (b - a);
        value.clamp(low.min(*high), low.max(*high))
    }

    /// The slope at a point: the harmonic mean of those on both sides, level at a peak, so that the curve rises and falls
    /// with its points only (Fritsch and Butland, "A Method for Constructing Local Monotone Piecewise Cubic
    /// Interpolants", 1984).
    fn slope(&self, at: usize) -> f64 {
        let secant = |from: usize| {
            let [[a, low], [b, high]] = [*self.points.get(from)?, *self.points.get(from + 1)?];
            Some((high - low) / (b - a))
        };
        match (at.checked_sub(1).and_then(secant), secant(at)) {
            (Some(a), Some(b)) if a * b > 0.0 => 2.0 * a * b / (a + b),
            (Some(_), Some(_)) | (None, None) => 0.0,
            (Some(only), None) | (None, Some(only)) => only,
        }
    }
}

/// Ready-made curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvePreset {
    /// As it is.
    Linear,
    /// Slow at both ends.
    Ease,
    /// Little until near the end.
    Sharp,
    /// Much from the start.
    Soft,
    /// All or nothing.
    Step,
    /// Most in the middle.
    Peak,
    /// In three levels.
    Terraces,
}

impl CurvePreset {
    /// All of them, in the order of menus.
    pub const ALL: [Self; 7] =
        [Self::Linear, Self::Ease, Self::Sharp, Self::Soft, Self::Step, Self::Peak, Self::Terraces];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Linear => "Linear",
            Self::Ease => "Ease",
            Self::Sharp => "Sharp",
            Self::Soft => "Soft",
            Self::Step => "Step",
            Self::Peak => "Peak",
            Self::Terraces => "Terraces",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Linear => "The mask as it is.",
            Self::Ease => "The border begins and ends slowly.",
            Self::Sharp => "Little until the mask is nearly full.",
            Self::Soft => "Much as soon as the mask begins.",
            Self::Step => "All or nothing, with a narrow border.",
            Self::Peak => "Most where the mask is half full: along its border.",
            Self::Terraces => "In three levels: nothing, half, all.",
        }
    }

    /// The curve.
    pub fn curve(self) -> ResponseCurve {
        let (points, smooth): (&[[f64; 2]], bool) = match self {
            Self::Linear => (&[[0.0, 0.0], [1.0, 1.0]], false),
            Self::Ease => (&[[0.0, 0.0], [0.15, 0.0], [0.5, 0.5], [0.85, 1.0], [1.0, 1.0]], true),
            Self::Sharp => (&[[0.0, 0.0], [0.5, 0.15], [0.8, 0.5], [1.0, 1.0]], true),
            Self::Soft => (&[[0.0, 0.0], [0.2, 0.5], [0.5, 0.85], [1.0, 1.0]], true),
            Self::Step => (&[[0.0, 0.0], [0.45, 0.0], [0.55, 1.0], [1.0, 1.0]], false),
            Self::Peak => (&[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]], true),
            Self::Terraces => (&[[0.3, 0.0], [0.35, 0.5], [0.65, 0.5], [0.7, 1.0]], false),
        };
        ResponseCurve { points: points.to_vec(), smooth }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_go_through_their_points_and_never_beyond_their_neighbors() {
        for preset in CurvePreset::ALL {
            for smooth in [false, true] {
                let curve = ResponseCurve { smooth, ..preset.curve() };
                assert_eq!(curve.fault(), None, "{preset:?}");
                for [x, y] in &curve.points {
                    assert!((curve.value(*x) - y).abs() < 1e-12, "{preset:?} at {x}");
                }
                let mut before = curve.value(0.0);
                for i in 0..=1_000 {
                    let x = f64::from(i) / 1_000.0;
                    let value = curve.value(x);
                    let at = curve.points.partition_point(|point| point[0] <= x);
                    let around = [at.saturating_sub(1), at.min(curve.points.len() - 1)].map(|i| curve.points[i][1]);
                    let [low, high] = [around[0].min(around[1]), around[0].max(around[1])];
                    assert!((low - 1e-12..=high + 1e-12).contains(&value), "{preset:?}: {value} at {x}");
                    assert!((value - before).abs() < 0.02, "{preset:?}: a jump at {x}");
                    before = value;
                }
            }
        }
        assert!(CurvePreset::Linear.curve().is_identity() && !CurvePreset::Ease.curve().is_identity());
        assert!((CurvePreset::Linear.curve().value(0.3) - 0.3).abs() < 1e-15);
    }

    #[test]
    fn points_out_of_order_or_range_are_refused_with_the_reason() {
        let fault = |points: &[[f64; 2]]| ResponseCurve { points: points.to_vec(), smooth: false }.fault();
        assert!(fault(&[[0.0, 0.0]]).unwrap().contains("2 to 8 points, not 1"));
        assert!(fault(&[[0.0, 0.0]; 9]).unwrap().contains("not 9"));
        assert!(fault(&[[0.0, 0.0], [1.0, 1.5]]).unwrap().contains("not 1.5"));
        assert!(fault(&[[0.0, f64::NAN], [1.0, 1.0]]).unwrap().contains("NaN"));
        assert!(fault(&[[0.5, 0.0], [0.5, 1.0]]).unwrap().contains("0.5 after 0.5"));
        assert_eq!(fault(&[[0.0, 1.0], [1.0, 0.0]]), None);
    }
}
