//! What one evaluation of a component takes, by how it is evaluated: dispatches are cut by it.

use isolith_field::{CellTree, Component};

/// What evaluating a component means for its pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvaluationCost {
    /// Whether the pipeline is straight-line code.
    pub straight: bool,
    /// Most loop iterations of one evaluation.
    pub iterations: u32,
    /// Leaves that one evaluation visits, about.
    pub leaves: f64,
}

/// Loop iterations for each copy of an entry, about: a modifier's own loops (layers of noise, steps of a recursion).
const LOOPS_OF_COPIES: u32 = 2;

impl EvaluationCost {
    /// Of a component that is walked through, entry by entry, by code that holds `loops` besides; `loop_trips` is
    /// how many its own leaves take.
    pub fn of_entries(component: &Component, loops: u32, loop_trips: u32) -> Self {
        // For each entry an iteration, one for the choice of its shape, one for a group that ends. Of copies most are
        // out of reach.
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: false,
            iterations: ((4 + loops) * component.count + loop_trips + 2).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of straight-line code for a component: loops are only in modifiers, at most one for each entry, and in leaves;
    /// `loop_trips` as in [`EvaluationCost::of_entries`].
    pub fn of_straight_line(component: &Component, loop_trips: u32) -> Self {
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: true,
            iterations: (2 + component.count + loop_trips).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Of a component with tapes.
    pub fn of_tapes(component: &Component, tree: &CellTree, loops: u32, loop_trips: u32) -> Self {
        // Two iterations find the cell.
        Self {
            straight: false,
            iterations: (4 + loops) * tree.longest() + loop_trips + 8,
            leaves: tree.mean_length() * leaves(component, loop_trips) / f64::from(component.count) + 2.0,
        }
    }
}

/// Entries of a component, the loops of its leaves counted in: a trip takes a part of what a leaf takes, and most loops
/// end early.
fn leaves(component: &Component, loop_trips: u32) -> f64 {
    f64::from(component.count) + f64::from(loop_trips) * LOOP_TRIP
}

/// Leaves that a loop trip counts as. With 0 single batches took 0.55 s in `fractals`, now 0.16; its stills take a tenth longer,
/// with 1 those of `drawn` took a third longer.
const LOOP_TRIP: f64 = 0.25;
