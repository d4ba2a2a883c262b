// The march along a ray of the trace pass.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/ray.wgsl"
#include "common/ahead.wgsl"
#include "generated/value.wgsl"

// All lengths below are in footprints of a pixel at the place in question.
// Where the field between a point outside and one inside is no more than this, the line between them is followed to the end.
const HIT: f32 = select(1e-3, 4e-3, LEAPS_FAR) * FINENESS;
// From outside only, at an angle that is not grazing: where the field is no more than this, it is looked whether it is negative
// just behind the place where it should end.
const CLOSE: f32 = 1e-3 * FINENESS;
// The least fall of the field per distance that is not grazing.
const STEEP: f32 = 0.2;
// With less than this left unseen, a straight approach is tried to its end at once, and taken back if there is no surface: where
// fields are convex if nothing proves afterwards that there was none on the way, elsewhere if it ends outside. Where the
// surface has bumps smaller than a pixel, a long leap would pass some.
const LEAP: f32 = select(select(0.1, 1.0, CLOSE_IS_HIT), 3.0, LEAPS_FAR);
// At grazing angles, steps shorter than this creep until they see the sign change: a ray that only
// comes near is never taken for a hit.
const CREEP: f32 = 1e-3 * FINENESS;
// Longest creeping step: a chord shorter than this may be missed.
const CREEP_LONGEST: f32 = 0.03 * CREEP_SHARE;
// How fast the expected slope of the field follows the one that was met, from 0 to 1.
const ADAPTION: f32 = 0.6;

struct March {
    t: f32,
    hit: bool,
    ended: bool,
    evaluations: u32,
}

