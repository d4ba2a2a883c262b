//! Every operator with every kernel.

use isolith::field::Join;
use isolith::field::eval::{BlendParams, BlendResult, op_join};
use isolith::scene::{Blend, BlendKernel, Operator};

use super::samples::{Random, many};

/// The first three operators: the ones that kernels round in the same way.
const PLAIN: [Join; 3] = [Join::Union, Join::Intersection, Join::Difference];

fn kernels() -> impl Iterator<Item = (u32, BlendKernel)> {
    BlendKernel::ALL.into_iter().enumerate().map(|(i, kernel)| (i as u32, kernel))
}

/// Blend parameters as flattening writes them.
fn blend_params(join: Join, blend: &Blend, [half_width, depth]: [f64; 2]) -> BlendParams {
    let has_width = matches!(join, Join::Pipe | Join::Groove | Join::Tongue);
    BlendParams { support: blend.support(), size: if has_width { half_width } else { blend.steps.into() }, depth }
}

/// Whether the combination exists: grooves and tongues have no steps.
fn applies(join: Join, kernel: BlendKernel) -> bool {
    !(kernel.has_steps() && matches!(join, Join::Groove | Join::Tongue))
}

fn apply(join: Join, a: f64, b: f64, blend: &Blend, kernel: u32) -> BlendResult<f64> {
    op_join(join as u32, a, b, &blend_params(join, blend, [0.2, 0.3]), kernel)
}

fn hard(join: Join, a: f64, b: f64) -> f64 {
    match join {
        Join::Union => a.min(b),
        Join::Intersection => a.max(b),
        Join::Difference => a.max(-b),
        Join::Xor => a.min(b).max(-a.max(b)),
        other => panic!("{other:?} is no operator on sets"),
    }
}

