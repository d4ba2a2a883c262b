//! A mesh as distance bricks.
//!
//! | file | holds |
//! |---|---|
//! | `resolution` | sizes of voxels |
//! | `solid` | the pieces of a mesh, closed, and which are sheets |
//! | `columns` | inside or outside, for every sample |
//! | `facets` | triangles in voxels, and the nearest of them |
//! | `samples` | the samples of a brick |
//! | `content` | all bricks near the surface |
//! | `paint` | the looks of the samples around the surface |
//! | `key` | what bricks are made of, for files of them |
//! | `watch` | progress and cancellation |
//!
//! Surfaces that masks cut out count as whole.

mod columns;
mod content;
mod facets;
mod key;
mod paint;
mod resolution;
mod samples;
mod solid;
mod watch;

pub use key::bricks_key;
pub use resolution::{usual_resolution, voxel_for};

use super::TriangleMesh;
use columns::Columns;
use content::Contents;
use isolith_bricks::{BrickContent, BrickError, BrickGrid, Bricks, CELL_VOXELS, MAX_BRICK_TEXELS, RESOLUTIONS, encode};
use isolith_geometry::Aabb;
use paint::painted;
use samples::{Distances, SHEET_HALF};
use solid::Solid;
use watch::{Watch, watched};

/// Bricks, and what their maker has to say of the mesh.
#[derive(Debug)]
pub struct Voxelized {
    /// The bricks.
    pub bricks: Bricks,
    /// What is not as the mesh says, as texts for the user.
    pub remarks: Vec<String>,
}

/// Bricks of a mesh. `progress` is told the share that is done at least every 100 ms, and stops the work by returning
/// false.
///
/// # Errors
/// There are too many, the mesh has no triangles with an area, or `progress` returned false.
pub fn bricks_of(mesh: &TriangleMesh, voxel: f64, progress: &mut dyn FnMut(f32) -> bool) -> Result<Bricks, BrickError> {
    voxelized(mesh, voxel, progress).map(|made| made.bricks)
}

/// The same, with remarks.
///
/// # Errors
/// As [`bricks_of`].
pub fn voxelized(
    mesh: &TriangleMesh,
    voxel: f64,
    progress: &mut dyn FnMut(f32) -> bool,
) -> Result<Voxelized, BrickError> {
    watched(progress, |watch| made(mesh, voxel, watch))
}

fn made(mesh: &TriangleMesh, voxel: f64, watch: &Watch) -> Result<Voxelized, BrickError> {
    let bounds = mesh.bounds;
    if !(voxel > 0.0 && voxel.is_finite()) {
        return Err(BrickError::Voxel);
    }
    if bounds.is_empty() || !bounds.is_finite() {
        return Err(BrickError::Empty);
    }
    let across = (2.0 * bounds.half()).max_element() / voxel;
    // A little more than the limit, for sizes that were rounded.
    if across > f64::from(RESOLUTIONS[1]) * 1.001 {
        return Err(BrickError::TooFine { voxels: across.min(1e18) as u64 });
    }
    let bounds = bounds.expanded(f64::from(SHEET_HALF) * voxel);
    let grid = BrickGrid::around(&bounds, voxel);
    let least = grid.cell_count() + grid.cell_count().div_ceil(4);
    if least > MAX_BRICK_TEXELS {
        return Err(BrickError::TooLarge { texels: least });
    }
    let solid = Solid::new(mesh, &grid);
    watch.advance(0.15);
    watch.check()?;
    if solid.closed.is_empty() && solid.thin.is_empty() {
        return Err(BrickError::Empty);
    }
    let size = [0, 1].map(|i| (grid.cells[i] * CELL_VOXELS) as usize + 1);
    let columns = Columns::new(size, &solid.chain);
    watch.advance(0.05);
    let distances = Distances { solid: &solid, columns };
    let (mut bricks, order) = encoded(grid, bounds, &Contents::new(grid, &distances, watch)?, watch)?;
    if mesh.has_looks() {
        bricks.looks = Some(painted(mesh, &bricks, &order, &distances, watch)?);
    }
    let mut remarks = Vec::new();
    if solid.has_sheets {
        remarks.push(format!(
            "has surfaces that bound no space; they get a thickness of {} voxels, {:.3} mm",
            2.0 * SHEET_HALF,
            2e3 * f64::from(SHEET_HALF) * voxel
        ));
    }
    Ok(Voxelized { bricks, remarks })
}

/// The bricks, and those with samples in their order.
fn encoded(
    grid: BrickGrid,
    bounds: Aabb,
    contents: &Contents,
    watch: &Watch,
) -> Result<(Bricks, Vec<[u32; 3]>), BrickError> {
    let mut order = Vec::new();
    let bricks = encode(grid, bounds, &mut |corner| contents.corner(corner) * grid.voxel, &mut |brick| {
        watch.check()?;
        let content = contents.brick(brick);
        if matches!(content, BrickContent::Near { .. }) {
            order.push(brick);
        }
        Ok(content)
    })?;
    Ok((bricks, order))
}
