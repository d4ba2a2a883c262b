//! Orders of the window, carried out in jobs on a device of their own: what happens to it does not reach the window.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::costs;
use super::error::ExportError;
use super::outputs::{self, Quantity};
use super::still::{StillPainter, StillSettings, Stills};
use crate::field::debug_view::ViewMode;
use crate::field::{Shading, Warning};
use crate::geometry::Lens;
use crate::jobs::Task;
use crate::render::{AdapterChoice, Film, StillWatch};
use crate::scene::Scene;
use crate::session::{
    MAX_SAMPLES, MeasuredView, Moments, RenderOrder, RenderRefusal, RenderReport, RenderSettings, SceneCost,
    StillPreview, Studio, check_size, ending, folder_of, numbered,
};

/// Longest side of a preview, in pixels.
const PREVIEW_SIDE: u32 = 512;
/// Interval between previews.
const PREVIEW_EVERY: Duration = Duration::from_millis(150);
/// Samples of a thumbnail.
const THUMBNAIL_SAMPLES: u32 = 4;

/// A studio on a graphics adapter.
pub struct GpuStudio {
    choice: AdapterChoice,
}

impl GpuStudio {
    /// A studio on this adapter.
    pub fn new(choice: AdapterChoice) -> Self {
        Self { choice }
    }
}

impl Studio for GpuStudio {
    fn export(
        &self,
        order: &RenderOrder,
        task: &Task,
        show: &mut dyn FnMut(StillPreview),
    ) -> Result<RenderReport, RenderRefusal> {
        let started = Instant::now();
        let pictures = pictures(order).map_err(RenderRefusal::Failed)?;
        task.set_stage("checking files");
        let existing: Vec<PathBuf> =
            pictures.iter().map(|(path, _)| path).filter(|path| path.exists()).cloned().collect();
        if !order.may_replace && !existing.is_empty() {
            return Err(RenderRefusal::Exists(existing));
        }
        let mut report = RenderReport { files: Vec::new(), warnings: Vec::new(), seconds: 0.0 };
        let made = self.make(order, &pictures, task, show, &mut report);
        report.seconds = started.elapsed().as_secs_f64();
        match made {
            Ok(()) => Ok(report),
            Err(_) if task.is_canceled() => Err(RenderRefusal::Canceled),
            Err(ExportError::Canceled) => Err(RenderRefusal::Canceled),
            Err(error) => Err(RenderRefusal::Failed(with_count(&error, report.files.len(), pictures.len()))),
        }
    }

    fn thumbnail(
        &self,
        scene: &Scene,
        folder: Option<PathBuf>,
        size: [u32; 2],
        task: &Task,
    ) -> Result<StillPreview, String> {
        let settings = StillSettings {
            size,
            camera: None,
            view_mode: ViewMode::Shaded,
            passes: None,
            shading: Shading::Rendered,
            film: Film { samples: THUMBNAIL_SAMPLES, is_transparent: false, lens: Lens::default() },
            is_linear: false,
            has_layers: false,
        };
        let draw = || {
            let still = Stills::new(scene.clone(), folder.clone(), settings).at(0.0, task)?;
            let unseen = &mut |_| {};
            StillPainter::new(self.choice.clone()).draw(&still, task, &mut Watch::new(task, 0.0, 1.0, size, unseen))
        };
        let (drawn, _) = draw().map_err(|error: ExportError| error.to_string())?;
        let samples = [THUMBNAIL_SAMPLES; 2];
        Ok(StillPreview { size, pixels: drawn.buffers.color, samples, file: None })
    }

    fn measure(&self, view: &MeasuredView, task: &Task) -> Result<SceneCost, String> {
        costs::measure(&self.choice, view, task).map_err(|error| error.to_string())
    }

    fn adapter(&self) -> Option<String> {
        self.choice.wanted().map(str::to_owned)
    }
}

