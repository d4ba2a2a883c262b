//! Bounds of shapes, and the effect of scaling on them.

use glam::DVec3;

use super::{Degrees, Shape};
use crate::drawn::{profile_bounds, text_bounds, tube_bounds};
use crate::params::ParamValue;
use isolith_geometry::Aabb;

const INFINITY: f64 = f64::INFINITY;

impl Shape {
    /// A box around the surface, in local space.
    pub fn bounds(&self) -> Aabb {
        // The bounds of a solid of revolution, from its radius, its lowest and its highest point.
        let turned = |r: f64, low: f64, high: f64| Aabb::new(DVec3::new(-r, low, -r), DVec3::new(r, high, r));
        match *self {
            Self::Tube { ref points, radius, closed } => tube_bounds(points, radius, closed),
            Self::Extrusion { ref corners, smooth, depth, .. } => thick(profile_bounds(corners, smooth), depth),
            Self::Text { ref text, ref font, size, depth, .. } => thick(text_bounds(text, font, size), depth),
            Self::Revolution { ref corners, smooth, offset } => {
                let flat = profile_bounds(corners, smooth);
                turned((flat.max.x + offset).max(0.0), flat.min.y, flat.max.y)
            }
            Self::Terrain { size, amplitude, .. }
            | Self::Ocean { size, amplitude, .. }
            | Self::Heightmap { size, height: amplitude, .. } => {
                let [x, depth, z] = size;
                Aabb::new(DVec3::new(-0.5 * x, -depth, -0.5 * z), DVec3::new(0.5 * x, amplitude, 0.5 * z))
            }
            Self::MeshField { ref file, .. } => file.bricks().bounds(),
            Self::RoundCone { bottom_radius, top_radius, height } => {
                let low = (-0.5 * height - bottom_radius).min(0.5 * height - top_radius);
                let high = (0.5 * height + top_radius).max(-0.5 * height + bottom_radius);
                turned(bottom_radius.max(top_radius), low, high)
            }
            Self::Capsule { start, end, radius } => Aabb::from_points([start.into(), end.into()]).expanded(radius),
            Self::Plane {} | Self::Cone { .. } => turned(INFINITY, -INFINITY, 0.0),
            Self::CappedTorus { major_radius, minor_radius, half_angle } => {
                let (sine, cosine) = half_angle.0.to_radians().sin_cos();
                let z = major_radius * if cosine > 0.0 { sine } else { 1.0 };
                let low = DVec3::new(major_radius * cosine, 0.0, -z);
                Aabb::new(low, DVec3::new(major_radius, 0.0, z)).expanded(minor_radius)
            }
            Self::CutSphere { radius, cut } => {
                let cut = cut.clamp(-radius, radius);
                turned(if cut > 0.0 { rim(radius, cut) } else { radius }, cut, radius)
            }
            Self::HollowCutSphere { radius, cut, thickness } => {
                let cut = cut.clamp(-radius, radius);
                turned(if cut < 0.0 { rim(radius, cut) } else { radius }, -radius, cut).expanded(0.5 * thickness)
            }
            Self::SolidAngle { radius, half_angle } => {
                let (sine, cosine) = half_angle.0.to_radians().sin_cos();
                turned(radius * if cosine > 0.0 { sine } else { 1.0 }, radius * cosine.min(0.0), radius)
            }
            Self::Triangle { width, depth, skew, thickness } => {
                let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
                let corners = [at(-0.5 * width, -0.5 * depth), at(0.5 * width, -0.5 * depth), at(skew, 0.5 * depth)];
                Aabb::from_points(corners).expanded(0.5 * thickness)
            }
            _ => Aabb::from_center_half(DVec3::ZERO, self.half_extent()),
        }
    }

    /// Half the size of a box around the origin that holds the surface.
    fn half_extent(&self) -> DVec3 {
        let turned = |r: f64, half: f64| DVec3::new(r, half, r);
        match *self {
            Self::Sphere { radius }
            | Self::Octahedron { radius }
            | Self::DeathStar { radius, .. }
            | Self::Mandelbulb { radius, .. }
            | Self::Julia { radius, .. }
            | Self::Kleinian { radius, .. } => DVec3::splat(radius),
            Self::Ellipsoid { radii } => radii.into(),
            Self::Box { size, .. } | Self::BoxFrame { size, .. } => DVec3::from(size) * 0.5,
            Self::Torus { major_radius, minor_radius } => turned(major_radius + minor_radius, minor_radius),
            Self::Cylinder { radius, height, .. } => turned(radius, 0.5 * height),
            Self::CappedCone { bottom_radius, top_radius, height } => {
                turned(bottom_radius.max(top_radius), 0.5 * height)
            }
            // Two sides face along X, so corners lie on Z, 2/√3 farther out than the sides.
            Self::HexagonalPrism { radius, height } => DVec3::new(radius, height * 0.5, radius * 2.0 / 3.0_f64.sqrt()),
            Self::Link { length, major_radius, minor_radius } => {
                let across = major_radius + minor_radius;
                DVec3::new(0.5 * length + across, minor_radius, across)
            }
            Self::MengerSponge { size, .. } => DVec3::splat(0.5 * size),
            Self::InfiniteCylinder { radius } => turned(radius, INFINITY),
            Self::TriangularPrism { width, depth, height } | Self::Rhombus { width, depth, height, .. } => {
                DVec3::new(width, height, depth) * 0.5
            }
            Self::Prism { sides, radius, height, .. } => turned(radius / sides.half_angle().cos(), 0.5 * height),
            Self::Pyramid { width, height } => turned(0.5 * width, 0.5 * height),
            Self::Vesica { height, width } => turned(0.5 * width.min(height), 0.5 * height),
            Self::Quad { width, depth, skew, thickness } => {
                DVec3::new(0.5 * (width + skew.abs()), 0.0, 0.5 * depth) + 0.5 * thickness
            }
            Self::Star { outer_radius, inner_radius, height, .. } => {
                turned(outer_radius.max(inner_radius), 0.5 * height)
            }
            Self::PolygonRing { sides, major_radius, minor_radius } => {
                let corner = minor_radius / sides.half_angle().cos();
                turned(major_radius + corner, corner)
            }
            // Shapes that are not centered, see `bounds`.
            _ => DVec3::splat(INFINITY),
        }
    }

