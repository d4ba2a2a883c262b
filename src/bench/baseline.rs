//! The methods of drawing a picture that are compared.

use std::str::FromStr;

use crate::render::EvalStrategy;
use crate::wgsl::{Options, SkipMode};

/// A method of drawing a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Baseline {
    /// Every node at every step of every ray, each from sphere to sphere, as the thesis "Ray Marching Scene Creator" (Basov
    /// 2024) does.
    Thesis,
    /// The whole scene as one generated pipeline with its numbers written into it, as a person would write it.
    Baked,
    /// Components by the interpreter.
    Interpreter,
    /// Components by tapes.
    Tape,
    /// Components by pipelines of their own.
    StraightLine,
    /// No way to draw, but what one could come to that found each surface by a single evaluation: each ray starts at its
    /// true depth, the field is evaluated once to confirm it, and once for normal and material; by whichever of
    /// interpreter, tapes and pipelines takes the least time. What evaluates fields by other means may take less.
    Limit,
    /// What the editor does once its pipelines are ready.
    Auto,
}

impl Baseline {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Thesis, Self::Baked, Self::Interpreter, Self::Tape, Self::StraightLine, Self::Limit, Self::Auto];

    /// Its name, as the command line and reports write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Baked => "baked",
            Self::Interpreter => "interpreter",
            Self::Tape => "tape",
            Self::StraightLine => "straight-line",
            Self::Limit => "limit",
            Self::Auto => "auto",
        }
    }

    /// Whether earlier versions used this name for it; scripts may still do.
    fn was_called(self, name: &str) -> bool {
        match self {
            Self::Baked => name == "generated",
            Self::Interpreter => name == "interpreted",
            Self::Tape => name == "pruned",
            // In both spellings.
            Self::StraightLine => name.strip_prefix("speciali").is_some_and(|rest| ["sed", "zed"].contains(&rest)),
            Self::Thesis | Self::Limit | Self::Auto => false,
        }
    }

    /// Whether the scene is one component.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Self::Thesis | Self::Baked)
    }

    /// How its components are evaluated; of several the quickest counts.
    pub(super) fn strategies(self) -> &'static [EvalStrategy] {
        match self {
            Self::Thesis | Self::Interpreter => &[EvalStrategy::Interpreter],
            Self::Baked => &[EvalStrategy::Baked],
            Self::Tape => &[EvalStrategy::Tape],
            Self::StraightLine => &[EvalStrategy::StraightLine],
            Self::Limit => &[EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine],
            Self::Auto => &[EvalStrategy::Auto],
        }
    }

    /// What its pipelines do, from what they do by default.
    pub(super) fn options(self, options: Options) -> Options {
        let relaxed = self != Self::Thesis;
        if self.is_whole() { Options { skip_mode: SkipMode::Never, cones: false, relaxed, ..options } } else { options }
    }
}

impl FromStr for Baseline {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL
            .into_iter()
            .find(|baseline| baseline.name() == name || baseline.was_called(name))
            .ok_or_else(|| format!("{name} is none of {}", names()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_earlier_versions_are_still_understood() {
        let former =
            ["generated", "interpreted", "pruned", &["speciali", "sed"].concat(), &["speciali", "zed"].concat()];
        let found = former.map(|name| name.parse::<Baseline>().map(Baseline::name));
        let expected =
            ["baked", "interpreter", "tape", "straight-line", "straight-line"].map(|name| Ok(name.to_owned()));
        assert_eq!(found.map(|name| name.map(str::to_owned)), expected);
        for baseline in Baseline::ALL {
            assert_eq!(baseline.name().parse(), Ok(baseline));
        }
        assert!("speciali".parse::<Baseline>().is_err());
    }

    #[test]
    fn the_limit_is_that_of_whichever_pipelines_are_quickest() {
        // Auto chooses among these, and a bad choice must show.
        for baseline in [Baseline::Interpreter, Baseline::Tape, Baseline::StraightLine] {
            assert!(
                baseline.strategies().iter().all(|strategy| Baseline::Limit.strategies().contains(strategy)),
                "{baseline:?}"
            );
        }
        assert!(Baseline::ALL.into_iter().all(|baseline| !baseline.strategies().is_empty()));
    }
}
