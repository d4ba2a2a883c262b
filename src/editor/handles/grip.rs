//! The movement of a handle in the space of its node, and the value that a ray stands for.

use glam::{DAffine3, DVec3};

use isolith_geometry::Ray;

/// How a handle moves, in the space of its node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// Along a ray: the value is the distance from `origin` over `factor`.
    Line {
        /// Where the value is 0.
        origin: DVec3,
        /// A unit vector.
        direction: DVec3,
        /// Distance per unit of the value; not 0.
        factor: f64,
    },
    /// Around a point: the value is the angle in degrees from `zero` toward `quarter`, over `factor`.
    Arc {
        /// The center of the circle.
        center: DVec3,
        /// A unit vector.
        zero: DVec3,
        /// A unit vector, perpendicular to `zero`.
        quarter: DVec3,
        /// The radius of the circle.
        radius: f64,
        /// Angle per unit of the value; not 0.
        factor: f64,
    },
    /// Anywhere: in the plane through `at` that faces the eye, or in the plane across Z if `flat`.
    Place {
        /// Where it is.
        at: DVec3,
        /// Whether it stays in the plane across Z.
        flat: bool,
    },
}

/// A ray in the world, with the space of the node.
#[derive(Clone, Copy, Debug)]
pub struct Pointing<'a> {
    /// The ray of the pointer.
    pub ray: &'a Ray,
    /// The direction of the view; a unit vector.
    pub forward: DVec3,
    /// The transform of the node.
    pub world_from_local: &'a DAffine3,
}

impl Grip {
    /// The position of the handle for a value; a place is where it is.
    pub fn position(&self, value: f64) -> DVec3 {
        match *self {
            Self::Line { origin, direction, factor } => origin + direction * (value * factor),
            Self::Arc { center, zero, quarter, radius, factor } => {
                let (sine, cosine) = (value * factor).to_radians().sin_cos();
                center + (zero * cosine + quarter * sine) * radius
            }
            Self::Place { at, .. } => at,
        }
    }

    /// The value that the ray stands for; `None` if it runs along the movement, or for a place.
    pub fn value(&self, pointing: &Pointing<'_>) -> Option<f64> {
        match *self {
            Self::Line { origin, direction, factor } => {
                let start = pointing.world_from_local.transform_point3(origin);
                let along = pointing.world_from_local.transform_vector3(direction);
                let length = along.length();
                let distance = distance_along(start, along / length, pointing.ray)?;
                Some(distance / (length * factor)).filter(|value| value.is_finite())
            }
            Self::Arc { center, zero, quarter, factor, .. } => {
                let at = in_plane(pointing, center, zero.cross(quarter))? - center;
                let angle = at.dot(quarter).atan2(at.dot(zero)).to_degrees();
                Some(angle / factor).filter(|value| value.is_finite())
            }
            Self::Place { .. } => None,
        }
    }

    /// The place that the ray stands for, in the space of the node; `None` unless it is a place.
    pub fn place(&self, pointing: &Pointing<'_>) -> Option<DVec3> {
        let Self::Place { at, flat } = *self else { return None };
        if flat {
            return in_plane(pointing, at, DVec3::Z);
        }
        let world = pointing.world_from_local.transform_point3(at);
        let t = (world - pointing.ray.origin).dot(pointing.forward) / pointing.ray.direction.dot(pointing.forward);
        let hit = (t.is_finite() && t > 0.0).then(|| pointing.ray.at(t))?;
        Some(pointing.world_from_local.inverse().transform_point3(hit)).filter(|point| point.is_finite())
    }
}

/// The point of a plane of the node's space that the ray meets; `None` if the plane is seen nearly from its edge.
fn in_plane(pointing: &Pointing<'_>, through: DVec3, normal: DVec3) -> Option<DVec3> {
    let local_from_world = pointing.world_from_local.inverse();
    let origin = local_from_world.transform_point3(pointing.ray.origin);
    let direction = local_from_world.transform_vector3(pointing.ray.direction).try_normalize()?;
    let slope = direction.dot(normal);
    const FLATTEST: f64 = 0.02;
    if slope.abs() < FLATTEST {
        return None;
    }
    let t = (through - origin).dot(normal) / slope;
    (t > 0.0).then(|| origin + direction * t).filter(|point| point.is_finite())
}

