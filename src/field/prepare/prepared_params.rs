//! The parameters of a prepared shape.

use glam::DVec3;

use isolith_scene::SHAPE_FLOATS;

/// Parameters and payload of a prepared shape.
pub(super) struct PreparedParams {
    pub parameters: [f64; SHAPE_FLOATS],
    pub payload: Vec<[f64; 4]>,
}

impl PreparedParams {
    /// Parameters from their first two rows.
    pub fn new(first: [f64; 4], second: [f64; 4], payload: Vec<[f64; 4]>) -> Self {
        let mut parameters = [0.0; SHAPE_FLOATS];
        parameters[..4].copy_from_slice(&first);
        parameters[4..8].copy_from_slice(&second);
        Self { parameters, payload }
    }
}

/// A row with a sphere, slightly enlarged as slack for rounding in f32.
pub(super) fn bounding_sphere(center: DVec3, radius: f64) -> [f64; 4] {
    let room = 1e-6 * (radius + center.abs().max_element());
    [center.x, center.y, center.z, radius + room]
}
