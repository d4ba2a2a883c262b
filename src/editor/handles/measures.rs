//! The values of a node, and the directions of the view in the node's space, that handles are computed from.

use glam::DVec3;

use isolith_geometry::Aabb;
use isolith_scene::{Node, NodeKind, ParamValue, Params, Part};

/// What the rows of the tables read.
pub struct Measures<'a> {
    /// The node.
    pub node: &'a Node,
    /// The part of it that has the parameters.
    pub part: Part,
    /// The view's right in the node's space; a unit vector.
    pub right: DVec3,
    /// The view's up in the node's space; a unit vector.
    pub up: DVec3,
    /// A length in the node's space that looks the same at every distance.
    pub reach: f64,
    /// A point of the node's space where the first two children of a group meet.
    pub seam: DVec3,
    /// The length of the unit in which a group's blend radius is measured.
    pub blend_unit: f64,
}

impl<'a> Measures<'a> {
    /// The parameters of the part.
    pub fn params(&self) -> Option<&'a dyn Params> {
        self.part.params(self.node)
    }

    /// The number of this name; 0 if there is none.
    pub fn number(&self, name: &str) -> f64 {
        match self.params().and_then(|params| params.get(name)) {
            Some(ParamValue::Scalar(value)) => value,
            Some(ParamValue::Count(value)) => f64::from(value),
            _ => 0.0,
        }
    }

    /// The vector of this name; 0 if there is none.
    pub fn vector(&self, name: &str) -> DVec3 {
        match self.params().and_then(|params| params.get(name)) {
            Some(ParamValue::Vector(value)) => value,
            _ => DVec3::ZERO,
        }
    }

    /// The rows of the list of this name; empty if there is none.
    pub fn rows(&self, name: &str) -> Vec<[f64; 4]> {
        match self.params().and_then(|params| params.get(name)) {
            Some(ParamValue::List(list)) => list.rows,
            _ => Vec::new(),
        }
    }

    /// The bounds of the shape; empty if there is none or it has no end.
    pub fn bounds(&self) -> Aabb {
        match &self.node.kind {
            NodeKind::Object(object) => Some(object.shape.bounds()).filter(Aabb::is_finite).unwrap_or(Aabb::EMPTY),
            _ => Aabb::EMPTY,
        }
    }

    /// A direction to the silhouette of a ball, off the screen's axes, where the arrows are.
    pub fn outward(&self) -> DVec3 {
        (self.right * 0.9 - self.up * 0.44).normalize_or(DVec3::X)
    }

    /// The direction across an axis that is nearest to the view's right.
    pub fn across(&self, axis: DVec3) -> DVec3 {
        let axis = axis.normalize_or(DVec3::Y);
        let flat = self.right - axis * self.right.dot(axis);
        flat.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector())
    }

    /// The direction across the Y axis that is nearest to the view's right.
    pub fn turned(&self) -> DVec3 {
        self.across(DVec3::Y)
    }
}
