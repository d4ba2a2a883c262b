// The march of a pixel's ray through the copies of one type that it may pass. Included by
// `trace.wgsl` instead of `copy/trace.wgsl`, which explains it.

#include "generated/surface.wgsl"
#include "common/veil.wgsl"
#include "copy/material.wgsl"
#include "copy/walk.wgsl"
#include "copy/copied.wgsl"

@group(2) @binding(9) var<storage, read_write> copied: array<vec4i>;

// In the last word of where an unfinished march goes on: within the copy of this cell. Else see
// `copy_walk_go_on`.
const TRACE_IN_COPY: i32 = 3;

fn trace_march(component: Component, pixel: vec2u, subtile: Subtile, lane: u32, depth: f32, exists: bool) -> Traced {
    surface_begin(component);
    let place = select(0u, copied_place(pixel), exists);
    let resume = select(dispatch.near, textureLoad(march_target, pixel).x, dispatch.relaunch > 0u);
    let left_at = select(vec4i(0), copied[place + 1u], dispatch.relaunch > 0u);
    let limit = min(depth, dispatch.far);
    let origin = instancer_local_point(vec3f(0.0));
    let direction = instancer_local_direction(view_direction(pixel));
    var walk = copy_walk_begin(
        component.kind, origin, direction, select(dispatch.near, subtile.start, dispatch.compacted == 0u),
        select(-1.0, limit, exists && resume != MARCH_ENDED), 0.0, dispatch.max_cells,
    );
    if left_at.w != 0 {
        let mode = select(left_at.w, WALK_AT_CELL, left_at.w == TRACE_IN_COPY);
        copy_walk_go_on(&walk, vec4i(left_at.xyz, mode), limit);
    }
    var is_first = left_at.w == TRACE_IN_COPY;
    var traced = Traced(NEVER, resume, true, 0u);
    var leaves_at = vec4i(0);
    var hit = vec3i(0);
    var visit: CopyVisit;
    while copy_walk_next(&walk, component.kind, min(limit, traced.t), &visit) {
        // The march was left within it.
        let resumes = is_first && all(visit.copy.place == left_at.xyz);
        is_first = false;
        let along = copy_local_direction(visit.copy, direction);
        let stretch = length(along);
        // Positions count from where the ray enters: so they are no larger than the copy.
        let local = copy_local_point(visit.copy, origin + direction * visit.entry) + component.eye;
        let ray = Ray(local, visit.entry * stretch, along / stretch);
        let interval = bounds_interval(component, ray, 0.0);
        let begun = traced.evaluations;
        march_side = 1.0;
        march_takes_side = resumes;
        var begin_at = select(max(interval.x, ray.skipped), resume * stretch, resumes);
        let exit = min(interval.y, visit.exit * stretch);
        var passed = select(0u, VEILS_AT_ONCE * dispatch.relaunch, resumes);
        var is_left = false;
        while begin_at <= exit {
            let most = min(dispatch.max_steps - traced.evaluations, dispatch.copy_steps - (traced.evaluations - begun));
            is_left = most == 0u || passed == VEILS_AT_ONCE * (dispatch.relaunch + 1u);
            if is_left {
                break;
            }
            let marched = march_along(component, ray, begin_at, exit, 0.0, most, dispatch.footprint);
            traced.evaluations += marched.evaluations;
            begin_at = marched.t;
            is_left = !marched.ended;
            if !marched.hit || marched.t / stretch >= min(limit, traced.t) {
                break;
            }
            let seen = surface(ray_at(ray, marched.t));
            let opacity = veil_opacity_of_copy(visit.copy, seen, view_direction(pixel), marched.t / stretch);
            if veil_covers(opacity, pixel, veil_layer_of_copy(visit.copy.cell) + passed) {
                traced.t = marched.t / stretch;
                hit = visit.copy.place;
                break;
            }
            passed += 1u;
            begin_at = veil_behind(marched.t, length(local));
            march_takes_side = true;
        }
        // A ray that needs more steps than it may take passes the copy.
        if is_left && traced.evaluations - begun < dispatch.copy_steps {
            traced.ended = false;
            traced.resume = begin_at / stretch;
            leaves_at = vec4i(visit.copy.place, TRACE_IN_COPY);
            break;
        }
    }
    if walk.exhausted {
        traced.ended = false;
        traced.resume = walk.entry;
        leaves_at = copy_walk_left(&walk);
    }
    trace_keep_copy(place, hit, leaves_at, traced, limit);
    return traced;
}

// The opacity of a surface of a copy, which the eye sees in this direction at `t`.
fn veil_opacity_of_copy(copy: Copy, found: Surface, direction: vec3f, t: f32) -> f32 {
    let replaced = copy_material(copy).replaced;
    var mixture = found.materials;
    if replaced != COPY_ABSENT {
        mixture = mixture_of(replaced);
    }
#if TEXTURES
    veil_seen = veil_point(direction, t, copy_world_gradient(copy, found.gradient));
    veil_there = TexturedPoint(
        copy_local_point(copy, instancer_local_point(veil_seen.position)),
        normalize(copy_local_direction(copy, instancer_local_direction(veil_seen.normal))),
        copy_local_direction(copy, instancer_local_direction(veil_seen.across)),
        copy_local_direction(copy, instancer_local_direction(veil_seen.along)),
    );
#end
    return veil_opacity(mixture);
}

// What the surfaces of a copy add to their layer.
fn veil_layer_of_copy(cell: vec3i) -> u32 {
    let place = bitcast<vec3u>(cell);
    return coverage_hash(place.x + coverage_hash(place.y + coverage_hash(place.z)));
}

// Keeps which copy a pixel shows, and where its march goes on.
fn trace_keep_copy(place: u32, hit: vec3i, leaves_at: vec4i, traced: Traced, limit: f32) {
    if traced.t < limit {
        copied[place] = vec4i(hit, i32(dispatch.component) + 1);
    }
    if !traced.ended {
        copied[place + 1u] = leaves_at;
    }
}
