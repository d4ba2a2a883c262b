//! The scene at one moment as arrays, exactly as the GPU reads them, and the CPU twin that evaluates
//! the same arrays in f64.
//!
//! | module | what it does |
//! |---|---|
//! | `batch` | small components joined by place |
//! | `body` | shape → the numbers that it is evaluated with |
//! | `budget`, `survey`, `usage` | what flattening may take, counted before it is done |
//! | `collect`, `fold`, `cuts` | scene → folds of operands, one for each component |
//! | `flatten` | scene → [`FlatScene`] |
//! | `modify` | what modifiers do to bounds and steps |
//! | `moved` | the numbers of a component relative to a point near the eye |
//! | `reflatten` | the same after a small change |
//! | `twin` | the field over the arrays, in f64, with exact derivatives: the truth |
//! | `unflattened` | the field of a scene without flattening: a second opinion for tests |
//! | `trace` | rays against the twin, with certainty instead of a step limit |
//! | `shade` | light on surfaces, twin of `shaders/light` |
//! | `truth` | the whole picture by `twin`, `trace` and `shade` |
//! | `pick` | which node a ray hits |
//! | `prune` | which entries of a large component matter where |
//! | `meshes` | the meshes that a scene names, loaded |
//! | `mesh_rays` | rays against them |
//! | `view` | the view of a scene when nobody chose one |
//! | `inspect` | ways to look at a picture other than lit, their colours |
//! | `compare` | how wrong a picture is, against the truth |

mod arrays;
mod batch;
mod body;
mod budget;
mod buffers;
mod collect;
pub mod compare;
mod cuts;
mod emit;
mod enclosure;
mod flatten;
mod fold;
pub mod inspect;
mod joints;
mod leaf;
pub mod mesh_rays;
mod meshes;
mod modify;
mod moved;
mod operands;
pub mod pick;
mod prune;
mod reflatten;
pub mod shade;
mod stack;
mod survey;
pub mod trace;
pub mod truth;
pub mod twin;
pub mod unflattened;
mod usage;
pub mod view;

pub use arrays::*;
pub use body::Body;
pub use budget::{Cancel, Usage};
pub use buffers::*;
pub use compare::Accuracy;
pub use flatten::{FlattenError, flatten, flatten_until, flatten_whole};
pub use modify::{MAX_NEIGHBOURS, REPEAT_REACH, is_copying};
pub use moved::move_rows;
pub use prune::*;
pub use reflatten::Flattener;
pub use shade::{GpuLight, gpu_lights};
pub use survey::is_quick;
