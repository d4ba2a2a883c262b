//! The passes, each with its shader of the same name, in the order of the frame: mesh, hiz, cone, trace,
//! surface, shade, debug_view, overlay. Cone, trace and surface evaluate the field and live together in `field`.

pub mod debug_view;
pub mod field;
pub mod hiz;
pub mod mesh;
pub mod overlay;
pub mod shade;
