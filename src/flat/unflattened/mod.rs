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
//! | `modifier` | what modifiers do to points and values |

mod build;
mod modifier;

use glam::{DAffine3, DVec3};
use thiserror::Error;

use super::eval::{BlendParams, op_join, shape_distance};
use super::prepare::PreparedShape;
use crate::geometry::Aabb;
use crate::scene::{NodeId, Scene};
use modifier::Deformed;

/// Why a scene has no such field.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{node}: {reason}")]
pub struct Unsupported {
    /// Which node.
    pub node: NodeId,
    /// What is not evaluated without flattening.
    pub reason: &'static str,
}

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

/// What a node comes to.
#[derive(Clone)]
enum Part {
    /// The empty set.
    Nothing,
    Leaf(Leaf),
    Fold {
        first: Box<Part>,
        rest: Vec<(Link, Part)>,
    },
    Deformed(Deformed),
}

/// A shape in the world, or in the space of a deformation.
#[derive(Clone)]
struct Leaf {
    local_from_outer: DAffine3,
    /// Factor on its local distance.
    scale: f64,
    prepared: PreparedShape,
}

/// How an operand joins what stands before it.
#[derive(Clone, Copy)]
struct Link {
    join: u32,
    blend_params: BlendParams,
    kernel: u32,
}

impl Part {
    fn value(&self, p: DVec3) -> f64 {
        match self {
            Self::Nothing => f64::INFINITY,
            Self::Leaf(leaf) => {
                let local = leaf.local_from_outer.transform_point3(p).to_array();
                let PreparedShape { kind, parameters, payload: rows, .. } = &leaf.prepared;
                shape_distance(*kind, local, parameters, &|row| rows[row]) * leaf.scale
            }
            Self::Fold { first, rest } => rest.iter().fold(first.value(p), |so_far, (link, part)| {
                op_join(link.join, so_far, part.value(p), &link.blend_params, link.kernel).value
            }),
            Self::Deformed(deformed) => deformed.value(p),
        }
    }

    fn is_exact(&self) -> bool {
        match self {
            Self::Nothing | Self::Leaf(_) => true,
            Self::Fold { first, rest } => first.is_exact() && rest.iter().all(|(_, part)| part.is_exact()),
            Self::Deformed(deformed) => deformed.is_exact(),
        }
    }

    /// Around its shapes, cut or not.
    fn bounds(&self) -> Aabb {
        match self {
            Self::Nothing => Aabb::EMPTY,
            Self::Leaf(leaf) => leaf.prepared.bounds.transformed(&leaf.local_from_outer.inverse()),
            Self::Fold { first, rest } => rest.iter().fold(first.bounds(), |all, (_, part)| all.union(&part.bounds())),
            Self::Deformed(deformed) => deformed.content.bounds().transformed(&deformed.local_from_outer.inverse()),
        }
    }
}
