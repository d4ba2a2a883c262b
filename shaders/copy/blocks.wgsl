// Blocks of slabs that masks leave empty: a walk passes them whole. Counterpart of
// `src/field/copies/blocks.rs`.

// Slabs of the first block that is tried, of the one after it if that is not empty, and of the
// largest. An empty block is followed by one that is BLOCK_LEAST times as long.
const BLOCK_SLABS: i32 = 16;
const BLOCK_LEAST: i32 = 4;
const BLOCK_MOST: i32 = 4096;
// Rounding of places, in relation to their coordinates.
const BLOCK_SLACK: f32 = 1e-5;

// Whether masks let no copy stand in a box of places, relative to the anchor's place.
fn copy_block_is_empty(low: vec3f, high: vec3f, masks: u32) -> bool {
    let center = 0.5 * (low + high);
    let half = 0.5 * (high - low) + BLOCK_SLACK * (abs(center + instancer.anchor_place) + 1.0);
    return copy_masks_most(center, half, masks) <= 0.0;
}

// Passes the next slabs if they are empty before `far`; else tries fewer, or later.
fn copy_walk_pass_block(walk: ptr<function, CopyWalk>, far: f32, masks: u32) -> bool {
    let axis = (*walk).axis;
    let is_backward = (*walk).direction[axis] < 0.0;
    let count = min((*walk).block, (*walk).left);
    let last = (*walk).slab + select(count - 1, 1 - count, is_backward);
    let entry = walk_slab(walk, (*walk).slab, far).x;
    let exit = walk_slab(walk, last, far).y;
    let along = vec2i(min((*walk).slab, last), max((*walk).slab, last));
    let x = select(walk_cells(walk, 0u, entry, exit), along, axis == 0u);
    let y = select(walk_cells(walk, 1u, entry, exit), along, axis == 1u);
    let z = select(walk_cells(walk, 2u, entry, exit), along, axis == 2u);
    let shift = vec3f(2.0 * instancer.stagger, 0.0, 0.0);
    let low = vec3f(vec3i(x.x, y.x, z.x)) * instancer.spacing - shift;
    let high = vec3f(vec3i(x.y, y.y, z.y)) * instancer.spacing + shift;
    // Behind the end of the walk there is nothing to prove.
    let passes = entry <= exit && (any(low > high + 2.0 * shift) || copy_block_is_empty(low, max(low, high), masks));
    if passes {
        (*walk).slab = last + select(1, -1, is_backward);
        (*walk).left -= count;
        (*walk).block = min((*walk).block * BLOCK_LEAST, BLOCK_MOST);
    } else if (*walk).block > BLOCK_LEAST {
        (*walk).block = BLOCK_LEAST;
    } else {
        (*walk).block = BLOCK_SLABS;
        (*walk).pause = BLOCK_LEAST;
    }
    return passes;
}
