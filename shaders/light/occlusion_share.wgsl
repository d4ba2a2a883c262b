// What arrives of the environment. Needs `shadow_settings` and `shares_byte`.

#include "light/occlusion.wgsl"

// Mean free direction, and visible share of the environment. In a sample of a still picture rays correct
// the cones in whose parts of the hemisphere they lie: the mean of the samples is that of the rays, with
// less noise (a control variate, sampled where it is in doubt). The first of many samples count less. A
// single share may be below 0 or above 1.
fn occlusion_at(pixel: vec2u, normal: vec3f) -> vec4f {
    let slot = (shadow_settings.lights + 3u) / 4u * 4u;
    var sum = vec4f(0.0);
    var doubt = 0.0;
    for (var i = 0u; i < shadow_settings.cones; i += 1u) {
        let cone = occlusion_cone(normal, i);
        let share = shares_byte(pixel, slot + i);
        sum += vec4f(cone.xyz, 1.0) * (cone.w * share);
        doubt += cone.w * occlusion_doubt(share);
    }
    let free = select(normal, normalize(sum.xyz), dot(sum.xyz, sum.xyz) > 1e-8);
    let seen = select(vec4f(normal, 1.0), vec4f(free, sum.w), shadow_settings.cones > 0u);
    var off = 0.0;
    for (var i = 0u; i < OCCLUSION_RAYS; i += 1u) {
        let stored = u32(round(255.0 * shares_byte(pixel, slot + OCCLUSION_CONES + i)));
        let of_cone = shares_byte(pixel, slot + stored % OCCLUSION_FREE);
        let found = select(0.0, 1.0, stored >= OCCLUSION_FREE);
        off += (found - of_cone) * doubt / occlusion_doubt(of_cone) / f32(OCCLUSION_RAYS);
    }
    let has_ray = shadow_settings.sample > 0u && shadow_settings.cones > 0u;
    let visible = seen.w + select(0.0, off * occlusion_trust(shadow_settings.sample), has_ray);
    let bent = normal + (seen.xyz * seen.w - normal) * shadow_settings.occlusion_strength;
    return vec4f(
        select(normal, normalize(bent), dot(bent, bent) > 1e-8),
        1.0 + (visible - 1.0) * shadow_settings.occlusion_strength,
    );
}
