//! Environment maps against Monte Carlo integrals over the image.

use super::*;

/// A room with two windows of a hundred times its brightness, and a red wall.
fn room() -> EnvironmentImage {
    let size = [128, 64];
    let color = |i: usize| {
        let (x, y) = (i % size[0], i / size[0]);
        match (x, y) {
            (20..=31, 14..=25) => [20.0, 18.0, 15.0],
            (80..=83, 8..=11) => [60.0, 60.0, 70.0],
            (96..=120, 30..=50) => [0.8, 0.1, 0.05],
            _ => [0.2, 0.25, 0.3 + 0.004 * (64 - y) as f32],
        }
    };
    EnvironmentImage { size, texels: (0..size[0] * size[1]).map(color).collect(), pixels: 0 }
}

/// Directions all over the sphere, and their number.
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let y = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let (turn, side) = (i as f64 * PI * (3.0 - 5.0_f64.sqrt()), (1.0 - y * y).sqrt());
        DVec3::new(turn.cos() * side, y, turn.sin() * side)
    })
}

#[test]
fn colors_are_kept_within_the_steps_of_their_brightest_channel() {
    for (i, direction) in directions(1_000).enumerate() {
        let color = (direction + 1.0) * 10.0_f64.powf(i as f64 / 200.0 - 2.0);
        let off = (unpacked(packed(color)) - color).abs().max_element();
        assert!(off <= color.max_element() / 510.0, "{color}: {off}");
    }
    assert_eq!(unpacked(packed(DVec3::ZERO)), DVec3::ZERO);
    assert!((unpacked(packed(DVec3::splat(1e9))) - 65_408.0).length() < 200.0);
}

#[test]
fn texels_are_where_their_directions_are() {
    let image = room();
    let map = EnvironmentMap::new(&image);
    let whole = &map.levels[0];
    for i in (0..whole.texels.len()).step_by(7) {
        let direction = whole.direction(i);
        let off = (whole.radiance(direction) - unpacked(whole.texels[i])).length();
        assert!(off < 1e-6 * (1.0 + unpacked(whole.texels[i]).length()), "{i} {direction}: {off}");
    }
    let all: f64 = (0..whole.size[1]).map(|line| whole.solid_angle(line) * whole.size[0] as f64).sum();
    assert!((all - 4.0 * PI).abs() < 1e-9);
    // The middle of the image is in the direction −Z, the upper edge above, the right half toward +X.
    assert!(whole.direction(64 + 32 * 128).dot(DVec3::NEG_Z) > 0.99 && whole.direction(64).y > 0.99);
    assert!(whole.direction(96 + 32 * 128).dot(DVec3::X) > 0.99);
    // Turned by 90° counterclockwise, the middle is in the direction −X.
    let placed = PlacedMap { map: Arc::new(map), strength: 1.0, rotation: PI * 0.5 };
    assert!((placed.map_from_world(DVec3::NEG_X) - DVec3::NEG_Z).length() < 1e-12);
}

#[test]
fn diffuse_light_is_near_the_integral() {
    let map = EnvironmentMap::new(&room());
    let lights: Vec<(DVec3, DVec3)> = directions(20_000).map(|d| (d, map.levels[0].radiance(d))).collect();
    let mean = lights.iter().map(|(_, light)| light.element_sum()).sum::<f64>() / 3.0 / lights.len() as f64;
    let mut errors = Vec::new();
    for normal in directions(200) {
        let sum: DVec3 = lights.iter().map(|(d, light)| *light * d.dot(normal).max(0.0)).sum();
        let truth = sum * 4.0 / lights.len() as f64;
        errors.push((map.irradiance(normal) - truth).abs().max_element() / mean);
    }
    errors.sort_by(f64::total_cmp);
    // Order 2 keeps 99 % of the energy; windows this bright and small are the worst case.
    let (average, p99) = (errors.iter().sum::<f64>() / 200.0, errors[197]);
    assert!(average < 0.07 && p99 < 0.15, "{average} {p99}");
}

#[test]
fn reflections_are_near_the_integral_of_their_lobe() {
    let map = EnvironmentMap::new(&room());
    let lights: Vec<(DVec3, DVec3)> = directions(40_000).map(|d| (d, map.levels[0].radiance(d))).collect();
    let mean = lights.iter().map(|(_, light)| light.element_sum()).sum::<f64>() / 3.0 / lights.len() as f64;
    // Measured, with a margin: small bright windows in coarse levels are the worst case.
    for (k, most) in [(2, [0.02, 0.25]), (3, [0.015, 0.12]), (4, [0.02, 0.1]), (5, [0.025, 0.1])] {
        let roughness = (k as f64 / (ROUGH_LEVELS - 1) as f64).powf(1.5);
        let a2 = roughness.powi(4);
        let mut errors = Vec::new();
        for axis in directions(120) {
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for (d, light) in &lights {
                let (facing, half) = (d.dot(axis), (*d + axis).normalize().dot(axis));
                let weight = facing.max(0.0) / (half * half * (a2 - 1.0) + 1.0).powi(2);
                sum += *light * weight;
                weights += weight;
            }
            errors.push((map.reflected(axis, roughness) - sum / weights).abs().max_element() / mean);
        }
        errors.sort_by(f64::total_cmp);
        let found = [errors.iter().sum::<f64>() / errors.len() as f64, errors[118]];
        assert!(found[0] < most[0] && found[1] < most[1], "{roughness}: {found:?}");
    }
}

#[test]
fn one_color_lights_and_reflects_that_color() {
    let environment =
        Environment { background: EnvironmentKind::Color { color: [0.5, 0.25, 0.125] }, ..Environment::default() };
    let placed = PlacedMap::of(&environment).expect("a color has a map");
    for direction in directions(50) {
        let color = DVec3::new(0.5, 0.25, 0.125);
        for found in [placed.map.irradiance(direction), placed.map.reflected(direction, 0.4)] {
            assert!((found - color).length() < 2e-3, "{found}");
        }
    }
    assert!(PlacedMap::of(&Environment::default()).is_none());
    assert_eq!(map_words(None).len(), MAP_HEADER);
    assert!(map_words(Some(&placed)).len() > MAP_HEADER + LEVELS);
}
