// The walk through the copies around a point: all whose bounding spheres meet a ball. It goes on like
// a walk along a ray, with the cells of a box as its only slab.

#include "copy/walk.wgsl"

// `center` is in the instancer's space, relative to the anchor's place.
fn copy_around_begin(center: vec3f, radius: f32) -> CopyWalk {
    var walk: CopyWalk;
    walk.origin = center;
    walk.spread = radius;
    walk.cell = vec3i(1);
    if any(center < instancer.bounds_low - radius) || any(center > instancer.bounds_high + radius) {
        return walk;
    }
    if instancer_count(instancer.tree_count, center.x) > 0u {
        walk_begin_list(&walk, COPY_OF_ANY);
        return walk;
    }
    let reach = vec3f(walk_reach(0u), walk_reach(1u), walk_reach(2u)) + radius;
    let first = clamp((center - reach) / instancer.spacing, vec3f(-1e9), vec3f(1e9));
    let last = clamp((center + reach) / instancer.spacing, vec3f(-1e9), vec3f(1e9));
    walk.low = max(vec3i(ceil(first)), instancer.low);
    walk.high = min(vec3i(floor(last)), instancer.high);
    walk.cell = select(walk.high + 1, walk.low, all(walk.low <= walk.high));
    return walk;
}

// Moves a walk that has begun on to where another was left: see `copy_walk_left`.
fn copy_around_go_on(walk: ptr<function, CopyWalk>, at: vec3i) {
    if copy_walk_is_over(walk) {
        return;
    }
    if instancer_count(instancer.tree_count, (*walk).origin.x) > 0u {
        walk_go_on_list(walk, u32(at.y));
    } else {
        (*walk).cell = at;
    }
}

// The next copy; false if there is none, or if the budget of the walk is exhausted.
fn copy_around_next(walk: ptr<function, CopyWalk>, found: ptr<function, Copy>) -> bool {
    let is_list = instancer_count(instancer.tree_count, (*walk).origin.x) > 0u;
    let radius = (*walk).spread;
    loop {
        if copy_walk_is_over(walk) {
            return false;
        }
        if (*walk).budget == 0u {
            (*walk).exhausted = true;
            return false;
        }
        (*walk).budget -= 1u;
        if is_list {
            if !around_step_list(walk) {
                continue;
            }
        } else {
            walk_pass_cell(walk);
        }
        let at_rest = copy_at_rest((*walk).at, COPY_OF_ANY);
        if at_rest.kind == COPY_ABSENT || distance(at_rest.place, (*walk).origin) > instancer.reach_at_rest + radius {
            continue;
        }
        let copy = copy_moved((*walk).at, at_rest);
        if copy.kind != COPY_ABSENT {
            let sphere = copy_sphere(copy);
            if distance(sphere.xyz, (*walk).origin) <= sphere.w + radius {
                *found = copy;
                return true;
            }
        }
    }
    return false;
}

// Moves on to the next node of the tree; true if that is a leaf that the ball meets.
fn around_step_list(walk: ptr<function, CopyWalk>) -> bool {
    (*walk).open -= 1u;
    let index = walk_stack[(*walk).open];
    let row = instancer.first_row + 2u * index;
    let low = places[row];
    let high = places[row + 1u];
    let center = (*walk).origin;
    if length(max(max(low.xyz - center, center - high.xyz), vec3f(0.0))) > (*walk).spread {
        return false;
    }
    return walk_open_list(walk, index, bitcast<u32>(low.w), bitcast<u32>(high.w));
}
