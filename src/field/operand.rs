//! Operands of folds, in world space.

use std::rc::Rc;

use glam::DAffine3;

use super::arrays::Join;
use super::prepare::PreparedShape;
use isolith_geometry::Aabb;
use isolith_scene::{Blend, MaterialId, ModifierKind, Node};

/// One operand of a fold. Clones share its content.
#[derive(Clone)]
pub(super) struct Operand<'a> {
    /// The node it came from.
    pub node: &'a Node,
    /// Its outermost node, which messages about the component name.
    pub outermost: &'a Node,
    /// How it joins the result so far.
    pub join: Join,
    /// Its blend, with the radius in meters.
    pub blend: Blend,
    /// Size and depth of joins that need them, see [`super::eval::BlendParams`].
    pub detail: [f64; 2],
    /// World bounds of its surface.
    pub bounds: Aabb,
    /// Its field is at least `bound_slope` times the distance to `cull_box`.
    pub cull_box: Aabb,
    /// See `cull_box`.
    pub bound_slope: f64,
    /// Number of shapes, modifiers and groups in it.
    pub entries: usize,
    /// Nesting depth of groups and modifiers, itself counted; 0 for a shape.
    pub depth: u32,
    /// Its kind and content.
    pub value: Value<'a>,
}

/// Kind and content of an operand.
#[derive(Clone)]
pub(super) enum Value<'a> {
    /// A shape: local-from-world, factor on its local distance, prepared shape, material, and the space of its object if
    /// textures of the material need it.
    Leaf {
        local_from_world: DAffine3,
        distance_scale: f64,
        prepared: Rc<PreparedShape>,
        material: MaterialId,
        object_from_world: Option<Rc<DAffine3>>,
    },
    /// A nested fold; never of one operand.
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

/// A modifier that stays in the arrays, with the bounds of its result.
#[derive(Clone, Debug)]
pub(super) struct Modified {
    /// Its rows, see `modifier_params`.
    pub rows: Vec<[f64; 4]>,
    /// Its payload; empty for most.
    pub data: Rc<[[f64; 4]]>,
    /// Bounds of the result, in the node's own space.
    pub bounds: Aabb,
    /// The field is at least `bound_slope` times the distance to this box.
    pub cull_box: Aabb,
    /// See `cull_box`.
    pub bound_slope: f64,
    /// Most evaluations of the content for one point.
    pub copies: u32,
    /// A warning for the artist.
    pub warning: Option<String>,
}
