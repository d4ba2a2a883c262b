// The spaces of an instancer and of its copies.

#include "copy/variation.wgsl"

// A point of the space of a copy, from one of the instancer's space.
fn copy_local_point(copy: Copy, p: vec3f) -> vec3f {
    return copy_local_direction(copy, p - copy.position);
}

fn copy_local_direction(copy: Copy, d: vec3f) -> vec3f {
    return quaternion_rotated(vec4f(-copy.rotation.xyz, copy.rotation.w), d) / copy.scale;
}

// The gradient in the world of a field whose gradient in the space of a copy is `g`.
fn copy_world_gradient(copy: Copy, g: vec3f) -> vec3f {
    let h = quaternion_rotated(copy.rotation, g / copy.scale);
    return instancer.local_x.xyz * h.x + instancer.local_y.xyz * h.y + instancer.local_z.xyz * h.z;
}
