//! The command line: the only place that prints, and the only one that ends the program.
//!
//! | module | what it does |
//! |---|---|
//! | `render` | `isolith render`: a picture without a window |
//! | `bench` | `isolith bench`: run time against error |
//! | `check` | `isolith check`: contents and faults of scenes |
//! | `shader` | `isolith shader`: the assembled source of a pass |
//! | `progress` | the bar, and Ctrl-C |
//! | `adapters` | `isolith adapters`, and the option that chooses one |
//! | `input` | scene files, standard input |
//! | `text` | printing |
//! | `pack` | `isolith pack`, `isolith unpack`: models within a scene |
//! | `film` | options for samples, exposure and view transform |
//! | `log` | spans and events, enabled by `RUST_LOG` |
//! | `runtime_folder` | the folder `XDG_RUNTIME_DIR` that drivers need |
//! | `failure` | failures and their exit codes |

mod adapters;
mod bench;
mod check;
mod failure;
mod film;
mod input;
mod log;
mod pack;
mod progress;
mod render;
mod runtime_folder;
mod shader;
mod text;

#[cfg(feature = "window")]
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::document::state_folder;
use clap::{Parser, Subcommand};

use crate::render::Gpu;
use crate::render::driver::loop_iterations;
use crate::scene::file;
use failure::Failure;
use text::{complain, say};

/// The exit codes in `--help`; `src/cli/README.md` has the same table.
const EXIT_CODES: &str = "Exit codes:
  0    done
  1    something else went wrong while rendering
  2    the command was not understood
  3    the scene file is missing, broken or beyond a limit, or has warnings under --strict
  4    no graphics: no Vulkan, Metal or DirectX driver answers, or no display
  5    an output cannot be written
  130  canceled with Ctrl-C";

/// Build, animate and render scenes of signed distance functions.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES, args_conflicts_with_subcommands = true)]
struct Arguments {
    /// Scene to open in the editor; without a display it is rendered to NAME.png in this folder
    scene: Option<PathBuf>,
    #[command(flatten)]
    adapter: adapters::AdapterArguments,
    #[command(subcommand)]
    command: Option<CliCommand>,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Render a scene to a picture, without a window
    #[command(after_help = EXIT_CODES)]
    Render(render::RenderArguments),
    /// Say what scene files hold and what is wrong with them
    #[command(after_help = EXIT_CODES)]
    Check(check::CheckArguments),
    /// Measure how long scenes take and how exact they are, by every method
    #[command(after_help = EXIT_CODES)]
    Bench(bench::BenchArguments),
    /// Write a scene with the files of its models, so that one file is all of it
    #[command(after_help = EXIT_CODES)]
    Pack(pack::PackArguments),
    /// Write a scene without the files that it packs, and these beside it
    #[command(after_help = EXIT_CODES)]
    Unpack(pack::UnpackArguments),
    /// Print the WGSL source of a pass as a graphics device gets it
    #[command(after_help = EXIT_CODES)]
    Shader(shader::ShaderArguments),
    /// Print the JSON schema of scene files
    Schema,
    /// List the graphics adapters
    Adapters(adapters::AdaptersArguments),
    /// Write the example scenes into a folder
    #[command(hide = true)]
    Gallery {
        /// The folder
        folder: PathBuf,
    },
    /// Say which graphics driver answers
    #[command(hide = true)]
    Probe(adapters::AdapterArguments),
}

/// Runs the program with its command line arguments.
pub fn main() -> ExitCode {
    log::listen();
    runtime_folder::provide();
    let arguments = Arguments::parse();
    if let Some(folder) = state_folder() {
        file::keep_records_in(&folder.join("temporaries"));
        file::remove_leftovers();
    }
    match run(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            complain(&format!("error: {failure}"));
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        None => open(arguments.scene.as_deref(), &arguments.adapter),
        Some(CliCommand::Render(arguments)) => render::render(&arguments),
        Some(CliCommand::Check(arguments)) => check::check(&arguments),
        Some(CliCommand::Bench(arguments)) => bench::bench(&arguments),
        Some(CliCommand::Pack(arguments)) => pack::pack_scene(&arguments),
        Some(CliCommand::Unpack(arguments)) => pack::unpack_scene(&arguments),
        Some(CliCommand::Shader(arguments)) => shader::shader(&arguments),
        Some(CliCommand::Schema) => say(&format!("{:#}", crate::scene::file::schema())),
        Some(CliCommand::Gallery { folder }) => write_gallery(&folder),
        Some(CliCommand::Adapters(arguments)) => adapters::list(&arguments),
        Some(CliCommand::Probe(adapter)) => probe(&adapter),
    }
}

/// Opens the editor. Without a display, renders the scene to a file instead.
fn open(scene: Option<&Path>, adapter: &adapters::AdapterArguments) -> Result<(), Failure> {
    scene.map_or(Ok(()), input::refuse_unknown_word)?;
    let missing =
        if cfg!(feature = "window") { "There is no display" } else { "The program was built without its window" };
    #[cfg(feature = "window")]
    if has_display(|name| std::env::var_os(name)) {
        use crate::{app, document::Document, editor::new_document};
        let document = match scene {
            Some(path) => Document::open(path).map_err(Failure::Scene)?,
            None => new_document(),
        };
        return app::run(document, &adapter.choice(), complain).map_err(|e| Failure::Graphics(e.to_string()));
    }
    let Some(scene) = scene else {
        return Err(Failure::Graphics(format!("{missing}; give a scene and it is rendered to a picture")));
    };
    let stem = scene.file_stem().unwrap_or(scene.as_os_str());
    let output = PathBuf::from(stem).with_extension("png");
    say(&format!("{missing}: rendering {} to {}.", scene.display(), output.display()))?;
    render::render(&render::RenderArguments::still(scene, &output, adapter))
}

/// Whether there is a display. Only X11 and Wayland announce it through the environment; other systems always have
/// one.
#[cfg(feature = "window")]
fn has_display(variable: impl Fn(&str) -> Option<OsString>) -> bool {
    let set = |name: &str| variable(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

fn write_gallery(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Write { path: folder.to_path_buf(), reason: error.to_string() })?;
    let written = crate::gallery::write_all(folder)
        .map_err(|error| Failure::Write { path: PathBuf::from(&error.file), reason: error.reason })?;
    written.iter().try_for_each(|path| say(&format!("wrote {}", path.display())))
}

/// Prints the driver's name, and the number of iterations of its loops.
fn probe(adapter: &adapters::AdapterArguments) -> Result<(), Failure> {
    let gpu = Gpu::open(&adapter.choice())?;
    let iterations = loop_iterations(&gpu)?;
    let info = &gpu.info;
    say(&format!("{} ({}, {} {}), loops of {iterations}", info.name, info.backend, info.driver, info.driver_info))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[cfg(feature = "window")]
    #[test]
    #[cfg(target_os = "linux")]
    fn a_display_is_one_that_is_named() {
        let with = |name: &'static str, value: &'static str| move |n: &str| (n == name).then(|| OsString::from(value));
        assert!(has_display(with("DISPLAY", ":0")));
        assert!(has_display(with("WAYLAND_DISPLAY", "wayland-0")));
        assert!(!has_display(with("DISPLAY", "")));
        assert!(!has_display(|_| None));
    }
}
