//! The value of a parameter between two keys.
//!
//! Smooth curves are cubic Hermite splines with the slopes of F. N. Fritsch and J. Butland, "A method for constructing
//! local monotone piecewise cubic interpolants", SIAM J. Sci. Stat. Comput. 5 (1984): the curve passes through the keys
//! and stays between them, so that no value exceeds the limits that its keys keep. Rotations go along the great circle
//! between two keys (K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985), at a rate by the same
//! rule.

use glam::{DQuat, DVec3};

use super::track::{KeyInterpolation, Keyframe, Track};
use crate::params::ParamValue;

impl Track {
    /// The value at `time` seconds; `None` without keys.
    pub fn value_at(&self, time: f64) -> Option<ParamValue> {
        (!self.keys.is_empty()).then(|| value(&self.keys, time))
    }
}

/// The value at `time`. There is at least one key.
fn value(keys: &[Keyframe], time: f64) -> ParamValue {
    let after = keys.partition_point(|key| key.time <= time);
    let Some(at) = after.checked_sub(1) else { return keys[0].value.clone() };
    let key = &keys[at];
    if after == keys.len() || key.interpolation == KeyInterpolation::Hold {
        return key.value.clone();
    }
    let segment = Segment { keys, at, share: (time - key.time) / (keys[after].time - key.time) };
    match &key.value {
        ParamValue::Scalar(_) => ParamValue::Scalar(segment.number(0)),
        ParamValue::Vector(_) => ParamValue::Vector(DVec3::from_array([0, 1, 2].map(|i| segment.number(i)))),
        ParamValue::Count(_) => ParamValue::Count(segment.number(0).round() as u32),
        ParamValue::Counts(_) => ParamValue::Counts([0, 1, 2].map(|i| segment.number(i).round() as u32)),
        ParamValue::Rotation(from) => segment.rotation(*from),
        // There is nothing between on and off.
        other => other.clone(),
    }
}

/// One of the numbers of a value; 0 where it has none.
fn number(value: &ParamValue, index: usize) -> f64 {
    match value {
        ParamValue::Scalar(v) => *v,
        ParamValue::Vector(v) => v[index],
        ParamValue::Count(n) => f64::from(*n),
        ParamValue::Counts(n) => f64::from(n[index]),
        _ => 0.0,
    }
}

/// Two neighboring keys, and how far between them.
struct Segment<'a> {
    keys: &'a [Keyframe],
    at: usize,
    /// From 0 at the first of the two to 1 at the second.
    share: f64,
}

impl Segment<'_> {
    fn length(&self) -> f64 {
        self.keys[self.at + 1].time - self.keys[self.at].time
    }

    fn is_smooth(&self) -> bool {
        self.keys[self.at].interpolation == KeyInterpolation::Smooth
    }

    fn number(&self, index: usize) -> f64 {
        let [from, to] = [self.at, self.at + 1].map(|at| number(&self.keys[at].value, index));
        if !self.is_smooth() {
            return (from + (to - from) * self.share).clamp(from.min(to), from.max(to));
        }
        let slopes = [self.at, self.at + 1].map(|at| {
            let rate = |first: usize| {
                (number(&self.keys[first + 1].value, index) - number(&self.keys[first].value, index))
                    / (self.keys[first + 1].time - self.keys[first].time)
            };
            self.slope_at(at, rate)
        });
        // Rounding alone could pass a key.
        hermite(self.share, [from, to], slopes.map(|slope| slope * self.length())).clamp(from.min(to), from.max(to))
    }

    /// The slope at a key, from the rate of each of the two segments that meet there.
    fn slope_at(&self, at: usize, rate: impl Fn(usize) -> f64) -> f64 {
        let keys = self.keys;
        // The curve stands still where it begins and ends, and next to a value that stays.
        if at == 0 || at + 1 == keys.len() || keys[at - 1].interpolation == KeyInterpolation::Hold {
            return 0.0;
        }
        if keys[at].interpolation == KeyInterpolation::Hold {
            return 0.0;
        }
        let lengths = [keys[at].time - keys[at - 1].time, keys[at + 1].time - keys[at].time];
        monotone_slope([rate(at - 1), rate(at)], lengths)
    }

    fn rotation(&self, from: DQuat) -> ParamValue {
        let ParamValue::Rotation(to) = self.keys[self.at + 1].value else { return ParamValue::Rotation(from) };
        let share = if self.is_smooth() { self.turned_share() } else { self.share };
        ParamValue::Rotation(slerp(from, to, share))
    }

    /// The share of the rotation between the two keys.
    fn turned_share(&self) -> f64 {
        let turn = |first: usize| {
            let [a, b] = [first, first + 1].map(|at| match self.keys[at].value {
                ParamValue::Rotation(rotation) => rotation,
                _ => DQuat::IDENTITY,
            });
            shortest(a.conjugate() * b).to_scaled_axis()
        };
        let angle = turn(self.at).length();
        if angle == 0.0 {
            return self.share;
        }
        let slopes = [self.at, self.at + 1].map(|at| {
            let rate = |first: usize| turn(first).length() / (self.keys[first + 1].time - self.keys[first].time);
            let slope = self.slope_at(at, rate);
            if slope == 0.0 {
                return 0.0;
            }
            // Where the axis turns by a right angle or more, the rotation stops.
            let (before, after) = (turn(at - 1).normalize_or_zero(), turn(at).normalize_or_zero());
            slope * before.dot(after).max(0.0)
        });
        hermite(self.share, [0.0, 1.0], slopes.map(|slope| slope * self.length() / angle)).clamp(0.0, 1.0)
    }
}

/// The weighted harmonic mean of two rates; 0 where they differ in sign.
fn monotone_slope([before, after]: [f64; 2], [length_before, length_after]: [f64; 2]) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let weights = [2.0 * length_after + length_before, length_after + 2.0 * length_before];
    (weights[0] + weights[1]) / (weights[0] / before + weights[1] / after)
}

/// The cubic with these values and slopes at 0 and 1.
fn hermite(u: f64, [from, to]: [f64; 2], [leave, arrive]: [f64; 2]) -> f64 {
    let v = 1.0 - u;
    v * v * (1.0 + 2.0 * u) * from + u * u * (3.0 - 2.0 * u) * to + u * v * (v * leave - u * arrive)
}

/// The same rotation by the shorter way.
fn shortest(rotation: DQuat) -> DQuat {
    if rotation.w < 0.0 { -rotation } else { rotation }
}

/// The rotation between two, by the shorter way. At the ends it is one of the two to the last bit.
fn slerp(from: DQuat, to: DQuat, share: f64) -> DQuat {
    match share {
        share if share <= 0.0 => from,
        share if share >= 1.0 => to,
        share => from.slerp(to, share).normalize(),
    }
}
