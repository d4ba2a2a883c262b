// A sphere cut by a plane: radius a.x, height of the cut a.y. The part above the cut stays.
//
// Outside, the nearest point is on the sphere if the direction to its center leads through the part
// that stays, else on the flat or its rim; inside, the nearer of sphere and flat is exact.

fn sdf_cut_sphere(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    let radius = a.x;
    let cut = clamp(a.y, -radius, radius);
    let rim = sqrt((radius - cut) * (radius + cut));
    let q = vec2f(length(p.xz), p.y);
    let far = length(q);
    let over = far - radius;
    let under = cut - q.y;
    if over <= 0.0 && under <= 0.0 {
        return max(over, under);
    }
    if over > 0.0 && q.y * radius >= cut * far {
        return over;
    }
    if under > 0.0 && q.x <= rim {
        return under;
    }
    return length(vec2f(q.x - rim, under));
}
