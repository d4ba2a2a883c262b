//! The cards, and a process for each. The driver reads the card to emulate when it is loaded, and that environment must
//! not affect the program's own devices.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::subjects::Pipeline;
use crate::vulkan::Device;
use crate::{Error, Statistics};

/// A generation of graphics cards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Card {
    /// Its name in tables.
    pub name: &'static str,
    /// Its names in RADV, by version of the driver.
    families: &'static [&'static str],
    /// Most vector registers per lane: 128, in the allocation steps of the card. With these a SIMD holds 8 or 10 waves,
    /// enough for some to compute while others wait for memory.
    pub max_vgprs: u64,
}

/// Two generations that differ in their number of registers: RDNA 2, and RDNA 3.
pub const CARDS: [Card; 2] = [
    Card { name: "GFX10.3", families: &["gfx1030", "navi21"], max_vgprs: 128 },
    Card { name: "GFX11", families: &["gfx1100", "navi31"], max_vgprs: 132 },
];

/// The driver's statistics for all pipelines.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// Description of the card and the driver.
    pub device: String,
    /// Statistics of the stages of each pipeline.
    pub statistics: Vec<Vec<Statistics>>,
}

/// Makes `program` compile all pipelines for a card, in its own process.
pub fn measure(card: &Card, program: &Path, pipelines: &[Pipeline]) -> Result<Report, Error> {
    let failed = |error: &dyn std::fmt::Display| Error::Process(format!("{}: {error}", card.name));
    let drivers = drivers()?;
    let orders = tempfile::NamedTempFile::new().map_err(|error| failed(&error))?;
    let text = serde_json::to_vec(pipelines).map_err(|error| failed(&error))?;
    std::fs::write(orders.path(), text).map_err(|error| failed(&error))?;
    let mut complaint = String::new();
    for family in card.families {
        let mut command = Command::new(program);
        command.arg(orders.path()).env("RADV_FORCE_FAMILY", family).env("AMD_FORCE_FAMILY", family);
        // Both names of the same variable: loaders before 1.3.207 know only the second one.
        command.env("VK_DRIVER_FILES", &drivers).env("VK_ICD_FILENAMES", &drivers);
        // Cached pipelines would take no time.
        command.env("MESA_SHADER_CACHE_DISABLE", "true").env_remove("RADV_DEBUG").env_remove("ACO_DEBUG");
        let output = command.output().map_err(|error| failed(&error))?;
        if output.status.success() {
            return serde_json::from_slice(&output.stdout).map_err(|error| failed(&error));
        }
        complaint = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        if !complaint.to_lowercase().contains("unknown family") {
            break;
        }
    }
    match complaint.strip_prefix(NO_DRIVER) {
        Some(reason) => Err(Error::NoDriver(reason.to_owned())),
        None => Err(failed(&complaint)),
    }
}

/// Prefix of the error message of the card's process if the driver is missing.
pub const NO_DRIVER: &str = "no driver: ";

/// The body of the card's process: compiles the pipelines in the file and prints a [`Report`] or an error.
pub fn serve(orders: &Path) -> Result<String, String> {
    let text = std::fs::read(orders).map_err(|error| error.to_string())?;
    let pipelines: Vec<Pipeline> = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
    let in_words = |error: Error| match error {
        Error::NoDriver(reason) => format!("{NO_DRIVER}{reason}"),
        other => other.to_string(),
    };
    let device = Device::open().map_err(in_words)?;
    let statistics = pipelines.iter().map(|pipeline| device.compile(pipeline));
    let statistics = statistics.collect::<Result<_, _>>().map_err(in_words)?;
    serde_json::to_string(&Report { device: device.name.clone(), statistics }).map_err(|error| error.to_string())
}

/// Paths of RADV's manifests, in the loader's format.
fn drivers() -> Result<String, Error> {
    let folders = folders();
    let mut found: Vec<String> = Vec::new();
    for entry in folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with("radeon_icd") && name.ends_with(".json") {
            found.push(entry.path().display().to_string());
        }
    }
    if found.is_empty() {
        let folders = folders.iter().map(|folder| folder.display().to_string());
        return Err(Error::NoDriver(format!("no radeon_icd*.json in {}", folders.collect::<Vec<_>>().join(", "))));
    }
    // One for each architecture: the loader picks one that it can load.
    Ok(found.join(":"))
}

/// Folders of driver manifests: that of the manifest named in the environment, then the loader's default folders.
fn folders() -> Vec<PathBuf> {
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].map(variable).join(":");
    let named = named.split(':').filter_map(|file| Path::new(file).parent().map(Path::to_path_buf));
    let shared = ["/usr/share", "/usr/local/share", "/etc", "/usr/local/etc"].map(PathBuf::from);
    let own = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".local/share"));
    let of_systems = shared.into_iter().chain(own).map(|root| root.join("vulkan/icd.d"));
    named.filter(|folder| !folder.as_os_str().is_empty()).chain(of_systems).collect()
}
