// What arrives of the lights and of the environment, as pass `shadow` left it.

#include "light/shadow_settings.wgsl"

@group(3) @binding(8) var<uniform> shadow_settings: ShadowSettings;
@group(3) @binding(9) var<storage, read> shadow_shares: array<u32>;

// The word of a pixel that holds the share of a slot.
fn shares_word(pixel: vec2u, slot: u32) -> u32 {
    return shadow_shares[(pixel.y * view.width + pixel.x) * shadow_settings.stride + slot / 4u];
}

#if SPARSE_SHARES
#include "light/sparse_shares.wgsl"
#include "light/sparse_occlusion.wgsl"
#else
#include "light/occlusion_share.wgsl"

fn shares_byte(pixel: vec2u, slot: u32) -> f32 {
    return f32(shares_word(pixel, slot) >> (8u * (slot & 3u)) & 0xffu) / 255.0;
}
#end

// The visible share of a light.
fn shadow_share(light: u32, pixel: vec2u) -> f32 {
    return select(1.0, shares_byte(pixel, light), light < shadow_settings.lights);
}
