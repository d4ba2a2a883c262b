// One dispatch: which component, which part of the picture, how far.

struct DispatchParams {
    // Upper left pixel.
    origin: vec2u,
    // First pixel outside.
    end: vec2u,
    component: u32,
    // Steps that an invocation may take in this dispatch.
    max_steps: u32,
    // 0 begins a march, later relaunches continue it.
    relaunch: u32,
    // 1 in the last relaunch: what has not ended by now is counted.
    last_relaunch: u32,
    // Which list of subtiles, see `common/subtiles.wgsl`.
    list: u32,
    // Where its subtiles start in `subtiles`.
    first_subtile: u32,
    // 1 where a march goes on with the rays that were left, compacted; 0 for all pixels of the subtiles.
    compacted: u32,
    // Where the rays that are left stand in `rays`.
    rays: u32,
    // Where the lists of subtiles with hits begin in `subtiles`.
    hits: u32,
}

@group(3) @binding(0) var<uniform> dispatch: DispatchParams;

// Pixels along a side of a tile: what a cone begins with.
const TILE: u32 = 8u;
