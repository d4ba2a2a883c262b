//! The window: shows the editor, keeps its picture up to date.

use std::cell::RefCell;
use std::rc::Rc;

use super::canvas::Canvas;
use super::{Ending, Parked};
use crate::editor::{Editor, Message};
use crate::render::{Gpu, RenderError};

/// The window's content, as eframe runs it.
pub(super) struct Window {
    /// Present while the window is open; parked for the next one when it closes.
    editor: Option<Editor>,
    canvas: Canvas,
    parked: Parked,
    ending: Rc<RefCell<Ending>>,
}

impl Window {
    /// Takes the editor over.
    pub fn new(
        context: &eframe::CreationContext<'_>,
        parked: Parked,
        ending: Rc<RefCell<Ending>>,
    ) -> Result<Self, RenderError> {
        Editor::setup(&context.egui_ctx);
        let state = context.wgpu_render_state.clone().expect("the window is opened with the wgpu renderer");
        let gpu = Gpu::watch(state.device.clone(), state.queue.clone(), state.adapter.get_info());
        crate::render::driver::loop_iterations(&gpu)?;
        let canvas = Canvas::new(gpu, state)?;
        let editor = parked.borrow_mut().take();
        Ok(Self { editor, canvas, parked, ending })
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let Some(editor) = &mut self.editor else { return };
        editor.show(ui, &self.canvas.picture());
        match self.canvas.update(editor, ui.ctx()) {
            Ok(()) => {}
            Err(RenderError::Gpu(error)) if self.canvas.is_lost() => {
                *self.ending.borrow_mut() = Ending::DeviceLost;
                *self.parked.borrow_mut() = self.editor.take();
                tell(&error.to_string());
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            }
            Err(error) => editor.report(Message::error(error.to_string())),
        }
    }

    fn on_exit(&mut self) {
        if let Some(editor) = self.editor.take() {
            *self.parked.borrow_mut() = Some(editor);
        }
    }
}

/// On the terminal, where a lost device can still be read about.
fn tell(message: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "warning: {message}");
}
