//! Lighting of surfaces, in f64, with the same parameters and formulas as `shaders/light/shade.wgsl`. Colors are
//! linear until [`shade_encode`].

use glam::DVec3;

use crate::eval::SurfaceMaterial;
use crate::lights::GpuLight;

/// Color of a surface point: Lambert's diffuse term, Blinn and Phong's highlight, ambient light. `position` is
/// relative to the eye; `normal` and `to_eye` have unit length.
pub fn shade_surface(
    material: &SurfaceMaterial,
    position: DVec3,
    normal: DVec3,
    to_eye: DVec3,
    ambient: DVec3,
    lights: &[GpuLight],
) -> DVec3 {
    let mut color = material.emission + material.albedo * shade_ambient(normal.y, ambient);
    for light in lights {
        let (to_light, share) = shade_incoming(light, position);
        let facing = normal.dot(to_light).max(0.0);
        let halfway = to_light + to_eye;
        let alignment = normal.dot(halfway).max(0.0) / halfway.length().max(1e-6);
        let highlight = material.specular * alignment.powf(material.shininess);
        color += (material.albedo + highlight) * vector(light.color) * (facing * share);
    }
    color
}

/// Unit vector toward the light, and the fraction of the light that arrives without shadows.
pub fn shade_incoming(light: &GpuLight, position: DVec3) -> (DVec3, f64) {
    if light.kind == GpuLight::DIRECTIONAL {
        return (-vector(light.direction), 1.0);
    }
    let offset = vector(light.position) - position;
    let distance = offset.length();
    let to_light = offset / distance.max(1e-6);
    let mut share = shade_attenuation(light, distance);
    if light.kind == GpuLight::SPOT {
        let (none, full) = (f64::from(light.cos_outer), f64::from(light.cos_inner));
        let x = ((-to_light.dot(vector(light.direction)) - none) / (full - none)).clamp(0.0, 1.0);
        share *= x * x * (3.0 - 2.0 * x);
    }
    (to_light, share)
}

/// Attenuation by distance; fades to zero at the light's range.
pub fn shade_attenuation(light: &GpuLight, distance: f64) -> f64 {
    let ratio = (distance / f64::from(light.range)).min(1.0);
    let window = 1.0 - ratio.powi(4);
    let [constant, linear, quadratic] = [light.constant, light.linear, light.quadratic].map(f64::from);
    window * window / (constant + (linear + quadratic * distance) * distance).max(1e-4)
}

/// Ambient light: full from above, half from below.
pub fn shade_ambient(normal_y: f64, ambient: DVec3) -> DVec3 {
    ambient * (0.75 + 0.25 * normal_y)
}

/// Color of a ray without a hit; `direction_y` is the height of its unit direction.
pub fn shade_background(direction_y: f64, sky: DVec3, horizon: DVec3) -> DVec3 {
    let height = direction_y.clamp(0.0, 1.0);
    horizon.lerp(sky, height * (2.0 - height))
}

/// Encodes linear light for a screen (IEC 61966-2-1), clamped to 0..1.
pub fn shade_encode(linear: DVec3) -> DVec3 {
    linear
        .clamp(DVec3::ZERO, DVec3::ONE)
        .map(|c| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 })
}

/// The inverse of [`shade_encode`]: decodes a byte of a texture.
pub fn shade_decode(encoded: DVec3) -> DVec3 {
    encoded.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::gpu_lights;
    use crate::{FlatLight, flatten};
    use isolith_geometry::Camera;
    use isolith_scene::{Attenuation, Light, LightKind, Node, NodeKind, Scene};

    const GRAY: SurfaceMaterial =
        SurfaceMaterial { albedo: DVec3::splat(0.5), specular: 0.5, emission: DVec3::ZERO, shininess: 16.0 };

    fn light(kind: LightKind) -> GpuLight {
        let light = Light { color: [1.0, 0.5, 0.25], intensity: 2.0, light: kind };
        let flat = FlatLight { id: isolith_scene::NodeId(1), position: DVec3::Y * 4.0, direction: DVec3::NEG_Y, light };
        GpuLight::new(&flat, DVec3::Y)
    }

    /// A floor 2 below the light's height over the eye, viewed from the side.
    fn floor(lights: &[GpuLight], x: f64) -> DVec3 {
        shade_surface(&GRAY, DVec3::new(x, 1.0, -2.0), DVec3::Y, DVec3::Z, DVec3::ZERO, lights)
    }

    #[test]
    fn a_directional_light_gives_albedo_times_color_times_cosine() {
        let sun = light(LightKind::Sun {});
        let matte = SurfaceMaterial { specular: 0.0, ..GRAY };
        let tilted = DVec3::new(0.0, 0.5, 0.75_f64.sqrt());
        let color = shade_surface(&matte, DVec3::ZERO, tilted, DVec3::Z, DVec3::ZERO, &[sun]);
        assert!((color - DVec3::new(0.5, 0.25, 0.125)).length() < 1e-7, "{color}");
        assert_eq!(shade_surface(&matte, DVec3::ZERO, DVec3::NEG_Y, DVec3::Z, DVec3::ZERO, &[sun]), DVec3::ZERO);
    }

    #[test]
    fn point_lights_weaken_and_end_at_their_range() {
        let attenuation = Attenuation { constant: 1.0, linear: 0.5, quadratic: 0.25, range: 8.0 };
        let lamp = light(LightKind::Point { attenuation });
        assert!((shade_attenuation(&lamp, 2.0) - (1.0 - 1.0 / 256.0_f64).powi(2) / 3.0).abs() < 1e-6);
        assert_eq!(shade_attenuation(&lamp, 8.0), 0.0);
        assert_eq!(shade_attenuation(&lamp, 100.0), 0.0);
        let nothing = Attenuation { constant: 0.0, linear: 0.0, quadratic: 0.0, range: 8.0 };
        assert!(shade_attenuation(&light(LightKind::Point { attenuation: nothing }), 0.0).is_finite());
    }

    #[test]
    fn spots_are_full_within_and_dark_without() {
        for (inner, outer) in [(20.0, 30.0), (30.0, 30.0), (0.0, 0.0)] {
            let spot = light(LightKind::Spot { attenuation: Attenuation::default(), inner, outer });
            let share = |degrees: f64| {
                let (s, c) = degrees.to_radians().sin_cos();
                shade_incoming(&spot, vector(spot.position) + DVec3::new(s, -c, 0.0)).1
            };
            if inner > 1.0 {
                assert_eq!(share(inner - 1.0), shade_attenuation(&spot, 1.0));
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
        let color = shade_surface(&GRAY, -camera.position, facing, facing, DVec3::ZERO, &studio);
        assert!(color.min_element() > 0.1, "{color}");
        scene.insert(None, 0, Node::new("Sun", NodeKind::Light(Light::sun()))).unwrap();
        let own = gpu_lights(&flatten(&scene, 0.0).unwrap(), &camera);
        assert_eq!((own.len(), own[0].direction), (1, [0.0, 0.0, -1.0]));
    }

    #[test]
    fn encoding_is_undone_by_decoding() {
        for i in 0..=100 {
            let c = DVec3::splat(f64::from(i) / 100.0);
            assert!((shade_decode(shade_encode(c)) - c).length() < 1e-4);
        }
        let clamped = shade_encode(DVec3::new(-1.0, 2.0, 0.0));
        assert!((clamped - DVec3::Y).length() < 1e-12, "{clamped}");
    }
}
