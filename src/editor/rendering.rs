//! Rendering into files: the settings of the render dialog, and the job that renders. `render_view` shows them.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use egui::{ColorImage, Context, TextureHandle, TextureOptions};

use super::messages::Message;
use isolith_document::Document;
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_session::{
    FrameRange, Moments, RenderOrder, RenderRefusal, RenderReport, RenderSettings, SharedStudio, StillPreview, ending,
    folder_of,
};

/// The name of the picture of a scene that has no file.
const UNNAMED: &str = "render";
/// What stands for the frame's number in suggested names.
const NUMBER: &str = ".####";
/// Most files that a question lists.
pub const FILES_LISTED: usize = 4;

/// The format of the pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RenderFormat {
    /// PNG.
    #[default]
    Png,
    /// OpenEXR with linear light.
    Exr,
    /// OpenEXR with everything.
    Layers,
}

impl RenderFormat {
    /// All, in the order of the list.
    pub const ALL: [Self; 3] = [Self::Png, Self::Exr, Self::Layers];

    /// Its name in the list.
    pub fn label(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Exr => "OpenEXR",
            Self::Layers => "OpenEXR with layers",
        }
    }

    /// One sentence about it.
    pub fn help(self) -> &'static str {
        match self {
            Self::Png => "The picture as it looks, 8 bits per channel",
            Self::Exr => "Linear light before exposure and view transform, 32 bits per channel",
            Self::Layers => {
                "Linear light, depth, normal, node id with names, and albedo, as layers of one file for compositing"
            }
        }
    }

    fn ending(self) -> &'static str {
        if self == Self::Png { "png" } else { "exr" }
    }
}

/// How the last order ended.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderOutcome {
    /// These files are complete; warnings beside.
    Done(RenderReport),
    /// A reason.
    Failed(String),
    /// Canceled; what was complete stays.
    Canceled,
}

/// Rendering under way.
pub struct Running {
    job: Job<Result<RenderReport, RenderRefusal>>,
    previews: Receiver<StillPreview>,
    started: Instant,
}

impl Running {
    /// Its task.
    pub fn task(&self) -> &Task {
        self.job.task()
    }

    /// Remaining time at the speed so far; `None` before there is one to judge by.
    pub fn time_left(&self) -> Option<Duration> {
        let share = f64::from(self.task().progress()?);
        let elapsed = self.started.elapsed().as_secs_f64();
        (share > 0.02 && elapsed > 0.5).then(|| Duration::from_secs_f64(elapsed * (1.0 - share) / share))
    }
}

/// The picture so far.
pub struct ShownPreview {
    /// The texture.
    pub texture: TextureHandle,
    /// Samples so far, and of the complete picture.
    pub samples: [u32; 2],
    /// Its file.
    pub file: Option<PathBuf>,
}

/// State of the dialog, and the job.
#[derive(Default)]
pub struct Rendering {
    /// Whether the window is open.
    pub is_open: bool,
    /// The settings; output and moments come from the fields below.
    pub settings: RenderSettings,
    /// The typed path.
    pub output: String,
    /// The format.
    pub format: RenderFormat,
    /// Whether a range of frames is rendered.
    pub has_frames: bool,
    /// The first and the last frame.
    pub frames: [i64; 2],
    /// Files that exist, while the artist is asked about them.
    pub existing: Vec<PathBuf>,
    /// How the last order ended.
    pub outcome: Option<RenderOutcome>,
    /// The picture so far.
    pub preview: Option<ShownPreview>,
    /// The job.
    pub running: Option<Running>,
    /// The scene that the path was suggested for.
    suggested_for: Option<Option<PathBuf>>,
}

impl Rendering {
    /// Opens the window, with suggestions for this document.
    pub fn open(&mut self, document: &Document) {
        self.is_open = true;
        let file = document.path().map(Path::to_path_buf);
        if self.suggested_for.as_ref() == Some(&file) {
            return;
        }
        let timeline = &document.scene().animation.timeline;
        self.frames = [timeline.start, timeline.end].map(|time| timeline.frame_at(time).round() as i64);
        self.settings.camera = None;
        self.output = suggested_output(file.as_deref(), self.format).display().to_string();
        if self.has_frames {
            self.set_frames(true);
        }
        self.suggested_for = Some(file);
    }

