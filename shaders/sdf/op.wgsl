// Operators. `blend_params` is the first row of the joining operand: the support in x, further
// values of the operator or the kernel in z and w. `op_join` and the functions that it calls for
// extended operators return (value, derivative by a, derivative by b, b's weight in the material).
// Union, intersection and difference return (value, weight of b): the weight is the size of the
// derivative by b, and also b's weight in the material; a has the rest. Counterpart:
// `src/field/eval/op.rs`.
//
// Beyond |a - b| >= support, union, intersection and difference are exactly hard. Support 0 is hard
// everywhere. The numbers of the joins and kernels are those of `Join` and `BlendKernel` on the
// CPU.

const JOIN_FIRST: u32 = 0u;
const JOIN_UNION: u32 = 1u;
const JOIN_INTERSECTION: u32 = 2u;
const JOIN_DIFFERENCE: u32 = 3u;
const JOIN_XOR: u32 = 4u;
const JOIN_PIPE: u32 = 5u;
const JOIN_GROOVE: u32 = 6u;
const JOIN_TONGUE: u32 = 7u;
const JOIN_ENGRAVE: u32 = 8u;
const JOIN_MORPH: u32 = 9u;
const JOIN_PAINT: u32 = 10u;
const JOIN_REVERSE_DIFFERENCE: u32 = 11u;

const KERNEL_CIRCULAR: u32 = 0u;
const KERNEL_QUADRATIC: u32 = 1u;
const KERNEL_CUBIC: u32 = 2u;
const KERNEL_SMOOTH_CHAMFER: u32 = 3u;
const KERNEL_CHAMFER: u32 = 4u;
const KERNEL_STAIRS: u32 = 5u;
const KERNEL_COLUMNS: u32 = 6u;

const SQRT_2: f32 = 1.41421356;

