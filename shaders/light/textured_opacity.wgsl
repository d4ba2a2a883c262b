// The opacity that a texture gives, see `light/texture.wgsl`, at `veil_seen`.

#include "light/textured.wgsl"

const OPACITY_SLOT: u32 = 4u;

// The opacity of the entry at `index`, `own` without a texture of it, read by `detail` footprints.
fn textured_opacity(own: f32, index: u32, detail: f32) -> f32 {
    let placed = placed_textures[index];
    if placed.textures == TEXTURE_NONE {
        return own;
    }
    let texture = texture_sets[placed.textures].slots[OPACITY_SLOT];
    if texture.kind == 0u {
        return own;
    }
    var there = veil_seen;
    if placed.copied_by > 0u {
        there = veil_there;
    }
    let rows = mat3x3f(placed.rows[0].xyz, placed.rows[1].xyz, placed.rows[2].xyz);
    let axes = mat3x3f(normalize(rows[0]), normalize(rows[1]), normalize(rows[2]));
    let shift = vec3f(placed.rows[0].w, placed.rows[1].w, placed.rows[2].w);
    let normal = normalize(there.normal * axes);
    let at = texture_wrapped(there.position * rows + shift - texture_repeated(placed, there.position));
    let weights = texture_weights(normal, texture_sets[placed.textures].sharpness);
    let sample = TextureSample(at, there.across * rows * detail, there.along * rows * detail, normal, weights);
    return clamp(textured_value(texture, sample, false).x, 0.0, 1.0);
}
