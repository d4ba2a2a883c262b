// The spaces of an instancer and of its copies.

#include "copies/variation.wgsl"

// A point of the instancer's space, relative to the anchor's place, from one relative to the eye.
fn instancer_local_point(p: vec3f) -> vec3f {
    let q = vec4f(p, 1.0);
    return vec3f(dot(instancer.local_x, q), dot(instancer.local_y, q), dot(instancer.local_z, q));
}

fn instancer_local_direction(d: vec3f) -> vec3f {
    return vec3f(dot(instancer.local_x.xyz, d), dot(instancer.local_y.xyz, d), dot(instancer.local_z.xyz, d));
}

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
