// A light as the CPU packs it (`GpuLight`), 64 bytes. Positions are relative to the eye.

struct Light {
    position: vec3f,
    kind: u32,
    // Unit direction in which the light travels.
    direction: vec3f,
    range: f32,
    // Color times intensity, linear.
    color: vec3f,
    constant: f32,
    linear: f32,
    quadratic: f32,
    // Cosines of the half angles of full light and of no light; the first is always the greater.
    cos_inner: f32,
    cos_outer: f32,
}

const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_POINT: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;
