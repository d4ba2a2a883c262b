//! Linear light to the colors of a screen. Counterpart of `shaders/light/display.wgsl`.
//!
//! | transform | source |
//! |---|---|
//! | AgX | Troy Sobotka's AgX, <https://github.com/sobotka/AgX>; matrices and polynomial of the contrast curve by Benjamin Wrensch's fit, *Minimal AgX Implementation*, <https://iolite-engine.com/blog_posts/minimal_agx_implementation> |
//! | PBR Neutral | Khronos PBR Neutral Tone Mapper, <https://github.com/KhronosGroup/ToneMapping> |
//! | sRGB | IEC 61966-2-1 |

use glam::{DMat3, DVec3};

use isolith_scene::{DisplaySettings, ViewTransform};

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

/// The factor of an exposure in stops.
pub fn display_gain(settings: &DisplaySettings) -> f64 {
    settings.exposure.exp2()
}

/// The color of a screen for the light of a scene: exposure, view transform and encoding.
pub fn display_color(radiance: DVec3, settings: &DisplaySettings) -> DVec3 {
    let exposed = radiance * display_gain(settings);
    display_encode(match settings.view_transform {
        ViewTransform::None => exposed,
        ViewTransform::Agx => display_agx(exposed),
        ViewTransform::PbrNeutral => display_neutral(exposed),
    })
}

/// AgX; the module names its source. The result is linear light of a screen.
pub fn display_agx(scene: DVec3) -> DVec3 {
    let inset = DMat3::from_cols_array_2d(&[
        [0.842_479_062, 0.042_328_242_3, 0.042_375_654_9],
        [0.078_433_6, 0.878_468_636, 0.078_433_6],
        [0.079_223_745_1, 0.079_166_127_5, 0.879_142_974],
    ]);
    let outset = DMat3::from_cols_array_2d(&[
        [1.196_879_01, -0.052_896_851_8, -0.052_971_635_5],
        [-0.098_020_881_1, 1.151_903_13, -0.098_043_450_1],
        [-0.099_029_744_1, -0.098_961_176_8, 1.151_073_67],
    ]);
    let stops = (inset * scene).max(DVec3::splat(1e-10)).map(f64::log2);
    let curved = ((stops + 12.473_93) / 16.5).clamp(DVec3::ZERO, DVec3::ONE).map(display_agx_curve);
    (outset * curved).max(DVec3::ZERO).map(|v| v.powf(2.2))
}

/// The contrast curve of AgX over a range of 16.5 stops.
fn display_agx_curve(x: f64) -> f64 {
    ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.002_32
}

/// Compression of PBR Neutral starts here: 0.8 less the lift.
const DISPLAY_NEUTRAL_START: f64 = 0.76;
/// The reflection of a dielectric, which PBR Neutral subtracts.
const DISPLAY_NEUTRAL_LIFT: f64 = 0.04;
const DISPLAY_NEUTRAL_DESATURATION: f64 = 0.15;

