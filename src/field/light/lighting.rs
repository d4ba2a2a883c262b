//! The light of a surface point: the sum over all lights, and the environment. Counterpart of
//! `shaders/light/lighting.wgsl`. Colors are linear.

use glam::DVec3;

use super::arriving::Arriving;
use super::brdf::{ShadingPoint, brdf_ambient, brdf_direct};
use super::environment::environment_ambient;
use crate::lights::GpuLight;

/// Color of a surface point.
pub fn lighting_surface(point: &ShadingPoint, ambient: DVec3, lights: &[GpuLight], arriving: &Arriving) -> DVec3 {
    let ambient = environment_ambient(arriving.bent.y, ambient) * arriving.visibility;
    let mut color = point.material.emission + brdf_ambient(point) * ambient;
    for (index, light) in lights.iter().enumerate() {
        let (to_light, share) = lighting_incoming(light, point.position);
        color += brdf_direct(point, to_light) * vector(light.color) * (share * arriving.shadow_share(index));
    }
    color
}

/// Unit vector toward the light, and the fraction of the light that arrives without shadows.
pub fn lighting_incoming(light: &GpuLight, position: DVec3) -> (DVec3, f64) {
    if light.kind == GpuLight::DIRECTIONAL {
        return (-vector(light.direction), 1.0);
    }
    let offset = vector(light.position) - position;
    let distance = offset.length();
    let to_light = offset / distance.max(1e-6);
    let mut share = lighting_attenuation(light, distance);
    if light.kind == GpuLight::SPOT {
        let (none, full) = (f64::from(light.cos_outer), f64::from(light.cos_inner));
        let x = ((-to_light.dot(vector(light.direction)) - none) / (full - none)).clamp(0.0, 1.0);
        share *= x * x * (3.0 - 2.0 * x);
    }
    (to_light, share)
}

/// Attenuation by distance; fades to zero at the light's range.
pub fn lighting_attenuation(light: &GpuLight, distance: f64) -> f64 {
    let ratio = (distance / f64::from(light.range)).min(1.0);
    let window = 1.0 - ratio.powi(4);
    let [constant, linear, quadratic] = [light.constant, light.linear, light.quadratic].map(f64::from);
    window * window / (constant + (linear + quadratic * distance) * distance).max(1e-4)
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::gpu_lights;
    use crate::mixture::SurfaceMaterial;
    use crate::{FlatLight, flatten};
    use isolith_geometry::Camera;
    use isolith_scene::{Attenuation, Light, LightKind, Node, NodeKind, Scene};

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

    fn light(kind: LightKind) -> GpuLight {
        let light = Light { color: [1.0, 0.5, 0.25], intensity: 2.0, light: kind };
        let flat = FlatLight { id: isolith_scene::NodeId(1), position: DVec3::Y * 4.0, direction: DVec3::NEG_Y, light };
        GpuLight::new(&flat, DVec3::Y)
    }

    /// A surface without ambient light.
    fn lit(material: SurfaceMaterial, position: DVec3, normal: DVec3, to_eye: DVec3, lights: &[GpuLight]) -> DVec3 {
        let point = ShadingPoint { material, position, normal, to_eye };
        lighting_surface(&point, DVec3::ZERO, lights, &Arriving::all(normal))
    }

    /// A floor 2 below the light's height over the eye, viewed from the side.
    fn floor(lights: &[GpuLight], x: f64) -> DVec3 {
        lit(gray(), DVec3::new(x, 1.0, -2.0), DVec3::Y, DVec3::Z, lights)
    }

    #[test]
    fn a_directional_light_gives_albedo_times_color_times_cosine() {
        let sun = light(LightKind::Sun {});
        let matte = SurfaceMaterial { phong_specular: 0.0, ..gray() };
        let tilted = DVec3::new(0.0, 0.5, 0.75_f64.sqrt());
        let color = lit(matte, DVec3::ZERO, tilted, DVec3::Z, &[sun]);
        assert!((color - DVec3::new(0.5, 0.25, 0.125)).length() < 1e-7, "{color}");
        assert_eq!(lit(matte, DVec3::ZERO, DVec3::NEG_Y, DVec3::Z, &[sun]), DVec3::ZERO);
    }

    #[test]
    fn point_lights_weaken_and_end_at_their_range() {
        let attenuation = Attenuation { constant: 1.0, linear: 0.5, quadratic: 0.25, range: 8.0 };
        let lamp = light(LightKind::Point { attenuation });
        assert!((lighting_attenuation(&lamp, 2.0) - (1.0 - 1.0 / 256.0_f64).powi(2) / 3.0).abs() < 1e-6);
        assert_eq!(lighting_attenuation(&lamp, 8.0), 0.0);
        assert_eq!(lighting_attenuation(&lamp, 100.0), 0.0);
        let nothing = Attenuation { constant: 0.0, linear: 0.0, quadratic: 0.0, range: 8.0 };
        assert!(lighting_attenuation(&light(LightKind::Point { attenuation: nothing }), 0.0).is_finite());
    }

    #[test]
    fn spots_are_full_within_and_dark_without() {
        for (inner, outer) in [(20.0, 30.0), (30.0, 30.0), (0.0, 0.0)] {
            let spot = light(LightKind::Spot { attenuation: Attenuation::default(), inner, outer });
            let share = |degrees: f64| {
                let (s, c) = degrees.to_radians().sin_cos();
                lighting_incoming(&spot, vector(spot.position) + DVec3::new(s, -c, 0.0)).1
            };
            if inner > 1.0 {
                assert_eq!(share(inner - 1.0), lighting_attenuation(&spot, 1.0));
            }
            assert_eq!(share(outer + 1.0), 0.0);
        }
        assert!(
            floor(&[light(LightKind::Spot { attenuation: Attenuation::default(), inner: 60.0, outer: 70.0 })], 0.1).x
                > 0.1
        );
    }

    #[test]
    fn a_scene_without_lights_is_not_black_and_one_with_lights_keeps_its_own() {
        let camera = Camera::looking_at(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, 0.7);
        let mut scene = Scene::new();
        let studio = gpu_lights(&flatten(&scene, 0.0).unwrap(), &camera);
        let facing = (camera.position).normalize();
        let color = lit(gray(), -camera.position, facing, facing, &studio);
        assert!(color.min_element() > 0.1, "{color}");
        scene.insert(None, 0, Node::new("Sun", NodeKind::Light(Light::sun()))).unwrap();
        let own = gpu_lights(&flatten(&scene, 0.0).unwrap(), &camera);
        assert_eq!((own.len(), own[0].direction), (1, [0.0, 0.0, -1.0]));
    }
}
