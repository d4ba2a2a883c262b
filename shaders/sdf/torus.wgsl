// A torus around Y.

#include "generated/params/TorusParams.wgsl"

fn sdf_torus(p: vec3f, q: TorusParams) -> f32 {
    return length(vec2f(length(p.xz) - q.major_radius, p.y)) - q.minor_radius;
}

// Upper bound of the concavity: within `span` of a point, all in units of the component, the second
// derivative of the field along any line is nowhere less than the negative of this. The distance to
// a circle is concave only near the circle's axis, nearer to it than the circle: there it bends at
// most as the distance to the axis does.
fn sdf_torus_concavity(p: vec3f, q: TorusParams, scale: f32, span: f32) -> f32 {
    let nearest = length(p.xz) * scale - span;
    return select(1.0 / max(nearest, 1e-9), 0.0, nearest >= q.major_radius * scale);
}
