//! `isolith pack` and `isolith unpack`: the models of a scene within its file, and beside it again.

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::input::{folder, is_standard, read_scene, shown};
use super::text::say;
use crate::jobs::Task;
use crate::scene::file::{self, FileError};
use crate::scene::{PackedFiles, Scene};
use crate::session::{pack, unpack};

/// The scene and the result of packing.
#[derive(Debug, Args)]
pub struct PackArguments {
    /// Scene to pack
    scene: PathBuf,
    /// The file that holds the scene with its models
    #[arg(short, long)]
    output: PathBuf,
}

/// The scene and the result of unpacking.
#[derive(Debug, Args)]
pub struct UnpackArguments {
    /// Scene that packs its models
    scene: PathBuf,
    /// The scene without them; the models are written beside it. An existing model of other content is never replaced
    #[arg(short, long)]
    output: PathBuf,
}

/// Writes the scene with the files of its models.
pub fn pack_scene(arguments: &PackArguments) -> Result<(), Failure> {
    let PackArguments { scene: path, output } = arguments;
    let mut scene = read_scene(path)?;
    let folder = folder(path).filter(|_| !is_standard(path));
    let packed = pack(&scene, folder.as_deref(), &Task::new("Packing"));
    scene.packed = packed.map_err(|reason| Failure::Scene(FileError::new(&shown(path), reason)))?;
    save(&scene, output)?;
    let (count, size) = (scene.packed.table().len(), scene.packed.size());
    say(&format!("{}: {count} files packed, {:.1} MiB", output.display(), size as f64 / f64::from(1 << 20)))
}

/// Writes the scene without the files that it packs, and these beside it.
pub fn unpack_scene(arguments: &UnpackArguments) -> Result<(), Failure> {
    let UnpackArguments { scene: path, output } = arguments;
    let mut scene = read_scene(path)?;
    let beside = output.parent().unwrap_or(output);
    let written = unpack(&scene, beside, &Task::new("Unpacking"))
        .map_err(|reason| Failure::Write { path: output.clone(), reason })?;
    let count = scene.packed.table().len();
    scene.packed = PackedFiles::default();
    save(&scene, output)?;
    say(&format!("{}: {count} files unpacked, {} written", output.display(), written.len()))
}

fn save(scene: &Scene, output: &std::path::Path) -> Result<(), Failure> {
    let failed = |error: FileError| Failure::Write { path: output.to_path_buf(), reason: error.reason };
    file::save(scene, output).map_err(failed)
}
