// Repeat: copies at equal distances.
//
// The candidates are the cell around the point and, along each axis, its neighbors, nearer ones
// first. All other cells are farther away than their bounds, and the distance to these bounds
// limits the field: so it is correct for any content.

#include "generated/params/RepeatParams.wgsl"

fn repeat_candidates(q: RepeatParams) -> vec3u {
    let code = q.candidates;
    return vec3u(code & 127u, (code >> 7u) & 127u, code >> 14u);
}

// The cell around x along one axis.
fn repeat_base(x: f32, spacing: f32, first: f32, last: f32, middle: f32) -> f32 {
    return clamp(round((x - middle) / spacing), first, last);
}

// Offset of the n-th candidate: the cell itself, the nearer neighbor, the one across, and so on.
fn repeat_step(n: u32, side: f32) -> f32 {
    let away = f32((n + 1u) / 2u);
    return select(-away, away, (n & 1u) == 1u) * side;
}

fn repeat_side(x: f32) -> f32 {
    return select(-1.0, 1.0, x >= 0.0);
}

// The cell of the k-th copy.
fn detach_repeat_index(p: vec3f, k: u32, q: RepeatParams) -> vec3f {
    let n = repeat_candidates(q);
    let y = repeat_base(p.y, q.spacing.y, q.first.y, q.last.y, q.middle.y);
    let z = repeat_base(p.z, q.spacing.z, q.first.z, q.last.z, q.middle.z);
    let yk = y + repeat_step((k / n.x) % n.y, repeat_side(p.y - y * q.spacing.y - q.middle.y));
    let zk = z + repeat_step(k / (n.x * n.y), repeat_side(p.z - z * q.spacing.z - q.middle.z));
    let row = p.x - q.offset.x * yk;
    let x = repeat_base(row, q.spacing.x, q.first.x, q.last.x, q.middle.x);
    return vec3f(x + repeat_step(k % n.x, repeat_side(row - x * q.spacing.x - q.middle.x)), yk, zk);
}

// Position of a cell.
fn repeat_place(index: vec3f, q: RepeatParams) -> vec3f {
    return index * q.spacing + vec3f(q.offset.x * index.y, q.offset.y * index.x, q.offset.z * index.x);
}

fn repeat_exists(index: vec3f, q: RepeatParams) -> bool {
    let carved = all(index >= q.carve_from) && all(index < q.carve_to);
    return all(index >= q.first) && all(index <= q.last) && !carved;
}

fn mod_repeat_count(q: RepeatParams) -> u32 {
    let n = repeat_candidates(q);
    return n.x * n.y * n.z;
}

// Distance along one axis to the nearest cell that is not a candidate; 3e38 if there is none.
fn repeat_beyond(x: f32, spacing: f32, first: f32, last: f32, middle: f32, half: f32, candidates: u32) -> f32 {
    let base = repeat_base(x, spacing, first, last, middle);
    let place = x - middle - base * spacing;
    let near = f32(candidates / 2u);
    let across = f32((candidates - 1u) / 2u);
    let upper = place >= 0.0;
    let above = select(across, near, upper) + 1.0;
    let below = select(near, across, upper) + 1.0;
    return min(
        select(3e38, above * spacing - half - place, base + above <= last),
        select(3e38, below * spacing - half + place, base - below >= first),
    );
}

// Distance to all cells that are not candidates.
fn mod_repeat_start(p: vec3f, q: RepeatParams) -> f32 {
    let n = repeat_candidates(q);
    let outside = max(max(q.least - p, p - q.greatest), vec3f(0.0));
    var x = repeat_beyond(p.x, q.spacing.x, q.first.x, q.last.x, q.middle.x, q.half.x, n.x);
    if q.offset.x != 0.0 && x < 3e38 {
        // Rows are shifted: take the least distance over all shifts.
        x = min((f32(n.x / 2u) + 0.5) * q.spacing.x, (f32((n.x - 1u) / 2u) + 1.0) * q.spacing.x) - q.half.x;
    }
    let y = repeat_beyond(p.y, q.spacing.y, q.first.y, q.last.y, q.middle.y, q.half.y, n.y);
    let z = repeat_beyond(p.z, q.spacing.z, q.first.z, q.last.z, q.middle.z, q.half.z, n.z);
    return min(
        select(3e38, length(vec3f(x, outside.y, outside.z)), x < 3e38),
        min(
            select(3e38, length(vec3f(outside.x, y, outside.z)), y < 3e38),
            select(3e38, length(vec3f(outside.x, outside.y, z)), z < 3e38),
        ),
    );
}

// Lower bound of the field of the k-th copy; 3e38 if the copy does not exist, -3e38 if unknown.
fn mod_repeat_bound(p: vec3f, k: u32, q: RepeatParams) -> f32 {
    let index = detach_repeat_index(p, k, q);
    let away = length(max(abs(p - repeat_place(index, q) - q.middle) - q.half, vec3f(0.0))) * q.slope;
    return select(3e38, select(-3e38, away, away > 0.0), repeat_exists(index, q));
}

// The point in the space of the k-th copy.
fn mod_repeat_point(p: vec3f, k: u32, q: RepeatParams) -> vec3f {
    let index = detach_repeat_index(p, k, q);
    var at = p - repeat_place(index, q);
    if q.turn != 0.0 {
        let angle = q.turn * (index.x + index.y + index.z);
        let turn = vec2f(cos(angle), sin(angle));
        at = vec3f(turn.x * at.x - turn.y * at.z, at.y, turn.y * at.x + turn.x * at.z);
    }
    let flags = q.mirrored;
    let odd = abs(index - 2.0 * floor(index * 0.5)) > vec3f(0.5);
    let flip = odd & (vec3u(flags & 1u, flags & 2u, flags & 4u) != vec3u(0u));
    return select(at, -at, flip);
}

fn mod_repeat_scale(k: u32, q: RepeatParams) -> f32 {
    return 1.0;
}
