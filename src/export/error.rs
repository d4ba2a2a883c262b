//! Errors on the way from a scene to files.

use std::path::PathBuf;

use thiserror::Error;

use crate::field::FlattenError;
use crate::render::{GpuError, RenderError};

/// Why there is no picture, or no file of it.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The settings do not fit the scene.
    #[error("{0}")]
    Settings(String),
    /// The scene is beyond a limit.
    #[error(transparent)]
    Limit(#[from] FlattenError),
    /// The renderer failed.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// An output cannot be written.
    #[error("{}: cannot be written: {reason}", path.display())]
    Write {
        /// The output.
        path: PathBuf,
        /// The error of the system.
        reason: String,
    },
    /// It was canceled.
    #[error("canceled")]
    Canceled,
}

impl From<GpuError> for ExportError {
    fn from(error: GpuError) -> Self {
        Self::Render(error.into())
    }
}
