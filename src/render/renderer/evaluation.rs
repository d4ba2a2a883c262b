//! Cost of one evaluation of a component with a given evaluator. The plan sizes dispatches by it.

use isolith_field::{CellTree, Component};

/// Cost of one evaluation of a component by its pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvaluationCost {
    /// Whether the pipeline is straight-line code.
    pub straight: bool,
    /// Upper bound of the loop iterations of one evaluation.
    pub iterations: u32,
    /// Approximate number of leaves that one evaluation visits.
    pub leaves: f64,
}

/// Approximate loop iterations for each copy of an entry: a modifier's own loops (layers of noise, recursion steps).
const LOOPS_OF_COPIES: u32 = 2;

impl EvaluationCost {
    /// Cost of a component by the interpreter, entry by entry. `loops`: other loops in the interpreter's code.
    /// `loop_trips`: iterations of the component's own leaves.
    pub fn of_entries(component: &Component, loops: u32, loop_trips: u32) -> Self {
        // Each entry takes an iteration, one for the choice of its shape, and one for a group that ends. Most copies
        // are out of reach.
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: false,
            iterations: ((4 + loops) * component.count + loop_trips + 2).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Cost of straight-line code for a component. Loops occur only in modifiers, at most one for each entry, and in
    /// leaves. `loop_trips` as in [`EvaluationCost::of_entries`].
    pub fn of_straight_line(component: &Component, loop_trips: u32) -> Self {
        let copies = if component.is_modified() { component.copies * LOOPS_OF_COPIES } else { 1 };
        Self {
            straight: true,
            iterations: (2 + component.count + loop_trips).saturating_mul(copies),
            leaves: leaves(component, loop_trips) * f64::from(component.copies).sqrt(),
        }
    }

    /// Cost of a component with tapes.
    pub fn of_tapes(component: &Component, tree: &CellTree, loops: u32, loop_trips: u32) -> Self {
        // Two iterations find the cell.
        Self {
            straight: false,
            iterations: (4 + loops) * tree.longest() + loop_trips + 8,
            leaves: tree.mean_length() * leaves(component, loop_trips) / f64::from(component.count) + 2.0,
        }
    }
}

/// Entries of a component, including the loops of its leaves: an iteration costs a fraction of a leaf, and most loops
/// end early.
fn leaves(component: &Component, loop_trips: u32) -> f64 {
    f64::from(component.count) + f64::from(loop_trips) * LOOP_TRIP
}

/// Leaves that a loop iteration counts as. With 0, single batches took 0.55 s in `fractals`, now 0.16; its stills take
/// a tenth longer. With 1, those of `drawn` took a third longer.
const LOOP_TRIP: f64 = 0.25;
