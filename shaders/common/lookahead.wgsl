// What pipelines that know the structure prove of the field ahead on a ray, or behind, from its last two values: see
// `render::wgsl::lookahead`. Whether it proves enough for long oversteps is VERIFIED_OVERSTEP. The march says before each evaluation how
// far it wants to know.

// How far ahead is looked, in ways since the last evaluation.
const LOOKAHEAD_WINDOW: f32 = 2.0;
// How much a line may rise. What rises may be taken as if it stayed; in a concave fold the lines themselves will do, as what is
// made of them lies above the line between its ends.
const LOOKAHEAD_MIN_DESCENT: f32 = select(0.0, -1.0, LOOKAHEAD_IS_CONCAVE);
// The concavity of a field of which nothing is known.
const LOOKAHEAD_UNKNOWN: f32 = 1e30;
// The way that is looked at, how far it and the last evaluation are from this one, and one by the way since that one.
var<private> lookahead_window: f32;
var<private> lookahead_span: f32;
var<private> lookahead_inverse_step: f32;
// What is added to a slope for rounding; 1 where there is no last evaluation behind.
var<private> lookahead_slack: f32 = 1.0;
// By how much a concavity of 1 takes the line through the last two values lower, per distance.
var<private> lookahead_bend: f32;
// Nowhere in the window is the field less.
var<private> lookahead_minimum: f32;
// Whether the window lies before the last evaluation, seen from this one.
var<private> lookahead_is_behind: bool;

// `gone`: the way since the last evaluation, negative where that was ahead. `rounding`: of two values.
fn lookahead_begin(gone: f32, window: f32, rounding: f32) {
    let is_known = gone > 0.0;
    lookahead_is_behind = false;
    lookahead_window = window;
    lookahead_span = max(window, gone);
    lookahead_inverse_step = select(0.0, 1.0 / gone, is_known);
    lookahead_slack = select(1.0, rounding / gone, is_known);
    lookahead_bend = select(0.0, 0.5 * (window + gone), is_known);
}

// Asks about the way behind the nearer one of the last two evaluations instead. `gone`: the way since the last one, negative
// where that was farther.
fn lookahead_begin_behind(gone: f32, window: f32, rounding: f32) {
    lookahead_begin(abs(gone), max(window, 0.0), rounding);
    lookahead_span = lookahead_window + abs(gone);
    lookahead_is_behind = gone > 0.0;
    lookahead_inverse_step = select(lookahead_inverse_step, -lookahead_inverse_step, lookahead_is_behind);
}

// What the field is where the window begins, that was `before` and is `now`.
fn lookahead_base(before: f32, now: f32) -> f32 {
    return select(now, before, VERIFIED_OVERSTEP && lookahead_is_behind);
}

// How much a field of a slope of at most 1 can fall ahead, per distance, that was `before` and is `now`, and whose second
// derivative is at least the negative of `concavity`.
fn lookahead_descent(before: f32, now: f32, concavity: f32) -> f32 {
    return clamp((before - now) * lookahead_inverse_step + lookahead_slack + concavity * lookahead_bend, LOOKAHEAD_MIN_DESCENT, 1.0);
}

// By no more than this the field, which is `f` here, falls per distance in the window; 1 where nothing better is known.
fn lookahead_slope(f: f32) -> f32 {
    if !LOOKAHEAD || !LOOKAHEAD_IS_CONCAVE {
        return 1.0;
    }
    return select(1.0, clamp((f - lookahead_minimum) / lookahead_window, 0.0, 1.0), lookahead_window > 0.0);
}

// As far as this the field, which is `f` here, is proven to be positive.
fn lookahead_free_interval(f: f32) -> f32 {
    if !LOOKAHEAD {
        return 0.0;
    }
    let share = select(0.0, f / (f - lookahead_minimum), LOOKAHEAD_IS_CONCAVE);
    return lookahead_window * select(share, 1.0, lookahead_minimum > 0.0);
}