/// The distance along a line, from `origin` in the unit direction `axis`, of its point that is nearest to the ray; `None`
/// if they are parallel.
fn distance_along(origin: DVec3, axis: DVec3, ray: &Ray) -> Option<f64> {
    let between = origin - ray.origin;
    let cosine = axis.dot(ray.direction);
    let determinant = 1.0 - cosine * cosine;
    // Also false for NaN.
    (determinant > 1e-9).then(|| (cosine * between.dot(ray.direction) - between.dot(axis)) / determinant)
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec2};

    use super::*;
    use isolith_geometry::Camera;

    const SIZE: DVec2 = DVec2::new(700.0, 500.0);

    /// Looks at what a point of the node's space stands for.
    fn seen<T>(at: DVec3, ask: impl Fn(&Pointing<'_>) -> T) -> T {
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.4);
        let (scale, place) = (DVec3::new(1.5, 0.5, 2.0), DVec3::new(0.4, -0.2, 0.1));
        let world_from_local = DAffine3::from_scale_rotation_translation(scale, turn, place);
        let camera = Camera::looking_at(DVec3::new(5.0, 4.0, 6.0), DVec3::ZERO, 0.7);
        let (pixel, _) = camera.project(world_from_local.transform_point3(at), SIZE).unwrap();
        let (ray, forward) = (camera.ray(pixel, SIZE), camera.rotation * DVec3::NEG_Z);
        ask(&Pointing { ray: &ray, forward, world_from_local: &world_from_local })
    }

    #[test]
    fn what_is_pointed_at_is_the_value_at_that_position() {
        let line = Grip::Line { origin: DVec3::new(0.1, 0.2, 0.3), direction: DVec3::new(0.6, 0.0, 0.8), factor: 0.5 };
        let arc = Grip::Arc { center: DVec3::X * 0.2, zero: DVec3::NEG_Z, quarter: DVec3::Y, radius: 1.2, factor: 0.5 };
        for (grip, values) in [(line, [0.0, 0.7, 1.9]), (arc, [0.0, 35.0, 110.0])] {
            for value in values {
                let found = seen(grip.position(value), |pointing| grip.value(pointing)).unwrap();
                assert!((found - value).abs() < 1e-6, "{grip:?} {value} {found}");
            }
        }
        assert_eq!(seen(DVec3::ZERO, |pointing| line.place(pointing)), None);
    }

    #[test]
    fn a_place_keeps_its_plane() {
        let at = DVec3::new(0.3, 0.1, 0.2);
        for flat in [false, true] {
            let grip = Grip::Place { at, flat };
            assert!((seen(at, |pointing| grip.place(pointing)).unwrap() - at).length() < 1e-9);
        }
        let moved =
            seen(DVec3::new(-0.4, 0.5, 0.2), |pointing| Grip::Place { at, flat: true }.place(pointing)).unwrap();
        assert!((moved - DVec3::new(-0.4, 0.5, 0.2)).length() < 1e-9, "{moved}");
    }

    #[test]
    fn a_line_toward_the_eye_has_no_value() {
        let grip = Grip::Line { origin: DVec3::ZERO, direction: DVec3::Z, factor: 1.0 };
        let ray = Ray { origin: DVec3::Z * 5.0, direction: DVec3::NEG_Z };
        let pointing = Pointing { ray: &ray, forward: DVec3::NEG_Z, world_from_local: &DAffine3::IDENTITY };
        assert_eq!(grip.value(&pointing), None);
        let edge = Grip::Arc { center: DVec3::ZERO, zero: DVec3::Z, quarter: DVec3::X, radius: 1.0, factor: 1.0 };
        assert_eq!(edge.value(&pointing), None, "a circle seen from its edge");
    }
}
