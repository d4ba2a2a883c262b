// Pass `trace`: one component against the depth target, by sphere tracing (Hart 1996).

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "field/value.wgsl"

@group(2) @binding(0) var depth_target: texture_storage_2d<r32float, read_write>;
@group(2) @binding(1) var owner_target: texture_storage_2d<r32uint, write>;
// Where a march that has not ended goes on; MARCH_ENDED for the others.
@group(2) @binding(2) var march_target: texture_storage_2d<r32float, read_write>;
// Rays that had not ended after the last round, per component.
@group(2) @binding(3) var<storage, read_write> unfinished: array<atomic<u32>>;

const MARCH_ENDED: f32 = -1.0;
// Nearer than this, in footprints, the march creeps until it sees the sign change: a ray that only
// comes near is never taken for a hit.
const CREEP_BELOW: f32 = 1e-3;
// Longest creeping step, in footprints: a chord shorter than this may be missed.
const CREEP_LONGEST: f32 = 0.03;
// Relative spacing of f32, with room for the rounding of a few operations.
const SPACING: f32 = 2.4e-7;

// Where the ray is within the component's bounds: entry and exit.
fn bounds_interval(component: Component, direction: vec3f) -> vec2f {
    // A component of the direction that is zero would give 0 times infinity.
    let d = select(direction, vec3f(1e-9), abs(direction) < vec3f(1e-9));
    let a = (component.low - component.eye) / d;
    let b = (component.high - component.eye) / d;
    let near = min(a, b);
    let far = max(a, b);
    var interval = vec2f(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
    let plane = component.half_space;
    let height = dot(plane.xyz, component.eye) + plane.w;
    let climb = dot(plane.xyz, direction);
    if height > 0.0 {
        // The eye is outside: in at the crossing, or never. A little early, so that the march sees
        // the sign change.
        let crossing = -height / min(climb, -1e-30) * (1.0 - 4.0 * SPACING);
        interval.x = select(3e38, max(interval.x, crossing), climb < 0.0);
    }
    return interval;
}

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) id: vec3u) {
    let pixel = work.origin + id.xy;
    if pixel.x >= work.end.x || pixel.y >= work.end.y {
        return;
    }
    let component = components[work.component];
    let direction = view_direction(pixel);
    let interval = bounds_interval(component, direction);
    let depth = textureLoad(depth_target, pixel).x;
    let exit = min(min(interval.y, view.far), depth);
    var t = max(interval.x, view.near);
    if work.round > 0u {
        t = textureLoad(march_target, pixel).x;
        if t == MARCH_ENDED {
            return;
        }
    }
    var ended = t > exit;
    var hit = false;
    var last = vec2f(t, 0.0);
    var creep = 0.0;
    for (var step = 0u; step < work.max_steps && !ended; step += 1u) {
        let f = field(component.first, component.end, component.eye + direction * t);
        if f < 0.0 {
            hit = true;
            // Secant between the last point outside and this one; the first point has none before it.
            t = select(t, last.x + (t - last.x) * last.y / (last.y - f), last.y > 0.0);
            break;
        }
        let footprint = view.footprint * t;
        let near_enough = max(CREEP_BELOW * footprint, SPACING * (t + length(component.eye)));
        creep = select(0.0, clamp(creep * 2.0, near_enough, max(near_enough, CREEP_LONGEST * footprint)), f < near_enough);
        last = vec2f(t, f);
        t += max(f, creep);
        ended = t > exit;
    }
    if hit && t < depth {
        textureStore(depth_target, pixel, vec4f(t));
        textureStore(owner_target, pixel, vec4u(work.component));
    }
    let open = !hit && !ended;
    if work.last_round == 1u {
        if open {
            atomicAdd(&unfinished[work.component], 1u);
        }
    } else {
        textureStore(march_target, pixel, vec4f(select(MARCH_ENDED, t, open)));
    }
}
