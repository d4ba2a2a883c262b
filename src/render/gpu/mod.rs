//! The GPU: adapters, the device with its limits and errors, and readback.

pub mod adapter;
pub mod brdf_probe;
pub mod copy_probe;
mod device;
pub mod driver;
mod error;
pub mod mesh_ray_probe;
pub mod probe;
pub mod readback;
pub mod scene_probe;

pub use adapter::{AdapterChoice, AdapterSummary, adapters, instance_descriptor};
pub use device::{Gpu, device_descriptor};
pub use error::GpuError;
