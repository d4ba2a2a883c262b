//! Snapping of drags in the viewport: always or while Ctrl is held, and by which steps.

use super::steps::{ANGLE_STEP, snap_step};
use isolith_document::PreferenceValues;

/// The steps of lengths that can be chosen, in meters.
pub const LENGTHS: [f64; 8] = [1.0, 0.5, 0.1, 0.05, 0.02, 0.01, 0.005, 0.001];
/// The steps of angles that can be chosen, in degrees.
pub const ANGLES: [f64; 6] = [1.0, ANGLE_STEP, 10.0, 15.0, 45.0, 90.0];

/// How drags snap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapSettings {
    /// Drags snap unless Ctrl is held, rather than only while it is.
    pub is_on: bool,
    /// The step of lengths in meters; `None` for one that suits the view.
    pub length: Option<f64>,
    /// The step of angles in degrees.
    pub angle: f64,
}

impl Default for SnapSettings {
    fn default() -> Self {
        Self { is_on: false, length: None, angle: ANGLE_STEP }
    }
}

impl SnapSettings {
    /// As they were kept.
    pub fn kept(values: &PreferenceValues) -> Self {
        let angle = values.snap_angle.unwrap_or(ANGLE_STEP);
        Self { is_on: values.snaps, length: values.snap_length, angle }
    }

    /// Keeps them for the next start.
    pub fn keep(&self, values: &mut PreferenceValues) {
        values.snaps = self.is_on;
        values.snap_length = self.length;
        values.snap_angle = Some(self.angle).filter(|angle| *angle != ANGLE_STEP);
    }

    /// The step of lengths in meters, in a view from this distance; 0 for none. `ctrl` says whether Ctrl is held.
    pub fn length_step(&self, ctrl: bool, distance: f64) -> f64 {
        if self.is_on == ctrl { 0.0 } else { self.length.unwrap_or_else(|| snap_step(distance)) }
    }

    /// The step of angles in degrees; 0 for none.
    pub fn angle_step(&self, ctrl: bool) -> f64 {
        if self.is_on == ctrl { 0.0 } else { self.angle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ctrl_means_the_opposite_of_the_switch() {
        let mut snap = SnapSettings::default();
        assert_eq!((snap.length_step(false, 2.0), snap.angle_step(false)), (0.0, 0.0));
        assert!((snap.length_step(true, 2.0) - 0.1).abs() < 1e-12 && snap.angle_step(true) == ANGLE_STEP);
        snap = SnapSettings { is_on: true, length: Some(0.005), angle: 15.0 };
        assert_eq!((snap.length_step(false, 2.0), snap.angle_step(false)), (0.005, 15.0));
        assert_eq!((snap.length_step(true, 2.0), snap.angle_step(true)), (0.0, 0.0));
    }

    #[test]
    fn what_is_kept_comes_back() {
        let mut values = PreferenceValues::default();
        assert_eq!(SnapSettings::kept(&values), SnapSettings::default());
        let snap = SnapSettings { is_on: true, length: Some(0.02), angle: 45.0 };
        snap.keep(&mut values);
        assert_eq!(SnapSettings::kept(&values), snap);
    }
}
