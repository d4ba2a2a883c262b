// The march along a ray of the trace pass.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/ahead.wgsl"
#include "generated/value.wgsl"

// All lengths below are in footprints of a pixel at the place in question.
// Where a straight approach at an angle that is not grazing is this near, its line is followed to the end.
const HIT: f32 = 1e-3 * FINENESS;
// The least fall of the field per distance that is not grazing.
const STEEP: f32 = 0.2;
// Below this, a straight approach is tried to its end at once, and taken back if there is no surface. Where the surface has
// bumps smaller than a pixel, a long leap would pass some.
const LEAP: f32 = select(0.1, 1.0, CLOSE_IS_HIT);
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

// From `start` to a hit, to beyond `exit`, or through `max_steps` evaluations.
//
// Steps are as long as the sphere around the next point is expected to touch the one around this (Ban and
// Valasek, "Automatic Step Size Relaxation in Sphere Tracing", 2023); where the two leave a gap, the step
// is taken back to the first one's end.
fn march_along(component: Component, direction: vec3f, start: f32, exit: f32, steps: u32) -> March {
    let reach = length(component.eye);
    var t = start;
    // The last point known to be outside with nothing before it, its field, and how far it is free behind it.
    var safe = vec2f(start, 0.0);
    var free = 0.0;
    // The expected slope of the field along the ray.
    var slope = -1.0;
    var relaxed = false;
    var leaping = false;
    var may_leap = true;
    var creep = 0.0;
    // The nearest point known to be inside, and its field; NEVER until there is one.
    var inside = vec2f(NEVER, 0.0);
    // Where a leap ended outside, and the field there; NEVER for none.
    var ahead = vec2f(NEVER, 0.0);
    // Where the ray was before a leap behind which a gap was left, and the field there; NEVER for none.
    var doubt = vec2f(NEVER, 0.0);
    // Where the field was last evaluated.
    var last = NEVER;
    for (var step = 0u; step < steps; step += 1u) {
        ahead_begin(t - last, AHEAD_WINDOW * (t - safe.x), 2.0 * SPACING * (t + reach));
        last = t;
        var f = field(component.eye + direction * t);
        var proven = ahead_free(f);
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
        // Fall of the field per distance since the last point; 0 at the first one.
        let fall = select(0.0, (safe.y - f) / advance, advance > 0.0 && safe.y > 0.0);
        if f < 0.0 || bracketed {
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
        if CLOSE_IS_HIT && fall > STEEP && f < HIT * footprint {
            return March(t + f / fall, true, true, step + 1u);
        }
        if leaping && safe.y + f + CREEP_LONGEST * footprint < advance {
            // No surface where the line led: go on from the sphere that was left too early.
            leaping = false;
            may_leap = false;
            ahead = vec2f(t, f);
            t = safe.x + free;
            continue;
        }
        if doubt.x < NEVER && f >= safe.y {
            // A leap was kept though between its two spheres there was room for a thin skin, and behind it the field
            // does not fall: look there.
            safe = doubt;
            doubt.x = NEVER;
            leaping = false;
            may_leap = false;
            t = safe.x + safe.y;
            continue;
        }
        doubt = select(vec2f(NEVER, 0.0), safe, leaping && safe.y + f < advance);
        let near = max(CREEP * footprint, SPACING * (t + reach));
        let longest = max(near, CREEP_LONGEST * footprint);
        // Where the field falls, not farther than to a little behind its expected end.
        let due = select(longest, f / fall + 0.25 * HIT * footprint, fall > 0.0);
        creep = select(0.0, clamp(min(creep * 2.0, due), near, longest), f < near);
        leaping = RELAXED && may_leap && fall > STEEP && f < LEAP * footprint && f > near;
        may_leap = true;
        slope = select(-1.0, mix(slope, -fall, ADAPTION), advance > 0.0);
        safe = vec2f(t, f);
        free = max(max(f, creep), select(0.0, proven, f > near));
        if t + free > exit && !leaping {
            return March(t, false, true, step + 1u);
        }
        let wide = f * 2.0 / (1.0 - min(slope, 0.9));
        relaxed = RELAXED && !leaping && wide > free * 1.01;
        // A leap ends a little inside, where the sign tells.
        t += select(select(free, wide, relaxed), f / fall + 0.25 * HIT * footprint, leaping);
    }
    return March(min(safe.x, doubt.x), false, steps == 0u, steps);
}
