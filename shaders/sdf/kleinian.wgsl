// A pseudo-Kleinian set (Knighty, fractalforums.com, 2011) within a sphere; `reach` is the radius of
// that sphere in the set's own unit. Each step folds space at a box and inverts it within another
// sphere; the set is what ends near a disc.
//
// The field is the radius of a sphere around the point that is certainly on one side, from the
// distance to the disc back through the steps. Folds bring points nearer to each other. The
// inversion stretches by k / r² where that is more than 1: a way of s from r inward becomes at most
// k / (r - s) - k / r, which the code solves for s.

#include "generated/params/KleinianParams.wgsl"

fn sdf_kleinian(p: vec3f, q: KleinianParams) -> f32 {
    let corner = q.fold;
    let inversion = q.inversion;
    let scale = max(q.radius, 1e-9) / q.reach;
    var at = p / scale;
    var radii: array<f32, 8>;
    var count = 0;
    loop {
        if count == 8 || f32(count) + 0.5 >= q.iterations {
            break;
        }
        at = 2.0 * clamp(at, -corner, corner) - at;
        radii[count] = length(at);
        at *= max(inversion / max(dot(at, at), 1e-30), 1.0);
        count += 1;
    }
    let around = length(at.xz);
    let to_plane = abs(around * at.y / max(length(at), 1e-30));
    var field = max(to_plane, around - 0.92) - q.thickness;
    let edge = sqrt(inversion);
    for (var i = count - 1; i >= 0; i--) {
        let radius = radii[i];
        let way = abs(field);
        var back = way;
        if radius < edge {
            back = way * radius * radius / max(way * radius + inversion, 1e-30);
        } else if way > radius - edge {
            back = radius - inversion / max(way - radius + 2.0 * edge, 1e-30);
        }
        field = select(back, -back, field < 0.0);
    }
    return max(length(p) - q.radius, field * scale);
}
