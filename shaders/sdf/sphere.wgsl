// A sphere.

#include "generated/params/SphereParams.wgsl"

fn sdf_sphere(p: vec3f, q: SphereParams) -> f32 {
    return length(p) - q.radius;
}
