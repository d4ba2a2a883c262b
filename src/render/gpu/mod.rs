//! The device: which adapter, its limits, its errors, and what is read back from it.

mod adapter;
mod device;
pub mod driver;
pub mod probe;
pub mod readback;
pub mod scene_probe;

pub use adapter::{AdapterChoice, AdapterSummary, adapters};
pub use device::{Gpu, GpuError, device_descriptor, instance_descriptor};
