//! The JSON of a glTF file: taken out of its container, parsed, its references checked.

use std::panic::{AssertUnwindSafe, catch_unwind};

use gltf::json::{self, Root, mesh::Semantic, validation::Checked};

use super::error::Refusal;

/// A checked document and the binary chunk of its container.
///
/// Invariant: every index that the document holds is in range, so `root.get(index)` finds something.
pub(super) struct Document<'a> {
    pub root: Root,
    pub binary_chunk: Option<&'a [u8]>,
}

/// Parses a .gltf or .glb file.
pub(super) fn read_document(bytes: &[u8]) -> Result<Document<'_>, Refusal> {
    let (text, binary_chunk) = if bytes.starts_with(MAGIC) { split_container(bytes)? } else { (bytes, None) };
    // The crate has panicked on broken files; the checks here leave no known way, this is the net.
    let root = catch_unwind(AssertUnwindSafe(|| parse(text)))
        .unwrap_or_else(|_| Err(Refusal::at("", "is broken in a way that the glTF reader cannot name")))?;
    Ok(Document { root, binary_chunk })
}

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The JSON chunk and the binary chunk of a container (glTF 2.0 specification, section 4.4).
fn split_container(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Refusal> {
    let refuse = |reason: String| Refusal::at("container", reason);
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
        word.ok_or_else(|| refuse("ends within a header".into()))
    };
    let version = word(4)?;
    if version != 2 {
        return Err(refuse(format!("has version {version}, not 2")));
    }
    let length = word(8)? as usize;
    if length > bytes.len() || length < HEADER_BYTES {
        return Err(refuse(format!("says {length} bytes, but has {}", bytes.len())));
    }
    let mut at = HEADER_BYTES;
    let (mut text, mut binary) = (None, None);
    while at < length {
        let (size, kind) = (word(at)? as usize, word(at + 4)?.to_le_bytes());
        let start = at + CHUNK_HEADER_BYTES;
        let chunk = start.checked_add(size).filter(|end| *end <= length).and_then(|end| bytes.get(start..end));
        let chunk = chunk.ok_or_else(|| refuse(format!("has a chunk of {size} bytes that does not fit")))?;
        match (&kind, text, binary) {
            (b"JSON", None, None) => text = Some(chunk),
            (_, None, _) => return Err(refuse("does not begin with a JSON chunk".into())),
            (b"BIN\0", Some(_), None) => binary = Some(chunk),
            // Other chunks belong to extensions, and are to be ignored.
            _ => {}
        }
        at = start + size.next_multiple_of(4);
    }
    Ok((text.ok_or_else(|| refuse("has no JSON chunk".into()))?, binary))
}

fn parse(text: &[u8]) -> Result<Root, Refusal> {
    let mut root: Root =
        json::deserialize::from_slice(text).map_err(|e| Refusal::at("", format!("is not glTF JSON: {e}")))?;
    // Integers in attributes are read as they are, which is all that this extension asks for.
    root.extensions_required.retain(|name| name != "KHR_mesh_quantization");
    // The crate's own validation indexes the accessors by these without a look.
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{m}].primitives[{p}].attributes.POSITION");
            match primitive.attributes.get(&Checked::Valid(Semantic::Positions)) {
                None => return Err(Refusal::at(place, "is missing")),
                Some(index) if index.value() >= root.accessors.len() => {
                    return Err(Refusal::at(place, format!("names accessor {}, which is missing", index.value())));
                }
                Some(_) => {}
            }
        }
    }
    match gltf::Document::from_json(root) {
        Ok(document) => Ok(document.into_json()),
        Err(gltf::Error::Validation(faults)) => {
            let (place, fault) = faults.first().map_or_else(
                || (String::new(), "is not valid".into()),
                |(path, fault)| (plain_place(path.as_str()), reason_of(*fault).to_owned()),
            );
            Err(Refusal::at(place, fault))
        }
        Err(other) => Err(Refusal::at("", other.to_string())),
    }
}

/// The crate writes `a.b["c"]` and, for some, appends ` = "value"`: ours is `a.b.c`.
fn plain_place(path: &str) -> String {
    path.split(" = ").next().unwrap_or(path).replace("[\"", ".").replace("\"]", "")
}

fn reason_of(fault: json::validation::Error) -> &'static str {
    use json::validation::Error;
    match fault {
        Error::IndexOutOfBounds => "names something that is missing",
        Error::Invalid => "has a value that glTF does not allow",
        Error::Missing => "lacks data that glTF demands",
        Error::Oversize => "is too large",
        Error::Unsupported => "is an extension that is needed but not supported",
    }
}
