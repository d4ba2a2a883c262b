// Lower bounds of the field ahead on a ray, or behind. Pipelines that know the structure derive
// them from the last two values, see `src/wgsl/lookahead.rs`. VERIFIED_OVERSTEP says whether the
// bounds suffice for long oversteps. Before each evaluation the march sets the window.

// Length of the window ahead, in distances from the last evaluation.
const LOOKAHEAD_WINDOW: f32 = 2.0;
// Least descent of a line. A rising line counts as constant, except in a concave fold: that uses
// the rising lines themselves, as their fold lies above the line between its ends.
const LOOKAHEAD_MIN_DESCENT: f32 = select(0.0, -1.0, LOOKAHEAD_IS_CONCAVE);
// Concavity of a field without a known bound.
const LOOKAHEAD_UNKNOWN: f32 = 1e30;
// Length of the window; the span from here to the end of the window and the last evaluation;
// 1 / the distance from the last evaluation.
var<private> lookahead_window: f32;
var<private> lookahead_span: f32;
var<private> lookahead_inverse_step: f32;
// Slack of a slope for rounding; 1 if there is no last evaluation behind.
var<private> lookahead_slack: f32 = 1.0;
// Amount by which a concavity of 1 lowers the line through the last two values, per distance.
var<private> lookahead_bend: f32;
// Lower bound of the field in the window.
var<private> lookahead_minimum: f32;
// Whether the window lies before the last evaluation, seen from this one.
var<private> lookahead_is_behind: bool;

// Sets the window ahead. `gone`: distance from the last evaluation, negative if that was ahead.
// `rounding`: that of two values.
fn lookahead_begin(gone: f32, window: f32, rounding: f32) {
    let is_known = gone > 0.0;
    lookahead_is_behind = false;
    lookahead_window = window;
    lookahead_span = max(window, gone);
    lookahead_inverse_step = select(0.0, 1.0 / gone, is_known);
    lookahead_slack = select(1.0, rounding / gone, is_known);
    lookahead_bend = select(0.0, 0.5 * (window + gone), is_known);
}

// Sets the window to the stretch behind the nearer of the last two evaluations instead. `gone`:
// distance from the last evaluation, negative if that was farther.
fn lookahead_begin_behind(gone: f32, window: f32, rounding: f32) {
    lookahead_begin(abs(gone), max(window, 0.0), rounding);
    lookahead_span = lookahead_window + abs(gone);
    lookahead_is_behind = gone > 0.0;
    lookahead_inverse_step = select(lookahead_inverse_step, -lookahead_inverse_step, lookahead_is_behind);
}

// The field where the window begins, from its value `before` at the last evaluation and `now` at
// this one.
fn lookahead_base(before: f32, now: f32) -> f32 {
    return select(now, before, VERIFIED_OVERSTEP && lookahead_is_behind);
}

// Upper bound of the descent ahead, per distance, of a field of slope at most 1 that was `before`
// at the last evaluation and is `now` at this one. Its second derivative is at least the negative
// of `concavity`.
fn lookahead_descent(before: f32, now: f32, concavity: f32) -> f32 {
    return clamp((before - now) * lookahead_inverse_step + lookahead_slack + concavity * lookahead_bend, LOOKAHEAD_MIN_DESCENT, 1.0);
}

// Upper bound of the field's descent in the window, per distance; the field is `f` here. 1 if no
// better bound is known.
fn lookahead_slope(f: f32) -> f32 {
    if !LOOKAHEAD || !LOOKAHEAD_IS_CONCAVE {
        return 1.0;
    }
    return select(1.0, clamp((f - lookahead_minimum) / lookahead_window, 0.0, 1.0), lookahead_window > 0.0);
}

// Length of the interval ahead in which the field, `f` here, is proven positive.
fn lookahead_free_interval(f: f32) -> f32 {
    if !LOOKAHEAD {
        return 0.0;
    }
    let share = select(0.0, f / (f - lookahead_minimum), LOOKAHEAD_IS_CONCAVE);
    return lookahead_window * select(share, 1.0, lookahead_minimum > 0.0);
}
