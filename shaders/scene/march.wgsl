// Rays against the whole scene, from anywhere. Counterpart of `SceneEvaluator::ray` in
// `src/field/scene_eval.rs`.
//
// `t` counts from the eye along the whole path, as `Ray.skipped` does: a ray that leaves a surface
// at depth 5 begins at 5, and its footprint continues from there.

#include "common/march.wgsl"
#include "scene/hierarchy.wgsl"
#include "scene/surface_ray.wgsl"

struct SceneMarch {
    // The nearest hit, or the far limit.
    t: f32,
    // The component of the hit; NO_COMPONENT for none.
    component: u32,
    // The last visited component.
    visit: SceneVisit,
    // `t` at which the march through it resumes; NEVER once it has ended.
    resume: f32,
    // Number of visited components without bounds, plus one; 0 while others remain.
    unbounded: u32,
    // Whether the march is complete. If not, another dispatch calls `scene_march` again with this
    // state.
    ended: bool,
}

// A new march that ends at `far`.
fn scene_march_begin(far: f32) -> SceneMarch {
    return SceneMarch(far, NO_COMPONENT, SceneVisit(-1.0, -1.0, 0u), NEVER, 0u, false);
}

// Moves on to the next component. Ended if there is none; unchanged if the limit is reached.
fn scene_march_next(ray: Ray, near: f32, begun: SceneMarch) -> SceneMarch {
    var march = begun;
    if march.unbounded == 0u {
        march.visit = scene_next(ray, near, march.t, march.visit);
        if scene_visits >= scene_limits.max_visits {
            return begun;
        }
        march.unbounded = select(0u, 1u, march.visit.component == NO_COMPONENT);
    }
    if march.unbounded > 0u {
        let at = scene_limits.tree_nodes + march.unbounded - 1u;
        march.ended = at >= scene_limits.all_nodes;
        march.unbounded += 1u;
        march.visit = SceneVisit(near, march.t, hierarchy[min(at, scene_limits.all_nodes - 1u)].link);
    }
    march.resume = march.visit.entry;
    return march;
}

// Follows the ray from `near` to the first surface, through one component after the other in the
// order of their bounds, each by its own field.
fn scene_march(ray: Ray, near: f32, begun: SceneMarch) -> SceneMarch {
    var march = begun;
    while !march.ended && scene_evaluations < scene_limits.max_evaluations && scene_visits < scene_limits.max_visits {
        let is_new = march.resume == NEVER;
        if is_new {
            march = scene_march_next(ray, near, march);
            if march.ended || march.resume == NEVER {
                break;
            }
        }
        let component = scene_components[march.visit.component];
        let local = Ray(ray.origin + component.eye, ray.skipped, ray.direction);
        let start = select(march.resume, max(march.resume, bounds_half_space_entry(component, local)), is_new);
        let exit = min(march.visit.exit, march.t);
        let steps = select(0u, scene_limits.max_evaluations - scene_evaluations, start <= exit);
        field_begin(component);
        let marched = march_along(component, local, start, exit, 0.0, steps, view.footprint);
        scene_evaluations += marched.evaluations;
        if marched.hit && marched.t < march.t {
            march.t = marched.t;
            march.component = march.visit.component;
        }
        march.resume = select(marched.t, NEVER, marched.ended);
    }
    return march;
}
