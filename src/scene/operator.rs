//! Operators and blends: how a group joins its operands.

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::limits::{BLEND_RADIUS, NO_LIMITS, STEPS};
use super::params::{
    Choice, Param, ParamField, ParamSlot, ParamValue, Visit, choices, choices_of, named, nested_params, param_rows,
    param_struct,
};

/// An operator. It folds over the children in the artist's order: the first child is the start, `a`; each
/// later child, `b`, joins the running result.
///
/// The formulas of pipe, groove, tongue and engraving follow Mercury's hg_sdf (2015), halved or divided where
/// that makes them safe to step by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Operator {
    /// What is in any child.
    Union,
    /// What is in every child.
    Intersection,
    /// What is in the first child and in no later one.
    Difference,
    /// What is in exactly one of a and b.
    Xor,
    /// A round tube along the curve in which the surfaces of a and b meet.
    Pipe,
    /// a with a groove cut along the surface of b.
    Groove,
    /// a with a tongue raised along the surface of b.
    Tongue,
    /// a with a V of 45° cut along the surface of b.
    Engrave,
    /// Between a and b: the share of b's field, the rest of a's.
    Morph,
    /// a, with the material of b where it is in b.
    Paint,
}

impl Operator {
    /// Every operator, in the order of the user interface.
    pub const ALL: [Self; 10] = [
        Self::Union,
        Self::Intersection,
        Self::Difference,
        Self::Xor,
        Self::Pipe,
        Self::Groove,
        Self::Tongue,
        Self::Engrave,
        Self::Morph,
        Self::Paint,
    ];
    /// The set operators: with a radius of 0 they depend on inside and outside only.
    pub const SETS: [Self; 4] = [Self::Union, Self::Intersection, Self::Difference, Self::Xor];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Union => "Union",
            Self::Intersection => "Intersection",
            Self::Difference => "Difference",
            Self::Xor => "Exclude (XOR)",
            Self::Pipe => "Pipe",
            Self::Groove => "Groove",
            Self::Tongue => "Ridge",
            Self::Engrave => "Engrave",
            Self::Morph => "Morph",
            Self::Paint => "Color projection",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Union => "What is in any child",
            Self::Intersection => "What is in every child",
            Self::Difference => "The first child without the later ones",
            Self::Xor => "What is in one child but not in the next",
            Self::Pipe => "A tube along the curve where the surfaces meet",
            Self::Groove => "The first child with a groove along the surface of each later one",
            Self::Tongue => "The first child with a ridge along the surface of each later one",
            Self::Engrave => "The first child with a V cut along the surface of each later one",
            Self::Morph => "Between the first child and the next",
            Self::Paint => "The shape of the first child in the colors of the later ones",
        }
    }

    /// Whether its blends have a radius; for [`Operator::Paint`] the radius is that of the soft edge.
    pub fn has_radius(self) -> bool {
        !matches!(self, Self::Pipe | Self::Morph)
    }

    /// Whether its blends have a kernel.
    pub fn has_kernel(self) -> bool {
        self.has_radius() && self != Self::Paint
    }

    /// Whether a [`BlendKernel`] with steps gets its steps with this operator. Grooves and tongues use the plain bevel
    /// instead.
    pub fn has_steps(self) -> bool {
        self.has_kernel() && !matches!(self, Self::Groove | Self::Tongue)
    }

    /// Whether it has a width: the full width of a groove or tongue, the diameter of a pipe.
    pub fn has_width(self) -> bool {
        matches!(self, Self::Pipe | Self::Groove | Self::Tongue)
    }

    /// Whether it has a depth: that of a groove or V, or the height of a tongue.
    pub fn has_depth(self) -> bool {
        matches!(self, Self::Groove | Self::Tongue | Self::Engrave)
    }
}

/// What a node does to those before it in its group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// It is joined by the operator of its group.
    #[default]
    Add,
    /// It is cut away.
    Subtract,
    /// What is outside of it is cut away.
    Intersect,
}

impl Operation {
    /// Every operation, in the order of the user interface.
    pub const ALL: [Self; 3] = [Self::Add, Self::Subtract, Self::Intersect];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Add => "Add",
            Self::Subtract => "Subtract",
            Self::Intersect => "Intersect",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Add => "Joined by its group's operator",
            Self::Subtract => "Cut away from what stands before it",
            Self::Intersect => "Keeps of what stands before it only what is inside of it",
        }
    }

    /// The operator that joins a node to those before it in a group of this operator.
    pub fn in_group(self, operator: Operator) -> Operator {
        match self {
            Self::Add => operator,
            Self::Subtract => Operator::Difference,
            Self::Intersect => Operator::Intersection,
        }
    }
}

