//! Instancers: their children are types, of which they place copies, in any number.
//!
//! Each copy has an id: its cell in the lattice, or its place in a list. What sets it apart from the others follows
//! from the seed and this id, so that a copy stays the same when others come or go.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use super::limits::{ANGLE, COPIES, NO_LIMITS, POSITION, SEED, SPACING, UNIT};
use super::node_id::NodeId;
use super::params::{Variants, choices, nested_params, nested_variants, param_kinds, param_struct, slot_params};
use super::response_curve::ResponseCurve;
use super::texture_image::TextureImage;
use super::{Limits, MaterialId};

/// Most masks of one instancer.
pub const MAX_MASKS: usize = 8;
/// Most types of one instancer.
pub const MAX_TYPES: usize = 32;
/// Most materials in the palette of one instancer.
pub const MAX_PALETTE: usize = 64;

param_kinds! {
    /// Where copies stand, in the instancer's own space.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
    pub enum Lattice;

    /// The kind of a lattice, without its parameters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum LatticeKind;

    /// In rows along X, Y and Z.
    Grid = "Grid" {
        /// How many along each axis; 0 is without end in both directions.
        counts: [u32; 3] = [5, 1, 5], COPIES.fixed();
        /// From one copy to the next, along each axis.
        spacing: [f64; 3] = [2.0; 3], SPACING;
    }
    /// In rows along X, every other row shifted by half a spacing, as in a honeycomb; in layers along Y.
    Hexagonal = "Hexagonal" {
        /// How many along X, layers along Y, and rows along Z; 0 is without end in both directions.
        counts: [u32; 3] = [5, 1, 5], COPIES.fixed();
        /// From one copy to its six neighbors.
        spacing: f64 = 2.0, SPACING;
        /// From one layer to the next.
        height: f64 = 2.0, SPACING;
    }
    /// In rings around the Y axis; each copy faces outward along X.
    Polar = "Polar" {
        /// How many in the innermost ring.
        count: u32 = 12, COPIES.fixed();
        /// How many rings.
        rings: u32 = 1, RINGS.fixed();
        /// Radius of the innermost ring.
        radius: f64 = 3.0, SPACING;
        /// From one ring to the next; copies keep their distance along the rings.
        spacing: f64 = 2.0, SPACING;
    }
    /// Spread over the surface of another node, nowhere closer than the minimum distance.
    Scatter = "Scatter on surface" {
        /// Copies per square meter.
        density: f64 = 1.0, DENSITY;
        /// No two copies are closer than this.
        minimum_distance: f64 = 0.0, DISTANCE;
    }
    /// Along the curve of a tube.
    Curve = "Along curve" {
        /// From one copy to the next, along the curve.
        spacing: f64 = 1.0, SPACING;
    }
}

impl LatticeKind {
    /// The lattice with its default parameters.
    pub fn default_lattice(self) -> Lattice {
        self.with_defaults()
    }
}

impl Variants for Lattice {
    fn variants() -> Vec<(Self, &'static str, &'static str)> {
        LatticeKind::ALL.iter().map(|kind| (kind.with_defaults(), kind.label(), kind.help())).collect()
    }

    fn variant(&self) -> usize {
        self.kind() as usize
    }
}

nested_variants!(Lattice, "Distribution", "Where the copies stand.");

/// How copies of a grid find the target's surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Snap {
    /// Not at all.
    #[default]
    Off,
    /// Along the instancer's Y axis, to the first surface from above.
    Down,
    /// To the nearest point of the surface.
    Nearest,
}

impl Snap {
    const ALL: [Self; 3] = [Self::Off, Self::Down, Self::Nearest];

    fn label(self) -> &'static str {
        match self {
            Self::Off => "Off",
            Self::Down => "Along Y",
            Self::Nearest => "Nearest surface",
        }
    }

    fn help(self) -> &'static str {
        match self {
            Self::Off => "Copies stand where the lattice has them.",
            Self::Down => "Copies fall from above along the instancer's Y axis, onto the target.",
            Self::Nearest => "Copies move to the nearest point of the target's surface.",
        }
    }
}

choices!(Snap);

