//! Errors of rendering.

use thiserror::Error;

use crate::gpu::GpuError;
use isolith_scene::NodeId;
use isolith_wgsl::ShaderError;

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum RenderError {
    /// Error of the device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A shader could not be assembled.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The picture is larger than the device allows.
    #[error("a picture of {0} by {1} pixels is not possible; the device's limit is {2} a side")]
    Size(u32, u32, u32),
    /// The counters of all pixels do not fit into one buffer of the device.
    #[error("a picture of {0} by {1} pixels is too large to count what each of them takes")]
    Counts(u32, u32),
    /// Which copies the pixels show does not fit into one buffer of the device.
    #[error("a picture of {0} by {1} pixels is too large to remember which copy each of them shows")]
    Copies(u32, u32),
    /// The plan needs more dispatches than one buffer of the device can hold, mostly for this node.
    #[error("a picture of {0} by {1} pixels takes too many steps for this device, most of them for node {2}")]
    TooManyDispatches(u32, u32, NodeId),
    /// The subtile lists exceed the largest binding of the device.
    #[error(
        "a picture of {} by {} pixels takes lists of {needed} bytes for the places that components cover, most of them \
         for node {node}; this device binds at most {limit} bytes",
        size[0], size[1]
    )]
    ListBytes {
        /// Width and height of the picture.
        size: [u32; 2],
        /// The node with the longest lists.
        node: NodeId,
        /// Bytes that the lists need.
        needed: u64,
        /// Bytes that the device can bind.
        limit: u64,
    },
    /// The caller asked to stop.
    #[error("canceled")]
    Canceled,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::adapter::{AdapterChoice, all, instance};
    use crate::{EvalStrategy, Gpu, Renderer, device_descriptor};
    use isolith_field::flatten;
    use isolith_gallery as gallery;

    /// A device that binds at most `bytes` bytes of a storage buffer.
    fn device_that_binds(bytes: u64) -> Gpu {
        let adapter = AdapterChoice::new(None).pick(&all(&instance()), |_| true).expect("an adapter");
        let mut descriptor = device_descriptor(&adapter);
        descriptor.required_limits.max_storage_buffer_binding_size = bytes;
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
        Gpu::watch(device, queue, adapter.get_info())
    }

    /// 65 536 balls in one place needed lists of a gigabyte, and the driver refused the bind group.
    #[test]
    fn lists_larger_than_a_binding_are_refused_with_node_limit_and_size() {
        const LIMIT: u64 = 1 << 16;
        let flat = flatten(&gallery::crowd(64, false, 1), 0.0).expect("within the limits");
        let camera = flat.default_camera(&[], 1.0);
        let mut renderer = Renderer::new(&device_that_binds(LIMIT)).expect("a renderer");
        renderer.set_strategy(EvalStrategy::Interpreter);
        let mut draw = |side| renderer.render(&flat, &[], &camera, [side; 2], &mut |_| true).map(|_| ());
        let error = draw(512).expect_err("its lists are too large");
        let RenderError::ListBytes { size, node, needed, limit } = error else { panic!("{error}") };
        assert!(size == [512; 2] && flat.ids.contains(&node) && needed > limit && limit == LIMIT, "{error}");
        let text = error.to_string();
        for part in ["512 by 512", &format!("node {node}"), &needed.to_string(), "at most 65536 bytes"] {
            assert!(text.contains(part), "{text}");
        }
        draw(16).expect("a small picture has room");
    }
}
