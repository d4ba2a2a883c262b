//! Closed-form ray intersections.

use glam::DVec3;
use isolith::geometry::Ray;

/// The intersection of a ray with a solid.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Where the ray enters and leaves the solid, if it does.
    pub span: Option<[f64; 2]>,
    /// The tangent of the angle between the ray and the normal where it enters.
    pub slope: f64,
    /// Angle between the ray and the nearest outline, in radians.
    pub edge: f64,
}

/// No solid near the ray.
pub const NOTHING: Seen = Seen { span: None, slope: 0.0, edge: f64::INFINITY };

impl Seen {
    /// The nearer of two separate solids.
    pub fn or(self, other: Self) -> Self {
        let entry = |seen: &Self| seen.span.map_or(f64::INFINITY, |[entry, _]| entry);
        let nearer = if entry(&other) < entry(&self) { other } else { self };
        Self { edge: self.edge.min(other.edge), ..nearer }
    }
}

/// A ball.
pub fn ball(ray: &Ray, center: DVec3, radius: f64) -> Seen {
    let to = center - ray.origin;
    let along = to.dot(ray.direction);
    let aside = (to - ray.direction * along).length();
    let edge = (aside - radius).abs() / along.abs().max(radius);
    if aside >= radius || along < -radius {
        return Seen { span: None, slope: 0.0, edge };
    }
    let half = ((radius - aside) * (radius + aside)).sqrt();
    Seen { span: Some([along - half, along + half]), slope: aside / half, edge }
}

/// The nearest of many balls with one radius.
pub fn balls(ray: &Ray, centers: impl IntoIterator<Item = DVec3>, radius: f64) -> Seen {
    centers.into_iter().map(|center| ball(ray, center, radius)).fold(NOTHING, Seen::or)
}

/// The half space below a plane.
pub fn half_space(ray: &Ray, point: DVec3, normal: DVec3) -> Seen {
    let climb = normal.dot(ray.direction);
    let height = normal.dot(ray.origin - point);
    // Toward the horizon, f32 cannot decide.
    let edge = if climb.abs() < 1e-3 { 0.0 } else { f64::INFINITY };
    let slope = (1.0 - climb * climb).max(0.0).sqrt() / climb.abs();
    Seen { span: (climb < 0.0 && height > 0.0).then(|| [-height / climb, f64::INFINITY]), slope, edge }
}

/// A floor at height 0 with a round hole of `radius` around `center`, of the given `depth`; open below if `is_open`.
/// The eye is above the floor.
pub fn floor_with_hole(ray: &Ray, center: DVec3, radius: f64, depth: f64, is_open: bool) -> Seen {
    let floor = half_space(ray, DVec3::ZERO, DVec3::Y);
    let Some([t, end]) = floor.span else { return floor };
    let aside = |t: f64| {
        let at = ray.at(t) - center;
        DVec3::new(at.x, 0.0, at.z)
    };
    // Across the view the rim is nearer than along the floor, by the sine of the angle.
    let rim = |t: f64, rise: f64| (aside(t).length() - radius).abs() * rise / t;
    let rise = ray.direction.y.abs();
    let edge = floor.edge.min(rim(t, rise));
    if aside(t).length() >= radius {
        return Seen { edge, ..floor };
    }
    // In the hole, the ray meets its wall, or the bottom first.
    let bottom = t + depth / rise;
    let flat = DVec3::new(ray.direction.x, 0.0, ray.direction.z);
    let (a, b, c) = (flat.length_squared(), aside(t).dot(flat), aside(t).length_squared() - radius * radius);
    let wall = t + (-b + (b * b - a * c).max(0.0).sqrt()) / a;
    if wall < bottom {
        let inward = aside(wall).normalize();
        let cosine = inward.dot(ray.direction).abs();
        let slope = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
        return Seen { span: Some([wall, end]), slope, edge: edge.min(rim(bottom, rise)) };
    }
    let span = (!is_open).then_some([bottom, end]);
    Seen { span, slope: floor.slope, edge: edge.min(rim(bottom, rise)) }
}