param_kinds! {
    /// A share from 0 to 1 for each place.
    #[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
    pub enum Mask;

    /// The kind of a mask, without its parameters. The number is the code that the GPU reads.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[repr(u32)]
    pub enum MaskKind;

    /// Patches of noise.
    Noise = "Noise" {
        /// Size of the patches.
        size: f64 = 8.0, SPACING;
        /// Share of the ground that is left empty.
        threshold: f64 = 0.5, UNIT;
        /// Width of the border between empty and full, in values of the noise.
        softness: f64 = 0.2, UNIT;
        /// Another number, other patches.
        seed: u32 = 1, SEED;
    }
    /// By height above the instancer's origin.
    Height = "Height" {
        /// Nothing stands below this.
        from: f64 = 0.0, POSITION;
        /// Nothing stands above this.
        to: f64 = 10.0, POSITION;
        /// Height over which the mask goes from empty to full, inward from both ends.
        softness: f64 = 0.5, DISTANCE;
    }
    /// By the slope of the ground that copies stand on.
    Slope = "Slope" {
        /// Full up to this angle from the horizontal.
        from: f64 = 25.0, SLOPE;
        /// Empty from this angle on.
        to: f64 = 40.0, SLOPE;
    }
    /// By the distance from the Y axis.
    Radius = "Radius" {
        /// Full up to this distance.
        inner: f64 = 5.0, DISTANCE;
        /// Empty from this distance on.
        outer: f64 = 10.0, DISTANCE;
    }
    /// By an image that lies on the ground plane, its upper edge toward −Z: the brighter, the more.
    Image = "Image" {
        /// An image larger than 256 pixels is made smaller.
        #[serde(default)]
        image: Attachment<TextureImage> = Attachment::NONE, NO_LIMITS;
        /// Of the image along X.
        width: f64 = 20.0, SPACING;
        /// Of the image along Z.
        length: f64 = 20.0, SPACING;
        /// Where its middle is; its height is ignored.
        offset: [f64; 3] = [0.0; 3], POSITION;
        /// Whether it repeats; else nothing stands beside it.
        tiled: bool = false, NO_LIMITS;
    }
}

impl MaskKind {
    /// The mask with its default parameters.
    pub fn default_mask(self) -> Mask {
        self.with_defaults()
    }
}

/// How a mask joins those before it. The number is the code that the GPU reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[repr(u32)]
pub enum MaskJoin {
    /// Their product.
    #[default]
    Multiply,
    /// Their sum, at most 1.
    Add,
    /// Those before it less this one, at least 0.
    Subtract,
    /// The least of both.
    Minimum,
    /// The greatest of both.
    Maximum,
}

impl MaskJoin {
    const ALL: [Self; 5] = [Self::Multiply, Self::Add, Self::Subtract, Self::Minimum, Self::Maximum];

    fn label(self) -> &'static str {
        match self {
            Self::Multiply => "Multiply",
            Self::Add => "Add",
            Self::Subtract => "Subtract",
            Self::Minimum => "Minimum",
            Self::Maximum => "Maximum",
        }
    }

    fn help(self) -> &'static str {
        match self {
            Self::Multiply => "Copies stand where all masks let them.",
            Self::Add => "Copies stand also where this mask lets them.",
            Self::Subtract => "Copies are taken away where this mask is full.",
            Self::Minimum => "The least of this mask and those before it counts.",
            Self::Maximum => "The greatest of this mask and those before it counts.",
        }
    }

    /// Of the share so far with that of the next mask.
    pub fn joined(self, share: f64, next: f64) -> f64 {
        match self {
            Self::Multiply => share * next,
            Self::Add => (share + next).min(1.0),
            Self::Subtract => (share - next).max(0.0),
            Self::Minimum => share.min(next),
            Self::Maximum => share.max(next),
        }
    }

    /// Whether nothing stands where this mask is empty.
    pub fn only_cuts(self) -> bool {
        matches!(self, Self::Multiply | Self::Minimum)
    }
}

choices!(MaskJoin);

/// A mask in an instancer's list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaskSlot {
    /// Full where the mask is empty, and the other way round.
    #[serde(default, skip_serializing_if = "is_default")]
    pub inverted: bool,
    /// How it joins the masks before it; the first one is the start.
    #[serde(default, skip_serializing_if = "is_default")]
    pub join: MaskJoin,
    /// What becomes of its share, after it is inverted.
    #[serde(default, skip_serializing_if = "is_default")]
    pub curve: ResponseCurve,
    /// The mask.
    pub mask: Mask,
}

slot_params!(MaskSlot, mask, {
    /// Full where the mask is empty, and the other way round.
    inverted: bool = false;
    /// How it joins the masks before it; the first one is the start.
    join: MaskJoin = MaskJoin::Multiply;
});

