//! How far the rays of a frame have got that have not ended as planned.

/// How the rays of a frame go on that have not ended as planned.
#[derive(Clone, Debug, Default)]
pub struct GoingOn {
    /// How many of [`crate::frame::plan::LONGER`] were tried.
    pub times: usize,
    /// Pieces of the plan before any ray went on.
    pub planned: Option<usize>,
    /// Rays without an end by component, as far as that was asked.
    pub unfinished: Option<Vec<u32>>,
}
