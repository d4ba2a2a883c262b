//! Isolith: building, animating and rendering scenes of signed distance functions.
//!
//! The architecture is described in `src/README.md`.

pub mod app;
pub mod bench;
pub mod cli;
pub mod document;
pub mod editor;
pub mod flat;
pub mod font;
pub mod gallery;
pub mod geometry;
pub mod guard;
pub mod jobs;
pub mod mesh;
pub mod render;
pub mod scene;
pub mod session;
