//! A whole picture at once, lit or looked at in another way.

use std::sync::Arc;
use std::time::Duration;

use super::{Frame, RenderError, Renderer, Slot, SlotState};
use crate::flat::inspect::{Look, Span};
use crate::flat::{Buffers, FlatScene, Warning};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;
use crate::render::gpu::Gpu;
use crate::render::kernel::Options;
use crate::render::kernels::Method;
use crate::render::passes::inspect::InspectPass;
use crate::render::passes::overlay::OverlaySettings;
use crate::render::readback::read_buffers;

impl Renderer {
    /// A renderer for looks that count: its kernels count, and components are walked by pruned lists, so that none
    /// has to be compiled for a look.
    pub fn counting(gpu: &Gpu) -> Result<Self, RenderError> {
        let mut renderer = Self::with_options(gpu, Options { counting: true, ..Self::options(gpu) })?;
        renderer.set_method(Method::Pruned);
        Ok(renderer)
    }

    /// The picture of a whole scene. `progress` is told the share that is done, between dispatches, and
    /// answers whether to go on.
    pub fn render(
        &mut self,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(Buffers, Vec<Warning>), RenderError> {
        self.render_as(Look::Shaded, flat, meshes, camera, size, progress)
    }

    /// The same by another look; for those that count the renderer must be one that does.
    pub fn render_as(
        &mut self,
        look: Look,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(Buffers, Vec<Warning>), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.inspect(&mut frame, look, flat, &Span::of(&flat.content(meshes), camera.position))?;
        while !frame.is_done() {
            if !progress(frame.progress()) {
                return Err(RenderError::Cancelled);
            }
            self.advance(&mut frame, Duration::ZERO)?;
        }
        progress(1.0);
        let buffers = read_buffers(&self.gpu, &self.slot(Slot::Full).targets)?;
        Ok((buffers, self.unfinished_rays(&frame)?))
    }

    /// Has the frame end as this look; distances are coloured within `span`. For looks that count the renderer must be
    /// one that does: others have counted nothing that could be shown.
    pub fn inspect(&mut self, frame: &mut Frame, look: Look, flat: &FlatScene, span: &Span) -> Result<(), RenderError> {
        assert!(self.counting || !look.counts(), "{} needs kernels that count", look.name());
        frame.look = look;
        if look != Look::Shaded {
            let Gpu { device, queue, .. } = &self.gpu;
            if self.inspect.is_none() {
                self.inspect = Some(InspectPass::new(device, &self.layouts)?);
            }
            if let Some(pass) = &mut self.inspect {
                pass.prepare((device, queue), flat, look, span);
            }
        }
        Ok(())
    }

    /// Colours the finished picture by the frame's look.
    pub(super) fn record_look(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let SlotState { targets, groups, .. } = self.slot(frame.slot);
        if let (true, Some(pass), Some(groups)) = (frame.look != Look::Shaded, &self.inspect, groups) {
            pass.record(&self.gpu.device, encoder, targets, &groups.view, self.march_counts.buffer());
        }
    }
}
