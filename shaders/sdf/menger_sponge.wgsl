// A Menger sponge (Menger, "Dimensionstheorie", 1928): a cube minus the bars that fill the middle thirds of its cells along each axis.
//
// The field is the greatest of the distance to the cube and the depths of the point in the bars of
// each size.

#include "generated/params/MengerSpongeParams.wgsl"

fn sdf_menger_sponge(p: vec3f, q: MengerSpongeParams) -> f32 {
    let d = abs(p) - 0.5 * q.size;
    var field = length(max(d, vec3f(0.0))) + min(max(d.x, max(d.y, d.z)), 0.0);
    var side = q.size;
    for (var step = 0; step < 8; step++) {
        if f32(step) + 0.5 > q.iterations {
            break;
        }
        // Offset from the middle of the cell. The second least coordinate gives the depth in the
        // bars.
        let t = abs(p - side * round(p / max(side, 1e-30)));
        let second = max(min(t.x, t.y), min(max(t.x, t.y), t.z));
        field = max(field, side / 6.0 - second);
        side /= 3.0;
    }
    return field;
}
