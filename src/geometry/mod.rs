//! Points, boxes, rays, transforms and cameras. Knows nothing of scenes.
//!
//! Conventions, for the whole program: right-handed, +Y up, metres, radians inside and degrees at
//! the border (files, inspector). Matrices are named `target_from_source`.

mod aabb;
mod camera;
mod ray;
mod transform;

pub use aabb::Aabb;
pub use camera::Camera;
pub use ray::Ray;
pub use transform::{Transform, singular_values};
