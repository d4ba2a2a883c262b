//! Ranges of rays.

/// The range of hits on a ray, as distances from its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayLimits {
    /// Start of the range; a solid here is hit here.
    pub near: f64,
    /// End of the range.
    pub far: f64,
}
