//! Sizes of voxels.

use isolith_geometry::Aabb;

use super::super::TriangleMesh;

/// The steps of usual resolutions.
const STEPS: [f64; 7] = [64.0, 96.0, 128.0, 192.0, 256.0, 384.0, 512.0];
/// Most memory of a usual resolution, in bytes.
const USUAL_BYTES: f64 = 48e6;
/// Bytes of samples for each square voxel of the surface: bricks reach beyond it by what they hold on either side.
const BYTES_PER_SQUARE: f64 = 18.0;

/// The size of voxels with this many along the longest side.
pub fn voxel_for(bounds: &Aabb, resolution: f64) -> f64 {
    let longest = (2.0 * bounds.half()).max_element();
    // Nothing has no size, and a point none to divide.
    if longest > 0.0 && longest.is_finite() { longest / resolution } else { 1.0 / resolution }
}

/// The voxels along the longest side that do justice to a mesh: one for the median edge, within reason.
pub fn usual_resolution(mesh: &TriangleMesh) -> f64 {
    let longest = (2.0 * mesh.bounds.half()).max_element();
    let mut edges = Vec::with_capacity(mesh.triangle_count());
    let mut area = 0.0;
    for triangle in 0..mesh.triangle_count() as u32 {
        let [a, b, c] = mesh.corners(triangle);
        area += 0.5 * (b - a).cross(c - a).length();
        edges.push([a.distance(b), b.distance(c), c.distance(a)][triangle as usize % 3]);
    }
    edges.retain(|edge| *edge > 0.0);
    if edges.is_empty() {
        return STEPS[0];
    }
    let middle = edges.len() / 2;
    let median = *edges.select_nth_unstable_by(middle, f64::total_cmp).1;
    let most = (USUAL_BYTES / BYTES_PER_SQUARE / (area / (longest * longest))).sqrt();
    let wanted = (longest / median).min(most);
    STEPS.into_iter().rev().find(|step| *step <= wanted * 1.2).unwrap_or(STEPS[0])
}
