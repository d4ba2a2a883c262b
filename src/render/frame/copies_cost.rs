//! What a ray through the copies of an instancer costs.

use isolith_field::copies::FlatInstancer;
use isolith_scene::DynamicKind;

/// The limits of an invocation that walks through copies, in one dispatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CopyLimits {
    /// Loop iterations for evaluations of fields.
    pub iterations: u32,
    /// Cells or nodes that it looks at.
    pub cells: u32,
}

/// Leaves that the work for a cell counts as, and expected cells of a ray.
const CELL_LEAVES: f64 = 2.0;
const CELLS: f64 = 16.0;

/// Least number of dispatches of a ray: a lattice without end has cells up to the horizon.
pub const LEAST_RELAUNCHES: u32 = 4;

/// Factor on the expected evaluations of a ray, which meets several copies.
pub const COPIES_OF_A_RAY: f64 = 2.0;

impl CopyLimits {
    /// The limits for an instancer, for an invocation of `iterations`: half of them are for cells.
    pub fn of(instancer: &FlatInstancer, iterations: u32) -> Self {
        let of_cell = cell_loops(instancer);
        Self { iterations: iterations / 2, cells: iterations / 2 / of_cell }
    }
}

/// Upper bound of the loop iterations for a cell of an instancer, or for a node of its tree.
pub fn cell_loops(instancer: &FlatInstancer) -> u32 {
    let of_dynamic = |kind: DynamicKind| match kind {
        DynamicKind::CurlNoise => 9,
        DynamicKind::RandomWalk => 5,
        // Layers, each along three axes.
        DynamicKind::FractionalBrownianMotion => 40,
        _ => 1,
    };
    let dynamics: u32 = instancer.dynamics.iter().map(|dynamic| of_dynamic(dynamic.kind)).sum();
    3 + (instancer.masks.len() + instancer.shares.len()) as u32 + dynamics
}

/// Expected cost of the walk of a ray, in leaves.
pub fn walk_leaves(instancer: &FlatInstancer) -> f64 {
    CELLS * CELL_LEAVES * (1 + instancer.dynamics.len() + instancer.masks.len()) as f64
}
