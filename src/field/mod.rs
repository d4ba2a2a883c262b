//! The scene at one moment as arrays, exactly as the GPU reads them, and the CPU evaluator, which evaluates the same
//! arrays in f64.
//!
//! | module | what it does |
//! |---|---|
//! | `batch` | batches of small neighboring components |
//! | `prepare` | shape → the parameters that evaluators read |
//! | `budget`, `survey`, `usage` | limits of flattening, counted in advance |
//! | `operand`, `composition` | operands of folds, and their composition |
//! | `collect`, `fold`, `cuts` | scene → folds of operands, one for each component |
//! | `flatten` | scene → [`FlatScene`] |
//! | `modifier_reach` | what modifiers read of their content, and how fine their patterns may be |
//! | `modifier_table` | all facts about a kind of modifier, in one row |
//! | `modify` | effects of modifiers on bounds and steps |
//! | `moved` | the parameters of a component relative to a point near the eye |
//! | `reflatten` | flattening after a small change |
//! | `standpoint` | the choice of the point near the eye |
//! | `light` | light and matter: reflection, lights, environment, display; counterpart of `shaders/light/` |
//! | `lights` | lights relative to the eye |
//! | `eval` | the field over the arrays, in f64, with exact derivatives: the reference |
//! | `unflattened` | the field of a scene without flattening: a second opinion for tests |
//! | `reference` | the reference renderer: whole pictures in f64, and the error of other pictures |
//! | `hierarchy`, `scene_eval` | distances and rays to all components at once |
//! | `pick` | which node a ray hits |
//! | `doctor` | looks for nodes whose field breaks its promise, is slow, or does nothing |
//! | `tape` | simplified tapes: the entries of a large component that matter in a cell |
//! | `mixture` | materials of a pixel with their weights; counterpart of `shaders/common/mixture.wgsl` |
//! | `meshes` | the loaded meshes of a scene |
//! | `mesh_rays` | intersections of rays with meshes |
//! | `view` | the default view of a scene |
//! | `shading`, `studio` | the scene under a studio light, also in one material |
//! | `debug_view` | view modes besides shading, and their colors |
//!
//! # Example
//!
//! A sphere is flattened, sampled and traced:
//!
//! ```
//! use glam::DVec3;
//! use isolith_field::reference::trace::trace;
//! use isolith_field::{eval, flatten};
//! use isolith_geometry::Ray;
//! use isolith_scene::{Node, NodeKind, Object, Scene, Shape};
//!
//! let mut scene = Scene::new();
//! let material = scene.materials()[0].id;
//! let shape = Shape::Sphere { radius: 1.0 };
//! scene.insert(None, 0, Node::new("Ball", NodeKind::Object(Object { shape, material })))?;
//! let flat = flatten(&scene, 0.0)?;
//!
//! let ball = &flat.components[0];
//! let (distance, gradient) = eval::gradient(&flat, ball, DVec3::new(3.0, 0.0, 0.0) - ball.origin);
//! assert!((distance - 2.0).abs() < 1e-12 && (gradient - DVec3::X).length() < 1e-12);
//!
//! let ray = Ray { origin: DVec3::Z * 5.0, direction: DVec3::NEG_Z };
//! let hit = trace(&flat, &ray, 0.0, 100.0)?.expect("the ray meets the ball");
//! assert!((hit.t - 4.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrays;
mod batch;
mod blends;
mod budget;
mod collect;
mod composition;
pub mod copies;
pub mod coverage;
mod cuts;
pub mod debug_view;
pub mod doctor;
mod emit;
mod error;
pub mod eval;
mod flat_bricks;
mod flat_material;
mod flat_texture;
mod flatten;
mod fold;
mod gbuffer;
pub mod hierarchy;
mod leaf;
pub mod light;
mod lights;
mod lower_bound;
mod marches;
mod mesh_material;
pub mod mesh_rays;
mod meshes;
pub mod mixture;
pub mod modifier_params;
mod modifier_reach;
mod modifier_table;
mod modify;
mod moved;
mod non_field;
mod operand;
mod passes;
pub mod pick;
mod prepare;
mod ray_limits;
pub mod reference;
mod reflatten;
pub mod scene_eval;
mod shading;
mod stack;
pub mod standpoint;
pub mod studio;
mod survey;
mod tape;
mod texel_words;
mod textures_in_view;
mod types;
pub mod unflattened;
mod usage;
pub mod veil;
pub mod view;

pub use arrays::*;
pub use budget::{Cancel, Usage};
pub use error::FlattenError;
pub use flat_bricks::FlatBricks;
pub use flat_material::FlatMaterial;
pub use flat_texture::*;
pub use flatten::{flatten, flatten_until, flatten_whole};
pub use gbuffer::*;
pub use lights::{GpuLight, gpu_lights};
pub use mesh_material::mesh_material;
pub use meshes::model_pose;
pub use modifier_table::{
    changes_value, is_copying, is_rough, modifier_layout, modifier_payload, modifier_payload_row, modifier_rows,
    moves_point,
};
pub use modify::{MAX_NEIGHBORS, REPEAT_REACH};
pub use moved::move_params;
pub use passes::ComponentPass;
pub use prepare::PreparedShape;
pub use ray_limits::RayLimits;
pub use reference::accuracy::Accuracy;
pub use reflatten::Flattener;
pub use shading::Shading;
pub use survey::is_quick;
pub use tape::*;
pub use texel_words::texel_words;
pub use textures_in_view::gpu_textures;
