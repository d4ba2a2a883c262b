//! `isolith render`: a picture and further outputs, without a window.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::adapters::AdapterArguments;
use super::failure::Failure;
use super::film::{FilmArguments, clear_background};
use super::input::{folder, is_standard, read_scene, shown};
use super::progress::{Interrupts, Progress, cancel_by_interrupts};
use super::text::{complain, say};
use crate::export::outputs::{self, Quantity};
use crate::export::{Drawn, Still, StillPainter, StillSettings, Stills};
use crate::field::debug_view::{DepthRange, ViewMode};
use crate::field::reference::image::render_reference;
use crate::field::{Shading, Warning};
use crate::jobs::{JobEnd, Jobs, Task};
use crate::render::{Film, StillWatch};
use crate::scene::{ParamPath, Scene, Track};
use crate::session::{FrameRange, MAX_SIDE, check_size, ending, numbered, parse_fps};

/// Arguments of `isolith render`.
#[derive(Clone, Debug, clap::Args)]
pub struct RenderArguments {
    /// Scene file; - reads standard input
    scene: PathBuf,
    /// Picture to write: .png, or .exr for linear light before exposure and view transform; - writes a .png to
    /// standard output
    #[arg(short, long, value_name = "FILE", value_parser = picture_path)]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size)]
    size: [u32; 2],
    /// Moment to render, in seconds
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_time)]
    time: f64,
    /// Frames to render, from the first to the last; a run of # in the names of outputs becomes the number, as in
    /// frame.####.png
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, value_parser = FrameRange::from_str, conflicts_with = "time")]
    frames: Option<FrameRange>,
    /// Frames per second, instead of those of the scene: frame N is at N divided by it
    #[arg(long, value_name = "N", requires = "frames", value_parser = parse_fps)]
    fps: Option<f64>,
    /// Camera of the scene by name, instead of its first one; a scene without cameras is seen whole
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Write depth, normal, node id and base color (albedo) into the .exr of --output, too, as layers
    #[arg(long, conflicts_with_all = ["reference", "view"])]
    layers: bool,
    /// Also write the distance along the ray: .exr holds meters (background is infinite), .png a picture
    /// of them
    #[arg(long, value_name = "FILE", value_parser = output_path)]
    depth: Option<PathBuf>,
    /// Also write the surface's normal in the world: .exr holds X, Y and Z, .png maps -1…1 to 0…255
    #[arg(long, value_name = "FILE", value_parser = output_path)]
    normal: Option<PathBuf>,
    /// Also write which node is seen: .exr holds its id (background is 0), .png a color for each
    #[arg(long, value_name = "FILE", value_parser = output_path)]
    node_id: Option<PathBuf>,
    /// What the picture shows: shaded, steps, evaluations, cells, entries, distance, normals, slope, nodes or
    /// components
    #[arg(long, value_name = "MODE", default_value = "shaded", value_parser = ViewMode::from_str, conflicts_with = "reference")]
    view: ViewMode,
    /// Show color and depth as they stand after this pass over the parts of the scene, counted from 1; 0 shows only
    /// what is rasterized. One part at the top of the scene after the other is marched, by their order, then from
    /// front to back
    #[arg(long, value_name = "N", conflicts_with = "reference")]
    pass: Option<u32>,
    #[command(flatten)]
    film: FilmArguments,
    /// How the scene is lit: rendered by its own lights, material by a studio light, or solid, everything in clay
    #[arg(long, value_name = "NAME", default_value = "rendered", value_parser = Shading::from_str)]
    shading: Shading,
    /// Render the reference: on the processor, in double precision, every ray to certainty. Slow
    #[arg(long, alias = "truth")]
    reference: bool,
    /// Make warnings errors, such as a model that is missing; then nothing is written
    #[arg(long)]
    strict: bool,
    /// Print one JSON object: {ok, file, outputs, width, height, samples, components, seconds, warnings}, for each frame of
    /// several with {frame, time} on a line of its own, or {ok, file, node, field, reason} where there is no picture
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    adapter: AdapterArguments,
}

impl RenderArguments {
    /// Arguments for one picture of a scene, with defaults for everything else.
    pub fn still(scene: &Path, output: &Path, adapter: &AdapterArguments) -> Self {
        Self {
            scene: scene.to_path_buf(),
            output: output.to_path_buf(),
            size: [1280, 720],
            time: 0.0,
            frames: None,
            fps: None,
            camera: None,
            layers: false,
            depth: None,
            normal: None,
            node_id: None,
            view: ViewMode::Shaded,
            pass: None,
            film: FilmArguments::default(),
            shading: Shading::Rendered,
            reference: false,
            strict: false,
            json: false,
            quiet: false,
            adapter: adapter.clone(),
        }
    }