/// The curve by which a blend rounds or cuts the edge. All are convex combinations of the operands, so the
/// field stays safe to step by, and all give the same greatest thickening at equal radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BlendKernel {
    /// A circular arc: at a right-angled corner, a fillet whose radius is the blend radius.
    Circular,
    /// A parabola: softer ends, a little wider.
    Quadratic,
    /// A cubic: curvature without a jump, widest.
    Cubic,
    /// A flat bevel with softened ends. Its volume is within 4 % of the least among smooth blends of equal
    /// thickening: the profile of a blend is convex and leaves the middle at 45°, so it never lies below the bevel.
    /// Earlier files call it `lean`.
    #[serde(alias = "lean")]
    SmoothChamfer,
    /// A flat bevel of 45° that touches the fillet of the same radius in its middle.
    Chamfer,
    /// Steps, whose edges lie on the bevel.
    Stairs,
    /// Columns with round fronts, which touch the bevel.
    Columns,
}

impl BlendKernel {
    /// Every kernel, in the order of the user interface.
    pub const ALL: [Self; 7] =
        [Self::Circular, Self::Quadratic, Self::Cubic, Self::SmoothChamfer, Self::Chamfer, Self::Stairs, Self::Columns];

    /// Thickening at a blend of equal distances, per blend radius, for every kernel: 1 − 1/√2, what a
    /// fillet of radius 1 adds at the middle of a right-angled corner. For steps and columns the greatest.
    pub const THICKENING: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Circular => "Circular",
            Self::Quadratic => "Quadratic",
            Self::Cubic => "Cubic",
            Self::SmoothChamfer => "Minimal",
            Self::Chamfer => "Chamfer",
            Self::Stairs => "Steps",
            Self::Columns => "Columns",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Circular => "A fillet with a round section",
            Self::Quadratic => "Softer ends, a little wider",
            Self::Cubic => "The softest and widest",
            Self::SmoothChamfer => "A smooth bevel that adds the least volume",
            Self::Chamfer => "A flat bevel of 45°",
            Self::Stairs => "Steps whose edges lie on the bevel",
            Self::Columns => "Round columns that touch the bevel",
        }
    }

    /// Whether it has a number of steps.
    pub fn has_steps(self) -> bool {
        matches!(self, Self::Stairs | Self::Columns)
    }

    /// Whether the blend is smooth: its derivative has no jump.
    pub fn is_smooth(self) -> bool {
        matches!(self, Self::Circular | Self::Quadratic | Self::Cubic | Self::SmoothChamfer)
    }

    /// Support per blend radius: where the operands' distances differ by more than this times the
    /// radius, the blend is exactly the hard operator. Thickening times 1/(1 − 1/√2), 4 and 6 (the
    /// normalization of Quilez, "smooth minimum", 2013–2024); for the smooth chamfer 8/3, for the bevel 2; for m
    /// steps 2m/(m + 1), for m columns 2m/(m + √2 − 1), so that edges and fronts lie on the bevel.
    pub fn support(self, steps: u32) -> f64 {
        let m = f64::from(steps);
        Self::THICKENING
            * match self {
                Self::Circular => return 1.0,
                Self::Quadratic => 4.0,
                Self::Cubic => 6.0,
                Self::SmoothChamfer => 8.0 / 3.0,
                Self::Chamfer => 2.0,
                Self::Stairs => 2.0 * m / (m + 1.0),
                Self::Columns => 2.0 * m / (m + std::f64::consts::SQRT_2 - 1.0),
            }
    }
}

/// The unit of a blend radius.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RadiusUnit {
    /// Meters.
    #[default]
    #[serde(rename = "metres")]
    Meters,
    /// The size of the operands: the largest half extent of the bounds in the world, of the joining operand or of the
    /// running result, whichever is less. Unbounded operands do not count; 1 m if both are unbounded.
    Size,
}

impl RadiusUnit {
    /// Every unit, in the order of the user interface.
    pub const ALL: [Self; 2] = [Self::Meters, Self::Size];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Meters => "Absolute",
            Self::Size => "Relative",
        }
    }

    /// The help text.
    pub fn help(self) -> &'static str {
        match self {
            Self::Meters => "The same length whatever the size",
            Self::Size => "Times the largest half extent of the smaller operand: scales along",
        }
    }
}

choices!(Operator);
choices!(Operation);
choices!(BlendKernel);
choices!(RadiusUnit);
nested_params!(Blend);

param_struct! {
    /// Kernel and radius of a blend; radius 0 is the hard operator.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct Blend {
        /// The curve of the blend; all thicken equally.
        kernel: BlendKernel = BlendKernel::Circular, NO_LIMITS.labeled("Blend profile");
        /// Fillet radius: how round the blends are; 0 is a sharp edge.
        radius: f64 = 0.0, BLEND_RADIUS.labeled("Blend radius");
        /// What the radius is measured in.
        #[serde(default, skip_serializing_if = "is_default")]
        unit: RadiusUnit = RadiusUnit::Meters, NO_LIMITS.labeled("Blend units");
        /// How many steps or columns; only those kernels have them.
        #[serde(default = "few_steps", skip_serializing_if = "is_few_steps", deserialize_with = "super::whole::read")]
        steps: u32 = few_steps(), STEPS;
    }
}

