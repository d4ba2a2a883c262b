// The convex hull of two spheres on Y: bottom radius a.x, top radius a.y, distance of the centers
// a.z.

fn sdf_round_cone(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let height = a.z;
    let narrowing = a.x - a.y;
    let q = vec2f(length(p.xz), p.y + 0.5 * height);
    let bottom = length(q) - a.x;
    let top = length(q - vec2f(0.0, height)) - a.y;
    if abs(narrowing) >= height {
        // One sphere contains the other.
        return select(top, bottom, narrowing >= 0.0);
    }
    // The unit normal of the slanted side; the spheres touch it at `along` 0 and
    // `normal.x * height`.
    let sine = narrowing / height;
    let normal = vec2f(sqrt((1.0 - sine) * (1.0 + sine)), sine);
    let along = dot(q, vec2f(-normal.y, normal.x));
    if along < 0.0 {
        return bottom;
    }
    if along > normal.x * height {
        return top;
    }
    return dot(q, normal) - a.x;
}
