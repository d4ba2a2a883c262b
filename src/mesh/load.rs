//! Loads a file as one mesh: the steps in order.

use std::borrow::Cow;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::accessor::Source;
use super::clip::{Poses, poses};
use super::document::{GltfDocument, read_document};
use super::error::LoadRefusal;
use super::forest::walk;
use super::limits::{MAX_BUFFER_BYTES, MAX_FILE_BYTES, MAX_TEXTURE_BYTES};
use super::model_pose::ClipTime;
use super::pose::{Pose, morph_weights};
use super::primitive::Writer;
use super::remarks::Remarks;
use super::resolve::{Reader, read_file};
use super::surface::Surfaces;
use super::texture::SharedTextures;
use super::{MeshError, TriangleMesh};

/// Reads a .gltf or .glb file, with the buffers and images that it names in its own folder.
///
/// # Errors
/// Names file, place and reason of everything that is missing, broken, unsafe or too large.
pub fn load(path: &Path) -> Result<TriangleMesh, MeshError> {
    let bytes = read_file(path).map_err(|reason| LoadRefusal::at("", reason).of(path))?;
    parse(&bytes, path, Some(path.parent().unwrap_or(Path::new("."))))
}

/// Like [`load`], from memory. `file` only names the file in errors; `folder` is where other files are looked up.
///
/// # Errors
/// As [`load`].
pub fn parse(bytes: &[u8], file: &Path, folder: Option<&Path>) -> Result<TriangleMesh, MeshError> {
    parse_posed(bytes, file, folder, None)
}

/// Like [`parse`], in the pose of a clip.
///
/// # Errors
/// As [`load`]; also what is broken in the clip.
pub fn parse_posed(
    bytes: &[u8],
    file: &Path,
    folder: Option<&Path>,
    clip: Option<&ClipTime>,
) -> Result<TriangleMesh, MeshError> {
    let mut texture_budget = MAX_TEXTURE_BYTES;
    parse_within(bytes, file, &Reader::new(folder), &mut texture_budget, (clip, SharedTextures::new()))
}

/// Like [`parse_posed`], with a given reader, and textures of the same file that were decoded before. `texture_budget`
/// is the number of bytes left for decoded textures.
pub(super) fn parse_within(
    bytes: &[u8],
    file: &Path,
    reader: &Reader<'_>,
    texture_budget: &mut u64,
    (clip, shared): (Option<&ClipTime>, SharedTextures),
) -> Result<TriangleMesh, MeshError> {
    let read = || {
        if bytes.len() as u64 > MAX_FILE_BYTES {
            return Err(LoadRefusal::at("", format!("has more than {MAX_FILE_BYTES} bytes")));
        }
        let document = read_document(bytes)?;
        let buffers = read_buffers(&document, reader)?;
        let source = Source { root: &document.root, buffers: &buffers, entries_read: Cell::new(0) };
        write_out(&source, Surfaces::new(&source, reader, texture_budget, shared), clip)
    };
    // No input is known to cause a panic, but the image decoders and this code read untrusted files.
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(LoadRefusal::at("", "is broken in a way that cannot be named")))
        .map_err(|refusal| refusal.of(file))
}

fn read_buffers<'a>(document: &GltfDocument<'a>, reader: &Reader<'_>) -> Result<Vec<Cow<'a, [u8]>>, LoadRefusal> {
    let mut total = 0;
    let mut buffers = Vec::with_capacity(document.root.buffers.len());
    for (i, buffer) in document.root.buffers.iter().enumerate() {
        let place = format!("buffers[{i}]");
        let bytes = match (&buffer.uri, document.binary_chunk) {
            (Some(uri), _) => reader.uri(uri).map(Cow::Owned),
            (None, Some(chunk)) if i == 0 => Ok(Cow::Borrowed(chunk)),
            (None, _) => Err("has no data".to_owned()),
        };
        let mut bytes = bytes.map_err(|reason| LoadRefusal::at(format!("{place}.uri"), reason))?;
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let reason = format!("says {} bytes, but has {}", buffer.byte_length.0, bytes.len());
            return Err(LoadRefusal::at(format!("{place}.byteLength"), reason));
        }
        // Bytes behind the stated length are padding; ignore them.
        match &mut bytes {
            Cow::Owned(bytes) => bytes.truncate(buffer.byte_length.0 as usize),
            Cow::Borrowed(bytes) => *bytes = &bytes[..buffer.byte_length.0 as usize],
        }
        total += bytes.len() as u64;
        if total > MAX_BUFFER_BYTES {
            return Err(LoadRefusal::at(place, format!("makes the buffers larger than {MAX_BUFFER_BYTES} bytes")));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

fn write_out<'a>(
    source: &'a Source<'a>,
    surfaces: Surfaces<'a>,
    clip: Option<&ClipTime>,
) -> Result<TriangleMesh, LoadRefusal> {
    let root = source.root;
    let mut remarks = Remarks::of(root);
    let poses = clip.map_or(Ok(Poses::new()), |clip| poses(source, clip, &mut remarks))?;
    let forest = walk(root, &poses)?;
    let mut writer = Writer::new(source, surfaces, remarks);
    for &index in &forest.shown {
        let node = &root.nodes[index];
        let Some((number, mesh)) = node.mesh.and_then(|mesh| Some((mesh.0, root.meshes.get(mesh.index())?))) else {
            continue;
        };
        let pose = Pose::of(source, &forest.world_from_node, index)?;
        let weights = poses.get(&index).and_then(|pose| pose.weights.as_deref());
        let weights = weights.unwrap_or_else(|| morph_weights(root, node));
        writer.add(mesh, &pose, weights, &format!("meshes[{number}]"))?;
    }
    let mesh = writer.finish();
    if mesh.indices.is_empty() { Err(LoadRefusal::at("", "shows no triangles")) } else { Ok(mesh) }
}
