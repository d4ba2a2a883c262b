//! Parameters of shapes: their values, and how these are packed for the evaluators.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::font::Face;
use crate::scene::attached::Attached;
use crate::scene::attachment::Attachment;
use crate::scene::drawn::{Corners, Points};
use crate::scene::heights::Heights;
use crate::scene::limits::{CORNERS, Limits, POINTS, SIZE};

/// Most numbers that the packed parameters of one shape may take.
pub const SHAPE_FLOATS: usize = 8;

/// Most numbers in a row of a list.
pub const LIST_COLUMNS: usize = 4;

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// One number.
    Scalar(f64),
    /// Three numbers: a size or a point.
    Vector(DVec3),
    /// On or off.
    Flag(bool),
    /// Points.
    List(List),
    /// Letters.
    Text(String),
    /// A file.
    File(Attached),
}

/// Points as rows of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct List {
    /// The rows; places behind the last column are 0.
    pub rows: Vec<[f64; LIST_COLUMNS]>,
    /// The names of the columns.
    pub columns: &'static [&'static str],
    /// Fewest and most rows.
    pub count: [usize; 2],
}

impl List {
    /// The limits of the numbers in a column, where those of the parameter are `limits`.
    pub fn limits(&self, column: usize, limits: &Limits) -> Limits {
        if column < 3 { *limits } else { SIZE }
    }
}

/// What is known about a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Its name in files and, with spaces for underscores, in the inspector.
    pub name: &'static str,
    /// One sentence for people.
    pub help: &'static str,
    /// Accepted and offered ranges.
    pub limits: Limits,
}

/// An angle in degrees. Evaluators are given its sine and cosine: those of the GPU are not exact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Degrees(pub f64);

/// How many sides a regular polygon has; rounded to a whole number. Evaluators are given that, then cosine and
/// sine of half the angle that a side takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Sides(pub f64);

impl Sides {
    /// Half the angle that a side takes, in radians.
    pub fn half_angle(self) -> f64 {
        std::f64::consts::PI / self.0.round()
    }
}

/// A Rust type that a parameter can have. Those that take no numbers are for shapes with data, which are not packed.
pub(super) trait ParamField: Sized {
    /// How many numbers it takes when packed.
    const FLOATS: usize;
    fn to_value(&self) -> ParamValue;
    fn from_value(value: ParamValue) -> Option<Self>;
    /// Writes the packed numbers to the start of `out`, which then begins behind them.
    fn pack(&self, out: &mut &mut [f64]);
    /// Reads the packed numbers from the start of `rest`, which then begins behind them.
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

fn scalar(value: ParamValue) -> Option<f64> {
    if let ParamValue::Scalar(v) = value { Some(v) } else { None }
}

impl ParamField for f64 {
    const FLOATS: usize = 1;
    fn to_value(&self) -> ParamValue {
        ParamValue::Scalar(*self)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        scalar(value)
    }
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, [*self]);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        take::<1>(rest)[0]
    }
}

impl ParamField for [f64; 3] {
    const FLOATS: usize = 3;
    fn to_value(&self) -> ParamValue {
        ParamValue::Vector((*self).into())
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Vector(v) = value { Some(v.to_array()) } else { None }
    }
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, *self);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        take(rest)
    }
}

impl ParamField for Degrees {
    const FLOATS: usize = 2;
    fn to_value(&self) -> ParamValue {
        ParamValue::Scalar(self.0)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        scalar(value).map(Self)
    }
    fn pack(&self, out: &mut &mut [f64]) {
        put(out, self.0.to_radians().sin_cos().into());
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        let [sine, cosine] = take(rest);
        Self(sine.atan2(cosine).to_degrees())
    }
}

impl ParamField for Sides {
    const FLOATS: usize = 3;
    fn to_value(&self) -> ParamValue {
        ParamValue::Scalar(self.0)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        scalar(value).map(Self)
    }
    fn pack(&self, out: &mut &mut [f64]) {
        let (sine, cosine) = self.half_angle().sin_cos();
        put(out, [self.0.round(), cosine, sine]);
    }
    fn unpack(rest: &mut &[f64]) -> Self {
        Self(take::<3>(rest)[0])
    }
}

impl ParamField for bool {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        ParamValue::Flag(*self)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Flag(v) = value { Some(v) } else { None }
    }
    fn pack(&self, _: &mut &mut [f64]) {}
    fn unpack(_: &mut &[f64]) -> Self {
        false
    }
}

impl ParamField for String {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        ParamValue::Text(self.clone())
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Text(v) = value { Some(v) } else { None }
    }
    fn pack(&self, _: &mut &mut [f64]) {}
    fn unpack(_: &mut &[f64]) -> Self {
        Self::new()
    }
}

/// What is kept as a file.
macro_rules! file {
    ($content:ty, $kind:ident) => {
        impl ParamField for Attachment<$content> {
            const FLOATS: usize = 0;
            fn to_value(&self) -> ParamValue {
                ParamValue::File(Attached::$kind(self.clone()))
            }
            fn from_value(value: ParamValue) -> Option<Self> {
                if let ParamValue::File(Attached::$kind(file)) = value { Some(file) } else { None }
            }
            fn pack(&self, _: &mut &mut [f64]) {}
            fn unpack(_: &mut &[f64]) -> Self {
                Self::NONE
            }
        }
    };
}
file!(Heights, Heights);
file!(Face, Font);

impl ParamField for Points {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        ParamValue::List(List { rows: self.to_vec(), columns: &["X", "Y", "Z", "Radius"], count: POINTS })
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::List(list) = value { Some(Self::new(list.rows)) } else { None }
    }
    fn pack(&self, _: &mut &mut [f64]) {}
    fn unpack(_: &mut &[f64]) -> Self {
        Self::new([])
    }
}

impl ParamField for Corners {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        let rows = self.iter().map(|[x, y]| [*x, *y, 0.0, 0.0]).collect();
        ParamValue::List(List { rows, columns: &["X", "Y"], count: CORNERS })
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        let ParamValue::List(list) = value else { return None };
        Some(Self::new(list.rows.into_iter().map(|[x, y, ..]| [x, y]).collect::<Vec<_>>()))
    }
    fn pack(&self, _: &mut &mut [f64]) {}
    fn unpack(_: &mut &[f64]) -> Self {
        Self::new([])
    }
}
