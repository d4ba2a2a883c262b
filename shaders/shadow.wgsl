// Pass `shadow`: soft shadows of the pixels with hits, by cones against the whole scene. Each pixel
// takes one cone after the other, one for each light that reaches it; in samples of still pictures
// with occlusion, rays to the environment come last: another pipeline has these (AMBIENT_RAYS). An invocation that reaches its limits
// leaves its state to the next dispatch. The second entry point, occlusion by cones, is in
// `light/shadow_occlusion.wgsl`.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/dispatch_params.wgsl"
#include "common/light.wgsl"
#include "scene/surface_ray.wgsl"
#if MESH_RAYS
#include "scene/mesh_rays.wgsl"
#include "scene/mesh_near.wgsl"
#end
#include "scene/cone.wgsl"
#if SCENE_COPIES
#include "scene/copies.wgsl"
#end
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
// `shadow_place` words for each pixel of the part, and again for its occlusion.
@group(2) @binding(4) var<storage, read_write> states: array<u32>;
// Number of pixels that have not ended, and of evaluations if pipelines count.
@group(2) @binding(5) var<storage, read_write> unfinished: array<atomic<u32>>;
@group(2) @binding(6) var<uniform> settings: ShadowSettings;
@group(2) @binding(7) var<uniform> dispatch: DispatchParams;

#include "light/shadow_cone.wgsl"
#include "light/shadow_occlusion.wgsl"

@compute @workgroup_size(8, 8)
fn shadow(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = dispatch.origin + shadow_invocation(group, lane) * settings.spacing;
    let exists = all(pixel < dispatch.end);
    let own = shadow_place(shadow_invocation(group, lane), 0u);
    let first = (pixel.y * view.width + pixel.x) * settings.stride;
    let point = shadow_point(pixel);
    let tasks = select(0u, shadow_tasks(), point.depth < BACKGROUND);
    var task = 0u;
    var march = shadow_march_begin(task, false);
#if SCENE_COPIES
    var copies = copies_begin();
    var walk: CopyWalk;
    var inner: SceneCone;
#end
    if exists && dispatch.relaunch == 1u {
        task = states[own];
        march = shadow_load(own);
#if SCENE_COPIES
        copies = shadow_load_copies(own);
#end
    } else if exists {
        shadow_clear(first);
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
                march = shadow_march_begin(task, false);
                continue;
            }
        }
        if (march.state & (CONE_ACTIVE | CONE_COPIES)) == 0u {
            cone_next(cone, &march);
        }
        var index = march.visit.component;
        var within = cone;
        var t = march.t;
#if SCENE_COPIES
        if (march.state & CONE_COPIES) != 0u {
            if (march.state & CONE_ACTIVE) == 0u || !copies.walks {
                copies_next(cone, &march, &copies, &walk, &inner);
            }
            index = copies.component;
            within = inner;
            t = march.t - copies.skipped;
        }
#end
        if (march.state & CONE_ACTIVE) != 0u {
            let component = scene_components[index];
            let p = within.origin + within.direction * t + component.eye;
            let f = shadow_field(component, p, within.spread * march.t);
            cone_step(within, &march, f.x, f.y);
        }
        if (march.state & CONE_ENDED) != 0u {
            has_cone = false;
            let needs_ray = (march.state & (CONE_UNPROVEN | CONE_RAY)) == CONE_UNPROVEN && settings.sample > 0u;
            if !needs_ray {
                shadow_store_task(first, point, task, shadow_mesh_share(point, task, march.share));
                task += 1u;
            }
            march = shadow_march_begin(task, needs_ray);
#if SCENE_COPIES
            copies = copies_begin();
#end
        }
    }
    if exists {
#if SCENE_COPIES
        copies_leave(&march, &copies, &walk);
        shadow_save_copies(own, copies.left_at, false);
#end
        shadow_leave(own, march, task, tasks);
    }
}
