//! Buffers → files, by the same atomic writer as scenes: a reader never sees a partial file.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageBuffer, ImageFormat};

use super::error::ExportError;
use super::still::{Drawn, Still};
use super::{exr_ids, exr_layers, exr_light};
use crate::field::{FlatScene, GBuffer, HitTarget};
use crate::scene::file;
use crate::session::ending;

/// The content of an output file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The picture.
    Color,
    /// The picture with all other quantities and the base color, as layers of one OpenEXR file.
    Layers,
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
            Self::Color | Self::Layers => "output",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::NodeId => "node-id",
        }
    }
}

/// Encodes one quantity of a picture as OpenEXR or PNG. Returns a note for reading the file, too, to be told after its
/// name.
///
/// # Errors
/// The encoder refuses, with its reason.
pub fn encode(quantity: Quantity, as_exr: bool, picture: &Drawn, still: &Still) -> Result<(Vec<u8>, String), String> {
    let (buffers, flat, samples) = (&picture.buffers, &*still.flat, still.film.samples);
    let size = [buffers.width, buffers.height];
    let (image, note) = match (quantity, as_exr) {
        (Quantity::Color, true) => {
            let bytes = exr_light::encode(size, &buffers.radiance, &flat.display, samples);
            return Ok((bytes.map_err(|error| error.to_string())?, " (linear light)".into()));
        }
        (Quantity::Layers, _) => {
            let bytes = exr_layers::encode(picture, &node_ids(buffers, flat), &still.names, &flat.display, samples);
            return Ok((bytes.map_err(|error| error.to_string())?, " (linear light, and layers)".into()));
        }
        (Quantity::Color, false) => (color(buffers), String::new()),
        (Quantity::Depth, true) => (raw(buffers, |i| [buffers.depth[i]; 3]), " (meters)".into()),
        (Quantity::Depth, false) => depth_picture(buffers),
        (Quantity::Normal, true) => (raw(buffers, |i| buffers.normal[i]), " (X, Y, Z)".into()),
        (Quantity::Normal, false) => (normal_picture(buffers), String::new()),
        (Quantity::NodeId, true) => {
            let bytes = exr_ids::encode(size[0], size[1], &node_ids(buffers, flat));
            return Ok((bytes.map_err(|error| error.to_string())?, " (ids, whole numbers)".into()));
        }
        (Quantity::NodeId, false) => (node_id_picture(buffers, flat), String::new()),
    };
    let format = if as_exr { ImageFormat::OpenExr } else { ImageFormat::Png };
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).map_err(|error| error.to_string())?;
    Ok((bytes.into_inner(), note))
}

/// Writes one quantity in the format of the path's extension, atomically. Returns a note for reading the file.
///
/// # Errors
/// It cannot be encoded or written.
pub fn write(quantity: Quantity, path: &Path, picture: &Drawn, still: &Still) -> Result<String, ExportError> {
    let failed = |reason: String| ExportError::Write { path: path.to_path_buf(), reason };
    let (bytes, note) = encode(quantity, ending(path) == "exr", picture, still).map_err(failed)?;
    write_bytes(path, &bytes)?;
    Ok(note)
}

/// Writes one output atomically.
///
/// # Errors
/// It cannot be written.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    file::replace(path, bytes, 0)
        .map_err(|error| ExportError::Write { path: path.to_path_buf(), reason: error.to_string() })
}

/// Refuses outputs that cannot be written, before minutes of rendering, and outputs that would replace another output
/// or an input: a link whose name ends in `.png` can point to the scene.
///
/// # Errors
/// The first such output, with the reason.
pub fn check_writable(outputs: &[&Path], inputs: &[&Path]) -> Result<(), ExportError> {
    for (index, path) in outputs.iter().enumerate() {
        let refuse = |reason: String| Err(ExportError::Write { path: path.to_path_buf(), reason });
        if let Some(other) = outputs[..index].iter().find(|other| file::is_same_place(other, path)) {
            return refuse(format!("it is the same file as {}, another output", other.display()));
        }
        if let Some(input) = inputs.iter().find(|input| file::is_same_place(input, path)) {
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

/// The id of the visible node of each pixel, 0 for background.
fn node_ids(buffers: &GBuffer, flat: &FlatScene) -> Vec<u64> {
    (0..buffers.depth.len()).map(|i| node_id(buffers, flat, i)).collect()
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
