// The light of a surface point: the sum over all lights, and the environment. Counterpart of
// `src/field/light/lighting.rs`. Needs `lights: array<Light>`, `shadow_share` and `occlusion_at`.
// Colors are linear.

#include "light/brdf.wgsl"
#include "light/area.wgsl"
#include "light/environment.wgsl"

// `open` is the share of the environment's light that arrives through the surface's own texture.
fn lighting_surface(point: ShadingPoint, pixel: vec2u, ambient: vec3f, open: f32, light_count: u32) -> vec3f {
    let free = occlusion_at(pixel, point.normal);
    var color = point.material.emission + lighting_around(point, free.xyz, ambient) * (open * free.w);
    var next = 0u;
#if LIGHT_TILES
    // The bits of the pixel's tile; lights without one would add nothing.
    next = light_count;
    let words = light_tile_words(light_count);
    let first = light_tile_first(pixel / LIGHT_TILE, view.width, words);
    for (var word = 0u; word < words; word += 1u) {
        var bits = light_tiles[first + word];
        while bits != 0u {
            let i = 32u * word + firstTrailingBit(bits);
            bits &= bits - 1u;
            let share = shadow_share(i, pixel);
            if share > 0.0 {
                color += lighting_reflected(point, lights[i]) * share;
            }
        }
    }
#end
    for (var i = next; i < light_count; i++) {
        let share = shadow_share(i, pixel);
        if share > 0.0 {
            color += lighting_reflected(point, lights[i]) * share;
        }
    }
    return color;
}

// The light of the environment that the surface reflects toward the eye; `free` is the mean direction
// from which it arrives.
fn lighting_around(point: ShadingPoint, free: vec3f, ambient: vec3f) -> vec3f {
    if IMAGE_LIT {
        let shares = brdf_environment(point);
        return shares.diffuse * environment_irradiance(normalize(free + shares.lean))
            + shares.specular * environment_reflected(shares.dominant, shares.roughness)
            + shares.coat * environment_reflected(shares.direction, shares.coat_roughness);
    }
    return brdf_ambient(point) * environment_ambient(free.y, ambient);
}

// The light of one source that the surface reflects toward the eye, without shadows.
fn lighting_reflected(point: ShadingPoint, light: Light) -> vec3f {
    let incoming = lighting_incoming(light, point.position);
    if incoming.share <= 0.0 {
        return vec3f(0.0);
    }
    if AREA_LIGHTS {
        return area_reflected(point, light, incoming) * light.color;
    }
    return brdf_direct(point, incoming.to_light) * light.color * incoming.share;
}

// How the point meets the light, without shadows.
fn lighting_incoming(light: Light, position: vec3f) -> IncomingLight {
    if light.kind == LIGHT_DIRECTIONAL {
        return IncomingLight(-light.direction, 1.0, light.radius * light.radius);
    }
    let offset = light.position - position;
    let distance = length(offset);
    if AREA_LIGHTS && light.kind == LIGHT_RECTANGLE {
        var incoming = area_rectangle(light, position);
        incoming.share *= lighting_window(light, distance);
        return incoming;
    }
    let to_light = offset / max(distance, 1e-6);
    var share = lighting_attenuation(light, distance);
    if light.kind == LIGHT_SPOT {
        share *= smoothstep(light.cos_outer, light.cos_inner, -dot(to_light, light.direction));
    }
    let sine = min(light.radius / max(distance, 1e-6), 1.0);
    return IncomingLight(to_light, share, sine * sine);
}

// Fades to zero at the light's range.
fn lighting_window(light: Light, distance: f32) -> f32 {
    let ratio = min(distance / light.range, 1.0);
    let window = 1.0 - ratio * ratio * ratio * ratio;
    return window * window;
}

// Attenuation with distance, the same everywhere within the light; fades to zero at its range.
fn lighting_attenuation(light: Light, distance: f32) -> f32 {
    let d = max(distance, light.radius);
    return lighting_window(light, distance) / max(light.constant + (light.linear + light.quadratic * d) * d, 1e-4);
}
