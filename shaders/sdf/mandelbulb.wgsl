// A Mandelbulb (White and Nylander, "The unraveling of the real 3D Mandelbulb", 2009) of a power n
// within a sphere. The set where iterating z -> P(z) + c, from z = c on, does not leave the sphere
// of radius B = 2^(1/(n-1)), outside of which every step leads farther out. P raises the distance from the center to the power n, and multiplies the angle from
// the Y axis and the angle around it by n.
//
// The field is the radius of a sphere around the point that is certainly on one side (the idea:
// Hart, Sandin and Kauffman, "Ray tracing deterministic 3-D fractals", 1989), from the last step
// back to the first: if the sphere of radius t around P(z) + c is on one side, so is that of radius
// e around z where e (1 + L) = t. L bounds the stretch of P within that sphere, and c moves by no
// more than z. P stretches by n |z|^(n-1) max(1, |sin n a / sin a|), a being the angle from the
// axis; the code bounds that quotient by the lesser of n and 1 / sin a. This also yields the
// spheres within such a sphere: the slope is at most 1.

#include "generated/params/MandelbulbParams.wgsl"
#include "sdf/detach.wgsl"

fn sdf_mandelbulb(p: vec3f, q: MandelbulbParams) -> f32 {
    let power = clamp(floor(q.power + 0.5), 2.0, 16.0);
    let escape = exp2(1.0 / (power - 1.0));
    // This far out, the distance to the sphere is more than the bound from later steps:
    // (2r - B)^n >= 2 r^n.
    let reach = escape / (2.0 - exp2(1.0 / power));
    let scale = max(q.radius, 1e-9) / escape;
    let start = p / scale;
    var at = start;
    // Distances from the center and from the axis.
    var orbit: array<vec2f, 17>;
    var last = 0;
    loop {
        orbit[last] = vec2f(length(at), length(at.xz));
        if last == 16 || f32(last) + 0.5 > q.iterations || orbit[last].x > reach {
            break;
        }
        at = start + sdf_mandelbulb_power(at, orbit[last].y, u32(power));
        last += 1;
    }
    var field = orbit[last].x - escape;
    for (var i = last - 1; i >= 0; i--) {
        let back = sdf_mandelbulb_back(orbit[i], abs(field), power);
        field = max(orbit[i].x - escape, select(back, -back, field < 0.0));
    }
    return field * scale;
}

// P, as powers of two complex numbers by squaring: height and distance from the axis, the direction around it.
fn sdf_mandelbulb_power(at: vec3f, around: f32, power: u32) -> vec3f {
    var square = vec4f(at.y, around, at.xz / max(around, 1e-18));
    var product = vec4f(1.0, 0.0, 1.0, 0.0);
    for (var bits = power; bits > 0u; bits >>= 1u) {
        if (bits & 1u) == 1u {
            product = sdf_mandelbulb_times(product, square);
        }
        square = sdf_mandelbulb_times(square, square);
    }
    return vec3f(product.y * product.z, product.x, product.y * product.w);
}

// Two products of complex numbers.
fn sdf_mandelbulb_times(u: vec4f, v: vec4f) -> vec4f {
    return u.xxzz * v.xyzw + vec4f(-1.0, 1.0, -1.0, 1.0) * u.yyww * v.yxwz;
}

// The radius e at a place of the orbit (distance from the center, from the axis) for which
// e (1 + L) is the way. Newton's method on logarithms, in which the slope only grows, descends to it; the
// code subtracts the remainder. Only the last step takes part in differentiation.
fn sdf_mandelbulb_back(spot: vec2f, way: f32, power: f32) -> f32 {
    let fixed = detach_vec2(spot);
    let goal = detach_f32(max(way, 1e-30));
    var radius = goal / (1.0 + sdf_mandelbulb_stretch(fixed, 0.0, power).x);
    for (var i = 0; i < 6; i++) {
        let stretch = sdf_mandelbulb_stretch(fixed, radius, power);
        let excess = log2(radius * (1.0 + stretch.x) / goal);
        radius *= exp2(-excess * (1.0 + stretch.x) / (1.0 + stretch.x + stretch.y));
        if abs(excess) < 1e-3 {
            break;
        }
    }
    let stretch = sdf_mandelbulb_stretch(spot, radius, power);
    let slope = detach_f32(1.0 + stretch.x + stretch.y);
    let safe = radius / max(detach_f32(radius * (1.0 + stretch.x)) / goal, 1.0);
    return safe + (way - detach_f32(way) - radius * (stretch.x - detach_f32(stretch.x))) / slope;
}

// L within the radius, and the radius times its derivative.
fn sdf_mandelbulb_stretch(spot: vec2f, radius: f32, power: f32) -> vec2f {
    let far = max(spot.x + radius, 1e-30);
    let beside = max(spot.y - radius, far / power);
    let stretch = power * pow(far, power - 1.0) * far / beside;
    let nearing = select(0.0, radius / beside + radius / far, spot.y - radius > far / power);
    return vec2f(stretch, stretch * ((power - 1.0) * radius / far + nearing));
}
