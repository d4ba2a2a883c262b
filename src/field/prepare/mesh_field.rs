//! Models: where their bricks lie, see `eval/brick_field.rs` for the rows.

use super::prepared_params::PreparedParams;
use isolith_bricks::{BrickLevels, Bricks};
use isolith_scene::shape_params::MeshFieldParams;

/// Rows of a level.
const LEVEL_ROWS: usize = 3;
/// The row of a level whose last number is the first texel.
const FIRST_TEXEL: usize = 1;

/// The rows of bricks whose first texel is 0.
pub fn mesh_field(levels: &BrickLevels) -> PreparedParams {
    let mut rows = vec![[levels.all().len() as f64, levels.scale(), f64::from(levels.mark()), 0.0]];
    let bounds = levels.bounds();
    rows.extend([bounds.center(), bounds.half()].map(|v| [v.x, v.y, v.z, 0.0]));
    let mut first = 0;
    for bricks in levels.all() {
        rows.extend(level_rows(bricks, first));
        first += bricks.texels.len();
    }
    PreparedParams::new(&MeshFieldParams {}, rows)
}

/// There are fewer texels than 32-bit floats count exactly, see `MAX_BRICK_TEXELS`.
fn level_rows(bricks: &Bricks, first: usize) -> [[f64; 4]; LEVEL_ROWS] {
    let [x, y, z] = bricks.grid.origin.to_array();
    let [nx, ny, nz] = bricks.grid.cells.map(f64::from);
    let voxel = bricks.grid.voxel;
    [[x, y, z, voxel], [nx, ny, nz, first as f64], [f64::from(bricks.first_brick), 0.0, 0.0, 0.0]]
}

/// Calls `row` for each row of the payload whose last number is a first texel, counted from that of the finest level.
pub fn first_texels(levels: &BrickLevels, mut row: impl FnMut(usize)) {
    // Four rows come before: the bounding sphere, the number of levels, the bounds.
    (0..levels.all().len()).for_each(|level| row(4 + LEVEL_ROWS * level + FIRST_TEXEL));
}
