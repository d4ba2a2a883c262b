// What arrives of the environment. Needs `shadow_settings` and `shares_byte`.

#include "light/occlusion.wgsl"

// Mean free direction, and visible share of the environment.
fn occlusion_at(pixel: vec2u, normal: vec3f) -> vec4f {
    var sum = vec4f(0.0);
    for (var i = 0u; i < shadow_settings.cones; i += 1u) {
        let cone = occlusion_cone(normal, i);
        sum += vec4f(cone.xyz, 1.0) * (cone.w * shares_byte(pixel, (shadow_settings.lights + 3u) / 4u * 4u + i));
    }
    let free = select(normal, normalize(sum.xyz), dot(sum.xyz, sum.xyz) > 1e-8);
    let seen = select(vec4f(normal, 1.0), vec4f(free, sum.w), shadow_settings.cones > 0u);
    let bent = normal + (seen.xyz * seen.w - normal) * shadow_settings.occlusion_strength;
    return vec4f(
        select(normal, normalize(bent), dot(bent, bent) > 1e-8),
        1.0 + (seen.w - 1.0) * shadow_settings.occlusion_strength,
    );
}
