//! The lights of a scene as the GPU and the reference renderer read them.

use std::f64::consts::PI;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::arrays::{FlatLight, FlatScene};
use super::studio::StudioLight;
use isolith_geometry::{Aabb, Camera};
use isolith_scene::{Falloff, LightKind};

/// Radiance of a white surface below which a light ends. Within its range a light is weaker than by the inverse square
/// of the distance by at most 1.1 times as much: it fades to zero there.
pub const LEAST_LIGHT: f64 = 1e-3;

/// A light as the GPU reads it, relative to the eye; `shaders/common/light.wgsl` is its counterpart.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuLight {
    /// Position of its middle relative to the eye.
    pub position: [f32; 3],
    /// One of [`GpuLight::DIRECTIONAL`], [`GpuLight::POINT`], [`GpuLight::SPOT`], [`GpuLight::RECTANGLE`].
    pub kind: u32,
    /// Unit direction in which the light travels.
    pub direction: [f32; 3],
    /// Distance beyond which it lights nothing.
    pub range: f32,
    /// Of a sun and lights from a sphere: irradiance by π, at 1 m. Of a rectangle: radiance. Linear.
    pub color: [f32; 3],
    /// Of the sphere; of a sun the sine of half its angular diameter.
    pub radius: f32,
    /// From the middle of a rectangle to its right side.
    pub right: [f32; 3],
    /// Cosine of the half angle of full intensity of a spot; always above `cos_outer`.
    pub cos_inner: f32,
    /// From the middle of a rectangle to its upper side.
    pub up: [f32; 3],
    /// Cosine of the half angle at which a spot has faded out.
    pub cos_outer: f32,
    /// Constant term of the attenuation.
    pub constant: f32,
    /// Linear term of the attenuation, per meter.
    pub linear: f32,
    /// Quadratic term of the attenuation, per square meter.
    pub quadratic: f32,
    /// 1 if it casts shadows.
    pub cast_shadows: u32,
}

impl GpuLight {
    /// Parallel light.
    pub const DIRECTIONAL: u32 = 0;
    /// Light from a sphere in all directions.
    pub const POINT: u32 = 1;
    /// Light from a sphere into a cone.
    pub const SPOT: u32 = 2;
    /// Light from one side of a rectangle.
    pub const RECTANGLE: u32 = 3;

    /// The light as seen from `eye`.
    pub fn new(light: &FlatLight, eye: DVec3) -> Self {
        let placed = Self {
            position: (light.position - eye).as_vec3().to_array(),
            direction: light.direction.as_vec3().to_array(),
            cast_shadows: light.light.cast_shadows.into(),
            range: 1.0,
            constant: 1.0,
            cos_outer: -1.0,
            ..Self::zeroed()
        };
        let color = DVec3::from(light.light.color);
        match light.light.light {
            LightKind::Sun { strength, angle } => Self {
                kind: Self::DIRECTIONAL,
                color: (color * (strength / PI)).as_vec3().to_array(),
                radius: (angle * 0.5).to_radians().sin() as f32,
                ..placed
            },
            LightKind::Point { power, radius, falloff } => {
                let radius = radius * light.scale;
                Self { kind: Self::POINT, ..placed }.with_sphere(color * (power / (4.0 * PI * PI)), radius, falloff)
            }
            LightKind::Spot { power, radius, falloff, inner, outer } => {
                let cos_outer = outer.to_radians().cos();
                let spot = Self {
                    kind: Self::SPOT,
                    // A cone with a hard edge still needs a width for the fade to be defined.
                    cos_inner: inner.to_radians().cos().max(cos_outer + 1e-4) as f32,
                    cos_outer: cos_outer as f32,
                    ..placed
                };
                spot.with_sphere(color * (power / (4.0 * PI * PI)), radius * light.scale, falloff)
            }
            LightKind::Rectangle { power, width, height } => {
                placed.with_rectangle(color * power, light.axes[0] * (width * 0.5), light.axes[1] * (height * 0.5))
            }
        }
    }

    fn with_sphere(self, color: DVec3, radius: f64, falloff: Falloff) -> Self {
        let (range, [constant, linear, quadratic]) = match falloff {
            Falloff::InverseSquare {} => (radius + reach(color), [0.0, 0.0, 1.0]),
            Falloff::Attenuation { constant, linear, quadratic, range } => (range, [constant, linear, quadratic]),
        };
        Self {
            color: color.as_vec3().to_array(),
            radius: radius as f32,
            range: range as f32,
            constant: constant as f32,
            linear: linear as f32,
            quadratic: quadratic as f32,
            ..self
        }
    }

    /// `color` times the emitted power; from the middle to the right and to the upper side.
    fn with_rectangle(self, color: DVec3, right: DVec3, up: DVec3) -> Self {
        // Groups with different scales along their axes may skew it.
        let up = up - right * (up.dot(right) / right.length_squared().max(1e-300));
        let area = 4.0 * right.length() * up.length();
        let normal = right.cross(up).normalize_or(DVec3::Z);
        let along = if normal.dot(DVec3::from(self.direction.map(f64::from))) < 0.0 { -normal } else { normal };
        Self {
            kind: Self::RECTANGLE,
            direction: along.as_vec3().to_array(),
            right: right.as_vec3().to_array(),
            up: up.as_vec3().to_array(),
            color: (color / (PI * area.max(1e-12))).as_vec3().to_array(),
            range: ((right + up).length() + reach(color / (PI * PI))) as f32,
            ..self
        }
    }

