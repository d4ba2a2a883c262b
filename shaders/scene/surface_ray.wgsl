// Rays that leave a surface.

#include "common/ray.wgsl"

// Distance above a surface at which a ray that leaves it begins, in footprints; `SURFACE_BIAS` on
// the CPU.
const SURFACE_BIAS: f32 = 0.25;

// A ray that leaves a surface at `p`; the path from the eye to `p` has the length `gone`. `normal`
// and `direction` have unit length.
fn scene_surface_ray(p: vec3f, normal: vec3f, direction: vec3f, gone: f32) -> Ray {
    let side = select(normal, -normal, dot(normal, direction) < 0.0);
    return Ray(p + side * (SURFACE_BIAS * view.footprint * gone), gone, direction);
}
