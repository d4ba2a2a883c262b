//! Modifiers: changes of a node's own field, or of that of its subtree, before its transform applies. The table below
//! is the only list of them: the enum, the file format, the inspector, the tests and the golden sheet follow from it.
//!
//! To add one: an entry here, its row in `field/modifier_table.rs`, its effect on bounds and steps in
//! `field/modify.rs`, `mod_name_…` in `field/eval/modifier.rs` and in `shaders/mod/`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::attachment::Attachment;
use super::heights::Heights;
use super::limits::{
    AMPLITUDE, ANGLE, BLEND_RADIUS, COPIES, CURVATURE, DISPLACEMENT, NO_LIMITS, POSITION, SIZE, SPACING, TAPER,
    THICKNESS, TILE,
};
use super::params::{param_kinds, slot_params};
use super::{Axis, Limits};

/// Most modifiers of one node.
pub const MAX_MODIFIERS: usize = 32;

param_kinds! {
    /// A modifier with its parameters, in the node's own space.
    #[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
    pub enum Modifier;

    /// The kind of a modifier, without its parameters. The number is the code that the GPU reads.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[repr(u32)]
    pub enum ModifierKind;

    /// The same on the other side of a plane through the origin, for each axis that is on.
    Mirror = "Mirror" {
        /// Across which planes: through the origin, at right angles to the axis.
        axes: [bool; 3] = [true, false, false], NO_LIMITS.fixed();
        /// Blend radius at the seam; 0 is a sharp edge.
        blend: f64 = 0.0, BLEND_RADIUS;
    }
    /// Copies at equal distances along X, Y and Z. Exact for any content, also where it reaches into other cells.
    Repeat = "Array" {
        /// How many along each axis: 1 is no repetition, 0 is without end in both directions.
        counts: [u32; 3] = [3, 1, 1], COPIES;
        /// From one copy to the next, along each axis.
        spacing: [f64; 3] = [1.5; 3], SPACING;
        /// Y and Z: how far each copy along X is moved besides, where that axis has no repetition of its own.
        /// X: how far each row along Y is shifted, like bricks.
        offset: [f64; 3] = [0.0; 3], POSITION;
        /// Each copy is turned around its Y by so much more than the one before.
        turn: f64 = 0.0, ANGLE;
        /// Every other copy is mirrored, along each axis that is on.
        mirrored: [bool; 3] = [false; 3], NO_LIMITS;
        /// First cell of a block that is left out, counted from 0; nothing is left out where `carve_to` is 0.
        carve_from: [u32; 3] = [0; 3], COPIES;
        /// The cell after the last one of that block, along each axis.
        carve_to: [u32; 3] = [0; 3], COPIES;
    }
    /// Copies around the Y axis.
    Polar = "Radial array" {
        /// How many all around.
        count: u32 = 6, AROUND.fixed();
        /// How far the content is moved out along X first.
        radius: f64 = 1.0, SIZE;
        /// Every other copy is mirrored.
        mirrored: bool = false, NO_LIMITS;
    }
    /// Copies of copies, each smaller, turned and moved as the one before.
    Recursion = "Recursion" {
        /// How often, the original counted.
        count: u32 = 4, RECURSION;
        /// From a copy's origin to that of the next one, in the copy's own space.
        offset: [f64; 3] = [0.0, 0.8, 0.0], POSITION;
        /// Turns each copy, in degrees around X, Y and Z.
        rotation: [f64; 3] = [0.0, 0.0, 30.0], ANGLE;
        /// Size of each copy relative to the one before.
        scale: f64 = 0.7, RECURSION_SCALE;
        /// Each copy stands on both sides of the plane at right angles to the axis; what crosses the plane is cut there.
        mirrored: [bool; 3] = [true, false, false], NO_LIMITS;
    }
    /// Turned around the Y axis, more with every meter of height.
    Twist = "Twist" {
        /// By how much for each meter.
        angle: f64 = 90.0, CURVATURE;
    }
    /// What lies along X is bent to an arc toward Y; lengths along the X axis stay.
    Bend = "Bend" {
        /// By how much for each meter along X; negative bends down.
        angle: f64 = 45.0, CURVATURE;
    }
    /// Wider or narrower in X and Z with height.
    Taper = "Taper" {
        /// How much of the width at the origin is added for each meter of height.
        change: f64 = -0.4, TAPER;
    }
    /// Cut open at the origin and drawn apart, along each axis.
    Elongate = "Elongate" {
        /// By how much it grows along each axis.
        length: [f64; 3] = [1.0, 0.0, 0.0], SIZE;
    }
    /// Grown by a radius, its edges rounded with it.
    Round = "Round" {
        /// How far the surface moves outward.
        radius: f64 = 0.1, THICKNESS;
    }
    /// Hollow: only a wall around the surface stays, or several within each other.
    Onion = "Shell (solidify)" {
        /// Of the wall.
        thickness: f64 = 0.05, THICKNESS;
        /// How many walls, inward from the surface.
        walls: u32 = 1, WALLS;
        /// Between the middles of two walls.
        spacing: f64 = 0.2, SPACING;
    }
    /// The surface is moved in and out by waves along X, Y and Z.
    Waves = "Wave" {
        /// How far at most.
        amplitude: f64 = 0.05, AMPLITUDE;
        /// From one wave to the next.
        length: f64 = 0.4, SPACING;
        /// Where in the wave the origin is.
        phase: f64 = 0.0, ANGLE;
    }
    /// The surface is moved in and out by noise.
    Noise = "Noise" {
        /// How far at most.
        amplitude: f64 = 0.08, AMPLITUDE;
        /// Of the largest bumps.
        size: f64 = 0.5, SPACING;
        /// Each further layer has half the size and half the height.
        octaves: u32 = 3, OCTAVES;
        /// Another number, another noise.
        seed: u32 = 1, SEED;
    }
    /// The surface is moved in and out by an image, which is repeated without end, every other time mirrored.
    Displacement = "Displace (image)" {
        /// Its pixels are heights; an image larger than 256 pixels is made smaller. Nothing happens without one.
        #[serde(default)]
        image: Attachment<Heights> = Attachment::NONE, NO_LIMITS;
        /// How far what is white moves outward, or inward where it is negative; what is black stays.
        height: f64 = 0.1, DISPLACEMENT;
        /// Width of the image.
        tile: f64 = 1.0, TILE;
        /// The image is seen upright from where this axis points to, its middle at the origin.
        axis: Axis = Axis::Y, NO_LIMITS;
    }
}

