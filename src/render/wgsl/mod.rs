//! How a component is evaluated on the GPU: the source of the passes for one way or another.
//!
//! An [`Evaluator`] is either the interpreter, which walks any component, or straight-line code for the
//! [`Structure`] of one. Both call the same functions of `shaders/sdf/`.

mod assemble;
mod dual;
mod gradients;
mod leaf_cost;
mod lookahead;
mod material_weights;
mod modifiers;
#[cfg(test)]
mod random;
mod specialize;
mod structure;

pub use assemble::{Extended, FILES, OpSet, ShaderError, assemble, assemble_plain, fits_templates, shape_loops};
pub use leaf_cost::tapes_are_cheaper;
pub use structure::{MAX_PIPELINE_ROWS, ShapeSet, Structure, template_rows};

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
    fn is_straight(&self) -> bool {
        matches!(self, Self::StraightLine(_) | Self::Baked(..))
    }

    /// What its interpreter's parts must be able to evaluate.
    fn op_set(&self) -> OpSet {
        match self {
            Self::Interpreter(ops) | Self::Tape(ops) => ops.clone(),
            Self::StraightLine(structure) | Self::Baked(structure, _) => structure.op_set(),
        }
    }
}

/// How code leaves out what cannot matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SkipMode {
    /// By `if`: free where a branch that no lane takes is not executed.
    #[default]
    Branches,
    /// Not within straight-line code, where all is computed and chosen from: lavapipe executes the body of every `if`
    /// and the first iteration of every loop, and what is read as uniform within either costs 25 times as much.
    Selects,
    /// Not at all: every node at every step, as the benches' baselines do it.
    Never,
}

/// How near a march comes to the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// A tenth of a pixel's footprint.
    Draft,
    /// A thousandth.
    #[default]
    Default,
    /// A hundred thousandth.
    Fine,
}

impl Quality {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Default, Self::Fine];

    /// Its name, as reports write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Default => "default",
            Self::Fine => "fine",
        }
    }

    /// Tolerances of the march relative to the default's.
    fn fineness(self) -> f32 {
        match self {
            Self::Draft => 100.0,
            Self::Default => 1.0,
            Self::Fine => 0.01,
        }
    }
}

/// What the pipelines do beside drawing, and what they may assume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// Count steps and evaluations.
    pub counting: bool,
    /// How pipelines leave out what is out of reach.
    pub skip_mode: SkipMode,
    /// Whether cones around tiles go before the rays.
    pub cones: bool,
    /// Whether rays take longer steps than from sphere to sphere, where they expect that nothing is there.
    pub relaxed: bool,
    /// How near a march comes to the surface.
    pub quality: Quality,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            counting: false,
            skip_mode: SkipMode::default(),
            cones: true,
            relaxed: true,
            quality: Quality::default(),
        }
    }
}
