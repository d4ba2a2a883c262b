// The depth target, R32Float: distance from the eye along the pixel's ray, in world units.
// `src/render/resources/targets.rs` is this file's counterpart.

// Depth of pixels without a hit. Finite, because WGSL does not guarantee infinities.
const BACKGROUND: f32 = 1e30;
// In the visibility target: no component and no mesh.
const VISIBILITY_NONE: u32 = 0xffffffffu;
// In the visibility and leaf targets: a mesh; the other bits are its index.
const MESH_BIT: u32 = 0x80000000u;
