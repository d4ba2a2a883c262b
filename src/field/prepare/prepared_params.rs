//! The parameters of a prepared shape.

use glam::DVec3;

use isolith_scene::{EvalParams, SHAPE_FLOATS};

/// Parameters and payload of a prepared shape.
pub(super) struct PreparedParams {
    pub parameters: [f64; SHAPE_FLOATS],
    pub payload: Vec<[f64; 4]>,
}

impl PreparedParams {
    /// Packs the parameters.
    pub fn new(params: &impl EvalParams, payload: Vec<[f64; 4]>) -> Self {
        let mut parameters = [0.0; SHAPE_FLOATS];
        params.write(|at, number| parameters[at] = number);
        Self { parameters, payload }
    }
}

/// A row with a sphere, slightly enlarged as slack for rounding in f32.
pub(super) fn bounding_sphere(center: DVec3, radius: f64) -> [f64; 4] {
    let room = 1e-6 * (radius + center.abs().max_element());
    [center.x, center.y, center.z, radius + room]
}
