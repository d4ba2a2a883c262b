// Shares between pixels that have them, while something moves: one in a few along each axis, for occlusion in more. The
// four around a pixel count by their distance, and as far as they show the same surface: so edges stay sharp (Kopf, Cohen,
// Lischinski and Uyttendaele, "Joint Bilateral Upsampling", 2007).

// Distance from the plane of the pixel at which another surface hardly counts, in footprints of the pixels from one with
// shares to the next.
const SHARES_PLANE: f32 = 1.0;
// What the pixels around count at least: of no surface that is alike, the nearest stand for it.
const SHARES_LEAST: f32 = 1e-4;

// The pixels with shares around one, and what they count; nothing where no surface is.
struct SharesAround {
    pixels: array<vec2u, 4>,
    weights: vec4f,
}

var<private> shares_of_lights: SharesAround;
var<private> shares_of_cones: SharesAround;

// Those around a pixel that shows a surface at this depth, with this unit normal. One in `spacing`, a power of two, along
// each axis has shares.
fn shares_around(pixel: vec2u, depth: f32, normal: vec3f, spacing: u32) -> SharesAround {
    var around: SharesAround;
    let first = pixel & vec2u(~(spacing - 1u));
    let last = (vec2u(view.width, view.height) - 1u) & vec2u(~(spacing - 1u));
    let part = vec2f(pixel - first) / f32(spacing);
    let position = view_direction(pixel) * depth;
    let thin = 1.0 / (SHARES_PLANE * f32(spacing) * view.footprint * depth);
    for (var i = 0u; i < 4u; i += 1u) {
        let side = vec2u(i & 1u, i >> 1u);
        let there = min(first + spacing * side, last);
        around.pixels[i] = there;
        let near = select(1.0 - part, part, side == vec2u(1u));
        let other_depth = textureLoad(depth_target, there, 0).x;
        let off = dot(view_direction(there) * other_depth - position, normal) * thin;
        let turn = max(dot(textureLoad(normal_target, there, 0).xyz, normal), 0.0);
        let turn_2 = turn * turn;
        let alike = max(turn_2 * turn_2 * exp(-min(off * off, 80.0)), SHARES_LEAST);
        around.weights[i] = select(0.0, near.x * near.y * alike, other_depth < BACKGROUND);
    }
    around.weights /= max(dot(around.weights, vec4f(1.0)), 1e-20);
    return around;
}

fn shares_find(pixel: vec2u, depth: f32, normal: vec3f) {
    shares_of_lights = shares_around(pixel, depth, normal, shadow_settings.spacing);
    shares_of_cones = shares_around(pixel, depth, normal, shadow_settings.cone_spacing);
}

// The four shares of a word between the pixels around; all of them without any.
fn shares_between(around: SharesAround, slot: u32) -> vec4f {
    var sum = vec4f(1.0 - dot(around.weights, vec4f(1.0)));
    for (var i = 0u; i < 4u; i += 1u) {
        sum += around.weights[i] * unpack4x8unorm(shares_word(around.pixels[i], slot));
    }
    return sum;
}

// The share of a light. The pixel is the one of `shares_find`.
fn shares_byte(pixel: vec2u, slot: u32) -> f32 {
    return shares_between(shares_of_lights, slot)[slot & 3u];
}
