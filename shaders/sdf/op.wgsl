// Operators. Each returns (value, weight of b): the weight is how much the value follows b, from 0 to 1,
// and is also b's share of the material; a has the rest.
//
// Beyond |a - b| >= support the operator is exactly hard. Support 0 is hard everywhere.
// The numbers of the joins and kernels are those of `Join` and `BlendKernel` on the CPU.

const JOIN_FIRST: u32 = 0u;
const JOIN_UNION: u32 = 1u;
const JOIN_INTERSECTION: u32 = 2u;
const JOIN_DIFFERENCE: u32 = 3u;

const KERNEL_CIRCULAR: u32 = 0u;
const KERNEL_QUADRATIC: u32 = 1u;
const KERNEL_CUBIC: u32 = 2u;

// The operand b joins what stands so far, a.
fn op_join(join: u32, a: f32, b: f32, support: f32, kernel: u32) -> vec2f {
    let sign_a = select(1.0, -1.0, join >= JOIN_INTERSECTION);
    let sign_b = select(1.0, -1.0, join == JOIN_INTERSECTION);
    let joined = op_union(sign_a * a, sign_b * b, support, kernel);
    return vec2f(sign_a * joined.x, joined.y);
}

fn op_union(a: f32, b: f32, support: f32, kernel: u32) -> vec2f {
    let blend = op_blend(abs(a - b), support, kernel);
    return vec2f(min(a, b) - blend.x, select(blend.y, 1.0 - blend.y, b < a));
}

fn op_intersection(a: f32, b: f32, support: f32, kernel: u32) -> vec2f {
    let joined = op_union(-a, -b, support, kernel);
    return vec2f(-joined.x, joined.y);
}

// a without b.
fn op_difference(a: f32, b: f32, support: f32, kernel: u32) -> vec2f {
    let joined = op_union(-a, b, support, kernel);
    return vec2f(-joined.x, joined.y);
}

// What a blend takes from the lesser of two operands that differ by `difference`, and the weight of the
// greater. Kernels: Quilez, "smooth minimum", scaled by their supports to one thickening.
fn op_blend(difference: f32, support: f32, kernel: u32) -> vec2f {
    if difference >= support {
        return vec2f(0.0);
    }
    let h = 1.0 - difference / support;
    if kernel == KERNEL_CIRCULAR {
        let root = sqrt(1.0 + h * (2.0 - h));
        return vec2f(0.5 * support * (1.0 + h - root), 0.5 * (1.0 - (1.0 - h) / root));
    }
    if kernel == KERNEL_QUADRATIC {
        return vec2f(0.25 * support * h * h, 0.5 * h);
    }
    return vec2f(support * h * h * h / 6.0, 0.5 * h * h);
}

// The hard operators, for kernels that know that nothing is blended.
fn op_hard_union(a: f32, b: f32) -> vec2f {
    return vec2f(min(a, b), select(0.0, 1.0, b < a));
}

fn op_hard_intersection(a: f32, b: f32) -> vec2f {
    return vec2f(max(a, b), select(0.0, 1.0, b > a));
}

fn op_hard_difference(a: f32, b: f32) -> vec2f {
    return vec2f(max(a, -b), select(0.0, 1.0, -b > a));
}