impl From<Mask> for MaskSlot {
    fn from(mask: Mask) -> Self {
        Self { inverted: false, join: MaskJoin::default(), curve: ResponseCurve::default(), mask }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

param_struct! {
    /// How much copies differ from the types.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct Variation {
        /// Share of its cell within which a copy may stand anywhere: 0 in the middle, 1 in the whole cell.
        looseness: f64 = 0.0, UNIT;
        /// Least displacement.
        offset_min: [f64; 3] = [0.0; 3], POSITION;
        /// Greatest displacement.
        offset_max: [f64; 3] = [0.0; 3], POSITION;
        /// Least rotation around X, Y and Z, in degrees.
        rotation_min: [f64; 3] = [0.0; 3], ANGLE;
        /// Greatest rotation around X, Y and Z, in degrees.
        rotation_max: [f64; 3] = [0.0; 3], ANGLE;
        /// Least factor on the size, along each axis.
        scale_min: [f64; 3] = [1.0; 3], COPY_SCALE;
        /// Greatest factor on the size, along each axis.
        scale_max: [f64; 3] = [1.0; 3], COPY_SCALE;
        /// The same random number for the scales of all axes.
        uniform: bool = true, NO_LIMITS;
    }
}
nested_params!(Variation);

param_struct! {
    /// How much the materials of copies differ from those of the types.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct MaterialVariation {
        /// Of the base color's hue to either side: 1 is once around.
        hue: f64 = 0.0, HALF;
        /// Of the base color's saturation to either side, as a share.
        saturation: f64 = 0.0, UNIT;
        /// Of the base color's value to either side, as a share.
        value: f64 = 0.0, UNIT;
        /// Of the roughness to either side.
        roughness: f64 = 0.0, UNIT;
        /// Of the emission, downward, as a share.
        emission: f64 = 0.0, UNIT;
    }
}
nested_params!(MaterialVariation);

param_struct! {
    /// Places copies of its children.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields, default)]
    pub struct Instancer [
        /// The surface that copies stand on, or the tube whose curve they follow. An id of no other node has no effect.
        target: Option<NodeId> = None;
        /// Masks of existence.
        masks: Vec<MaskSlot> = Vec::new();
        /// Materials of which each copy takes one instead of all those of its type; none keeps them.
        palette: Vec<MaterialId> = Vec::new();
    ] {
        /// Where the copies stand.
        lattice: Lattice = LatticeKind::Grid.with_defaults(), NO_LIMITS;
        /// Another number, other copies.
        seed: u32 = 1, SEED;
        /// Keeps the seed when seeds are drawn anew.
        seed_locked: bool = false, NO_LIMITS.fixed();
        /// Share of the places where a copy stands, before masks.
        probability: f64 = 1.0, UNIT;
        /// How copies find the surface of the target.
        snap: Snap = Snap::Off, NO_LIMITS;
        /// How far copies turn from upright to the normal of the ground that they stand on.
        align: f64 = 0.0, UNIT;
        /// How much copies differ from the types.
        variation: Variation = Variation::default(), NO_LIMITS;
        /// How much their materials differ.
        material: MaterialVariation = MaterialVariation::default(), NO_LIMITS;
    }
}

impl Instancer {
    /// A grid of limited counts.
    pub fn grid(counts: [u32; 3], spacing: [f64; 3]) -> Self {
        Self { lattice: Lattice::Grid { counts, spacing }, ..Self::default() }
    }
}

/// Rings of copies.
const RINGS: Limits = Limits::new([1.0, 8.0], [1.0, 1_000.0], "").whole();
/// Copies per square meter.
const DENSITY: Limits = Limits::new([0.01, 10.0], [1e-6, 1e6], "/m²");
/// Distances, 0 included.
const DISTANCE: Limits = Limits::new([0.0, 10.0], [0.0, 1e9], "m");
/// Angles of the ground.
const SLOPE: Limits = Limits::new([0.0, 90.0], [0.0, 180.0], "°");
/// Factors on the size of copies: 0 is a copy that is not there.
const COPY_SCALE: Limits = Limits::new([0.1, 3.0], [0.0, 1e4], "");
/// Shares of a hue circle to either side.
const HALF: Limits = Limits::new([0.0, 0.5], [0.0, 0.5], "");
