//! The field of a scene as its tree says it, in f64, without flattening: no components, no bounds, no runs, nothing skipped,
//! no number rounded to 32 bits. Slow; a second opinion for tests. Renderer and reference read the arrays that flattening
//! makes, so a fault of flattening is in both.
//!
//! It shares with them the formulas of shapes and operators (`eval`), what a shape is evaluated with (`PreparedShape`), which modifiers
//! do nothing, and no more. Copies are made one by one, and cells of a repetition without end are looked at around the point.
//!
//! | file | what it does |
//! |---|---|
//! | `build` | nodes → parts |
//! | `part` | a part: a shape, a fold, or a part in a deformed space |
//! | `modifier` | what modifiers do to points and values |

mod build;
mod modifier;
mod part;

use glam::DVec3;

use isolith_scene::Scene;
use part::Part;

pub use build::Unsupported;

/// The field of a scene.
pub struct SceneField {
    whole: Part,
}

impl SceneField {
    /// Prepares a scene.
    ///
    /// # Errors
    /// A blend depends on values that flattening chooses freely: sizes of bounds, or the field of a deformation away from
    /// its surface.
    pub fn new(scene: &Scene) -> Result<Self, Unsupported> {
        Ok(Self { whole: build::whole(scene)? })
    }

    /// The field at a point of the world: its sign and its zeros are right, and where [`Self::is_exact`] its value is
    /// what the operands' formulas say. Infinite where nothing is.
    pub fn value(&self, p: DVec3) -> f64 {
        self.whole.value(p)
    }

    /// Whether the value itself is given by the tree. Deformations and repetitions may have any field with their surface.
    pub fn is_exact(&self) -> bool {
        self.whole.is_exact()
    }
}