    /// Prints the warnings for the artist. Rendering continues unless warnings are errors.
    fn warn(&self, warnings: &[Warning]) -> Result<(), Failure> {
        for Warning { node, name, reason } in warnings.iter().filter(|_| !self.quiet && !self.json) {
            complain(&format!("warning: {}: {name} {node}: {reason}", shown(&self.scene).display()));
        }
        match warnings.len() {
            count if count > 0 && self.strict => Err(Failure::Strict { file: shown(&self.scene), count }),
            _ => Ok(()),
        }
    }

    /// Prints a line about the result, unless standard output holds the picture or a JSON object.
    fn tell(&self, line: &str) -> Result<(), Failure> {
        match self.quiet || self.json {
            true => Ok(()),
            false if is_standard(&self.output) => {
                complain(line);
                Ok(())
            }
            false => say(line),
        }
    }

    /// The samples of the picture.
    fn film(&self) -> Result<Film, Failure> {
        let is_colored = self.view == ViewMode::Shaded;
        if self.layers && !self.is_linear() {
            return Err(Failure::Usage("--layers: only an .exr as --output has layers".into()));
        }
        if !is_colored && self.is_linear() {
            return Err(Failure::Usage("--output: views other than shaded have no linear light for an .exr".into()));
        }
        self.film.film(self.reference || !is_colored, is_colored)
    }

    /// Whether the picture is written as linear light.
    fn is_linear(&self) -> bool {
        ending(&self.output) == "exr"
    }

    /// Every output with its quantity.
    fn outputs(&self) -> Vec<(Quantity, &Path)> {
        let all = [
            (if self.layers { Quantity::Layers } else { Quantity::Color }, Some(&self.output)),
            (Quantity::Depth, self.depth.as_ref()),
            (Quantity::Normal, self.normal.as_ref()),
            (Quantity::NodeId, self.node_id.as_ref()),
        ];
        all.into_iter().filter_map(|(quantity, path)| Some((quantity, path?.as_path()))).collect()
    }
}

/// Renders and writes every output. Writes nothing until a whole picture is complete. With `--json`, prints a failure
/// as one object on standard output, too.
pub fn render(arguments: &RenderArguments) -> Result<(), Failure> {
    let done = make(arguments);
    if let (true, Err(failure)) = (arguments.json, &done) {
        say(&failure.to_json(&shown(&arguments.scene)).to_string())?;
    }
    done
}

/// Renders the picture, or the frames.
fn make(arguments: &RenderArguments) -> Result<(), Failure> {
    let started = Instant::now();
    if arguments.json && is_standard(&arguments.output) {
        return Err(Failure::Usage("standard output can hold the picture or the JSON object, not both".into()));
    }
    let first = arguments.frames.map(|frames| frames.iter().next().unwrap_or(0));
    let paths = outputs_of(arguments, first)?;
    let paths: Vec<_> = paths.iter().map(|(_, path)| path.as_path()).filter(|path| !is_standard(path)).collect();
    let inputs = [arguments.scene.as_path()];
    outputs::check_writable(&paths, if is_standard(&arguments.scene) { &[] } else { &inputs })?;
    let film = arguments.film()?;
    let mut scene = read_scene(&arguments.scene)?;
    let display = scene.display;
    arguments.film.apply(&mut scene.display);
    if scene.display != display {
        // What is asked for holds at every moment.
        let still = Track { path: ParamPath::of_display("exposure"), keys: Vec::new() };
        scene.set_tracks([still]).map_err(|error| Failure::Other(error.to_string()))?;
    }
    let frames_per_second = arguments.fps.unwrap_or(scene.animation.timeline.frames_per_second);
    let settings = StillSettings {
        size: arguments.size,
        camera: arguments.camera.clone(),
        view_mode: arguments.view,
        shading: arguments.shading,
        passes: arguments.pass,
        film,
        is_linear: arguments.is_linear(),
        has_layers: arguments.layers,
    };
    let stills = Stills::new(scene, folder(&arguments.scene), settings);
    let mut pictures = Pictures { arguments, stills, painter: None, told: Vec::new() };
    let Some(frames) = arguments.frames else {
        let object = pictures.make(arguments.time, None, started)?;
        return if arguments.json { say(&object.to_string()) } else { Ok(()) };
    };
    let time_of = |frame| {
        let time = frames.time_of(frame, frames_per_second);
        time.map_err(|reason| Failure::Usage(format!("--frames: {reason}")))
    };
    for frame in frames.iter() {
        time_of(frame)?;
    }
    for frame in frames.iter() {
        let (time, started) = (time_of(frame)?, Instant::now());
        let mut object = pictures.make(time, Some(frame), started)?;
        (object["frame"], object["time"]) = (frame.into(), time.into());
        if arguments.json {
            say(&object.to_string())?;
        }
    }
    let count = frames.iter().len();
    arguments.tell(&format!("{count} frames, {:.1} s", started.elapsed().as_secs_f64()))
}

