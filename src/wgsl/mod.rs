//! The WGSL that evaluates components on the GPU: the source of the passes for each evaluator.
//!
//! An [`Evaluator`] is an interpreter, which evaluates any component, or straight-line code for the [`Structure`] of
//! one. Both call the same functions of `shaders/sdf/`.
//!
//! | file | contents |
//! |---|---|
//! | `files` | the files of `shaders/`, and their includes |
//! | `op_set`, `structure` | the properties of a scene, and of a component, that determine the source |
//! | `options`, `evaluator` | options of the pipelines, and the evaluators |
//! | `params` | the structs of parameters, and their reading |
//! | `calls`, `modifiers` | calls of the functions of shapes and modifiers |
//! | `dual`, `gradients` | these functions with their derivatives |
//! | `lookahead`, `material_weights`, `specialize` | straight-line code |
//! | `assemble` | the whole source of a pass |
//! | `leaf_cost` | whether tapes are faster than straight-line code |

mod assemble;
mod calls;
mod disk;
mod dual;
mod evaluator;
mod files;
mod gradients;
mod leaf_cost;
mod lookahead;
mod material_weights;
mod modifiers;
mod op_set;
mod options;
mod params;
#[cfg(test)]
mod random;
mod specialize;
mod structure;

pub use assemble::{SCENE_COPIES, assemble, assemble_featured, assemble_plain, assemble_with};
pub use evaluator::Evaluator;
pub use files::{FILES, ShaderError};
pub use leaf_cost::tapes_are_cheaper;
pub use op_set::{Extended, OpSet, fits_templates, shape_loops};
pub use options::{Options, Quality, SkipMode, Veil};
pub use structure::{MAX_PIPELINE_ROWS, ShapeSet, Structure, template_rows};