// Joins the operand b to the result so far, a. `EXTENDED_JOINS` and `EXTENDED_KERNELS` say whether
// the component has any beyond the first three; other pipelines leave them out.
fn op_join(join: u32, a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec4f {
    if EXTENDED_JOINS && join > JOIN_DIFFERENCE {
        return op_extended(join, a, b, blend_params, kernel);
    }
    let sign_a = select(1.0, -1.0, join >= JOIN_INTERSECTION);
    let sign_b = select(1.0, -1.0, join == JOIN_INTERSECTION);
    let joined = op_union(sign_a * a, sign_b * b, blend_params, kernel);
    return vec4f(sign_a * joined.x, 1.0 - joined.y, sign_a * sign_b * joined.y, joined.y);
}

fn op_union(a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec2f {
    let blend = op_blend(abs(a - b), blend_params, kernel);
    // Not `min`: for that lavapipe also tests for NaN.
    return vec2f(select(a, b, b < a) - blend.x, select(blend.y, 1.0 - blend.y, b < a));
}

fn op_intersection(a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec2f {
    let joined = op_union(-a, -b, blend_params, kernel);
    return vec2f(-joined.x, joined.y);
}

// a minus b.
fn op_difference(a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec2f {
    let joined = op_union(-a, b, blend_params, kernel);
    return vec2f(-joined.x, joined.y);
}

// The amount that a blend takes from the lesser of two operands that differ by `difference`, and
// the weight of the greater. Kernels: Quilez, "smooth minimum", scaled by their supports to the
// same thickening.
fn op_blend(difference: f32, blend_params: vec4f, kernel: u32) -> vec2f {
    let support = blend_params.x;
    let h = (support - difference) * (1.0 / support);
    // May be NaN beyond the support, where the `select` below discards it.
    var blend: vec2f;
    if EXTENDED_KERNELS && kernel >= KERNEL_SMOOTH_CHAMFER {
        blend = op_extended_blend(difference, h, blend_params, kernel);
    } else if kernel == KERNEL_CIRCULAR {
        let root = sqrt(2.0 * support * support - difference * difference);
        blend = vec2f(support - 0.5 * difference - 0.5 * root, 0.5 - 0.5 * difference / root);
    } else if kernel == KERNEL_QUADRATIC {
        blend = vec2f(0.25 * support * h * h, 0.5 * h);
    } else {
        blend = vec2f((1.0 / 6.0) * support * h * (h * h), 0.5 * h * h);
    }
    return select(vec2f(0.0), blend, difference < support);
}

// The same for bevels. Steps and columns: Mercury's hg_sdf (2015) builds its stairs in the same
// coordinates, the operands' sum and difference; the columns here are arcs of 90 degrees, so that
// no derivative exceeds 1.
fn op_extended_blend(difference: f32, h: f32, blend_params: vec4f, kernel: u32) -> vec2f {
    let support = blend_params.x;
    if kernel == KERNEL_SMOOTH_CHAMFER {
        if h > 0.5 {
            return vec2f(0.5 * (0.75 * support - difference), 0.5);
        }
        return vec2f(0.5 * support * h * h, h);
    }
    if kernel == KERNEL_CHAMFER {
        return vec2f(0.5 * support * h, 0.5);
    }
    // Each of blend_params.z steps is two `half` wide; u is the position of the point in its step,
    // from -1 to 1.
    let half = support / blend_params.z;
    let u = clamp(2.0 * fract(0.5 * h * blend_params.z), 0.0, 2.0);
    if kernel == KERNEL_STAIRS {
        return vec2f(0.5 * (support * h + half * (1.0 - abs(1.0 - u))), select(0.0, 1.0, u <= 1.0));
    }
    let root = sqrt(2.0 - (1.0 - u) * (1.0 - u));
    return vec2f(0.5 * (support * h + half * (root - 1.0)), 0.5 * (1.0 + (1.0 - u) / root));
}

// The operators beyond the first three.
fn op_extended(join: u32, a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec4f {
    if join == JOIN_XOR {
        return op_xor(a, b, blend_params, kernel);
    }
    if join == JOIN_PIPE {
        return op_pipe(a, b, blend_params.z);
    }
    if join == JOIN_MORPH {
        return vec4f(mix(a, b, blend_params.w), 1.0 - blend_params.w, blend_params.w, blend_params.w);
    }
    if join == JOIN_PAINT {
        return vec4f(a, 1.0, 0.0, op_paint(b, blend_params.x));
    }
    if join == JOIN_ENGRAVE {
        return op_engrave(a, b, blend_params, kernel);
    }
    if join == JOIN_REVERSE_DIFFERENCE {
        let joined = op_difference(b, a, blend_params, kernel);
        return vec4f(joined.x, -joined.y, 1.0 - joined.y, 1.0 - joined.y);
    }
    return op_groove(join, a, b, blend_params, kernel);
}

// The symmetric difference: all points in one but not in both.
fn op_xor(a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec4f {
    let outer = op_union(a, b, blend_params, kernel);
    let inner = op_intersection(a, b, blend_params, kernel);
    if -inner.x > outer.x {
        return vec4f(-inner.x, inner.y - 1.0, -inner.y, inner.y);
    }
    return vec4f(outer.x, 1.0 - outer.y, outer.y, outer.y);
}

// A round tube along the curve where both are 0. Both terms are bounds of the distance: the first has the surface,
// and is divided by the greatest slope that it can have; the second is the greater far away. It has b's material.
fn op_pipe(a: f32, b: f32, radius: f32) -> vec4f {
    let greater = max(abs(a), abs(b));
    let part = min(abs(a), abs(b)) / max(greater, 1e-30);
    let stretch = sqrt(1.0 + part * part);
    let round = (greater * stretch - radius) * (0.5 * SQRT_2);
    if round > greater - radius {
        let way = 0.5 * SQRT_2 / (stretch * max(greater, 1e-30));
        return vec4f(round, a * way, b * way, 1.0);
    }
    let sign_a = select(1.0, -1.0, a < 0.0);
    let sign_b = select(1.0, -1.0, b < 0.0);
    let follows = select(0.0, 1.0, abs(b) > abs(a));
    return vec4f(greater - radius, (1.0 - follows) * sign_a, follows * sign_b, 1.0);
}

// A groove or a tongue of half width blend_params.z along the surface of b, blend_params.w deep or high.
fn op_groove(join: u32, a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec4f {
    let sign = select(1.0, -1.0, join == JOIN_GROOVE);
    let side = abs(b) - blend_params.z;
    let end = sign * a - blend_params.w;
    let joined = op_union(sign * a, max(side, end), blend_params, kernel);
    let w = joined.y;
    if end > side {
        return vec4f(sign * joined.x, 1.0, 0.0, w);
    }
    return vec4f(sign * joined.x, 1.0 - w, sign * select(w, -w, b < 0.0), w);
}

// A V of 45 degrees along the surface of b, blend_params.w deep.
fn op_engrave(a: f32, b: f32, blend_params: vec4f, kernel: u32) -> vec4f {
    let cut = 0.5 * (abs(b) - a - blend_params.w);
    let joined = op_difference(a, cut, blend_params, kernel);
    let w = joined.y;
    return vec4f(joined.x, 1.0 - 0.5 * w, 0.5 * select(-w, w, b < 0.0), w);
}

// The weight of the paint b, whose edge fades over `radius` to both sides.
fn op_paint(b: f32, radius: f32) -> f32 {
    if abs(b) >= radius {
        return select(0.0, 1.0, b < 0.0);
    }
    let h = 0.5 - 0.5 * b / radius;
    return h * h * (3.0 - 2.0 * h);
}

// Hard operators, for pipelines without blends.
fn op_hard_union(a: f32, b: f32) -> vec2f {
    return vec2f(min(a, b), select(0.0, 1.0, b < a));
}

fn op_hard_intersection(a: f32, b: f32) -> vec2f {
    return vec2f(max(a, b), select(0.0, 1.0, b > a));
}

fn op_hard_difference(a: f32, b: f32) -> vec2f {
    return vec2f(max(a, -b), select(0.0, 1.0, -b > a));
}
