//! The types that a parameter of a shape can have.

use glam::DVec3;

use super::drawn::{Corners, Points};
use super::limits::{CORNERS, Limits, POINTS, SIZE};

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

/// A Rust type that a parameter can have.
pub(super) trait ParamField: Sized {
    /// How many numbers it takes among those that a shape is evaluated with.
    const FLOATS: usize;
    fn to_value(&self) -> ParamValue;
    fn from_value(value: ParamValue) -> Option<Self>;
}

impl ParamField for f64 {
    const FLOATS: usize = 1;
    fn to_value(&self) -> ParamValue {
        ParamValue::Scalar(*self)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Scalar(v) = value { Some(v) } else { None }
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
}

impl ParamField for bool {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        ParamValue::Flag(*self)
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Flag(v) = value { Some(v) } else { None }
    }
}

impl ParamField for Points {
    const FLOATS: usize = 0;
    fn to_value(&self) -> ParamValue {
        ParamValue::List(List { rows: self.to_vec(), columns: &["X", "Y", "Z", "Radius"], count: POINTS })
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::List(list) = value { Some(Self::new(list.rows)) } else { None }
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
}
