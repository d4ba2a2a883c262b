//! The choice of how components are evaluated.

/// How components are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EvalStrategy {
    /// Specialized pipelines for what is not too large for one, tapes for the rest; both are made in the
    /// background, and the interpreter draws until they are ready.
    #[default]
    Auto,
    /// The interpreter for everything.
    Interpreter,
    /// Tapes where a component has them, the interpreter for the rest; waits until they are made.
    Tape,
    /// Specialized pipelines for everything that is not too large for one; waits until they are built.
    StraightLine,
    /// A pipeline for each component with its numbers written into it, however large: what the benches compare with.
    Baked,
}
