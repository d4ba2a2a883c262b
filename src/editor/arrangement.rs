//! What the commands that align, distribute and paste parts can be told.

use isolith_geometry::Aabb;

/// A part of what was copied, to be given to other nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CopiedPart {
    /// Position, rotation and scale.
    Transform,
    /// The material.
    Material,
    /// All modifiers, in place of those before.
    Modifiers,
    /// All dynamics, in place of those before.
    Dynamics,
}

impl CopiedPart {
    /// Every part, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Transform, Self::Material, Self::Modifiers, Self::Dynamics];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Transform => "Paste transform",
            Self::Material => "Paste material",
            Self::Modifiers => "Paste modifiers",
            Self::Dynamics => "Paste dynamics",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Transform => "Gives the selection position, rotation and scale of the copied node",
            Self::Material => "Gives the selection the material of the copied node",
            Self::Modifiers => "Gives the selection the modifiers of the copied node in place of its own",
            Self::Dynamics => "Gives the selection the dynamics of the copied node in place of its own",
        }
    }
}

/// What is aligned along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundsEdge {
    /// The lower ends.
    Least,
    /// The middles.
    Middle,
    /// The upper ends.
    Greatest,
}

impl BoundsEdge {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Least, Self::Middle, Self::Greatest];

    /// What is aligned, in words.
    pub fn label(self, axis: usize) -> &'static str {
        match (self, axis) {
            (Self::Least, 0) => "left",
            (Self::Greatest, 0) => "right",
            (Self::Least, 1) => "bottom",
            (Self::Greatest, 1) => "top",
            (Self::Least, _) => "back",
            (Self::Greatest, _) => "front",
            (Self::Middle, _) => "middle",
        }
    }

    /// Its coordinate.
    pub fn of(self, bounds: &Aabb, axis: usize) -> f64 {
        match self {
            Self::Least => bounds.min[axis],
            Self::Middle => bounds.center()[axis],
            Self::Greatest => bounds.max[axis],
        }
    }
}

/// Where the origin of a group goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OriginPlace {
    /// To the middle of what it holds.
    Center,
    /// To the middle of its lower side.
    Bottom,
}

/// The names of the axes.
pub const AXIS_NAMES: [&str; 3] = ["X", "Y", "Z"];
