//! Joins editor and renderer in one window, and opens the window again when the graphics device is lost.

mod canvas;
mod window;

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::document::Document;
use crate::editor::{Editor, Example, Message};
use crate::gallery;
use window::Window;

/// Why the window closed otherwise than by the artist's wish.
#[derive(Debug, Error)]
pub enum AppError {
    /// There is no window or no device.
    #[error("the window could not be opened: {0}")]
    Window(String),
    /// The device was lost too often.
    #[error("the graphics device was lost {0} times within a minute")]
    Lost(usize),
}

/// The editor between two windows: here while none is open.
type Parked = Rc<RefCell<Option<Editor>>>;

/// What the window left behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    /// The artist closed it.
    Closed,
    /// The device was lost: another window is to be opened.
    DeviceLost,
}

/// Most losses of the device within a minute before the program gives up.
const MAX_LOSSES: usize = 5;

/// Opens the editor on the document and returns when it is closed. The document survives the loss of
/// the graphics device: everything on the device is made anew from it.
pub fn run(document: Document) -> Result<(), AppError> {
    let mut editor = Editor::new(document);
    editor.set_examples(examples());
    editor.set_recent(crate::document::RecentFiles::load());
    let parked: Parked = Rc::new(RefCell::new(Some(editor)));
    let mut losses: Vec<Instant> = Vec::new();
    loop {
        if open_window(&parked)? == Ending::Closed {
            return Ok(());
        }
        losses.retain(|at| at.elapsed() < Duration::from_secs(60));
        losses.push(Instant::now());
        if losses.len() > MAX_LOSSES {
            return Err(AppError::Lost(losses.len()));
        }
        if let Some(editor) = parked.borrow_mut().as_mut() {
            editor.report(Message::warning("The graphics device was lost and has been opened again. Nothing is lost."));
        }
    }
}

fn open_window(parked: &Parked) -> Result<Ending, AppError> {
    let ending = Rc::new(RefCell::new(Ending::Closed));
    let (for_window, its_ending) = (parked.clone(), ending.clone());
    let result = eframe::run_native(
        "isolith",
        options(),
        Box::new(move |context| Ok(Box::new(Window::new(context, for_window, its_ending)?))),
    );
    let ending = *ending.borrow();
    match (result, ending) {
        (_, Ending::DeviceLost) => Ok(ending),
        (Ok(()), Ending::Closed) => Ok(ending),
        (Err(error), Ending::Closed) => Err(AppError::Window(error.to_string())),
    }
}

fn options() -> eframe::NativeOptions {
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor = crate::render::instance_descriptor();
    setup.device_descriptor = Arc::new(crate::render::device_descriptor);
    eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Isolith")
            .with_app_id("isolith")
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([800.0, 500.0])
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: eframe::egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() },
        run_and_return: true,
        ..Default::default()
    }
}

/// The shipped scenes, for the File menu.
fn examples() -> Vec<Example> {
    gallery::all()
        .into_iter()
        .map(|(name, scene)| Example {
            name: name.replace('-', " "),
            open: Box::new(move || Ok(Document::new(scene.clone()))),
        })
        .collect()
}
