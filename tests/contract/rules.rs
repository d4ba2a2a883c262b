//! The rules of the contract, as functions that return the violation. The tests below apply them to fields that break
//! them, to show that the rules can fail.

use glam::DVec3;

use super::samples::{Random, many};

/// |f(a) − f(b)| ≤ |a − b| over random pairs, near and far, within `half` of `center`. `noise` is the tolerance for
/// rounding.
pub fn steps_are_safe(
    field: &dyn Fn(DVec3) -> f64,
    center: DVec3,
    half: f64,
    pairs: usize,
    noise: f64,
) -> Result<(), String> {
    let mut random = Random::new(pairs as u64);
    for _ in 0..many(pairs) {
        let a = center + random.point(half);
        let distance = half * 10_f64.powf(random.range(-4.0, 0.5));
        let b = a + random.direction() * distance;
        let (fa, fb) = (field(a), field(b));
        if (fa - fb).abs() > (a - b).length() * (1.0 + 1e-9) + noise {
            return Err(format!("from {fa} at {a} to {fb} at {b} over a distance of {}", (a - b).length()));
        }
    }
    Ok(())
}

/// The gradient matches central differences wherever the field is smooth enough for them.
pub fn gradient_is_right(
    field: &dyn Fn(DVec3) -> (f64, DVec3),
    points: impl Iterator<Item = DVec3>,
    h: f64,
) -> Result<(), String> {
    let (mut compared, mut count) = (0, 0);
    for p in points {
        count += 1;
        let (value, gradient) = field(p);
        if gradient.length() > 1.0 + 1e-6 {
            return Err(format!("the gradient at {p} is {gradient}, longer than 1"));
        }
        let side = |axis: DVec3| (field(p + axis * h).0 - value) / h;
        let ahead = DVec3::new(side(DVec3::X), side(DVec3::Y), side(DVec3::Z));
        let behind = -DVec3::new(side(-DVec3::X), side(-DVec3::Y), side(-DVec3::Z));
        if (ahead - behind).length() > 1e-3 {
            continue;
        }
        compared += 1;
        let differences = (ahead + behind) * 0.5;
        if (differences - gradient).length() > 2e-3 {
            return Err(format!("the gradient at {p} is {gradient}, differences say {differences}"));
        }
    }
    if compared * 2 < count {
        return Err(format!("only {compared} of {count} points could be compared"));
    }
    Ok(())
}

#[test]
fn a_field_that_grows_too_fast_is_caught() {
    let good = |p: DVec3| p.length() - 1.0;
    assert_eq!(steps_are_safe(&good, DVec3::ZERO, 2.0, 2_000, 0.0), Ok(()));
    let steep = |p: DVec3| (p.length() - 1.0) * 1.01;
    assert!(steps_are_safe(&steep, DVec3::ZERO, 2.0, 2_000, 0.0).is_err());
    // The fast approximation for an ellipsoid, which is not a bound.
    let r = DVec3::new(1.0, 0.2, 0.4);
    let quick = |p: DVec3| {
        let k = (p / r).length();
        k * (k - 1.0) / (p / (r * r)).length()
    };
    assert!(steps_are_safe(&quick, DVec3::ZERO, 1.0, 2_000, 0.0).is_err());
}

#[test]
fn a_wrong_gradient_is_caught() {
    let points = || (1..50).map(|i| DVec3::new(0.1 * f64::from(i), 0.3, -0.2));
    let good = |p: DVec3| (p.length(), p.normalize());
    assert_eq!(gradient_is_right(&good, points(), 1e-5), Ok(()));
    let turned = |p: DVec3| (p.length(), (p + DVec3::new(0.0, 0.01, 0.0)).normalize());
    assert!(gradient_is_right(&turned, points(), 1e-5).is_err());
}
