// The part of a sphere within an angle around Y: radius a.x, sine and cosine of the angle a.yz.

fn sdf_solid_angle(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let q = vec2f(length(p.xz), p.y);
    let along = dot(q, a.yz);
    let across = dot(q, vec2f(a.z, -a.y));
    let far = length(q);
    var to_side = abs(across);
    if along <= 0.0 {
        to_side = far;
    } else if along >= a.x {
        to_side = length(q - a.x * a.yz);
    }
    if across >= 0.0 {
        return to_side;
    }
    return max(far - a.x, -to_side);
}