/// Every output with its quantity, in the file of this frame.
fn outputs_of(arguments: &RenderArguments, frame: Option<i64>) -> Result<Vec<(Quantity, PathBuf)>, Failure> {
    let path = |path: &Path| match frame {
        Some(_) if is_standard(path) => {
            Err(Failure::Usage("standard output holds one picture, not one for each of --frames".into()))
        }
        Some(frame) => numbered(path, frame).map_err(Failure::Usage),
        None => Ok(path.to_path_buf()),
    };
    arguments.outputs().into_iter().map(|(quantity, pattern)| Ok((quantity, path(pattern)?))).collect()
}

/// Makes pictures of a scene, one after the other.
struct Pictures<'a> {
    arguments: &'a RenderArguments,
    stills: Stills,
    painter: Option<StillPainter>,
    /// Warnings that were printed.
    told: Vec<Warning>,
}

impl Pictures<'_> {
    /// Renders the scene at `time` seconds and writes every output. Returns the result as one JSON object.
    fn make(&mut self, time: f64, frame: Option<i64>, started: Instant) -> Result<Value, Failure> {
        let arguments = self.arguments;
        let cancel = cancel_by_interrupts();
        let still = self.stills.at(time, &Task::canceled_by("rendering", &cancel));
        let still = still.map_err(|error| Failure::of_export(error, &shown(&arguments.scene)))?;
        let mut warnings = still.warnings.clone();
        self.warn(&warnings)?;
        if cancel.is_canceled() {
            return Err(Failure::Canceled);
        }
        let drawn = if arguments.reference {
            reference_picture(arguments, self.stills.scene().clone(), &still)?
        } else {
            let painter = self.painter.take().unwrap_or_else(|| StillPainter::new(arguments.adapter.choice()));
            let (painter, drawn, unfinished) = gpu_picture(arguments, painter, &still)?;
            self.painter = Some(painter);
            self.warn(&unfinished)?;
            warnings.extend(unfinished);
            drawn
        };
        let mut written = Vec::new();
        for (quantity, path) in outputs_of(arguments, frame)? {
            let mut note = write_output(quantity, &path, &drawn, &still)?;
            if quantity == Quantity::Color {
                let range = DepthRange::of(&still.flat.content(&still.meshes), still.camera.position);
                note += &arguments.view.note(&range);
            }
            arguments.tell(&format!("wrote {}{note}", path.display()))?;
            let file = path.display().to_string();
            written.push(json!({ "quantity": quantity.name(), "file": file, "note": note.trim() }));
        }
        let ([width, height], samples) = (arguments.size, still.film.samples);
        let (components, seconds) = (still.flat.components.len(), started.elapsed().as_secs_f64());
        let said = if samples > 1 { format!("{samples} samples, ") } else { String::new() };
        arguments.tell(&format!("{width}x{height} pixels, {said}{components} components, {seconds:.1} s"))?;
        let told = warnings.iter().map(|w| json!({ "node": format!("{} {}", w.name, w.node), "reason": w.reason }));
        Ok(json!({
            "ok": true,
            "file": shown(&arguments.scene).display().to_string(),
            "outputs": written,
            "width": width,
            "height": height,
            "samples": samples,
            "components": components,
            "seconds": seconds,
            "warnings": told.collect::<Vec<_>>(),
        }))
    }

    /// Prints the warnings that are new.
    fn warn(&mut self, warnings: &[Warning]) -> Result<(), Failure> {
        let new: Vec<Warning> = warnings.iter().filter(|warning| !self.told.contains(warning)).cloned().collect();
        let result = self.arguments.warn(&new);
        self.told.extend(new);
        result
    }
}

/// Interval of progress updates.
const TELL_EVERY: Duration = Duration::from_millis(50);