/// Khronos PBR Neutral; the module names its source. The result is linear light of a screen.
pub fn display_neutral(scene: DVec3) -> DVec3 {
    let least = scene.min_element();
    let lift = if least < 2.0 * DISPLAY_NEUTRAL_LIFT { least - 6.25 * least * least } else { DISPLAY_NEUTRAL_LIFT };
    let color = scene - lift;
    let peak = color.max_element();
    if peak < DISPLAY_NEUTRAL_START {
        return color;
    }
    let room = 1.0 - DISPLAY_NEUTRAL_START;
    let compressed = 1.0 - room * room / (peak + room - DISPLAY_NEUTRAL_START);
    let white = 1.0 - 1.0 / (DISPLAY_NEUTRAL_DESATURATION * (peak - compressed) + 1.0);
    (color * (compressed / peak)).lerp(DVec3::splat(compressed), white)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(v: f64) -> DVec3 {
        DVec3::splat(v)
    }

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255_u8 {
            let encoded = display_encode(display_decode(gray(f64::from(byte) / 255.0))) * 255.0;
            assert_eq!(encoded.round(), gray(f64::from(byte)), "{byte}: {encoded}");
            // The two parts of the curve meet within 1e-7 of each other.
            assert!((encoded.x - f64::from(byte)).abs() < 1e-4, "{byte}: {encoded}");
        }
        let clamped = display_encode(DVec3::new(-1.0, 2.0, 0.0));
        assert!((clamped - DVec3::Y).length() < 1e-12, "{clamped}");
    }

    /// Sobotka's sigmoid: slope 2 at middle gray (10 of 16.5 stops, 0.5), powers 3 and 3.25 of toe and shoulder.
    fn sigmoid(x: f64) -> f64 {
        let (pivot, slope) = (10.0 / 16.5, 2.0_f64);
        let is_toe = x < pivot;
        let (power, width) = if is_toe { (3.0, pivot) } else { (3.25, 1.0 - pivot) };
        let reach = ((slope * width).powf(-power) * ((slope * width / 0.5).powf(power) - 1.0)).powf(-1.0 / power);
        let scale = if is_toe { -reach } else { reach };
        let term = slope * (x - pivot) / scale;
        scale * term / (1.0 + term.powf(power)).powf(1.0 / power) + 0.5
    }

    #[test]
    fn agx_has_the_curve_of_its_source() {
        for i in 0..=1000 {
            let x = f64::from(i) / 1000.0;
            assert!((display_agx_curve(x) - sigmoid(x)).abs() < 0.006, "{x}");
        }
    }

    #[test]
    fn agx_keeps_grays_gray_and_bends_bright_colors_to_white() {
        // 0.5 encoded with a power of 2.2.
        let middle = display_agx(gray(0.18));
        assert!((middle - gray(0.5_f64.powf(2.2))).abs().max_element() < 0.006, "{middle}");
        let mut last = -1.0;
        for stop in -12..=8 {
            let shown = display_agx(gray(0.18 * f64::from(stop).exp2()));
            assert!((shown.max_element() - shown.min_element()) < 1e-3, "{shown}");
            assert!(shown.x >= last && (0.0..=1.0).contains(&shown.x), "{stop}: {shown}");
            last = shown.x;
        }
        assert!(last > 0.98, "{last}");
        let red = |strength: f64| display_agx(DVec3::new(strength, 0.0, 0.0));
        let saturation = |c: DVec3| 1.0 - c.min_element() / c.max_element();
        assert!(saturation(red(0.5)) > 0.9 && saturation(red(100.0)) < 0.5, "{} {}", red(0.5), red(100.0));
    }

    #[test]
    fn neutral_shows_base_colors_as_they_are_under_white_light() {
        // A dielectric reflects 4 % more than its base color. From 0.08 up to 0.8 the sum is compensated exactly.
        for (r, g, b) in [(0.04, 0.04, 0.04), (0.04, 0.4, 0.7), (0.75, 0.3, 0.1), (0.2, 0.2, 0.2), (0.759, 0.759, 0.04)]
        {
            let base = DVec3::new(r, g, b);
            let shown = display_neutral(base + DISPLAY_NEUTRAL_LIFT);
            assert!((shown - base).abs().max_element() < 1e-12, "{base}: {shown}");
        }
    }

    #[test]
    fn neutral_has_the_values_of_its_specification() {
        assert_eq!(display_neutral(DVec3::ZERO), DVec3::ZERO);
        // Below 0.08: 6.25 times the square.
        assert!((display_neutral(gray(0.04)) - gray(0.01)).length() < 1e-12);
        // Gray 1: 1 - 0.24² / (0.96 + 0.24 - 0.76).
        assert!((display_neutral(gray(1.0)) - gray(1.0 - 0.0576 / 0.44)).length() < 1e-12);
        // Red 2: the peak 2 is compressed to 1 - 0.0576 / 1.48, and 1 - 1 / (0.15 * (2 - peak) + 1) of it is white.
        let peak = 1.0 - 0.0576 / 1.48;
        let white = peak * (1.0 - 1.0 / (0.15 * (2.0 - peak) + 1.0));
        let shown = display_neutral(DVec3::new(2.0, 0.0, 0.0));
        assert!((shown - DVec3::new(peak, white, white)).length() < 1e-12, "{shown}");
        assert!(display_neutral(gray(1e6)).max_element() < 1.0);
    }

    #[test]
    fn exposure_counts_in_stops_before_the_transform() {
        for view_transform in ViewTransform::ALL {
            let exposed = DisplaySettings { exposure: 2.0, view_transform };
            let plain = DisplaySettings { exposure: 0.0, view_transform };
            let color = DVec3::new(0.02, 0.1, 0.05);
            assert!((display_color(color, &exposed) - display_color(4.0 * color, &plain)).length() < 1e-12);
        }
    }
}
