// Light from everywhere, and the background. Counterpart of `src/field/light/environment.rs` and
// `environment_map.rs`. Needs `environment_map: array<u32>`; a scene with a gradient does not read it.

// Places in its header: the harmonics, the strength, the sine and cosine of the rotation, and for each
// level its size and the place of its texels.
const MAP_STRENGTH: u32 = 27u;
const MAP_ROTATION: u32 = 28u;
const MAP_SIZES: u32 = 30u;
// Images for reflections; they follow the image itself.
const ROUGH_LEVELS: u32 = 6u;

// Ambient light of a gradient: full from above, half from below.
fn environment_ambient(normal_y: f32, ambient: vec3f) -> vec3f {
    return ambient * (0.75 + 0.25 * normal_y);
}

// Background color of a gradient; `direction_y` is the height of the ray's unit direction.
fn environment_gradient(direction_y: f32, sky: vec3f, horizon: vec3f) -> vec3f {
    let height = clamp(direction_y, 0.0, 1.0);
    return mix(horizon, sky, height * (2.0 - height));
}

// The background in a direction.
fn environment_background(direction: vec3f, sky: vec3f, horizon: vec3f) -> vec3f {
    if IMAGE_LIT {
        return environment_radiance(environment_turned(direction), 0u) * environment_number(MAP_STRENGTH);
    }
    return environment_gradient(direction.y, sky, horizon);
}

fn environment_number(at: u32) -> f32 {
    return bitcast<f32>(environment_map[at]);
}

fn environment_harmonic(i: u32) -> vec3f {
    return vec3f(environment_number(3u * i), environment_number(3u * i + 1u), environment_number(3u * i + 2u));
}

// Irradiance by pi of a surface with this normal (Ramamoorthi and Hanrahan 2001).
fn environment_irradiance(normal: vec3f) -> vec3f {
    let n = environment_turned(normal);
    let linear = environment_harmonic(1u) * n.y + environment_harmonic(2u) * n.z + environment_harmonic(3u) * n.x;
    let mixed = environment_harmonic(4u) * (n.x * n.y) + environment_harmonic(5u) * (n.y * n.z)
        + environment_harmonic(7u) * (n.x * n.z);
    let squares = environment_harmonic(6u) * (3.0 * n.z * n.z - 1.0)
        + environment_harmonic(8u) * (n.x * n.x - n.y * n.y);
    return max(environment_harmonic(0u) + linear + mixed + squares, vec3f(0.0));
}

// Radiance around a direction, blurred as by a reflection of this roughness.
fn environment_reflected(direction: vec3f, roughness: f32) -> vec3f {
    let at = pow(clamp(roughness, 0.0, 1.0), 2.0 / 3.0) * f32(ROUGH_LEVELS - 1u);
    let below = min(u32(at), ROUGH_LEVELS - 2u);
    let turned = environment_turned(direction);
    let smooth_part = environment_radiance(turned, below + 1u);
    let rough_part = environment_radiance(turned, below + 2u);
    return mix(smooth_part, rough_part, at - f32(below)) * environment_number(MAP_STRENGTH);
}

// A world direction in the map's space.
fn environment_turned(direction: vec3f) -> vec3f {
    let sine = environment_number(MAP_ROTATION);
    let cosine = environment_number(MAP_ROTATION + 1u);
    return vec3f(
        cosine * direction.x - sine * direction.z, direction.y, sine * direction.x + cosine * direction.z);
}

// The radiance of a level from a unit direction in the map's space, between the four nearest texels.
fn environment_radiance(direction: vec3f, level: u32) -> vec3f {
    let columns = environment_map[MAP_SIZES + 3u * level];
    let lines = environment_map[MAP_SIZES + 3u * level + 1u];
    let first = environment_map[MAP_SIZES + 3u * level + 2u];
    let x = (0.5 + atan2(direction.x, -direction.z) / 6.28318531) * f32(columns) - 0.5;
    let down = acos(clamp(direction.y, -1.0, 1.0)) / 3.14159265;
    let y = clamp(down * f32(lines) - 0.5, 0.0, f32(lines - 1u));
    let left = u32(floor(x) + f32(columns)) % columns;
    let right = (left + 1u) % columns;
    let above = first + u32(y) * columns;
    let below = first + min(u32(y) + 1u, lines - 1u) * columns;
    let upper = mix(environment_texel(above + left), environment_texel(above + right), fract(x));
    let lower = mix(environment_texel(below + left), environment_texel(below + right), fract(x));
    return mix(upper, lower, fract(y));
}

// 9 bits of each color, and 5 bits of their exponent.
fn environment_texel(at: u32) -> vec3f {
    let texel = environment_map[at];
    let color = vec3f(f32(texel & 511u), f32((texel >> 9u) & 511u), f32((texel >> 18u) & 511u));
    return color * exp2(f32(texel >> 27u) - 24.0);
}
