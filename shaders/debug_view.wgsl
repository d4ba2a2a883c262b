// Pass `debug_view`, only if a view mode is active: shows the results or counts of the previous
// passes as colors over the picture. Counterpart of `src/field/debug_view.rs`. Colors are sRGB, as
// the screen expects them.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/counts.wgsl"

struct DebugView {
    // View mode; `ViewMode` on the CPU.
    view_mode: u32,
    // Counts above this, and distances from this on, get the last color.
    top: f32,
    // Distances up to this get the first color.
    bottom: f32,
    // Spacing of the lines of equal distance.
    spacing: f32,
    // Index of the first mesh and of the first component in `colors`.
    first_mesh: u32,
    first_component: u32,
    padding_0: u32,
    padding_1: u32,
}

@group(1) @binding(0) var<uniform> settings: DebugView;
@group(1) @binding(1) var<storage, read> counted: array<u32>;
// One color per entry of the subtree-extent array, then per mesh, then per component: red, green
// and blue, 8 bits each.
@group(1) @binding(2) var<storage, read> colors: array<u32>;
@group(2) @binding(0) var depth_target: texture_2d<f32>;
// w: length of the field's gradient; 0 for meshes.
@group(2) @binding(1) var normal_target: texture_2d<f32>;
@group(2) @binding(2) var visibility_target: texture_2d<u32>;
@group(2) @binding(3) var leaf_target: texture_2d<u32>;
@group(2) @binding(4) var color_target: texture_storage_2d<rgba8unorm, write>;

const VIEW_MODE_STEPS: u32 = 1u;
const VIEW_MODE_EVALUATIONS: u32 = 2u;
const VIEW_MODE_CELLS: u32 = 3u;
const VIEW_MODE_ENTRIES: u32 = 4u;
const VIEW_MODE_DISTANCE: u32 = 5u;
const VIEW_MODE_NORMALS: u32 = 6u;
const VIEW_MODE_SLOPE: u32 = 7u;
const VIEW_MODE_NODES: u32 = 8u;

// Pixels without a hit.
const DEBUG_VIEW_NOTHING: vec3f = vec3f(0.1, 0.11, 0.13);
// Meshes, in view modes that show fields only.
const DEBUG_VIEW_MESH: vec3f = vec3f(0.3, 0.31, 0.34);
// Deviations of the gradient's length from 1 up to this are rounding.
const DEBUG_VIEW_ROUNDING: f32 = 1e-3;

@compute @workgroup_size(8, 8)
fn debug_view(@builtin(global_invocation_id) id: vec3u) {
    if view_contains(id.xy) {
        textureStore(color_target, id.xy, vec4f(debug_view_pixel(id.xy), 1.0));
    }
}

fn debug_view_pixel(pixel: vec2u) -> vec3f {
    if settings.view_mode <= VIEW_MODE_ENTRIES {
        return debug_view_count(debug_view_counted(pixel), settings.top);
    }
    let depth = textureLoad(depth_target, pixel, 0).x;
    if depth >= BACKGROUND {
        return DEBUG_VIEW_NOTHING;
    }
    if settings.view_mode == VIEW_MODE_DISTANCE {
        let share = (depth - settings.bottom) / (settings.top - settings.bottom);
        return debug_view_distance(share) * select(1.0, 0.5, debug_view_is_line(pixel, depth));
    }
    let normal = textureLoad(normal_target, pixel, 0);
    if settings.view_mode == VIEW_MODE_NORMALS {
        return debug_view_normal(normal.xyz);
    }
    let facing = abs(dot(normal.xyz, view_direction(pixel)));
    let visibility = textureLoad(visibility_target, pixel, 0).x;
    let is_mesh = (visibility & MESH_BIT) != 0u;
    if settings.view_mode == VIEW_MODE_SLOPE {
        return debug_view_lit(select(debug_view_slope(normal.w), DEBUG_VIEW_MESH, is_mesh), facing);
    }
    var at = settings.first_component + visibility;
    if is_mesh {
        at = settings.first_mesh + (visibility & ~MESH_BIT);
    } else if settings.view_mode == VIEW_MODE_NODES {
        at = textureLoad(leaf_target, pixel, 0).x;
    }
    return debug_view_lit(unpack4x8unorm(colors[at]).rgb, facing);
}

