// What arrives of the lights and of the environment, as pass `shadow` left it.

#include "light/shadow_settings.wgsl"
#include "light/occlusion_share.wgsl"

@group(3) @binding(8) var<uniform> shadow_settings: ShadowSettings;
@group(3) @binding(9) var<storage, read> shadow_shares: array<u32>;

fn shares_own_byte(pixel: vec2u, slot: u32) -> f32 {
    let at = (pixel.y * view.width + pixel.x) * shadow_settings.stride;
    return f32(shadow_shares[at + slot / 4u] >> (8u * (slot & 3u)) & 0xffu) / 255.0;
}

#if SPARSE_SHARES
#include "light/sparse_shares.wgsl"
#end
#if FULL_SHARES
fn shares_byte(pixel: vec2u, slot: u32) -> f32 {
    return shares_own_byte(pixel, slot);
}

#end

// The visible share of a light.
fn shadow_share(light: u32, pixel: vec2u) -> f32 {
    return select(1.0, shares_byte(pixel, light), light < shadow_settings.lights);
}