#[test]
fn equal_radii_thicken_equally() {
    for join in PLAIN {
        for (number, kernel) in kernels() {
            for radius in [1e-3, 0.1, 1.0, 50.0] {
                for steps in [1, 2, 5] {
                    let blend = Blend { steps, ..Blend::new(kernel, radius) };
                    for a in [-0.7, 0.0, 2.0] {
                        // Measure the thickening along the diagonal, where the operands are equal; for steps and
                        // columns at their edges and fronts.
                        let places = if kernel.has_steps() { 2 * steps } else { 1 };
                        let change = |i: u32| {
                            let apart = if kernel.has_steps() {
                                blend.support() * (1.0 - f64::from(2 * i + 1) / f64::from(steps)).abs()
                            } else {
                                0.0
                            };
                            let b = if join == Join::Intersection { a - apart } else { a + apart };
                            let b = if join == Join::Difference { -a + apart } else { b };
                            let joined = apply(join, a, b, &blend, number);
                            (joined.value - hard(join, a, b)).abs() + 0.5 * apart
                        };
                        for i in 0..places.div_ceil(2) {
                            let found = change(i);
                            let right = (found - blend.thickening()).abs() < 1e-9 * (radius + a.abs());
                            assert!(right, "{join:?} {kernel:?} {radius} {steps}: {found}, not {}", blend.thickening());
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn beyond_the_support_the_operators_are_hard() {
    let mut random = Random::new(1);
    for join in PLAIN {
        for (number, kernel) in kernels() {
            for radius in [0.0, 1e-6, 0.3, 1e6] {
                let blend = Blend::new(kernel, radius);
                for _ in 0..many(500) {
                    let a = random.range(-2.0, 2.0) * (1.0 + radius);
                    let distance = blend.support() * random.range(1.0 + 1e-9, 3.0) + random.range(1e-9, 1.0);
                    let b = if random.chance(0.5) { a + distance } else { a - distance };
                    let b = if join == Join::Difference { -b } else { b };
                    let joined = apply(join, a, b, &blend, number);
                    assert_eq!(joined.value, hard(join, a, b));
                    assert!(joined.weight == 0.0 || joined.weight == 1.0);
                    assert_eq!(joined.weight == 1.0, joined.value != a);
                }
            }
        }
    }
}

/// Flattening and tapes rely on this.
#[test]
fn far_from_the_second_operand_the_first_is_left_as_it_is() {
    let mut random = Random::new(4);
    for (number, kernel) in kernels() {
        for _ in 0..many(2_000) {
            let blend = Blend { steps: 1 + random.index(5) as u32, ..Blend::new(kernel, random.range(0.0, 2.0)) };
            let a = random.range(-2.0, 2.0);
            let (support, more) = (blend.support(), random.range(1e-9, 1.0));
            for (join, b) in [
                (Join::Xor, a.abs() + support),
                (Join::Groove, 0.2 + support - a),
                (Join::Tongue, a + 0.2 + support),
                (Join::Engrave, 0.3 + 2.0 * support - a),
                (Join::Paint, support),
            ] {
                if !applies(join, kernel) {
                    continue;
                }
                let joined = apply(join, a, b.max(0.0) + more, &blend, number);
                assert_eq!((joined.value, joined.by_a, joined.by_b, joined.weight), (a, 1.0, 0.0, 0.0), "{join:?}");
            }
        }
    }
}

#[test]
fn values_step_safely_and_derivatives_are_right() {
    const H: f64 = 1e-6;
    let mut random = Random::new(2);
    for join in Join::ALL {
        for (number, kernel) in kernels().filter(|(_, kernel)| applies(join, *kernel)) {
            let (mut compared, mut count) = (0, 0);
            for _ in 0..many(10_000) {
                let radius = random.pick(&[0.0, 0.05, 1.0, 20.0]);
                let blend = Blend { steps: 1 + random.index(5) as u32, ..Blend::new(kernel, radius) };
                let (a, b) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
                let step = random.range(0.0, 1.0);
                let (da, db) = (random.range(-step, step), random.range(-step, step));
                let at = |a: f64, b: f64| apply(join, a, b, &blend, number);
                let (from, to) = (at(a, b), at(a + da, b + db));
                let change = (from.value - to.value).abs();
                assert!(change <= da.abs().max(db.abs()) + 1e-12, "{join:?} {kernel:?} {a} {b}");
                assert!((0.0..=1.0).contains(&from.weight));
                assert!(from.by_a.abs() + from.by_b.abs() <= 1.0 + 1e-12);
                let sides = [
                    [at(a + H, b).value - from.value, from.value - at(a - H, b).value],
                    [at(a, b + H).value - from.value, from.value - at(a, b - H).value],
                ];
                count += 1;
                if sides.iter().all(|[ahead, behind]| (ahead - behind).abs() < 1e-3 * H) {
                    compared += 1;
                    for (derivative, [ahead, behind]) in [from.by_a, from.by_b].into_iter().zip(sides) {
                        assert!((derivative - 0.5 * (ahead + behind) / H).abs() < 1e-3, "{join:?} {kernel:?} {a} {b}");
                    }
                }
            }
            assert!(compared * 2 > count, "{join:?} {kernel:?}: {compared}");
        }
    }
}

#[test]
fn blends_only_add_to_unions_and_only_take_from_cuts() {
    let mut random = Random::new(6);
    for join in PLAIN {
        for (number, kernel) in kernels() {
            for _ in 0..many(5_000) {
                let blend = Blend { steps: 1 + random.index(5) as u32, ..Blend::new(kernel, random.range(0.0, 3.0)) };
                let (a, b) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
                let change = apply(join, a, b, &blend, number).value - hard(join, a, b);
                assert!(if join == Join::Union { change <= 1e-12 } else { change >= -1e-12 });
                assert!(change.abs() <= blend.thickening() + 1e-12);
            }
        }
    }
}

#[test]
fn signs_are_what_the_operators_mean() {
    let mut random = Random::new(5);
    let (half_width, depth) = (0.2, 0.3);
    for _ in 0..many(20_000) {
        let (a, b) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        let near = b.abs() < half_width;
        for (join, inside) in [
            (Join::Union, a < 0.0 || b < 0.0),
            (Join::Intersection, a < 0.0 && b < 0.0),
            (Join::Difference, a < 0.0 && b > 0.0),
            (Join::Xor, (a < 0.0) != (b < 0.0)),
            (Join::Pipe, a.hypot(b) < half_width),
            (Join::Groove, a < 0.0 && !(near && a > -depth)),
            (Join::Tongue, a < 0.0 || (near && a < depth)),
            (Join::Engrave, a < 0.0 && a + depth < b.abs()),
            (Join::Morph, (1.0 - depth) * a + depth * b < 0.0),
            (Join::Paint, a < 0.0),
        ] {
            let value = op_join(join as u32, a, b, &blend_params(join, &Blend::HARD, [half_width, depth]), 0).value;
            assert_eq!(value < 0.0, inside, "{join:?} at {a}, {b}: {value}");
        }
    }
}

#[test]
fn a_smooth_blend_is_continuous_with_its_slope_at_the_end_of_its_support_and_in_its_middle() {
    for (number, kernel) in kernels().filter(|(_, kernel)| kernel.is_smooth()) {
        let blend = Blend::new(kernel, 0.5);
        let at = |difference: f64| apply(Join::Union, 0.0, difference, &blend, number);
        assert!(at(blend.support() - 1e-6).value.abs() < 1e-9, "{kernel:?}");
        assert!(at(blend.support() - 1e-6).weight < 1e-4, "{kernel:?}");
        assert!((at(1e-9).weight - 0.5).abs() < 1e-6 && (at(-1e-9).weight - 0.5).abs() < 1e-6, "{kernel:?}");
    }
}

#[test]
fn paint_is_whole_inside_and_fades_over_its_edge() {
    let blend = Blend::new(BlendKernel::Circular, 0.1);
    let share = |b: f64| apply(Join::Paint, 0.7, b, &blend, 0).weight;
    assert_eq!([share(-0.1), share(0.0), share(0.1)], [1.0, 0.5, 0.0]);
    assert!(share(-0.03) > share(0.03));
    let hard = |b: f64| apply(Join::Paint, 0.7, b, &Blend::HARD, 0).weight;
    assert_eq!([hard(-1e-9), hard(1e-9)], [1.0, 0.0]);
}

/// The name in shaders: `SmoothChamfer` becomes `SMOOTH_CHAMFER`.
fn screaming(name: &str) -> String {
    let word = |(i, c): (usize, char)| if i > 0 && c.is_uppercase() { format!("_{c}") } else { c.to_string() };
    name.char_indices().map(word).collect::<String>().to_uppercase()
}

#[test]
fn the_shader_numbers_joins_and_kernels_alike() {
    let shader = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/sdf/op.wgsl")).unwrap();
    for (number, kernel) in kernels() {
        let name = screaming(&format!("{kernel:?}"));
        assert!(shader.contains(&format!("const KERNEL_{name}: u32 = {number}u;")), "{name}");
    }
    for (number, join) in Join::ALL.into_iter().enumerate() {
        assert_eq!(join as usize, number);
        let name = screaming(&format!("{join:?}"));
        assert!(shader.contains(&format!("const JOIN_{name}: u32 = {number}u;")), "{name}");
    }
    let joins: Vec<Join> = Operator::ALL.into_iter().map(Join::of).collect();
    assert_eq!(joins, Join::ALL[1..=joins.len()]);
    // Not one of the artist's operators: a difference with exchanged operands.
    assert_eq!(Join::ALL[joins.len() + 1..], [Join::ReverseDifference]);
}
