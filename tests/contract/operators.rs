//! Every operator with every kernel.

use isolith::flat::Join;
use isolith::flat::twin::{op_difference, op_intersection, op_join, op_union};
use isolith::scene::{Blend, BlendKernel, Operator};

use super::samples::Random;

fn kernels() -> impl Iterator<Item = (u32, BlendKernel)> {
    BlendKernel::ALL.into_iter().enumerate().map(|(i, kernel)| (i as u32, kernel))
}

/// The operator, with b's sign turned so that all of them look alike: the result has the sign of a.
fn apply(operator: Operator, a: f64, b: f64, support: f64, kernel: u32) -> (f64, f64) {
    let joined = match operator {
        Operator::Union => op_union(a, b, support, kernel),
        Operator::Intersection => op_intersection(a, b, support, kernel),
        Operator::Difference => op_difference(a, b, support, kernel),
    };
    (joined.value, joined.weight)
}

fn hard(operator: Operator, a: f64, b: f64) -> f64 {
    match operator {
        Operator::Union => a.min(b),
        Operator::Intersection => a.max(b),
        Operator::Difference => a.max(-b),
    }
}

#[test]
fn equal_radii_thicken_equally() {
    for operator in Operator::ALL {
        for (number, kernel) in kernels() {
            for radius in [1e-3, 0.1, 1.0, 50.0] {
                let blend = Blend { kernel, radius };
                for a in [-0.7, 0.0, 2.0] {
                    let b = if operator == Operator::Difference { -a } else { a };
                    let (value, weight) = apply(operator, a, b, blend.support(), number);
                    let change = (value - hard(operator, a, b)).abs();
                    assert!((change - blend.thickening()).abs() < 1e-9 * radius, "{operator:?} {kernel:?} {radius}");
                    assert_eq!(weight, 0.5);
                }
            }
        }
    }
}

#[test]
fn beyond_the_support_the_operators_are_hard() {
    let mut random = Random::new(1);
    for operator in Operator::ALL {
        for (number, kernel) in kernels() {
            for radius in [0.0, 1e-6, 0.3, 1e6] {
                let support = Blend { kernel, radius }.support();
                for _ in 0..500 {
                    let a = random.range(-2.0, 2.0) * (1.0 + radius);
                    let distance = support * random.range(1.0 + 1e-9, 3.0) + random.range(1e-9, 1.0);
                    let b = if random.chance(0.5) { a + distance } else { a - distance };
                    let b = if operator == Operator::Difference { -b } else { b };
                    let (value, weight) = apply(operator, a, b, support, number);
                    assert_eq!(value, hard(operator, a, b));
                    assert!(weight == 0.0 || weight == 1.0);
                    assert_eq!(weight == 1.0, value != a);
                }
            }
        }
    }
}

#[test]
fn values_step_safely_and_weights_are_shares() {
    let mut random = Random::new(2);
    for operator in Operator::ALL {
        for (number, kernel) in kernels() {
            for _ in 0..20_000 {
                let radius = random.pick(&[0.0, 0.05, 1.0, 20.0]);
                let support = Blend { kernel, radius }.support();
                let (a, b) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
                let step = random.range(0.0, 1.0);
                let (da, db) = (random.range(-step, step), random.range(-step, step));
                let (from, weight) = apply(operator, a, b, support, number);
                let (to, _) = apply(operator, a + da, b + db, support, number);
                assert!((from - to).abs() <= da.abs().max(db.abs()) + 1e-12, "{operator:?} {kernel:?} {a} {b}");
                assert!((0.0..=1.0).contains(&weight));
                // A blend only ever adds to a union and only ever takes from the others.
                let change = from - hard(operator, a, b);
                assert!(if operator == Operator::Union { change <= 0.0 } else { change >= 0.0 });
                assert!(change.abs() <= Blend { kernel, radius }.thickening() + 1e-12);
            }
        }
    }
}

#[test]
fn a_blend_is_continuous_with_its_slope_at_the_end_of_its_support() {
    for (number, kernel) in kernels() {
        let support = Blend { kernel, radius: 0.5 }.support();
        let at = |difference: f64| op_union(0.0, difference, support, number);
        assert!(at(support - 1e-6).value.abs() < 1e-9, "{kernel:?}");
        assert!(at(support - 1e-6).weight < 1e-4, "{kernel:?}");
    }
}

#[test]
fn a_join_is_the_operator_of_its_number() {
    let mut random = Random::new(3);
    for _ in 0..100 {
        let (a, b) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        for (number, _) in kernels() {
            let join = |join: Join| op_join(join as u32, a, b, 0.4, number);
            assert_eq!(join(Join::First).value, b);
            assert_eq!(join(Join::Union), op_union(a, b, 0.4, number));
            assert_eq!(join(Join::Intersection), op_intersection(a, b, 0.4, number));
            assert_eq!(join(Join::Difference), op_difference(a, b, 0.4, number));
        }
    }
}

#[test]
fn the_shader_numbers_joins_and_kernels_alike() {
    let shader = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/sdf/op.wgsl")).unwrap();
    for (number, kernel) in kernels() {
        let name = format!("{kernel:?}").to_uppercase();
        assert!(shader.contains(&format!("const KERNEL_{name}: u32 = {number}u;")), "{name}");
    }
}