impl ModifierKind {
    /// The modifier with its default parameters.
    pub fn default_modifier(self) -> Modifier {
        self.with_defaults()
    }
}

/// Copies around an axis: each is evaluated as a shape of its own.
const AROUND: Limits = Limits::new([2.0, 32.0], [1.0, 1024.0], "").whole();
/// Copies of a recursion.
const RECURSION: Limits = Limits::new([1.0, 8.0], [1.0, 12.0], "").whole();
/// Relative size of a copy of a recursion.
const RECURSION_SCALE: Limits = Limits::new([0.2, 1.0], [0.05, 1.0], "");
/// Walls of an onion.
const WALLS: Limits = Limits::new([1.0, 8.0], [1.0, 64.0], "").whole();
/// Layers of noise.
const OCTAVES: Limits = Limits::new([1.0, 6.0], [1.0, 8.0], "").whole();
/// Seeds.
const SEED: Limits = Limits::new([0.0, 100.0], [0.0, 65_535.0], "").whole();

/// A modifier in a node's list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModifierSlot {
    /// Whether it does anything.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub enabled: bool,
    /// What it does.
    pub modifier: Modifier,
}

slot_params!(ModifierSlot, modifier, {
    /// Whether it does anything.
    enabled: bool = true;
});

impl From<Modifier> for ModifierSlot {
    fn from(modifier: Modifier) -> Self {
        Self { enabled: true, modifier }
    }
}

fn yes() -> bool {
    true
}

fn is_true(value: &bool) -> bool {
    *value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attached, ParamValue};

    #[test]
    fn every_parameter_can_be_read_and_written() {
        for &kind in ModifierKind::ALL {
            let mut modifier = kind.default_modifier();
            assert_eq!(modifier.kind(), kind);
            let values = modifier.values();
            assert_eq!(values.len(), kind.params().len());
            for (i, value) in values.iter().enumerate() {
                let image = Attachment::drawn("dots.png", [2, 2], |x, y| (100 * x + y) as u8);
                let changed = match *value {
                    ParamValue::File(_) => ParamValue::File(Attached::Heights(image)),
                    ParamValue::Choice(_) => ParamValue::Choice("z"),
                    ParamValue::Scalar(v) => ParamValue::Scalar(v + 0.25),
                    ParamValue::Vector(v) => ParamValue::Vector(v + 0.25),
                    ParamValue::Count(v) => ParamValue::Count(v + 1),
                    ParamValue::Counts(v) => ParamValue::Counts(v.map(|n| n + 1)),
                    ParamValue::Flag(v) => ParamValue::Flag(!v),
                    ParamValue::Flags(v) => ParamValue::Flags(v.map(|f| !f)),
                    ParamValue::Rotation(_) | ParamValue::List(_) | ParamValue::Text(_) => {
                        unreachable!("no modifier has one")
                    }
                };
                assert!(modifier.set_value(i, changed.clone()));
                assert_eq!(modifier.values()[i], changed);
                let other =
                    if matches!(value, ParamValue::Flag(_)) { ParamValue::Scalar(0.0) } else { ParamValue::Flag(true) };
                assert!(!modifier.set_value(i, other), "{kind:?} {i} takes a value of another type");
            }
            assert!(!modifier.set_value(values.len(), ParamValue::Scalar(1.0)));
        }
    }
}
