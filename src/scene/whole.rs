//! Whole numbers in files. JSON has one kind of number: `3.0` is as whole as `3`, as the schema says, and some programs
//! write all numbers that way.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error, Unexpected, Visitor};

/// Above this, `f64` cannot represent every whole number, so a value may stand for another.
const MAX_EXACT: f64 = (1_u64 << 53) as f64;

/// Reads a whole number in any notation.
pub(super) fn read<'de, D: Deserializer<'de>, T: TryFrom<u64>>(deserializer: D) -> Result<T, D::Error> {
    // Deserializes a number of any kind: when serde buffers an enum with an inner `type`, a number accepts only the
    // kind that it was buffered as.
    deserializer.deserialize_f64(Whole(PhantomData))
}

/// Reads three whole numbers.
pub(super) fn read_three<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u32; 3], D::Error> {
    struct Count(u32);
    impl<'de> Deserialize<'de> for Count {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            read(deserializer).map(Self)
        }
    }
    <[Count; 3]>::deserialize(deserializer).map(|counts| counts.map(|count| count.0))
}

struct Whole<T>(PhantomData<T>);

impl<T: TryFrom<u64>> Visitor<'_> for Whole<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a whole number from 0")?;
        let most: u64 = if size_of::<T>() == 8 { u64::MAX } else { (1 << (8 * size_of::<T>())) - 1 };
        if most == u64::MAX { Ok(()) } else { write!(f, " to {most}") }
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<T, E> {
        T::try_from(value).map_err(|_| E::invalid_value(Unexpected::Unsigned(value), &self))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        let whole = u64::try_from(value).ok().and_then(|value| T::try_from(value).ok());
        whole.ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        if value.fract() != 0.0 || !(0.0..=MAX_EXACT).contains(&value) {
            return Err(E::invalid_type(Unexpected::Float(value), &self));
        }
        T::try_from(value as u64).map_err(|_| E::invalid_value(Unexpected::Float(value), &self))
    }
}
