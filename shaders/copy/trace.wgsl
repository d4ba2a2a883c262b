// The march of a pixel's ray through the copies of one type. Included by `trace.wgsl` instead of
// `common/trace_march.wgsl`.
//
// Each copy is marched in its own space, along a ray of unit length there: t grows by the same
// factor as the footprint of the pixel, so the march is that of any other component.

#include "copy/walk.wgsl"
#include "copy/copied.wgsl"

@group(2) @binding(9) var<storage, read_write> copied: array<vec4i>;

// In the last word of where an unfinished march goes on: within the copy of this cell. Else see
// `copy_walk_go_on`.
const TRACE_IN_COPY: i32 = 3;

fn trace_march(component: Component, pixel: vec2u, subtile: Subtile, lane: u32, depth: f32, exists: bool) -> Traced {
    let place = select(0u, copied_place(pixel), exists);
    let resume = select(dispatch.near, textureLoad(march_target, pixel).x, dispatch.relaunch > 0u);
    let runs = exists && resume != MARCH_ENDED;
    let left_at = select(vec4i(0), copied[place + 1u], dispatch.relaunch > 0u);
    let limit = min(depth, dispatch.far);
    let start = select(dispatch.near, subtile.start, dispatch.compacted == 0u);
    let origin = instancer_local_point(vec3f(0.0));
    let direction = instancer_local_direction(view_direction(pixel));
    var walk = copy_walk_begin(component.kind, origin, direction, start, select(-1.0, limit, runs), 0.0, dispatch.max_cells);
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
        let entry = select(max(interval.x, ray.skipped), resume * stretch, resumes);
        let exit = min(interval.y, visit.exit * stretch);
        let left = dispatch.max_steps - traced.evaluations;
        let meets = entry <= exit;
        let most = min(left, dispatch.copy_steps);
        let marched = march_along(component, ray, entry, exit, 0.0, select(0u, most, meets), dispatch.footprint);
        traced.evaluations += marched.evaluations;
        let t = select(NEVER, marched.t / stretch, marched.hit);
        if t < min(limit, traced.t) {
            traced.t = t;
            hit = visit.copy.place;
        }
        // A ray that needs more steps than it may take passes the copy.
        if (!marched.ended && marched.evaluations < dispatch.copy_steps) || (meets && left == 0u) {
            traced.ended = false;
            traced.resume = marched.t / stretch;
            leaves_at = vec4i(visit.copy.place, TRACE_IN_COPY);
            break;
        }
    }
    if walk.exhausted {
        traced.ended = false;
        traced.resume = walk.entry;
        leaves_at = copy_walk_left(&walk);
    }
    if traced.t < limit {
        copied[place] = vec4i(hit, i32(dispatch.component) + 1);
    }
    if !traced.ended {
        copied[place + 1u] = leaves_at;
    }
    return traced;
}
