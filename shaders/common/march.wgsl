// The march along a ray of the trace pass.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/ray.wgsl"
#include "common/lookahead.wgsl"
#include "generated/value.wgsl"

// All lengths below are in footprints of a pixel at the place in question.
// Where the field between a point outside and one inside is no more than this, the line between them is followed to the end.
const HIT: f32 = select(1e-3, 4e-3, VERIFIED_OVERSTEP) * FINENESS;
// From outside only, at an angle that is not grazing: where the field is no more than this, it is looked whether it is negative
// just behind the place where it should end.
const CLOSE: f32 = 1e-3 * FINENESS;
// The least fall of the field per distance that is not grazing.
const STEEP: f32 = 0.2;
// With less than this left unseen, a straight approach is tried to its end at once, and taken back if there is no surface: where
// fields are convex if nothing proves afterward that there was none on the way, elsewhere if it ends outside. Where the
// surface has bumps smaller than a pixel, a long overstep would pass some.
const OVERSTEP_GAP: f32 = select(select(0.1, 1.0, CLOSE_IS_HIT), 3.0, VERIFIED_OVERSTEP);
// How far behind the face that is looked for the second time, as a share of the first.
const LEAST_ENTRY: f32 = 0.25;
// At grazing angles, rays take steps no longer than this until they see the sign change: a ray that only
// comes near is never taken for a hit.
const MIN_STEP: f32 = 1e-3 * FINENESS;
// Longest of these steps: a chord shorter than this may be missed.
const MIN_STEP_LIMIT: f32 = 0.03 * MIN_STEP_SCALE;
// How fast the expected slope of the field follows the one that was met, from 0 to 1.
const ADAPTION: f32 = 0.6;

struct March {
    t: f32,
    hit: bool,
    ended: bool,
    evaluations: u32,
}

