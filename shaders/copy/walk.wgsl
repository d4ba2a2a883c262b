// The walk along a ray or a cone through the copies of an instancer. Counterpart of
// `src/field/copies/walk.rs`.

#include "copy/space.wgsl"
#include "copy/walk_list.wgsl"
#include "copy/blocks.wgsl"

// A copy whose bounding sphere the cone meets, and where.
struct CopyVisit {
    copy: Copy,
    entry: f32,
    exit: f32,
}

// How far a copy may be off the place of its cell along an axis, with the shift of rows.
fn walk_reach(axis: u32) -> f32 {
    return instancer.reach[axis] + select(0.0, 2.0 * instancer.stagger, axis == 0u);
}

// The first and the last cell along an axis whose copies may meet the cone between two parameters.
fn walk_cells(walk: ptr<function, CopyWalk>, axis: u32, start: f32, end: f32) -> vec2i {
    let origin = (*walk).origin[axis];
    let direction = (*walk).direction[axis];
    let a = origin + direction * start;
    let b = origin + direction * end;
    let reach = walk_reach(axis) + (*walk).spread * end;
    let spacing = instancer.spacing[axis];
    let first = clamp((min(a, b) - reach) / spacing, -1e9, 1e9);
    let last = clamp((max(a, b) + reach) / spacing, -1e9, 1e9);
    return vec2i(max(i32(ceil(first)), instancer.low[axis]), min(i32(floor(last)), instancer.high[axis]));
}

// Where the cone may meet copies of a slab.
fn walk_slab(walk: ptr<function, CopyWalk>, slab: i32, far: f32) -> vec2f {
    let axis = (*walk).axis;
    let direction = (*walk).direction[axis];
    let middle = f32(slab) * instancer.spacing[axis] - (*walk).origin[axis];
    let reach = walk_reach(axis);
    let speed = abs(direction);
    let spread = (*walk).spread;
    let ahead = select(middle, -middle, direction < 0.0);
    let entry = (ahead - reach) / max(speed + spread, 1e-12);
    let exit = select(far, (ahead + reach) / max(speed - spread, 1e-12), speed > spread);
    let is_still = speed + spread < 1e-12;
    return select(vec2f(max(entry, (*walk).near), min(exit, far)), vec2f((*walk).near, far), is_still);
}

// Begins at `near`, for copies of this kind. `budget`: most cells that are looked at.
fn copy_walk_begin(kind: u32, origin: vec3f, direction: vec3f, near: f32, far: f32, spread: f32, budget: u32) -> CopyWalk {
    var walk: CopyWalk;
    walk.origin = origin;
    walk.direction = direction;
    walk.spread = spread;
    walk.budget = budget;
    walk.near = near;
    walk.cell = vec3i(1);
    walk.entry = near;
    walk.block = BLOCK_SLABS;
    // Between the bounds of all copies.
    let interval = walk_interval(&walk, instancer.bounds_low, instancer.bounds_high, far);
    walk.near = interval.x;
    let end = interval.y;
    if walk.near > end {
        return walk;
    }
    if instancer_count(instancer.tree_count, direction.x) > 0u {
        walk_begin_list(&walk, kind);
        return walk;
    }
    let is_long = instancer.low != instancer.high;
    let speed = select(vec3f(-1.0), abs(direction) / instancer.spacing, is_long);
    walk.axis = select(0u, 1u, speed.y > speed.x);
    walk.axis = select(walk.axis, 2u, speed.z > speed[walk.axis]);
    let slabs = walk_cells(&walk, walk.axis, walk.near, end);
    walk.left = max(slabs.y - slabs.x + 1, 0);
    walk.slab = select(slabs.x, slabs.y, direction[walk.axis] < 0.0);
    return walk;
}

// What `copy_walk_go_on` is told in w: where a walk goes on.
const WALK_AT_CELL: i32 = 1;
const WALK_AT_SLAB: i32 = 2;

// Moves a walk that has begun on to where another was left: to a cell, to the node of a list, or to
// the slab of a cell.
fn copy_walk_go_on(walk: ptr<function, CopyWalk>, at: vec4i, far: f32) {
    if instancer_count(instancer.tree_count, (*walk).direction.x) > 0u {
        if (*walk).open > 0u {
            walk_go_on_list(walk, u32(at.y));
        }
        return;
    }
    let slab = at[(*walk).axis];
    (*walk).left = select((*walk).left - abs(slab - (*walk).slab), 0, (*walk).left <= 0);
    (*walk).slab = slab;
    if at.w == WALK_AT_CELL && (*walk).left > 0 && !walk_next_slab(walk, far) {
        (*walk).cell = at.xyz;
    }
}

// Where a walk that is not over goes on.
fn copy_walk_left(walk: ptr<function, CopyWalk>) -> vec4i {
    if instancer_count(instancer.tree_count, (*walk).direction.x) > 0u {
        return vec4i(0, i32(walk_stack[(*walk).open - 1u]), 0, WALK_AT_CELL);
    }
    let is_between = any((*walk).cell > (*walk).high);
    return select(vec4i((*walk).cell, WALK_AT_CELL), vec4i(vec3i((*walk).slab), WALK_AT_SLAB), is_between);
}

fn copy_walk_is_over(walk: ptr<function, CopyWalk>) -> bool {
    let is_list = instancer_count(instancer.tree_count, (*walk).direction.x) > 0u;
    return select((*walk).left <= 0 && any((*walk).cell > (*walk).high), (*walk).open == 0u, is_list);
}

