//! An instancer at one moment, ready for evaluation. Lengths are in its own space.

use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::mask_curve::FlatCurve;
use super::noise::Coordinate;
use crate::hierarchy::Hierarchy;
use isolith_geometry::{Aabb, singular_values};
use isolith_scene::{DynamicKind, MaskJoin, MaskKind, MaterialVariation, NodeId, ShareImage, Variation};

/// An instancer with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatInstancer {
    /// Its node.
    pub id: NodeId,
    /// World from its own space.
    pub world_from_local: DAffine3,
    /// Where its copies stand.
    pub placement: Placement,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Share of the places where a copy stands, before masks.
    pub probability: f64,
    /// Masks of existence.
    pub masks: Vec<FlatMask>,
    /// The pixels of their images and the samples of their curves as the GPU reads them, where it evaluates masks: in
    /// lattices.
    pub mask_rows: Arc<Vec<[f32; 4]>>,
    /// Ranges of the transforms.
    pub variation: Variation,
    /// How much materials differ.
    pub material: MaterialVariation,
    /// Materials of which each copy takes one: indices into [`crate::FlatScene::materials`]; empty for those of the type.
    pub palette: Vec<u32>,
    /// For each type the sum of the shares of the types up to it; the last one is 1.
    pub shares: Vec<f64>,
    /// Motions of each copy.
    pub dynamics: Vec<FlatDynamic>,
    /// Bounding sphere of the content of each type, in the space of a copy: center and radius.
    pub spheres: Vec<(DVec3, f64)>,
    /// How far the content of a copy may reach from its place along each axis, at any time.
    pub reach: DVec3,
    /// How far it may reach from where the copy stands at rest, with its looseness and its offset.
    pub reach_at_rest: f64,
}

/// Where copies stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Placement {
    /// In cells, without a list.
    Lattice(FlatLattice),
    /// In a list.
    List(Arc<PlaceList>),
}

/// A regular lattice of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatLattice {
    /// The first cell along each axis; [`FlatLattice::ENDLESS`] with its sign turned for none.
    pub low: [i32; 3],
    /// The last cell along each axis; [`FlatLattice::ENDLESS`] for none.
    pub high: [i32; 3],
    /// From one cell to the next, along each axis.
    pub spacing: DVec3,
    /// Place of the cell 0, 0, 0.
    pub shift: DVec3,
    /// Half the shift along X between even and odd rows, in meters; 0 for a grid.
    pub stagger: f64,
}

/// Places that do not follow a rule, in the order of the types of their copies.
#[derive(Clone, Debug)]
pub struct PlaceList {
    /// The places.
    pub places: Vec<Place>,
    /// A tree over the boxes of the copies there: of the trees over those of each type.
    pub tree: Hierarchy,
    /// The nodes at which the trees of the types begin; [`Hierarchy::NONE`] for types without a copy.
    pub roots: Vec<u32>,
    /// Both as the GPU reads them: made once, not for each frame.
    pub rows: Vec<[f32; 4]>,
}

impl PartialEq for PlaceList {
    fn eq(&self, other: &Self) -> bool {
        self.places == other.places
    }
}

/// A place of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Identity of the copy, for its random numbers: stays when others come or go.
    pub cell: [i32; 3],
    /// Where it stands.
    pub position: DVec3,
    /// How it is turned there.
    pub rotation: DQuat,
    /// Cosine of the slope of the ground there: 1 on level ground, and where there is none.
    pub up: f64,
}

/// A mask. The GPU reads the parameters as they are, see `shaders/copy/masks.wgsl`.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatMask {
    /// Its kind.
    pub kind: MaskKind,
    /// Whether it is turned around.
    pub inverted: bool,
    /// How it joins those before it.
    pub join: MaskJoin,
    /// Seed of its noise.
    pub key: u32,
    /// Noise: threshold, softness, 1 / size. Height: from, to, softness. Slope: cosines of both angles. Radius: inner,
    /// outer. Image: pixels per meter along X and Z, columns and rows.
    pub params: [f64; 4],
    /// What becomes of its share; none for what changes nothing.
    pub curve: Option<Arc<FlatCurve>>,
    /// Its first row among [`FlatInstancer::mask_rows`].
    pub curve_row: u32,
    /// Its image.
    pub image: Option<FlatMaskImage>,
}

/// The image of a mask.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatMaskImage {
    /// Its pixels.
    pub shares: Arc<ShareImage>,
    /// Its first row among [`FlatInstancer::mask_rows`].
    pub first_row: u32,
    /// Where the instancer's origin is in the image, in pixels from its upper left corner.
    pub origin: DVec2,
    /// Whether it repeats.
    pub tiled: bool,
}