/// Runs `work` on its own thread while this one shows its progress. A panic in it becomes a failure.
fn by_job<T: Send + 'static>(
    name: &'static str,
    arguments: &RenderArguments,
    interrupts: Interrupts,
    work: impl FnOnce(&Task) -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    let mut progress = Progress::start(name, arguments.quiet, interrupts);
    let task = match interrupts {
        Interrupts::StopTheTask => Task::canceled_by(name, &cancel_by_interrupts()),
        Interrupts::EndTheProgram => Task::without_cancel(name),
    };
    let end = Jobs::default().start(task, work).wait_telling(TELL_EVERY, |task| {
        progress.update(task.progress().map_or(0.0, f64::from));
    });
    progress.finish();
    match end {
        JobEnd::Done(result) => result,
        JobEnd::Failed(reason) => Err(Failure::Other(reason)),
        JobEnd::Canceled => Err(Failure::Canceled),
    }
}

/// The picture by the painter, which draws in a job and comes back for the next one.
fn gpu_picture(
    arguments: &RenderArguments,
    mut painter: StillPainter,
    still: &Still,
) -> Result<(StillPainter, Drawn, Vec<Warning>), Failure> {
    /// Tells the task.
    struct Watch<'a>(&'a Task);
    impl StillWatch for Watch<'_> {
        fn progress(&mut self, share: f32) -> bool {
            self.0.set_progress(share);
            !self.0.is_canceled()
        }
    }
    let still = still.clone();
    by_job("rendering", arguments, Interrupts::StopTheTask, move |task| {
        let (drawn, unfinished) = painter.draw(&still, task, &mut Watch(task))?;
        Ok((painter, drawn, unfinished))
    })
}

fn reference_picture(arguments: &RenderArguments, scene: Scene, still: &Still) -> Result<Drawn, Failure> {
    let (path, size, still) = (arguments.scene.clone(), arguments.size, still.clone());
    by_job("tracing", arguments, Interrupts::EndTheProgram, move |task| {
        let Still { flat, meshes, camera, film, .. } = &still;
        let reference = render_reference(flat, meshes, camera, size, &|share| task.set_progress(share as f32));
        let mut buffers = reference.map_err(|error| Failure::given_up(&path, &scene, &error))?.buffers;
        if film.is_transparent {
            clear_background(&mut buffers);
        }
        Ok(Drawn { buffers, base_colors: Vec::new() })
    })
}

/// Writes one quantity: to standard output as PNG, or to a file.
fn write_output(quantity: Quantity, path: &Path, drawn: &Drawn, still: &Still) -> Result<String, Failure> {
    if !is_standard(path) {
        return Ok(outputs::write(quantity, path, drawn, still)?);
    }
    let failed = |reason: String| Failure::Write { path: path.to_path_buf(), reason };
    let (bytes, note) = outputs::encode(quantity, false, drawn, still).map_err(failed)?;
    let mut out = std::io::stdout().lock();
    out.write_all(&bytes).and_then(|()| out.flush()).map_err(|error| failed(error.to_string()))?;
    Ok(note)
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let number = |part: &str| part.parse::<u32>().ok();
    let size = text.split_once('x').and_then(|(w, h)| Some([number(w)?, number(h)?]));
    let size = size.ok_or(format!("give width and height in pixels, 1 to {MAX_SIDE} each, like 1280x720"))?;
    check_size(size).map(|()| size)
}

fn parse_time(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|time: &f64| time.is_finite()).ok_or("give a finite number of seconds".to_string())
}

fn picture_path(text: &str) -> Result<PathBuf, String> {
    match ending(Path::new(text)).as_str() {
        "png" | "exr" => Ok(text.into()),
        _ if is_standard(Path::new(text)) => Ok(text.into()),
        _ => Err("the picture's name must end in .png or .exr, or be - for standard output".into()),
    }
}

fn output_path(text: &str) -> Result<PathBuf, String> {
    match ending(Path::new(text)).as_str() {
        "png" | "exr" => Ok(text.into()),
        _ => Err("the name must end in .exr or .png".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_refused() {
        assert_eq!(parse_size("640x360"), Ok([640, 360]));
        for bad in
            ["", "640", "640x", "x360", "0x10", "10x0", "-1x5", "1.5x2", "640x360x2", "16385x1", "16384x16384", "a"]
        {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn times_are_finite() {
        assert_eq!(parse_time("-1.5"), Ok(-1.5));
        for bad in ["inf", "nan", "1e999", "", "soon"] {
            assert!(parse_time(bad).is_err(), "{bad}");
        }
    }
}
