//! How the operands of a group are joined.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A Boolean operator. It folds over the children in the artist's order: the first child is the
/// start, each later child is joined to what stands so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Operator {
    /// What is in any child.
    Union,
    /// What is in every child.
    Intersection,
    /// What is in the first child and in no later one.
    Difference,
}

impl Operator {
    /// Every operator, in the order of the user interface.
    pub const ALL: [Self; 3] = [Self::Union, Self::Intersection, Self::Difference];

    /// Name for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::Union => "Union",
            Self::Intersection => "Intersection",
            Self::Difference => "Difference",
        }
    }
}

/// The curve with which a blend rounds the joint. All give the same thickening at equal radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BlendKernel {
    /// A circular arc: at a right-angled joint, a fillet whose radius is the blend radius.
    Circular,
    /// A parabola: softer ends, a little wider.
    Quadratic,
    /// A cubic: curvature without a jump, widest.
    Cubic,
}

impl BlendKernel {
    /// Every kernel, in the order of the user interface.
    pub const ALL: [Self; 3] = [Self::Circular, Self::Quadratic, Self::Cubic];

    /// Thickening at a joint of equal distances, per blend radius, for every kernel: 1 − 1/√2, what a
    /// fillet of radius 1 adds at the middle of a right-angled joint.
    pub const THICKENING: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

    /// Name for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::Circular => "Circular",
            Self::Quadratic => "Quadratic",
            Self::Cubic => "Cubic",
        }
    }

    /// Support per blend radius: where the operands' distances differ by more than this times the
    /// radius, the blend is exactly the hard operator. Thickening times 1/(1 − 1/√2), 4 and 6 (the
    /// normalisation of Quilez, "smooth minimum", 2013–2024).
    pub fn support(self) -> f64 {
        match self {
            Self::Circular => 1.0,
            Self::Quadratic => 4.0 * Self::THICKENING,
            Self::Cubic => 6.0 * Self::THICKENING,
        }
    }
}

/// Kernel and radius of a blend; radius 0 is the hard operator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blend {
    /// The curve.
    pub kernel: BlendKernel,
    /// Fillet radius in metres, see [`BlendKernel::THICKENING`].
    pub radius: f64,
}

impl Blend {
    /// No blend.
    pub const HARD: Self = Self { kernel: BlendKernel::Circular, radius: 0.0 };

    /// How far apart two distances may be and still blend.
    pub fn support(&self) -> f64 {
        self.kernel.support() * self.radius
    }

    /// The most that the blend can add to or take from the hard operator's value.
    pub fn thickening(&self) -> f64 {
        BlendKernel::THICKENING * self.radius
    }
}