    fn directional(direction: DVec3, color: DVec3) -> Self {
        Self {
            kind: Self::DIRECTIONAL,
            direction: direction.normalize().as_vec3().to_array(),
            color: color.as_vec3().to_array(),
            range: 1.0,
            constant: 1.0,
            cast_shadows: 1,
            ..Self::zeroed()
        }
    }

    /// Whether it has a size, so that shading needs the formulas for area lights.
    pub fn has_size(&self) -> bool {
        self.radius > 0.0 || self.kind == Self::RECTANGLE
    }
}

/// The distance at which a light that gives a white surface the radiance `color` at 1 m gives it [`LEAST_LIGHT`].
fn reach(color: DVec3) -> f64 {
    (color.max_element() / LEAST_LIGHT).sqrt().max(1e-6)
}

/// The lights that may reach what the camera sees in a picture of `size` pixels, as seen from the camera. A scene
/// without lights, and without an image or color around it, gets the lights of a
/// studio, which are fixed to the viewer.
pub fn gpu_lights(flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Vec<GpuLight> {
    if flat.lights.is_empty() && flat.environment_map.is_none() {
        let light = |(direction, color, radius): &StudioLight| GpuLight {
            radius: *radius as f32,
            ..GpuLight::directional(camera.rotation * DVec3::from(*direction), DVec3::from(*color))
        };
        return flat.studio.lights().iter().map(light).collect();
    }
    let sides = view_sides(camera, size);
    let lights = flat.lights.iter().map(|light| GpuLight::new(light, camera.position));
    let mut lights: Vec<_> =
        lights.filter(|light| may_reach(light, &sides, camera) && meets_content(flat, light, &sides, camera)).collect();
    // Those with shadows first: shares exist for these alone.
    lights.sort_by_key(|light| 1 - light.cast_shadows);
    lights
}

/// Unit normals, inward, of the planes through the eye that bound the view: its four sides, and the plane before the
/// eye.
fn view_sides(camera: &Camera, [width, height]: [u32; 2]) -> [DVec3; 5] {
    let tan = camera.tan_half_fov();
    let wide = tan * f64::from(width) / f64::from(height);
    let inward = |x: f64, y: f64, z: f64| camera.rotation * DVec3::new(x, y, z).normalize();
    [
        inward(1.0, 0.0, -wide),
        inward(-1.0, 0.0, -wide),
        inward(0.0, 1.0, -tan),
        inward(0.0, -1.0, -tan),
        inward(0.0, 0.0, -1.0),
    ]
}

/// Whether the light's range meets the view.
fn may_reach(light: &GpuLight, sides: &[DVec3; 5], camera: &Camera) -> bool {
    if light.color == [0.0; 3] {
        return false;
    }
    if light.kind == GpuLight::DIRECTIONAL {
        return true;
    }
    let position = DVec3::from(light.position.map(f64::from));
    // More than rounding moves it.
    let range = f64::from(light.range) * 1.001 + position.length() * 1e-5;
    position.length() - range < camera.far && sides.iter().all(|side| side.dot(position) > -range)
}

/// Whether the light's range meets bounds of something that is in view. Meshes may be anywhere: their bounds are not
/// known here.
fn meets_content(flat: &FlatScene, light: &GpuLight, sides: &[DVec3; 5], camera: &Camera) -> bool {
    if light.kind == GpuLight::DIRECTIONAL || !flat.meshes.is_empty() || flat.components.is_empty() {
        return true;
    }
    let position = DVec3::from(light.position.map(f64::from));
    let range = f64::from(light.range) * 1.001 + position.length() * 1e-5;
    let center = camera.position + position;
    let meets = |bounds: &Aabb| {
        let (middle, half) = (bounds.center() - camera.position, bounds.half());
        let is_seen = |side: &DVec3| side.dot(middle) + side.abs().dot(half) >= 0.0;
        bounds.distance(center) <= range && (!bounds.is_finite() || sides.iter().all(is_seen))
    };
    let hierarchy = flat.hierarchy();
    let meets_unbounded = hierarchy.unbounded.iter().any(|item| {
        let component = &flat.components[*item as usize];
        let height = |[x, y, z, d]: [f64; 4]| DVec3::new(x, y, z).dot(center - component.origin) + d;
        component.half_space.map_or(0.0, height) <= range
    });
    if meets_unbounded || flat.instancers.iter().any(|instancer| meets(&instancer.world_bounds())) {
        return true;
    }
    let mut open: Vec<usize> = (0..hierarchy.nodes.len().min(1)).collect();
    while let Some(index) = open.pop() {
        let node = &hierarchy.nodes[index];
        if !meets(&node.bounds) {
            continue;
        }
        if node.is_leaf() {
            return true;
        }
        open.extend([node.link as usize, index + 1]);
    }
    false
}

#[cfg(test)]
mod tests;
