// A torus around Y: major radius a.x, minor radius a.y.

fn sdf_torus(p: vec3f, a: vec4f, b: vec4f) -> f32 {
    return length(vec2f(length(p.xz) - a.x, p.y)) - a.y;
}

// Upper bound of the concavity: within `span` of a point, all in units of the component, the second
// derivative of the field along any line is nowhere less than the negative of this. The distance to
// a circle is concave only near the circle's axis, nearer to it than the circle: there it bends at
// most as the distance to the axis does.
fn sdf_torus_concavity(p: vec3f, a: vec4f, b: vec4f, scale: f32, span: f32) -> f32 {
    let nearest = length(p.xz) * scale - span;
    return select(1.0 / max(nearest, 1e-9), 0.0, nearest >= a.x * scale);
}
