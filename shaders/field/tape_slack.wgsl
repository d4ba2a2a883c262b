// See `field/no_slack.wgsl`; for tapes.

// In an empty cell the value is the bound at the cell's middle less the distance from there. The
// field lies between that and the bound plus the distance, and the bound itself is the estimate.
fn field_slack() -> f32 {
    return tape_slack;
}
