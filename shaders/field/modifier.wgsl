// Copies of a modifier's content.

// The next copy, from the k-th on, that may be nearer than `least`; NO_COPY if there is none.
fn modifier_next(kind: u32, p: vec3f, k: u32, least: f32, row: u32) -> u32 {
    let count = modifier_count(kind, row);
    var copy = k;
    while copy < count && modifier_bound(kind, p, copy, row) >= least {
        copy += 1u;
    }
    return select(NO_COPY, copy, copy < count);
}
