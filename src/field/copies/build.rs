//! From the instancer of a scene to one that can be evaluated.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::dynamics::{Envelope, copy_envelope};
use super::gpu::place_rows;
use super::instancer::{FlatInstancer, FlatLattice, FlatMask, Place, PlaceList, Placement};
use super::masks::mask_cuts;
use super::moved_scene::node_dynamics;
use super::variation::{Copy, copy_of_place};
use super::walk::copy_sphere;
use crate::hierarchy::Hierarchy;
use isolith_geometry::Aabb;
use isolith_scene::{Instancer, Lattice, Mask, Node, Variation};

/// A type of an instancer: how often it is chosen, and its bounds in the space of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyType {
    /// In relation to the others.
    pub weight: f64,
    /// Its bounds.
    pub bounds: Aabb,
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
    let is_listed = is_listed(instancer);
    // Places of a list may be turned anyhow.
    let tilt = if is_listed { PI } else { variation_tilt(&variation) + envelope.tilt };
    let content = content_reach(types, DVec3::from_array(variation.scale_max) * envelope.scale, tilt);
    let [least, most] = [variation.offset_min, variation.offset_max].map(DVec3::from_array);
    let offset = least.abs().max(most.abs());
    let offset = if is_listed { DVec3::splat(offset.length()) } else { offset };
    let (masks, mask_rows) = flat_masks(instancer);
    let mut flat = FlatInstancer {
        id: node.id,
        world_from_local,
        placement: Placement::Lattice(masked_lattice(instancer)),
        seed: instancer.seed,
        probability: instancer.probability,
        masks,
        mask_rows: Arc::new(if is_listed { Vec::new() } else { mask_rows }),
        variation,
        material: instancer.material,
        palette,
        shares: shares.collect(),
        dynamics,
        spheres: types.iter().map(|one| (one.bounds.center(), one.bounds.half().length())).collect(),
        reach: content + offset + envelope.displacement,
        reach_at_rest: reach_at_rest(types, &variation, envelope),
    };
    match &flat.placement {
        Placement::Lattice(lattice) if !is_listed => {
            let size = DVec3::from_array([0, 1, 2].map(|i| if lattice.is_long(i) { lattice.spacing[i] } else { 0.0 }));
            flat.reach += 0.5 * variation.looseness * size;
        }
        _ => flat.placement = listed(&flat, places, envelope),
    }
    flat
}

/// The masks, with the pixels of their images and the samples of their curves.
fn flat_masks(instancer: &Instancer) -> (Vec<FlatMask>, Vec<[f32; 4]>) {
    let (mut masks, mut rows) = (Vec::new(), Vec::new());
    for slot in &instancer.masks {
        let first = rows.len() as u32;
        let mut mask = FlatMask::new(slot, [first; 2]);
        if let Some(image) = &mask.image {
            rows.extend_from_slice(&image.shares.rows);
        }
        if let Some(curve) = &mask.curve {
            mask.curve_row = rows.len() as u32;
            rows.extend(curve.samples.chunks_exact(4).map(|four| [four[0], four[1], four[2], four[3]]));
        }
        masks.push(mask);
    }
    (masks, rows)
}

/// The lattice without the cells that a mask leaves empty on all sides.
fn masked_lattice(instancer: &Instancer) -> FlatLattice {
    let mut lattice = FlatLattice::of(&instancer.lattice).unwrap_or(FlatLattice::ONE);
    for at in (0..instancer.masks.len()).filter(|at| mask_cuts(&instancer.masks, *at)) {
        match instancer.masks[at].mask {
            Mask::Radius { outer, .. } => [0, 2].into_iter().for_each(|axis| lattice.keep(axis, [-outer, outer])),
            Mask::Height { from, to, .. } => lattice.keep(1, [from, to]),
            Mask::Image { ref image, width, length, offset, tiled: false } if image.content().is_some() => {
                for (axis, size) in [(0, width), (2, length)] {
                    lattice.keep(axis, [-0.5, 0.5].map(|end| offset[axis] + end * size));
                }
            }
            Mask::Noise { .. } | Mask::Slope { .. } | Mask::Image { .. } => {}
        }
    }
    lattice
}

/// Greatest angle between the Y axes of a copy and of its type, by the ranges of its rotation.
fn variation_tilt(variation: &Variation) -> f64 {
    let most = |axis: usize| variation.rotation_min[axis].abs().max(variation.rotation_max[axis].abs());
    (most(0) + most(2)).to_radians()
}

