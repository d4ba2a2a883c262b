//! The ways to draw a picture that are compared.

use std::str::FromStr;

use crate::render::Method;
use crate::render::kernel::{Options, Skipping};

/// A way to draw a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Way {
    /// Every node at every step of every ray, each from sphere to sphere, as the thesis "Ray Marching Scene Creator" (Basov
    /// 2024) does.
    Thesis,
    /// The whole scene as one generated kernel with its numbers written into it, as a person would write it.
    Generated,
    /// Components by the interpreter.
    Interpreted,
    /// Components by pruned lists.
    Pruned,
    /// Components by kernels of their own.
    Specialised,
    /// No way to draw, but what one could come to that found each surface by a single evaluation: each ray starts at its
    /// true depth, the field is evaluated once to confirm it, and once for normal and material; by whichever of
    /// interpreter, pruned lists and kernels takes the least time. What evaluates fields by other means may take less.
    Limit,
    /// What the editor does once its kernels are ready.
    Auto,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Thesis, Self::Generated, Self::Interpreted, Self::Pruned, Self::Specialised, Self::Limit, Self::Auto];

    /// Its name, as the command line and reports write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Generated => "generated",
            Self::Interpreted => "interpreted",
            Self::Pruned => "pruned",
            Self::Specialised => "specialised",
            Self::Limit => "limit",
            Self::Auto => "auto",
        }
    }

    /// Whether the scene is one component.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Self::Thesis | Self::Generated)
    }

    /// How its components are evaluated; of several the quickest counts.
    pub(super) fn methods(self) -> &'static [Method] {
        match self {
            Self::Thesis | Self::Interpreted => &[Method::Interpreted],
            Self::Generated => &[Method::Generated],
            Self::Pruned => &[Method::Pruned],
            Self::Specialised => &[Method::Specialised],
            Self::Limit => &[Method::Interpreted, Method::Pruned, Method::Specialised],
            Self::Auto => &[Method::Auto],
        }
    }

    /// What its kernels do, from what they do by default.
    pub(super) fn options(self, options: Options) -> Options {
        let relaxed = self != Self::Thesis;
        if self.is_whole() { Options { skipping: Skipping::Never, cones: false, relaxed, ..options } } else { options }
    }
}

impl FromStr for Way {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|way| way.name() == name).ok_or_else(|| format!("{name} is none of {}", names()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_that_of_whichever_kernels_are_quickest() {
        // Auto chooses among these, and a bad choice must show.
        for way in [Way::Interpreted, Way::Pruned, Way::Specialised] {
            assert!(way.methods().iter().all(|method| Way::Limit.methods().contains(method)), "{way:?}");
        }
        assert!(Way::ALL.into_iter().all(|way| !way.methods().is_empty()));
    }
}
