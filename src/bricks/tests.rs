//! Tests of the layout.

use super::*;

#[test]
fn bytes_hold_distances_to_half_a_step() {
    for i in -396..=396 {
        let voxels = f64::from(i) * 0.01;
        let again = BrickContent::sample_voxels(BrickContent::sample_byte(voxels));
        assert!((again - voxels).abs() <= 0.5 / SAMPLE_STEPS + 1e-12, "{voxels} became {again}");
    }
    assert_eq!(BrickContent::sample_byte(0.0), 128);
    assert_eq!(BrickContent::sample_voxels(BrickContent::sample_byte(-99.0)), -SAMPLE_REACH);
}

#[test]
fn the_slope_of_a_plane_is_that_of_its_distance() {
    let normal = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    let mut samples = [0; BRICK_VOLUME];
    for (i, sample) in samples.iter_mut().enumerate() {
        let p = DVec3::new((i % 8) as f64, (i / 8 % 8) as f64, (i / 64) as f64);
        *sample = BrickContent::sample_byte((p - 3.5).dot(normal) * 0.3);
    }
    let slope = BrickContent::slope(&samples);
    assert!((0.28..0.36).contains(&slope), "{slope}");
}

#[test]
fn the_placeholder_has_samples_where_its_surface_is_and_nowhere_else() {
    let levels = placeholder();
    let bricks = levels.finest();
    assert!((40..400).contains(&bricks.count()), "{bricks:?}");
    assert_eq!(bricks.texels.len(), bricks.first_brick as usize + bricks.count() * BRICK_TEXELS);
    assert!(bricks.grid.bounds().contains(bricks.bounds.min) && bricks.grid.bounds().contains(bricks.bounds.max));
}

#[test]
fn too_fine_voxels_are_refused_with_their_number() {
    let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::ONE);
    let refused = bake(bounds, 1e-5, &|p| p.length() - 1.0).unwrap_err().to_string();
    assert!(refused.contains("199999 voxels") && refused.contains("at most 1024"), "{refused}");
}

#[test]
fn the_scale_of_a_ball_is_little_less_than_what_its_slope_allows() {
    let bounds = Aabb::from_center_half(DVec3::ZERO, DVec3::splat(0.5));
    let field = BakedField { bounds, distance: &|p, _| p.length() - 0.5, look: None };
    let levels = BrickLevels::new(&bake_levels(&field, 0.02, &|_| true).unwrap());
    assert!((3..=MAX_LEVELS).contains(&levels.all().len()), "{levels:?}");
    assert!((0.5..1.0).contains(&levels.scale()), "{}", levels.scale());
}
