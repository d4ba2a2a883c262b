//! Errors of differentiation.

use thiserror::Error;

/// Why a function has no dual function.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DualError {
    /// The source is not valid WGSL.
    #[error("the distance function cannot be read: {0}")]
    Source(String),
    /// The source has no function of this name.
    #[error("there is no function {0}")]
    NoFunction(String),
    /// The function uses a construct without a rule.
    #[error("{function}: no derivative of {construct}")]
    Unsupported {
        /// The function: the requested one, or one that it calls.
        function: String,
        /// The construct.
        construct: String,
    },
}
