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
//! | `detail` | which of them tell more than those of the next coarser level |
//! | `paint` | the looks of the samples around the surface |
//! | `key` | what bricks are made of, for files of them |
//! | `sample` | a small mesh that tells one maker from another |
//! | `watch` | progress and cancellation |
//!
//! Surfaces that masks cut out count as whole.

mod columns;
mod content;
mod detail;
mod facets;
mod key;
mod paint;
mod resolution;
mod sample;
mod samples;
mod solid;
mod watch;

pub use key::{bricks_key, maker_key};
pub use resolution::{usual_resolution, voxel_for};

use std::sync::Arc;

use super::TriangleMesh;
use columns::Columns;
use content::Contents;
use detail::Detail;
use facets::LevelScale;
use isolith_bricks::{BrickError, BrickGrid, BrickSource, Bricks, CELL_VOXELS, MAX_BRICK_TEXELS, encode, in_levels};
use isolith_geometry::Aabb;
use paint::painted;
use samples::{Distances, SHEET_HALF};
use solid::Solid;
use watch::{Watch, watched};

/// Bricks, and what their maker has to say of the mesh.
#[derive(Debug)]
pub struct Voxelized {
    /// The bricks of the finest level, with all coarser ones.
    pub bricks: Arc<Bricks>,
    /// What is not as the mesh says, as texts for the user.
    pub remarks: Vec<String>,
}

/// Bricks of a mesh in one size of voxels, all of them. `progress` is told the share that is done at least every 100 ms, and
/// stops the work by returning false.
///
/// # Errors
/// There are too many, the mesh has no triangles with an area, or `progress` returned false.
pub fn bricks_of(mesh: &TriangleMesh, voxel: f64, progress: &mut dyn FnMut(f32) -> bool) -> Result<Bricks, BrickError> {
    watched(progress, |watch| {
        let maker = Maker::new(mesh, voxel, watch)?;
        watch.begin(1.0);
        maker.level(voxel, None)
    })
}

/// Bricks of a mesh in voxels of this size and all coarser ones, each level without what the next one tells, and remarks.
///
/// # Errors
/// As [`bricks_of`].
pub fn voxelized(
    mesh: &TriangleMesh,
    voxel: f64,
    progress: &mut dyn FnMut(f32) -> bool,
) -> Result<Voxelized, BrickError> {
    watched(progress, |watch| {
        let maker = Maker::new(mesh, voxel, watch)?;
        let bricks = in_levels(&mesh.bounds, voxel, &mut |own, coarser| {
            // A level takes about four times as long as the next coarser one.
            watch.begin(0.75 * (voxel / own).powi(2));
            maker.level(own, coarser)
        })?;
        let mut remarks = Vec::new();
        if maker.solid.has_sheets {
            remarks.push(format!(
                "has surfaces that bound no space; they get a thickness of {} voxels, {:.3} mm",
                2.0 * SHEET_HALF,
                2e3 * f64::from(SHEET_HALF) * voxel
            ));
        }
        Ok(Voxelized { bricks, remarks })
    })
}

/// What all levels are made of, in units of the finest voxels.
struct Maker<'a> {
    mesh: &'a TriangleMesh,
    solid: Solid,
    columns: Columns,
    finest: BrickGrid,
    watch: &'a Watch,
}

impl<'a> Maker<'a> {
    fn new(mesh: &'a TriangleMesh, voxel: f64, watch: &'a Watch) -> Result<Self, BrickError> {
        BrickGrid::checked(&mesh.bounds, voxel)?;
        let finest = BrickGrid::around(&bounds_of(mesh, voxel), voxel);
        let least = finest.cell_count() + finest.cell_count().div_ceil(4);
        if least > MAX_BRICK_TEXELS {
            return Err(BrickError::TooLarge { texels: least });
        }
        watch.begin(1.0);
        let solid = Solid::new(mesh, &finest);
        watch.advance(0.15);
        watch.check()?;
        if solid.is_empty() {
            return Err(BrickError::Empty);
        }
        let size = [0, 1].map(|i| (finest.cells[i] * CELL_VOXELS) as usize + 1);
        let columns = Columns::new(size, &solid.chain);
        watch.advance(0.05);
        Ok(Self { mesh, solid, columns, finest, watch })
    }

    /// The bricks of a level that `coarser` does not stand in for.
    fn level(&self, voxel: f64, coarser: Option<Arc<Bricks>>) -> Result<Bricks, BrickError> {
        // All levels have the same surface, of the same thickness.
        let bounds = bounds_of(self.mesh, self.finest.voxel);
        let grid = BrickGrid::around(&bounds, voxel);
        let first = ((grid.origin - self.finest.origin) / self.finest.voxel).round().as_ivec3();
        let scale = LevelScale { step: (voxel / self.finest.voxel).round() as i32, first };
        let distances = Distances::new(&self.solid, &self.columns, scale);
        let (mesh, has_looks, finest) = (self.mesh, self.mesh.has_looks(), self.finest.voxel);
        let detail = coarser.as_deref().map(|coarser| Detail { mesh, has_looks, coarser, finest });
        let contents = Contents::new(grid, &distances, detail, self.watch)?;
        let corner = |corner: [u32; 3]| contents.corner(corner) * grid.voxel;
        let brick = |brick: [u32; 3]| contents.brick(brick);
        let source = BrickSource { grid, bounds, coarser: coarser.clone(), corner: &corner, brick: &brick };
        let (mut bricks, order) = encode(source)?;
        if has_looks {
            bricks.looks = Some(painted(self.mesh, &bricks, &order, &distances, self.watch)?);
        }
        Ok(bricks)
    }
}

/// A box around the surface: sheets have a thickness.
fn bounds_of(mesh: &TriangleMesh, voxel: f64) -> Aabb {
    mesh.bounds.expanded(f64::from(SHEET_HALF) * voxel)
}
