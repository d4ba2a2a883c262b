// The convex hull of two spheres on Y; the height is the distance of their centers.

#include "generated/params/RoundConeParams.wgsl"

fn sdf_round_cone(p: vec3f, q: RoundConeParams) -> f32 {
    let height = q.height;
    let narrowing = q.bottom_radius - q.top_radius;
    let at = vec2f(length(p.xz), p.y + 0.5 * height);
    let bottom = length(at) - q.bottom_radius;
    let top = length(at - vec2f(0.0, height)) - q.top_radius;
    if abs(narrowing) >= height {
        // One sphere contains the other.
        return select(top, bottom, narrowing >= 0.0);
    }
    // The unit normal of the slanted side; the spheres touch it at `along` 0 and
    // `normal.x * height`.
    let sine = narrowing / height;
    let normal = vec2f(sqrt((1.0 - sine) * (1.0 + sine)), sine);
    let along = dot(at, vec2f(-normal.y, normal.x));
    if along < 0.0 {
        return bottom;
    }
    if along > normal.x * height {
        return top;
    }
    return dot(at, normal) - q.bottom_radius;
}
