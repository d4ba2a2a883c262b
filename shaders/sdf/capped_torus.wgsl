// An arc of a torus around Y, centered on X: major radius a.x, minor radius a.y, sine and cosine of
// half the arc a.zw.
//
// In the plane of the ring, the nearest point of the arc has the same direction from the center, or
// is an end (idea: Quilez, "distance functions").

fn sdf_capped_torus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let z = abs(p.z);
    let ring = length(vec2f(length(p.xz) - a.x, p.y));
    let end = length(vec3f(p.x - a.x * a.w, z - a.x * a.z, p.y));
    return select(end, ring, p.x * a.z - z * a.w > 0.0) - a.y;
}
