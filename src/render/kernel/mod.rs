//! How a component is evaluated on the GPU: the source of the passes for one way or another.
//!
//! An [`Evaluator`] is either the interpreter, which walks any component, or straight-line code for the
//! [`Structure`] of one. Both call the same functions of `shaders/sdf/`.

mod dual;
mod shares;
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

/// How straight-line code leaves out a group or a run that is out of reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Skipping {
    /// By `if`: free where a branch that no lane takes is not executed.
    #[default]
    Branches,
    /// By a loop of at most one round: lavapipe executes the body of every `if`, but ends a loop that no
    /// lane is in.
    Loops,
}

/// What the kernels do beside drawing, and what they may assume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Options {
    /// Count steps and evaluations.
    pub counting: bool,
    /// How specialised kernels leave out what is out of reach.
    pub skipping: Skipping,
}
