// Pass `trace`: one component against the depth target, by sphere tracing (Hart 1996), over the tiles
// that the cone pass has left.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "common/tiles.wgsl"
#include "common/ahead.wgsl"
#include "generated/value.wgsl"
#include "common/bounds.wgsl"
#include "common/counts.wgsl"

@group(2) @binding(0) var depth_target: texture_storage_2d<r32float, read_write>;
@group(2) @binding(1) var owner_target: texture_storage_2d<r32uint, write>;
// Where a march that has not ended goes on; MARCH_ENDED for the others.
@group(2) @binding(2) var march_target: texture_storage_2d<r32float, read_write>;
// The farthest depth in each tile.
@group(2) @binding(3) var farthest_target: texture_storage_2d<r32float, write>;
@group(2) @binding(4) var<storage, read> tiles: array<Tile>;
// For each list how many rays have not ended in the first round; then the pixels of those of the list under way,
// column and row, 16 bits each.
@group(2) @binding(6) var<storage, read_write> rays: array<atomic<u32>>;
// For each list the arguments of an indirect dispatch over these: groups of 64, 1, 1. Written in the first round.
@group(2) @binding(7) var<storage, read_write> ray_counts: array<atomic<u32>>;
// See `common/counts.wgsl`.
@group(2) @binding(5) var<storage, read_write> march_counts: array<atomic<u32>>;

const MARCH_ENDED: f32 = -1.0;
// All lengths below are in footprints of a pixel at the place in question.
// Where a straight approach at an angle that is not grazing is this near, its line is followed to the end.
const HIT: f32 = 1e-3 * FINENESS;
// The least fall of the field per distance that is not grazing.
const STEEP: f32 = 0.2;
// Below this, a straight approach is tried to its end at once, and taken back if there is no surface. Where the surface has
// bumps smaller than a pixel, a long leap would pass some.
const LEAP: f32 = select(0.1, 1.0, CLOSE_IS_HIT);
// At grazing angles, steps shorter than this creep until they see the sign change: a ray that only
// comes near is never taken for a hit.
const CREEP: f32 = 1e-3 * FINENESS;
// Longest creeping step: a chord shorter than this may be missed.
const CREEP_LONGEST: f32 = 0.03 * CREEP_SHARE;
// How fast the expected slope of the field follows the one that was met, from 0 to 1.
const ADAPTION: f32 = 0.6;

var<workgroup> farthest: atomic<u32>;

struct March {
    t: f32,
    hit: bool,
    ended: bool,
    evaluations: u32,
}

// From `start` to a hit, to beyond `exit`, or through `max_steps` evaluations.
//
// Steps are as long as the sphere around the next point is expected to touch the one around this (Ban and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023); where the two leave a gap, the step
// is taken back to the first one's end.
fn trace_march(component: Component, direction: vec3f, start: f32, exit: f32, steps: u32) -> March {
    let reach = length(component.eye);
    var t = start;
    // The last point known to be outside with nothing before it, its field, and how far it is free behind it.
    var safe = vec2f(start, 0.0);
    var free = 0.0;
    // The expected slope of the field along the ray.
    var slope = -1.0;
    var relaxed = false;
    var leaping = false;
    var may_leap = true;
    var creep = 0.0;
    // The nearest point known to be inside, and its field; NEVER until there is one.
    var inside = vec2f(NEVER, 0.0);
    // Where a leap ended outside, and the field there; NEVER for none.
    var ahead = vec2f(NEVER, 0.0);
    // Where the ray was before a leap behind which a gap was left, and the field there; NEVER for none.
    var doubt = vec2f(NEVER, 0.0);
    // Where the field was last evaluated.
    var last = NEVER;
    for (var step = 0u; step < steps; step += 1u) {
        ahead_begin(t - last, AHEAD_WINDOW * (t - safe.x), 2.0 * SPACING * (t + reach));
        last = t;
        var f = field(component.eye + direction * t);
        var proven = ahead_free(f);
        var advance = t - safe.x;
        if relaxed && safe.y + abs(f) < advance {
            relaxed = false;
            slope = -1.0;
            t = safe.x + free;
            continue;
        }
        relaxed = false;
        if f > 0.0 && t + f + CREEP_LONGEST * view.footprint * t >= ahead.x - ahead.y {
            // The two spheres meet: the leap was right, and what it found counts.
            safe = vec2f(t, f);
            t = ahead.x;
            f = ahead.y;
            proven = 0.0;
            advance = t - safe.x;
            leaping = true;
            may_leap = true;
        }
        ahead.x = NEVER;
        let footprint = view.footprint * t;
        let bracketed = inside.x < NEVER;
        // Fall of the field per distance since the last point; 0 at the first one.
        let fall = select(0.0, (safe.y - f) / advance, advance > 0.0 && safe.y > 0.0);
        if f < 0.0 || bracketed {
            // The sign has changed: close in by secants between the last point outside and the first
            // inside. After a leap the two may be footprints apart, too far for a single one.
            if f < 0.0 {
                inside = vec2f(t, f);
            } else {
                safe = vec2f(t, f);
            }
            // Where the field was 0 outside, this is there.
            let root = safe.x + (inside.x - safe.x) * safe.y / (safe.y - inside.y);
            if safe.y <= 0.0 || abs(f) < max(HIT * footprint, SPACING * (t + reach)) || root == t {
                return March(root, true, true, step + 1u);
            }
            t = root;
            continue;
        }
        if CLOSE_IS_HIT && fall > STEEP && f < HIT * footprint {
            return March(t + f / fall, true, true, step + 1u);
        }
        if leaping && safe.y + f + CREEP_LONGEST * footprint < advance {
            // No surface where the line led: go on from the sphere that was left too early.
            leaping = false;
            may_leap = false;
            ahead = vec2f(t, f);
            t = safe.x + free;
            continue;
        }
        if doubt.x < NEVER && f >= safe.y {
            // A leap was kept though between its two spheres there was room for a thin skin, and behind it the field
            // does not fall: look there.
            safe = doubt;
            doubt.x = NEVER;
            leaping = false;
            may_leap = false;
            t = safe.x + safe.y;
            continue;
        }
        doubt = select(vec2f(NEVER, 0.0), safe, leaping && safe.y + f < advance);
        let near = max(CREEP * footprint, SPACING * (t + reach));
        let longest = max(near, CREEP_LONGEST * footprint);
        // Where the field falls, not farther than to a little behind its expected end.
        let due = select(longest, f / fall + 0.25 * HIT * footprint, fall > 0.0);
        creep = select(0.0, clamp(min(creep * 2.0, due), near, longest), f < near);
        leaping = RELAXED && may_leap && fall > STEEP && f < LEAP * footprint && f > near;
        may_leap = true;
        slope = select(-1.0, mix(slope, -fall, ADAPTION), advance > 0.0);
        safe = vec2f(t, f);
        free = max(max(f, creep), select(0.0, proven, f > near));
        if t + free > exit && !leaping {
            return March(t, false, true, step + 1u);
        }
        let wide = f * 2.0 / (1.0 - min(slope, 0.9));
        relaxed = RELAXED && !leaping && wide > free * 1.01;
        // A leap ends a little inside, where the sign tells.
        t += select(select(free, wide, relaxed), f / fall + 0.25 * HIT * footprint, leaping);
    }
    return March(min(safe.x, doubt.x), false, steps == 0u, steps);
}

