//! Lights with a size against Monte Carlo integrals over their surface.

use super::super::lighting::lighting_incoming;
use super::*;
use crate::FlatLight;
use crate::light::brdf::brdf_direct;
use crate::light::lobes::{density, half_vector};
use isolith_scene::{Falloff, Light, LightKind, NodeId};

/// Samples of an integral.
const SAMPLES: usize = 4_096;

/// Numbers from 0 to 1 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.number()
    }

    fn direction(&mut self) -> DVec3 {
        let (z, turn) = (self.within([-1.0, 1.0]), self.within([0.0, 2.0 * PI]));
        let side = (1.0 - z * z).sqrt();
        DVec3::new(side * turn.cos(), side * turn.sin(), z)
    }
}

fn light(position: DVec3, direction: DVec3, kind: LightKind) -> GpuLight {
    let [x, y]: [DVec3; 2] = direction.any_orthonormal_pair().into();
    let light = Light::new(kind);
    GpuLight::new(&FlatLight { id: NodeId(1), position, direction, axes: [x, y], scale: 1.0, light }, DVec3::ZERO)
}

/// A light that does not end within the tests.
fn sphere(position: DVec3, radius: f64) -> GpuLight {
    let falloff = Falloff::InverseSquare {};
    light(position, DVec3::NEG_Z, LightKind::Point { power: 1e9, radius, falloff })
}

fn rectangle(position: DVec3, direction: DVec3, width: f64, height: f64) -> GpuLight {
    light(position, direction, LightKind::Rectangle { power: 1e9, width, height })
}

/// A shading point at the origin with its normal along +Z.
fn point(material: SurfaceMaterial, to_eye: DVec3) -> ShadingPoint {
    ShadingPoint { material, position: DVec3::ZERO, normal: DVec3::Z, to_eye }
}

/// The mean of `brdf` over the solid angle of the light, times that angle, by π: what [`reflected_by`] estimates, as
/// seen from the origin, for a light of the radiance 1.
fn integral(random: &mut Random, light: &GpuLight, point: &ShadingPoint, brdf: Brdf) -> DVec3 {
    let [middle, right, up, direction] = [light.position, light.right, light.up, light.direction].map(vector);
    let mut sum = DVec3::ZERO;
    for i in 0..SAMPLES {
        // Stratified in 64 by 64 cells.
        let x = ((i % 64) as f64 + random.number()) / 64.0;
        let y = ((i / 64) as f64 + random.number()) / 64.0;
        let (to_light, solid) = if light.kind == GpuLight::RECTANGLE {
            let offset = middle + right * (2.0 * x - 1.0) + up * (2.0 * y - 1.0);
            let area = 4.0 * right.length() * up.length();
            let facing = (-direction.dot(offset) / offset.length()).max(0.0);
            (offset.normalize(), area * facing / offset.length_squared())
        } else {
            let least = (1.0 - (f64::from(light.radius) / middle.length()).powi(2)).sqrt();
            let (cosine, turn) = (1.0 - x * (1.0 - least), 2.0 * PI * y);
            let side = (1.0 - cosine * cosine).sqrt();
            let axis = middle.normalize();
            let (a, b) = axis.any_orthonormal_pair();
            (axis * cosine + (a * turn.cos() + b * turn.sin()) * side, 2.0 * PI * (1.0 - least))
        };
        sum += brdf(point, to_light) * solid / PI;
    }
    sum / SAMPLES as f64
}

type Brdf = fn(&ShadingPoint, DVec3) -> DVec3;

/// Lambert's reflection alone.
fn lambert(point: &ShadingPoint, to_light: DVec3) -> DVec3 {
    point.material.base_color * point.normal.dot(to_light).max(0.0)
}

/// A mirror of GGX facets without Fresnel's factor (Walter et al. 2007), times the cosine times π.
fn ggx(point: &ShadingPoint, to_light: DVec3) -> DVec3 {
    let a2 = point.material.roughness.powi(4);
    let half = (point.to_eye + to_light).normalize();
    let [h, l, v] = [half, to_light, point.to_eye].map(|d| point.normal.dot(d));
    if l <= 0.0 {
        return DVec3::ZERO;
    }
    let d = a2 / (PI * (h * h * (a2 - 1.0) + 1.0).powi(2));
    let visible = 0.5 / (l * (v * v * (1.0 - a2) + a2).sqrt() + v * (l * l * (1.0 - a2) + a2).sqrt());
    DVec3::splat(PI * d * visible * l)
}

