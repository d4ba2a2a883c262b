//! Joins editor and renderer in one window, and reopens the window when the graphics device is lost.

mod samples;
mod shared_app;
mod viewport_renderer;
mod window;

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use thiserror::Error;

use crate::document::recovery::Recovery;
use crate::document::{Document, data_folder, state_folder};
use crate::editor::{Editor, Example, Message};
use crate::export::GpuStudio;
use crate::gallery;
use crate::jobs::Task;
use crate::render::{AdapterChoice, Gpu};
use crate::scene::{NodeKind, Scene};
use shared_app::SharedApp;
use window::{SMALLEST, Window};

/// Why the window closed, other than by the artist's order.
#[derive(Debug, Error)]
pub enum AppError {
    /// There is no window or no device.
    #[error("the window could not be opened: {0}")]
    Window(String),
    /// The device was lost too often.
    #[error("the graphics device was lost {0} times within a minute")]
    Lost(usize),
}

/// How the window ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    /// The artist closed it.
    Closed,
    /// The device was lost: open another window.
    DeviceLost,
}

/// The program gives up after more device losses than this within a minute.
const MAX_LOSSES: usize = 5;

/// Opens the editor on the document, drawn by the chosen adapter, and returns when the artist closes it. The document
/// survives the loss of the graphics device: each new window rebuilds everything on the device from it. A panic keeps
/// unsaved work and reports it through `tell`.
pub fn run(document: Document, adapter: &AdapterChoice, tell: fn(&str)) -> Result<(), AppError> {
    let is_new = document.path().is_none();
    let mut editor = Editor::new(document);
    editor.set_examples(examples());
    editor.set_studio(Arc::new(GpuStudio::new(adapter.clone())));
    editor.set_templates(templates(), gallery::thumbnail);
    editor.set_recent(crate::document::RecentFiles::load());
    editor.set_preferences(crate::document::Preferences::load());
    if is_new {
        editor.welcome_at_start();
    }
    match start_recovery() {
        Ok(recovery) => {
            recovery.rescuer().rescue_at_panics(tell);
            editor.set_recovery(recovery);
        }
        Err(reason) => editor.report(Message::warning(format!("Unsaved work cannot be kept for recovery: {reason}."))),
    }
    let shared = SharedApp { editor: Rc::new(RefCell::new(editor)), gpu: Rc::default() };
    let mut losses: Vec<Instant> = Vec::new();
    loop {
        if open_window(&shared, adapter)? == Ending::Closed {
            shared.editor.borrow_mut().end_recovery();
            return Ok(());
        }
        // Painting on the lost device may have panicked.
        shared.editor.borrow_mut().drop_notes();
        losses.retain(|at| at.elapsed() < Duration::from_secs(60));
        losses.push(Instant::now());
        if losses.len() > MAX_LOSSES {
            return Err(AppError::Lost(losses.len()));
        }
        let message = "The graphics device was lost and has been opened again. Nothing else is lost.";
        shared.editor.borrow_mut().report(Message::warning(message));
    }
}

fn start_recovery() -> Result<Recovery, String> {
    let folder = state_folder().ok_or("this user has no folder for it")?;
    Recovery::start(&folder.join("recovery")).map_err(|error| error.to_string())
}

fn open_window(shared: &SharedApp, adapter: &AdapterChoice) -> Result<Ending, AppError> {
    let for_window = shared.clone();
    // Painting on a lost device panics in places. Such a panic does not leave the editor inconsistent.
    let result = catch_unwind(AssertUnwindSafe(|| {
        eframe::run_native(
            "isolith",
            options(adapter),
            Box::new(move |context| Ok(Box::new(Window::new(context, for_window)?))),
        )
    }));
    if shared.gpu.borrow().as_ref().is_some_and(Gpu::is_lost) {
        return Ok(Ending::DeviceLost);
    }
    match result {
        Ok(Ok(())) => Ok(Ending::Closed),
        Ok(Err(error)) => Err(AppError::Window(error.to_string())),
        Err(panic) => resume_unwind(panic),
    }
}

fn options(adapter: &AdapterChoice) -> eframe::NativeOptions {
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor = crate::render::instance_descriptor();
    setup.native_adapter_selector = Some(Arc::new(adapter.selector()));
    setup.device_descriptor = Arc::new(crate::render::device_descriptor);
    eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Isolith")
            .with_app_id("isolith")
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size(SMALLEST)
            .with_drag_and_drop(true),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: eframe::egui_wgpu::WgpuConfiguration { wgpu_setup: setup.into(), ..Default::default() },
        run_and_return: true,
        ..Default::default()
    }
}

/// The scenes to start from, for the welcome.
fn templates() -> Vec<Example> {
    let template = |gallery::Template { name, scene, .. }| Example {
        name: name.into(),
        is_test: false,
        open: Arc::new(move |_| Ok(Document::new(scene.clone()))),
    };
    gallery::templates().into_iter().map(template).collect()
}

/// The shipped scenes, for the File menu. A scene finds its meshes beside its own file. So a scene with meshes opens
/// from the shipped file if the program starts beside it, otherwise from a copy in the user's data folder.
fn examples() -> Vec<Example> {
    let open = |name: &str, scene: &Scene, task: &Task| {
        let shipped = Path::new("scenes").join(name).with_extension("json");
        let has_meshes = scene.nodes().iter().any(|node| matches!(node.kind, NodeKind::Mesh(_)));
        let file = match data_folder() {
            _ if shipped.exists() => shipped,
            Some(data) if has_meshes => {
                let folder = data.join("examples").join(env!("CARGO_PKG_VERSION"));
                gallery::install(name, scene, &folder).map_err(|error| error.to_string())?
            }
            _ => return Ok(Document::new(scene.clone())),
        };
        Document::open_by(&file, task).map_err(|error| error.to_string())
    };
    gallery::all()
        .into_iter()
        .map(|(name, scene)| Example {
            name: name.replace('-', " "),
            is_test: gallery::is_test_scene(name),
            open: Arc::new(move |task| open(name, &scene, task)),
        })
        .collect()
}