    /// The shape whose field is exactly that of this one scaled by `s` (all positive) along its own axes, if there is
    /// one: non-uniform scale then costs nothing and keeps the bound tight.
    pub fn absorb_scale(&self, s: DVec3) -> Option<Self> {
        if self.kind().has_data() {
            // All of its payload would have to be rebuilt, and a factor on its distance keeps the bound just as tight.
            return None;
        }
        if s.x == s.y && s.y == s.z {
            return Some(self.clone().with_lengths_times(s.x));
        }
        let round = s.x == s.z;
        let times = |v: [f64; 3]| (DVec3::from(v) * s).to_array();
        Some(match *self {
            Self::Sphere { radius } => Self::Ellipsoid { radii: (s * radius).to_array() },
            Self::Ellipsoid { radii } => Self::Ellipsoid { radii: times(radii) },
            Self::Box { size, rounding: 0.0 } => Self::Box { size: times(size), rounding: 0.0 },
            Self::Cylinder { radius, height, rounding: 0.0 } if round => {
                Self::Cylinder { radius: radius * s.x, height: height * s.y, rounding: 0.0 }
            }
            Self::CappedCone { bottom_radius, top_radius, height } if round => Self::CappedCone {
                bottom_radius: bottom_radius * s.x,
                top_radius: top_radius * s.x,
                height: height * s.y,
            },
            Self::Plane {} => Self::Plane {},
            Self::HexagonalPrism { radius, height } if round => {
                Self::HexagonalPrism { radius: radius * s.x, height: height * s.y }
            }
            Self::Cone { half_angle } if round => {
                let (sine, cosine) = half_angle.0.to_radians().sin_cos();
                Self::Cone { half_angle: Degrees((sine * s.x).atan2(cosine * s.y).to_degrees()) }
            }
            Self::InfiniteCylinder { radius } if round => Self::InfiniteCylinder { radius: radius * s.x },
            Self::TriangularPrism { width, depth, height } => {
                Self::TriangularPrism { width: width * s.x, depth: depth * s.z, height: height * s.y }
            }
            Self::Prism { sides, radius, height, rounding: 0.0 } if round => {
                Self::Prism { sides, radius: radius * s.x, height: height * s.y, rounding: 0.0 }
            }
            Self::Pyramid { width, height } if round => Self::Pyramid { width: width * s.x, height: height * s.y },
            Self::Rhombus { width, depth, height, rounding: 0.0 } => {
                Self::Rhombus { width: width * s.x, depth: depth * s.z, height: height * s.y, rounding: 0.0 }
            }
            Self::Star { points, outer_radius, inner_radius, height, rounding: 0.0 } if round => Self::Star {
                points,
                outer_radius: outer_radius * s.x,
                inner_radius: inner_radius * s.x,
                height: height * s.y,
                rounding: 0.0,
            },
            _ => return None,
        })
    }

    /// The shape with every length multiplied by a factor.
    pub fn with_lengths_times(mut self, factor: f64) -> Self {
        for (index, value) in self.values().into_iter().enumerate() {
            if self.kind().params()[index].limits.unit == "m" {
                let value = match value {
                    ParamValue::Scalar(v) => ParamValue::Scalar(v * factor),
                    ParamValue::Vector(v) => ParamValue::Vector(v * factor),
                    ParamValue::List(mut list) => {
                        list.rows.iter_mut().flatten().for_each(|v| *v *= factor);
                        ParamValue::List(list)
                    }
                    other => other,
                };
                self.set_value(index, value);
            }
        }
        self
    }
}

/// Extends flat bounds to a depth along Z.
fn thick(flat: Aabb, depth: f64) -> Aabb {
    let half = DVec3::Z * (0.5 * depth);
    Aabb::new(flat.min - half, flat.max + half)
}

/// The radius of the circle in which a ball is cut at a height over its center.
fn rim(radius: f64, cut: f64) -> f64 {
    ((radius - cut) * (radius + cut)).sqrt()
}
