// What kernels that know the structure prove of the field ahead on a ray, or behind, from its last two values: see
// `render::kernel::ahead`. Whether it proves enough for long leaps is LEAPS_FAR. The march says before each evaluation how
// far it wants to know.

// How far ahead is looked, in ways since the last evaluation.
const AHEAD_WINDOW: f32 = 2.0;
// How much a line may rise. What rises may be taken as if it stayed; in a concave fold the lines themselves will do, as what is
// made of them lies above the line between its ends.
const AHEAD_LEAST_FALL: f32 = select(0.0, -1.0, AHEAD_IS_CONCAVE);
// The concavity of a field of which nothing is known.
const AHEAD_UNKNOWN: f32 = 1e30;
// The way that is looked at, how far it and the last evaluation are from this one, and one by the way since that one.
var<private> ahead_window: f32;
var<private> ahead_span: f32;
var<private> ahead_pace: f32;
// What is added to a slope for rounding; 1 where there is no last evaluation behind.
var<private> ahead_doubt: f32 = 1.0;
// By how much a concavity of 1 takes the line through the last two values lower, per distance.
var<private> ahead_bend: f32;
// Nowhere in the window is the field less.
var<private> ahead_least: f32;
// Whether the window lies before the last evaluation, seen from this one.
var<private> ahead_is_behind: bool;

// `gone`: the way since the last evaluation, negative where that was ahead. `rounding`: of two values.
fn ahead_begin(gone: f32, window: f32, rounding: f32) {
    let is_known = gone > 0.0;
    ahead_is_behind = false;
    ahead_window = window;
    ahead_span = max(window, gone);
    ahead_pace = select(0.0, 1.0 / gone, is_known);
    ahead_doubt = select(1.0, rounding / gone, is_known);
    ahead_bend = select(0.0, 0.5 * (window + gone), is_known);
}

// Asks about the way behind the nearer one of the last two evaluations instead. `gone`: the way since the last one, negative
// where that was farther.
fn ahead_begin_behind(gone: f32, window: f32, rounding: f32) {
    ahead_begin(abs(gone), max(window, 0.0), rounding);
    ahead_span = ahead_window + abs(gone);
    ahead_is_behind = gone > 0.0;
    ahead_pace = select(ahead_pace, -ahead_pace, ahead_is_behind);
}

// What the field is where the window begins, that was `before` and is `now`.
fn ahead_base(before: f32, now: f32) -> f32 {
    return select(now, before, LEAPS_FAR && ahead_is_behind);
}

// How much a field of a slope of at most 1 can fall ahead, per distance, that was `before` and is `now`, and whose second
// derivative is at least the negative of `concavity`.
fn ahead_fall(before: f32, now: f32, concavity: f32) -> f32 {
    return clamp((before - now) * ahead_pace + ahead_doubt + concavity * ahead_bend, AHEAD_LEAST_FALL, 1.0);
}

// By no more than this the field, which is `f` here, falls per distance in the window; 1 where nothing better is known.
fn ahead_slope(f: f32) -> f32 {
    if !AHEAD || !AHEAD_IS_CONCAVE {
        return 1.0;
    }
    return select(1.0, clamp((f - ahead_least) / ahead_window, 0.0, 1.0), ahead_window > 0.0);
}

// As far as this the field, which is `f` here, is proven to be positive.
fn ahead_free(f: f32) -> f32 {
    if !AHEAD {
        return 0.0;
    }
    let share = select(0.0, f / (f - ahead_least), AHEAD_IS_CONCAVE);
    return ahead_window * select(share, 1.0, ahead_least > 0.0);
}
