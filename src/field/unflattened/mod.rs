//! The field of a scene from its tree, in f64, without flattening: no components, no bounds, no runs, no skipping, no
//! rounding to 32 bits. It is slow; tests use it as a second opinion. Renderer and reference read the arrays from
//! flattening, so a fault of flattening is in both.
//!
//! It shares with them only the formulas of shapes and operators (`eval`), the prepared shapes (`PreparedShape`), and
//! which modifiers are idle. It makes copies one by one, and evaluates cells of an infinite repetition around the
//! point.
//!
//! | file | content |
//! |---|---|
//! | `build` | builds parts from nodes |
//! | `part` | a part: a shape, a fold, or a part in a deformed space |
//! | `modifier` | the effect of modifiers on points and values |

mod build;
mod modifier;
mod part;

use glam::DVec3;

use isolith_scene::{Operation, Scene};
use part::Part;

pub use build::Unsupported;

/// The field of a scene.
pub struct SceneField {
    whole: Part,
    has_intersections: bool,
}

impl SceneField {
    /// Prepares a scene.
    ///
    /// # Errors
    /// A blend depends on values that flattening chooses freely: sizes of bounds, or the field of a deformation away
    /// from its surface.
    pub fn new(scene: &Scene) -> Result<Self, Unsupported> {
        let has_intersections = scene.nodes().iter().any(|node| node.operation == Operation::Intersect);
        Ok(Self { whole: build::whole(scene)?, has_intersections })
    }

    /// The field at a point of the world. Its sign and its zeros are right; where [`Self::is_exact`], its value
    /// follows the operands' formulas. Infinite for an empty scene.
    pub fn value(&self, p: DVec3) -> f64 {
        self.whole.value(p)
    }

    /// Whether nodes intersect what stands before them. What they cut off wholly is in this tree a lower bound, where
    /// flattened arrays have nothing.
    pub fn has_intersections(&self) -> bool {
        self.has_intersections
    }

    /// Whether the tree determines the value itself. Deformations and repetitions may have any field with their
    /// surface.
    pub fn is_exact(&self) -> bool {
        self.whole.is_exact()
    }
}
