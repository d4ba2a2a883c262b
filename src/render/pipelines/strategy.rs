//! How the renderer chooses evaluators.

/// Strategy for the evaluation of components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EvalStrategy {
    /// Specialized pipelines for components that are small enough, tapes for the rest. Workers build both in the
    /// background, and the interpreter draws until they are ready.
    #[default]
    Auto,
    /// The interpreter for all components.
    Interpreter,
    /// Tapes for components that have them, the interpreter for the rest. Waits until the tapes are ready.
    Tape,
    /// Specialized pipelines for all components that are small enough. Waits until they are built.
    StraightLine,
    /// A pipeline for each component, of any size, with its parameters as constants: the baseline of the benches.
    Baked,
}