/// The estimate for a light of the radiance 1.
fn estimated(light: &GpuLight, point: &ShadingPoint, brdf: Brdf) -> DVec3 {
    let incoming = lighting_incoming(light, point.position);
    // The color of a sphere is its irradiance at 1 m.
    let radiance = if light.kind == GpuLight::RECTANGLE { 1.0 } else { f64::from(light.radius).powi(2) };
    reflected_by(point, light, &incoming, |direction, _| brdf(point, direction)) * radiance
}

/// Lights of every size at random places, many of them cut by the horizon.
fn lights(random: &mut Random, count: usize) -> Vec<GpuLight> {
    let one = |random: &mut Random, i: usize| {
        let position = random.direction() * DVec3::new(1.0, 1.0, 0.6) + DVec3::Z * 0.4;
        let size = 10.0_f64.powf(random.within([-2.0, 0.0]));
        if i.is_multiple_of(2) {
            return sphere(position, size * 0.8 * position.length());
        }
        let toward = (random.direction() * 0.8 - position).normalize();
        let height = size * random.within([0.2, 1.0]);
        rectangle(position, toward, size, height)
    };
    (0..count).map(|i| one(random, i)).collect()
}

/// The mean and the 99th percentile of errors.
fn statistics(mut errors: Vec<f64>) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    [errors.iter().sum::<f64>() / errors.len() as f64, errors[errors.len() * 99 / 100]]
}

#[test]
fn diffuse_light_of_spheres_and_rectangles_is_that_of_the_integral() {
    let mut random = Random(1);
    let white = SurfaceMaterial { base_color: DVec3::ONE, roughness: 1.0, ..SurfaceMaterial::default() };
    let mut errors = [Vec::new(), Vec::new()];
    for light in lights(&mut random, 400) {
        let point = point(white, DVec3::Z);
        let off = estimated(&light, &point, lambert).x - integral(&mut random, &light, &point, lambert).x;
        errors[usize::from(light.kind == GpuLight::RECTANGLE)].push(off.abs());
    }
    let [[mean, p99], rectangles] = errors.map(statistics);
    // Spheres are exact, up to the noise of the integral.
    assert!(mean < 1e-3 && p99 < 5e-3, "spheres: {mean} {p99}");
    // Rectangles that the horizon cuts are lit as spheres of the same size.
    let [mean, p99] = rectangles;
    assert!(mean < 2e-3 && p99 < 0.02, "rectangles: {mean} {p99}");
}

#[test]
fn highlights_are_near_those_of_the_integral() {
    let mut random = Random(2);
    // Measured, with a margin. A lobe that is narrower than the light sees its edge, which the estimate blurs.
    for (roughness, most) in [(0.1, [0.07, 0.8]), (0.3, [0.03, 0.25]), (0.6, [0.02, 0.2]), (1.0, [0.01, 0.06])] {
        let material = SurfaceMaterial { roughness, ..SurfaceMaterial::default() };
        let mut errors = Vec::new();
        for light in lights(&mut random, 600) {
            // The eye looks near the reflection of the light, where highlights are.
            let middle = vector(light.position).normalize();
            let aside = random.direction() * random.number() * roughness;
            let to_eye = (DVec3::new(-middle.x, -middle.y, middle.z.abs().max(0.15)) + aside).normalize();
            if to_eye.z < 0.1 {
                continue;
            }
            let point = point(material, to_eye);
            let truth = integral(&mut random, &light, &point, ggx).x;
            errors.push((estimated(&light, &point, ggx).x - truth).abs());
        }
        let [mean, p99] = statistics(errors);
        assert!(mean < most[0] && p99 < most[1], "{roughness}: mean {mean}, p99 {p99}");
    }
}