// From `start` to a hit, to beyond `exit`, or through `steps` evaluations. `first_descent`: how the field is expected to fall
// there per distance, 0 for unknown.
//
// Steps are as long as the sphere around the next point is expected to touch the one around this (Ban and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023); where the two leave a gap, the step
// is taken back to the first one's end.
fn march_along(component: Component, ray: Ray, start: f32, exit: f32, first_descent: f32, steps: u32) -> March {
    let reach = length(component.eye);
    var t = start;
    // The last point known to be outside with nothing before it, its field, and how far it is free behind it.
    var safe = vec2f(start, 0.0);
    var free_interval = 0.0;
    // The expected slope of the field along the ray.
    var slope = select(-1.0, -first_descent, first_descent > STEEP);
    var relaxed = false;
    var overstepping = false;
    var may_overstep = true;
    var min_step = 0.0;
    // The nearest point known to be inside, and its field; NEVER until there is one.
    var inside = vec2f(NEVER, 0.0);
    // Where an overstep ended outside, and the field there; NEVER for none.
    var overshoot = vec2f(NEVER, 0.0);
    // Where the ray was before an overstep behind which a gap was left, the field there, and where the gap begins; NEVER for none.
    var unverified_gap = vec3f(NEVER, 0.0, 0.0);
    // Where the field was last evaluated, and what it was.
    var last = vec2f(NEVER, 0.0);
    // Where the surface is expected, if the field is negative at the next point, just behind; NEVER for none.
    var end = NEVER;
    // Where that was tried first, the field there, and how far it was proven to be free behind; NEVER for none.
    var tried = vec3f(NEVER, 0.0, 0.0);
    for (var step = 0u; step < steps; step += 1u) {
        let rounding = 2.0 * SPACING * (t + reach);
        let looks_back = VERIFIED_OVERSTEP && unverified_gap.x < NEVER;
        if looks_back {
            lookahead_begin_behind(t - last.x, min(t, last.x) - unverified_gap.z, rounding);
        } else {
            lookahead_begin(t - last.x, LOOKAHEAD_WINDOW * (t - safe.x), rounding);
        }
        var f = field(ray_at(ray, t));
        // What is no more than a rounding is no material.
        f = select(f, 0.0, f < 0.0 && f >= -component.flush);
        if f < 0.0 && end < NEVER {
            return March(end, true, true, step + 1u);
        }
        // The way behind an overstep is free where the field is no less there than where the overstep ended.
        let is_seen = lookahead_minimum > min(select(f, last.y, t > last.x), 0.0);
        var proven = select(lookahead_free_interval(f), 0.0, looks_back);
        last = vec2f(t, f);
        if end < NEVER && tried.x == NEVER {
            // What is thinner than the room that rounding is given may have been passed: look once more, just behind its face.
            tried = vec3f(t, f, proven);
            t = end + LEAST_ENTRY * (t - end);
            continue;
        }
        if end < NEVER {
            t = tried.x;
            f = tried.y;
            proven = tried.z;
            tried.x = NEVER;
        }
        end = NEVER;
        var advance = t - safe.x;
        if relaxed && safe.y + abs(f) < advance {
            relaxed = false;
            slope = -1.0;
            t = safe.x + free_interval;
            continue;
        }
        relaxed = false;
        if f > 0.0 && t + f + MIN_STEP_LIMIT * view.footprint * t >= overshoot.x - overshoot.y {
            // The two spheres meet: the overstep was right, and what it found counts.
            safe = vec2f(t, f);
            free_interval = f;
            t = overshoot.x;
            f = overshoot.y;
            proven = 0.0;
            advance = t - safe.x;
            overstepping = true;
            may_overstep = true;
        }
        overshoot.x = NEVER;
        let footprint = view.footprint * t;
        let bracketed = inside.x < NEVER;
        // Whether an overstep has ended outside, and there is no surface where its line led.
        let is_lost = !VERIFIED_OVERSTEP && overstepping && f >= 0.0 && safe.y + f + MIN_STEP_LIMIT * footprint < advance;
        if unverified_gap.x < NEVER && select(f >= safe.y && !bracketed && !is_lost, !is_seen, VERIFIED_OVERSTEP) {
            // There was room for a thin skin between the two spheres of an overstep, and nothing proves that there is none, or
            // behind it the field does not fall: look there.
            safe = unverified_gap.xy;
            t = unverified_gap.z;
            unverified_gap.x = NEVER;
            inside.x = NEVER;
            overstepping = false;
            may_overstep = false;
            continue;
        }
        if VERIFIED_OVERSTEP {
            unverified_gap = march_unverified_gap(safe, free_interval, overstepping && free_interval + abs(f) < advance);
        }
        // Fall of the field per distance since the last point; 0 at the first one.
        let descent = select(0.0, (safe.y - f) / advance, advance > 0.0 && safe.y > 0.0);
        if f < 0.0 || bracketed {
            overstepping = false;
            // The sign has changed: close in by secants between the last point outside and the first
            // inside. After an overstep the two may be footprints apart, too far for a single one.
            if f < 0.0 {
                inside = vec2f(t, f);
            } else {
                safe = vec2f(t, f);
            }
            // Where the field was 0 outside, this is there.
            let root = safe.x + (inside.x - safe.x) * safe.y / (safe.y - inside.y);
            if safe.y <= 0.0 || abs(f) < max(HIT * footprint, SPACING * (t + reach)) || root == t {
                return March(root, true, true, step + 1u);
            }
            t = root;
            continue;
        }
        let expected = select(descent, first_descent, advance == 0.0);
        if CLOSE_IS_HIT && expected > STEEP && f < CLOSE * footprint {
            // It may end in nothing: in a face that a cut has taken away.
            if !VERIFIED_OVERSTEP {
                unverified_gap = march_unverified_gap(safe, safe.y, overstepping && safe.y + f < advance);
            }
            overstepping = false;
            safe = vec2f(t, f);
            free_interval = f;
            end = t + f / expected;
            t = end + (0.5 * rounding + component.flush) / expected;
            continue;
        }
        if is_lost {
            // Go on from the sphere that was left too early.
            overstepping = false;
            may_overstep = false;
            overshoot = vec2f(t, f);
            t = safe.x + free_interval;
            continue;
        }
        if !VERIFIED_OVERSTEP {
            unverified_gap = march_unverified_gap(safe, safe.y, overstepping && safe.y + f < advance);
        }
        let near = max(MIN_STEP * footprint, SPACING * (t + reach));
        let longest = max(near, MIN_STEP_LIMIT * footprint);
        // Where the field falls, not farther than to a little behind its expected end.
        let due = select(longest, f / expected + 0.25 * HIT * footprint, expected > 0.0);
        // A step of which nothing is known must not pass a sheet.
        let shortest = select(near, SPACING * (t + reach), expected == 0.0);
        let wanted = select(min_step * 2.0, longest, advance == 0.0 && expected > 0.0);
        min_step = select(0.0, clamp(min(wanted, due), shortest, longest), f < near);
        // What an overstep would leave unseen, at most.
        let unseen = select(f, f / expected - max(f, proven), VERIFIED_OVERSTEP);
        overstepping = RELAXED && may_overstep && expected > STEEP && unseen < OVERSTEP_GAP * footprint && f > near;
        may_overstep = true;
        slope = select(slope, mix(slope, -descent, ADAPTION), advance > 0.0);
        safe = vec2f(t, f);
        free_interval = max(max(f, min_step), select(0.0, proven, f > near));
        if t + free_interval > exit && !overstepping && !(VERIFIED_OVERSTEP && unverified_gap.x < NEVER) {
            return March(t, false, true, step + 1u);
        }
        let wide = f * 2.0 / (1.0 - min(slope, 0.9));
        relaxed = RELAXED && !overstepping && wide > free_interval * 1.01;
        // An overstep ends a little inside, where the sign tells.
        t += select(select(free_interval, wide, relaxed), f / expected + 0.25 * HIT * footprint, overstepping);
    }
    return March(min(safe.x, unverified_gap.x), false, steps == 0u, steps);
}

// Where an overstep that left a gap began, the field there, and where the gap begins, `free_interval` behind that.
fn march_unverified_gap(safe: vec2f, free_interval: f32, is_left: bool) -> vec3f {
    return select(vec3f(NEVER, 0.0, 0.0), vec3f(safe, safe.x + free_interval), is_left);
}
