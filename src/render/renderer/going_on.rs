//! State of the rays that have not ended within the plan.

/// Progress of a frame's rays beyond the plan.
#[derive(Clone, Debug, Default)]
pub struct GoingOn {
    /// Number of factors of [`crate::frame::plan::LONGER`] that were tried.
    pub times: usize,
    /// Number of planned dispatches, before any ray continued.
    pub planned: Option<usize>,
    /// Number of unfinished rays of each component, once it was read back.
    pub unfinished: Option<Vec<u32>>,
}
