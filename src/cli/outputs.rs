//! Buffers → files. A file is written beside its place and moved there whole, so that no reader ever sees
//! half of it.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageBuffer, ImageFormat};

use super::exr_ids;
use super::failure::Failure;
use super::input::is_standard;
use crate::flat::{Buffers, FlatScene, Hitee};

/// What a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The picture.
    Color,
    /// Distance along the ray, in metres.
    Depth,
    /// World normal.
    Normal,
    /// Id of the node seen.
    NodeId,
}

impl Quantity {
    /// Its name in JSON, as the option that asks for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "output",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::NodeId => "node-id",
        }
    }
}

/// Writes one quantity of the buffers, as the path's ending asks; `-` is standard output and gets a PNG. Returns what a
/// person needs to know to read it, to be put behind the file's name.
pub fn write(quantity: Quantity, path: &Path, buffers: &Buffers, flat: &FlatScene) -> Result<String, Failure> {
    let failed = |reason: String| Failure::Write { path: path.to_path_buf(), reason };
    let (bytes, note) = encode(quantity, ending(path) == "exr", buffers, flat).map_err(failed)?;
    if is_standard(path) {
        let mut out = std::io::stdout().lock();
        out.write_all(&bytes).and_then(|()| out.flush()).map_err(|error| failed(error.to_string()))?;
    } else {
        replace(path, &bytes).map_err(|error| failed(error.to_string()))?;
    }
    Ok(note)
}

fn encode(quantity: Quantity, as_exr: bool, buffers: &Buffers, flat: &FlatScene) -> Result<(Vec<u8>, String), String> {
    let (image, note) = match (quantity, as_exr) {
        (Quantity::Color, _) => (color(buffers), String::new()),
        (Quantity::Depth, true) => (raw(buffers, |i| [buffers.depth[i]; 3]), " (metres)".into()),
        (Quantity::Depth, false) => depth_picture(buffers),
        (Quantity::Normal, true) => (raw(buffers, |i| buffers.normal[i]), " (X, Y, Z)".into()),
        (Quantity::Normal, false) => (normal_picture(buffers), String::new()),
        (Quantity::NodeId, true) => {
            let ids: Vec<u64> = (0..buffers.depth.len()).map(|i| node_id(buffers, flat, i)).collect();
            let bytes = exr_ids::encode(buffers.width, buffers.height, &ids).map_err(|error| error.to_string())?;
            return Ok((bytes, " (ids, whole numbers)".into()));
        }
        (Quantity::NodeId, false) => (node_id_picture(buffers, flat), String::new()),
    };
    let format = if as_exr { ImageFormat::OpenExr } else { ImageFormat::Png };
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).map_err(|error| error.to_string())?;
    Ok((bytes.into_inner(), note))
}

/// The path's ending in small letters.
pub fn ending(path: &Path) -> String {
    path.extension().map_or(String::new(), |e| e.to_string_lossy().to_lowercase())
}

/// Refuses early what could not be written after minutes of rendering.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return Ok(());
    }
    let refuse = |reason: String| Err(Failure::Write { path: path.to_path_buf(), reason });
    if path.is_dir() {
        return refuse("it is a folder".into());
    }
    let probe = temporary(path);
    match fs::File::create(&probe) {
        Ok(_) => {
            let _ = fs::remove_file(&probe);
            Ok(())
        }
        Err(error) => refuse(error.to_string()),
    }
}

fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let beside = temporary(path);
    let written = fs::File::create(&beside).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&beside, path)
    });
    if written.is_err() {
        let _ = fs::remove_file(&beside);
    }
    written
}

fn temporary(path: &Path) -> PathBuf {
    let name = path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
    path.with_file_name(format!(".{name}.tmp-{}", std::process::id()))
}

fn color(buffers: &Buffers) -> DynamicImage {
    let bytes = buffers.color.iter().flatten().copied().collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, bytes);
    DynamicImage::ImageRgba8(image.expect("one colour for each pixel"))
}

fn raw(buffers: &Buffers, value: impl Fn(usize) -> [f32; 3]) -> DynamicImage {
    let values = (0..buffers.depth.len()).flat_map(value).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, values);
    DynamicImage::ImageRgb32F(image.expect("three numbers for each pixel"))
}

fn picture_of(buffers: &Buffers, pixel: impl Fn(usize) -> [u8; 3]) -> DynamicImage {
    let bytes = (0..buffers.depth.len()).flat_map(pixel).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, bytes);
    DynamicImage::ImageRgb8(image.expect("three bytes for each pixel"))
}

/// Near is white, far dark grey, background black, with 16 bits so that it can be measured.
fn depth_picture(buffers: &Buffers) -> (DynamicImage, String) {
    const FARTHEST: f64 = 0.1;
    let finite = || buffers.depth.iter().copied().filter(|depth| depth.is_finite()).map(f64::from);
    let (near, far) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let grey = |depth: f32| -> u16 {
        if !depth.is_finite() {
            return 0;
        }
        let share = (f64::from(depth) - near) / (far - near).max(f64::MIN_POSITIVE);
        ((1.0 - share * (1.0 - FARTHEST)) * f64::from(u16::MAX)).round() as u16
    };
    let values = buffers.depth.iter().map(|depth| grey(*depth)).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, values).expect("one grey for each pixel");
    let note =
        if near <= far { format!(" (white {near:.4} m, grey 0.1 {far:.4} m)") } else { " (nothing is seen)".into() };
    (DynamicImage::ImageLuma16(image), note)
}

fn normal_picture(buffers: &Buffers) -> DynamicImage {
    picture_of(buffers, |i| match buffers.depth[i].is_finite() {
        true => buffers.normal[i].map(|n| ((n * 0.5 + 0.5) * 255.0).round() as u8),
        false => [0; 3],
    })
}

/// The id of the node that a pixel shows, 0 where it shows none.
fn node_id(buffers: &Buffers, flat: &FlatScene, pixel: usize) -> u64 {
    match buffers.hitee(pixel) {
        Hitee::Background => 0,
        Hitee::Leaf(leaf) => flat.ids[leaf].0,
        Hitee::Mesh(mesh) => flat.meshes[mesh].id.0,
    }
}

fn node_id_picture(buffers: &Buffers, flat: &FlatScene) -> DynamicImage {
    picture_of(buffers, |i| match node_id(buffers, flat, i) {
        0 => [0; 3],
        id => {
            // Fibonacci hashing spreads neighbouring ids over the whole range; at least 64 keeps the
            // colours apart from the background.
            let hash = id.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            [56, 48, 40].map(|shift| 64 + ((hash >> shift) & 0xff) as u8 / 4 * 3)
        }
    })
}
