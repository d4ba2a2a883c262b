// Shares between pixels that have them, while something moves: every second pixel along each axis. The four around a pixel
// count by their distance, and as far as they show the same surface: so edges stay sharp (Kopf, Cohen, Lischinski and
// Uyttendaele, "Joint Bilateral Upsampling", 2007).

// Distance from the plane of the pixel, in footprints, at which another surface hardly counts.
const SHARES_PLANE: f32 = 2.0;
// What the pixels around count at least: of no surface that is alike, the nearest stand for it.
const SHARES_LEAST: f32 = 1e-4;

var<private> shares_around: array<vec2u, 4>;
var<private> shares_weights: vec4f;

// Finds the pixels around one that shows a surface at this depth, with this unit normal.
fn shares_find(pixel: vec2u, depth: f32, normal: vec3f) {
    let first = pixel & vec2u(0xfffffffeu);
    let last = (vec2u(view.width, view.height) - 1u) & vec2u(0xfffffffeu);
    let part = 0.5 * vec2f(pixel & vec2u(1u));
    let position = view_direction(pixel) * depth;
    var weights = vec4f(0.0);
    for (var i = 0u; i < 4u; i += 1u) {
        let side = vec2u(i & 1u, i >> 1u);
        let there = min(first + 2u * side, last);
        shares_around[i] = there;
        let near = select(1.0 - part, part, side == vec2u(1u));
        let other_depth = textureLoad(depth_target, there, 0).x;
        if near.x * near.y > 0.0 && other_depth < BACKGROUND {
            let other = view_direction(there) * other_depth;
            let off = dot(other - position, normal) / (SHARES_PLANE * view.footprint * depth);
            let turn = max(dot(textureLoad(normal_target, there, 0).xyz, normal), 0.0);
            let turn_2 = turn * turn;
            let alike = turn_2 * turn_2 * exp(-off * off);
            weights[i] = near.x * near.y * max(alike, SHARES_LEAST);
        }
    }
    let whole = dot(weights, vec4f(1.0));
    shares_weights = weights / max(whole, 1e-20);
}

// A share between those around; all of it without any. The pixel is the one of `shares_find`.
fn shares_byte(pixel: vec2u, slot: u32) -> f32 {
    var sum = 1.0 - dot(shares_weights, vec4f(1.0));
    for (var i = 0u; i < 4u; i += 1u) {
        if shares_weights[i] > 0.0 {
            sum += shares_weights[i] * shares_own_byte(shares_around[i], slot);
        }
    }
    return sum;
}