// The next copy of this kind whose bounding sphere the cone meets before `far`; false if there is
// none.
fn copy_walk_next(walk: ptr<function, CopyWalk>, kind: u32, far: f32, found: ptr<function, CopyVisit>) -> bool {
    let is_list = instancer_count(instancer.tree_count, (*walk).direction.x) > 0u;
    let masks = instancer_count(instancer.mask_count, (*walk).direction.x);
    // Without motions a look before them saves less than it costs.
    let still = instancer_count(instancer.dynamic_count, (*walk).direction.x) == 0u;
    loop {
        if copy_walk_is_over(walk) {
            return false;
        }
        if (*walk).budget == 0u {
            (*walk).exhausted = true;
            return false;
        }
        (*walk).budget -= 1u;
        var looks = false;
        if is_list {
            looks = walk_step_list(walk, far);
        } else if any((*walk).cell > (*walk).high) {
            if masks > 0u && (*walk).pause == 0 && (*walk).left >= BLOCK_LEAST {
                copy_walk_pass_block(walk, far, masks);
                continue;
            }
            (*walk).pause = max((*walk).pause - 1, 0);
            if walk_next_slab(walk, far) {
                return false;
            }
            continue;
        } else {
            looks = walk_step_cell(walk);
        }
        if !looks {
            continue;
        }
        let at_rest = copy_at_rest((*walk).at, kind);
        if at_rest.kind == COPY_ABSENT || !(walk_may_meet(walk, at_rest.place) || still) {
            continue;
        }
        let copy = copy_moved((*walk).at, at_rest);
        if copy.kind != COPY_ABSENT && walk_meets(walk, copy, far, found) {
            return true;
        }
    }
    return false;
}

// Moves on to the next slab; true if it begins behind `far`.
fn walk_next_slab(walk: ptr<function, CopyWalk>, far: f32) -> bool {
    let axis = (*walk).axis;
    let slab = (*walk).slab;
    (*walk).slab += select(1, -1, (*walk).direction[axis] < 0.0);
    (*walk).left -= 1;
    let interval = walk_slab(walk, slab, far);
    (*walk).entry = interval.x;
    if interval.x > far {
        (*walk).left = 0;
        return true;
    }
    let x = select(walk_cells(walk, 0u, interval.x, interval.y), vec2i(slab), axis == 0u);
    let y = select(walk_cells(walk, 1u, interval.x, interval.y), vec2i(slab), axis == 1u);
    let z = select(walk_cells(walk, 2u, interval.x, interval.y), vec2i(slab), axis == 2u);
    (*walk).low = vec3i(x.x, y.x, z.x);
    (*walk).high = vec3i(x.y, y.y, z.y);
    (*walk).cell = select(vec3i(x.y + 1, y.x, z.x), (*walk).low, interval.x <= interval.y && all((*walk).low <= (*walk).high));
    return false;
}

// Looks at the next cell, and moves on.
fn walk_pass_cell(walk: ptr<function, CopyWalk>) {
    let cell = (*walk).cell;
    let low = (*walk).low;
    let high = (*walk).high;
    // X first, then Y, then Z; at the end any component is beyond its range.
    let wraps_x = cell.x >= high.x;
    let wraps_y = wraps_x && cell.y >= high.y;
    let is_last = wraps_y && cell.z >= high.z;
    let next = vec3i(select(cell.x + 1, low.x, wraps_x), select(select(cell.y, cell.y + 1, wraps_x), low.y, wraps_y), select(cell.z, cell.z + 1, wraps_y));
    (*walk).at = cell;
    (*walk).cell = select(next, high + 1, is_last);
}

// Moves on to the next cell of the slab; true if its reach meets the cone.
fn walk_step_cell(walk: ptr<function, CopyWalk>) -> bool {
    let cell = (*walk).cell;
    walk_pass_cell(walk);
    let away = copy_cell_place(cell) - (*walk).origin;
    let direction = (*walk).direction;
    let nearest = dot(away, direction) / dot(direction, direction);
    let miss = away - direction * nearest;
    let most = length(instancer.reach);
    // Radius of the cone where the sphere of this radius ends at the latest.
    let wide = (*walk).spread * max(nearest + most * inverseSqrt(dot(direction, direction)), 0.0);
    // Seen from above, the reach is less for what is tall.
    let level = direction.xz;
    let beside = abs(away.x * level.y - away.z * level.x);
    let near = (length(instancer.reach.xz) + wide) * length(level);
    return dot(miss, miss) <= (most + wide) * (most + wide) && beside <= near;
}

// Whether the cone may meet the copy that stands here at rest.
fn walk_may_meet(walk: ptr<function, CopyWalk>, place: vec3f) -> bool {
    let away = place - (*walk).origin;
    let direction = (*walk).direction;
    let square = dot(direction, direction);
    let nearest = dot(away, direction) / square;
    let miss = away - direction * nearest;
    let reach = instancer.reach_at_rest;
    let wide = reach + (*walk).spread * max(nearest + reach * inverseSqrt(square), 0.0) + 1e-6 * abs(nearest) * sqrt(square);
    return dot(miss, miss) <= wide * wide;
}

// Whether the cone meets the bounding sphere of a copy before `far`.
fn walk_meets(walk: ptr<function, CopyWalk>, copy: Copy, far: f32, found: ptr<function, CopyVisit>) -> bool {
    let sphere = copy_sphere(copy);
    let away = sphere.xyz - (*walk).origin;
    let direction = (*walk).direction;
    let speed = length(direction);
    let nearest = dot(away, direction) / (speed * speed);
    let radius = sphere.w + (*walk).spread * clamp(nearest + sphere.w / speed, 0.0, far);
    let miss = away - direction * nearest;
    let depth = radius * radius - dot(miss, miss);
    let half = sqrt(max(depth, 0.0)) / speed;
    let entry = max(nearest - half, (*walk).near);
    let exit = min(nearest + half, far);
    if depth < 0.0 || entry > exit {
        return false;
    }
    *found = CopyVisit(copy, entry, exit);
    return true;
}
