//! The window: shows the editor, keeps its picture up to date.

use std::time::Duration;

use super::Shared;
use super::canvas::Canvas;
use crate::editor::{Editor, Message};
use crate::render::{Gpu, RenderError};

/// The window's content, as eframe runs it.
pub(super) struct Window {
    canvas: Canvas,
    shared: Shared,
    /// Whether the window has been painted: before its first picture, for which a driver may compile for seconds.
    is_open: bool,
    /// How long each frame waits, to see the window as it is on a slow machine.
    delay: Duration,
}

/// Names that time, in milliseconds.
const FRAME_DELAY: &str = "ISOLITH_FRAME_DELAY";

impl Window {
    /// Shows the editor that is in `shared`.
    pub fn new(context: &eframe::CreationContext<'_>, shared: Shared) -> Result<Self, RenderError> {
        Editor::setup(&context.egui_ctx);
        let state = context.wgpu_render_state.clone().expect("the window is opened with the wgpu renderer");
        let gpu = Gpu::watch(state.device.clone(), state.queue.clone(), state.adapter.get_info());
        *shared.gpu.borrow_mut() = Some(gpu.clone());
        crate::render::driver::loop_iterations(&gpu)?;
        let delay = std::env::var(FRAME_DELAY).ok().and_then(|text| text.parse().ok()).map(Duration::from_millis);
        Ok(Self { canvas: Canvas::new(gpu, state)?, shared, is_open: false, delay: delay.unwrap_or_default() })
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.canvas.is_lost() {
            // Nothing can be painted any more.
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        if !self.delay.is_zero() {
            std::thread::sleep(self.delay);
        }
        let mut slot = self.shared.editor.borrow_mut();
        let editor = &mut *slot;
        editor.show(ui, &self.canvas.picture());
        if !std::mem::replace(&mut self.is_open, true) {
            ui.ctx().request_repaint();
            return;
        }
        match self.canvas.update(editor, ui.ctx()) {
            Ok(()) => {}
            // What this frame has drawn cannot be painted: the pass is repeated, empty.
            Err(_) if self.canvas.is_lost() => ui.ctx().request_discard("the device is lost"),
            Err(error) => editor.report(Message::error(error.to_string())),
        }
    }
}
