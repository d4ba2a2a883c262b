// Rays through a component.

#include "common/view.wgsl"
#include "common/scene.wgsl"

// Neighboring rays of a narrow picture are too close together for f32 over the whole distance from
// the eye. Positions on a ray therefore count from a plane across the view,
// `component.ray_origin_depth` before the eye, where places in the picture are known exactly. In
// wide pictures this depth is 0, and the plane passes through the eye. `t` is the distance from the
// eye everywhere.
struct Ray {
    // Intersection of the ray and the plane, relative to the component's origin.
    origin: vec3f,
    // `t` of that place.
    skipped: f32,
    // Of unit length.
    direction: vec3f,
}

// The ray through the point at `offset` from the picture's center, on the plane at distance 1
// before the eye.
fn ray_toward(component: Component, offset: vec3f) -> Ray {
    let along = offset + view.forward;
    // The length of `along` minus 1, without cancellation.
    let longer = dot(offset, offset) / (1.0 + length(along));
    let skipped = component.ray_origin_depth + component.ray_origin_depth * longer;
    return Ray(component.eye + offset * component.ray_origin_depth, skipped, normalize(along));
}

// The ray through the center of a pixel.
fn ray_through(component: Component, pixel: vec2u) -> Ray {
    return ray_toward(component, view_offset(vec2f(pixel) + 0.5));
}

// The point at `t`, relative to the component's origin.
fn ray_at(ray: Ray, t: f32) -> vec3f {
    return ray.origin + ray.direction * (t - ray.skipped);
}
