//! The values of parameters, and the types that hold one.

use std::fmt;

use glam::{DQuat, DVec3};
use serde::Deserializer;

use super::ParamField;
use crate::attached::Attached;
use crate::attachment::Attachment;
use crate::drawn::{Corners, Points};
use crate::environment_image::EnvironmentImage;
use crate::heights::Heights;
use crate::limits::{CORNERS, Limits, POINTS, SIZE};
use crate::texture_image::TextureImage;
use crate::whole;
use isolith_font::Face;

/// Most numbers in a row of a list.
pub const LIST_COLUMNS: usize = 4;

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// One number.
    Scalar(f64),
    /// Three numbers: a size, a point, a color.
    Vector(DVec3),
    /// A whole number.
    Count(u32),
    /// A whole number for each axis.
    Counts([u32; 3]),
    /// On or off.
    Flag(bool),
    /// On or off for each axis.
    Flags([bool; 3]),
    /// One of the choices of the parameter, by its key in files.
    Choice(&'static str),
    /// A unit quaternion.
    Rotation(DQuat),
    /// Points.
    List(List),
    /// Text.
    Text(String),
    /// A file.
    File(Attached),
}

/// Points as rows of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct List {
    /// The rows; entries behind the last column are 0.
    pub rows: Vec<[f64; LIST_COLUMNS]>,
    /// The names of the columns.
    pub columns: &'static [&'static str],
    /// Fewest and most rows.
    pub count: [usize; 2],
}

impl List {
    /// The limits of the numbers in a column, given the `limits` of the parameter.
    pub fn limits(&self, column: usize, limits: &Limits) -> Limits {
        if column < 3 { *limits } else { SIZE }
    }
}

impl ParamValue {
    /// One of the three elements of a value per axis or channel.
    pub fn element(&self, index: usize) -> Option<Self> {
        match self {
            Self::Vector(v) => v.to_array().get(index).map(|v| Self::Scalar(*v)),
            Self::Counts(v) => v.get(index).map(|v| Self::Count(*v)),
            Self::Flags(v) => v.get(index).map(|v| Self::Flag(*v)),
            _ => None,
        }
    }

    /// The same value with one of its three elements replaced; `None` if it has no such element of that type.
    pub fn with_element(&self, index: usize, value: &Self) -> Option<Self> {
        let mut new = self.clone();
        match (&mut new, value) {
            (Self::Vector(all), Self::Scalar(v)) if index < 3 => all[index] = *v,
            (Self::Counts(all), Self::Count(v)) => *all.get_mut(index)? = *v,
            (Self::Flags(all), Self::Flag(v)) => *all.get_mut(index)? = *v,
            _ => return None,
        }
        Some(new)
    }
}

impl fmt::Display for ParamValue {
    /// As in files, but points are only counted and attachments only named.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scalar(v) => write!(f, "{v}"),
            Self::Vector(v) => write!(f, "[{}, {}, {}]", v.x, v.y, v.z),
            Self::Count(v) => write!(f, "{v}"),
            Self::Counts(v) => write!(f, "{v:?}"),
            Self::Flag(v) => write!(f, "{v}"),
            Self::Flags(v) => write!(f, "{v:?}"),
            Self::Choice(key) => f.write_str(key),
            Self::Rotation(q) => write!(f, "[{}, {}, {}, {}]", q.x, q.y, q.z, q.w),
            Self::List(list) => write!(f, "{} points", list.rows.len()),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::File(file) => match file.name() {
                Some(name) => write!(f, "{name:?}"),
                None => f.write_str("none"),
            },
        }
    }
}

macro_rules! fields {
    ($($type:ty = $variant:ident $(by $read:path)?;)+) => { $(
        impl ParamField for $type {
            fn to_value(&self) -> Option<ParamValue> {
                Some(ParamValue::$variant(*self))
            }
            fn from_value(value: ParamValue) -> Option<Self> {
                if let ParamValue::$variant(v) = value { Some(v) } else { None }
            }
            $( fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $read(deserializer)
            } )?
        }
    )+ };
}

fields! {
    f64 = Scalar;
    DVec3 = Vector;
    u32 = Count by whole::read;
    [u32; 3] = Counts by whole::read_three;
    bool = Flag;
    [bool; 3] = Flags;
    DQuat = Rotation;
}

impl ParamField for [f64; 3] {
    fn to_value(&self) -> Option<ParamValue> {
        Some(ParamValue::Vector((*self).into()))
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Vector(v) = value { Some(v.to_array()) } else { None }
    }
}

impl ParamField for String {
    const ANIMATABLE: bool = false;
    fn to_value(&self) -> Option<ParamValue> {
        Some(ParamValue::Text(self.clone()))
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::Text(v) = value { Some(v) } else { None }
    }
}

/// Implements the field for a type of attachment.
macro_rules! file {
    ($content:ty, $kind:ident) => {
        impl ParamField for Attachment<$content> {
            const ANIMATABLE: bool = false;
            fn to_value(&self) -> Option<ParamValue> {
                Some(ParamValue::File(Attached::$kind(self.clone())))
            }
            fn from_value(value: ParamValue) -> Option<Self> {
                if let ParamValue::File(Attached::$kind(file)) = value { Some(file) } else { None }
            }
        }
    };
}
file!(Heights, Heights);
file!(TextureImage, Texture);
file!(Face, Font);
file!(EnvironmentImage, Environment);

impl ParamField for Points {
    const ANIMATABLE: bool = false;
    fn to_value(&self) -> Option<ParamValue> {
        Some(ParamValue::List(List { rows: self.to_vec(), columns: &["X", "Y", "Z", "Radius"], count: POINTS }))
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        if let ParamValue::List(list) = value { Some(Self::new(list.rows)) } else { None }
    }
}

impl ParamField for Corners {
    const ANIMATABLE: bool = false;
    fn to_value(&self) -> Option<ParamValue> {
        let rows = self.iter().map(|[x, y]| [*x, *y, 0.0, 0.0]).collect();
        Some(ParamValue::List(List { rows, columns: &["X", "Y"], count: CORNERS }))
    }
    fn from_value(value: ParamValue) -> Option<Self> {
        let ParamValue::List(list) = value else { return None };
        Some(Self::new(list.rows.into_iter().map(|[x, y, ..]| [x, y]).collect::<Vec<_>>()))
    }
}
