// The state of a walk, and the walk through a list of places. Counterpart of
// `src/field/copies/walk.rs`.

#include "copy/instancer.wgsl"

struct CopyWalk {
    // In the instancer's space, relative to the anchor's place. The parameter is the distance in
    // the world, so the direction need not have unit length.
    origin: vec3f,
    near: f32,
    direction: vec3f,
    // Radius of the cone at parameter 1.
    spread: f32,
    // The axis along which slabs are walked, the next slab, and how many are left.
    axis: u32,
    slab: i32,
    left: i32,
    // Cells that may be looked at, so that no invocation runs on for ever; `exhausted` tells that
    // there were more, from `entry` on.
    budget: u32,
    // The next cell of the current slab, and the range of its cells.
    cell: vec3i,
    exhausted: bool,
    low: vec3i,
    entry: f32,
    high: vec3i,
    // Open nodes of the tree of a list.
    open: u32,
    // The cell or place to look at, see `copy_at`.
    at: vec3i,
}

const WALK_DEPTH: u32 = 32u;
var<private> walk_stack: array<u32, WALK_DEPTH>;

// Moves on to the next node of the tree; true if that is a leaf that the cone meets.
fn walk_step_list(walk: ptr<function, CopyWalk>, far: f32) -> bool {
    (*walk).open -= 1u;
    let index = walk_stack[(*walk).open];
    let row = instancer.first_row + 2u * index;
    let low = places[row];
    let high = places[row + 1u];
    let direction = (*walk).direction;
    let origin = (*walk).origin;
    let wide = (*walk).spread * far;
    let is_flat = abs(direction) < vec3f(1e-12);
    let safe = select(direction, vec3f(1e-12), is_flat);
    let a = (low.xyz - wide - origin) / safe;
    let b = (high.xyz + wide - origin) / safe;
    let first = min(a, b);
    let last = max(a, b);
    let entry = max((*walk).near, max(first.x, max(first.y, first.z)));
    let exit = min(far, min(last.x, min(last.y, last.z)));
    if entry > exit {
        return false;
    }
    let link = bitcast<u32>(low.w);
    let axis = bitcast<u32>(high.w);
    if axis == 3u {
        (*walk).at = vec3i(i32(link), 0, 0);
        return true;
    }
    let is_backward = direction[axis] < 0.0;
    walk_stack[(*walk).open] = select(link, index + 1u, is_backward);
    walk_stack[(*walk).open + 1u] = select(index + 1u, link, is_backward);
    (*walk).open += 2u;
    return false;
}
