//! Lights with a size: how large they appear, how far they are above the horizon, and how their highlights look.
//! Counterpart of `shaders/light/area.wgsl`, which names the sources of the formulas.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::brdf::{ShadingPoint, brdf_layered};
use crate::lights::GpuLight;
use crate::mixture::SurfaceMaterial;

/// A light as a point meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncomingLight {
    /// Unit direction to its middle.
    pub to_light: DVec3,
    /// Irradiance of a surface that faces it, relative to the light's color times π.
    pub share: f64,
    /// Square of the sine of the half angle of a sphere that appears as large.
    pub sine_squared: f64,
}

/// The irradiance of a surface, relative to that of one that faces the light: the cosine of the angle of incidence,
/// unless the horizon cuts a part of the light off. Exact for spheres.
pub fn area_facing(cosine: f64, sine_squared: f64) -> f64 {
    let s = sine_squared.max(1e-8);
    if cosine * cosine >= s {
        return cosine.max(0.0);
    }
    let x = (1.0 / s - 1.0).max(0.0).sqrt();
    let sine = (1.0 - cosine * cosine).max(1e-12).sqrt();
    let y = (-x * cosine / sine).clamp(-1.0, 1.0);
    let q = sine * (1.0 - y * y).sqrt();
    (((cosine * y.acos() - x * q) * s + q.atan2(x.max(1e-12))) / (PI * s)).max(0.0)
}

/// An edge of a polygon in Lambert's formula for its vector irradiance.
fn area_edge(from_point: DVec3, next: DVec3) -> DVec3 {
    let side = from_point.cross(next);
    let sine = side.length();
    side * (0.5 * sine.atan2(from_point.dot(next)) / sine.max(1e-20))
}

/// A rectangle as a point meets it, by Lambert's formula; from behind it is dark.
pub fn area_rectangle(light: &GpuLight, position: DVec3) -> IncomingLight {
    let [middle, right, up, direction] = [light.position, light.right, light.up, light.direction].map(vector);
    let middle = middle - position;
    let corners = [middle - right - up, middle + right - up, middle + right + up, middle - right + up];
    let mut flow: DVec3 = (0..4).map(|i| area_edge(corners[i], corners[(i + 1) % 4])).sum();
    if flow.dot(direction) > 0.0 {
        flow = -flow;
    }
    let strength = flow.length();
    let share = if middle.dot(direction) < 0.0 { strength / PI } else { 0.0 };
    IncomingLight { to_light: flow / strength.max(1e-20), share, sine_squared: share.min(1.0) }
}

/// What a mirror shows of the light.
struct Mirrored {
    /// Unit direction to the nearest part of the light, of which only a part counts around its middle.
    direction: DVec3,
    /// How far the mirrored ray passes the edge of the light, in radians; negative within.
    aside: f64,
}

fn area_mirrored(point: &ShadingPoint, light: &GpuLight, incoming: &IncomingLight, part: f64) -> Mirrored {
    let ray = 2.0 * point.normal.dot(point.to_eye) * point.normal - point.to_eye;
    if light.kind == GpuLight::RECTANGLE {
        let [middle, right, up, direction] = [light.position, light.right, light.up, light.direction].map(vector);
        let middle = middle - point.position;
        let along = middle.dot(direction) / ray.dot(direction).min(-1e-3);
        let hit = ray * along - middle;
        let size = DVec2::new(right.length(), up.length());
        let at = DVec2::new(hit.dot(right), hit.dot(up)) / size.max(DVec2::splat(1e-6));
        let beyond = at.abs() - size;
        let aside = beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0);
        let held = at.clamp(-size * part, size * part) / size.max(DVec2::splat(1e-6));
        let direction = (middle + right * held.x + up * held.y).normalize();
        return Mirrored { direction, aside: aside / along.max(1e-6) };
    }
    let toward = ray * incoming.to_light.dot(ray) - incoming.to_light;
    let (distance, sine) = (toward.length(), incoming.sine_squared.sqrt());
    let held = toward * (part * sine / distance.max(1e-6)).min(1.0);
    Mirrored { direction: (incoming.to_light + held).normalize(), aside: distance - sine }
}

/// Roughness of the highlight, as α of GGX.
fn area_alpha(material: &SurfaceMaterial) -> f64 {
    let of_ggx = material.roughness * material.roughness;
    let of_phong = (2.0 / (material.phong_shininess / material.phong_weight.max(1e-4) + 2.0)).sqrt();
    (of_ggx + (of_phong - of_ggx) * material.phong_weight).max(1e-3)
}

/// The light that the surface reflects toward the eye, relative to the light's color.
pub fn area_reflected(point: &ShadingPoint, light: &GpuLight, incoming: &IncomingLight) -> DVec3 {
    reflected_by(point, light, incoming, |direction, widened| {
        let mut layers = point.layers();
        layers.coat_alpha = widened(layers.coat_alpha);
        brdf_layered(point, &layers, direction)
    })
}

/// [`area_reflected`] for any reflection function, which also gets what widens the spread of its coat.
fn reflected_by(
    point: &ShadingPoint,
    light: &GpuLight,
    incoming: &IncomingLight,
    brdf: impl Fn(DVec3, &dyn Fn(f64) -> f64) -> DVec3,
) -> DVec3 {
    let material = &point.material;
    let widened = incoming.sine_squared / (4.0 * point.normal.dot(point.to_eye).max(1e-3));
    let alpha = area_alpha(material);
    let spread = 1.0 + widened / (alpha * alpha);
    let covered = 1.0 - 1.0 / spread;
    let mirrored = area_mirrored(point, light, incoming, covered);
    let edge = mirrored.aside / (2.0 * alpha);
    let visible = 0.5 - 0.5 * edge / (1.0 + edge * edge).sqrt();
    let strength = (1.0 - covered + covered * visible) / spread;
    let of_coat = |alpha: f64| ((alpha * alpha + widened) / spread).min(1.0).sqrt();
    let facing = area_facing(point.normal.dot(incoming.to_light), incoming.sine_squared);
    let diffuse = facing - point.normal.dot(mirrored.direction).max(0.0) * strength;
    let albedo = material.base_color * (1.0 - material.metalness * (1.0 - material.phong_weight));
    (brdf(mirrored.direction, &of_coat) * strength + albedo * diffuse) * incoming.share
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

#[cfg(test)]
mod tests;
