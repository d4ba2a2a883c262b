// State of a march, and its transitions.

#include "common/bounds.wgsl"

// Lengths below are in footprints of a pixel at the place in question.
// Once the field between a point outside and one inside is at most this, the march accepts the root
// of the line between them.
const HIT: f32 = select(1e-3, 4e-3, VERIFIED_OVERSTEP) * FINENESS;
// Least descent of the field per distance that is not grazing.
const STEEP: f32 = 0.2;
// If an overstep leaves less than this unseen, the march tries a straight approach to its end at
// once. It takes the overstep back if there is no surface: with verified oversteps if no proof
// shows afterward that the way was free, else if it ends outside. Where the surface has bumps
// smaller than a pixel, a long overstep would pass some.
const OVERSTEP_GAP: f32 = select(select(0.1, 1.0, CLOSE_IS_HIT), 3.0, VERIFIED_OVERSTEP);
// Depth of the second test behind a face, as a share of the first.
const LEAST_ENTRY: f32 = 0.25;
// Where the field is less than this, steps have at least this length until the ray sees the sign
// change: a ray that only comes near is never a hit.
const MIN_STEP: f32 = 1e-3 * FINENESS;
// Longest of these steps: a chord shorter than this may be missed.
const MIN_STEP_LIMIT: f32 = 0.03 * MIN_STEP_SCALE;
// How fast the expected slope of the field follows the measured one, from 0 to 1.
const ADAPTION: f32 = 0.6;

// State of a march between two evaluations.
struct MarchState {
    // `t` of the next evaluation.
    t: f32,
    // The last point known to be outside with nothing before it, and the field there; then the free
    // interval behind it.
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
    // End of an overstep that ended outside, and the field there; NEVER for none.
    overshoot: vec2f,
    // Start of an overstep that left a gap, the field there, and the beginning of the gap; NEVER
    // for none.
    unverified_gap: vec3f,
    // `t` of the last evaluation, and the field there.
    last: vec2f,
    // Expected `t` of the surface, a hit if the field is negative at the next point, just behind;
    // NEVER for none.
    end: f32,
    // First point that tested this, the field there, and the free interval proven behind it; NEVER
    // for none.
    tried: vec3f,
}

// Result of an evaluation at the current point.
struct MarchSample {
    f: f32,
    // Length of the free interval proven behind the point.
    proven: f32,
    // Whether the gap of an overstep is proven free.
    is_seen: bool,
    // Distance from the last safe point.
    advance: f32,
}

// State before the first evaluation.
fn march_begin(start: f32, first_descent: f32) -> MarchState {
    let safe = vec2f(start, 0.0);
    let slope = select(-1.0, -first_descent, first_descent > STEEP);
    let never = vec2f(NEVER, 0.0);
    return MarchState(start, safe, 0.0, slope, false, false, true, 0.0, never, never, vec3f(NEVER, 0.0, 0.0), never, NEVER, vec3f(NEVER, 0.0, 0.0));
}

// The sphere here meets the one around the end of an overstep: the overstep was right, and the
// march continues from its end.
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

// The two spheres of an overstep leave room for a thin skin, and no proof excludes one, or the
// field does not fall behind it: returns to the gap.
fn march_return_to_gap(state: ptr<function, MarchState>) {
    state.safe = state.unverified_gap.xy;
    state.t = state.unverified_gap.z;
    state.unverified_gap.x = NEVER;
    state.inside.x = NEVER;
    state.overstepping = false;
    state.may_overstep = false;
}

// After a sign change, closes in by secants between the last point outside and the first inside.
// After an overstep the two may be footprints apart, too far for a single secant. Where the field
// was 0 outside, the root is there.
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

// Tests whether the field is negative `depth` behind its expected end. A face that a cut has
// removed has nothing behind it.
fn march_look_behind(state: ptr<function, MarchState>, sample: MarchSample, expected: f32, depth: f32) {
    march_leave_gap(state, sample);
    state.overstepping = false;
    state.safe = vec2f(state.t, sample.f);
    state.free_interval = sample.f;
    state.end = state.t + sample.f / expected;
    state.t = state.end + depth / expected;
}

