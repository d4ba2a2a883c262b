// Repeat: copies at equal distances. `src/field/modify.rs` writes the rows:
// a: spacing, turn per cell; b: first cells, flags of mirrored axes; c: last cells, number of
// candidate cells along each axis (one number to the base of 128); d: center of the content in its
// cell, its least slope; e: its half extent; f: offsets; g, h: the omitted block, first cell and
// the one after the last; i, j: corners of the bounds.
//
// The candidates are the cell around the point and, along each axis, its neighbors, nearer ones
// first. All other cells are farther away than their bounds, and the distance to these bounds
// limits the field: so it is correct for any content.

fn repeat_candidates(c: vec4f) -> vec3u {
    let code = u32(c.w);
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
fn detach_repeat_index(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, f: vec4f) -> vec3f {
    let n = repeat_candidates(c);
    let y = repeat_base(p.y, a.y, b.y, c.y, d.y);
    let z = repeat_base(p.z, a.z, b.z, c.z, d.z);
    let yk = y + repeat_step((k / n.x) % n.y, repeat_side(p.y - y * a.y - d.y));
    let zk = z + repeat_step(k / (n.x * n.y), repeat_side(p.z - z * a.z - d.z));
    let row = p.x - f.x * yk;
    let x = repeat_base(row, a.x, b.x, c.x, d.x);
    return vec3f(x + repeat_step(k % n.x, repeat_side(row - x * a.x - d.x)), yk, zk);
}

// Position of a cell.
fn repeat_place(index: vec3f, a: vec4f, f: vec4f) -> vec3f {
    return index * a.xyz + vec3f(f.x * index.y, f.y * index.x, f.z * index.x);
}

fn repeat_exists(index: vec3f, b: vec4f, c: vec4f, g: vec4f, h: vec4f) -> bool {
    let carved = all(index >= g.xyz) && all(index < h.xyz);
    return all(index >= b.xyz) && all(index <= c.xyz) && !carved;
}

fn mod_repeat_count(a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f, g: vec4f, h: vec4f, i: vec4f, j: vec4f) -> u32 {
    let n = repeat_candidates(c);
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
fn mod_repeat_start(p: vec3f, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f, g: vec4f, h: vec4f, i: vec4f, j: vec4f) -> f32 {
    let n = repeat_candidates(c);
    let outside = max(max(i.xyz - p, p - j.xyz), vec3f(0.0));
    var x = repeat_beyond(p.x, a.x, b.x, c.x, d.x, e.x, n.x);
    if f.x != 0.0 && x < 3e38 {
        // Rows are shifted: take the least distance over all shifts.
        x = min((f32(n.x / 2u) + 0.5) * a.x, (f32((n.x - 1u) / 2u) + 1.0) * a.x) - e.x;
    }
    let y = repeat_beyond(p.y, a.y, b.y, c.y, d.y, e.y, n.y);
    let z = repeat_beyond(p.z, a.z, b.z, c.z, d.z, e.z, n.z);
    return min(
        select(3e38, length(vec3f(x, outside.y, outside.z)), x < 3e38),
        min(
            select(3e38, length(vec3f(outside.x, y, outside.z)), y < 3e38),
            select(3e38, length(vec3f(outside.x, outside.y, z)), z < 3e38),
        ),
    );
}

// Lower bound of the field of the k-th copy; 3e38 if the copy does not exist, -3e38 if unknown.
fn mod_repeat_bound(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f, g: vec4f, h: vec4f, i: vec4f, j: vec4f) -> f32 {
    let index = detach_repeat_index(p, k, a, b, c, d, f);
    let away = length(max(abs(p - repeat_place(index, a, f) - d.xyz) - e.xyz, vec3f(0.0))) * d.w;
    return select(3e38, select(-3e38, away, away > 0.0), repeat_exists(index, b, c, g, h));
}

// The point in the space of the k-th copy.
fn mod_repeat_point(p: vec3f, k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f, g: vec4f, h: vec4f, i: vec4f, j: vec4f) -> vec3f {
    let index = detach_repeat_index(p, k, a, b, c, d, f);
    var q = p - repeat_place(index, a, f);
    if a.w != 0.0 {
        let angle = a.w * (index.x + index.y + index.z);
        let turn = vec2f(cos(angle), sin(angle));
        q = vec3f(turn.x * q.x - turn.y * q.z, q.y, turn.y * q.x + turn.x * q.z);
    }
    let flags = u32(b.w);
    let odd = abs(index - 2.0 * floor(index * 0.5)) > vec3f(0.5);
    let flip = odd & (vec3u(flags & 1u, flags & 2u, flags & 4u) != vec3u(0u));
    return select(q, -q, flip);
}

fn mod_repeat_scale(k: u32, a: vec4f, b: vec4f, c: vec4f, d: vec4f, e: vec4f, f: vec4f, g: vec4f, h: vec4f, i: vec4f, j: vec4f) -> f32 {
    return 1.0;
}
