//! Failures of commands, as messages for people and as JSON for scripts.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::export::ExportError;
use crate::field::FlattenError;
use crate::field::reference::trace::TraceError;
use crate::render::{GpuError, RenderError};
use crate::scene::Scene;
use crate::scene::file::FileError;

/// Why a command failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// The arguments are invalid for this scene.
    #[error("{0}")]
    Usage(String),
    /// The scene file is missing, broken or beyond a limit.
    #[error("{0}")]
    Scene(FileError),
    /// There is no usable graphics adapter, device or window.
    #[error("{0}")]
    Graphics(String),
    /// An output cannot be written.
    #[error("{}: cannot be written: {reason}", path.display())]
    Write {
        /// The output.
        path: PathBuf,
        /// The error of the system.
        reason: String,
    },
    /// The user pressed Ctrl-C.
    #[error("canceled")]
    Canceled,
    /// There are warnings, and `--strict` makes them errors.
    #[error("{}: {count} warnings, which --strict makes errors", file.display())]
    Strict {
        /// The scene.
        file: PathBuf,
        /// Number of warnings.
        count: usize,
    },
    /// Some of several scenes cannot be used; each was reported before.
    #[error("{bad} of {all} scenes cannot be used")]
    Several {
        /// Number of scenes that cannot be used.
        bad: usize,
        /// Number of all scenes.
        all: usize,
    },
    /// Anything else.
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// The failure of a scene that cannot be flattened: a fault of its file, at a node.
    pub fn beyond_limit(scene: &Path, error: &FlattenError) -> Self {
        Self::Scene(FileError {
            file: scene.display().to_string(),
            node: Some(format!("{} {}", error.name, error.node)),
            field: None,
            reason: format!("{} is {}, and the limit is {}", error.what, error.value, error.limit),
        })
    }

    /// The failure to make a picture of this scene.
    pub fn of_export(error: ExportError, scene: &Path) -> Self {
        match error {
            ExportError::Limit(error) => Self::beyond_limit(scene, &error),
            other => other.into(),
        }
    }

    /// The failure as one JSON object: `ok`, `file`, `node`, `field`, `reason`.
    pub fn to_json(&self, file: &Path) -> serde_json::Value {
        let (file, node, field, reason) = match self {
            Self::Scene(error) => (error.file.clone(), error.node.clone(), error.field.clone(), error.reason.clone()),
            Self::Write { path, reason } => (path.display().to_string(), None, None, reason.clone()),
            other => (file.display().to_string(), None, None, other.to_string()),
        };
        serde_json::json!({ "ok": false, "file": file, "node": node, "field": field, "reason": reason })
    }

    /// The failure of a scene whose reference does not end: a node of its file is beyond a limit.
    pub fn given_up(path: &Path, scene: &Scene, error: &TraceError) -> Self {
        let name = scene.node(error.node).map_or("", |node| node.name.as_str());
        Self::Scene(FileError {
            file: path.display().to_string(),
            node: Some(format!("{name} {}", error.node)),
            field: None,
            reason: error.to_string(),
        })
    }

    /// The program's exit code; `--help` and the README list them.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Other(_) => 1,
            Self::Usage(_) => 2,
            Self::Scene(_) | Self::Strict { .. } | Self::Several { .. } => 3,
            Self::Graphics(_) => 4,
            Self::Write { .. } => 5,
            Self::Canceled => 130,
        }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::NoAdapter | GpuError::NoDevice { .. } => Self::Graphics(error.to_string()),
            GpuError::NoSuchAdapter { .. } => Self::Usage(error.to_string()),
            GpuError::Lost(_) | GpuError::Refused(_) => Self::Other(error.to_string()),
        }
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Settings(reason) => Self::Usage(reason),
            ExportError::Limit(error) => Self::Other(error.to_string()),
            ExportError::Render(error) => error.into(),
            ExportError::Write { path, reason } => Self::Write { path, reason },
            ExportError::Canceled => Self::Canceled,
        }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Canceled => Self::Canceled,
            RenderError::Gpu(error) => error.into(),
            RenderError::Size(..) => Self::Usage(error.to_string()),
            RenderError::Shader(_)
            | RenderError::Counts(..)
            | RenderError::Copies(..)
            | RenderError::TooManyDispatches(..)
            | RenderError::ListBytes { .. } => Self::Other(error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Group, Node, NodeKind};

    #[test]
    fn a_reference_that_is_given_up_names_file_and_node() {
        let mut scene = Scene::new();
        let node = scene.insert(None, 0, Node::new("n0", NodeKind::Group(Group::UNION))).expect("room");
        let failure = Failure::given_up(Path::new("slow.json"), &scene, &TraceError { node });
        assert!(failure.to_string().starts_with("slow.json: n0 #1: a ray was not at its end"), "{failure}");
        assert_eq!(failure.exit_code(), 3);
    }
}
