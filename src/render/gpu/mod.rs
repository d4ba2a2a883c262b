//! The device: which adapter, its limits, its errors, and what is read back from it.

pub mod adapter;
mod device;
pub mod driver;
mod error;
pub mod probe;
pub mod readback;
pub mod scene_probe;

pub use adapter::{AdapterChoice, AdapterSummary, adapters, instance_descriptor};
pub use device::{Gpu, device_descriptor};
pub use error::GpuError;
