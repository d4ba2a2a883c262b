//! What a mesh file may ask for. Checked before anything is allocated.

/// Largest file read: the glTF itself, each buffer, each image; in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// All buffers of one glTF together, in bytes.
pub const MAX_BUFFER_BYTES: u64 = 512 << 20;
/// Longest side of an image, in pixels.
pub const MAX_IMAGE_SIDE: u32 = 16_384;
/// All decoded textures of one glTF together, in bytes.
pub const MAX_TEXTURE_BYTES: u64 = 1 << 30;
/// Most nodes in the forest.
pub const MAX_NODES: usize = 100_000;
/// Most vertices after every instance of every mesh is written out.
pub const MAX_VERTICES: usize = 8 << 20;
/// Most triangles after every instance of every mesh is written out.
pub const MAX_TRIANGLES: usize = 8 << 20;
/// Most entries that one accessor may have.
pub const MAX_ACCESSOR_COUNT: usize = MAX_TRIANGLES * 3;
/// Most entries read from all accessors together; a file may name the same bytes many times over.
pub const MAX_ENTRIES_READ: u64 = 4 * (MAX_ACCESSOR_COUNT as u64);
/// Farthest a coordinate may lie from the origin, in metres.
pub const MAX_COORDINATE: f64 = 1e9;
