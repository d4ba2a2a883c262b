//! Distances and winding numbers of meshes by looking at every triangle, in f64.

use std::f64::consts::PI;

use glam::DVec3;

use super::shapes::Soup;

impl Soup {
    pub fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        // As the file holds them.
        let at = |p: u32| self.points[p as usize].as_vec3().as_dvec3();
        self.triangles.iter().map(move |t| t.map(at))
    }

    /// The distance from the nearest triangle.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.corners().map(|corners| distance(corners, p)).fold(f64::INFINITY, f64::min)
    }

    /// The generalized winding number: the solid angle of all triangles over that of a sphere (Van Oosterom and Strackee,
    /// "The solid angle of a plane triangle", 1983).
    pub fn winding(&self, p: DVec3) -> f64 {
        let angle = |corners: [DVec3; 3]| {
            let [a, b, c] = corners.map(|corner| corner - p);
            let [x, y, z] = [a, b, c].map(DVec3::length);
            let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
            2.0 * a.dot(b.cross(c)).atan2(below)
        };
        self.corners().map(angle).sum::<f64>() / (4.0 * PI)
    }

    pub fn is_inside(&self, p: DVec3) -> bool {
        self.winding(p).abs() > 0.5
    }
}

/// The distance from a triangle: from its plane where the foot lies within, and from its edges elsewhere.
fn distance([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    let edge = |a: DVec3, b: DVec3| {
        let along = b - a;
        let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        if t.is_nan() { p.distance(a) } else { p.distance(a + along * t) }
    };
    let edges = edge(a, b).min(edge(b, c)).min(edge(c, a));
    let normal = (b - a).cross(c - a);
    let within = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) >= 0.0;
    let is_within = normal.length_squared() > 0.0 && within(a, b) && within(b, c) && within(c, a);
    if is_within { edges.min((p - a).dot(normal).abs() / normal.length()) } else { edges }
}
