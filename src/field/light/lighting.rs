//! The light of a surface point: the sum over all lights, and the environment. Counterpart of
//! `shaders/light/lighting.wgsl`. Colors are linear.

use glam::DVec3;

use super::area::{IncomingLight, area_rectangle, area_reflected};
use super::arriving::Arriving;
use super::brdf::ShadingPoint;
use super::environment::{EnvironmentLight, environment_on};
use crate::lights::GpuLight;

/// Color of a surface point, where the share `open` of the environment's light arrives through its own texture.
pub fn lighting_surface(
    point: &ShadingPoint,
    environment: &EnvironmentLight<'_>,
    open: f64,
    lights: &[GpuLight],
    arriving: &Arriving,
) -> DVec3 {
    let lit = |(index, light)| lighting_reflected(point, light) * arriving.shadow_share(index);
    let sum: DVec3 = lights.iter().enumerate().map(lit).sum();
    let around = environment_on(point, environment, arriving.bent) * (open * arriving.visibility);
    point.material.emission + around + sum
}

/// The light of one source that the surface reflects toward the eye, without shadows.
pub fn lighting_reflected(point: &ShadingPoint, light: &GpuLight) -> DVec3 {
    area_reflected(point, light, &lighting_incoming(light, point.position)) * vector(light.color)
}

/// How the point meets the light, without shadows.
pub fn lighting_incoming(light: &GpuLight, position: DVec3) -> IncomingLight {
    let radius = f64::from(light.radius);
    if light.kind == GpuLight::DIRECTIONAL {
        return IncomingLight { to_light: -vector(light.direction), share: 1.0, sine_squared: radius * radius };
    }
    let offset = vector(light.position) - position;
    let distance = offset.length();
    if light.kind == GpuLight::RECTANGLE {
        let incoming = area_rectangle(light, position);
        return IncomingLight { share: incoming.share * lighting_window(light, distance), ..incoming };
    }
    let to_light = offset / distance.max(1e-6);
    let mut share = lighting_attenuation(light, distance);
    if light.kind == GpuLight::SPOT {
        let (none, full) = (f64::from(light.cos_outer), f64::from(light.cos_inner));
        let x = ((-to_light.dot(vector(light.direction)) - none) / (full - none)).clamp(0.0, 1.0);
        share *= x * x * (3.0 - 2.0 * x);
    }
    let sine = (radius / distance.max(1e-6)).min(1.0);
    IncomingLight { to_light, share, sine_squared: sine * sine }
}

/// Fades to zero at the light's range.
fn lighting_window(light: &GpuLight, distance: f64) -> f64 {
    let ratio = (distance / f64::from(light.range)).min(1.0);
    (1.0 - ratio.powi(4)).powi(2)
}

