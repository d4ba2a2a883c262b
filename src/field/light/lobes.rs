//! Samples of GGX, for integrals over what a surface reflects.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// Smith's Λ for GGX at this cosine.
pub(super) fn smith(cosine: f64, alpha: f64) -> f64 {
    ((1.0 + (alpha / cosine).powi(2) * (1.0 - cosine * cosine)).sqrt() - 1.0) / 2.0
}

/// A visible microfacet normal for a place in the unit square, by spherical caps (Dupuy and Benyoub 2023). The surface's
/// normal is Z.
pub(super) fn half_vector(eye: DVec3, alpha: f64, [u, v]: [f64; 2]) -> DVec3 {
    let stretched = DVec3::new(alpha * eye.x, alpha * eye.y, eye.z).normalize();
    let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
    let (sine, cosine) = (TAU * u).sin_cos();
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let half = DVec3::new(radius * cosine, radius * sine, z) + stretched;
    DVec3::new(alpha * half.x, alpha * half.y, half.z.max(0.0)).normalize()
}

/// Density of directions of light that `half_vector` leads to, per solid angle.
pub(super) fn density(eye: DVec3, alpha: f64, to_light: DVec3) -> f64 {
    let half = (eye + to_light).normalize();
    let d = alpha * alpha * half.z * half.z + half.truncate().length_squared();
    alpha * alpha / (PI * d * d) / (1.0 + smith(eye.z, alpha)) / (4.0 * eye.z)
}
