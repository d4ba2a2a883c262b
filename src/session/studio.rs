//! What a renderer does for a user interface beside the frames, in jobs. The interface names no renderer: whoever joins
//! both hands one over.

use std::path::PathBuf;
use std::sync::Arc;

use super::render_order::RenderOrder;
use super::scene_cost::{MeasuredView, SceneCost};
use isolith_field::Warning;
use isolith_jobs::Task;
use isolith_scene::Scene;

/// A small copy of a picture, finished or not.
#[derive(Clone, Debug, PartialEq)]
pub struct StillPreview {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// sRGB and straight alpha, row by row.
    pub pixels: Vec<[u8; 4]>,
    /// Samples so far, and of the complete picture.
    pub samples: [u32; 2],
    /// Its file, for a picture that goes into one.
    pub file: Option<PathBuf>,
}

/// What an order has made.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderReport {
    /// The files, in the order in which they were written.
    pub files: Vec<PathBuf>,
    /// Warnings, each once.
    pub warnings: Vec<Warning>,
    /// How long it took.
    pub seconds: f64,
}

/// Why an order was not carried out, or not to its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RenderRefusal {
    /// These files exist, and the order may not replace them. Nothing was rendered.
    Exists(Vec<PathBuf>),
    /// It was canceled. What is complete stays.
    Canceled,
    /// A reason for the user.
    Failed(String),
}

/// See the module.
pub trait Studio: Send + Sync {
    /// Renders the pictures of an order into their files, with progress and a preview of each picture while it refines.
    ///
    /// # Errors
    /// See [`RenderRefusal`].
    fn export(
        &self,
        order: &RenderOrder,
        task: &Task,
        show: &mut dyn FnMut(StillPreview),
    ) -> Result<RenderReport, RenderRefusal>;

    /// Draws a scene as its first camera sees it, or the whole of it. Its models lie in the folder.
    ///
    /// # Errors
    /// A reason for the user.
    fn thumbnail(
        &self,
        scene: &Scene,
        folder: Option<PathBuf>,
        size: [u32; 2],
        task: &Task,
    ) -> Result<StillPreview, String>;

    /// Measures what a picture takes.
    ///
    /// # Errors
    /// A reason for the user.
    fn measure(&self, view: &MeasuredView, task: &Task) -> Result<SceneCost, String>;

    /// The adapter that the user has chosen by name.
    fn adapter(&self) -> Option<String> {
        None
    }
}

/// A shared studio.
pub type SharedStudio = Arc<dyn Studio>;
