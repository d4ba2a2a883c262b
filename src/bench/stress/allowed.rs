//! How much of a picture may be wrong, by what is difficult about it.

/// How much of a picture may be wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// Share of the pixels that may be wrong.
    pub wrong: f64,
    /// Largest error of the depth at the 99th percentile, in pixel footprints.
    pub depth: f64,
    /// Pixels that other methods may show otherwise.
    pub differ: usize,
}

impl Allowed {
    /// Of any picture. A hundredth of the pixels of such small pictures are those along outlines, where rays graze and a
    /// thousandth of a footprint across the surface is many times that along the ray.
    pub const USUAL: Self = Self { wrong: 0.003, depth: 0.3, differ: 0 };
    /// Of cells 1e4 away in each direction: numbers of 32 bits are 2 mm apart there, a tenth of a footprint, and many
    /// times that along grazing rays. Methods round otherwise.
    pub const FAR_CELL: Self = Self { wrong: 0.02, depth: 4.0, differ: 2 };
    /// Of what is drawn apart to 1e6 m: a sliver 3e-5 footprints wide. It may be shown in a pixel or not, by where
    /// the steps of a method end.
    pub const SLIVER: Self = Self { differ: 1, ..Self::USUAL };
    /// Of the Kleinian set: its dust is finer than rounding, and methods round otherwise.
    pub const DUST: Self = Self { differ: 3, ..Self::USUAL };
}
