//! How much of a picture may be wrong, by circumstance.

/// How much of a picture may be wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowed {
    /// Fraction of the pixels that may be wrong.
    pub wrong: f64,
    /// Largest 99th percentile of the depth error, in pixel footprints.
    pub depth: f64,
    /// Number of pixels that other methods may show differently.
    pub differ: usize,
}

impl Allowed {
    /// For any picture. In such small pictures a hundredth of the pixels lie along outlines, where rays graze and a
    /// thousandth of a footprint across the surface is many times that along the ray.
    pub const USUAL: Self = Self { wrong: 0.003, depth: 0.3, differ: 0 };
    /// For cells 1e4 away in each direction: 32-bit numbers are 2 mm apart there, a tenth of a footprint and many times
    /// that along grazing rays. Methods round differently.
    pub const FAR_CELL: Self = Self { wrong: 0.02, depth: 4.0, differ: 2 };
    /// For content elongated to 1e6 m: a sliver 3e-5 footprints wide. Whether a pixel shows it depends on where the
    /// steps of a method end.
    pub const SLIVER: Self = Self { differ: 1, ..Self::USUAL };
    /// For the Kleinian set: its dust is finer than rounding, and methods round differently.
    pub const DUST: Self = Self { differ: 3, ..Self::USUAL };
}
