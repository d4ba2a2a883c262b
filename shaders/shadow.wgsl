// Pass `shadow`: soft shadows of the pixels with hits, by cones against the whole scene. Each pixel
// takes one cone after the other, one for each light that reaches it. An invocation that reaches
// its limits leaves its state to the next dispatch. The second entry point is occlusion.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch_params.wgsl"
#include "common/light.wgsl"
#include "scene/surface_ray.wgsl"
#if MESH_RAYS
#include "scene/mesh_rays.wgsl"
#end
#include "scene/cone.wgsl"
#include "light/shadow_settings.wgsl"
#include "light/occlusion.wgsl"
#include "light/extent.wgsl"
#include "light/sample.wgsl"
#include "light/shadow_state.wgsl"
#include "scene/occluder.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var normal_target: texture_2d<f32>;
@group(2) @binding(2) var<storage, read> lights: array<Light>;
// See `light/shadow_settings.wgsl`.
@group(2) @binding(3) var<storage, read_write> shares: array<u32>;
// SHADOW_STATE words for each pixel of the part.
@group(2) @binding(4) var<storage, read_write> states: array<u32>;
// Number of pixels that have not ended.
@group(2) @binding(5) var<storage, read_write> unfinished: array<atomic<u32>>;
@group(2) @binding(6) var<uniform> settings: ShadowSettings;
@group(2) @binding(7) var<uniform> dispatch: DispatchParams;

// See the CPU's constants of these names.
const OCCLUSION_NEAR: f32 = 0.0833333;
const OCCLUSION_FAR: f32 = 0.76;
const OCCLUSION_GROWTH: f32 = 3.0;
const OCCLUSION_SINE: f32 = 0.5;

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

@compute @workgroup_size(8, 8)
fn shadow(@builtin(global_invocation_id) id: vec3u) {
    let pixel = dispatch.origin + id.xy;
    let exists = all(pixel < dispatch.end);
    let width = dispatch.end.x - dispatch.origin.x;
    let own = 2u * SHADOW_STATE * (id.y * width + id.x);
    let first = (pixel.y * view.width + pixel.x) * settings.stride;
    let point = shadow_point(pixel);
    let tasks = select(0u, settings.lights, point.depth < BACKGROUND);
    var task = 0u;
    var march = cone_march_begin();
    if exists && dispatch.relaunch == 1u {
        task = states[own];
        march = shadow_load(own);
    } else if exists {
        for (var i = 0u; i < (settings.lights + 3u) / 4u; i += 1u) {
            shares[first + i] = 0xffffffffu;
        }
    }
    var cone: SceneCone;
    var has_cone = false;
    while task < tasks && scene_evaluations < scene_limits.max_evaluations && scene_visits < scene_limits.max_visits
        && scene_has_mesh_visits() {
        if !has_cone {
            scene_visits += 1u;
            cone = shadow_cone(point, task, (march.state & CONE_RAY) != 0u);
            has_cone = cone.far > 0.0;
            if !has_cone {
                task += 1u;
                continue;
            }
        }
        if (march.state & CONE_ACTIVE) == 0u {
            cone_next(cone, &march);
        }
        if (march.state & CONE_ACTIVE) != 0u {
            let component = scene_components[march.visit.component];
            let p = cone.origin + cone.direction * march.t + component.eye;
            // Where the bounds are outside of the cone, so is the component.
            var f = length(max(max(component.low - p, p - component.high), vec3f(0.0)));
            var slack = 0.0;
            scene_visits += 1u;
            if f <= cone.spread * march.t {
                field_begin(component);
                f = field(p);
                slack = field_slack();
                scene_evaluations += 1u;
            }
            cone_step(cone, &march, f, slack);
        }
        if (march.state & CONE_ENDED) != 0u {
            has_cone = false;
            let is_open = (march.state & (CONE_UNPROVEN | CONE_RAY)) == CONE_UNPROVEN;
            let needs_ray = is_open && settings.sample > 0u;
            if !needs_ray {
                // A sample asks the meshes along a ray to a point of the light; without samples, to its middle.
                var share = march.share;
                if share > 0.0 {
                    share *= scene_mesh_share(shadow_cone(point, task, settings.sample > 0u));
                }
                shadow_store(first, task, share);
                task += 1u;
            }
            march = cone_march_begin();
            march.state = select(0u, CONE_RAY, needs_ray);
        }
    }
    if exists {
        states[own] = task;
        if task < tasks {
            shadow_save(own, march);
            atomicAdd(&unfinished[0], 1u);
        }
    }
}

