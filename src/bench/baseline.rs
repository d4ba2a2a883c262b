//! The methods of drawing a picture that `isolith bench` compares.

use std::str::FromStr;

use crate::render::EvalStrategy;
use crate::wgsl::{Options, SkipMode};

/// A method of drawing a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Baseline {
    /// Sphere tracing that evaluates every node at every step of every ray, as in the thesis "Ray Marching Scene
    /// Creator" (Basov 2024).
    Thesis,
    /// The whole scene as one generated pipeline with its parameters as constants, as a person would write it.
    Baked,
    /// Each component by the interpreter.
    Interpreter,
    /// Each component by its tapes.
    Tape,
    /// Each component by a pipeline with straight-line code.
    StraightLine,
    /// A lower bound instead of a usable method: the cost of finding each surface by a single evaluation. Each ray
    /// starts at its true depth; one evaluation confirms it and one more gives normal and material. Uses the fastest of
    /// interpreter, tapes and straight-line code. Other kinds of evaluators may take less.
    Limit,
    /// The choice of the editor once its pipelines are ready.
    Auto,
}

impl Baseline {
    /// All methods.
    pub const ALL: [Self; 7] =
        [Self::Thesis, Self::Baked, Self::Interpreter, Self::Tape, Self::StraightLine, Self::Limit, Self::Auto];

    /// The name of the method on the command line and in reports.
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

    /// Whether earlier versions used this name for the method; scripts may still use it.
    fn was_called(self, name: &str) -> bool {
        match self {
            Self::Baked => name == "generated",
            Self::Interpreter => name == "interpreted",
            Self::Tape => name == "pruned",
            // British and American spelling.
            Self::StraightLine => name.strip_prefix("speciali").is_some_and(|rest| ["sed", "zed"].contains(&rest)),
            Self::Thesis | Self::Limit | Self::Auto => false,
        }
    }

    /// Whether the method draws the whole scene as one component.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Self::Thesis | Self::Baked)
    }

    /// The evaluation strategies of the method; of several, the fastest counts.
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

    /// The evaluation strategy of a method that chooses one and changes nothing else.
    pub fn strategy(self) -> Option<EvalStrategy> {
        match self {
            Self::Thesis | Self::Limit => None,
            _ => self.strategies().first().copied(),
        }
    }

    /// The options of its pipelines, derived from the default `options`.
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
        // Auto chooses among these strategies, and a bad choice must show.
        for baseline in [Baseline::Interpreter, Baseline::Tape, Baseline::StraightLine] {
            assert!(
                baseline.strategies().iter().all(|strategy| Baseline::Limit.strategies().contains(strategy)),
                "{baseline:?}"
            );
        }
        assert!(Baseline::ALL.into_iter().all(|baseline| !baseline.strategies().is_empty()));
    }
}