@compute @workgroup_size(8, 8)
fn trace(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = tiles[work.first_tile + group.x];
    var pixel = tile_pixel(tile) + tile_place(lane);
    var exists = view_contains(pixel);
    if work.packed == 1u {
        let at = group.x * 64u + lane;
        exists = at < atomicLoad(&rays[work.list]);
        let ray = atomicLoad(&rays[work.rays + at]);
        pixel = select(vec2u(0u), vec2u(ray & 0xffffu, ray >> 16u), exists);
    }
    let component = subject;
    field_begin(component);
    var depth = select(0.0, textureLoad(depth_target, pixel).x, exists);
    let direction = view_direction(pixel);
    let interval = bounds_interval(component, direction, 0.0);
    let exit = min(min(interval.y, view.far), depth);
    var start = max(max(interval.x, view.near), max(tile.start[tile_quad(lane)], bounds_half_space_entry(component, direction)));
    if work.round > 0u {
        start = textureLoad(march_target, pixel).x;
        start = select(start, NEVER, start == MARCH_ENDED);
    }
    let steps = select(0u, work.max_steps, exists && start <= exit);
    let marched = trace_march(component, direction, start, exit, steps);
    if exists {
        if marched.hit && marched.t < depth {
            depth = marched.t;
            textureStore(depth_target, pixel, vec4f(depth));
            textureStore(owner_target, pixel, vec4u(work.component));
        }
        trace_leave(pixel, marched);
        if COUNTING {
            trace_count(pixel, marched.evaluations);
        }
    }
    if work.packed == 1u {
        // What was found by single rays only makes tiles nearer: their farthest depths stay true.
        return;
    }
    // Depths are positive, so their bits are in order.
    atomicMax(&farthest, bitcast<u32>(depth));
    workgroupBarrier();
    if lane == 0u {
        textureStore(farthest_target, tile_pixel(tile) / TILE, vec4f(bitcast<f32>(atomicLoad(&farthest))));
    }
}

// What has not ended is left for the next round, or counted after the last one.
fn trace_leave(pixel: vec2u, marched: March) {
    if work.last_round == 1u {
        if !marched.ended {
            atomicAdd(&march_counts[work.component * COMPONENT_COUNTS], 1u);
        }
        return;
    }
    if work.round > 0u {
        textureStore(march_target, pixel, vec4f(select(marched.t, MARCH_ENDED, marched.ended)));
    } else if !marched.ended {
        textureStore(march_target, pixel, vec4f(marched.t));
        let at = atomicAdd(&rays[work.list], 1u);
        atomicMax(&ray_counts[work.list * 4u], at / 64u + 1u);
        atomicStore(&rays[work.rays + at], pixel.x | (pixel.y << 16u));
    }
}

// What a march took, for its pixel and for its component.
fn trace_count(pixel: vec2u, evaluations: u32) {
    let begun = select(0u, 1u, evaluations > 0u && work.packed == 0u);
    let took = vec4u(evaluations, begun, walked);
    let of_pixel = counts_of_pixel(arrayLength(&march_counts), pixel);
    let of_component = work.component * COMPONENT_COUNTS + 1u;
    for (var i = 0u; i < PIXEL_COUNTS; i += 1u) {
        atomicAdd(&march_counts[of_pixel + i], took[i]);
        atomicAdd(&march_counts[of_component + i], took[i]);
    }
}
