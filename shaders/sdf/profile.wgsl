// Profiles in the plane: the signed distance to closed curves made of arcs; exact. `data` is the shape's first row,
// see `src/field/prepare/profile.rs`.

#include "sdf/detach.wgsl"

// `overlaps`: inside by the nonzero rule, else by the even-odd rule.
fn sdf_profile(p: vec2f, groups: u32, overlaps: bool, data: u32) -> f32 {
    let found = detach_vec2(sdf_profile_nearest(p, groups, data));
    let row = u32(found.x);
    let first = scene_row(row);
    let second = scene_row(row + 1u);
    let w = p - first.xy;
    let x = dot(w, first.zw);
    let y = w.y * first.z - w.x * first.w;
    let foot = detach_f32(sdf_profile_foot(x, y, second.x));
    let reach = abs(second.y);
    // Distance to the right of the piece. A point on the curve counts as on the right, at a level
    // piece as above. The sign there is that of this side, so that the gradient is that of the
    // surface.
    let u = 1.0 - second.x * y;
    let m = sqrt(u * u + second.x * x * second.x * x);
    let right = (second.x * dot(w, w) - 2.0 * y) / (m + 1.0);
    let side = select(right, -right, second.z == second.w && first.z > 0.0);
    let aside = select(side, -side, side < 0.0);
    let lambda = clamp(foot, -reach, reach);
    let share = 2.0 * lambda / (1.0 + second.x * second.x * lambda * lambda);
    let from_end = length(vec2f(x - share, y - share * second.x * lambda));
    let d = select(from_end, aside, abs(foot) < reach);
    let turns = i32(found.y);
    return select(d, -d, select((turns & 1) != 0, turns != 0, overlaps));
}

// Row of the nearest piece, and winding number of the curves around the point.
fn sdf_profile_nearest(p: vec2f, groups: u32, data: u32) -> vec2f {
    // No group is farther away than the far corner of its box.
    var least = 1e37;
    for (var group = 0u; group < groups; group += 1u) {
        let box = scene_row(data + 1u + 2u * group);
        least = min(least, length(max(abs(p - box.xy), abs(p - box.zw))));
    }
    least = least * 1.00001 + 1e-30;
    let first = data + 1u + 2u * groups;
    var nearest = first;
    var turns = 0.0;
    for (var group = 0u; group < groups; group += 1u) {
        let box = scene_row(data + 1u + 2u * group);
        let chain = scene_row(data + 2u + 2u * group);
        // The ends of a chain wholly to the right decide its crossings; a chain wholly to the left
        // has none.
        let is_right = p.x < box.x;
        turns += select(0.0, select(0.0, 1.0, chain.y > p.y) - select(0.0, 1.0, chain.x > p.y), is_right);
        let reached = length(max(max(box.xy - p, p - box.zw), vec2f(0.0))) <= least;
        let count = select(0u, u32(chain.w), reached);
        for (var piece = 0u; piece < count; piece += 1u) {
            let row = first + 2u * (u32(chain.z) + piece);
            let place = scene_row(row);
            let arc = scene_row(row + 1u);
            let w = p - place.xy;
            let x = dot(w, place.zw);
            let y = w.y * place.z - w.x * place.w;
            let d = sdf_profile_distance(x, y, arc);
            nearest = select(nearest, row, d < least);
            least = min(least, d);
            // A piece that bends to the left is the right side of a circle: left of it is
            // everything left of the center, or in the circle.
            let from_circle = arc.x * dot(w, w) - 2.0 * y;
            let from_center = arc.x * w.x + place.w;
            let is_in = from_circle < 0.0;
            let is_in_or_beside = is_in || from_center < 0.0;
            let is_left = select(is_in && from_center > 0.0, is_in_or_beside, arc.x >= 0.0);
            let crosses = !is_right && arc.z <= p.y && p.y < arc.w && is_left;
            turns += select(0.0, select(1.0, -1.0, arc.y < 0.0), crosses);
        }
    }
    return vec2f(f32(nearest), turns);
}

// λ of the point of the circle nearest to (x, y), which is relative to the middle of the piece.
fn sdf_profile_foot(x: f32, y: f32, bend: f32) -> f32 {
    let u = 1.0 - bend * y;
    let m = sqrt(u * u + bend * x * bend * x);
    let behind = select(1.0, -1.0, x < 0.0) * (m - u) / max(bend * bend * abs(x), 1e-30);
    return clamp(select(behind, x / max(m + u, 1e-30), u >= 0.0), -1e12, 1e12);
}

fn sdf_profile_distance(x: f32, y: f32, arc: vec4f) -> f32 {
    let foot = sdf_profile_foot(x, y, arc.x);
    let u = 1.0 - arc.x * y;
    let m = sqrt(u * u + arc.x * x * arc.x * x);
    let aside = abs((arc.x * (x * x + y * y) - 2.0 * y) / (m + 1.0));
    let lambda = clamp(foot, -abs(arc.y), abs(arc.y));
    let share = 2.0 * lambda / (1.0 + arc.x * arc.x * lambda * lambda);
    return select(length(vec2f(x - share, y - share * arc.x * lambda)), aside, abs(foot) < abs(arc.y));
}
