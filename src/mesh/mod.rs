//! Triangles: glTF files as one indexed mesh, ready for upload, with a ray query.
//!
//! ```text
//! .gltf / .glb ──► resolve (files, data URIs) ──► document (JSON, checked) ──► forest (who stands where)
//!              ──► primitive (accessors, textures) ──► TriangleMesh ──► bvh (on the first ray)
//! ```
//!
//! Files come from strangers. Every number is checked before anything is read or allocated by it, the
//! crate that parses the JSON runs behind `catch_unwind`, and nothing outside the file's own folder is
//! opened. What is refused is named: file, place in the file, reason.

mod accessor;
mod bvh;
mod document;
mod error;
mod forest;
mod library;
pub mod limits;
mod load;
mod primitive;
mod resolve;
mod texture;
mod triangle_mesh;

pub use bvh::{Bvh, BvhNode};
pub use error::MeshError;
pub use library::MeshLibrary;
pub use load::{load, parse};
pub use triangle_mesh::{MeshHit, Part, Texture, TriangleMesh};
