//! How a component is evaluated on the GPU: the source of the passes for one way or another.
//!
//! An [`Evaluator`] is either the interpreter, which walks any component, or straight-line code for the
//! [`Structure`] of one. Both call the same functions of `shaders/sdf/`.

mod source;
mod specialise;
mod structure;

pub use source::{FILES, Features, ShaderError, plain_source, source};
pub use structure::{MAX_KERNEL_ROWS, Structure};

/// A way to evaluate components; decides the source of the kernels.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Evaluator {
    /// Walks the subtree-extent array.
    Interpreted(Features),
    /// Straight-line code for every component of this structure.
    Specialised(Structure),
}

/// What the kernels do beside drawing, and what they may assume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Options {
    /// Count steps and evaluations.
    pub counting: bool,
    /// Branches around groups that are out of reach; pays where a branch not taken costs nothing.
    pub skipping: bool,
}
