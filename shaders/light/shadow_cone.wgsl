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

// Number of cones and rays of a pixel.
fn shadow_tasks() -> u32 {
    var tasks = settings.lights;
#if AMBIENT_RAYS
    tasks += OCCLUSION_RAYS;
#end
    return tasks;
}

// Where the share of a task is stored: of a light, or of a ray to the environment behind the cones.
fn shadow_slot(task: u32) -> u32 {
    let of_ray = (settings.lights + 3u) / 4u * 4u + OCCLUSION_CONES + task - settings.lights;
    return select(task, of_ray, task >= settings.lights);
}

// Begins the march of a task.
fn shadow_march_begin(task: u32, is_ray: bool) -> ConeMarch {
    var march = cone_march_begin();
    march.state = select(0u, CONE_RAY, is_ray || task >= settings.lights);
    return march;
}

#if AMBIENT_RAYS
// The direction of a ray to the environment.
struct AmbientRay {
    // Point of the unit disc below it.
    place: vec2f,
    // The cone to whose part of the hemisphere it belongs.
    cone: u32,
}

// Rays go to the part of a cone as often as it weighs and is in doubt.
fn shadow_ambient_direction(point: ShadowPoint, task: u32) -> AmbientRay {
    let first = (point.pixel.y * view.width + point.pixel.x) * settings.stride;
    let slot = shadow_slot(settings.lights) - OCCLUSION_CONES;
    var parts: array<f32, OCCLUSION_CONES>;
    var all = 0.0;
    for (var i = 0u; i < OCCLUSION_CONES; i += 1u) {
        let at = slot + i;
        let share = f32(shares[first + at / 4u] >> (8u * (at & 3u)) & 0xffu) / 255.0;
        parts[i] = occlusion_cone(point.normal, i).w * occlusion_doubt(share);
        all += parts[i];
    }
    let unit = sample_around(point.pixel, settings.lights, OCCLUSION_RAYS * settings.sample + task - settings.lights);
    var left = unit.x * all;
    var chosen = OCCLUSION_CONES;
    var within = 0.0;
    for (var i = 0u; i < OCCLUSION_CONES; i += 1u) {
        let is_here = chosen == OCCLUSION_CONES && (left < parts[i] || i + 1u == OCCLUSION_CONES);
        chosen = select(chosen, i, is_here);
        within = select(within, left / parts[i], is_here);
        left -= parts[i];
    }
    return AmbientRay(occlusion_place(chosen, vec2f(clamp(within, 0.0, 1.0), unit.y)), chosen);
}

#end

// Stores the share of a task; of a ray to the environment, which cone it was about and whether it is free.
fn shadow_store_task(first: u32, point: ShadowPoint, task: u32, share: f32) {
    var stored = share;
#if AMBIENT_RAYS
    if task >= settings.lights {
        let found = select(0u, OCCLUSION_FREE, share > 0.5);
        stored = f32(shadow_ambient_direction(point, task).cone + found) / 255.0;
    }
#end
    shadow_store(first, shadow_slot(task), stored);
}

#if AMBIENT_RAYS
// A ray of occlusion.
fn shadow_ambient_ray(point: ShadowPoint, task: u32) -> SceneCone {
    let place = shadow_ambient_direction(point, task).place;
    let height = sqrt(max(1.0 - dot(place, place), 1e-6));
    let around = occlusion_right(point.normal) * place.x + occlusion_up(point.normal) * place.y;
    let along = normalize(around + point.normal * height);
    let start = scene_surface_ray(point.position, point.normal, along, point.depth);
    let least = RAY_STEP * view.footprint * point.depth;
    return SceneCone(start.origin, 0.0, along, settings.occlusion_radius, 0.0, 0.0, least, 0.0, point.normal);
}

#end
// The cone to a light; it ends at 0 if there is nothing to do. `is_ray`: a ray to a point of it.
fn shadow_cone(point: ShadowPoint, task: u32, is_ray: bool) -> SceneCone {
#if AMBIENT_RAYS
    if task >= settings.lights {
        return shadow_ambient_ray(point, task);
    }
#end
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
#if VEILS
    cone_veil = component.translucency;
#end
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
