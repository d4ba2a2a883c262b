//! Operands: what folds are made of, in world space.

use std::rc::Rc;

use glam::DAffine3;

use super::arrays::Join;
use super::prepare::PreparedShape;
use isolith_geometry::Aabb;
use isolith_scene::{Blend, MaterialId, ModifierKind, Node};

/// One operand of a fold. What is below it is shared by its clones.
#[derive(Clone)]
pub(super) struct Operand<'a> {
    /// The node it came from.
    pub node: &'a Node,
    /// The outermost node that it belongs to: what a message about its component names.
    pub outermost: &'a Node,
    /// How it joins what precedes it.
    pub join: Join,
    /// How round the blend is, in meters.
    pub blend: Blend,
    /// What else the join needs, see [`super::eval::BlendParams`]: size and depth.
    pub detail: [f64; 2],
    /// Around its surface, in the world.
    pub bounds: Aabb,
    /// Its field is at least `bound_slope` times the distance to `cull_box`.
    pub cull_box: Aabb,
    /// See `cull_box`.
    pub bound_slope: f64,
    /// Shapes, modifiers and groups in it.
    pub entries: usize,
    /// How deep groups and modifiers are nested in it, itself counted; 0 for a shape.
    pub depth: u32,
    /// What it is.
    pub value: Value<'a>,
}

/// What an operand is.
#[derive(Clone)]
pub(super) enum Value<'a> {
    /// A shape: local-from-world, factor on its local distance, what it is evaluated with.
    Leaf { local_from_world: DAffine3, distance_scale: f64, prepared: Rc<PreparedShape>, material: MaterialId },
    /// A fold of its own; never of one operand.
    Fold(Rc<Vec<Operand<'a>>>),
    /// A fold in the local space of a modifier: local-from-world, factor on its local distance, the modifier.
    Modified {
        local_from_world: DAffine3,
        distance_scale: f64,
        kind: ModifierKind,
        modified: Modified,
        content: Rc<Vec<Operand<'a>>>,
    },
}

/// A modifier that stays in the arrays, with what it makes of its content.
#[derive(Clone, Debug)]
pub(super) struct Modified {
    /// Its rows, see `shaders/mod/`.
    pub rows: Vec<[f64; 4]>,
    /// Its data; nothing for most.
    pub data: Rc<[[f64; 4]]>,
    /// Around the result, in the node's own space.
    pub bounds: Aabb,
    /// The field is at least `bound_slope` times the distance to this.
    pub cull_box: Aabb,
    /// See `cull_box`.
    pub bound_slope: f64,
    /// How often the content may be evaluated for one point.
    pub copies: u32,
    /// What the artist should know.
    pub warning: Option<String>,
}
