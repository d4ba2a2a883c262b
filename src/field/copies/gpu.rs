//! Instancers as the GPU reads them. The counterparts are in `shaders/copy/instancer.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use super::hash::Channel;
use super::instancer::{FlatDynamic, FlatInstancer, FlatLattice, FlatMask, Place, Placement};
use super::noise::Coordinate;
use crate::hierarchy::Hierarchy;
use isolith_scene::{DynamicKind, MAX_DYNAMICS, MAX_MASKS, MAX_PALETTE, MAX_TYPES, MaskKind};

/// A mask.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuCopyMask {
    kind: u32,
    inverted: u32,
    key: u32,
    join: u32,
    params: [f32; 4],
    whole: [i32; 2],
    fraction: [f32; 2],
    curve: [f32; 4],
}

/// A motion.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuCopyDynamic {
    kind: u32,
    key: u32,
    whole: i32,
    fraction: f32,
    a: [f32; 4],
    b: [f32; 4],
    place_whole: [i32; 3],
    channel: u32,
    place: [f32; 3],
    padding: u32,
    rows: [[f32; 4]; 3],
}

/// An instancer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuInstancer {
    local: [[f32; 4]; 3],
    low: [i32; 3],
    seed: u32,
    high: [i32; 3],
    probability: f32,
    anchor: [i32; 3],
    mask_count: u32,
    spacing: [f32; 3],
    most_factor: f32,
    anchor_place: [f32; 3],
    stagger: f32,
    jitter: [f32; 3],
    dynamic_count: u32,
    offset_min: [f32; 3],
    type_count: u32,
    offset_max: [f32; 3],
    palette_count: u32,
    rotation_min: [f32; 3],
    uniform_scale: u32,
    rotation_max: [f32; 3],
    tree_count: u32,
    scale_min: [f32; 3],
    roughness: f32,
    scale_max: [f32; 3],
    emission: f32,
    hue: f32,
    saturation: f32,
    value: f32,
    /// First row of the places.
    pub first_place: u32,
    bounds_low: [f32; 3],
    /// First row of the tree.
    pub first_row: u32,
    bounds_high: [f32; 3],
    /// Visits that a cell counts as in queries of the scene.
    pub cell_visits: u32,
    reach: [f32; 3],
    reach_at_rest: f32,
    shares: [f32; MAX_TYPES],
    spheres: [[f32; 4]; MAX_TYPES],
    palette: [u32; MAX_PALETTE],
    masks: [GpuCopyMask; MAX_MASKS],
    dynamics: [GpuCopyDynamic; MAX_DYNAMICS],
    roots: [u32; MAX_TYPES],
    /// The components of the types, for queries of the scene; `u32::MAX` for none.
    pub components: [u32; MAX_TYPES],
}

/// Cells farther from the anchor than this are on no walk.
const FARTHEST: i32 = 1 << 30;
/// Bounds beyond this count as endless, so that no infinity meets a zero.
const ENDLESS: f64 = 1e18;

