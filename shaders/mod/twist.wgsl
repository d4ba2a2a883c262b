// Twist: rotates around Y with height.

#include "generated/params/TwistParams.wgsl"
#include "mod/enclosed.wgsl"

fn mod_twist_point(p: vec3f, k: u32, q: TwistParams) -> vec3f {
    let reach = q.half + q.margin;
    let angle = q.rate * clamp(p.y, q.center - reach, q.center + reach);
    let c = cos(angle);
    let s = sin(angle);
    return vec3f(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
}

fn mod_twist_value(f: f32, p: vec3f, q: TwistParams) -> f32 {
    let away = max(length(p.xz) - q.radius, abs(p.y - q.center) - q.half);
    return mod_enclosed(f * q.slope, away, q.margin);
}
