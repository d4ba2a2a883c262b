//! The JSON of a glTF file: extracted from its container, parsed, its references checked.

use super::error::{LoadRefusal, name};
use super::limits::{MAX_JSON_COMMAS, MAX_JSON_OBJECTS};
use super::references::check_references;
use super::schema::{Asset, Root, Versioned};

/// A checked document and the binary chunk of its container.
///
/// Invariant: every index that the document holds is in range.
pub(super) struct GltfDocument<'a> {
    pub root: Root,
    pub binary_chunk: Option<&'a [u8]>,
}

/// Supported extensions. Files that require another one are refused.
pub(super) const SUPPORTED: &[&str] = &[
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Parses a .gltf or .glb file.
pub(super) fn read_document(bytes: &[u8]) -> Result<GltfDocument<'_>, LoadRefusal> {
    let (text, binary_chunk) = if bytes.starts_with(MAGIC) { split_container(bytes)? } else { (bytes, None) };
    Ok(GltfDocument { root: parse(text)?, binary_chunk })
}

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The JSON chunk and the binary chunk of a container (glTF 2.0 specification, section 4.4).
fn split_container(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), LoadRefusal> {
    let refuse = |reason: String| LoadRefusal::at("container", reason);
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
            // Other chunks belong to extensions; the specification says to ignore them.
            _ => {}
        }
        at = start + size.next_multiple_of(4);
    }
    Ok((text.ok_or_else(|| refuse("has no JSON chunk".into()))?, binary))
}

fn parse(text: &[u8]) -> Result<Root, LoadRefusal> {
    // Byte order marks are not allowed, but some editors write them.
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    check_amount(text)?;
    let versioned: Versioned =
        serde_json::from_slice(text).map_err(|e| LoadRefusal::at("", format!("is not glTF JSON: {e}")))?;
    check_version(versioned.asset.as_ref())?;
    let mut json = serde_json::Deserializer::from_slice(text);
    let root: Root = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let place = error.path().to_string();
        LoadRefusal::at(
            if place == "." { String::new() } else { place },
            format!("is not glTF JSON: {}", error.inner()),
        )
    })?;
    for (i, extension) in root.extensions_required.iter().enumerate() {
        if !SUPPORTED.contains(&extension.as_str()) {
            let reason = format!("the file needs {}, which is not supported", name(extension));
            return Err(LoadRefusal::at(format!("extensionsRequired[{i}]"), reason));
        }
    }
    check_references(&root)?;
    Ok(root)
}

/// Refuses text whose objects would take much more memory than the text. Brackets within strings count too.
fn check_amount(text: &[u8]) -> Result<(), LoadRefusal> {
    let (mut objects, mut commas) = (0, 0);
    for byte in text {
        match byte {
            b'{' | b'[' => objects += 1,
            b',' => commas += 1,
            _ => {}
        }
    }
    if objects > MAX_JSON_OBJECTS {
        return Err(LoadRefusal::at("", format!("holds {objects} objects, more than {MAX_JSON_OBJECTS}")));
    }
    if commas > MAX_JSON_COMMAS {
        return Err(LoadRefusal::at("", format!("holds {commas} values, more than {MAX_JSON_COMMAS}")));
    }
    Ok(())
}

/// Checks the version before anything else is read: files of version 1 have another structure, and would be refused for
/// a wrong reason.
fn check_version(asset: Option<&Asset>) -> Result<(), LoadRefusal> {
    let Some(version) = asset.and_then(|asset| asset.version.as_deref()) else {
        return Err(LoadRefusal::at("", "has no asset.version, so it is no glTF file"));
    };
    let needed = asset.and_then(|asset| asset.min_version.as_deref()).unwrap_or(version);
    if !version.starts_with("2.") {
        return Err(LoadRefusal::at("asset.version", format!("is {}; files of glTF 2 are read", name(version))));
    }
    if !needed.starts_with("2.") || (needed != "2.0" && needed != version) {
        return Err(LoadRefusal::at("asset.minVersion", format!("is {}; files of glTF 2.0 are read", name(needed))));
    }
    Ok(())
}
