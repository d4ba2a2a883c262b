// What arrives of the environment, between pixels with shares. Needs `shares_between`.

#include "light/occlusion.wgsl"

// See `light/occlusion_share.wgsl`; by cones alone, for samples have shares for all pixels.
fn occlusion_at(pixel: vec2u, normal: vec3f) -> vec4f {
    let slot = (shadow_settings.lights + 3u) / 4u * 4u;
    let strength = shadow_settings.occlusion_strength;
    let low = shares_between(shares_of_cones, slot);
    let high = shares_between(shares_of_cones, slot + 4u);
    var shares = array<f32, OCCLUSION_CONES>(low.x, low.y, low.z, low.w, high.x, high.y);
    var sum = vec4f(0.0);
    for (var i = 0u; i < OCCLUSION_CONES; i += 1u) {
        let cone = occlusion_cone(normal, i);
        sum += vec4f(cone.xyz, 1.0) * (cone.w * shares[i]);
    }
    let free = select(normal, normalize(sum.xyz), dot(sum.xyz, sum.xyz) > 1e-8);
    let bent = normal + (free * sum.w - normal) * strength;
    let is_known = shadow_settings.cones > 0u && dot(bent, bent) > 1e-8;
    return vec4f(
        select(normal, normalize(bent), is_known),
        select(1.0, 1.0 + (sum.w - 1.0) * strength, shadow_settings.cones > 0u),
    );
}
