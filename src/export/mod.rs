//! Pictures as files: the one way from a scene to rendered files, for the command line and for the window.
//!
//! | file | holds |
//! |---|---|
//! | `still` | a scene at a moment, ready to be drawn, and the renderer that draws it |
//! | `outputs` | buffers → files |
//! | `exr_light`, `exr_ids`, `exr_layers` | linear light, ids, and all of a picture as OpenEXR channels |
//! | `exr_header` | attributes in an order of their own |
//! | `costs` | what a picture takes, measured |
//! | `studio` | orders of the window, carried out in jobs |
//! | `error` | errors |

mod costs;
mod error;
mod exr_header;
mod exr_ids;
mod exr_layers;
mod exr_light;
pub mod outputs;
mod still;
mod studio;

pub use error::ExportError;
pub use still::{Drawn, Still, StillPainter, StillSettings, Stills};
pub use studio::GpuStudio;
