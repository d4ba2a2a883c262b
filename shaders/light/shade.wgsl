// Color of a surface point: Lambert diffuse, Blinn-Phong highlight, ambient light.
// Needs `lights: array<Light>` and `light/material.wgsl`. All colors are linear until
// `shade_encode`.

// `position` is relative to the eye; `normal` and `to_eye` have unit length.
fn shade_surface(
    material: FlatMaterial,
    position: vec3f,
    normal: vec3f,
    to_eye: vec3f,
    ambient: vec3f,
    light_count: u32,
) -> vec3f {
    var color = material.emission + material.albedo * shade_ambient(normal.y, ambient);
    for (var i = 0u; i < light_count; i++) {
        let light = lights[i];
        let incoming = shade_incoming(light, position);
        let facing = max(dot(normal, incoming.xyz), 0.0);
        let halfway = incoming.xyz + to_eye;
        let alignment = max(dot(normal, halfway), 0.0) / max(length(halfway), 1e-6);
        let highlight = material.specular * pow(alignment, material.shininess);
        color += (material.albedo + highlight) * light.color * (facing * incoming.w);
    }
    return color;
}

// Unit vector toward the light, and the share of its light that arrives, without shadows.
fn shade_incoming(light: Light, position: vec3f) -> vec4f {
    if light.kind == LIGHT_DIRECTIONAL {
        return vec4f(-light.direction, 1.0);
    }
    let offset = light.position - position;
    let distance = length(offset);
    let to_light = offset / max(distance, 1e-6);
    var share = shade_attenuation(light, distance);
    if light.kind == LIGHT_SPOT {
        share *= smoothstep(light.cos_outer, light.cos_inner, -dot(to_light, light.direction));
    }
    return vec4f(to_light, share);
}

// Attenuation with distance; fades to zero at the light's range.
fn shade_attenuation(light: Light, distance: f32) -> f32 {
    let ratio = min(distance / light.range, 1.0);
    let window = 1.0 - ratio * ratio * ratio * ratio;
    return window * window / max(light.constant + (light.linear + light.quadratic * distance) * distance, 1e-4);
}

// Ambient light: full from above, half from below.
fn shade_ambient(normal_y: f32, ambient: vec3f) -> vec3f {
    return ambient * (0.75 + 0.25 * normal_y);
}

// Background color of a ray; `direction_y` is the height of its unit direction.
fn shade_background(direction_y: f32, sky: vec3f, horizon: vec3f) -> vec3f {
    let height = clamp(direction_y, 0.0, 1.0);
    return mix(horizon, sky, height * (2.0 - height));
}

// Encodes linear light as sRGB (IEC 61966-2-1), clamped to 0..1.
fn shade_encode(linear: vec3f) -> vec3f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}
