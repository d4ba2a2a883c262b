// One piece of work: which component, which part of the picture, how far.

struct Work {
    // Upper left pixel.
    origin: vec2u,
    // First pixel outside.
    end: vec2u,
    component: u32,
    // Steps that an invocation may take in this dispatch.
    max_steps: u32,
    // 0 begins a march, later rounds continue it.
    round: u32,
    // 1 in the last round: what has not ended by now is counted.
    last_round: u32,
    // Which list of quads, see `common/quads.wgsl`.
    list: u32,
    // Where its quads start in `quads`.
    first_quad: u32,
    // 1 where a march goes on with the rays that were left, packed side by side; 0 for all pixels of the quads.
    packed: u32,
    // Where the rays that are left stand in `rays`.
    rays: u32,
    // Where the lists of quads with hits begin in `quads`.
    hits: u32,
}

@group(3) @binding(0) var<uniform> work: Work;

// Pixels along a side of a tile: what a cone begins with.
const TILE: u32 = 8u;