// From `start` to a hit, to beyond `exit`, or through `steps` evaluations. `first_fall`: how the field is expected to fall
// there per distance, 0 for unknown.
//
// Steps are as long as the sphere around the next point is expected to touch the one around this (Ban and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023); where the two leave a gap, the step
// is taken back to the first one's end.
fn march_along(component: Component, ray: Ray, start: f32, exit: f32, first_fall: f32, steps: u32) -> March {
    let reach = length(component.eye);
    var t = start;
    // The last point known to be outside with nothing before it, its field, and how far it is free behind it.
    var safe = vec2f(start, 0.0);
    var free = 0.0;
    // The expected slope of the field along the ray.
    var slope = select(-1.0, -first_fall, first_fall > STEEP);
    var relaxed = false;
    var leaping = false;
    var may_leap = true;
    var creep = 0.0;
    // The nearest point known to be inside, and its field; NEVER until there is one.
    var inside = vec2f(NEVER, 0.0);
    // Where a leap ended outside, and the field there; NEVER for none.
    var ahead = vec2f(NEVER, 0.0);
    // Where the ray was before a leap behind which a gap was left, the field there, and where the gap begins; NEVER for none.
    var doubt = vec3f(NEVER, 0.0, 0.0);
    // Where the field was last evaluated, and what it was.
    var last = vec2f(NEVER, 0.0);
    // Where the surface is expected, if the field is negative at the next point, just behind; NEVER for none.
    var end = NEVER;
    for (var step = 0u; step < steps; step += 1u) {
        let rounding = 2.0 * SPACING * (t + reach);
        let looks_back = LEAPS_FAR && doubt.x < NEVER;
        if looks_back {
            ahead_begin_behind(t - last.x, min(t, last.x) - doubt.z, rounding);
        } else {
            ahead_begin(t - last.x, AHEAD_WINDOW * (t - safe.x), rounding);
        }
        var f = field(ray_at(ray, t));
        // What is no more than a rounding is no material.
        f = select(f, 0.0, f < 0.0 && f >= -component.flush);
        if f < 0.0 && end < NEVER {
            return March(end, true, true, step + 1u);
        }
        end = NEVER;
        // The way behind a leap is free where the field is no less there than where the leap ended.
        let is_seen = ahead_least > min(select(f, last.y, t > last.x), 0.0);
        var proven = select(ahead_free(f), 0.0, looks_back);
        last = vec2f(t, f);
        var advance = t - safe.x;
        if relaxed && safe.y + abs(f) < advance {
            relaxed = false;
            slope = -1.0;
            t = safe.x + free;
            continue;
        }
        relaxed = false;
        if f > 0.0 && t + f + CREEP_LONGEST * view.footprint * t >= ahead.x - ahead.y {
            // The two spheres meet: the leap was right, and what it found counts.
            safe = vec2f(t, f);
            free = f;
            t = ahead.x;
            f = ahead.y;
            proven = 0.0;
            advance = t - safe.x;
            leaping = true;
            may_leap = true;
        }
        ahead.x = NEVER;
        let footprint = view.footprint * t;
        let bracketed = inside.x < NEVER;
        // Whether a leap has ended outside, and there is no surface where its line led.
        let is_lost = !LEAPS_FAR && leaping && f >= 0.0 && safe.y + f + CREEP_LONGEST * footprint < advance;
        if doubt.x < NEVER && select(f >= safe.y && !bracketed && !is_lost, !is_seen, LEAPS_FAR) {
            // There was room for a thin skin between the two spheres of a leap, and nothing proves that there is none, or
            // behind it the field does not fall: look there.
            safe = doubt.xy;
            t = doubt.z;
            doubt.x = NEVER;
            inside.x = NEVER;
            leaping = false;
            may_leap = false;
            continue;
        }
        if LEAPS_FAR {
            doubt = march_doubt(safe, free, leaping && free + abs(f) < advance);
        }
        // Fall of the field per distance since the last point; 0 at the first one.
        let fall = select(0.0, (safe.y - f) / advance, advance > 0.0 && safe.y > 0.0);
        if f < 0.0 || bracketed {
            leaping = false;
            // The sign has changed: close in by secants between the last point outside and the first
            // inside. After a leap the two may be footprints apart, too far for a single one.
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
        let expected = select(fall, first_fall, advance == 0.0);
        if CLOSE_IS_HIT && expected > STEEP && f < CLOSE * footprint {
            // It may end in nothing: in a face that a cut has taken away.
            if !LEAPS_FAR {
                doubt = march_doubt(safe, safe.y, leaping && safe.y + f < advance);
            }
            leaping = false;
            safe = vec2f(t, f);
            free = f;
            end = t + f / expected;
            t = end + (0.5 * rounding + component.flush) / expected;
            continue;
        }
        if is_lost {
            // Go on from the sphere that was left too early.
            leaping = false;
            may_leap = false;
            ahead = vec2f(t, f);
            t = safe.x + free;
            continue;
        }
        if !LEAPS_FAR {
            doubt = march_doubt(safe, safe.y, leaping && safe.y + f < advance);
        }
        let near = max(CREEP * footprint, SPACING * (t + reach));
        let longest = max(near, CREEP_LONGEST * footprint);
        // Where the field falls, not farther than to a little behind its expected end.
        let due = select(longest, f / expected + 0.25 * HIT * footprint, expected > 0.0);
        // A step of which nothing is known must not pass a sheet.
        let shortest = select(near, SPACING * (t + reach), expected == 0.0);
        let wanted = select(creep * 2.0, longest, advance == 0.0 && expected > 0.0);
        creep = select(0.0, clamp(min(wanted, due), shortest, longest), f < near);
        // What a leap would leave unseen, at most.
        let unseen = select(f, f / expected - max(f, proven), LEAPS_FAR);
        leaping = RELAXED && may_leap && expected > STEEP && unseen < LEAP * footprint && f > near;
        may_leap = true;
        slope = select(slope, mix(slope, -fall, ADAPTION), advance > 0.0);
        safe = vec2f(t, f);
        free = max(max(f, creep), select(0.0, proven, f > near));
        if t + free > exit && !leaping && !(LEAPS_FAR && doubt.x < NEVER) {
            return March(t, false, true, step + 1u);
        }
        let wide = f * 2.0 / (1.0 - min(slope, 0.9));
        relaxed = RELAXED && !leaping && wide > free * 1.01;
        // A leap ends a little inside, where the sign tells.
        t += select(select(free, wide, relaxed), f / expected + 0.25 * HIT * footprint, leaping);
    }
    return March(min(safe.x, doubt.x), false, steps == 0u, steps);
}

// Where a leap that left a gap began, the field there, and where the gap begins, `free` behind that.
fn march_doubt(safe: vec2f, free: f32, is_left: bool) -> vec3f {
    return select(vec3f(NEVER, 0.0, 0.0), vec3f(safe, safe.x + free), is_left);
}
