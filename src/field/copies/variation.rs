//! What sets a copy apart: existence, type, place, material. Counterpart of `shaders/copy/variation.wgsl`.

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use super::dynamics::{CopyMotion, copy_motion};
use super::hash::{Channel, copy_randoms};
use super::instancer::{FlatInstancer, Placement};
use super::masks::copy_masks;

/// A copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Copy {
    /// Its cell, or the id of its place.
    pub cell: [i32; 3],
    /// Its type: index among the types of the instancer.
    pub kind: u32,
    /// Where its origin is, in the space of the instancer.
    pub position: DVec3,
    /// How it is turned.
    pub rotation: DQuat,
    /// Its size along its own axes.
    pub scale: DVec3,
    /// Its dynamics, of which its place has taken effect already.
    pub motion: CopyMotion,
}

/// A copy whose scale is less than this along an axis is not there.
const LEAST_SCALE: f64 = 1e-6;

impl Copy {
    /// Instancer's space from the space of the copy.
    pub fn instancer_from_copy(&self) -> DAffine3 {
        DAffine3::from_mat3_translation(
            DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.scale),
            self.position,
        )
    }
}

/// A copy before its size, its rotation and its motion are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CopyAtRest {
    cell: [i32; 3],
    kind: u32,
    /// Where it stands when it does not move.
    pub place: DVec3,
    turned: DQuat,
}

/// The copy of a cell; `None` if there is none.
pub fn copy_of_cell(instancer: &FlatInstancer, cell: [i32; 3]) -> Option<Copy> {
    copy_moved(instancer, copy_at_rest(instancer, cell)?)
}

/// Where the copy of a cell stands; `None` if there is none.
pub(super) fn copy_at_rest(instancer: &FlatInstancer, cell: [i32; 3]) -> Option<CopyAtRest> {
    let Placement::Lattice(lattice) = &instancer.placement else { return None };
    let base = lattice.place(cell);
    let kind = copy_kind(instancer, cell, base, 1.0)?;
    // The looseness is a share of the cell, along the axes that have several.
    let cell_size = DVec3::from_array([0, 1, 2].map(|i| if lattice.is_long(i) { lattice.spacing[i] } else { 0.0 }));
    Some(copy_placed(instancer, cell, kind, (base, DQuat::IDENTITY), cell_size))
}

/// The copy at a place of the list; `None` if there is none.
pub fn copy_of_place(instancer: &FlatInstancer, place: usize) -> Option<Copy> {
    let Placement::List(list) = &instancer.placement else { return None };
    let place = list.places[place];
    let kind = copy_kind(instancer, place.cell, place.position, place.up)?;
    let placed = (place.position, place.rotation);
    copy_moved(instancer, copy_placed(instancer, place.cell, kind, placed, DVec3::ZERO))
}

/// The type of a copy at a place with this cosine of the slope of the ground; `None` if there is no copy.
fn copy_kind(instancer: &FlatInstancer, cell: [i32; 3], base: DVec3, up: f64) -> Option<u32> {
    let [exists, kind, _] = copy_randoms(instancer.seed, cell, Channel::Choice as u32);
    if exists >= instancer.probability * copy_masks(&instancer.masks, base, up) {
        return None;
    }
    instancer.shares.iter().position(|sum| kind < *sum).map(|kind| kind as u32)
}

/// A value between these ends, by a random number for each axis.
fn between(least: [f64; 3], most: [f64; 3], at: DVec3) -> DVec3 {
    DVec3::from_array(least) + (DVec3::from_array(most) - DVec3::from_array(least)) * at
}

/// A copy that exists, of type `kind`, off its base.
fn copy_placed(
    instancer: &FlatInstancer,
    cell: [i32; 3],
    kind: u32,
    (base, turned): (DVec3, DQuat),
    cell_size: DVec3,
) -> CopyAtRest {
    let variation = &instancer.variation;
    let randoms = |channel: Channel| DVec3::from_array(copy_randoms(instancer.seed, cell, channel as u32));
    let jitter = (randoms(Channel::Place) - 0.5) * variation.looseness * cell_size;
    let offset = between(variation.offset_min, variation.offset_max, randoms(Channel::Offset));
    CopyAtRest { cell, kind, place: base + jitter + turned * offset, turned }
}

/// The copy in its size, turned and moved; `None` if its size is none.
pub(super) fn copy_moved(instancer: &FlatInstancer, at_rest: CopyAtRest) -> Option<Copy> {
    let CopyAtRest { cell, kind, place, turned } = at_rest;
    let variation = &instancer.variation;
    let randoms = |channel: Channel| DVec3::from_array(copy_randoms(instancer.seed, cell, channel as u32));
    let angles = between(variation.rotation_min, variation.rotation_max, randoms(Channel::Rotation));
    let [x, y, z] = angles.to_array().map(f64::to_radians);
    let own = DQuat::from_euler(EulerRot::YXZ, y, x, z);
    let sizes = randoms(Channel::Scale);
    let sizes = if variation.uniform { DVec3::splat(sizes.x) } else { sizes };
    let scale = between(variation.scale_min, variation.scale_max, sizes);
    let motion = copy_motion(&instancer.dynamics, instancer.seed, cell, place);
    let scale = scale * motion.scale;
    (scale.min_element() >= LEAST_SCALE).then(|| Copy {
        cell,
        kind,
        position: place + motion.translation,
        rotation: motion.rotation * turned * own,
        scale,
        motion,
    })
}

/// Changes of the material of a copy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyMaterial {
    /// The material instead of that of the type: index into [`crate::FlatScene::materials`].
    pub replaced: Option<u32>,
    /// Added to the hue of the base color, in rounds.
    pub hue: f64,
    /// Factor on the saturation of the base color.
    pub saturation: f64,
    /// Factor on the value of the base color.
    pub value: f64,
    /// Added to the roughness.
    pub roughness: f64,
    /// Factor on the emission.
    pub emission: f64,
}

/// How the material of a copy differs from that of its type.
pub fn copy_material(instancer: &FlatInstancer, copy: &Copy) -> CopyMaterial {
    let [hue, saturation, value] = copy_randoms(instancer.seed, copy.cell, Channel::Color as u32);
    let [roughness, emission, _] = copy_randoms(instancer.seed, copy.cell, Channel::Surface as u32);
    let [_, _, choice] = copy_randoms(instancer.seed, copy.cell, Channel::Choice as u32);
    let palette = &instancer.palette;
    let side = |random: f64| 2.0 * random - 1.0;
    let by = &instancer.material;
    CopyMaterial {
        replaced: palette.get((choice * palette.len() as f64) as usize).copied(),
        hue: by.hue * side(hue) + copy.motion.hue,
        saturation: 1.0 + by.saturation * side(saturation),
        value: 1.0 + by.value * side(value),
        roughness: by.roughness * side(roughness),
        emission: (1.0 - by.emission * emission) * copy.motion.emission,
    }
}
