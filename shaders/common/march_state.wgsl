// Where a march stands, and how it goes on from there.

#include "common/bounds.wgsl"

// All lengths below are in footprints of a pixel at the place in question.
// Where the field between a point outside and one inside is no more than this, the line between them is followed to the end.
const HIT: f32 = select(1e-3, 4e-3, VERIFIED_OVERSTEP) * FINENESS;
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

// Where a march stands between two evaluations.
struct MarchState {
    // Where the field is evaluated next.
    t: f32,
    // The last point known to be outside with nothing before it, its field, and how far it is free behind it.
    safe: vec2f,
    free_interval: f32,
    // The expected slope of the field along the ray.
    slope: f32,
    relaxed: bool,
    overstepping: bool,
    may_overstep: bool,
    min_step: f32,
    // The nearest point known to be inside, and its field; NEVER until there is one.
    inside: vec2f,
    // Where an overstep ended outside, and the field there; NEVER for none.
    overshoot: vec2f,
    // Where the ray was before an overstep behind which a gap was left, the field there, and where the gap begins; NEVER for none.
    unverified_gap: vec3f,
    // Where the field was last evaluated, and what it was.
    last: vec2f,
    // Where the surface is expected, if the field is negative at the next point, just behind; NEVER for none.
    end: f32,
    // Where that was tried first, the field there, and how far it was proven to be free behind; NEVER for none.
    tried: vec3f,
}

// What is known of the point that a march has come to.
struct MarchSample {
    f: f32,
    // How far it is proven to be free behind it.
    proven: f32,
    // Whether the way behind an overstep has proven to be free.
    is_seen: bool,
    // The way since the last safe point.
    advance: f32,
}

// Before the first evaluation.
fn march_begin(start: f32, first_descent: f32) -> MarchState {
    let safe = vec2f(start, 0.0);
    let slope = select(-1.0, -first_descent, first_descent > STEEP);
    let never = vec2f(NEVER, 0.0);
    return MarchState(start, safe, 0.0, slope, false, false, true, 0.0, never, never, vec3f(NEVER, 0.0, 0.0), never, NEVER, vec3f(NEVER, 0.0, 0.0));
}

// The sphere here meets the one around the place where an overstep ended: the overstep was right, and what it found counts.
fn march_accept_overshoot(state: ptr<function, MarchState>, sample: ptr<function, MarchSample>) {
    state.safe = vec2f(state.t, sample.f);
    state.free_interval = sample.f;
    state.t = state.overshoot.x;
    sample.f = state.overshoot.y;
    sample.proven = 0.0;
    sample.advance = state.t - state.safe.x;
    state.overstepping = true;
    state.may_overstep = true;
}

// There was room for a thin skin between the two spheres of an overstep, and nothing proves that there is none, or behind it
// the field does not fall: look there.
fn march_return_to_gap(state: ptr<function, MarchState>) {
    state.safe = state.unverified_gap.xy;
    state.t = state.unverified_gap.z;
    state.unverified_gap.x = NEVER;
    state.inside.x = NEVER;
    state.overstepping = false;
    state.may_overstep = false;
}

// The sign has changed: close in by secants between the last point outside and the first inside. After an overstep the two
// may be footprints apart, too far for a single one. Where the field was 0 outside, the root is there.
fn march_secant(state: ptr<function, MarchState>, f: f32) -> f32 {
    state.overstepping = false;
    if f < 0.0 {
        state.inside = vec2f(state.t, f);
    } else {
        state.safe = vec2f(state.t, f);
    }
    let safe = state.safe;
    let inside = state.inside;
    return safe.x + (inside.x - safe.x) * safe.y / (safe.y - inside.y);
}

