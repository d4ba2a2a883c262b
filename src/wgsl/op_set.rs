//! The set of shapes, modifiers and operators in a source.

use std::collections::BTreeSet;

use isolith_field::{self as field, FIRST_EXTENDED_KERNEL, FlatNode, FlatScene, Join, MAX_STACK, modifier_rows};
use isolith_scene::{ModifierKind, ShapeKind};

/// The operations that an interpreter supports. They are its cache key, so a changed value never builds a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct OpSet {
    /// Shapes in use.
    pub shapes: BTreeSet<ShapeKind>,
    /// Modifiers in use.
    pub modifiers: BTreeSet<ModifierKind>,
    /// Size of the stack of accumulators: a power of two.
    pub stack: u32,
    /// Operators and blend kernels beyond the first three.
    pub extended: Extended,
}

/// Operators that a source contains only if an entry needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Extended {
    /// Whether there are operators beyond union, intersection and difference.
    pub joins: bool,
    /// Whether there are blends beyond circular, quadratic and cubic ones.
    pub kernels: bool,
}

impl Extended {
    /// The needs of these entries.
    fn of(nodes: &[FlatNode]) -> Self {
        Self {
            joins: nodes.iter().any(|node| Join::ALL[node.join() as usize].is_extended()),
            kernels: nodes.iter().any(|node| node.kernel() >= FIRST_EXTENDED_KERNEL),
        }
    }
}

impl OpSet {
    /// The operations in `flat`.
    pub fn of(flat: &FlatScene) -> Self {
        let mut used = vec![false; ShapeKind::ALL.len()];
        let mut modifiers = BTreeSet::new();
        for node in &flat.nodes {
            if let Some(kind) = node.modifier() {
                modifiers.insert(kind);
            } else if node.is_leaf() {
                used[(node.code & 0xffff) as usize] = true;
            }
        }
        let shapes = ShapeKind::ALL.iter().filter(|k| used[**k as usize]).copied().collect();
        let stack = flat.components.iter().map(|c| c.stack).max().unwrap_or(0);
        Self { shapes, modifiers, stack: stack.max(1).next_power_of_two(), extended: Extended::of(&flat.nodes) }
    }

    /// The empty set.
    pub fn none() -> Self {
        Self { shapes: BTreeSet::new(), modifiers: BTreeSet::new(), stack: 1, extended: Extended::default() }
    }

    /// All operations.
    pub fn all() -> Self {
        Self {
            shapes: ShapeKind::ALL.iter().copied().collect(),
            modifiers: ModifierKind::ALL.iter().copied().filter(|kind| modifier_rows(*kind) > 0).collect(),
            stack: MAX_STACK,
            extended: Extended { joins: true, kernels: true },
        }
    }

    /// Loops in the code besides the main loop over entries. lavapipe counts one iteration of each for every entry,
    /// even if no lane enters the loop.
    pub fn loops(&self) -> u32 {
        let modifiers = if self.modifiers.is_empty() { 0 } else { MODIFIER_LOOPS };
        modifiers + self.shapes.iter().map(|kind| shape_loops(*kind)[0]).sum::<u32>()
    }

    /// Whether a pipeline for `self` also serves `other`.
    pub fn covers(&self, other: &Self) -> bool {
        let has = |a: bool, b: bool| a || !b;
        self.stack >= other.stack
            && self.shapes.is_superset(&other.shapes)
            && self.modifiers.is_superset(&other.modifiers)
            && has(self.extended.joins, other.extended.joins)
            && has(self.extended.kernels, other.extended.kernels)
    }

    /// Whether it contains hardly more than `other`: a few shapes, no loops.
    pub fn is_near(&self, other: &Self) -> bool {
        const FEW: usize = 3;
        // Rough fields are marched differently, and a picture must not depend on the pictures before it.
        self.is_rough() == other.is_rough()
            && self.loops() == other.loops()
            && self.shapes.len() <= other.shapes.len() + FEW
    }

    /// Whether rays may come as close to 0 as to a surface without touching one. Fields of fractals and landscapes may
    /// be far below the distance, and so may fields divided by the stretch of a deformation. Then only a change of sign
    /// is a hit, and oversteps are short: longer ones would pass bumps of a fraction of a pixel.
    pub(super) fn is_rough(&self) -> bool {
        use ShapeKind::{Heightmap, Julia, Kleinian, Mandelbulb, MengerSponge, MeshField, Ocean, Terrain};
        let is_rough = |kind: &ShapeKind| {
            matches!(kind, Julia | Kleinian | Mandelbulb | MengerSponge | MeshField | Terrain | Heightmap | Ocean)
        };
        self.shapes.iter().any(is_rough) || self.modifiers.iter().any(|kind| field::is_rough(*kind))
    }
}

/// Loops in the code of modifiers (the choice of the next copy, recursion steps, layers of noise), each counted for
/// every place that calls it.
const MODIFIER_LOOPS: u32 = 16;

/// Number of loops in a shape's function, and the upper bound of their iterations together. Loops over payload come on
/// top, at most one for each of the shape's rows.
pub fn shape_loops(kind: ShapeKind) -> [u32; 2] {
    match kind {
        ShapeKind::MengerSponge => [1, 8],
        ShapeKind::Julia | ShapeKind::Kleinian => [2, 64],
        // Up to 16 powers by 5 squarings each, and as many steps back by 6 iterations each.
        ShapeKind::Mandelbulb => [4, 240],
        ShapeKind::Tube | ShapeKind::Extrusion | ShapeKind::Revolution | ShapeKind::Text => [3, 0],
        ShapeKind::Terrain | ShapeKind::Ocean => [1, 0],
        // Over its levels.
        ShapeKind::MeshField => [1, isolith_bricks::MAX_LEVELS as u32],
        _ => [0, 0],
    }
}

/// Whether pipelines for templates contain the shape: it has neither loops nor payload.
pub fn fits_templates(kind: ShapeKind) -> bool {
    !kind.is_iterated() && !kind.has_data()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_are_iterated_are_those_without_data_that_loop() {
        for &kind in ShapeKind::ALL.iter().filter(|kind| !kind.has_data()) {
            assert_eq!(shape_loops(kind)[0] > 0, kind.is_iterated(), "{kind:?}");
        }
    }
}
