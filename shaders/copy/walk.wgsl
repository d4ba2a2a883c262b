// The walk along a ray or a cone through the copies of an instancer. Counterpart of
// `src/field/copies/walk.rs`.

#include "copy/space.wgsl"

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
    // Open nodes of the tree; NO_OPEN ends a walk through a list.
    open: u32,
}

// A copy whose bounding sphere the cone meets, and where.
struct CopyVisit {
    copy: Copy,
    entry: f32,
    exit: f32,
}

const WALK_DEPTH: u32 = 32u;
var<private> walk_stack: array<u32, WALK_DEPTH>;

// How far a copy may be off the place of its cell along an axis, with the shift of rows.
fn walk_reach(axis: u32) -> f32 {
    return instancer.reach + select(0.0, 2.0 * instancer.stagger, axis == 0u);
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

// Begins at `near`. `budget`: most cells that are looked at.
fn copy_walk_begin(origin: vec3f, direction: vec3f, near: f32, far: f32, spread: f32, budget: u32) -> CopyWalk {
    var walk: CopyWalk;
    walk.origin = origin;
    walk.direction = direction;
    walk.spread = spread;
    walk.budget = budget;
    walk.near = near;
    walk.cell = vec3i(1);
    walk.entry = near;
    // Between the bounds of all copies.
    let wide = spread * far;
    let low = (instancer.bounds_low - wide - origin) / direction;
    let high = (instancer.bounds_high + wide - origin) / direction;
    let is_flat = abs(direction) < vec3f(1e-12);
    let outside = is_flat & ((origin < instancer.bounds_low - wide) | (origin > instancer.bounds_high + wide));
    let first = select(min(low, high), vec3f(-1e30), is_flat);
    let last = select(max(low, high), vec3f(1e30), is_flat);
    walk.near = max(near, max(first.x, max(first.y, first.z)));
    let end = min(far, min(last.x, min(last.y, last.z)));
    if any(outside) || walk.near > end {
        return walk;
    }
    if instancer.tree_count > 0u {
        walk.open = 1u;
        walk_stack[0] = 0u;
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

// The next copy of this kind whose bounding sphere the cone meets before `far`; false if there is
// none.
fn copy_walk_next(walk: ptr<function, CopyWalk>, kind: u32, far: f32, found: ptr<function, CopyVisit>) -> bool {
    let is_list = instancer.tree_count > 0u;
    loop {
        if select((*walk).left <= 0 && any((*walk).cell > (*walk).high), (*walk).open == 0u, is_list) {
            return false;
        }
        if (*walk).budget == 0u {
            (*walk).exhausted = true;
            return false;
        }
        (*walk).budget -= 1u;
        var copy = copy_none();
        if is_list {
            copy = walk_step_list(walk, kind, far);
        } else if any((*walk).cell > (*walk).high) {
            if walk_next_slab(walk, far) {
                return false;
            }
            continue;
        } else {
            copy = walk_step_cell(walk, kind);
        }
        if copy.kind != NO_COPY && walk_meets(walk, copy, far, found) {
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

// The copy of the next cell of the slab, if it is of this kind and its reach meets the cone.
fn walk_step_cell(walk: ptr<function, CopyWalk>, kind: u32) -> Copy {
    let cell = (*walk).cell;
    let low = (*walk).low;
    let high = (*walk).high;
    // X first, then Y, then Z; at the end any component is beyond its range.
    let wraps_x = cell.x >= high.x;
    let wraps_y = wraps_x && cell.y >= high.y;
    let is_last = wraps_y && cell.z >= high.z;
    let next = vec3i(select(cell.x + 1, low.x, wraps_x), select(select(cell.y, cell.y + 1, wraps_x), low.y, wraps_y), select(cell.z, cell.z + 1, wraps_y));
    (*walk).cell = select(next, high + 1, is_last);
    let away = copy_cell_place(cell) - (*walk).origin;
    let direction = (*walk).direction;
    let nearest = dot(away, direction) / dot(direction, direction);
    let miss = away - direction * nearest;
    let reach = instancer.reach + (*walk).spread * max(nearest + instancer.reach * inverseSqrt(dot(direction, direction)), 0.0);
    if dot(miss, miss) > reach * reach {
        return copy_none();
    }
    return copy_of_cell(cell, kind);
}

// The copy of the next node of the tree, if that is a leaf that the cone meets.
fn walk_step_list(walk: ptr<function, CopyWalk>, kind: u32, far: f32) -> Copy {
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
        return copy_none();
    }
    let link = bitcast<u32>(low.w);
    let axis = bitcast<u32>(high.w);
    if axis == 3u {
        return copy_of_place(link, kind);
    }
    let is_backward = direction[axis] < 0.0;
    walk_stack[(*walk).open] = select(link, index + 1u, is_backward);
    walk_stack[(*walk).open + 1u] = select(index + 1u, link, is_backward);
    (*walk).open += 2u;
    return copy_none();
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
