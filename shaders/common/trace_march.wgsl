// The march of a pixel's ray through one component. Included by `trace.wgsl`, which declares what it
// uses.

fn trace_march(component: Component, pixel: vec2u, subtile: Subtile, lane: u32, depth: f32, exists: bool) -> Traced {
    let ray = ray_through(component, pixel);
    let interval = bounds_interval(component, ray, 0.0);
    let exit = min(min(interval.y, dispatch.far), depth);
    let passed = select(subtile.start, subtile_start(subtile, lane), VERIFIED_OVERSTEP);
    let entry = bounds_half_space_entry(component, ray);
    var start = max(max(interval.x, dispatch.near), max(passed, entry));
    if dispatch.relaunch > 0u {
        start = textureLoad(march_target, pixel).x;
        start = select(start, NEVER, start == MARCH_ENDED);
    }
    let steps = select(0u, dispatch.max_steps, exists && start <= exit);
    // For a half space the angle of entry is known, for others the descent that the cone measured.
    let known_descent = select(select(0.0, subtile.descent, VERIFIED_OVERSTEP), -dot(component.half_space.xyz, ray.direction), start == entry);
    let descent = select(0.0, known_descent, dispatch.relaunch == 0u);
    let marched = march_along(component, ray, start, exit, descent, steps, dispatch.footprint);
    return Traced(select(NEVER, marched.t, marched.hit), marched.t, marched.ended, marched.evaluations);
}
