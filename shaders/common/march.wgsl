// The march along a ray through one component.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/ray.wgsl"
#include "common/lookahead.wgsl"
#include "generated/value.wgsl"
#include "common/march_state.wgsl"

// Only from outside, at an angle that is not grazing: if the field is at most this, in footprints
// of a pixel there, the march tests whether the field is negative just behind its expected end.
const CLOSE: f32 = 1e-3 * FINENESS;

#if VEILED
// Within a solid that the ray may leave, the field counts with its sign turned, as that of the space
// around. The first evaluation of a march tells, if the march begins at a surface.
var<private> march_side: f32 = 1.0;
var<private> march_takes_side: bool = false;

#end
struct March {
    t: f32,
    hit: bool,
    ended: bool,
    evaluations: u32,
}

// Marches from `start` to a hit, to beyond `exit`, or through `steps` evaluations. `first_descent`:
// expected descent of the field there per distance, 0 if unknown. `size`: width of a pixel at
// distance 1, by which errors are measured.
//
// A step is as long as the sphere around the next point is expected to touch the one around this
// (Ban and Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023). If the two leave a
// gap, the march takes the step back to the end of the first sphere.
fn march_along(component: Component, ray: Ray, start: f32, exit: f32, first_descent: f32, steps: u32, size: f32) -> March {
    let reach = length(component.eye);
    var state = march_begin(start, first_descent);
    for (var step = 0u; step < steps; step += 1u) {
        let rounding = 2.0 * SPACING * (state.t + reach);
        // Numbers are as large as the point is far from their origin, or smaller.
        let flush = min(component.flush, component.flush_near + 0.5 * rounding);
        var sample = march_evaluate(&state, ray, flush, rounding);
        if sample.f < 0.0 && state.end < NEVER {
            return March(state.end, true, true, step + 1u);
        }
        if state.end < NEVER && state.tried.x == NEVER {
            march_look_again(&state, sample);
            continue;
        }
        if state.end < NEVER {
            march_recall_tried(&state, &sample);
        }
        state.end = NEVER;
        if state.relaxed && state.safe.y + abs(sample.f) < sample.advance {
            state.relaxed = false;
            state.slope = -1.0;
            state.t = state.safe.x + state.free_interval;
            continue;
        }
        state.relaxed = false;
        if sample.f > 0.0 && state.t + sample.f + MIN_STEP_LIMIT * size * state.t >= state.overshoot.x - state.overshoot.y {
            march_accept_overshoot(&state, &sample);
        }
        state.overshoot.x = NEVER;
        let footprint = size * state.t;
        let f = sample.f;
        let bracketed = state.inside.x < NEVER;
        // Whether an overstep ended outside, without a surface where its line led.
        let is_lost = !VERIFIED_OVERSTEP && state.overstepping && f >= 0.0 && state.safe.y + f + MIN_STEP_LIMIT * footprint < sample.advance;
        if state.unverified_gap.x < NEVER && select(f >= state.safe.y && !bracketed && !is_lost, !sample.is_seen, VERIFIED_OVERSTEP) {
            march_return_to_gap(&state);
            continue;
        }
        if VERIFIED_OVERSTEP {
            state.unverified_gap = march_unverified_gap(state.safe, state.free_interval, state.overstepping && state.free_interval + abs(f) < sample.advance);
        }
        // Descent of the field per distance since the last point; 0 at the first one.
        let descent = select(0.0, (state.safe.y - f) / sample.advance, sample.advance > 0.0 && state.safe.y > 0.0);
        if f < 0.0 || bracketed {
            let root = march_secant(&state, f);
            if state.safe.y <= 0.0 || abs(f) < max(HIT * footprint, SPACING * (state.t + reach)) || root == state.t {
                return March(root, true, true, step + 1u);
            }
            state.t = root;
            continue;
        }
        let expected = select(descent, first_descent, sample.advance == 0.0);
        if CLOSE_IS_HIT && expected > STEEP && f < CLOSE * footprint {
            march_look_behind(&state, sample, expected, 0.5 * rounding + flush);
            continue;
        }
        if is_lost {
            march_take_back_overstep(&state, f);
            continue;
        }
        march_settle(&state, sample, descent, expected, footprint, SPACING * (state.t + reach));
        if state.t + state.free_interval > exit && !state.overstepping && !(VERIFIED_OVERSTEP && state.unverified_gap.x < NEVER) {
            return March(state.t, false, true, step + 1u);
        }
        march_advance(&state, f / expected + 0.25 * HIT * footprint);
    }
    return March(min(state.safe.x, state.unverified_gap.x), false, steps == 0u, steps);
}

// Evaluates the field at the current point. The only call of the field.
fn march_evaluate(state: ptr<function, MarchState>, ray: Ray, flush: f32, rounding: f32) -> MarchSample {
    let t = state.t;
    let last = state.last;
    let looks_back = VERIFIED_OVERSTEP && state.unverified_gap.x < NEVER;
    if looks_back {
        lookahead_begin_behind(t - last.x, min(t, last.x) - state.unverified_gap.z, rounding);
    } else {
        lookahead_begin(t - last.x, LOOKAHEAD_WINDOW * (t - state.safe.x), rounding);
    }
    var f = field(ray_at(ray, t));
#if VEILED
    march_side = select(march_side, select(1.0, -1.0, f < 0.0), march_takes_side);
    march_takes_side = false;
    f *= march_side;
#end
    // A negative field within `flush` is rounding, not material.
    f = select(f, 0.0, f < 0.0 && f >= -flush);
    // The stretch behind an overstep is free if the field there is no less than where the overstep
    // ended.
    let is_seen = lookahead_minimum > min(select(f, last.y, t > last.x), 0.0);
    let proven = select(lookahead_free_interval(f), 0.0, looks_back);
    state.last = vec2f(t, f);
    return MarchSample(f, proven, is_seen, t - state.safe.x);
}