/// The instancer for an eye at a point of the world. Its places, if it has any, begin at row `first_row` of
/// [`gpu_places`].
pub fn gpu_instancer(instancer: &FlatInstancer, eye: DVec3, first_row: u32) -> GpuInstancer {
    let local_from_world = instancer.world_from_local.inverse();
    let local_eye = local_from_world.transform_point3(eye);
    let (lattice, nodes) = match &instancer.placement {
        Placement::Lattice(lattice) => (*lattice, 0),
        Placement::List(list) => (FlatLattice::ONE, list.tree.nodes.len() as u32),
    };
    let anchor = lattice.nearest(local_eye);
    let place = if nodes > 0 { DVec3::ZERO } else { lattice.place(anchor) };
    let relative = |cell: [i32; 3]| [0, 1, 2].map(|i| cell[i].saturating_sub(anchor[i]).clamp(-FARTHEST, FARTHEST));
    let m = local_from_world.matrix3;
    let off = local_eye - place;
    let local = [0, 1, 2].map(|i| floats([m.x_axis[i], m.y_axis[i], m.z_axis[i], off[i]]));
    let bounds = instancer.bounds();
    let bound = |v: DVec3| vector((v - place).clamp(DVec3::splat(-ENDLESS), DVec3::splat(ENDLESS)));
    let long = DVec3::from_array([0, 1, 2].map(|i| if lattice.is_long(i) { 1.0 } else { 0.0 }));
    let variation = &instancer.variation;
    let radians = |angles: [f64; 3]| floats(angles.map(f64::to_radians));
    let mut gpu = GpuInstancer {
        local,
        low: relative(lattice.low),
        seed: instancer.seed,
        high: relative(lattice.high),
        probability: instancer.probability as f32,
        anchor,
        mask_count: instancer.masks.len() as u32,
        spacing: vector(lattice.spacing),
        most_factor: instancer.least_scale().recip() as f32,
        anchor_place: vector(place),
        stagger: lattice.stagger as f32,
        jitter: vector(long * lattice.spacing * variation.looseness),
        dynamic_count: instancer.dynamics.len() as u32,
        offset_min: floats(variation.offset_min),
        type_count: instancer.shares.len() as u32,
        offset_max: floats(variation.offset_max),
        palette_count: instancer.palette.len() as u32,
        rotation_min: radians(variation.rotation_min),
        uniform_scale: variation.uniform.into(),
        rotation_max: radians(variation.rotation_max),
        tree_count: nodes,
        scale_min: floats(variation.scale_min),
        roughness: instancer.material.roughness as f32,
        scale_max: floats(variation.scale_max),
        emission: instancer.material.emission as f32,
        hue: instancer.material.hue as f32,
        saturation: instancer.material.saturation as f32,
        value: instancer.material.value as f32,
        first_place: first_row + 2 * nodes,
        bounds_low: bound(bounds.min),
        first_row,
        bounds_high: bound(bounds.max),
        reach: vector(instancer.reach),
        // Slightly more, for the rounding of places.
        reach_at_rest: (1.001 * instancer.reach_at_rest) as f32,
        ..GpuInstancer::zeroed()
    };
    fill_lists(&mut gpu, instancer, place);
    gpu
}

/// Fills what an instancer has several of. `place` is that of the anchor.
fn fill_lists(gpu: &mut GpuInstancer, instancer: &FlatInstancer, place: DVec3) {
    for (to, share) in gpu.shares.iter_mut().zip(&instancer.shares) {
        *to = *share as f32;
    }
    for (to, (center, radius)) in gpu.spheres.iter_mut().zip(&instancer.spheres) {
        *to = floats([center.x, center.y, center.z, *radius]);
    }
    for (to, material) in gpu.palette.iter_mut().zip(&instancer.palette) {
        *to = *material;
    }
    if let Placement::List(list) = &instancer.placement {
        gpu.roots.fill(Hierarchy::NONE);
        gpu.roots[..list.roots.len()].copy_from_slice(&list.roots);
    }
    for (to, mask) in gpu.masks.iter_mut().zip(&instancer.masks) {
        *to = gpu_mask(mask, place, gpu.first_row);
    }
    for (at, (to, dynamic)) in gpu.dynamics.iter_mut().zip(&instancer.dynamics).enumerate() {
        *to = gpu_dynamic(dynamic, at, place);
    }
}

/// The places of a list, and the tree over them; of a lattice the images of its masks.
pub fn gpu_places(instancer: &FlatInstancer) -> &[[f32; 4]] {
    match &instancer.placement {
        Placement::List(list) => &list.rows,
        Placement::Lattice(_) => &instancer.mask_rows,
    }
}

