//! The ways to evaluate components.

use super::op_set::OpSet;
use super::structure::Structure;

/// A way to evaluate components; decides the source of the pipelines.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Evaluator {
    /// Walks the subtree-extent array.
    Interpreter(OpSet),
    /// Walks, in each cell of space, the tape of what can matter there.
    Tape(OpSet),
    /// Straight-line code for every component of this structure, or of this template.
    StraightLine(Structure),
    /// Straight-line code for one component, with its numbers (bits of f32) written into it: what the benches
    /// compare with. Every changed value would compile another one.
    Baked(Structure, Vec<[u32; 4]>),
}

impl Evaluator {
    /// Whether it is straight-line code; otherwise it walks, by loops that end where no invocation is in them.
    pub(super) fn is_straight(&self) -> bool {
        matches!(self, Self::StraightLine(_) | Self::Baked(..))
    }

    /// What its interpreter's parts must be able to evaluate.
    pub(super) fn op_set(&self) -> OpSet {
        match self {
            Self::Interpreter(ops) | Self::Tape(ops) => ops.clone(),
            Self::StraightLine(structure) | Self::Baked(structure, _) => structure.op_set(),
        }
    }
}