/// Attenuation by distance, the same everywhere within the light; fades to zero at its range.
pub fn lighting_attenuation(light: &GpuLight, distance: f64) -> f64 {
    let d = distance.max(f64::from(light.radius));
    let [constant, linear, quadratic] = [light.constant, light.linear, light.quadratic].map(f64::from);
    lighting_window(light, distance) / (constant + (linear + quadratic * d) * d).max(1e-4)
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::lights::gpu_lights;
    use crate::mixture::SurfaceMaterial;
    use crate::{FlatLight, flatten};
    use isolith_geometry::Camera;
    use isolith_scene::{Falloff, Light, LightKind, Node, NodeKind, Scene};

    /// Gray by Blinn and Phong.
    fn gray() -> SurfaceMaterial {
        SurfaceMaterial {
            base_color: DVec3::splat(0.5),
            phong_weight: 1.0,
            phong_specular: 0.5,
            phong_shininess: 16.0,
            ..SurfaceMaterial::default()
        }
    }

    /// The power that gives a white surface the radiance 1 at 1 m.
    const POWER: f64 = 4.0 * PI * PI;

    fn light(kind: LightKind) -> GpuLight {
        let light = Light { color: [1.0, 0.5, 0.25], ..Light::new(kind) };
        let (id, position) = (isolith_scene::NodeId(1), DVec3::Y * 4.0);
        let axes = [DVec3::X, DVec3::NEG_Z];
        let flat = FlatLight { id, position, direction: DVec3::NEG_Y, axes, scale: 1.0, light };
        GpuLight::new(&flat, DVec3::Y)
    }

    /// A light without a size.
    fn point_light(falloff: Falloff) -> GpuLight {
        light(LightKind::Point { power: POWER, radius: 0.0, falloff })
    }

    fn spot_light(inner: f64, outer: f64) -> GpuLight {
        light(LightKind::Spot { power: POWER, radius: 0.0, falloff: Falloff::InverseSquare {}, inner, outer })
    }

    /// A surface without ambient light.
    fn lit(material: SurfaceMaterial, position: DVec3, normal: DVec3, to_eye: DVec3, lights: &[GpuLight]) -> DVec3 {
        let point = ShadingPoint { material, position, normal, to_eye };
        lighting_surface(&point, &EnvironmentLight::default(), 1.0, lights, &Arriving::all(normal))
    }

    /// A floor 2 below the light's height over the eye, viewed from the side.
    fn floor(lights: &[GpuLight], x: f64) -> DVec3 {
        lit(gray(), DVec3::new(x, 1.0, -2.0), DVec3::Y, DVec3::Z, lights)
    }

    #[test]
    fn a_directional_light_gives_albedo_times_color_times_cosine() {
        let sun = light(LightKind::Sun { strength: 2.0 * PI, angle: 0.0 });
        let matte = SurfaceMaterial { phong_specular: 0.0, ..gray() };
        let tilted = DVec3::new(0.0, 0.5, 0.75_f64.sqrt());
        let color = lit(matte, DVec3::ZERO, tilted, DVec3::Z, &[sun]);
        assert!((color - DVec3::new(0.5, 0.25, 0.125)).length() < 1e-7, "{color}");
        assert_eq!(lit(matte, DVec3::ZERO, DVec3::NEG_Y, DVec3::Z, &[sun]), DVec3::ZERO);
    }

    #[test]
    fn point_lights_weaken_and_end_at_their_range() {
        let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.5, quadratic: 0.25, range: 8.0 };
        let lamp = point_light(falloff);
        assert!((lighting_attenuation(&lamp, 2.0) - (1.0 - 1.0 / 256.0_f64).powi(2) / 3.0).abs() < 1e-6);
        assert_eq!(lighting_attenuation(&lamp, 8.0), 0.0);
        assert_eq!(lighting_attenuation(&lamp, 100.0), 0.0);
        let nothing = Falloff::Attenuation { constant: 0.0, linear: 0.0, quadratic: 0.0, range: 8.0 };
        assert!(lighting_attenuation(&point_light(nothing), 0.0).is_finite());
    }

    #[test]
    fn power_and_strength_are_in_watts() {
        let white = SurfaceMaterial { base_color: DVec3::ONE, phong_specular: 0.0, ..gray() };
        // Below the light by 2 m.
        let at = DVec3::Y;
        let radiance = |light: GpuLight| lit(white, at, DVec3::Y, DVec3::Y, &[light]).x;
        assert!((radiance(light(LightKind::Sun { strength: 3.0, angle: 0.0 })) - 3.0 / PI).abs() < 1e-6);
        let (power, falloff) = (1000.0, Falloff::InverseSquare {});
        for radius in [0.0, 0.5] {
            let expected = power / (4.0 * PI * 4.0) / PI;
            let point = radiance(light(LightKind::Point { power, radius, falloff }));
            assert!((point / expected - 1.0).abs() < 1e-6, "{point} {expected}");
            let spot = radiance(light(LightKind::Spot { power, radius, falloff, inner: 20.0, outer: 30.0 }));
            assert_eq!(spot, point);
        }
        // A small rectangle has the power of a Lambert emitter.
        let rectangle = radiance(light(LightKind::Rectangle { power, width: 0.01, height: 0.02 }));
        assert!((rectangle / (power / (PI * 4.0) / PI) - 1.0).abs() < 1e-4, "{rectangle}");
    }

    #[test]
    fn spots_are_full_within_and_dark_without() {
        for (inner, outer) in [(20.0, 30.0), (30.0, 30.0), (0.0, 0.0)] {
            let spot = spot_light(inner, outer);
            let share = |degrees: f64| {
                let (s, c) = degrees.to_radians().sin_cos();
                lighting_incoming(&spot, vector(spot.position) + DVec3::new(s, -c, 0.0)).share
            };
            if inner > 1.0 {
                assert!((share(inner - 1.0) - lighting_attenuation(&spot, 1.0)).abs() < 1e-12);
            }
            assert_eq!(share(outer + 1.0), 0.0);
        }
        let below = floor(&[spot_light(60.0, 70.0)], 0.1).x;
        assert!(below > 0.04, "{below}");
    }

    #[test]
    fn a_scene_without_lights_is_not_black_and_one_with_lights_keeps_its_own() {
        let camera = Camera::looking_at(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, 0.7);
        let mut scene = Scene::new();
        let studio = gpu_lights(&flatten(&scene, 0.0).unwrap(), &camera, [64, 64]);
        let facing = (camera.position).normalize();
        let color = lit(gray(), -camera.position, facing, facing, &studio);
        assert!(color.min_element() > 0.1, "{color}");
        scene.insert(None, 0, Node::new("Sun", NodeKind::Light(Light::sun()))).unwrap();
        let own = gpu_lights(&flatten(&scene, 0.0).unwrap(), &camera, [64, 64]);
        assert_eq!((own.len(), own[0].direction), (1, [0.0, 0.0, -1.0]));
    }
}
