// Where a light is, as seen from a point, and how large. Counterpart of `light_extent` and
// `light_toward` in `src/field/light/shadow.rs`.

// Length of the cone to a directional light.
const SHADOW_REACH: f32 = 1e6;
// Least and greatest tangent of a cone.
const LEAST_SPREAD: f32 = 1e-3;
const GREATEST_SPREAD: f32 = 1.0;

// Tangent of the angular radius of a directional light, radius of others; a rectangle counts as a
// disc of its area.
fn light_extent(light: Light) -> f32 {
    let disc = sqrt(length(light.right) * length(light.up) * 1.2732395);
    return select(light.radius, disc, light.kind == LIGHT_RECTANGLE);
}

// Direction (xyz) and distance of the middle of a light; the distance is 0 if none of its light
// reaches the point.
fn light_toward(light: Light, position: vec3f) -> vec4f {
    let offset = light.position - position;
    let distance = length(offset);
    let to_light = offset / max(distance, 1e-6);
    let is_outside = light.kind == LIGHT_SPOT && -dot(to_light, light.direction) < light.cos_outer;
    let reaches = distance < light.range && !is_outside;
    let lamp = vec4f(to_light, select(0.0, distance, reaches));
    return select(lamp, vec4f(-light.direction, SHADOW_REACH), light.kind == LIGHT_DIRECTIONAL);
}

// Tangent of the cone to a light at this distance.
fn light_spread(light: Light, distance: f32) -> f32 {
    let extent = light_extent(light);
    let spread = select(extent / max(distance, 1e-6), extent, light.kind == LIGHT_DIRECTIONAL);
    return clamp(spread, LEAST_SPREAD, GREATEST_SPREAD);
}
