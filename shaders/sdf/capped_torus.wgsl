// A ring around Y of which an arc around X is left: major radius a.x, minor radius a.y, sine and cosine of half the arc
// a.zw.
//
// In the plane of the ring the nearest point of the arc lies in the same direction from the centre, or is an end
// (idea: Quilez, "distance functions").

fn sdf_capped_torus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let q = vec2f(p.x, abs(p.z));
    if q.x * a.z - q.y * a.w > 0.0 {
        return length(vec2f(length(q) - a.x, p.y)) - a.y;
    }
    return length(vec3f(q - a.x * a.wz, p.y)) - a.y;
}
