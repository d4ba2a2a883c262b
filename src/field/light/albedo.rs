//! Directional albedo of a GGX lobe. Counterpart of `shaders/light/albedo.wgsl`, which describes it.
//!
//! The fits are rational functions of the cosine `m`, of `a = alpha`, of `h = √(m² + a²)` and of `s = m/h`, found by
//! least squares. The tests compare them with the integrals, which are taken over visible normals (Heitz 2018).

/// The albedo for three reflectances of microfacets at the cosine c: 1; (1 - c)⁵; and c (1 - c)⁶.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularAlbedo {
    /// Of a mirror.
    pub whole: f64,
    /// Of what Schlick adds toward grazing angles.
    pub grazing: f64,
    /// Of what the tint of a metal takes away.
    pub tinted: f64,
}

/// The albedo seen at this cosine, for GGX of the width `alpha`.
pub fn albedo_specular(cosine: f64, alpha: f64) -> SpecularAlbedo {
    let (m, a) = (cosine, alpha);
    let h = m.hypot(a);
    let s = m / h;
    let whole_n = 1.02238
        + a * (-1.30552 + a * (0.51858 - 0.00885 * a))
        + s * (-0.0812 + a * (0.65935 - 0.39366 * a) + s * (-0.81197 + 0.26938 * a + 0.15901 * s));
    let whole_d = 1.0 + a * (-1.21234 + 0.44146 * a) + s * (0.17825 + 0.77411 * a - 0.8875 * s);
    let whole = (1.0095 * whole_n / whole_d).min(1.0);
    let mean_n = 0.00064
        + h * (5.70049 + h * (197.88056 + 19.0947 * h))
        + m * (-4.71285 + h * (-248.05753 + 63.2403 * h) + m * (58.38394 - 240.3202 * h + 174.91862 * m));
    let mean_d = 1.0 + h * (103.0172 + 376.08077 * h) + m * (-94.91184 - 699.04703 * h + 340.33741 * m);
    let grazing = (whole * (1.0 - mean_n / mean_d).clamp(0.0, 1.0).powi(5) + 0.0022).min(whole);
    let tinted_n = 0.00352
        + h * (2.27045 + h * (-3.51273 + 2.20232 * h))
        + m * (-1.51939 + h * (2.4919 - 4.48391 * h) + m * (-0.87124 + 4.82121 * h - 1.3811 * m));
    let tinted_d = 1.0 + h * (34.4031 + 82.73064 * h) + m * (-35.12822 + 33.93461 * h - 96.27183 * m);
    SpecularAlbedo { whole, grazing, tinted: (tinted_n / tinted_d).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::lobes::{half_vector, smith};
    use glam::DVec3;

    /// Samples along each side of the square.
    const SAMPLES: u32 = 48;

    /// The integrals: each visible normal reflects G2/G1 of the light.
    fn integrated(cosine: f64, alpha: f64) -> SpecularAlbedo {
        let eye = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let mut sum = [0.0; 3];
        for at in 0..SAMPLES * SAMPLES {
            let unit = [at % SAMPLES, at / SAMPLES].map(|i| (f64::from(i) + 0.5) / f64::from(SAMPLES));
            let half = half_vector(eye, alpha, unit);
            let c = eye.dot(half);
            let up = 2.0 * c * half.z - eye.z;
            if up > 0.0 {
                let (own, other) = (smith(cosine, alpha), smith(up, alpha));
                let passes = (1.0 + own) / (1.0 + own + other);
                let rest = (1.0 - c).max(0.0);
                sum[0] += passes;
                sum[1] += passes * rest.powi(5);
                sum[2] += passes * c * rest.powi(6);
            }
        }
        let [whole, grazing, tinted] = sum.map(|v| v / f64::from(SAMPLES * SAMPLES));
        SpecularAlbedo { whole, grazing, tinted }
    }

    #[test]
    fn the_fits_are_close_to_the_integrals_and_never_promise_less() {
        let mut worst: [f64; 3] = [0.0; 3];
        for cosine in [0.012, 0.035, 0.07, 0.13, 0.22, 0.37, 0.55, 0.72, 0.88, 0.97, 1.0] {
            for roughness in [0.05_f64, 0.09, 0.17, 0.26, 0.38, 0.5, 0.63, 0.77, 0.9, 1.0] {
                let (exact, fit) = (integrated(cosine, roughness.powi(2)), albedo_specular(cosine, roughness.powi(2)));
                let whole = fit.whole / exact.whole - 1.0;
                let grazing = fit.grazing - exact.grazing;
                assert!(whole > -1e-3, "{cosine} {roughness}: {exact:?} {fit:?}");
                assert!(grazing > -1e-3, "{cosine} {roughness}: {exact:?} {fit:?}");
                let off = [whole, grazing, (fit.tinted - exact.tinted).abs()];
                worst = [0, 1, 2].map(|i| worst[i].max(off[i]));
            }
        }
        assert!(worst[0] < 0.024 && worst[1] < 0.021 && worst[2] < 0.002, "{worst:?}");
    }
}
