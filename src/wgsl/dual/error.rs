//! Why there is no derivative.

use thiserror::Error;

/// Why a function has no dual function.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DualError {
    /// The source is no WGSL.
    #[error("the distance function cannot be read: {0}")]
    Source(String),
    /// The source holds no function of this name.
    #[error("there is no function {0}")]
    NoFunction(String),
    /// The function uses something that has no rule here.
    #[error("{function}: no derivative of {construct}")]
    Unsupported {
        /// The function, which the one asked for may call.
        function: String,
        /// What it uses.
        construct: String,
    },
}