// The test found nothing behind the face. It may have passed a part thinner than the allowance for
// rounding: tests again, just behind the face.
fn march_look_again(state: ptr<function, MarchState>, sample: MarchSample) {
    state.tried = vec3f(state.t, sample.f, sample.proven);
    state.t = state.end + LEAST_ENTRY * (state.t - state.end);
}

// The second test found nothing either: continues from the point of the first.
fn march_recall_tried(state: ptr<function, MarchState>, sample: ptr<function, MarchSample>) {
    state.t = state.tried.x;
    sample.f = state.tried.y;
    sample.proven = state.tried.z;
    sample.advance = state.t - state.safe.x;
    state.tried.x = NEVER;
}

// Takes an overstep back: continues from the end of the sphere where it began.
fn march_take_back_overstep(state: ptr<function, MarchState>, f: f32) {
    state.overstepping = false;
    state.may_overstep = false;
    state.overshoot = vec2f(state.t, f);
    state.t = state.safe.x + state.free_interval;
}

// Without verified oversteps, the gap is the one between the two spheres.
fn march_leave_gap(state: ptr<function, MarchState>, sample: MarchSample) {
    if !VERIFIED_OVERSTEP {
        let safe = state.safe;
        state.unverified_gap = march_unverified_gap(safe, safe.y, state.overstepping && safe.y + sample.f < sample.advance);
    }
}

// Makes the current point the last safe one, and chooses the kind of the next step. `spacing`: that
// of f32 here.
fn march_settle(state: ptr<function, MarchState>, sample: MarchSample, descent: f32, expected: f32, footprint: f32, spacing: f32) {
    march_leave_gap(state, sample);
    let f = sample.f;
    let near = max(MIN_STEP * footprint, spacing);
    let longest = max(near, MIN_STEP_LIMIT * footprint);
    // Where the field falls, at most to slightly behind its expected end.
    let due = select(longest, f / expected + 0.25 * HIT * footprint, expected > 0.0);
    // A step without a known descent must not pass a sheet.
    let shortest = select(near, spacing, expected == 0.0);
    let wanted = select(state.min_step * 2.0, longest, sample.advance == 0.0 && expected > 0.0);
    state.min_step = select(0.0, clamp(min(wanted, due), shortest, longest), f < near);
    // Upper bound of the stretch that an overstep would leave unseen.
    let unseen = select(f, f / expected - max(f, sample.proven), VERIFIED_OVERSTEP);
    state.overstepping = RELAXED && state.may_overstep && expected > STEEP && unseen < OVERSTEP_GAP * footprint && f > near;
    state.may_overstep = true;
    state.slope = select(state.slope, mix(state.slope, -descent, ADAPTION), sample.advance > 0.0);
    state.safe = vec2f(state.t, f);
    state.free_interval = max(max(f, state.min_step), select(0.0, sample.proven, f > near));
}

// Takes the step from the last safe point. An overstep, of length `overstep`, ends slightly inside,
// where the sign tells.
fn march_advance(state: ptr<function, MarchState>, overstep: f32) {
    let free_interval = state.free_interval;
    let wide = state.safe.y * 2.0 / (1.0 - min(state.slope, 0.9));
    state.relaxed = RELAXED && !state.overstepping && wide > free_interval * 1.01;
    state.t += select(select(free_interval, wide, state.relaxed), overstep, state.overstepping);
}

// Start of an overstep that left a gap, the field there, and the beginning of the gap,
// `free_interval` behind the start.
fn march_unverified_gap(safe: vec2f, free_interval: f32, is_left: bool) -> vec3f {
    return select(vec3f(NEVER, 0.0, 0.0), vec3f(safe, safe.x + free_interval), is_left);
}
