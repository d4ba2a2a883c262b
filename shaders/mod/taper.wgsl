// Taper: scales the width with height.

#include "generated/params/TaperParams.wgsl"
#include "mod/enclosed.wgsl"

fn mod_taper_point(p: vec3f, k: u32, q: TaperParams) -> vec3f {
    let width = 1.0 + q.rate * clamp(p.y, q.low, q.high);
    return vec3f(p.x / width, p.y, p.z / width);
}

fn mod_taper_value(f: f32, p: vec3f, q: TaperParams) -> f32 {
    let away = abs(p - q.center) - q.half;
    return mod_enclosed(f * q.slope, max(max(away.x, away.y), away.z), q.margin);
}
