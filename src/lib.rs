//! Isolith: building, animating and rendering scenes of signed distance functions.
//!
//! The architecture is described in `src/README.md`.

#[cfg(feature = "window")]
pub mod app;
pub mod bench;
pub mod cli;
pub mod export;

pub use isolith_bricks as bricks;
pub use isolith_document as document;
#[cfg(feature = "window")]
pub use isolith_editor as editor;
pub use isolith_field as field;
pub use isolith_font as font;
pub use isolith_gallery as gallery;
pub use isolith_geometry as geometry;
pub use isolith_guard as guard;
pub use isolith_jobs as jobs;
pub use isolith_mesh as mesh;
pub use isolith_render as render;
pub use isolith_scene as scene;
pub use isolith_session as session;
pub use isolith_wgsl as wgsl;
