//! Modifiers: what a node does to itself, or to all below it, before it takes its place. The table below is
//! the only list of them: the enum, the file format, the inspector, the tests and the golden sheet follow
//! from it.
//!
//! To add one: an entry here, what it does to bounds and steps in `flat/modify.rs`, how many rows it has in
//! `flat/arrays.rs`, `mod_name_…` in `flat/eval/modifier.rs` and in `shaders/mod/`.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::attached::Attached;
use super::attachment::Attachment;
use super::heights::Heights;
use super::limits::{
    AMPLITUDE, ANGLE, BLEND_RADIUS, COPIES, COUNT, CURVATURE, DISPLACEMENT, POSITION, SIZE, SPACING, TAPER, THICKNESS,
    TILE,
};
use super::{Axis, Limits, whole};

/// Most modifiers of one node.
pub const MAX_MODIFIERS: usize = 32;

/// The value of a modifier's parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ModifierValue {
    /// A number.
    Scalar(f64),
    /// A number for each axis.
    Vector(DVec3),
    /// A whole number.
    Count(u32),
    /// A whole number for each axis.
    Counts([u32; 3]),
    /// On or off.
    Flag(bool),
    /// On or off for each axis.
    Flags([bool; 3]),
    /// One of the axes.
    Axis(Axis),
    /// A file.
    File(Attached),
}

/// A Rust type that a parameter can have.
trait Field: for<'de> Deserialize<'de> {
    fn to_value(&self) -> ModifierValue;
    fn from_value(value: ModifierValue) -> Option<Self>;
    /// From a file.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)
    }
}

macro_rules! fields {
    ($($ty:ty = $variant:ident $(by $read:path)?;)+) => { $(
        impl Field for $ty {
            fn to_value(&self) -> ModifierValue {
                ModifierValue::$variant(*self)
            }
            fn from_value(value: ModifierValue) -> Option<Self> {
                if let ModifierValue::$variant(v) = value { Some(v) } else { None }
            }
            $( fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $read(deserializer)
            } )?
        }
    )+ };
}

fields! {
    f64 = Scalar;
    u32 = Count by whole::read;
    [u32; 3] = Counts by whole::read_three;
    bool = Flag;
    [bool; 3] = Flags;
    Axis = Axis;
}

impl Field for [f64; 3] {
    fn to_value(&self) -> ModifierValue {
        ModifierValue::Vector((*self).into())
    }
    fn from_value(value: ModifierValue) -> Option<Self> {
        if let ModifierValue::Vector(v) = value { Some(v.to_array()) } else { None }
    }
}

impl Field for Attachment<Heights> {
    fn to_value(&self) -> ModifierValue {
        ModifierValue::File(Attached::Heights(self.clone()))
    }
    fn from_value(value: ModifierValue) -> Option<Self> {
        if let ModifierValue::File(Attached::Heights(file)) = value { Some(file) } else { None }
    }
}

/// What is known about a parameter.
#[derive(Clone, Copy, Debug)]
pub struct ModifierParam {
    /// Its name in files and, with spaces for underscores, in the inspector.
    pub name: &'static str,
    /// One sentence for people.
    pub help: &'static str,
    /// Accepted and offered ranges; without meaning for what is no number.
    pub limits: Limits,
}

