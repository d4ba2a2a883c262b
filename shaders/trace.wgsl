// Pass `trace`: one component against the depth target, by sphere tracing (Hart 1996), over the
// subtiles that the cone pass listed.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch.wgsl"
#include "common/subtiles.wgsl"
#include "generated/value.wgsl"
#include "common/bounds.wgsl"
#include "common/march.wgsl"
#include "generated/trace_march.wgsl"
#include "common/counts.wgsl"

@group(2) @binding(0) var depth_target: texture_storage_2d<r32float, read_write>;
@group(2) @binding(1) var visibility_target: texture_storage_2d<r32uint, write>;
// `t` at which an unfinished march resumes; MARCH_ENDED for the others.
@group(2) @binding(2) var march_target: texture_storage_2d<r32float, read_write>;
// The farthest depth of each subtile.
@group(2) @binding(3) var hiz_target: texture_storage_2d<r32float, write>;
// Subtiles that the cone pass listed; from `dispatch.hits` on, the places of subtiles with hits.
@group(2) @binding(4) var<storage, read_write> subtiles: array<Subtile>;
@group(2) @binding(8) var<storage, read> subtile_counts: array<u32>;
// Per list the number of rays unfinished after the first launch; then the pixels of the current
// list's unfinished rays, column and row, 16 bits each.
@group(2) @binding(6) var<storage, read_write> rays: array<atomic<u32>>;
// RAY_COUNTS words per list. Written in the first launch.
@group(2) @binding(7) var<storage, read_write> ray_counts: array<atomic<u32>>;
// See `common/counts.wgsl`.
@group(2) @binding(5) var<storage, read_write> march_counts: array<atomic<u32>>;

const MARCH_ENDED: f32 = -1.0;

// What a ray has found.
struct Traced {
    // Of the hit; NEVER without one.
    t: f32,
    // Where the march resumes if it has not ended.
    resume: f32,
    ended: bool,
    evaluations: u32,
}

var<workgroup> hiz: array<atomic<u32>, 4>;
// Whether a ray of the subtile has a hit, or is unfinished.
var<workgroup> has_hits: array<atomic<u32>, 4>;

@compute @workgroup_size(8, 8)
fn trace(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = group.x * 4u + subtile_of(lane);
    let subtile = subtiles[dispatch.first_subtile + slot];
    let is_listed = slot < subtile_counts[dispatch.list * SUBTILE_COUNTS + 4u];
    var pixel = subtile_pixel(subtile.place) + subtile_place(lane);
    var exists = is_listed && view_contains(pixel);
    if dispatch.compacted == 1u {
        let at = group.x * 64u + lane;
        exists = at < atomicLoad(&rays[dispatch.list]);
        let ray = atomicLoad(&rays[dispatch.rays + at]);
        pixel = select(vec2u(0u), vec2u(ray & 0xffffu, ray >> 16u), exists);
    }
    let component = subject;
    field_begin(component);
    var depth = select(0.0, textureLoad(depth_target, pixel).x, exists);
    let traced = trace_march(component, pixel, subtile, lane, depth, exists);
    if exists {
        // The last step may have ended behind the far limit.
        let is_nearer = traced.t < min(depth, dispatch.far);
        if is_nearer || !traced.ended {
            atomicOr(&has_hits[subtile_of(lane)], 1u);
        }
        if is_nearer {
            depth = traced.t;
            textureStore(depth_target, pixel, vec4f(depth));
            textureStore(visibility_target, pixel, vec4u(dispatch.component));
        }
        trace_leave(pixel, traced);
        if COUNTING {
            trace_count(pixel, traced.evaluations);
        }
    }
    if dispatch.compacted == 1u {
        // Hits of single rays only make subtiles nearer: their farthest depths remain upper bounds.
        return;
    }
    // Depths are positive, so their bits have the same order.
    atomicMax(&hiz[subtile_of(lane)], bitcast<u32>(depth));
    workgroupBarrier();
    if lane % 16u == 0u && is_listed {
        let deepest = bitcast<f32>(atomicLoad(&hiz[subtile_of(lane)]));
        textureStore(hiz_target, subtile_unpack(subtile.place), vec4f(deepest));
        if dispatch.relaunch == 0u && atomicLoad(&has_hits[subtile_of(lane)]) > 0u {
            let list = dispatch.list * RAY_COUNTS;
            let hit = atomicAdd(&ray_counts[list + 6u], 1u);
            atomicMax(&ray_counts[list + 3u], hit / 4u + 1u);
            subtiles[dispatch.hits + dispatch.first_subtile + hit].place = subtile.place;
        }
    }
}

// Leaves an unfinished march to the next relaunch, or counts it after the last one.
fn trace_leave(pixel: vec2u, traced: Traced) {
    if dispatch.last_relaunch == 1u {
        if !traced.ended {
            atomicAdd(&march_counts[dispatch.component * COMPONENT_COUNTS], 1u);
        }
        return;
    }
    if dispatch.relaunch > 0u {
        textureStore(march_target, pixel, vec4f(select(traced.resume, MARCH_ENDED, traced.ended)));
    } else if !traced.ended {
        textureStore(march_target, pixel, vec4f(traced.resume));
        let at = atomicAdd(&rays[dispatch.list], 1u);
        atomicMax(&ray_counts[dispatch.list * RAY_COUNTS], at / 64u + 1u);
        atomicStore(&rays[dispatch.rays + at], pixel.x | (pixel.y << 16u));
    }
}

// Adds the cost of a march to the counts of its pixel and its component.
fn trace_count(pixel: vec2u, evaluations: u32) {
    let started = select(0u, 1u, evaluations > 0u && dispatch.compacted == 0u);
    let counted = vec4u(evaluations, started, walked);
    let of_pixel = counts_of_pixel(arrayLength(&march_counts), pixel);
    let of_component = dispatch.component * COMPONENT_COUNTS + 1u;
    for (var i = 0u; i < PIXEL_COUNTS; i += 1u) {
        atomicAdd(&march_counts[of_pixel + i], counted[i]);
        atomicAdd(&march_counts[of_component + i], counted[i]);
    }
}
