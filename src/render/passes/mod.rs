//! The passes, each with its shader of the same name, in the order of the frame: mesh, farthest, cone, trace,
//! surface, shade, inspect, overlay. Cone, trace and surface evaluate the field and live together in `field`.

pub mod farthest;
pub mod field;
pub mod inspect;
pub mod mesh;
pub mod overlay;
pub mod shade;
