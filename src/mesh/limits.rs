//! Limits on mesh files, checked before anything is allocated.

/// Largest file read: the glTF itself, each buffer, each image; in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// All buffers of one glTF together, in bytes.
pub const MAX_BUFFER_BYTES: u64 = 512 << 20;
/// Most objects in the JSON of a glTF. Each takes up to 400 bytes when parsed.
pub const MAX_JSON_OBJECTS: usize = 1 << 20;
/// Most commas in the JSON of a glTF, as an estimate of the numbers in it.
pub const MAX_JSON_COMMAS: usize = 16 << 20;
/// Longest side of an image, in pixels.
pub const MAX_IMAGE_SIDE: u32 = 16_384;
/// All decoded textures of one scene together, in bytes: eight of 4096 × 4096 pixels.
pub const MAX_TEXTURE_BYTES: u64 = 512 << 20;
/// Most memory for decoding one image, besides the result, in bytes.
pub const MAX_DECODER_BYTES: u64 = 512 << 20;
/// Most nodes in the forest.
pub const MAX_NODES: usize = 100_000;
/// Most vertices, with every instance of every mesh written out.
pub const MAX_VERTICES: usize = 8 << 20;
/// Most triangles, with every instance of every mesh written out.
pub const MAX_TRIANGLES: usize = 8 << 20;
/// Most entries that one accessor may have.
pub const MAX_ACCESSOR_COUNT: usize = MAX_TRIANGLES * 3;
/// Most entries read from all accessors together; a file may name the same bytes many times over.
pub const MAX_ENTRIES_READ: u64 = 4 * (MAX_ACCESSOR_COUNT as u64);
/// Most attributes of primitives and of their morph targets, with every instance of every mesh written out.
pub const MAX_ATTRIBUTES: usize = 4 << 20;
/// Most keys of an animated property.
pub const MAX_KEYS: usize = 1 << 20;
/// Most joints of a skin.
pub const MAX_JOINTS: usize = 16_384;
/// Greatest distance of a coordinate from the origin, in meters.
pub const MAX_COORDINATE: f64 = 1e9;
/// Most warnings about one file; the last one counts the omitted ones.
pub const MAX_WARNINGS: usize = 24;
