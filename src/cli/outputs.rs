//! Buffers → files, by the same atomic writer as scenes: a reader never sees a partial file.

use std::io::{Cursor, Write};
use std::path::Path;

use image::{DynamicImage, ImageBuffer, ImageFormat};

use super::failure::Failure;
use super::input::is_standard;
use super::{exr_ids, exr_light};
use crate::field::{FlatScene, GBuffer, HitTarget};
use crate::scene::file;

/// The content of an output file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The picture.
    Color,
    /// Distance along the ray, in meters.
    Depth,
    /// World normal.
    Normal,
    /// Id of the visible node.
    NodeId,
}

impl Quantity {
    /// Its name in JSON, which is that of its option.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "output",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::NodeId => "node-id",
        }
    }
}

/// Writes one quantity of the buffers in the format of the path's extension; `-` is standard output and gets a PNG.
/// Returns a note for reading the file, to be printed after its name.
pub fn write(
    quantity: Quantity,
    path: &Path,
    buffers: &GBuffer,
    flat: &FlatScene,
    samples: u32,
) -> Result<String, Failure> {
    let failed = |reason: String| Failure::Write { path: path.to_path_buf(), reason };
    let (bytes, note) = encode(quantity, ending(path) == "exr", buffers, flat, samples).map_err(failed)?;
    if is_standard(path) {
        let mut out = std::io::stdout().lock();
        out.write_all(&bytes).and_then(|()| out.flush()).map_err(|error| failed(error.to_string()))?;
    } else {
        write_bytes(path, &bytes)?;
    }
    Ok(note)
}

fn encode(
    quantity: Quantity,
    as_exr: bool,
    buffers: &GBuffer,
    flat: &FlatScene,
    samples: u32,
) -> Result<(Vec<u8>, String), String> {
    let (image, note) = match (quantity, as_exr) {
        (Quantity::Color, true) => {
            let size = [buffers.width, buffers.height];
            let bytes = exr_light::encode(size, &buffers.radiance, &flat.display, samples);
            return Ok((bytes.map_err(|error| error.to_string())?, " (linear light)".into()));
        }
        (Quantity::Color, false) => (color(buffers), String::new()),
        (Quantity::Depth, true) => (raw(buffers, |i| [buffers.depth[i]; 3]), " (meters)".into()),
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

/// The path's extension in lower case.
pub fn ending(path: &Path) -> String {
    path.extension().map_or(String::new(), |e| e.to_string_lossy().to_lowercase())
}

/// Writes one output atomically.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    file::replace(path, bytes, 0)
        .map_err(|error| Failure::Write { path: path.to_path_buf(), reason: error.to_string() })
}

/// Refuses outputs that cannot be written, before minutes of rendering, and outputs that would replace another output
/// or an input: a link whose name ends in `.png` can point to the scene.
pub fn check_writable(outputs: &[&Path], inputs: &[&Path]) -> Result<(), Failure> {
    let outputs: Vec<&Path> = outputs.iter().copied().filter(|path| !is_standard(path)).collect();
    for (index, path) in outputs.iter().enumerate() {
        let refuse = |reason: String| Err(Failure::Write { path: path.to_path_buf(), reason });
        if let Some(other) = outputs[..index].iter().find(|other| file::is_same_place(other, path)) {
            return refuse(format!("it is the same file as {}, another output", other.display()));
        }
        if let Some(input) = inputs.iter().find(|input| !is_standard(input) && file::is_same_place(input, path)) {
            return refuse(format!("it is the same file as {}, which is read", input.display()));
        }
        if let Err(error) = file::check_writable(path) {
            return refuse(error.to_string());
        }
    }
    Ok(())
}

fn color(buffers: &GBuffer) -> DynamicImage {
    let bytes = buffers.color.iter().flatten().copied().collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, bytes);
    DynamicImage::ImageRgba8(image.expect("one color for each pixel"))
}

fn raw(buffers: &GBuffer, value: impl Fn(usize) -> [f32; 3]) -> DynamicImage {
    let values = (0..buffers.depth.len()).flat_map(value).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, values);
    DynamicImage::ImageRgb32F(image.expect("three numbers for each pixel"))
}

fn picture_of(buffers: &GBuffer, pixel: impl Fn(usize) -> [u8; 3]) -> DynamicImage {
    let bytes = (0..buffers.depth.len()).flat_map(pixel).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, bytes);
    DynamicImage::ImageRgb8(image.expect("three bytes for each pixel"))
}

/// Near is white, far is dark gray, background is black; 16 bits make it measurable.
fn depth_picture(buffers: &GBuffer) -> (DynamicImage, String) {
    const FARTHEST: f64 = 0.1;
    let finite = || buffers.depth.iter().copied().filter(|depth| depth.is_finite()).map(f64::from);
    let (near, far) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let gray = |depth: f32| -> u16 {
        if !depth.is_finite() {
            return 0;
        }
        let share = (f64::from(depth) - near) / (far - near).max(f64::MIN_POSITIVE);
        ((1.0 - share * (1.0 - FARTHEST)) * f64::from(u16::MAX)).round() as u16
    };
    let values = buffers.depth.iter().map(|depth| gray(*depth)).collect();
    let image = ImageBuffer::from_raw(buffers.width, buffers.height, values).expect("one gray for each pixel");
    let note =
        if near <= far { format!(" (white {near:.4} m, gray 0.1 {far:.4} m)") } else { " (nothing is seen)".into() };
    (DynamicImage::ImageLuma16(image), note)
}

fn normal_picture(buffers: &GBuffer) -> DynamicImage {
    picture_of(buffers, |i| match buffers.depth[i].is_finite() {
        true => buffers.normal[i].map(|n| ((n * 0.5 + 0.5) * 255.0).round() as u8),
        false => [0; 3],
    })
}

/// The id of the visible node of a pixel, 0 for background.
fn node_id(buffers: &GBuffer, flat: &FlatScene, pixel: usize) -> u64 {
    match buffers.hit_target(pixel) {
        HitTarget::Background => 0,
        HitTarget::Leaf(leaf) => flat.ids[leaf].0,
        HitTarget::Mesh(mesh) => flat.meshes[mesh].id.0,
    }
}

fn node_id_picture(buffers: &GBuffer, flat: &FlatScene) -> DynamicImage {
    picture_of(buffers, |i| match node_id(buffers, flat, i) {
        0 => [0; 3],
        id => {
            // Fibonacci hashing spreads neighboring ids over the whole range; at least 64 keeps the
            // colors apart from the background.
            let hash = id.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            [56, 48, 40].map(|shift| 64 + ((hash >> shift) & 0xff) as u8 / 4 * 3)
        }
    })
}