    /// Switches between one picture and a range; the path gets a place for the number, or loses it.
    pub fn set_frames(&mut self, has_frames: bool) {
        self.has_frames = has_frames;
        let path = PathBuf::from(&self.output);
        let Some(stem) = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()) else { return };
        let renamed = match has_frames {
            true if !stem.contains('#') => format!("{stem}{NUMBER}"),
            false => stem.trim_end_matches('#').trim_end_matches('.').to_owned(),
            true => stem,
        };
        let ending = path.extension().map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
        self.output = path.with_file_name(renamed + &ending).display().to_string();
    }

    /// Changes the format, and with it the ending of the path.
    pub fn set_format(&mut self, format: RenderFormat) {
        self.format = format;
        if !self.output.is_empty() {
            self.output = PathBuf::from(&self.output).with_extension(format.ending()).display().to_string();
        }
    }

    /// Takes the format from the ending of the typed path.
    pub fn follow_ending(&mut self) {
        self.format = match (ending(Path::new(&self.output)).as_str(), self.format) {
            ("png", _) => RenderFormat::Png,
            ("exr", RenderFormat::Png) => RenderFormat::Exr,
            (_, format) => format,
        };
    }

    /// The settings of an order at this moment of the document, or why there can be none.
    pub fn wanted(&self, document: &Document) -> Result<RenderSettings, String> {
        let output = PathBuf::from(self.output.trim());
        if output.as_os_str().is_empty() {
            return Err("Type the name of a file.".into());
        }
        if ending(&output) != self.format.ending() {
            return Err("The name must end in .png or .exr.".into());
        }
        if let Some(folder) = folder_of(&output).filter(|folder| !folder.is_dir()) {
            return Err(format!("There is no folder {}.", folder.display()));
        }
        if self.has_frames && !output.file_name().is_some_and(|name| name.to_string_lossy().contains('#')) {
            return Err("The name needs a place for the number of the frame, such as ####.".into());
        }
        let moments = match self.has_frames {
            true => Moments::Frames(FrameRange::new(self.frames[0], self.frames[1]).map_err(sentence)?),
            false => Moments::Still(document.time()),
        };
        isolith_session::check_size(self.settings.size).map_err(sentence)?;
        Ok(RenderSettings { output, has_layers: self.format == RenderFormat::Layers, moments, ..self.settings.clone() })
    }

    /// The command that renders the same; `None` for a scene without a file, or while the settings are not complete.
    pub fn command(&self, document: &Document, adapter: Option<&str>) -> Option<String> {
        Some(self.wanted(document).ok()?.command(document.path()?, adapter))
    }

    /// Starts the job.
    pub fn start(&mut self, document: &Document, studio: &SharedStudio, jobs: &Jobs, may_replace: bool) {
        let settings = match self.wanted(document) {
            Ok(settings) => settings,
            Err(reason) => {
                self.outcome = Some(RenderOutcome::Failed(reason));
                return;
            }
        };
        let name = settings.output.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let scene = document.resting().as_ref().clone();
        let order = RenderOrder { scene, file: document.path().map(Path::to_path_buf), settings, may_replace };
        let (sender, previews) = channel();
        let (studio, for_wake) = (studio.clone(), jobs.clone());
        let job = jobs.start(Task::lasting(format!("Rendering {name}")), move |task| {
            studio.export(&order, task, &mut |preview| {
                // The receiver is gone if the job was dropped: its task is canceled then.
                let _ = sender.send(preview);
                for_wake.wake();
            })
        });
        (self.outcome, self.preview) = (None, None);
        self.existing.clear();
        self.running = Some(Running { job, previews, started: Instant::now() });
    }

    /// Takes over previews and the end of the job; returns a message about the end. Call once a frame.
    pub fn poll(&mut self, ctx: &Context) -> Option<Message> {
        let running = self.running.as_ref()?;
        if let Some(preview) = running.previews.try_iter().last() {
            self.show_preview(ctx, preview);
        }
        let end = self.running.as_ref()?.job.poll()?;
        // Previews may have arrived since.
        if let Some(preview) = self.running.take().and_then(|running| running.previews.try_iter().last()) {
            self.show_preview(ctx, preview);
        }
        let outcome = match end {
            JobEnd::Done(Ok(report)) => RenderOutcome::Done(report),
            JobEnd::Done(Err(RenderRefusal::Exists(files))) => {
                self.existing = files;
                self.is_open = true;
                return None;
            }
            JobEnd::Done(Err(RenderRefusal::Failed(reason))) => RenderOutcome::Failed(sentence(reason)),
            JobEnd::Failed(reason) => RenderOutcome::Failed(sentence(reason)),
            JobEnd::Done(Err(RenderRefusal::Canceled)) | JobEnd::Canceled => RenderOutcome::Canceled,
        };
        let message = match &outcome {
            RenderOutcome::Done(report) => Message::success(report_text(report)),
            RenderOutcome::Failed(reason) => Message::error(reason.clone()),
            RenderOutcome::Canceled => Message::info("Rendering was canceled."),
        };
        self.outcome = Some(outcome);
        Some(message)
    }

    fn show_preview(&mut self, ctx: &Context, StillPreview { size, pixels, samples, file }: StillPreview) {
        let bytes: Vec<u8> = pixels.into_iter().flatten().collect();
        let image = ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), &bytes);
        match &mut self.preview {
            Some(shown) => {
                shown.texture.set(image, TextureOptions::LINEAR);
                (shown.samples, shown.file) = (samples, file);
            }
            None => {
                let texture = ctx.load_texture("rendered", image, TextureOptions::LINEAR);
                self.preview = Some(ShownPreview { texture, samples, file });
            }
        }
    }
}

