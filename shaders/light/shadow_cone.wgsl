// The cones of the pass `shadow`, and the evaluation of what is in their way. Needs the bindings of
// the pass.

// Least step of a ray, in footprints.
const RAY_STEP: f32 = 0.004;

// A point of a surface.
struct ShadowPoint {
    pixel: vec2u,
    depth: f32,
    position: vec3f,
    normal: vec3f,
}

// The cone to a light; it ends at 0 if there is nothing to do. `is_ray`: a ray to a point of it.
fn shadow_cone(point: ShadowPoint, task: u32, is_ray: bool) -> SceneCone {
    let light = lights[task];
    let toward = light_toward(light, point.position);
    let spread = light_spread(light, toward.w);
    let place = sample_disc(point.pixel, task, settings.sample) * spread;
    let ray = normalize(toward.xyz + occlusion_right(toward.xyz) * place.x + occlusion_up(toward.xyz) * place.y);
    let start = scene_surface_ray(point.position, point.normal, toward.xyz, point.depth);
    let far = select(0.0, toward.w, dot(point.normal, toward.xyz) > 0.0);
    let width = select(spread, 0.0, is_ray);
    // A ray must not step over the corner of a solid, which a cone sees at its side.
    let least = select(0.25, RAY_STEP, is_ray) * view.footprint * point.depth;
    let fineness = select(settings.fineness, 0.0, is_ray);
    let along = select(toward.xyz, ray, is_ray);
    let climb = dot(point.normal, along);
    let is_above = climb > width * sqrt(max(1.0 - climb * climb, 0.0)) + 1e-6;
    let above = select(vec3f(0.0), point.normal, is_above);
    return SceneCone(start.origin, 0.0, along, far, width, width, least, fineness, above);
}

// The point of an invocation; BACKGROUND deep if there is nothing to do.
fn shadow_point(pixel: vec2u) -> ShadowPoint {
    let depth = select(BACKGROUND, textureLoad(depth_target, pixel, 0).x, all(pixel < dispatch.end));
    let normal = textureLoad(normal_target, pixel, 0).xyz;
    return ShadowPoint(pixel, depth, view_direction(pixel) * depth, normal);
}

// The field of a component, or the distance to its bounds if those are farther away than `reach`, and
// by how much the field likely exceeds it. The only call of the field.
fn shadow_field(component: Component, p: vec3f, reach: f32) -> vec2f {
    scene_visits += 1u;
    // Where the bounds are outside of the cone, so is the component.
    let bound = length(max(max(component.low - p, p - component.high), vec3f(0.0)));
    if bound > reach {
        return vec2f(bound, 0.0);
    }
    field_begin(component);
    let f = field(p);
    scene_evaluations += 1u;
    return vec2f(f, field_slack());
}

// The share of a light that meshes leave as well. A sample asks them along a ray to a point of the
// light; without samples, to its middle.
fn shadow_mesh_share(point: ShadowPoint, task: u32, share: f32) -> f32 {
    if share <= 0.0 {
        return share;
    }
    return share * scene_mesh_share(shadow_cone(point, task, settings.sample > 0u));
}
