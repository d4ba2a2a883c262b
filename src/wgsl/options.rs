//! What the pipelines do, and how near they come to the surface.

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
    pub(super) fn fineness(self) -> f32 {
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