/// What an order has made, in a sentence.
pub fn report_text(report: &RenderReport) -> String {
    let seconds = report.seconds;
    match &*report.files {
        [one] => format!("Rendered {} in {seconds:.1} s", one.display()),
        many => format!("Rendered {} pictures in {seconds:.1} s", many.len()),
    }
}

/// A picture beside the scene's file, or in the current folder.
fn suggested_output(file: Option<&Path>, format: RenderFormat) -> PathBuf {
    let path = file.map_or_else(|| PathBuf::from(UNNAMED), Path::to_path_buf).with_extension(format.ending());
    std::path::absolute(&path).unwrap_or(path)
}

/// The reason with a capital letter and a period.
fn sentence(reason: String) -> String {
    let mut chars = reason.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let rest = chars.as_str();
    // A path keeps its letters.
    let start = if reason.starts_with('/') { reason.clone() } else { first + rest };
    if start.ends_with(['.', '!', '?']) { start } else { start + "." }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::Scene;

    #[test]
    fn the_path_follows_format_and_range() {
        let document = Document::new(Scene::new());
        let mut rendering = Rendering::default();
        rendering.open(&document);
        assert!(rendering.is_open && rendering.output.ends_with("render.png"), "{}", rendering.output);
        rendering.output = "a/pawn.png".into();
        rendering.set_frames(true);
        assert_eq!(rendering.output, "a/pawn.####.png");
        rendering.set_format(RenderFormat::Layers);
        assert_eq!(rendering.output, "a/pawn.####.exr");
        rendering.set_frames(true);
        assert_eq!(rendering.output, "a/pawn.####.exr", "there is a place already");
        rendering.set_frames(false);
        assert_eq!(rendering.output, "a/pawn.exr");
        rendering.follow_ending();
        assert_eq!(rendering.format, RenderFormat::Layers);
        rendering.output = "pawn.PNG".into();
        rendering.follow_ending();
        assert_eq!(rendering.format, RenderFormat::Png);
        rendering.open(&document);
        assert_eq!(rendering.output, "pawn.PNG", "what was typed stays");
    }

    #[test]
    fn settings_that_lead_to_no_picture_are_refused_with_a_reason() {
        let document = Document::new(Scene::new());
        let mut rendering = Rendering::default();
        let refused = |rendering: &Rendering| rendering.wanted(&document).expect_err("refused");
        assert!(refused(&rendering).contains("name of a file"));
        rendering.output = "pawn.jpg".into();
        assert!(refused(&rendering).contains(".png or .exr"));
        rendering.output = "no such folder/pawn.png".into();
        assert!(refused(&rendering).contains("no folder"));
        (rendering.output, rendering.has_frames, rendering.frames) = ("pawn.png".into(), true, [0, 4]);
        assert!(refused(&rendering).contains("####"));
        (rendering.output, rendering.frames) = ("pawn.#.png".into(), [5, 4]);
        assert!(refused(&rendering).contains("after the last"));
        rendering.frames = [4, 5];
        rendering.settings.size = [0, 10];
        assert!(refused(&rendering).contains("width and height"));
        rendering.settings.size = [64, 48];
        assert!(rendering.wanted(&document).is_ok());
        assert_eq!(rendering.command(&document, None), None, "a scene without a file has no command");
    }
}
