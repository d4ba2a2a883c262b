//! Round numbers for what is dragged: the steps of snapping, and the digits that a pixel can tell apart.

use glam::DVec3;

/// A round snapping step: about a fiftieth of the visible extent.
pub fn snap_step(distance: f64) -> f64 {
    10.0_f64.powf((distance * 0.05).log10().round()).max(1e-6)
}

/// The step between two angles, in degrees, while snapping.
pub const ANGLE_STEP: f64 = 5.0;

/// A power of ten no larger than half the length of a point of the screen, in meters.
pub fn finest_step(meters_per_point: f64) -> f64 {
    10.0_f64.powf((meters_per_point * 0.5).log10().floor()).clamp(1e-9, 1e6)
}

/// The multiple of the step that is nearest to the value; the value itself without a step.
pub fn rounded(value: f64, step: f64) -> f64 {
    // Dividing by the step's reciprocal gives 0.3, where multiplying by 0.1 gives 0.30000000000000004.
    let per_unit = (1.0 / step).round();
    match () {
        () if !(step.is_finite() && step > 0.0) => value,
        () if step < 1.0 && (per_unit * step - 1.0).abs() < 1e-9 => (value * per_unit).round() / per_unit + 0.0,
        () => (value / step).round() * step + 0.0,
    }
}

/// The same for each coordinate.
pub fn rounded_point(point: DVec3, step: f64) -> DVec3 {
    DVec3::from(point.to_array().map(|v| rounded(v, step)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapping_steps_are_powers_of_ten() {
        assert!((snap_step(2.0) - 0.1).abs() < 1e-12);
        assert!((snap_step(200.0) - 10.0).abs() < 1e-12);
        assert!((finest_step(0.005) - 0.001).abs() < 1e-12);
    }

    #[test]
    fn rounded_numbers_are_written_short() {
        assert_eq!(rounded(0.298, 0.1).to_string(), "0.3");
        assert_eq!(rounded(-0.01, 0.1).to_string(), "0");
        assert_eq!(rounded(127.0, 50.0), 150.0);
        assert_eq!(rounded(0.123, 0.0), 0.123);
        assert_eq!(rounded_point(DVec3::new(0.1204, 2.0, -0.75), 0.01), DVec3::new(0.12, 2.0, -0.75));
    }
}
