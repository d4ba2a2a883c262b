// One dispatch: which component, which part of the picture, how far.

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
}

@group(3) @binding(0) var<uniform> work: Work;
