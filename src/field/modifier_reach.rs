//! What modifiers read of their content, and where their numbers end.

use glam::DVec3;

use isolith_geometry::Aabb;
use isolith_scene::Modifier;

/// How much a deformation is expected to stretch what is read of its content. How much it does follows from the
/// bounds of the content, which are not known before.
const LIKELY_STRETCH: f64 = 2.0;
/// Farther than this many periods of its pattern from its origin, a modifier warns: f32 places a point to an eighth of
/// a period there.
const MOST_PERIODS: f64 = 1_048_576.0;

/// The greatest value of its content's field that a modifier reads, if `read_to` is the greatest that is read of its
/// own.
pub(super) fn read_within(modifier: &Modifier, read_to: f64) -> f64 {
    match *modifier {
        Modifier::Round { radius } => read_to + radius,
        Modifier::Onion { thickness, .. } => read_to + 0.5 * thickness,
        Modifier::Waves { amplitude, .. } | Modifier::Noise { amplitude, .. } => read_to + amplitude,
        Modifier::Displacement { height, .. } => read_to + height.max(0.0),
        Modifier::Twist { .. } | Modifier::Bend { .. } | Modifier::Taper { .. } => LIKELY_STRETCH * read_to,
        Modifier::Recursion { count, scale, .. } => read_to / scale.min(1.0).powi(count as i32 - 1),
        Modifier::Mirror { .. } | Modifier::Polar { .. } | Modifier::Repeat { .. } | Modifier::Elongate { .. } => {
            read_to
        }
    }
}

/// A warning if the pattern of a modifier is too fine for the place of its content.
pub(super) fn too_fine(modifier: &Modifier, content: &Aabb) -> Option<String> {
    let (period, pattern) = match *modifier {
        Modifier::Waves { length, .. } => (length, "waves"),
        Modifier::Noise { size, octaves, .. } => (size * 0.5_f64.powi(octaves as i32 - 1), "noise"),
        Modifier::Displacement { ref image, tile, .. } => {
            (tile / image.content().map_or(1.0, |heights| heights.size[0] as f64), "image")
        }
        _ => return None,
    };
    let away = content.distance(DVec3::ZERO);
    (away > MOST_PERIODS * period).then(|| {
        format!("lies {away:.3e} m from its own origin, too far for {pattern} as fine as {period:.1e} m to be exact")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_too_fine_for_its_place_is_told() {
        let noise = |size| Modifier::Noise { amplitude: 0.1, size, octaves: 3, seed: 1 };
        let at = |x: f64| Aabb::from_center_half(DVec3::X * x, DVec3::ONE);
        assert_eq!(too_fine(&noise(0.1), &at(0.0)), None);
        assert_eq!(too_fine(&noise(0.1), &at(26_000.0)), None);
        assert!(too_fine(&noise(0.1), &at(27_000.0)).is_some_and(|told| told.contains("noise")));
        let waves = Modifier::Waves { amplitude: 0.1, length: 1e-6, phase: 0.0 };
        assert_eq!(too_fine(&waves, &at(1.5)), None);
        assert!(too_fine(&waves, &at(3.0)).is_some_and(|told| told.contains("waves")));
        // The ground is near its origin somewhere.
        assert_eq!(too_fine(&noise(1e-9), &Aabb::EVERYTHING), None);
        assert_eq!(too_fine(&Modifier::Twist { angle: 30.0 }, &at(1e9)), None);
    }
}