/// The rows of a tree and the places below it, those of each type together.
pub(super) fn place_rows<'a>(of_types: impl Iterator<Item = &'a [Place]>, tree: &Hierarchy) -> Vec<[f32; 4]> {
    let mut rows = Vec::with_capacity(4 * tree.nodes.len());
    for node in &tree.nodes {
        // Outward, so that no copy is lost by rounding.
        let slack = 1e-6 * node.bounds.min.abs().max(node.bounds.max.abs()).max_element();
        let bounds = node.bounds.expanded(slack);
        for (corner, word) in [(bounds.min, node.link), (bounds.max, node.axis)] {
            let [x, y, z] = vector(corner);
            rows.push([x, y, z, f32::from_bits(word)]);
        }
    }
    for (kind, place) in of_types.enumerate().flat_map(|(kind, places)| places.iter().map(move |place| (kind, place))) {
        let [x, y, z] = vector(place.position);
        rows.push([x, y, z, place.up as f32]);
        rows.push(floats(place.rotation.to_array()));
        let [a, b, c] = place.cell.map(|i| f32::from_bits(i as u32));
        rows.push([a, b, c, f32::from_bits(kind as u32)]);
    }
    rows
}

/// `place` is that of the anchor; rows of images begin at `first_row`.
fn gpu_mask(mask: &FlatMask, place: DVec3, first_row: u32) -> GpuCopyMask {
    // Only noise uses them.
    let at = [place.x, place.z].map(|v| Coordinate::new(v * mask.params[2]));
    let mut gpu = GpuCopyMask {
        kind: mask.kind as u32,
        inverted: mask.inverted.into(),
        key: mask.key,
        join: mask.join as u32,
        params: floats(mask.params),
        whole: at.map(|c| c.whole),
        fraction: at.map(fraction),
        curve: [-1.0, 0.0, 0.0, 0.0],
    };
    if let Some(curve) = &mask.curve {
        // Rows are fewer than the whole numbers that f32 holds.
        gpu.curve = floats([curve.slope, curve.empty[0], curve.empty[1], f64::from(first_row + mask.curve_row)]);
    }
    match &mask.image {
        Some(image) => {
            let [a, b, width, height] = mask.params;
            let (mut at, size) = (image.origin + DVec2::new(a * place.x, b * place.z), DVec2::new(width, height));
            if image.tiled {
                at -= size * (at / size).floor();
            }
            gpu.whole = [(first_row + image.first_row) as i32, if image.tiled { MASK_TILED } else { MASK_ONCE }];
            gpu.fraction = floats(at.to_array());
        }
        None if mask.kind == MaskKind::Image => gpu.whole = [0, MASK_MISSING],
        None => {}
    }
    gpu
}

/// How the image of a mask lies, as in `shaders/copy/masks.wgsl`.
const MASK_ONCE: i32 = 0;
const MASK_TILED: i32 = 1;
const MASK_MISSING: i32 = 2;

fn gpu_dynamic(dynamic: &FlatDynamic, at: usize, place: DVec3) -> GpuCopyDynamic {
    let mut rows = dynamic.rows;
    if dynamic.kind == DynamicKind::Wind {
        // The source, relative to the anchor as positions are.
        rows[2] -= place;
    }
    let place = [0, 1, 2].map(|i| dynamic.place[i].moved(dynamic.rows[i].dot(place)));
    GpuCopyDynamic {
        kind: dynamic.kind as u32,
        key: dynamic.key,
        whole: dynamic.phase.whole,
        fraction: fraction(dynamic.phase),
        a: floats(dynamic.a),
        b: floats(dynamic.b),
        place_whole: place.map(|c| c.whole),
        channel: Channel::Dynamics as u32 + at as u32,
        place: place.map(fraction),
        padding: 0,
        rows: [0, 1, 2].map(|i| floats([rows[i].x, rows[i].y, rows[i].z, dynamic.c[i]])),
    }
}

/// The fraction in f32; below 1 after rounding as well.
fn fraction(at: Coordinate) -> f32 {
    (at.fraction as f32).min(1.0 - f32::EPSILON)
}

fn vector(v: DVec3) -> [f32; 3] {
    floats(v.to_array())
}

fn floats<const N: usize>(values: [f64; N]) -> [f32; N] {
    values.map(|v| v as f32)
}
