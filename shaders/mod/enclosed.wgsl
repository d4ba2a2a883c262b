// The field of a deformation: `value` divided by the largest stretch within a `margin` of the bound, from whose
// surface the point is `away`, negative within. Grows by at most 1 per meter, and has the sign of `value` within.
fn mod_enclosed(value: f32, away: f32, margin: f32) -> f32 {
    return max(away, min(value, 2.0 * margin - away));
}
