// An infinite cylinder along Y.

#include "generated/params/InfiniteCylinderParams.wgsl"

fn sdf_infinite_cylinder(p: vec3f, q: InfiniteCylinderParams) -> f32 {
    return length(p.xz) - q.radius;
}
