//! Triangles: glTF files as one indexed mesh, ready for upload, with a ray query.
//!
//! ```text
//! .gltf / .glb ──► resolve (files, data URIs) ──► document (JSON, checked) ──► forest (placement of nodes)
//!              ──► clip (what an animation moves) ──► primitive (accessors, poses, surfaces) ──► TriangleMesh ──► bvh (on the first ray)
//! ```
//!
//! Files are untrusted. Every number is checked before it sizes a read or an allocation, all of it runs behind
//! `catch_unwind`, and nothing outside the file's own folder is opened. A refusal names the file, the place in the
//! file, and the reason. `remarks` lists the contents of a file that are not drawn.

mod accessor;
mod bvh;
mod clip;
mod clip_schema;
mod document;
mod error;
mod forest;
mod library;
pub mod limits;
mod load;
mod material_schema;
mod model_pose;
mod node_pose;
mod pose;
mod primitive;
mod references;
mod remarks;
mod resolve;
mod schema;
mod surface;
mod texture;
mod triangle_mesh;
mod voxels;
mod watch;
mod whole;

pub use bvh::{Bvh, BvhNode};
pub use clip::ClipInfo;
pub use error::MeshError;
pub use library::{MeshLibrary, MeshResult, MeshSource, ReloadOutcome, Reread, model_files};
pub use load::{load, parse, parse_posed};
pub use model_pose::{ClipTime, ModelPose};
pub use resolve::ModelFileTable;
pub use surface::{Surface, TextureUse};
pub use texture::{Sampler, Texture, Wrap};
pub use triangle_mesh::{MeshHit, MeshLook, MeshPart, TriangleMesh};
pub use voxels::{Voxelized, bricks_key, bricks_of, maker_key, usual_resolution, voxel_for, voxelized};
pub use watch::Watcher;
