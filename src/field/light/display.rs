//! Linear light to the colors of a screen. Counterpart of `shaders/light/display.wgsl`.

use glam::DVec3;

/// Encodes linear light for a screen (IEC 61966-2-1), clamped to 0..1.
pub fn display_encode(linear: DVec3) -> DVec3 {
    linear
        .clamp(DVec3::ZERO, DVec3::ONE)
        .map(|c| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 })
}

/// The inverse of [`display_encode`]: decodes a byte of a texture.
pub fn display_decode(encoded: DVec3) -> DVec3 {
    encoded.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_is_undone_by_decoding() {
        for i in 0..=100 {
            let c = DVec3::splat(f64::from(i) / 100.0);
            assert!((display_decode(display_encode(c)) - c).length() < 1e-4);
        }
        let clamped = display_encode(DVec3::new(-1.0, 2.0, 0.0));
        assert!((clamped - DVec3::Y).length() < 1e-12, "{clamped}");
    }
}
