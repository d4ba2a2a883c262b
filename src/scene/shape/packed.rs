//! The parameter types of shapes, packed for the evaluators.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::eval_params::{EvalValue, PolygonSides, SineCosine};
use crate::params::{ParamField, ParamValue};

/// Most numbers that the packed parameters of one shape may take.
pub const SHAPE_FLOATS: usize = 8;

/// An angle in degrees. Evaluators receive it as [`SineCosine`], because those of the GPU are not exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Degrees(pub f64);

/// The number of sides of a regular polygon, rounded to a whole number. Evaluators receive it as
/// [`PolygonSides`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Sides(pub f64);

impl Sides {
    /// Half the angle of one side, in radians.
    pub fn half_angle(self) -> f64 {
        std::f64::consts::PI / self.0.round()
    }
}

/// Implements `ParamField` for a wrapper around one number.
macro_rules! scalar {
    ($type:ident) => {
        impl ParamField for $type {
            fn to_value(&self) -> Option<ParamValue> {
                Some(ParamValue::Scalar(self.0))
            }
            fn from_value(value: ParamValue) -> Option<Self> {
                if let ParamValue::Scalar(v) = value { Some(Self(v)) } else { None }
            }
        }
    };
}
scalar!(Degrees);
scalar!(Sides);

/// A parameter type as evaluators read it.
pub trait Packed: Sized {
    /// What they read.
    type Value: EvalValue;
    /// What they read of a parameter.
    fn pack(&self) -> Self::Value;
    /// The parameter of what they read.
    fn unpack(value: Self::Value) -> Self;
}

/// Implements the trait for types that evaluators read as they are.
macro_rules! as_it_is {
    ($($type:ty),+) => { $(
        impl Packed for $type {
            type Value = Self;
            fn pack(&self) -> Self {
                *self
            }
            fn unpack(value: Self) -> Self {
                value
            }
        }
    )+ };
}
as_it_is!(f64, [f64; 3]);

impl Packed for Degrees {
    type Value = SineCosine;
    fn pack(&self) -> SineCosine {
        let (sine, cosine) = self.0.to_radians().sin_cos();
        SineCosine { sine, cosine }
    }
    fn unpack(SineCosine { sine, cosine }: SineCosine) -> Self {
        Self(sine.atan2(cosine).to_degrees())
    }
}

impl Packed for Sides {
    type Value = PolygonSides;
    fn pack(&self) -> PolygonSides {
        let (sine, cosine) = self.half_angle().sin_cos();
        PolygonSides { count: self.0.round(), cosine, sine }
    }
    fn unpack(sides: PolygonSides) -> Self {
        Self(sides.count)
    }
}