/// A motion. The GPU reads the parameters as they are, see `shaders/copy/dynamics.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatDynamic {
    /// Its kind.
    pub kind: DynamicKind,
    /// Seed of its noise.
    pub key: u32,
    /// Periods since the start.
    pub phase: Coordinate,
    /// Axis of unit length, or amplitude along each axis; then an angle in radians, a radius or an amplitude.
    pub a: [f64; 4],
    /// Wind: steady share, softness, flutter in radians, radius. Others: spread over the copies, octaves, amplitude.
    pub b: [f64; 4],
    /// Wind: how far it blows away from its source, share of the radius without falloff, gusts per meter.
    pub c: [f64; 3],
    /// Noise coordinates at the instancer's origin; those of a point are this plus `rows` times the point.
    pub place: [Coordinate; 3],
    /// See `place`. The third one of wind is the place of its source.
    pub rows: [DVec3; 3],
}

/// Most places of a list.
pub const MAX_PLACES: usize = 1 << 18;

impl FlatLattice {
    /// The last cell of an axis without end.
    pub const ENDLESS: i32 = i32::MAX;

    /// Place of a cell, before anything is varied.
    pub fn place(&self, cell: [i32; 3]) -> DVec3 {
        let at = DVec3::from_array(cell.map(f64::from)) * self.spacing + self.shift;
        let odd = if cell[2] & 1 == 1 { self.stagger } else { -self.stagger };
        at + DVec3::X * odd
    }

    /// Whether it has no end along the axis.
    pub fn is_endless(&self, axis: usize) -> bool {
        self.high[axis] == Self::ENDLESS
    }

    /// Whether it has more than one cell along the axis.
    pub fn is_long(&self, axis: usize) -> bool {
        self.high[axis] != self.low[axis]
    }

    /// Whether the cell is one of it.
    pub fn contains(&self, cell: [i32; 3]) -> bool {
        (0..3).all(|i| self.low[i] <= cell[i] && cell[i] <= self.high[i])
    }

    /// Bounds of the places of all cells.
    pub fn bounds(&self) -> Aabb {
        let end = |axis: usize, cell: i32, endless: f64| {
            if self.is_endless(axis) { endless } else { f64::from(cell) * self.spacing[axis] + self.shift[axis] }
        };
        let min = DVec3::from_array([0, 1, 2].map(|axis| end(axis, self.low[axis], f64::NEG_INFINITY)));
        let max = DVec3::from_array([0, 1, 2].map(|axis| end(axis, self.high[axis], f64::INFINITY)));
        Aabb { min: min - DVec3::X * self.stagger, max: max + DVec3::X * self.stagger }
    }

    /// The cell nearest to a point along each axis, within the limits.
    pub fn nearest(&self, point: DVec3) -> [i32; 3] {
        let at = (point - self.shift) / self.spacing;
        [0, 1, 2].map(|axis| (at[axis].round() as i32).clamp(self.low[axis], self.high[axis]))
    }

    /// Number of cells; `None` without end.
    pub fn count(&self) -> Option<u64> {
        (0..3).try_fold(1_u64, |all, axis| {
            let count = u64::from(self.high[axis].abs_diff(self.low[axis])) + 1;
            if self.is_endless(axis) { None } else { Some(all.saturating_mul(count)) }
        })
    }
}

impl FlatInstancer {
    /// Bounds of all copies, in its own space.
    pub fn bounds(&self) -> Aabb {
        match &self.placement {
            Placement::Lattice(lattice) => {
                let places = lattice.bounds();
                Aabb { min: places.min - self.reach, max: places.max + self.reach }
            }
            Placement::List(list) => list.tree.nodes.first().map_or(Aabb::EMPTY, |root| root.bounds),
        }
    }

    /// Bounds of all copies, in the world.
    pub fn world_bounds(&self) -> Aabb {
        let bounds = self.bounds();
        if bounds.is_empty() {
            return bounds;
        }
        if bounds.is_finite() {
            return bounds.transformed(&self.world_from_local);
        }
        // Axes without end: exact where the world's axes are those of the instancer, else without end everywhere.
        let m = self.world_from_local.matrix3;
        let is_straight = [m.x_axis, m.y_axis, m.z_axis].iter().enumerate().all(|(i, column)| {
            let mut off = *column;
            off[i] = 0.0;
            off == DVec3::ZERO
        });
        if !is_straight {
            return Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let scale = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
        let [a, b] = [bounds.min, bounds.max].map(|v| v * scale + self.world_from_local.translation);
        Aabb { min: a.min(b), max: a.max(b) }
    }

    /// The least factor on lengths of its space.
    pub fn least_scale(&self) -> f64 {
        singular_values(&self.world_from_local.matrix3).0
    }
}
