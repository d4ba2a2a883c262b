//! An order to render pictures into files, as plain data: what a dialog asks for, and what the command line says.

use std::path::{Path, PathBuf};

use super::frames::FrameRange;
use isolith_field::Shading;
use isolith_scene::Scene;

/// Longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// Maximum number of pixels in a picture; the processor keeps 44 bytes for each.
pub const MAX_PIXELS: u64 = 1 << 27;
/// Default number of samples: straight edges err by 5 % of the contrast.
pub const DEFAULT_SAMPLES: u32 = 16;
/// Most samples: the rounding of their sum in f32 stays far below a step of a byte.
pub const MAX_SAMPLES: u32 = 4_096;
/// Default width and height in pixels.
pub const DEFAULT_SIZE: [u32; 2] = [1280, 720];

/// The moments of the pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moments {
    /// One picture, at a time in seconds.
    Still(f64),
    /// A picture for each of these frames, by the frame rate of the scene.
    Frames(FrameRange),
}

/// How the pictures are made, and where they go.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// File of the picture: .png, or .exr for linear light; of frames a pattern with a run of `#`.
    pub output: PathBuf,
    /// Whether an .exr also holds depth, normal, node id and base color.
    pub has_layers: bool,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Camera by name; `None` for the first one.
    pub camera: Option<String>,
    /// Samples per pixel.
    pub samples: u32,
    /// Whether the background is left out.
    pub is_transparent: bool,
    /// How the scene is lit.
    pub shading: Shading,
    /// Which moments.
    pub moments: Moments,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            output: PathBuf::new(),
            has_layers: false,
            size: DEFAULT_SIZE,
            camera: None,
            samples: DEFAULT_SAMPLES,
            is_transparent: false,
            shading: Shading::Rendered,
            moments: Moments::Still(0.0),
        }
    }
}

impl RenderSettings {
    /// Whether the picture is written as linear light.
    pub fn is_linear(&self) -> bool {
        ending(&self.output) == "exr"
    }

    /// The command that renders the same pictures from the scene's file.
    pub fn command(&self, scene: &Path, adapter: Option<&str>) -> String {
        let [width, height] = self.size;
        let mut words = vec!["isolith".into(), "render".into(), quoted(&scene.to_string_lossy())];
        let mut say = |option: &str, value: Option<&str>| {
            words.push(option.to_owned());
            words.extend(value.map(quoted));
        };
        say("-o", Some(&self.output.to_string_lossy()));
        if self.size != DEFAULT_SIZE {
            say("--size", Some(&format!("{width}x{height}")));
        }
        if let Some(camera) = &self.camera {
            say("--camera", Some(camera));
        }
        match self.moments {
            Moments::Still(0.0) => {}
            Moments::Still(time) => say("--time", Some(&time.to_string())),
            Moments::Frames(frames) => say("--frames", Some(&frames.to_string())),
        }
        if self.samples != DEFAULT_SAMPLES {
            say("--samples", Some(&self.samples.to_string()));
        }
        if self.is_transparent {
            say("--transparent", None);
        }
        if self.has_layers {
            say("--layers", None);
        }
        if self.shading != Shading::Rendered {
            say("--shading", Some(self.shading.name()));
        }
        if let Some(adapter) = adapter {
            say("--adapter", Some(adapter));
        }
        words.join(" ")
    }
}

/// A scene and how to render it.
#[derive(Clone, Debug)]
pub struct RenderOrder {
    /// The scene, at rest.
    pub scene: Scene,
    /// Its file; its models lie in the folder of it.
    pub file: Option<PathBuf>,
    /// How it is rendered.
    pub settings: RenderSettings,
    /// Whether files that exist may be replaced.
    pub may_replace: bool,
}

/// The path's extension in lower case.
pub fn ending(path: &Path) -> String {
    path.extension().map_or(String::new(), |e| e.to_string_lossy().to_lowercase())
}

/// Refuses a size beyond the limits.
///
/// # Errors
/// The reason.
pub fn check_size(size: [u32; 2]) -> Result<(), String> {
    let [width, height] = size;
    if size.iter().any(|side| !(1..=MAX_SIDE).contains(side)) {
        return Err(format!("give width and height in pixels, 1 to {MAX_SIDE} each, like 1280x720"));
    }
    match u64::from(width) * u64::from(height) > MAX_PIXELS {
        true => Err(format!("{width}x{height} is more than {MAX_PIXELS} pixels")),
        false => Ok(()),
    }
}

/// The word as a POSIX shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:=,+@%".contains(c);
    // A leading # begins a comment, elsewhere in a word it is a character like others.
    if !word.is_empty() && word.chars().enumerate().all(|(i, c)| is_plain(c) || (c == '#' && i > 0)) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_names_what_differs_from_its_defaults() {
        let plain = RenderSettings { output: "pawn.png".into(), ..RenderSettings::default() };
        assert_eq!(plain.command(Path::new("pawn.json"), None), "isolith render pawn.json -o pawn.png");
        let all = RenderSettings {
            output: "out/it's.####.exr".into(),
            has_layers: true,
            size: [64, 32],
            camera: Some("Front view".into()),
            samples: 3,
            is_transparent: true,
            shading: Shading::Solid,
            moments: Moments::Frames(FrameRange::new(-1, 24).expect("a range")),
        };
        let command = all.command(Path::new("a b.json"), Some("llvm"));
        let said = "isolith render 'a b.json' -o 'out/it'\\''s.####.exr' --size 64x32 --camera 'Front view' --frames \
                    -1..24 --samples 3 --transparent --layers --shading solid --adapter llvm";
        assert_eq!(command, said);
        let moment = RenderSettings { moments: Moments::Still(0.1), ..plain };
        assert!(moment.command(Path::new("p.json"), None).ends_with("--time 0.1"));
    }

    #[test]
    fn sizes_have_limits() {
        assert!(check_size([1, MAX_SIDE]).is_ok());
        for bad in [[0, 5], [5, MAX_SIDE + 1], [MAX_SIDE, MAX_SIDE]] {
            assert!(check_size(bad).is_err(), "{bad:?}");
        }
    }
}