impl Blend {
    /// No blend.
    pub const HARD: Self =
        Self { kernel: BlendKernel::Circular, radius: 0.0, unit: RadiusUnit::Meters, steps: few_steps() };

    /// A blend with a radius in meters.
    pub const fn new(kernel: BlendKernel, radius: f64) -> Self {
        Self { kernel, radius, ..Self::HARD }
    }

    /// The distance difference up to which the operands blend. The radius must be in meters.
    pub fn support(&self) -> f64 {
        self.kernel.support(self.steps) * self.radius
    }

    /// The greatest amount that the blend adds to or takes from the hard operator's value. The radius must be in
    /// meters.
    pub fn thickening(&self) -> f64 {
        BlendKernel::THICKENING * self.radius
    }

    /// The same blend with its radius in meters, between operands of this size, see [`RadiusUnit::Size`].
    pub fn in_meters(self, size: f64) -> Self {
        let factor = if self.unit == RadiusUnit::Size { size } else { 1.0 };
        Self { radius: self.radius * factor, unit: RadiusUnit::Meters, ..self }
    }
}

/// How a node blends with its siblings; it has an effect in groups only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BlendOverride {
    /// As its group says.
    #[default]
    Inherit,
    /// Not at all: it is joined without a blend.
    Hard,
    /// With this radius, in the unit of its group.
    Radius(f64),
}

impl BlendOverride {
    /// The first own radius of a node.
    const FIRST_RADIUS: f64 = 0.1;
    /// Every variant, in the order of the user interface.
    const ALL: [Self; 3] = [Self::Inherit, Self::Hard, Self::Radius(Self::FIRST_RADIUS)];

    /// Display name.
    fn label(self) -> &'static str {
        match self {
            Self::Inherit => "Inherit",
            Self::Hard => "None",
            Self::Radius(_) => "Custom",
        }
    }

    /// The help text.
    fn help(self) -> &'static str {
        match self {
            Self::Inherit => "With the radius of its group",
            Self::Hard => "Without a blend",
            Self::Radius(_) => "With a radius of its own, in its group's unit",
        }
    }

    /// The description of the radius.
    fn radius_param() -> &'static Param {
        let table = param_rows! {
            /// The blend radius of this node's blend.
            ["radius"] f64 = BlendOverride::FIRST_RADIUS, BLEND_RADIUS.labeled("Custom radius");
        };
        &table[0]
    }
}

/// A choice, followed by the radius if there is one.
impl ParamField for BlendOverride {
    const ANIMATABLE: bool = false;

    fn choices() -> &'static [Choice] {
        static CHOICES: LazyLock<Vec<Choice>> = LazyLock::new(|| {
            // In files, the variant with a radius is an object, not a word; its key serves as the key of the choice.
            let mut choices = choices_of(&BlendOverride::ALL, BlendOverride::label, BlendOverride::help);
            choices[2].key = "radius".into();
            choices
        });
        &CHOICES
    }

    fn to_value(&self) -> Option<ParamValue> {
        let same = |other: &Self| std::mem::discriminant(self) == std::mem::discriminant(other);
        Self::ALL.iter().position(same).map(|index| ParamValue::Choice(&Self::choices()[index].key))
    }

    fn from_value(value: ParamValue) -> Option<Self> {
        let ParamValue::Choice(key) = value else { return None };
        Self::choices().iter().position(|choice| choice.key == key).map(|index| Self::ALL[index])
    }

    fn visit_field(&self, slot: ParamSlot<'_>, visit: &mut Visit<'_>) {
        if let (Some(value), Some(param)) = (self.to_value(), named(slot.table, slot.name)) {
            visit(slot.prefix, param, value);
        }
        if let Self::Radius(radius) = self {
            visit(&slot.inner_prefix(), Self::radius_param(), ParamValue::Scalar(*radius));
        }
    }

    fn find_field(&self, slot: ParamSlot<'_>, below: &str) -> Option<&'static Param> {
        match (below, self) {
            ("", _) => named(slot.table, slot.name),
            (".radius", Self::Radius(_)) => Some(Self::radius_param()),
            _ => None,
        }
    }

    fn get_field(&self, below: &str) -> Option<ParamValue> {
        match (below, self) {
            ("", _) => self.to_value(),
            (".radius", Self::Radius(radius)) => Some(ParamValue::Scalar(*radius)),
            _ => None,
        }
    }

    fn set_field(&mut self, below: &str, value: ParamValue) -> bool {
        let new = match (below, &*self, value) {
            ("", Self::Radius(_), ParamValue::Choice("radius")) => Some(*self),
            ("", _, value) => Self::from_value(value),
            (".radius", Self::Radius(_), ParamValue::Scalar(radius)) => Some(Self::Radius(radius)),
            _ => None,
        };
        new.map(|new| *self = new).is_some()
    }
}

const fn few_steps() -> u32 {
    4
}

fn is_few_steps(steps: &u32) -> bool {
    *steps == few_steps()
}

fn is_default(unit: &RadiusUnit) -> bool {
    *unit == RadiusUnit::default()
}
