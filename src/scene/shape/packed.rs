//! The parameter types of shapes, packed for the evaluators.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::attachment::Attachment;
use crate::drawn::{Corners, Points};
use crate::heights::Heights;
use crate::model_file::ModelFile;
use crate::params::{ParamField, ParamValue};
use isolith_font::Face;

/// Most numbers that the packed parameters of one shape may take.
pub const SHAPE_FLOATS: usize = 8;

/// An angle in degrees. Evaluators receive its sine and cosine, because those of the GPU are not exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Degrees(pub f64);

/// The number of sides of a regular polygon, rounded to a whole number. Evaluators receive it, followed by the cosine
/// and sine of half the angle of one side.
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

/// A parameter type in its packed form.
pub trait Packed: Sized {
    /// Numbers in the packed form.
    const FLOATS: usize;
    /// Writes the packed numbers to the start of `out` and advances `out` behind them.
    fn pack(&self, out: &mut &mut [f64]);
    /// Reads the packed numbers from the start of `rest` and advances `rest` behind them.
    fn unpack(rest: &mut &[f64]) -> Self;
}

fn put<const N: usize>(out: &mut &mut [f64], numbers: [f64; N]) {
    let (first, rest) = std::mem::take(out).split_at_mut(N);
    first.copy_from_slice(&numbers);
    *out = rest;
}

fn take<const N: usize>(rest: &mut &[f64]) -> [f64; N] {
    let (first, behind) = rest.split_at(N);
    *rest = behind;
    std::array::from_fn(|i| first[i])
}

impl Packed for f64 {
    const FLOATS: usize = 1;
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, [*self]);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        take::<1>(rest)[0]
    }
}

impl Packed for [f64; 3] {
    const FLOATS: usize = 3;
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, *self);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        take(rest)
    }
}

impl Packed for Degrees {
    const FLOATS: usize = 2;
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, self.0.to_radians().sin_cos().into());
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        let [sine, cosine] = take(rest);
        Self(sine.atan2(cosine).to_degrees())
    }
}

impl Packed for Sides {
    const FLOATS: usize = 3;
    fn pack(&self, out: &mut &mut [f64]) {
        let (sine, cosine) = self.half_angle().sin_cos();
        put(out, [self.0.round(), cosine, sine]);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        Self(take::<3>(rest)[0])
    }
}

/// Implements the trait for types that only shapes with data have: they are not packed.
macro_rules! not_packed {
    ($($type:ty = $empty:expr;)+) => { $(
        impl Packed for $type {
            const FLOATS: usize = 0;
            fn pack(&self, _: &mut &mut [f64]) {}
            fn unpack(_: &mut &[f64]) -> Self {
                $empty
            }
        }
    )+ };
}

not_packed! {
    bool = false;
    String = Self::new();
    Points = Self::new([]);
    Corners = Self::new([]);
    Attachment<Heights> = Self::NONE;
    Attachment<Face> = Self::NONE;
    ModelFile = Self::default();
}
