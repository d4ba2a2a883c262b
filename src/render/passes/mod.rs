//! The passes, each with its shader of the same name, in the order of the frame: mesh, trace, surface,
//! shade, overlay.

pub mod mesh;
pub mod overlay;
pub mod shade;
pub mod surface;
pub mod trace;
