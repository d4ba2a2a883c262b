//! The evaluators of components.

use super::op_set::OpSet;
use super::structure::Structure;

/// An evaluator of components, which determines the source of the pipelines.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Evaluator {
    /// Loops over the subtree-extent array.
    Interpreter(OpSet),
    /// Loops over the tape of each cell of space.
    Tape(OpSet),
    /// Straight-line code for every component of this structure, or of this template.
    StraightLine(Structure),
    /// Straight-line code for one component, with its parameters as constants (bits of f32): the baseline of the
    /// benches. Every changed value would need another compilation.
    Baked(Structure, Vec<[u32; 4]>),
}

impl Evaluator {
    /// Whether it is straight-line code. The others loop over entries, and a loop ends when no invocation is left in
    /// it.
    pub(super) fn is_straight(&self) -> bool {
        matches!(self, Self::StraightLine(_) | Self::Baked(..))
    }

    /// The operations that the interpreter's parts of the source must support.
    pub(super) fn op_set(&self) -> OpSet {
        match self {
            Self::Interpreter(ops) | Self::Tape(ops) => ops.clone(),
            Self::StraightLine(structure) | Self::Baked(structure, _) => structure.op_set(),
        }
    }
}
