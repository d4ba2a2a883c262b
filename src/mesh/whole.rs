//! Whole numbers of a glTF file.

use serde::de::{Deserialize, Deserializer, Error, Visitor};

/// A whole number that is not negative. `5.0` counts as one, too: some exporters write it so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Whole(pub u64);

impl Whole {
    /// The number as an index; one beyond the address space becomes an index that no list has.
    pub fn index(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WholeVisitor)
    }
}

struct WholeVisitor;

/// Above this f64 cannot represent every whole number.
const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

impl Visitor<'_> for WholeVisitor {
    type Value = Whole;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a whole number that is not negative")
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Whole, E> {
        Ok(Whole(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Whole, E> {
        u64::try_from(value).map(Whole).map_err(|_| E::custom(format!("{value} is negative")))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Whole, E> {
        if (0.0..LARGEST_EXACT).contains(&value) && value.fract() == 0.0 {
            return Ok(Whole(value as u64));
        }
        Err(E::custom(format!("{value} is not a whole number")))
    }
}
