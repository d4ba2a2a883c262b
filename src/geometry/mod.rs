//! Points, arcs, boxes, rays, transforms and cameras. Independent of scenes.
//!
//! Conventions, for the whole program: right-handed, +Y up, meters, radians inside and degrees at
//! the border (files, inspector). Matrices are named `target_from_source`.

mod aabb;
mod arc;
mod arc_union;
mod camera;
mod jitter;
mod lens;
mod ray;
mod transform;

pub use aabb::Aabb;
pub use arc::{ArcPiece, biarc, smooth_curve, straight_curve};
pub use arc_union::{TooDense, arc_union};
pub use camera::Camera;
pub use jitter::{pixel_jitter, radical_inverse};
pub use lens::{Lens, SampleView};
pub use ray::Ray;
pub use transform::{Transform, singular_values};
