//! Axis-aligned boxes.

use glam::{DAffine3, DVec3};

use super::Ray;

/// An axis-aligned box; empty where `min > max`, unbounded where a coordinate is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least corner.
    pub min: DVec3,
    /// The greatest corner.
    pub max: DVec3,
}

impl Aabb {
    /// The empty box; the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    /// The unbounded box; the neutral element of [`Aabb::intersection`].
    pub const EVERYTHING: Self = Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

    /// The box between two opposite corners.
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The box of the given center that reaches `half` in each direction.
    pub fn from_center_half(center: DVec3, half: DVec3) -> Self {
        Self { min: center - half, max: center + half }
    }

    /// The smallest box around the points; empty for none.
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// Whether no point lies inside.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Whether every coordinate is finite (an empty box is not).
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// The middle; meaningful for finite boxes only.
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Half the extent along each axis.
    pub fn half(&self) -> DVec3 {
        (self.max - self.min) * 0.5
    }

    /// The smallest box that holds both.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The largest box inside both; empty if they do not meet.
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// The box, expanded by `by` on every side. An empty box stays empty.
    pub fn expanded(&self, by: f64) -> Self {
        if self.is_empty() { *self } else { Self { min: self.min - by, max: self.max + by } }
    }

    /// The box, moved by `by`.
    pub fn translated(&self, by: DVec3) -> Self {
        Self { min: self.min + by, max: self.max + by }
    }

    /// Whether the point lies inside or on the border.
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Euclidean distance from the point to the box; 0 inside, infinite for an empty box.
    pub fn distance(&self, p: DVec3) -> f64 {
        if self.is_empty() {
            return f64::INFINITY;
        }
        (self.min - p).max(p - self.max).max(DVec3::ZERO).length()
    }

    /// The smallest box around this box's image under an affine map. An unbounded box maps to
    /// everything unless the map keeps the axes apart.
    pub fn transformed(&self, target_from_source: &DAffine3) -> Self {
        if self.is_empty() {
            return *self;
        }
        let m = target_from_source.matrix3;
        let mut out = Self { min: target_from_source.translation, max: target_from_source.translation };
        for row in 0..3 {
            for column in 0..3 {
                let c = m.col(column)[row];
                // 0 times infinity is NaN; a zero coefficient contributes nothing whatever the extent.
                if c == 0.0 {
                    continue;
                }
                let (a, b) = (c * self.min[column], c * self.max[column]);
                out.min[row] += a.min(b);
                out.max[row] += a.max(b);
            }
        }
        out
    }

    /// The parameters of the ray's entry (not before 0) and exit; `None` if it misses.
    pub fn ray_interval(&self, ray: &Ray) -> Option<(f64, f64)> {
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if o < self.min[axis] || o > self.max[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.min[axis] - o) / d, (self.max[axis] - o) / d);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some((near, far))
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            DVec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unbounded_box_survives_a_rotation_about_its_own_axis() {
        let slab = Aabb::new(
            DVec3::new(f64::NEG_INFINITY, -1.0, f64::NEG_INFINITY),
            DVec3::new(f64::INFINITY, 0.0, f64::INFINITY),
        );
        let moved = slab.transformed(&DAffine3::from_translation(DVec3::new(3.0, 5.0, 0.0)));
        assert_eq!(moved.max.y, 5.0);
        assert_eq!(moved.min.y, 4.0);
        assert_eq!(moved.min.x, f64::NEG_INFINITY);
    }

    #[test]
    fn a_ray_that_starts_inside_enters_at_zero() {
        let unit = Aabb::from_center_half(DVec3::ZERO, DVec3::ONE);
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };
        assert_eq!(unit.ray_interval(&ray), Some((0.0, 1.0)));
        let beside = Ray { origin: DVec3::new(0.0, 2.0, 0.0), direction: DVec3::X };
        assert_eq!(unit.ray_interval(&beside), None);
    }
}
