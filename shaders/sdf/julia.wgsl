// A Julia set of quaternions (Norton, "Julia sets in the quaternions", 1989) within a sphere. The set
// where iterating z² + c does not leave the sphere of radius R = (1 + sqrt(1 + 4|c|)) / 2, outside
// of which every step leads farther out.
//
// The field is the radius of a sphere around the point that is certainly on one side:
// |w² - z²| <= 2|z|s + s² where |w - z| <= s. If the sphere of radius t around z² + c is on one side, so is the
// sphere of radius sqrt(|z|² + t) - |z| around z. These radii follow from the orbit, from the last
// step back to the first.

#include "generated/params/JuliaParams.wgsl"

fn sdf_julia(p: vec3f, q: JuliaParams) -> f32 {
    let constant = vec4f(q.constant, q.fourth);
    let escape = 0.5 + sqrt(0.25 + length(constant));
    let scale = max(q.radius, 1e-9) / escape;
    var at = vec4f(p / scale, 0.0);
    var radii: array<f32, 17>;
    var last = 0;
    loop {
        radii[last] = length(at);
        // This far out, the distance to the sphere is more than the bound from later steps.
        if last == 16 || f32(last) + 0.5 > q.iterations || radii[last] > 4.0 * escape {
            break;
        }
        at = vec4f(at.x * at.x - dot(at.yzw, at.yzw), 2.0 * at.x * at.yzw) + constant;
        last += 1;
    }
    var field = radii[last] - escape;
    for (var i = last - 1; i >= 0; i--) {
        let radius = radii[i];
        let sum = sqrt(radius * radius + abs(field)) + radius;
        field = max(radius - escape, field / max(sum, 1e-30));
    }
    return field * scale;
}
