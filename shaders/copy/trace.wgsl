// The march of a pixel's ray through the copies of one type. Included by `trace.wgsl` instead of
// `common/trace_march.wgsl`.
//
// Each copy is marched in its own space, along a ray of unit length there: t grows by the same
// factor as the footprint of the pixel, so the march is that of any other component.

#include "copy/walk.wgsl"
#include "copy/copied.wgsl"

@group(2) @binding(9) var<storage, read_write> copied: array<vec4i>;

// In the last word of where an unfinished march goes on: within this copy, or with this slab.
const TRACE_IN_COPY: i32 = 1;
const TRACE_IN_SLAB: i32 = 2;

fn trace_march(component: Component, pixel: vec2u, subtile: Subtile, lane: u32, depth: f32, exists: bool) -> Traced {
    let place = select(0u, copied_place(pixel), exists);
    let resume = select(view.near, textureLoad(march_target, pixel).x, dispatch.relaunch > 0u);
    let runs = exists && resume != MARCH_ENDED;
    let left_at = select(vec4i(0), copied[place + 1u], dispatch.relaunch > 0u);
    let limit = min(depth, view.far);
    let start = select(view.near, subtile.start, dispatch.compacted == 0u);
    let origin = instancer_local_point(vec3f(0.0));
    let direction = instancer_local_direction(view_direction(pixel));
    var walk = copy_walk_begin(origin, direction, start, select(-1.0, limit, runs), 0.0, dispatch.max_cells);
    if left_at.w != 0 {
        copy_walk_skip(&walk, left_at.xyz);
    }
    var seeks = left_at.w == TRACE_IN_COPY;
    var traced = Traced(NEVER, resume, true, 0u);
    var leaves_at = vec4i(0);
    var hit = vec3i(0);
    var visit: CopyVisit;
    while copy_walk_next(&walk, component.kind, min(limit, traced.t), &visit) {
        // Copies before the one where the march was left have been seen.
        if seeks && any(visit.copy.place != left_at.xyz) {
            continue;
        }
        let along = copy_local_direction(visit.copy, direction);
        let stretch = length(along);
        // Positions count from where the ray enters: so they are no larger than the copy.
        let local = copy_local_point(visit.copy, origin + direction * visit.entry) + component.eye;
        let ray = Ray(local, visit.entry * stretch, along / stretch);
        let interval = bounds_interval(component, ray, 0.0);
        let entry = select(max(interval.x, ray.skipped), resume * stretch, seeks);
        let exit = min(interval.y, visit.exit * stretch);
        seeks = false;
        let left = dispatch.max_steps - traced.evaluations;
        let meets = entry <= exit;
        let marched = march_along(component, ray, entry, exit, 0.0, select(0u, left, meets));
        traced.evaluations += marched.evaluations;
        let t = select(NEVER, marched.t / stretch, marched.hit);
        if t < min(limit, traced.t) {
            traced.t = t;
            hit = visit.copy.place;
        }
        if !marched.ended || (meets && left == 0u) {
            traced.ended = false;
            traced.resume = marched.t / stretch;
            leaves_at = vec4i(visit.copy.place, TRACE_IN_COPY);
            break;
        }
    }
    if walk.exhausted || seeks {
        traced.ended = false;
        traced.resume = walk.entry;
        leaves_at = vec4i(select(copy_walk_slab(&walk), left_at.xyz, seeks), TRACE_IN_SLAB);
    }
    if traced.t < limit {
        copied[place] = vec4i(hit, i32(dispatch.component) + 1);
    }
    if !traced.ended {
        copied[place + 1u] = leaves_at;
    }
    return traced;
}
