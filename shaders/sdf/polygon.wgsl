// Regular polygons.

#include "generated/params/PolygonSides.wgsl"

// Rotates and mirrors the plane so that all sides coincide with half of the one that faces X.
fn sdf_polygon_sector(q: vec2f, sides: PolygonSides) -> vec2f {
    let step = 6.2831853 / sides.count;
    let x = select(q.x, 1.0, q.x == 0.0 && q.y == 0.0);
    let turn = step * round(atan2(q.y, x) / step);
    let c = cos(turn);
    let s = sin(turn);
    let turned = vec2f(c * q.x + s * q.y, abs(c * q.y - s * q.x));
    // Arc tangents are not exact: mirrors points beyond the mirror line back.
    let mirror = vec2f(-sides.sine, sides.cosine);
    return turned - 2.0 * max(dot(turned, mirror), 0.0) * mirror;
}

// Distance to a polygon; `radius` is from the center to the middle of a side.
fn sdf_polygon(q: vec2f, sides: PolygonSides, radius: f32) -> f32 {
    let t = sdf_polygon_sector(q, sides);
    let beside = vec2f(t.x - radius, max(t.y - radius * sides.sine / sides.cosine, 0.0));
    return select(beside.x, length(beside), beside.x > 0.0);
}