/// What [`integral`] gives for GGX, by samples of the lobe: for lobes that are narrow beside the light.
fn integral_by_lobe(random: &mut Random, light: &GpuLight, point: &ShadingPoint) -> f64 {
    let [middle, right, up, direction] = [light.position, light.right, light.up, light.direction].map(vector);
    let is_lit = |to_light: DVec3| {
        if light.kind != GpuLight::RECTANGLE {
            return to_light.angle_between(middle) < (f64::from(light.radius) / middle.length()).asin();
        }
        let hit = to_light * (middle.dot(direction) / to_light.dot(direction)) - middle;
        let within = |side: DVec3| hit.dot(side).abs() <= side.length_squared();
        to_light.dot(direction) < 0.0 && within(right) && within(up)
    };
    let alpha = point.material.roughness.powi(2);
    let mut sum = 0.0;
    for i in 0..SAMPLES {
        let unit = [i % 64, i / 64].map(|at| (at as f64 + random.number()) / 64.0);
        let half = half_vector(point.to_eye, alpha, unit);
        let to_light = 2.0 * point.to_eye.dot(half) * half - point.to_eye;
        if to_light.z > 0.0 && is_lit(to_light) {
            sum += ggx(point, to_light).x / PI / density(point.to_eye, alpha, to_light);
        }
    }
    sum / SAMPLES as f64
}

/// The error of highlights by roughness and by the size of the light, as a share of its radiance: the chart of
/// `benches/README.md`. Both kinds of light, near the mirrored direction.
#[test]
#[allow(clippy::print_stdout, reason = "the figures are for whoever runs this with `--nocapture`")]
fn the_chart_of_highlights_has_no_hole() {
    const ROUGHNESS: [f64; 5] = [0.1, 0.2, 0.4, 0.7, 1.0];
    // Half angles in degrees.
    const SIZES: [f64; 5] = [1.0, 4.0, 12.0, 30.0, 50.0];
    let mut random = Random(3);
    for (kind, most) in [(GpuLight::POINT, 0.12), (GpuLight::RECTANGLE, 0.12)] {
        for roughness in ROUGHNESS {
            let material = SurfaceMaterial { roughness, ..SurfaceMaterial::default() };
            let row = SIZES.map(|size| {
                let errors = (0..60).map(|_| {
                    let (slant, turn) = (random.within([0.0, 1.1]), random.within([0.0, 2.0 * PI]));
                    let middle = DVec3::new(slant.sin() * turn.cos(), slant.sin() * turn.sin(), slant.cos());
                    let aside = random.direction() * random.number() * (roughness + size.to_radians()) * 0.5;
                    let to_eye = DVec3::new(-middle.x, -middle.y, middle.z) + aside;
                    let to_eye = (to_eye * DVec3::new(1.0, 1.0, 0.0) + DVec3::Z * to_eye.z.max(0.15)).normalize();
                    let light = match kind {
                        GpuLight::POINT => sphere(middle * 3.0, 3.0 * size.to_radians().sin()),
                        _ => rectangle(
                            middle * 3.0,
                            -middle,
                            6.0 * size.to_radians().tan(),
                            3.0 * size.to_radians().tan(),
                        ),
                    };
                    let point = point(material, to_eye);
                    let truth = match roughness {
                        ..0.3 => integral_by_lobe(&mut random, &light, &point),
                        _ => integral(&mut random, &light, &point, ggx).x,
                    };
                    (estimated(&light, &point, ggx).x - truth).abs()
                });
                errors.sum::<f64>() / 60.0
            });
            println!("kind {kind}, roughness {roughness}: {row:.3?}");
            assert!(row.iter().all(|error| *error < most), "kind {kind}, roughness {roughness}: {row:?}");
        }
    }
}

#[test]
fn a_small_light_is_a_point_and_a_rectangle_is_dark_from_behind() {
    let material = SurfaceMaterial { base_color: DVec3::splat(0.5), roughness: 0.5, ..SurfaceMaterial::default() };
    let at = DVec3::new(0.3, 0.2, 2.0);
    let point = point(material, DVec3::new(0.6, 0.0, 0.8));
    let small = sphere(at, 1e-4);
    let incoming = lighting_incoming(&small, DVec3::ZERO);
    let as_point = brdf_direct(&point, at.normalize()) * incoming.share;
    assert!((area_reflected(&point, &small, &incoming) - as_point).length() < 1e-6);
    let seen = |direction: DVec3| area_rectangle(&rectangle(at, direction, 1.0, 1.0), DVec3::ZERO).share;
    assert!(seen(-at.normalize()) > 0.05 && seen(at.normalize()) == 0.0);
    // Around a point within a sphere, half of the sky of every surface is lit.
    let inside = IncomingLight { to_light: DVec3::Z, share: 1.0, sine_squared: 1.0 };
    for (cosine, meant) in [(1.0, 1.0), (0.0, 0.5), (-1.0, 0.0)] {
        assert!((area_facing(cosine, inside.sine_squared) - meant).abs() < 1e-5, "{cosine}");
    }
}