// Count of a pixel. Where cones evaluate too, includes the pixel's share of the count of its tile's
// cones.
fn debug_view_counted(pixel: vec2u) -> f32 {
    let words = arrayLength(&counted);
    let of_pixel = counts_of_pixel(words, pixel);
    let of_tile = counts_of_tile(words, pixel / TILE);
    if settings.view_mode == VIEW_MODE_STEPS {
        return f32(counted[of_pixel]);
    }
    let word = select(settings.view_mode - 1u, 0u, settings.view_mode == VIEW_MODE_EVALUATIONS);
    return f32(counted[of_pixel + word]) + f32(counted[of_tile + word]) / f32(TILE * TILE);
}

// Whether a line of equal distance runs between the pixel and the one to its right or below. Not
// where several lines fall between two pixels.
fn debug_view_is_line(pixel: vec2u, depth: f32) -> bool {
    let last = vec2u(view.width, view.height) - 1u;
    let right = textureLoad(depth_target, min(pixel + vec2u(1u, 0u), last), 0).x;
    let below = textureLoad(depth_target, min(pixel + vec2u(0u, 1u), last), 0).x;
    let here = floor(depth / settings.spacing);
    let steps = abs(floor(vec2f(right, below) / settings.spacing) - here);
    let near = abs(vec2f(right, below) - depth) < vec2f(0.5 * settings.spacing);
    return any((steps == vec2f(1.0)) & near);
}

// From dark blue through green and yellow to red.
fn debug_view_ramp(share: f32) -> vec3f {
    let at = clamp(share, 0.0, 1.0) * 5.0;
    var color = vec3f(0.06, 0.07, 0.14);
    color = mix(color, vec3f(0.16, 0.24, 0.58), clamp(at, 0.0, 1.0));
    color = mix(color, vec3f(0.1, 0.54, 0.62), clamp(at - 1.0, 0.0, 1.0));
    color = mix(color, vec3f(0.44, 0.76, 0.36), clamp(at - 2.0, 0.0, 1.0));
    color = mix(color, vec3f(0.97, 0.84, 0.3), clamp(at - 3.0, 0.0, 1.0));
    return mix(color, vec3f(0.9, 0.28, 0.16), clamp(at - 4.0, 0.0, 1.0));
}

// Logarithmic color of a count; white above the top.
fn debug_view_count(count: f32, top: f32) -> vec3f {
    return select(debug_view_ramp(log2(1.0 + count) / log2(1.0 + top)), vec3f(1.0), count > top);
}

// Light when near, dark when far.
fn debug_view_distance(share: f32) -> vec3f {
    let at = clamp(share, 0.0, 1.0) * 2.0;
    let nearer = mix(vec3f(0.98, 0.93, 0.78), vec3f(0.27, 0.58, 0.64), min(at, 1.0));
    return mix(nearer, vec3f(0.1, 0.13, 0.27), max(at - 1.0, 0.0));
}

// X, Y and Z as red, green and blue.
fn debug_view_normal(normal: vec3f) -> vec3f {
    return normal * 0.5 + 0.5;
}

// Color of a gradient's length: blue below 1, gray at 1, orange to red above, magenta for infinity
// and NaN.
fn debug_view_slope(slope: f32) -> vec3f {
    if (bitcast<u32>(slope) & 0x7f800000u) == 0x7f800000u {
        return vec3f(1.0, 0.0, 1.0);
    }
    if slope > 1.0 + DEBUG_VIEW_ROUNDING {
        return mix(vec3f(1.0, 0.68, 0.2), vec3f(0.78, 0.06, 0.1), clamp(slope - 1.0, 0.0, 1.0));
    }
    if slope < 1.0 - DEBUG_VIEW_ROUNDING {
        return mix(vec3f(0.08, 0.12, 0.5), vec3f(0.45, 0.68, 0.95), max(slope, 0.0));
    }
    return vec3f(0.86, 0.87, 0.85);
}

// Slightly darker where the surface turns away from the eye, which makes its form visible.
fn debug_view_lit(color: vec3f, facing: f32) -> vec3f {
    return color * (0.6 + 0.4 * facing);
}
