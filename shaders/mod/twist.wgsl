// Twist: rotates around Y with height. a: radians per meter, 1 / largest stretch, radius of the
// content, margin; b: center and half extent of the content along Y.

#include "mod/enclosed.wgsl"

fn mod_twist_point(p: vec3f, k: u32, a: vec4f, b: vec4f) -> vec3f {
    let reach = b.y + a.w;
    let angle = a.x * clamp(p.y, b.x - reach, b.x + reach);
    let c = cos(angle);
    let s = sin(angle);
    return vec3f(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
}

fn mod_twist_value(f: f32, p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let away = max(length(p.xz) - a.z, abs(p.y - b.x) - b.y);
    return mod_enclosed(f * a.y, away, a.w);
}