// Looks whether the field is negative `depth` behind where it should end. It may end in nothing: in a face that a cut has
// taken away.
fn march_look_behind(state: ptr<function, MarchState>, sample: MarchSample, expected: f32, depth: f32) {
    march_leave_gap(state, sample);
    state.overstepping = false;
    state.safe = vec2f(state.t, sample.f);
    state.free_interval = sample.f;
    state.end = state.t + sample.f / expected;
    state.t = state.end + depth / expected;
}

// Nothing was found behind the face. What is thinner than the room that rounding is given may have been passed: look once more,
// just behind the face.
fn march_look_again(state: ptr<function, MarchState>, sample: MarchSample) {
    state.tried = vec3f(state.t, sample.f, sample.proven);
    state.t = state.end + LEAST_ENTRY * (state.t - state.end);
}

// Nothing was found there either: go on from the first of the two places.
fn march_recall_tried(state: ptr<function, MarchState>, sample: ptr<function, MarchSample>) {
    state.t = state.tried.x;
    sample.f = state.tried.y;
    sample.proven = state.tried.z;
    sample.advance = state.t - state.safe.x;
    state.tried.x = NEVER;
}

// Goes on from the sphere that was left too early.
fn march_take_back_overstep(state: ptr<function, MarchState>, f: f32) {
    state.overstepping = false;
    state.may_overstep = false;
    state.overshoot = vec2f(state.t, f);
    state.t = state.safe.x + state.free_interval;
}

// Where nothing proves oversteps, the gap is the one between the two spheres.
fn march_leave_gap(state: ptr<function, MarchState>, sample: MarchSample) {
    if !VERIFIED_OVERSTEP {
        let safe = state.safe;
        state.unverified_gap = march_unverified_gap(safe, safe.y, state.overstepping && safe.y + sample.f < sample.advance);
    }
}

// Makes the point that was reached the last safe one, and chooses how the next step is taken. `spacing`: that of f32 here.
fn march_settle(state: ptr<function, MarchState>, sample: MarchSample, descent: f32, expected: f32, footprint: f32, spacing: f32) {
    march_leave_gap(state, sample);
    let f = sample.f;
    let near = max(MIN_STEP * footprint, spacing);
    let longest = max(near, MIN_STEP_LIMIT * footprint);
    // Where the field falls, not farther than to a little behind its expected end.
    let due = select(longest, f / expected + 0.25 * HIT * footprint, expected > 0.0);
    // A step of which nothing is known must not pass a sheet.
    let shortest = select(near, spacing, expected == 0.0);
    let wanted = select(state.min_step * 2.0, longest, sample.advance == 0.0 && expected > 0.0);
    state.min_step = select(0.0, clamp(min(wanted, due), shortest, longest), f < near);
    // What an overstep would leave unseen, at most.
    let unseen = select(f, f / expected - max(f, sample.proven), VERIFIED_OVERSTEP);
    state.overstepping = RELAXED && state.may_overstep && expected > STEEP && unseen < OVERSTEP_GAP * footprint && f > near;
    state.may_overstep = true;
    state.slope = select(state.slope, mix(state.slope, -descent, ADAPTION), sample.advance > 0.0);
    state.safe = vec2f(state.t, f);
    state.free_interval = max(max(f, state.min_step), select(0.0, sample.proven, f > near));
}

// Takes the step from the last safe point. An overstep ends a little inside, where the sign tells: `overstep` from here.
fn march_advance(state: ptr<function, MarchState>, overstep: f32) {
    let free_interval = state.free_interval;
    let wide = state.safe.y * 2.0 / (1.0 - min(state.slope, 0.9));
    state.relaxed = RELAXED && !state.overstepping && wide > free_interval * 1.01;
    state.t += select(select(free_interval, wide, state.relaxed), overstep, state.overstepping);
}

// Where an overstep that left a gap began, the field there, and where the gap begins, `free_interval` behind that.
fn march_unverified_gap(safe: vec2f, free_interval: f32, is_left: bool) -> vec3f {
    return select(vec3f(NEVER, 0.0, 0.0), vec3f(safe, safe.x + free_interval), is_left);
}
