// Bend: turns the X axis into an arc around a point on Y.

#include "generated/params/BendParams.wgsl"
#include "mod/enclosed.wgsl"

// The angle of (x, y) from the y axis toward x. Two reductions and a polynomial, accurate to 2e-7
// (Moshier, "Methods and Programs for Mathematical Functions", 1989): a driver's own function may
// be thousands of times less accurate.
fn bend_angle(x: f32, y: f32) -> f32 {
    let wide = max(abs(x), abs(y));
    let ratio = min(abs(x), abs(y)) / max(wide, 1e-30);
    // Beyond tan(π/8) around π/4.
    let is_far = ratio > 0.41421357;
    let t = select(ratio, (ratio - 1.0) / (ratio + 1.0), is_far);
    let z = t * t;
    let series = (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * t + t;
    let first = select(series, series + 0.78539816, is_far);
    let second = select(first, 1.57079633 - first, abs(x) > abs(y));
    let third = select(second, 3.14159265 - second, y < 0.0);
    return select(third, -third, x < 0.0);
}

// Coordinates along the arc and from it toward the center.
fn bend_place(p: vec3f, q: BendParams) -> vec2f {
    let height = p.y * q.side;
    let r = length(vec2f(p.x, q.radius - height));
    // The radius minus r, without the difference of two large numbers.
    return vec2f(bend_angle(p.x, q.radius - height), (2.0 * q.radius * height - p.x * p.x - height * height) / (q.radius + r));
}

fn mod_bend_point(p: vec3f, k: u32, q: BendParams) -> vec3f {
    let at = bend_place(p, q);
    return vec3f(at.x * q.radius, at.y * q.side, p.z);
}

fn mod_bend_value(f: f32, p: vec3f, q: BendParams) -> f32 {
    let at = bend_place(p, q);
    let open = clamp(abs(at.x) - q.reach, -1.57079633, 1.57079633);
    let of_arc = max(max(at.y - q.high, q.low - at.y), (q.radius - at.y) * sin(open));
    let away = abs(p - q.center) - q.half;
    return mod_enclosed(f * q.slope, max(of_arc, max(max(away.x, away.y), away.z)), q.margin);
}
