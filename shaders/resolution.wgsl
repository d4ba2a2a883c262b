// Pass `resolution`: which rays of a part with a resolution of its own are traced. It runs twice over the subtiles that
// the cone pass listed, each time before dispatches that trace the rays it leaves, as if they were unfinished ones.
//
// First: the rays of a coarse grid, every second or fourth pixel along each axis. Then the pixels between, each by the four of
// the grid around it. Where all four show the part as one smooth surface, the pixel takes their distance. Where all four see
// as far as it does and none shows the part, the pixel stays as it is. All other pixels get rays.

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
@group(2) @binding(3) var<storage, read_write> subtiles: array<Subtile>;
@group(2) @binding(4) var<storage, read> subtile_counts: array<u32>;
@group(2) @binding(5) var<storage, read_write> rays: array<atomic<u32>>;
@group(2) @binding(6) var<storage, read_write> ray_counts: array<atomic<u32>>;
#if COPIES
@group(2) @binding(7) var<storage, read_write> copied: array<vec4i>;
#end

// A surface is smooth if the depths of four pixels differ by at most this many footprints for each pixel between them: a
// slope of some 70 degrees.
const RESOLUTION_STEEP: f32 = 3.0;
// A neighbor that sees less than this part of a pixel's depth may have been kept from seeing the part.
const RESOLUTION_BLOCKED: f32 = 0.95;

@compute @workgroup_size(8, 8)
fn resolution_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = group.x * 4u + subtile_of(lane);
    let subtile = subtiles[dispatch.first_subtile + slot];
    let is_listed = slot < subtile_counts[dispatch.list * SUBTILE_COUNTS + 4u];
    let pixel = subtile_pixel(subtile.place) + subtile_place(lane);
    let is_coarse = all(pixel % dispatch.spacing == vec2u(0u));
    let is_first = dispatch.relaunch == 0u;
    if !is_listed || !view_contains(pixel) {
        return;
    }
    if lane % 16u == 0u && is_first {
        resolution_list(subtile.place);
    }
    var gets_ray = is_coarse && is_first;
    if !is_coarse && !is_first {
        gets_ray = !resolution_fill(pixel);
    }
    if gets_ray {
        resolution_begin_ray(pixel, max(subtile_start(subtile, lane), dispatch.near));
    }
}

// Lists a subtile as one with hits: rays of the lists that this pass makes tell nothing of their subtiles.
fn resolution_list(place: u32) {
    let list = dispatch.list * RAY_COUNTS;
    let hit = atomicAdd(&ray_counts[list + 6u], 1u);
    atomicMax(&ray_counts[list + 3u], hit / 4u + 1u);
    subtiles[dispatch.hits + dispatch.first_subtile + hit].place = place;
}

// Leaves a ray that begins at `t` to the next dispatch of pass `trace`.
fn resolution_begin_ray(pixel: vec2u, t: f32) {
    textureStore(march_target, pixel, vec4f(t));
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

// Whether the four pixels of the grid around this one tell what it shows; if so, it shows that.
fn resolution_fill(pixel: vec2u) -> bool {
    let spacing = dispatch.spacing;
    let first = pixel / spacing * spacing;
    // Others of the grid may not be traced yet.
    let is_within = all(first >= dispatch.origin) && all(first + spacing < dispatch.end) && view_contains(first + spacing);
    let own = textureLoad(depth_target, pixel).x;
    var depths = vec4f();
    var inverse = vec4f();
    var shown = 0u;
#if COPIES
    let place = copied_place(pixel);
    let copy = copied[copied_place(first)];
#end
    for (var i = 0u; i < 4u; i += 1u) {
        let corner = select(pixel, first + spacing * vec2u(i & 1u, i >> 1u), is_within);
        depths[i] = textureLoad(depth_target, corner).x;
        inverse[i] = 1.0 / (depths[i] * resolution_along_axis(corner));
        var shows = textureLoad(visibility_target, corner).x == dispatch.component;
#if COPIES
        shows = shows && all(copied[copied_place(corner)] == copy);
#end
        shown += select(0u, 1u, shows);
    }
    let nearest = min(min(depths.x, depths.y), min(depths.z, depths.w));
    let farthest = max(max(depths.x, depths.y), max(depths.z, depths.w));
    if is_within && shown == 0u {
        return nearest >= RESOLUTION_BLOCKED * own;
    }
    let most = 1.0 + RESOLUTION_STEEP * f32(spacing) * view.footprint;
    if !is_within || shown < 4u || farthest > most * nearest {
        return false;
    }
    // The inverse of the depth of a plane is linear in the picture.
    let share = vec2f(pixel - first) / f32(spacing);
    let rows = mix(inverse.xz, inverse.yw, share.x);
    let depth = 1.0 / (mix(rows.x, rows.y, share.y) * resolution_along_axis(pixel));
    if depth < own {
        textureStore(depth_target, pixel, vec4f(depth));
        textureStore(visibility_target, pixel, vec4u(dispatch.component));
#if COPIES
        copied[place] = copy;
#end
    }
    return true;
}
