//! The axes of a space.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::params::choices;

/// One of the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// To the right.
    X,
    /// Upward.
    Y,
    /// Toward a viewer in front.
    Z,
}

impl Axis {
    /// All of them, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Display name.
    pub fn label(self) -> &'static str {
        ["X", "Y", "Z"][self as usize]
    }

    /// Empty: the name says it all.
    fn help(self) -> &'static str {
        ""
    }
}

choices!(Axis);
