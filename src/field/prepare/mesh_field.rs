//! Models: where their bricks lie, see `eval/brick_field.rs` for the rows.

use super::prepared_params::PreparedParams;
use isolith_bricks::Bricks;

/// Index of the payload row whose last number is the first texel, which is known only when the scene is written.
pub const FIRST_TEXEL_ROW: usize = 2;

/// The rows of bricks that begin at the first texel.
pub fn mesh_field(bricks: &Bricks) -> PreparedParams {
    let [x, y, z] = bricks.grid.origin.to_array();
    let [nx, ny, nz] = bricks.grid.cells.map(f64::from);
    // Fewer than 32-bit floats count exactly, see `MAX_BRICK_TEXELS`.
    let first_brick = f64::from(bricks.first_brick);
    let rows = vec![
        [x, y, z, bricks.grid.voxel],
        [nx, ny, nz, 0.0],
        [bricks.coarse_scale, bricks.coarse_error, first_brick, f64::from(bricks.mark())],
    ];
    PreparedParams::new([0.0; 4], [0.0; 4], rows)
}
