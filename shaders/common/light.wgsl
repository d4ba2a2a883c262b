// A light as the CPU packs it (`GpuLight`), 96 bytes. Positions are relative to the eye.

struct Light {
    // Of its middle.
    position: vec3f,
    kind: u32,
    // Unit direction in which the light travels.
    direction: vec3f,
    range: f32,
    // Of a sun and lights from a sphere: irradiance by pi, at 1 m. Of a rectangle: radiance.
    color: vec3f,
    // Of the sphere; of a sun the sine of half its angular diameter.
    radius: f32,
    // From the middle of a rectangle to its sides; perpendicular to each other.
    right: vec3f,
    // Cosines of the half angles of full light and of no light; the first is always the greater.
    cos_inner: f32,
    up: vec3f,
    cos_outer: f32,
    // The attenuation is 1 / (constant + linear d + quadratic d^2).
    constant: f32,
    linear: f32,
    quadratic: f32,
    // 1 if it casts shadows.
    cast_shadows: u32,
}

const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_POINT: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;
const LIGHT_RECTANGLE: u32 = 3u;
