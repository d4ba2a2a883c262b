// Not a pass: counts how many iterations of a loop the driver executes.

@group(0) @binding(0) var<storage, read_write> counted: array<u32>;

@compute @workgroup_size(1)
fn driver_count_iterations() {
    // The bound comes from memory, so that no compiler can shorten the loop.
    let wanted = counted[1];
    var done = 0u;
    for (var i = 0u; i < wanted; i += 1u) {
        done += 1u + (counted[2] & i);
    }
    counted[0] = done;
}
