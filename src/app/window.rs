//! The window: shows the editor and keeps its picture up to date.

use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::{Vec2, vec2};

use super::shared_app::SharedApp;
use super::viewport_renderer::ViewportRenderer;
use crate::editor::{Editor, Message, Picture, VIEWS, ViewSettings};
use crate::render::{Gpu, RenderError};

/// Minimum size of the window, in points.
pub(super) const SMALLEST: Vec2 = vec2(800.0, 500.0);

/// The window's content, run by eframe.
pub(super) struct Window {
    viewport: ViewportRenderer,
    /// Those of the viewports beside the main one, while they are shown.
    beside: [Option<ViewportRenderer>; VIEWS - 1],
    state: RenderState,
    shared: SharedApp,
    /// Whether the window has been painted once. The first picture comes later, because a driver may compile for
    /// seconds.
    is_open: bool,
    /// Since when input has been waiting while pictures rest.
    input_since: Option<Instant>,
    /// Artificial delay of each frame, to simulate a slow machine.
    delay: Duration,
}

/// Longest time for which waiting input goes before pictures: keys are handled one a frame, and many slow pictures would hold
/// them up for seconds.
const INPUT_FIRST: Duration = Duration::from_millis(500);

/// Environment variable with that delay in milliseconds.
const FRAME_DELAY: &str = "ISOLITH_FRAME_DELAY";

impl Window {
    /// Shows the editor in `shared`.
    pub fn new(context: &eframe::CreationContext<'_>, shared: SharedApp) -> Result<Self, RenderError> {
        Editor::setup(&context.egui_ctx);
        let state = context.wgpu_render_state.clone().expect("the window is opened with the wgpu renderer");
        let gpu = Gpu::watch(state.device.clone(), state.queue.clone(), state.adapter.get_info());
        *shared.gpu.borrow_mut() = Some(gpu.clone());
        crate::render::driver::loop_iterations(&gpu)?;
        let delay = std::env::var(FRAME_DELAY).ok().and_then(|text| text.parse().ok()).map(Duration::from_millis);
        Ok(Self {
            viewport: ViewportRenderer::new(gpu, state.clone())?,
            beside: Default::default(),
            state,
            shared,
            is_open: false,
            input_since: None,
            delay: delay.unwrap_or_default(),
        })
    }
}

impl Window {
    /// Whether input that waits is to be handled before pictures go on.
    fn input_goes_first(&mut self, waits: bool) -> bool {
        let since = self.input_since.get_or_insert_with(Instant::now).elapsed();
        let is_first = waits && since < INPUT_FIRST;
        if !is_first {
            self.input_since = None;
        }
        is_first
    }

    /// Advances the pictures of all viewports: first that of the active one, and the others while it rests.
    fn update(&mut self, editor: &mut Editor, ctx: &egui::Context) -> Result<(), RenderError> {
        if self.input_goes_first(Editor::input_waits(ctx)) {
            return Ok(());
        }
        let stops = editor.take_stop_drawing();
        let active = editor.active_view();
        let mut views: Vec<(usize, ViewSettings)> = vec![(active, editor.view())];
        views.extend(editor.views_beside());
        let mut may_refine = true;
        for (index, view) in &views {
            let renderer = match index.checked_sub(1).map(|beside| &mut self.beside[beside]) {
                None => &mut self.viewport,
                Some(Some(renderer)) => renderer,
                Some(empty) => {
                    let gpu = self.viewport.gpu().clone();
                    empty.insert(ViewportRenderer::new(gpu, self.state.clone())?)
                }
            };
            if stops {
                renderer.stop_drawing();
            }
            renderer.update(editor, *view, may_refine, ctx)?;
            may_refine &= renderer.is_complete();
        }
        for (beside, renderer) in self.beside.iter_mut().enumerate() {
            let is_shown = views.iter().any(|(index, _)| *index == beside + 1);
            if let Some(closed) = renderer.take_if(|_| !is_shown) {
                closed.close();
            }
        }
        Ok(())
    }

    /// The pictures of the viewports beside the main one.
    fn pictures_beside(&self) -> Vec<Picture> {
        let picture = |renderer: &Option<ViewportRenderer>| {
            renderer.as_ref().map_or_else(Picture::default, ViewportRenderer::picture)
        };
        self.beside.iter().map(picture).collect()
    }
}

/// Room for window borders and screen bars, in points.
const AROUND: Vec2 = vec2(16.0, 72.0);

/// Shrinks the window to the screen.
fn fit_to_screen(ctx: &egui::Context) {
    let (inner, monitor, fills) = ctx.input(|i| {
        let viewport = i.viewport();
        let fills = viewport.maximized == Some(true) || viewport.fullscreen == Some(true);
        (viewport.inner_rect.map(|rect| rect.size()), viewport.monitor_size, fills)
    });
    if let (Some(inner), Some(monitor), false) = (inner, monitor, fills)
        && let Some(size) = fitting(inner, monitor)
    {
        ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(size));
    }
}

/// The size that fits the monitor, at least [`SMALLEST`]; `None` if the window fits already.
fn fitting(inner: Vec2, monitor: Vec2) -> Option<Vec2> {
    let most = (monitor - AROUND).max(SMALLEST);
    (inner.x > most.x || inner.y > most.y).then(|| inner.min(most))
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if self.viewport.is_lost() {
            // Painting is impossible from here on.
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        if !self.delay.is_zero() && ui.ctx().current_pass_index() == 0 {
            std::thread::sleep(self.delay);
        }
        let shared = self.shared.clone();
        let mut slot = shared.editor.borrow_mut();
        let editor = &mut *slot;
        editor.set_pictures_beside(self.pictures_beside());
        editor.show(ui, &self.viewport.picture());
        if !std::mem::replace(&mut self.is_open, true) {
            fit_to_screen(ui.ctx());
            ui.ctx().request_repaint();
            return;
        }
        match self.update(editor, ui.ctx()) {
            Ok(()) => {}
            // The output of this frame cannot be painted: discard it and repeat the pass, which paints nothing.
            Err(_) if self.viewport.is_lost() => ui.ctx().request_discard("the device is lost"),
            Err(error) => editor.report(Message::error(error.to_string())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_fits_the_screen() {
        let wanted = vec2(1440.0, 900.0);
        assert_eq!(fitting(wanted, vec2(1920.0, 1080.0)), None);
        assert_eq!(fitting(wanted, vec2(1366.0, 768.0)), Some(vec2(1350.0, 696.0)));
        assert_eq!(fitting(wanted, vec2(1440.0, 900.0)), Some(vec2(1424.0, 828.0)));
        assert_eq!(fitting(wanted, vec2(640.0, 480.0)), Some(SMALLEST));
        assert_eq!(fitting(vec2(900.0, 600.0), vec2(1024.0, 768.0)), None);
    }
}
