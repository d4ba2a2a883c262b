//! The device: found, opened, watched.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use super::adapter::{self, AdapterChoice};
use super::error::GpuError;

/// A device and its queue, and what became of them.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Which driver and card.
    pub info: wgpu::AdapterInfo,
    health: Arc<Health>,
}

#[derive(Debug, Default)]
struct Health {
    lost: AtomicBool,
    messages: Mutex<Vec<String>>,
}

impl Gpu {
    /// A device without a window, on the adapter that the environment names or on the fastest.
    pub fn headless() -> Result<Self, GpuError> {
        Self::open(&AdapterChoice::new(None))
    }

    /// A device without a window.
    pub fn open(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let instance = adapter::instance();
        Self::on(&choice.pick(&adapter::all(&instance), |_| true)?)
    }

    /// A second device on the same adapter.
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

    /// Takes over a device opened elsewhere, and installs the handlers for loss and for errors that
    /// nobody catches: without them either would end the program.
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

    /// Whether the device is gone; a new one must be opened.
    pub fn is_lost(&self) -> bool {
        // The loss is told of when the device is polled; an error of that shows in the health, too.
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.health.lost.load(Ordering::Acquire)
    }

    /// Takes what the device complained about since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        self.health.messages.lock().map(|mut m| std::mem::take(&mut *m)).unwrap_or_default()
    }

    /// An error if the device is gone or has complained since the last call.
    pub fn check(&self) -> Result<(), GpuError> {
        let is_lost = self.is_lost();
        let messages = self.take_messages();
        match (is_lost, messages.is_empty()) {
            (true, _) => Err(GpuError::Lost(messages.join("; "))),
            (false, false) => Err(GpuError::Refused(messages.join("; "))),
            (false, true) => Ok(()),
        }
    }

    /// Waits until everything submitted so far is done.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| GpuError::Lost(e.to_string()))?;
        self.check()
    }

    /// Whether the driver computes on the processor: lavapipe, SwiftShader and their like.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }
}

impl Health {
    fn say(&self, message: String) {
        let message = one_line(&message);
        if let Ok(mut messages) = self.messages.lock() {
            // A broken device may complain without end.
            if messages.len() < 64 {
                messages.push(message);
            }
        }
    }
}

/// A driver's message without its line breaks.
fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Storage textures of a pass: up to four targets, the rows and the tapes. WebGPU's default is four.
const STORAGE_TEXTURES: u32 = 6;

/// What is asked of a device: WebGPU's defaults, with buffers as large as the adapter allows, and its clock where it has one.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let offered = adapter.limits();
    let required_limits = wgpu::Limits {
        max_texture_dimension_2d: offered.max_texture_dimension_2d,
        max_buffer_size: offered.max_buffer_size,
        max_storage_textures_per_shader_stage: STORAGE_TEXTURES,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        ..wgpu::Limits::default()
    };
    let required_features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
    wgpu::DeviceDescriptor { label: Some("isolith"), required_features, required_limits, ..Default::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the driver refuses says what it is, and the device goes on; only a device that is gone is lost.
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
