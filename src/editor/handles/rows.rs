//! The rows of the tables of handles, and the ways in which they are dragged.

use glam::DVec3;

use super::measures::Measures;

/// A place of the node's space, or a direction in it.
pub type Spot = fn(&Measures<'_>) -> DVec3;
/// A number.
pub type Amount = fn(&Measures<'_>) -> f64;

/// How a row turns its parameter into handles.
#[derive(Clone, Copy)]
pub enum Pull {
    /// A length to both sides of `base` along an axis, `share` of it to each: a handle at each of the `sides`. Dragging
    /// one side keeps the other where it is.
    Extent {
        /// The axis.
        axis: usize,
        /// The part of the value on each side: a half, or 1 for a half axis.
        share: f64,
        /// What lies in the middle.
        base: Spot,
        /// The sides that have a handle.
        sides: &'static [f64],
    },
    /// A length along a direction.
    Along {
        /// Where it is 0.
        origin: Spot,
        /// A unit vector.
        direction: Spot,
        /// Distance per unit of the value.
        factor: Amount,
    },
    /// An angle in degrees.
    Angle {
        /// The center of the circle.
        center: Spot,
        /// The direction of 0.
        zero: Spot,
        /// The direction of 90 degrees.
        quarter: Spot,
        /// The radius of the circle.
        radius: Amount,
        /// Angle per unit of the value.
        factor: f64,
    },
    /// A point in space.
    Point,
    /// A list of points; those of a profile stay in the plane across Z.
    List {
        /// Whether they are those of a profile.
        flat: bool,
        /// Where the first column is 0.
        base: Spot,
    },
}

/// A row: a parameter and how it is dragged.
#[derive(Clone, Copy)]
pub struct HandleRow {
    /// The parameter's key.
    pub param: &'static str,
    /// One of its three elements.
    pub element: Option<usize>,
    /// How it is dragged.
    pub pull: Pull,
    /// The greatest value that has an effect.
    pub most: Amount,
    /// The least value that the other parameters allow.
    pub least: Amount,
}

pub fn zero(_: &Measures<'_>) -> DVec3 {
    DVec3::ZERO
}

pub fn one(_: &Measures<'_>) -> f64 {
    1.0
}

fn anything(_: &Measures<'_>) -> f64 {
    f64::INFINITY
}

fn nothing(_: &Measures<'_>) -> f64 {
    f64::NEG_INFINITY
}

/// Both ends of an extent.
pub const BOTH: &[f64] = &[1.0, -1.0];

impl HandleRow {
    const fn new(param: &'static str, pull: Pull) -> Self {
        Self { param, element: None, pull, most: anything, least: nothing }
    }

    /// A length whose middle is the origin.
    pub const fn extent(param: &'static str, axis: usize) -> Self {
        Self::new(param, Pull::Extent { axis, share: 0.5, base: zero, sides: BOTH })
    }

    /// A length along a direction.
    pub const fn along(param: &'static str, origin: Spot, direction: Spot) -> Self {
        Self::new(param, Pull::Along { origin, direction, factor: one })
    }

    /// A length of which a factor is seen.
    pub const fn part_along(param: &'static str, origin: Spot, direction: Spot, factor: Amount) -> Self {
        Self::new(param, Pull::Along { origin, direction, factor })
    }

    /// An angle around a point.
    pub const fn angle(param: &'static str, zero: Spot, quarter: Spot, radius: Amount, factor: f64) -> Self {
        Self::new(param, Pull::Angle { center: self::zero, zero, quarter, radius, factor })
    }

    /// A point in space.
    pub const fn point(param: &'static str) -> Self {
        Self::new(param, Pull::Point)
    }

    /// A list of points.
    pub const fn list(param: &'static str, flat: bool, base: Spot) -> Self {
        Self::new(param, Pull::List { flat, base })
    }

    /// The same for one element.
    pub const fn element(mut self, index: usize) -> Self {
        self.element = Some(index);
        self
    }

    /// The same with other ends of the extent.
    pub const fn shaped(mut self, share: f64, base: Spot, sides: &'static [f64]) -> Self {
        if let Pull::Extent { axis, .. } = self.pull {
            self.pull = Pull::Extent { axis, share, base, sides };
        }
        self
    }

    /// The same with a greatest value.
    pub const fn at_most(mut self, most: Amount) -> Self {
        self.most = most;
        self
    }

    /// The same with a least value.
    pub const fn at_least(mut self, least: Amount) -> Self {
        self.least = least;
        self
    }
}
