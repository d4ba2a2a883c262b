// What kernels that know the structure prove of the field ahead on a ray, from its last two values: see
// `render::kernel::ahead`. The march says before each evaluation how far ahead it wants to know.

// How far ahead is looked, in ways since the last evaluation.
const AHEAD_WINDOW: f32 = 2.0;
// The way ahead that is looked at, the longer of it and the way since the last evaluation, and one by that way.
var<private> ahead_window: f32;
var<private> ahead_span: f32;
var<private> ahead_pace: f32;
// What is added to a slope for rounding; 1 where there is no last evaluation behind.
var<private> ahead_doubt: f32 = 1.0;
// Nowhere in the window is the field less.
var<private> ahead_least: f32;

// `gone`: the way since the last evaluation, negative where that was ahead. `rounding`: of two values.
fn ahead_begin(gone: f32, window: f32, rounding: f32) {
    let is_known = gone > 0.0;
    ahead_window = window;
    ahead_span = max(window, gone);
    ahead_pace = select(0.0, 1.0 / gone, is_known);
    ahead_doubt = select(1.0, rounding / gone, is_known);
}

// How much a convex field of a slope of at most 1 can fall ahead, per distance, that was `before` and is `now`.
fn ahead_fall(before: f32, now: f32) -> f32 {
    return clamp((before - now) * ahead_pace + ahead_doubt, 0.0, 1.0);
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
