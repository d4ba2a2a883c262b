// The light of a surface point: the sum over all lights, and the environment. Counterpart of
// `src/field/light/lighting.rs`. Needs `lights: array<Light>`, `shadow_share` and `occlusion_at`.
// Colors are linear.

#include "light/brdf.wgsl"
#include "light/environment.wgsl"

fn lighting_surface(point: ShadingPoint, pixel: vec2u, ambient: vec3f, light_count: u32) -> vec3f {
    let free = occlusion_at(pixel, point.normal);
    var color = point.material.emission + brdf_ambient(point) * environment_ambient(free.y, ambient) * free.w;
    for (var i = 0u; i < light_count; i++) {
        let light = lights[i];
        let incoming = lighting_incoming(light, point.position);
        color += brdf_direct(point, incoming.xyz) * light.color * (incoming.w * shadow_share(i, pixel));
    }
    return color;
}

// Unit vector toward the light, and the share of its light that arrives, without shadows.
fn lighting_incoming(light: Light, position: vec3f) -> vec4f {
    if light.kind == LIGHT_DIRECTIONAL {
        return vec4f(-light.direction, 1.0);
    }
    let offset = light.position - position;
    let distance = length(offset);
    let to_light = offset / max(distance, 1e-6);
    var share = lighting_attenuation(light, distance);
    if light.kind == LIGHT_SPOT {
        share *= smoothstep(light.cos_outer, light.cos_inner, -dot(to_light, light.direction));
    }
    return vec4f(to_light, share);
}

// Attenuation with distance; fades to zero at the light's range.
fn lighting_attenuation(light: Light, distance: f32) -> f32 {
    let ratio = min(distance / light.range, 1.0);
    let window = 1.0 - ratio * ratio * ratio * ratio;
    return window * window / max(light.constant + (light.linear + light.quadratic * distance) * distance, 1e-4);
}
