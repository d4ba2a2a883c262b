// The flat scene. `src/flat/arrays.rs` is this file's counterpart and says what the fields mean; a test
// compares the layouts.

struct FlatNode {
    code: u32,
    extent: u32,
    params: u32,
    material: u32,
}

// A component, as it stands to the eye.
struct Component {
    // The point that `ray_origin_depth` puts before the eye on the view axis, relative to the component's origin.
    eye: vec3f,
    first: u32,
    // Bounds, relative to the component's origin.
    low: vec3f,
    end: u32,
    high: vec3f,
    // First of its rows.
    params: u32,
    // Inside where dot(xyz, p) + w <= 0; all zero where there is none.
    half_space: vec4f,
    // The grid of cells, for evaluators that use one: lower corner, side of a cell at the top, how many there
    // are along each axis, where they stand in `tapes`.
    grid_low: vec3f,
    grid_side: f32,
    grid_counts: vec3u,
    tapes: u32,
    // See `common/ray.wgsl`; mostly 0.
    ray_origin_depth: f32,
    // Where the field is not below the negative of this, two faces in one place may have been rounded apart: no material is
    // between them.
    flush: f32,
}

const GROUP: u32 = 0xffffu;
const RUN: u32 = 0xfffeu;
// The first of the codes of modifiers; RUN and GROUP come after all of them.
const MODIFIER: u32 = 0xff00u;
const LEAF_ROWS: u32 = 4u;
// Rows of a modifier before its own.
const MODIFIER_ROWS: u32 = 6u;

@group(1) @binding(0) var<storage, read> nodes: array<FlatNode>;
// Rows of numbers, as a storage texture: lavapipe reads a texel at a place that is not constant several times as fast
// as four words of a buffer, and half as fast from a texture that may have levels of detail.
@group(1) @binding(1) var params: texture_storage_2d<rgba32float, read>;
// The component that a dispatch is about: its first word at a place that the CPU chooses.
@group(1) @binding(2) var<uniform> subject: Component;

// Rows and words stand in textures of this width, line after line.
const LINE: u32 = 4096u;

fn scene_row(at: u32) -> vec4f {
    return textureLoad(params, vec2u(at % LINE, at / LINE));
}
