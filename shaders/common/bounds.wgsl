// Rays against the bounds of a component.

#include "common/ray.wgsl"

// Relative spacing of f32, with room for the rounding of a few operations.
const SPACING: f32 = 2.4e-7;
// A crossing that never comes.
const NEVER: f32 = 3e38;

// Where the ray is within the component's box, grown by `by`: entry and exit.
fn bounds_interval(component: Component, ray: Ray, by: f32) -> vec2f {
    // A component of the direction that is zero would give 0 times infinity.
    let d = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let a = (component.low - by - ray.origin) / d;
    let b = (component.high + by - ray.origin) / d;
    let near = min(a, b);
    let far = max(a, b);
    return vec2f(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z)) + ray.skipped;
}

// Where the ray enters the component's half space: 0 from inside, NEVER where it does not.
fn bounds_half_space_entry(component: Component, ray: Ray) -> f32 {
    let plane = component.half_space;
    let height = dot(plane.xyz, ray.origin) + plane.w;
    let climb = dot(plane.xyz, ray.direction);
    // A little early, so that the march sees the sign change.
    let crossing = (ray.skipped - height / min(climb, -1e-30)) * (1.0 - 4.0 * SPACING);
    return select(select(NEVER, crossing, climb < 0.0), 0.0, height <= 0.0);
}