// Occlusion: six cones through one component after the other. Counterpart of `scene_occlusion` in
// `src/field/light/occlusion.rs`.
@compute @workgroup_size(8, 8)
fn shadow_occlusion(@builtin(global_invocation_id) id: vec3u) {
    let pixel = dispatch.origin + id.xy;
    let exists = all(pixel < dispatch.end);
    let own = 2u * SHADOW_STATE * (id.y * (dispatch.end.x - dispatch.origin.x) + id.x) + SHADOW_STATE;
    let point = shadow_point(pixel);
    let footprint = view.footprint * point.depth;
    let p = scene_surface_ray(point.position, point.normal, point.normal, point.depth).origin;
    let near = max(OCCLUSION_NEAR * settings.occlusion_radius, 2.0 * footprint);
    let far = OCCLUSION_FAR * settings.occlusion_radius;
    // The least ratios of the six cones.
    var low = vec3f(1.0);
    var high = vec3f(1.0);
    var after = 0u;
    // The cone in the component of the node before `after`; OCCLUSION_CONES for the next component.
    var cone = OCCLUSION_CONES;
    var t = near;
    var ended = point.depth >= BACKGROUND;
    if exists && dispatch.relaunch == 1u {
        after = states[own];
        cone = states[own + 1u];
        t = bitcast<f32>(states[own + 2u]);
        ended = states[own + 3u] == 1u;
        low = bitcast<vec3f>(vec3u(states[own + 4u], states[own + 5u], states[own + 6u]));
        high = bitcast<vec3f>(vec3u(states[own + 7u], states[own + 8u], states[own + 9u]));
    }
    while !ended && scene_evaluations < scene_limits.max_evaluations && scene_visits < scene_limits.max_visits {
        // Finds the next evaluation. Invocations that run together then evaluate together.
        var component: Component;
        var q = vec3f(0.0);
        var is_found = false;
        while !is_found && !ended && scene_visits < scene_limits.max_visits {
            if cone == OCCLUSION_CONES {
                let found = scene_occluder(p, point.normal, far * (1.0 + OCCLUSION_SINE), after);
                let is_valid = scene_visits < scene_limits.max_visits;
                after = select(after, found + 1u, is_valid);
                ended = is_valid && found >= scene_limits.all_nodes;
                cone = select(cone, 0u, is_valid);
                t = near;
            }
            if !ended && cone < OCCLUSION_CONES {
                scene_visits += 1u;
                component = scene_components[hierarchy[after - 1u].link];
                q = p + occlusion_cone(point.normal, cone).xyz * t + component.eye;
                let plane = dot(component.half_space.xyz, q) + component.half_space.w;
                // Otherwise the bounds are outside of the sphere, and so is the component.
                let bound = max(length(max(max(component.low - q, q - component.high), vec3f(0.0))), plane);
                is_found = bound < OCCLUSION_SINE * t * 0.999 && t <= far;
                // At the same distances for all: steps by the field would show the bounds.
                let next = select(t * OCCLUSION_GROWTH, t, is_found);
                cone += select(0u, 1u, next > far);
                t = select(next, near, next > far);
            }
        }
        if is_found {
            scene_evaluations += 1u;
            field_begin(component);
            let f = field(q);
            let ratio = (f + select(0.0, field_slack(), f > 0.0)) / (OCCLUSION_SINE * t);
            low = select(low, min(low, vec3f(ratio)), vec3u(0u, 1u, 2u) == vec3u(cone));
            high = select(high, min(high, vec3f(ratio)), vec3u(3u, 4u, 5u) == vec3u(cone));
            let next = t * OCCLUSION_GROWTH;
            let is_over = next > far || ratio <= -1.0;
            cone += select(0u, 1u, is_over);
            t = select(next, near, is_over);
        }
    }
    if exists {
        shadow_leave_occlusion(own, after, cone, t, ended, low, high, (pixel.y * view.width + pixel.x) * settings.stride);
    }
}
