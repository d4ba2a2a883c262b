// The march of a pixel's ray through one component some of whose surfaces it may pass. Included by
// `trace.wgsl` instead of `common/trace_march.wgsl`.

#include "generated/surface.wgsl"
#include "common/veil.wgsl"

fn trace_march(component: Component, pixel: vec2u, subtile: Subtile, lane: u32, depth: f32, exists: bool) -> Traced {
    surface_begin(component);
    let ray = ray_through(component, pixel);
    let interval = bounds_interval(component, ray, 0.0);
    let exit = min(min(interval.y, dispatch.far), depth);
    var start = max(max(interval.x, dispatch.near), max(subtile.start, bounds_half_space_entry(component, ray)));
    if dispatch.relaunch > 0u {
        start = textureLoad(march_target, pixel).x;
        start = select(start, NEVER, start == MARCH_ENDED);
    }
    var traced = Traced(NEVER, start, true, 0u);
    march_side = 1.0;
    // A march that goes on may be on either side.
    march_takes_side = dispatch.relaunch > 0u;
    var left = select(0u, dispatch.max_steps, exists && start <= exit);
    var passed = VEILS_AT_ONCE * dispatch.relaunch;
    let last = passed + VEILS_AT_ONCE;
    while left > 0u && passed < last {
        let marched = march_along(component, ray, traced.resume, exit, 0.0, left, dispatch.footprint);
        left -= min(left, marched.evaluations);
        traced.evaluations += marched.evaluations;
        traced.ended = marched.ended;
        traced.resume = marched.t;
        if !marched.hit || marched.t >= exit {
            break;
        }
        let found = surface(ray_at(ray, marched.t));
#if TEXTURES
        veil_seen = veil_point(ray.direction, marched.t, found.gradient);
#end
        left -= min(left, 1u);
        traced.evaluations += 1u;
        if veil_covers(veil_opacity(found.materials), pixel, passed) {
            traced.t = marched.t;
            break;
        }
        passed += 1u;
        traced.resume = veil_behind(marched.t, length(component.eye));
        march_takes_side = true;
        traced.ended = traced.resume > exit;
        if traced.ended {
            break;
        }
    }
    return traced;
}
