//! A part: a shape, a fold, or a part in a deformed space.

use glam::{DAffine3, DVec3};

use super::modifier::Deformation;
use crate::eval::{BlendParams, op_join, shape_distance};
use crate::prepare::PreparedShape;
use isolith_geometry::Aabb;

/// The evaluable form of a node.
#[derive(Clone)]
pub(super) enum Part {
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
pub(super) struct Leaf {
    pub local_from_outer: DAffine3,
    /// Factor on the shape's local distance.
    pub scale: f64,
    pub prepared: PreparedShape,
}

/// How an operand joins the result of those before it.
#[derive(Clone, Copy)]
pub(super) struct Link {
    pub join: u32,
    pub blend_params: BlendParams,
    pub kernel: u32,
}

impl Part {
    pub fn value(&self, p: DVec3) -> f64 {
        match self {
            Self::Nothing => f64::INFINITY,
            Self::Leaf(leaf) => {
                let local = leaf.local_from_outer.transform_point3(p).to_array();
                let shape = &leaf.prepared;
                shape_distance(shape.kind, local, &shape.parameters, shape) * leaf.scale
            }
            Self::Fold { first, rest } => rest.iter().fold(first.value(p), |so_far, (link, part)| {
                op_join(link.join, so_far, part.value(p), &link.blend_params, link.kernel).value
            }),
            Self::Deformed(deformed) => deformed.value(p),
        }
    }

    pub fn is_exact(&self) -> bool {
        match self {
            Self::Nothing | Self::Leaf(_) => true,
            Self::Fold { first, rest } => first.is_exact() && rest.iter().all(|(_, part)| part.is_exact()),
            Self::Deformed(deformed) => deformed.is_exact(),
        }
    }

    /// The bounds of its shapes, cut or not.
    pub fn bounds(&self) -> Aabb {
        match self {
            Self::Nothing => Aabb::EMPTY,
            Self::Leaf(leaf) => leaf.prepared.bounds.transformed(&leaf.local_from_outer.inverse()),
            Self::Fold { first, rest } => rest.iter().fold(first.bounds(), |all, (_, part)| all.union(&part.bounds())),
            Self::Deformed(deformed) => deformed.content.bounds().transformed(&deformed.local_from_outer.inverse()),
        }
    }
}

/// A part in a deformed space.
#[derive(Clone)]
pub(super) struct Deformed {
    pub local_from_outer: DAffine3,
    /// Factor on the local value.
    pub scale: f64,
    pub deformation: Deformation,
    pub content: Box<Part>,
}

impl Deformed {
    /// Whether its value follows from that of the content.
    pub fn is_exact(&self) -> bool {
        self.deformation.is_exact() && self.content.is_exact()
    }

    pub fn value(&self, p: DVec3) -> f64 {
        let local = self.local_from_outer.transform_point3(p);
        self.deformation.value(local, &|q| self.content.value(q)) * self.scale
    }
}