/// How far the content of types reaches from the origin of a copy along each axis, turned about Y at will and tilted by
/// up to `tilt`.
fn content_reach(types: &[CopyType], scale: DVec3, tilt: f64) -> DVec3 {
    let [mut beside, mut above]: [f64; 2] = [0.0; 2];
    for one in types {
        let far = one.bounds.min.abs().max(one.bounds.max.abs()) * scale;
        (beside, above) = (beside.max(far.x.hypot(far.z)), above.max(far.y));
    }
    let sine = if tilt < FRAC_PI_2 { tilt.sin() } else { 1.0 };
    let all = beside.hypot(above);
    let [beside, above] = [beside + above * sine, above + beside * sine].map(|reach| reach.min(all));
    DVec3::new(beside, above, beside)
}

/// How far the bounding spheres of copies reach from where these stand at rest, turned and moved in any way.
fn reach_at_rest(types: &[CopyType], variation: &Variation, envelope: Envelope) -> f64 {
    let sizes = [variation.scale_min, variation.scale_max].map(|ends| DVec3::from_array(ends).abs().max_element());
    let of = |one: &CopyType| one.bounds.center().length() + one.bounds.half().length();
    types.iter().map(of).fold(0.0, f64::max) * sizes[0].max(sizes[1]) * envelope.scale + envelope.displacement
}

/// Whether its copies stand in a list, not in cells.
pub fn is_listed(instancer: &Instancer) -> bool {
    FlatLattice::of(&instancer.lattice).is_none() || instancer.snap != isolith_scene::Snap::Off
}

/// The GPU places copies in f32: so much of a radius is more than that may move them.
const BOX_SLACK: f64 = 1e-4;

/// The places that exist, with a tree over everything that a copy there may reach at any time.
fn listed(flat: &FlatInstancer, places: Vec<Place>, envelope: Envelope) -> Placement {
    let all = PlaceList { places, tree: Hierarchy::default(), roots: Vec::new(), rows: Vec::new() };
    let all = Arc::new(all);
    let at_rest = FlatInstancer { placement: Placement::List(all.clone()), dynamics: Vec::new(), ..flat.clone() };
    let is_still = flat.dynamics.is_empty();
    let mut of_types = vec![(Vec::new(), Vec::new()); flat.shares.len()];
    for (at, place) in all.places.iter().enumerate() {
        if let Some(copy) = copy_of_place(&at_rest, at) {
            let (places, boxes) = &mut of_types[copy.kind as usize];
            places.push(*place);
            boxes.push(box_at_any_time(&at_rest, &copy, envelope, is_still));
        }
    }
    let trees: Vec<Hierarchy> = of_types.iter().map(|(_, boxes)| Hierarchy::build(boxes)).collect();
    let counts: Vec<u32> = of_types.iter().map(|(places, _)| places.len() as u32).collect();
    let (tree, roots) = Hierarchy::joined(&trees, &counts);
    let rows = place_rows(of_types.iter().map(|(places, _)| places.as_slice()), &tree);
    let places = of_types.into_iter().flat_map(|(places, _)| places).collect();
    Placement::List(Arc::new(PlaceList { places, tree, roots, rows }))
}

/// What a copy may reach at any time. `copy` is at rest.
fn box_at_any_time(instancer: &FlatInstancer, copy: &Copy, envelope: Envelope, is_still: bool) -> Aabb {
    let (center, radius) = copy_sphere(instancer, copy);
    // Dynamics turn the middle of the sphere about the copy's own, about Y by any angle, and scale both.
    let off = center - copy.position;
    let tilted = off.length() * 2.0 * (0.5 * envelope.tilt.min(PI)).sin();
    let scaled = (off.length() + radius) * (envelope.scale - 1.0).max(0.0);
    let radius = radius * (1.0 + BOX_SLACK) + tilted + scaled + envelope.displacement;
    if is_still {
        return Aabb::from_center_half(center, DVec3::splat(radius));
    }
    let around = radius + off.x.hypot(off.z);
    Aabb::from_center_half(copy.position + DVec3::Y * off.y, DVec3::new(around, radius, around))
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

impl FlatLattice {
    /// Keeps the cells whose places lie between two coordinates, and at least one.
    fn keep(&mut self, axis: usize, [from, to]: [f64; 2]) {
        if !self.is_long(axis) {
            return;
        }
        let off = if axis == 0 { self.stagger } else { 0.0 };
        let cell = |at: f64| (at - self.shift[axis]) / self.spacing[axis];
        let [from, to] = [cell(from - off).floor() as i32, cell(to + off).ceil() as i32];
        let [low, high] = [self.low[axis], self.high[axis]];
        self.low[axis] = from.clamp(low, high);
        self.high[axis] = to.clamp(self.low[axis], high);
    }
}
