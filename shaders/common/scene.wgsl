// The flat scene. `src/field/arrays.rs` is this file's counterpart and documents the fields; a test
// compares the layouts.

struct FlatNode {
    code: u32,
    extent: u32,
    params: u32,
    material: u32,
}

// A component, in relation to the eye.
struct Component {
    // The point at `ray_origin_depth` before the eye on the view axis, relative to the component's
    // origin.
    eye: vec3f,
    first: u32,
    // Bounds, relative to the component's origin.
    low: vec3f,
    end: u32,
    high: vec3f,
    // First of its rows.
    params: u32,
    // The half space that holds the component: dot(xyz, p) + w <= 0; all zero for none.
    half_space: vec4f,
    // The grid of cells, for evaluators with tapes: lower corner, side of a top cell, number of top
    // cells along each axis, their first word in `tapes`.
    grid_low: vec3f,
    grid_side: f32,
    grid_counts: vec3u,
    tapes: u32,
    // See `common/ray.wgsl`; mostly 0.
    ray_origin_depth: f32,
    // A field not below the negative of this may be the rounding between two coincident faces:
    // there is no material between them.
    flush: f32,
    // The same at the eye. It grows with the distance from there, up to `flush`.
    flush_near: f32,
    // Of the type of an instancer: its index among the types.
    kind: u32,
    // Share of the light that passes it.
    translucency: f32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

const GROUP: u32 = 0xffffu;
const RUN: u32 = 0xfffeu;
// First code of modifiers; RUN and GROUP follow the modifiers.
const MODIFIER: u32 = 0xff00u;
const LEAF_ROWS: u32 = 4u;
// Rows common to all modifiers, before a modifier's own.
const MODIFIER_ROWS: u32 = 6u;

@group(1) @binding(0) var<storage, read> nodes: array<FlatNode>;
// Rows, in a storage texture: lavapipe reads a texel at a variable position several times as fast
// as four words of a buffer, and half as fast from a texture that may have mip levels.
@group(1) @binding(1) var params: texture_storage_2d<rgba32float, read>;
// The component of the dispatch, at a dynamic offset.
@group(1) @binding(2) var<uniform> subject: Component;

#include "common/lines.wgsl"

fn scene_row(at: u32) -> vec4f {
    return textureLoad(params, vec2u(at % LINE, at / LINE));
}
