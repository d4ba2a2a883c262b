//! The device: opening it, and watching for errors and loss.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use super::adapter::{self, AdapterChoice};
use super::error::GpuError;

/// A device and its queue, with their health.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The driver and the graphics card.
    pub info: wgpu::AdapterInfo,
    health: Arc<Health>,
}

#[derive(Debug, Default)]
struct Health {
    lost: AtomicBool,
    messages: Mutex<Vec<String>>,
}

impl Gpu {
    /// Opens a device without a window, on the adapter that the environment names or on the fastest.
    pub fn headless() -> Result<Self, GpuError> {
        Self::open(&AdapterChoice::new(None))
    }

    /// Opens a device without a window.
    pub fn open(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let instance = adapter::instance();
        Self::on(&choice.pick(&adapter::all(&instance), |_| true)?)
    }

    /// Opens a second device on the same adapter.
    pub fn another(&self) -> Result<Self, GpuError> {
        let instance = adapter::instance();
        let found = adapter::all(&instance).into_iter().find(|adapter| adapter.get_info() == self.info);
        Self::on(&found.ok_or(GpuError::NoAdapter)?)
    }

    fn on(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|e| GpuError::NoDevice { adapter: info.name.clone(), reason: one_line(&e.to_string()) })?;
        Ok(Self::watch(device, queue, info))
    }

    /// Takes over a device that another part of the program opened. Installs handlers for loss and for uncaught errors:
    /// without them wgpu ends the program in both cases.
    pub fn watch(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        let health = Arc::new(Health::default());
        let of_loss = health.clone();
        device.set_device_lost_callback(move |reason, message| {
            of_loss.say(format!("{reason:?}: {message}"));
            of_loss.lost.store(true, Ordering::Release);
        });
        let of_error = health.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| of_error.say(error.to_string())));
        Self { device, queue, info, health }
    }

    /// Whether the device is lost. A lost device must be replaced.
    pub fn is_lost(&self) -> bool {
        // Polling reports the loss. An error of the poll itself also shows in the health.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.health.lost.load(Ordering::Acquire)
    }

    /// Takes the errors that the device has reported since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        self.health.messages.lock().map(|mut m| std::mem::take(&mut *m)).unwrap_or_default()
    }

    /// Fails if the device is lost or has reported an error since the last call.
    pub fn check(&self) -> Result<(), GpuError> {
        let is_lost = self.is_lost();
        let messages = self.take_messages();
        match (is_lost, messages.is_empty()) {
            (true, _) => Err(GpuError::Lost(messages.join("; "))),
            (false, false) => Err(GpuError::Refused(messages.join("; "))),
            (false, true) => Ok(()),
        }
    }

    /// Waits until the device has finished all submitted work.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| GpuError::Lost(e.to_string()))?;
        self.check()
    }

    /// Whether it is a software driver: lavapipe, SwiftShader and the like.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }
}

impl Health {
    fn say(&self, message: String) {
        let message = one_line(&message);
        if let Ok(mut messages) = self.messages.lock() {
            // A broken device may report errors without end.
            if messages.len() < 64 {
                messages.push(message);
            }
        }
    }
}

/// A driver's message in one line.
fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Storage textures of a pass: up to four targets, rows, tapes, bricks and images. WebGPU's default limit is four.
const STORAGE_TEXTURES: u32 = 8;

/// Storage buffers of a pass: rays through copies that are cut out by textures. WebGPU's default limit is eight.
const STORAGE_BUFFERS: u32 = 11;

/// Bytes of a pixel in all targets that the mesh pass draws into. WebGPU's default limit is 32.
const COLOR_ATTACHMENT_BYTES: u32 = 48;

/// Requirements on a device: WebGPU's defaults, with buffers as large as the adapter allows, and timestamps if it has
/// them.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let offered = adapter.limits();
    let required_limits = wgpu::Limits {
        max_texture_dimension_2d: offered.max_texture_dimension_2d,
        max_buffer_size: offered.max_buffer_size,
        max_storage_textures_per_shader_stage: STORAGE_TEXTURES,
        max_storage_buffers_per_shader_stage: STORAGE_BUFFERS,
        max_color_attachment_bytes_per_sample: COLOR_ATTACHMENT_BYTES,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..wgpu::Limits::default()
    };
    let required_features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
    wgpu::DeviceDescriptor { label: Some("isolith"), required_features, required_limits, ..Default::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The driver's refusal comes back with its reason, and the device remains usable: only a device that is gone is
    /// lost.
    #[test]
    fn a_refused_command_is_not_a_lost_device() {
        let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::STORAGE;
        let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage,
            mapped_at_creation: false,
        });
        let error = gpu.check().expect_err("such a buffer is not allowed");
        assert!(matches!(error, GpuError::Refused(_)), "{error}");
        assert_eq!(error.to_string().lines().count(), 1);
        assert!(gpu.check().is_ok(), "a complaint is made once");
        gpu.another().unwrap_or_else(|error| panic!("{error}"));
        gpu.device.destroy();
        let error = gpu.wait().expect_err("the device is gone");
        assert!(matches!(error, GpuError::Lost(_)), "{error}");
    }
}
