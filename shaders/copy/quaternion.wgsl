// Rotations as quaternions, x y z w.

fn quaternion_product(a: vec4f, b: vec4f) -> vec4f {
    return vec4f(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

fn quaternion_rotated(q: vec4f, v: vec3f) -> vec3f {
    let t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

fn quaternion_about(axis: vec3f, angle: f32) -> vec4f {
    return vec4f(axis * sin(0.5 * angle), cos(0.5 * angle));
}
