// Directional albedo of a GGX lobe: the share of light that it reflects toward the eye if light comes equally from
// everywhere. Counterpart of `src/field/light/albedo.rs`, whose tests compare these fits with the integrals.

// The albedo for three reflectances F of microfacets at the cosine c: 1; (1 - c)^5; and c (1 - c)^6.
struct SpecularAlbedo {
    whole: f32,
    grazing: f32,
    tinted: f32,
}

// `cosine` is that between the normal and the direction to the eye, `alpha` the width of GGX.
fn albedo_specular(cosine: f32, alpha: f32) -> SpecularAlbedo {
    let m = cosine;
    let a = alpha;
    let h = sqrt(m * m + a * a);
    let s = m / h;
    let whole_n = 1.02238 + a * (-1.30552 + a * (0.51858 - 0.00885 * a))
        + s * (-0.0812 + a * (0.65935 - 0.39366 * a) + s * (-0.81197 + 0.26938 * a + 0.15901 * s));
    let whole_d = 1.0 + a * (-1.21234 + 0.44146 * a) + s * (0.17825 + 0.77411 * a - 0.8875 * s);
    // Never less than the integral: energy must not grow.
    let whole = min(1.0095 * whole_n / whole_d, 1.0);
    // The cosine at which one microfacet would reflect as much of (1 - c)^5.
    let mean_n = 0.00064 + h * (5.70049 + h * (197.88056 + 19.0947 * h))
        + m * (-4.71285 + h * (-248.05753 + 63.2403 * h) + m * (58.38394 - 240.3202 * h + 174.91862 * m));
    let mean_d = 1.0 + h * (103.0172 + 376.08077 * h) + m * (-94.91184 - 699.04703 * h + 340.33741 * m);
    let rest = clamp(1.0 - mean_n / mean_d, 0.0, 1.0);
    let grazing = min(whole * rest * rest * rest * rest * rest + 0.0022, whole);
    let tinted_n = 0.00352 + h * (2.27045 + h * (-3.51273 + 2.20232 * h))
        + m * (-1.51939 + h * (2.4919 - 4.48391 * h) + m * (-0.87124 + 4.82121 * h - 1.3811 * m));
    let tinted_d = 1.0 + h * (34.4031 + 82.73064 * h) + m * (-35.12822 + 33.93461 * h - 96.27183 * m);
    return SpecularAlbedo(whole, grazing, max(tinted_n / tinted_d, 0.0));
}
