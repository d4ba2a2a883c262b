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
    // Slabs of the next block that may be empty, and slabs until one is tried again: see
    // `copy/blocks.wgsl`.
    block: i32,
    pause: i32,
    // The cell or place to look at, see `copy_at`. Of a place, the second is its node.
    at: vec3i,
}

// Those of a tree for one type, see `HIERARCHY_STACK`, below one over the types.
const WALK_DEPTH: u32 = 40u;
const WALK_NOWHERE: u32 = 0xffffffffu;
var<private> walk_stack: array<u32, WALK_DEPTH>;

// Where the cone enters and leaves a box: its bounds along each axis alone, so it may leave later.
fn walk_interval(walk: ptr<function, CopyWalk>, low: vec3f, high: vec3f, far: f32) -> vec2f {
    let origin = (*walk).origin;
    let spread = vec3f((*walk).spread);
    let is_backward = (*walk).direction < vec3f(0.0);
    let ahead = select(low - origin, origin - high, is_backward);
    let behind = select(high - origin, origin - low, is_backward);
    let speed = abs((*walk).direction);
    let entry = ahead / max(speed + spread, vec3f(1e-12));
    // A cone that is wider than steep never leaves on this axis.
    let leaves = (speed > spread) | (spread <= vec3f(0.0));
    let exit = select(vec3f(1e30), behind / max(speed - spread, vec3f(1e-12)), leaves);
    return vec2f(max((*walk).near, max(entry.x, max(entry.y, entry.z))), min(far, min(exit.x, min(exit.y, exit.z))));
}

// Opens the tree of a type, or the one of all.
fn walk_begin_list(walk: ptr<function, CopyWalk>, kind: u32) {
    let own = instancer.roots[min(kind / 4u, 7u)][kind % 4u];
    let root = select(own, 0u, kind == COPY_OF_ANY);
    walk_stack[0] = root;
    (*walk).open = select(1u, 0u, root == WALK_NOWHERE);
}

// Moves on to the next node of the tree; true if that is a leaf that the cone meets. The place to
// look at is then that of the leaf, with the number of the node as `at.y`.
fn walk_step_list(walk: ptr<function, CopyWalk>, far: f32) -> bool {
    (*walk).open -= 1u;
    let index = walk_stack[(*walk).open];
    let row = instancer.first_row + 2u * index;
    let low = places[row];
    let high = places[row + 1u];
    let interval = walk_interval(walk, low.xyz, high.xyz, far);
    if interval.x > interval.y {
        return false;
    }
    return walk_open_list(walk, index, bitcast<u32>(low.w), bitcast<u32>(high.w));
}

// Opens the children of a node, the nearer one on top; true if it is a leaf.
fn walk_open_list(walk: ptr<function, CopyWalk>, index: u32, link: u32, axis: u32) -> bool {
    if axis == 3u {
        (*walk).at = vec3i(i32(link), i32(index), 0);
        return true;
    }
    let is_backward = (*walk).direction[axis] < 0.0;
    walk_stack[(*walk).open] = select(link, index + 1u, is_backward);
    walk_stack[(*walk).open + 1u] = select(index + 1u, link, is_backward);
    (*walk).open += 2u;
    return false;
}

// Opens what a walk has open that is about to look at a node. It has begun at the root.
fn walk_go_on_list(walk: ptr<function, CopyWalk>, node: u32) {
    var index = walk_stack[0];
    (*walk).open = 0u;
    while index < node && (*walk).open + 1u < WALK_DEPTH {
        let row = instancer.first_row + 2u * index;
        let link = bitcast<u32>(places[row].w);
        let axis = min(bitcast<u32>(places[row + 1u].w), 2u);
        let is_backward = (*walk).direction[axis] < 0.0;
        // The left child follows its node, and all below it precede the right one.
        let is_right = node >= link;
        if is_right == is_backward {
            walk_stack[(*walk).open] = select(link, index + 1u, is_backward);
            (*walk).open += 1u;
        }
        index = select(index + 1u, link, is_right);
    }
    walk_stack[(*walk).open] = node;
    (*walk).open += 1u;
}
