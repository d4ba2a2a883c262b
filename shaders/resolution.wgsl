// Pass `resolution`: which rays of a part with a resolution of its own are traced. It runs twice over the subtiles that
// the cone pass listed, each time before dispatches that trace the rays it leaves, as if they were unfinished ones.
//
// First: the rays of a coarse grid, every second or fourth pixel along each axis. Then the pixels between, by the four of the
// grid around them. Where all four show the part as one smooth surface, pixels take their distance. Where all four see as far
// as a pixel does and none shows the part, it stays as it is. All other pixels get rays.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch.wgsl"
#include "common/subtiles.wgsl"
#if COPIES
#include "copy/copied.wgsl"
#end

@group(2) @binding(0) var depth_target: texture_storage_2d<r32float, read_write>;
@group(2) @binding(1) var visibility_target: texture_storage_2d<r32uint, read_write>;
// `t` at which the rays begin.
@group(2) @binding(2) var march_target: texture_storage_2d<r32float, write>;
// As in pass `trace`.
@group(2) @binding(3) var hiz_target: texture_storage_2d<r32float, write>;
@group(2) @binding(4) var<storage, read_write> subtiles: array<Subtile>;
@group(2) @binding(5) var<storage, read> subtile_counts: array<u32>;
@group(2) @binding(6) var<storage, read_write> rays: array<atomic<u32>>;
@group(2) @binding(7) var<storage, read_write> ray_counts: array<atomic<u32>>;
#if COPIES
@group(2) @binding(8) var<storage, read_write> copied: array<vec4i>;
#end

// A surface is smooth where depths between four pixels are off by at most this many footprints if it bends as it does at them.
const RESOLUTION_ERROR: f32 = 0.25;
// A neighbor that sees less than this part of a pixel's depth may have been kept from seeing the part.
const RESOLUTION_BLOCKED: f32 = 0.95;

// Farthest depths of the subtiles of a workgroup.
var<workgroup> resolution_farthest: array<atomic<u32>, 4>;

// One invocation for each cell of the grid: one of a subtile at 1/4, four at 1/2.
@compute @workgroup_size(16)
fn resolution_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let cells = SUBTILE / dispatch.spacing;
    let of_group = lane / (cells * cells);
    let slot = group.x * 4u + min(of_group, 3u);
    let subtile = subtiles[dispatch.first_subtile + slot];
    let is_listed = of_group < 4u && slot < subtile_counts[dispatch.list * SUBTILE_COUNTS + 4u];
    let cell = vec2u(lane % cells, lane / cells % cells);
    let pixel = subtile_pixel(subtile.place) + cell * dispatch.spacing;
    let is_seen = is_listed && view_contains(pixel);
    let leads = is_seen && all(cell == vec2u(0u));
    let is_first = dispatch.relaunch == 0u;
    if leads && is_first {
        resolution_list(subtile.place);
    }
    if is_seen && is_first {
        resolution_begin_ray(subtile, pixel);
    }
    if is_seen && !is_first {
        // Depths are positive, so their bits have the same order.
        atomicMax(&resolution_farthest[min(of_group, 3u)], bitcast<u32>(resolution_fill(subtile, pixel)));
    }
    workgroupBarrier();
    if leads && !is_first {
        // Rays that are left only make it nearer.
        let farthest = bitcast<f32>(atomicLoad(&resolution_farthest[min(of_group, 3u)]));
        textureStore(hiz_target, subtile_unpack(subtile.place), vec4f(farthest));
    }
}

// Lists a subtile as one with hits: rays of the lists that this pass makes tell nothing of their subtiles.
fn resolution_list(place: u32) {
    let list = dispatch.list * RAY_COUNTS;
    let hit = atomicAdd(&ray_counts[list + 6u], 1u);
    atomicMax(&ray_counts[list + 3u], hit / 4u + 1u);
    subtiles[dispatch.hits + dispatch.first_subtile + hit].place = place;
}

// Leaves the ray of a pixel to the next dispatch of pass `trace`.
fn resolution_begin_ray(subtile: Subtile, pixel: vec2u) {
    let start = subtile_start(subtile, (pixel.y % SUBTILE) * SUBTILE + pixel.x % SUBTILE);
    textureStore(march_target, pixel, vec4f(max(start, dispatch.near)));
#if COPIES
    // It begins in no copy.
    copied[copied_place(pixel) + 1u] = vec4i(0);
#end
    let at = atomicAdd(&rays[dispatch.list], 1u);
    atomicMax(&ray_counts[dispatch.list * RAY_COUNTS], at / 64u + 1u);
    atomicStore(&rays[dispatch.rays + at], pixel.x | (pixel.y << 16u));
}

// Distance along the view axis per distance along the ray of a pixel.
fn resolution_along_axis(pixel: vec2u) -> f32 {
    return dot(view_direction(pixel), view.forward);
}