impl GpuStudio {
    fn make(
        &self,
        order: &RenderOrder,
        pictures: &[(PathBuf, f64)],
        task: &Task,
        show: &mut dyn FnMut(StillPreview),
        report: &mut RenderReport,
    ) -> Result<(), ExportError> {
        // Of many frames the first stands for all: a full disk says so when it is full.
        let first: Vec<&Path> = pictures.iter().take(1).map(|(path, _)| path.as_path()).collect();
        let inputs: Vec<&Path> = order.file.iter().map(PathBuf::as_path).collect();
        outputs::check_writable(&first, &inputs)?;
        let RenderSettings { samples, is_transparent, has_layers, size, .. } = order.settings;
        let settings = StillSettings {
            size,
            camera: order.settings.camera.clone(),
            view_mode: ViewMode::Shaded,
            passes: None,
            shading: order.settings.shading,
            film: Film { samples, is_transparent, lens: Lens::default() },
            is_linear: order.settings.is_linear(),
            has_layers,
        };
        let quantity = if has_layers { Quantity::Layers } else { Quantity::Color };
        let mut stills = Stills::new(order.scene.clone(), order.file.as_deref().and_then(folder_of), settings);
        let mut painter = StillPainter::new(self.choice.clone());
        for (index, (path, time)) in pictures.iter().enumerate() {
            let done = [index, index + 1].map(|count| count as f32 / pictures.len() as f32);
            // Preparing reports a progress of its own, which would jump back and forth.
            let still = stills.at(*time, &Task::canceled_by(task.name(), task.flag()))?;
            task.set_stage("rendering");
            let show_named = &mut |preview| show(StillPreview { file: Some(path.clone()), ..preview });
            let mut watch = Watch::new(task, done[0], done[1], size, show_named);
            watch.wanted = samples;
            let (drawn, unfinished) = painter.draw(&still, task, &mut watch)?;
            watch.picture(&drawn.buffers.color, samples);
            add_new(&mut report.warnings, still.warnings.iter().cloned().chain(unfinished));
            if task.is_canceled() {
                return Err(ExportError::Canceled);
            }
            task.set_stage("writing");
            outputs::write(quantity, path, &drawn, &still)?;
            report.files.push(path.clone());
        }
        Ok(())
    }
}

/// The files with their moments. Refuses settings that no picture can have.
fn pictures(order: &RenderOrder) -> Result<Vec<(PathBuf, f64)>, String> {
    let settings = &order.settings;
    check_size(settings.size)?;
    if !(1..=MAX_SAMPLES).contains(&settings.samples) {
        return Err(format!("a picture has 1 to {MAX_SAMPLES} samples"));
    }
    match (ending(&settings.output).as_str(), settings.has_layers) {
        ("exr", _) | ("png", false) => {}
        ("png", true) => return Err("only an .exr has layers".into()),
        _ => return Err("the picture's name must end in .png or .exr".into()),
    }
    match settings.moments {
        Moments::Still(time) => Ok(vec![(settings.output.clone(), time)]),
        Moments::Frames(frames) => {
            let frames_per_second = order.scene.animation.timeline.frames_per_second;
            let picture = |frame| Ok((numbered(&settings.output, frame)?, frames.time_of(frame, frames_per_second)?));
            frames.iter().map(picture).collect()
        }
    }
}

/// What failed, and how many of several pictures are complete.
fn with_count(error: &ExportError, complete: usize, all: usize) -> String {
    match all > 1 {
        true => format!("{error} ({complete} of {all} pictures are complete)"),
        false => error.to_string(),
    }
}

fn add_new(warnings: &mut Vec<Warning>, more: impl Iterator<Item = Warning>) {
    for warning in more {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }
}

/// Tells a task and a preview how far a picture is.
struct Watch<'a> {
    task: &'a Task,
    start: f32,
    end: f32,
    size: [u32; 2],
    wanted: u32,
    shown: Option<Instant>,
    show: &'a mut dyn FnMut(StillPreview),
}

impl<'a> Watch<'a> {
    /// A watch over a picture that takes the task from `start` to `end`.
    fn new(task: &'a Task, start: f32, end: f32, size: [u32; 2], show: &'a mut dyn FnMut(StillPreview)) -> Self {
        Self { task, start, end, size, wanted: 1, shown: None, show }
    }
}

impl StillWatch for Watch<'_> {
    fn progress(&mut self, share: f32) -> bool {
        self.task.set_progress(self.start + (self.end - self.start) * share);
        !self.task.is_canceled()
    }

    fn wants_picture(&mut self) -> bool {
        self.shown.is_none_or(|shown| shown.elapsed() >= PREVIEW_EVERY)
    }

    fn picture(&mut self, color: &[[u8; 4]], samples: u32) {
        let (size, pixels) = reduced(self.size, color);
        (self.show)(StillPreview { size, pixels, samples: [samples, self.wanted], file: None });
        self.shown = Some(Instant::now());
    }
}

/// The picture, so small that it is quickly shown: every n-th pixel.
fn reduced([width, height]: [u32; 2], color: &[[u8; 4]]) -> ([u32; 2], Vec<[u8; 4]>) {
    let step = width.max(height).div_ceil(PREVIEW_SIDE).max(1);
    let size = [width.div_ceil(step), height.div_ceil(step)];
    let at = |x: u32, y: u32| color[(y * step) as usize * width as usize + (x * step) as usize];
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| at(x, y)));
    (size, pixels.collect())
}
