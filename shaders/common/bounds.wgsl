// Rays against the bounds of a component.

#include "common/ray.wgsl"

// Relative spacing of f32, with room for the rounding of a few operations.
const SPACING: f32 = 2.4e-7;
// `t` of an event that does not occur.
const NEVER: f32 = 3e38;

// Entry and exit of the ray through the component's box, grown by `by`.
fn bounds_interval(component: Component, ray: Ray, by: f32) -> vec2f {
    // A zero component of the direction would yield 0 times infinity.
    let d = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let a = (component.low - by - ray.origin) / d;
    let b = (component.high + by - ray.origin) / d;
    let near = min(a, b);
    let far = max(a, b);
    return vec2f(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z)) + ray.skipped;
}

// `t` at which the ray enters the component's half space: 0 from inside, NEVER if it does not
// enter.
fn bounds_half_space_entry(component: Component, ray: Ray) -> f32 {
    let plane = component.half_space;
    let height = dot(plane.xyz, ray.origin) + plane.w;
    let climb = dot(plane.xyz, ray.direction);
    // Slightly early, so that the march sees the sign change.
    let crossing = (ray.skipped - height / min(climb, -1e-30)) * (1.0 - 4.0 * SPACING);
    return select(select(NEVER, crossing, climb < 0.0), 0.0, height <= 0.0);
}
