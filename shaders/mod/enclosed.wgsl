// The field of a deformation. `value` is the deformed field divided by the largest stretch within a
// `margin` of the bound; `away` is the distance of the point from the bound, negative inside. The
// result grows by at most 1 per meter, and inside the bound it has the sign of `value`.
fn mod_enclosed(value: f32, away: f32, margin: f32) -> f32 {
    return max(away, min(value, 2.0 * margin - away));
}