macro_rules! modifiers {
    ($( $(#[doc = $doc:literal])+ $name:ident = $label:literal {
        $( $(#[doc = $help:literal])+ $(#[serde($missing:ident)])? $param:ident: $type:ty = $default:expr, $limits:expr; )*
    } )+) => {
        /// A modifier with its parameters, in the node's own space.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
        pub enum Modifier {
            $( $(#[doc = $doc])+ $name { $( $(#[doc = $help])+ #[serde(deserialize_with = "Field::read" $(, $missing)?)] $param: $type, )* }, )+
        }

        /// Which modifier, without its parameters. The number is the code that the GPU reads.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u32)]
        pub enum ModifierKind { $( $(#[doc = $doc])+ $name, )+ }

        impl ModifierKind {
            /// Every kind, in the order of the user interface.
            pub const ALL: &[Self] = &[$( Self::$name, )+];

            /// Name for people.
            pub fn label(self) -> &'static str {
                match self { $( Self::$name => $label, )+ }
            }

            /// What it does, for people.
            pub fn help(self) -> &'static str {
                match self { $( Self::$name => concat!($( $doc, )+).trim_ascii(), )+ }
            }

            /// Its parameters in order.
            pub fn params(self) -> &'static [ModifierParam] {
                match self { $( Self::$name => const { &[$( ModifierParam {
                    name: stringify!($param),
                    help: concat!($( $help, )+).trim_ascii(),
                    limits: $limits,
                }, )*] }, )+ }
            }

            /// The modifier with its default parameters.
            pub fn default_modifier(self) -> Modifier {
                match self { $( Self::$name => Modifier::$name { $( $param: $default, )* }, )+ }
            }
        }

        impl Modifier {
            /// Which modifier it is.
            pub fn kind(&self) -> ModifierKind {
                match self { $( Self::$name { .. } => ModifierKind::$name, )+ }
            }

            /// The parameters' values, in the order of [`ModifierKind::params`].
            pub fn values(&self) -> Vec<ModifierValue> {
                match self { $( Self::$name { $( $param, )* } => vec![$( $param.to_value(), )*], )+ }
            }

            /// Sets the parameter at `index`; false, and nothing changed, where there is none or the value is
            /// of another type.
            #[allow(unused_assignments, reason = "the count after the last parameter is not read")]
            pub fn set_value(&mut self, index: usize, value: ModifierValue) -> bool {
                match self { $( Self::$name { $( $param, )* } => {
                    let mut i = 0;
                    $( if i == index {
                        let Some(v) = Field::from_value(value) else { return false };
                        *$param = v;
                        return true;
                    }
                    i += 1; )*
                    false
                } )+ }
            }
        }
    };
}

modifiers! {
    /// The same on the other side of a plane through the origin, for each axis that is on.
    Mirror = "Mirror" {
        /// Across which planes: through the origin, at right angles to the axis.
        axes: [bool; 3] = [true, false, false], POSITION;
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
        mirrored: [bool; 3] = [false; 3], POSITION;
        /// First cell of a block that is left out, counted from 0; nothing is left out where `carve_to` is 0.
        carve_from: [u32; 3] = [0; 3], COPIES;
        /// The cell after the last one of that block, along each axis.
        carve_to: [u32; 3] = [0; 3], COPIES;
    }
    /// Copies around the Y axis.
    Polar = "Radial array" {
        /// How many all around.
        count: u32 = 6, AROUND;
        /// How far the content is moved out along X first.
        radius: f64 = 1.0, SIZE;
        /// Every other copy is mirrored.
        mirrored: bool = false, POSITION;
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
        mirrored: [bool; 3] = [true, false, false], POSITION;
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
        image: Attachment<Heights> = Attachment::NONE, COUNT;
        /// How far what is white moves outward, or inward where it is negative; what is black stays.
        height: f64 = 0.1, DISPLACEMENT;
        /// Width of the image.
        tile: f64 = 1.0, TILE;
        /// The image is seen upright from where this axis points to, its middle at the origin.
        axis: Axis = Axis::Y, POSITION;
    }
}

/// Copies around an axis: each is a shape of its own.
const AROUND: Limits = Limits { soft: [2.0, 32.0], hard: [1.0, 1024.0], unit: "" };
/// Copies of a recursion.
const RECURSION: Limits = Limits { soft: [1.0, 8.0], hard: [1.0, 12.0], unit: "" };
/// Relative size of a copy of a recursion.
const RECURSION_SCALE: Limits = Limits { soft: [0.2, 1.0], hard: [0.05, 1.0], unit: "" };
/// Walls of an onion.
const WALLS: Limits = Limits { soft: [1.0, 8.0], hard: [1.0, 64.0], unit: "" };
/// Layers of noise.
const OCTAVES: Limits = Limits { soft: [1.0, 6.0], hard: [1.0, 8.0], unit: "" };
/// Seeds.
const SEED: Limits = Limits { soft: [0.0, 100.0], hard: [0.0, 65_535.0], unit: "" };

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
                    ModifierValue::File(_) => ModifierValue::File(Attached::Heights(image)),
                    ModifierValue::Axis(_) => ModifierValue::Axis(Axis::Z),
                    ModifierValue::Scalar(v) => ModifierValue::Scalar(v + 0.25),
                    ModifierValue::Vector(v) => ModifierValue::Vector(v + 0.25),
                    ModifierValue::Count(v) => ModifierValue::Count(v + 1),
                    ModifierValue::Counts(v) => ModifierValue::Counts(v.map(|n| n + 1)),
                    ModifierValue::Flag(v) => ModifierValue::Flag(!v),
                    ModifierValue::Flags(v) => ModifierValue::Flags(v.map(|f| !f)),
                };
                assert!(modifier.set_value(i, changed.clone()));
                assert_eq!(modifier.values()[i], changed);
                let other = if matches!(value, ModifierValue::Flag(_)) {
                    ModifierValue::Scalar(0.0)
                } else {
                    ModifierValue::Flag(true)
                };
                assert!(!modifier.set_value(i, other), "{kind:?} {i} takes a value of another type");
            }
            assert!(!modifier.set_value(values.len(), ModifierValue::Scalar(1.0)));
        }
    }
}