// The inverse of the depth along the view axis of a pixel of the grid that shows what `first` does; 0 for others.
fn resolution_inverse(at: vec2i, first: vec2u) -> f32 {
    let is_traced = all(at >= vec2i(dispatch.origin)) && all(at < vec2i(dispatch.end)) && view_contains(vec2u(max(at, vec2i(0))));
    let pixel = select(first, vec2u(max(at, vec2i(0))), is_traced);
    var shows = is_traced && textureLoad(visibility_target, pixel).x == dispatch.component;
#if COPIES
    shows = shows && all(copied[copied_place(pixel)] == copied[copied_place(first)]);
#end
    return select(0.0, 1.0 / (textureLoad(depth_target, pixel).x * resolution_along_axis(pixel)), shows);
}

// How much four values in a row bend between the inner two; where no outer one is known, as much as these differ.
fn resolution_bend(before: f32, a: f32, b: f32, after: f32) -> f32 {
    let first = select(0.0, abs(before - 2.0 * a + b), before > 0.0);
    let last = select(0.0, abs(a - 2.0 * b + after), after > 0.0);
    return select(max(first, last), abs(a - b), before == 0.0 && after == 0.0);
}

// How far depths between four pixels of the grid may be off, in footprints, by how those around them go on. Linear interpolation
// is off by an eighth of the second difference.
fn resolution_error(first: vec2u, size: i32, inverse: vec4f) -> f32 {
    let at = vec2i(first);
    let left = vec2f(resolution_inverse(at + size * vec2i(-1, 0), first), resolution_inverse(at + size * vec2i(-1, 1), first));
    let right = vec2f(resolution_inverse(at + size * vec2i(2, 0), first), resolution_inverse(at + size * vec2i(2, 1), first));
    let above = vec2f(resolution_inverse(at + size * vec2i(0, -1), first), resolution_inverse(at + size * vec2i(1, -1), first));
    let below = vec2f(resolution_inverse(at + size * vec2i(0, 2), first), resolution_inverse(at + size * vec2i(1, 2), first));
    let across = max(
        resolution_bend(left.x, inverse.x, inverse.y, right.x),
        resolution_bend(left.y, inverse.z, inverse.w, right.y),
    );
    let down = max(
        resolution_bend(above.x, inverse.x, inverse.z, below.x),
        resolution_bend(above.y, inverse.y, inverse.w, below.y),
    );
    let least = min(min(inverse.x, inverse.y), min(inverse.z, inverse.w));
    return 0.125 * (across + down) / (least * view.footprint);
}

// Fills the cell of the grid that begins at a pixel, or begins rays for its pixels. Returns their farthest depth.
fn resolution_fill(subtile: Subtile, first: vec2u) -> f32 {
    // lavapipe makes constants of uniforms that end a loop, unless they depend on an invocation's own data.
    let size = select(dispatch.spacing, 0u, first.x == 0xffffffffu);
    // Others of the grid may not be traced yet.
    let is_within = all(first + size < dispatch.end) && view_contains(first + size);
    var depths = vec4f();
    var inverse = vec4f();
    var shown = 0u;
#if COPIES
    let copy = copied[copied_place(first)];
#end
    for (var i = 0u; i < 4u; i += 1u) {
        let corner = select(first, first + size * vec2u(i & 1u, i >> 1u), is_within);
        depths[i] = textureLoad(depth_target, corner).x;
        inverse[i] = 1.0 / (depths[i] * resolution_along_axis(corner));
        var shows = textureLoad(visibility_target, corner).x == dispatch.component;
#if COPIES
        shows = shows && all(copied[copied_place(corner)] == copy);
#end
        shown += select(0u, 1u, shows);
    }
    let nearest = min(min(depths.x, depths.y), min(depths.z, depths.w));
    let is_smooth = is_within && shown == 4u && resolution_error(first, i32(size), inverse) <= RESOLUTION_ERROR;
    let is_missed = is_within && shown == 0u;
    var deepest = depths.x;
    for (var i = 1u; i < size * size; i += 1u) {
        let pixel = first + vec2u(i % size, i / size);
        if !view_contains(pixel) {
            continue;
        }
        let own = textureLoad(depth_target, pixel).x;
        var depth = own;
        if is_smooth {
            // The inverse of the depth of a plane is linear in the picture.
            let share = vec2f(pixel - first) / f32(size);
            let rows = mix(inverse.xz, inverse.yw, share.x);
            depth = 1.0 / (mix(rows.x, rows.y, share.y) * resolution_along_axis(pixel));
            if depth < own {
                textureStore(depth_target, pixel, vec4f(depth));
                textureStore(visibility_target, pixel, vec4u(dispatch.component));
#if COPIES
                copied[copied_place(pixel)] = copy;
#end
            }
        } else if !is_missed || nearest < RESOLUTION_BLOCKED * own {
            resolution_begin_ray(subtile, pixel);
        }
        deepest = max(deepest, min(depth, own));
    }
    return deepest;
}
