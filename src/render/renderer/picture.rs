//! A whole picture at once, lit or looked at in another way.

use std::sync::Arc;
use std::time::Duration;

use super::{Frame, RenderError, Renderer, Slot, SlotState};
use crate::flat::debug_view::{DepthRange, ViewMode};
use crate::flat::{FlatScene, GBuffer, Warning};
use crate::geometry::Camera;
use crate::mesh::TriangleMesh;
use crate::render::gpu::Gpu;
use crate::render::gpu::readback::read_buffers;
use crate::render::passes::debug_view::DebugViewPass;
use crate::render::passes::overlay::OverlaySettings;
use crate::render::pipelines::strategy::EvalStrategy;
use crate::render::wgsl::Options;

impl Renderer {
    /// A renderer for view modes that count: its pipelines count, and components are walked by tapes, so that none
    /// has to be compiled for a view mode.
    pub fn counting(gpu: &Gpu) -> Result<Self, RenderError> {
        let mut renderer = Self::with_options(gpu, Options { counting: true, ..Self::options(gpu) })?;
        renderer.set_strategy(EvalStrategy::Tape);
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
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        self.render_as(ViewMode::Shaded, flat, meshes, camera, size, progress)
    }

    /// The same by another view mode; for those that count the renderer must be one that does.
    pub fn render_as(
        &mut self,
        view_mode: ViewMode,
        flat: &FlatScene,
        meshes: &[Option<Arc<TriangleMesh>>],
        camera: &Camera,
        size: [u32; 2],
        progress: &mut dyn FnMut(f32) -> bool,
    ) -> Result<(GBuffer, Vec<Warning>), RenderError> {
        let mut frame = self.begin(Slot::Full, flat, meshes, camera, size, OverlaySettings::default())?;
        self.debug_view(&mut frame, view_mode, flat, &DepthRange::of(&flat.content(meshes), camera.position))?;
        while !frame.is_done() {
            if !progress(frame.progress()) {
                return Err(RenderError::Canceled);
            }
            self.advance(&mut frame, Duration::ZERO)?;
        }
        progress(1.0);
        let buffers = read_buffers(&self.gpu, &self.slot(Slot::Full).targets)?;
        Ok((buffers, self.unfinished_rays(&frame)?))
    }

    /// Has the frame end as this look; distances are colored within `depth_range`. For view modes that count the renderer must be
    /// one that does: others have counted nothing that could be shown.
    pub fn debug_view(
        &mut self,
        frame: &mut Frame,
        view_mode: ViewMode,
        flat: &FlatScene,
        depth_range: &DepthRange,
    ) -> Result<(), RenderError> {
        assert!(self.counting || !view_mode.counts(), "{} needs pipelines that count", view_mode.name());
        frame.view_mode = view_mode;
        if view_mode != ViewMode::Shaded {
            let Gpu { device, queue, .. } = &self.gpu;
            if self.debug_view.is_none() {
                self.debug_view = Some(DebugViewPass::new(device, &self.layouts)?);
            }
            if let Some(pass) = &mut self.debug_view {
                pass.prepare((device, queue), flat, view_mode, depth_range);
            }
        }
        Ok(())
    }

    /// Colors the finished picture by the frame's look.
    pub(super) fn record_debug_view(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let SlotState { targets, groups, .. } = self.slot(frame.slot);
        if let (true, Some(pass), Some(groups)) = (frame.view_mode != ViewMode::Shaded, &self.debug_view, groups) {
            pass.record(&self.gpu.device, encoder, targets, &groups.view, self.march_counts.buffer());
        }
    }
}
