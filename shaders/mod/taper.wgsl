// Taper: scales the width with height. a: change of width per meter, 1 / largest stretch, margin;
// b: center of the bounds, least height of the content; c: half extent, greatest height.

#include "mod/enclosed.wgsl"

fn mod_taper_point(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f) -> vec3f {
    let width = 1.0 + a.x * clamp(p.y, b.w, c.w);
    return vec3f(p.x / width, p.y, p.z / width);
}

fn mod_taper_value(f: f32, p: vec3f, a: vec4f, b: vec4f, c: vec4f) -> f32 {
    let q = abs(p - b.xyz) - c.xyz;
    return mod_enclosed(f * a.y, max(max(q.x, q.y), q.z), a.z);
}
