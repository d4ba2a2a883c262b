//! What is shown without a model.

use std::sync::{Arc, LazyLock};

use glam::{DVec2, DVec3};
use isolith_geometry::Aabb;

use super::{BakedField, BrickLevels, bake_levels};

/// Size of a voxel, in meters.
const VOXEL: f64 = 0.02;

/// A ring that stands on a disc, half a meter high: the shape of a model that is not there.
pub fn placeholder() -> Arc<BrickLevels> {
    static MADE: LazyLock<Arc<BrickLevels>> = LazyLock::new(|| {
        let bounds = Aabb::new(DVec3::new(-0.3, -0.3, -0.3), DVec3::new(0.3, 0.45, 0.3));
        let field = BakedField { bounds, distance: &|p, _| distance(p), look: None };
        Arc::new(BrickLevels::new(&bake_levels(&field, VOXEL, &|_| true).expect("it is small")))
    });
    MADE.clone()
}

/// The exact distance to the placeholder, in meters, outside of it.
fn distance(p: DVec3) -> f64 {
    let ring = DVec2::new(DVec2::new(p.x, p.y - 0.15).length() - 0.22, p.z).length() - 0.08;
    let d = DVec2::new(DVec2::new(p.x, p.z).length() - 0.26, (p.y + 0.22).abs() - 0.04);
    let disc = d.max(DVec2::ZERO).length() + d.max_element().min(0.0) - 0.04;
    ring.min(disc)
}
