//! From the instancer of a scene to one that can be evaluated.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::dynamics::copy_envelope;
use super::hash::copy_hash;
use super::instancer::{FlatInstancer, FlatLattice, FlatMask, Place, PlaceList, Placement};
use super::moved_scene::node_dynamics;
use super::variation::copy_of_place;
use crate::hierarchy::Hierarchy;
use isolith_geometry::Aabb;
use isolith_scene::{Instancer, Lattice, Mask, MaskSlot, Node};

/// A type of an instancer: how often it is chosen, and its bounding sphere in the space of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyType {
    /// In relation to the others.
    pub weight: f64,
    /// Center of the sphere.
    pub center: DVec3,
    /// Radius of the sphere.
    pub radius: f64,
}

/// The instancer of a node at `time`. `types` have a positive weight together; `places` are those of a lattice that is
/// a list, see [`is_listed`]; `palette` are indices into the materials of the flat scene.
pub fn flat_instancer(
    node: &Node,
    instancer: &Instancer,
    world_from_local: DAffine3,
    time: f64,
    types: &[CopyType],
    places: Vec<Place>,
    palette: Vec<u32>,
) -> FlatInstancer {
    let sum: f64 = types.iter().map(|one| one.weight).sum();
    let mut so_far = 0.0;
    let shares = types.iter().map(|one| {
        so_far += one.weight;
        // Rounded as the GPU rounds it, so that both choose alike; the last one is exactly 1.
        f64::from((so_far / sum) as f32)
    });
    let dynamics = node_dynamics(node, time, instancer.seed);
    let variation = instancer.variation;
    let envelope = copy_envelope(&dynamics);
    let scale = DVec3::from_array(variation.scale_max).max_element() * envelope.scale;
    let content = types.iter().map(|one| one.center.length() + one.radius).fold(0.0, f64::max);
    let [least, most] = [variation.offset_min, variation.offset_max].map(DVec3::from_array);
    let offset = least.abs().max(most.abs()).length();
    let mut flat = FlatInstancer {
        id: node.id,
        world_from_local,
        placement: Placement::Lattice(FlatLattice::of(&instancer.lattice).unwrap_or(FlatLattice::ONE)),
        seed: instancer.seed,
        probability: instancer.probability,
        masks: instancer.masks.iter().map(FlatMask::new).collect(),
        variation,
        material: instancer.material,
        palette,
        shares: shares.collect(),
        dynamics,
        spheres: types.iter().map(|one| (one.center, one.radius)).collect(),
        reach: 0.0,
    };
    let jitter = match &flat.placement {
        Placement::Lattice(lattice) => {
            let size = DVec3::from_array([0, 1, 2].map(|i| if lattice.is_long(i) { lattice.spacing[i] } else { 0.0 }));
            0.5 * variation.looseness * size.length()
        }
        Placement::List(_) => 0.0,
    };
    flat.reach = jitter + offset + envelope.displacement + content * scale;
    if is_listed(instancer) {
        flat.placement = listed(&flat, places, content * scale + envelope.displacement + offset);
    }
    flat
}

/// Whether its copies stand in a list, not in cells.
pub fn is_listed(instancer: &Instancer) -> bool {
    FlatLattice::of(&instancer.lattice).is_none() || instancer.snap != isolith_scene::Snap::Off
}

/// The places that exist, with a tree over everything that a copy there may reach at any time.
fn listed(flat: &FlatInstancer, places: Vec<Place>, reach: f64) -> Placement {
    let list = |places: Vec<Place>, boxes: &[Aabb]| {
        Placement::List(Arc::new(PlaceList { places, tree: Hierarchy::build(boxes) }))
    };
    let all = FlatInstancer { placement: list(places.clone(), &[]), ..flat.clone() };
    let exist = places.into_iter().enumerate().filter(|(at, _)| copy_of_place(&all, *at).is_some());
    let places: Vec<Place> = exist.map(|(_, place)| place).collect();
    let boxes: Vec<Aabb> =
        places.iter().map(|place| Aabb::from_center_half(place.position, DVec3::splat(reach))).collect();
    list(places, &boxes)
}

impl FlatLattice {
    /// A single cell.
    pub const ONE: Self = Self { low: [0; 3], high: [0; 3], spacing: DVec3::ONE, shift: DVec3::ZERO, stagger: 0.0 };

    /// The lattice in cells; `None` for places of a list.
    pub fn of(lattice: &Lattice) -> Option<Self> {
        let (counts, spacing, stagger) = match *lattice {
            Lattice::Grid { counts, spacing } => (counts, DVec3::from_array(spacing), 0.0),
            Lattice::Hexagonal { counts, spacing, height } => {
                let rows = spacing * 0.75_f64.sqrt();
                (counts, DVec3::new(spacing, height, rows), if counts[2] == 1 { 0.0 } else { 0.25 * spacing })
            }
            Lattice::Polar { .. } | Lattice::Scatter { .. } | Lattice::Curve { .. } => return None,
        };
        // Counted from the middle, so that copies stay when the counts change.
        let low = counts.map(|n| if n == 0 { -Self::ENDLESS } else { -((n as i32 - 1) / 2) });
        let high = counts.map(|n| if n == 0 { Self::ENDLESS } else { n as i32 / 2 });
        let even = DVec3::from_array(counts.map(|n| if n > 0 && n % 2 == 0 { 0.5 } else { 0.0 }));
        Some(Self { low, high, spacing, shift: -even * spacing, stagger })
    }
}

impl FlatMask {
    /// A mask, ready for evaluation.
    pub fn new(slot: &MaskSlot) -> Self {
        let (key, params) = match slot.mask {
            Mask::Noise { size, threshold, softness, seed } => {
                (copy_hash(seed, [0; 3], 0x2000)[0], [threshold, softness.max(1e-6), 1.0 / size, 0.0])
            }
            Mask::Height { from, to, softness } => (0, [from, to, softness.max(1e-6), 0.0]),
            Mask::Slope { from, to } => {
                let [from, to] = [from, to].map(|angle| angle.to_radians().cos());
                (0, [from.max(to + 1e-6), to, 0.0, 0.0])
            }
            Mask::Radius { inner, outer } => (0, [inner, outer.max(inner + 1e-6), 0.0, 0.0]),
        };
        Self { kind: slot.mask.kind(), inverted: slot.inverted, key, params }
    }
}
