//! Tests: dual functions are valid, and return the original's value and a gradient that agrees with central
//! differences.

mod evaluate;

use super::{DUAL_PRELUDE, DualError, dual};
use crate::params::built;
use crate::random::Random;
use crate::{Evaluator, OpSet, Options, assemble, assemble_plain};
pub(crate) use evaluate::Machine;
use isolith_field::PreparedShape;
use isolith_field::eval::shape_distance;
use isolith_scene::{Limits, ParamValue, Shape, ShapeKind};

const DETACH: &str = include_str!("../../../shaders/sdf/detach.wgsl");

/// Every shape without payload.
fn shapes() -> impl Iterator<Item = (ShapeKind, &'static str)> {
    let named = |kind: &ShapeKind| (*kind, kind.function().strip_prefix("sdf_").unwrap());
    let without_data = ShapeKind::ALL.iter().filter(|kind| !kind.has_data());
    without_data.map(named)
}

/// The function of a shape and its dual function as `shape` and `dual_shape`, which take the parameters as two rows.
/// `payload` is the source of what it reads of its payload.
fn shape_machine(kind: ShapeKind, payload: &str) -> Machine {
    let function = kind.function();
    let library = assemble_plain(&format!("sdf/{}.wgsl", function.strip_prefix("sdf_").unwrap())).unwrap();
    let source = format!("{library}{payload}");
    let derived = dual(&source, function).unwrap_or_else(|e| panic!("{function}: {e}"));
    let params = built(&kind.eval_layout(), &|row| ["a", "b"][row].to_owned());
    let data = if kind.has_data() { ", 0u" } else { "" };
    Machine::new(&format!(
        "{source}{DUAL_PRELUDE}{derived}
        fn shape(p: vec3f, a: vec4f, b: vec4f) -> f32 {{ return {function}(p{params}{data}); }}
        fn dual_shape(p: vec3f, a: vec4f, b: vec4f) -> vec4f {{ return dual_{function}(p{params}{data}); }}"
    ))
}

/// Parameters of a shape, packed: lengths between 0.1 and 1.1, all angles and numbers of sides.
fn parameters(kind: ShapeKind, random: &mut Random) -> [f64; 8] {
    let mut shape = kind.default_shape();
    for (i, value) in shape.values().into_iter().enumerate() {
        let Limits { soft: [low, high], unit, .. } = kind.params()[i].limits;
        let mut number = || if unit == "m" { 0.1 + random.next() } else { low + (high - low) * random.next() };
        let value = match value {
            ParamValue::Scalar(_) => ParamValue::Scalar(number()),
            ParamValue::Vector(_) => ParamValue::Vector([number(), number(), number()].into()),
            _ => panic!("{kind:?} has data"),
        };
        assert!(shape.set_value(i, value));
    }
    shape.packed()
}

/// The source, the prelude and the dual function.
fn machine(source: &str, function: &str) -> Machine {
    let derived = dual(source, function).unwrap_or_else(|e| panic!("{function}: {e}"));
    Machine::new(&format!("{source}{DUAL_PRELUDE}{derived}"))
}

/// Central differences, or `None` at a kink, where both sides disagree.
fn differences(machine: &Machine, function: &str, p: [f64; 3], a: &[f64], b: &[f64]) -> Option<[f64; 3]> {
    const H: f64 = 1e-5;
    let value = |p: [f64; 3]| machine.call(function, &[&p, a, b])[0];
    let mut gradient = [0.0; 3];
    for i in 0..3 {
        let (mut less, mut more) = (p, p);
        less[i] -= H;
        more[i] += H;
        let (below, at, above) = (value(less), value(p), value(more));
        if (above - 2.0 * at + below).abs() / H > 1e-2 {
            return None;
        }
        gradient[i] = (above - below) / (2.0 * H);
    }
    Some(gradient)
}

/// The largest difference between the dual function's gradient and central differences, over random points.
fn worst(source: &str, function: &str, tries: usize) -> f64 {
    let machine = machine(source, function);
    worst_with(&machine, function, tries, |random| std::array::from_fn(|_| 0.1 + random.next()))
}

/// Like `worst`, with parameters made from random numbers.
fn worst_with(machine: &Machine, function: &str, tries: usize, parameters: impl Fn(&mut Random) -> [f64; 8]) -> f64 {
    let mut random = Random(7);
    let (mut worst, mut compared): (f64, _) = (0.0, 0);
    for _ in 0..tries {
        let params = parameters(&mut random);
        let (a, b) = params.split_at(4);
        let p = random.point(1.5);
        let derived = machine.call(&format!("dual_{function}"), &[&p, a, b]);
        assert_eq!(derived[3], machine.call(function, &[&p, a, b])[0], "{function} at {p:?}, {params:?}");
        let Some(gradient) = differences(machine, function, p, a, b) else { continue };
        compared += 1;
        for i in 0..3 {
            worst = worst.max((derived[i] - gradient[i]).abs() / gradient[i].abs().max(1.0));
        }
    }
    assert!(compared * 10 > tries * 7, "{function}: only {compared} points are smooth");
    worst
}

#[test]
fn gradients_of_shapes_are_those_of_central_differences() {
    for (kind, name) in shapes() {
        let error = worst_with(&shape_machine(kind, ""), "shape", 300, |random| parameters(kind, random));
        // Fractals have curvature at every scale.
        assert!(
            error < if matches!(name, "ellipsoid" | "julia" | "kleinian" | "mandelbulb") { 1e-3 } else { 1e-6 },
            "{name}: {error:e}"
        );
    }
}

/// A shape with its payload.
fn with_data(body: &PreparedShape) -> Machine {
    let rows: Vec<String> =
        body.payload.iter().map(|r| format!("vec4f({:?}, {:?}, {:?}, {:?})", r[0], r[1], r[2], r[3])).collect();
    let (count, rows) = (rows.len(), rows.join(", "));
    let payload =
        format!("fn scene_row(at: u32) -> vec4f {{ var rows = array<vec4f, {count}>({rows}); return rows[at]; }}\n");
    shape_machine(body.kind, &payload)
}

#[test]
fn gradients_of_shapes_with_data_are_those_of_central_differences() {
    // The gradient of models is written by hand.
    for &kind in ShapeKind::ALL.iter().filter(|kind| kind.has_data() && **kind != ShapeKind::MeshField) {
        let name = kind.function().strip_prefix("sdf_").unwrap();
        let mut shape: Shape = kind.default_shape();
        if matches!(kind, ShapeKind::Extrusion | ShapeKind::Revolution) {
            assert!(shape.set_value(1, ParamValue::Flag(true)));
        }
        let body = PreparedShape::new(&shape);
        let machine = with_data(&body);
        let (a, b) = body.parameters.split_at(4);
        let mut random = Random(5);
        let mut compared = 0;
        for _ in 0..60 {
            let p = random.point(0.8);
            let derived = machine.call("dual_shape", &[&p, a, b]);
            let reference = shape_distance(body.kind, p, &body.parameters, &body);
            assert!((derived[3] - reference).abs() < 1e-5, "{name} at {p:?}: {derived:?}, {reference}");
            let Some(gradient) = differences(&machine, "shape", p, a, b) else { continue };
            compared += 1;
            assert!(
                distance([derived[0], derived[1], derived[2]], gradient) < 1e-3,
                "{name} at {p:?}: {derived:?} {gradient:?}"
            );
        }
        assert!(compared > 30, "{name}: {compared}");
    }
}

#[test]
fn all_dual_functions_stand_in_one_shader() {
    let everything = Evaluator::Interpreter(OpSet::all());
    let text = assemble("surface.wgsl", &everything, Options::default()).unwrap();
    for &kind in ShapeKind::ALL {
        let data = if kind.has_data() { ", data: u32" } else { "" };
        let layout = kind.eval_layout();
        let params = if layout.members.is_empty() { String::new() } else { format!(", q: {}", layout.name) };
        let signature = format!("fn dual_{}(p: vec3f{params}{data}) -> vec4f {{", kind.function());
        assert_eq!(text.matches(&signature).count(), 1, "{kind:?}");
    }
}

/// The gradient's direction, or zero if there is none.
fn direction(derived: &[f64]) -> [f64; 3] {
    let size = derived[..3].iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-30);
    std::array::from_fn(|i| derived[i] / size)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn normals_at_surfaces_are_right_in_f32() {
    for (kind, name) in shapes() {
        use ShapeKind::{Julia, Kleinian, Mandelbulb, MengerSponge};
        if matches!(kind, MengerSponge | Julia | Kleinian | Mandelbulb) {
            // Fractals have edges everywhere, and their fields do not lead to the surface in a few steps.
            continue;
        }
        let derived = "dual_shape";
        let [exact, rounded] = [shape_machine(kind, ""), shape_machine(kind, "").rounded()];
        let mut random = Random(3);
        let mut compared = 0;
        for _ in 0..200 {
            let params = parameters(kind, &mut random).map(|v| f64::from(v as f32));
            let (a, b) = params.split_at(4);
            let mut p = random.point(1.0);
            for _ in 0..8 {
                let d = exact.call(derived, &[&p, a, b]);
                p = std::array::from_fn(|i| p[i] - d[3] * direction(&d)[i]);
            }
            // The reference is the direction slightly outside. If it changes within a little more, there is an edge.
            let normal = direction(&exact.call(derived, &[&p, a, b]));
            let beside = |i: usize, by: f64| {
                let mut q: [f64; 3] = std::array::from_fn(|i| p[i] + 1e-5 * normal[i]);
                q[i] += by;
                direction(&exact.call(derived, &[&q, a, b]))
            };
            let reference = beside(0, 0.0);
            if exact.call(derived, &[&p, a, b])[3].abs() > 1e-7
                || (0..3).any(|i| distance(beside(i, 1e-3), reference) + distance(beside(i, -1e-3), reference) > 0.1)
            {
                continue;
            }
            compared += 1;
            let error =
                distance(direction(&rounded.call(derived, &[&p.map(|v| f64::from(v as f32)), a, b])), reference);
            assert!(error < 2e-5, "{name} at {p:?}, {params:?}: {error:e}");
        }
        assert!(compared > 20, "{name}: only {compared} points compared");
    }
}

#[test]
fn a_face_has_a_normal_where_the_distance_is_exactly_zero() {
    let zero = [0.0; 4];
    for (name, p, a, normal) in [
        ("box", [0.5, 0.2, 0.1], [1.0, 1.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ("box_frame", [0.45, -0.5, 0.1], [1.0, 1.0, 1.0, 0.125], [0.0, -1.0, 0.0]),
        // The inner side of a bar.
        ("box_frame", [0.375, 0.4375, 0.1], [1.0, 1.0, 1.0, 0.125], [-1.0, 0.0, 0.0]),
        ("cylinder", [0.0, 0.5, 0.25], [0.5, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("cylinder", [0.0, 0.25, -0.5], [0.5, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ("capped_cone", [0.5, 0.25, 0.0], [0.5, 0.5, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ("capped_cone", [0.0, -0.5, 0.0], [0.5, 0.25, 1.0, 0.0], [0.0, -1.0, 0.0]),
        ("hexagonal_prism", [0.5, 0.1, 0.0], [0.5, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ("hexagonal_prism", [0.1, 0.5, 0.1], [0.5, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("plane", [3.0, 0.0, 1.0], zero, [0.0, 1.0, 0.0]),
    ] {
        let (kind, _) = shapes().find(|(_, n)| *n == name).unwrap();
        let derived = shape_machine(kind, "").call("dual_shape", &[&p, &a, &zero]);
        assert_eq!(derived[3], 0.0, "{name}");
        assert!(distance(direction(&derived), normal) < 1e-7, "{name} at {p:?}: {derived:?}");
    }
}

#[test]
fn every_rule_agrees_with_central_differences() {
    // `u` and `v` are vectors that depend on the point, between 0.1 and 0.9; `c` is constant.
    for expression in [
        "u.x + u.y - u.z * 2.0 / v.x",
        "dot(u / v, v) + (1.0 / u.y) - -u.z",
        "u.x % 0.3 + 2.0 % v.y",
        "length(abs(u - 0.5)) + abs(v.x - 0.4)",
        "dot(sign(u - 0.5) + floor(4.0 * u) + ceil(4.0 * v) + round(3.0 * u) + trunc(3.0 * v) + fract(3.0 * u), v)",
        "min(u.x, v.x) + max(u.y, 0.5) + length(max(u, v)) + min(0.4, u.z)",
        "dot(clamp(u, vec3f(0.2), v), u) + clamp(u.x, 0.3, 0.6) + clamp(0.5, u.y, v.y) + saturate(2.0 * u.z)",
        "length(mix(u, v, c.x)) + length(mix(u, v, vec3f(u.z, 0.5, v.z))) + mix(u.x, 0.3, v.x)",
        "step(0.5, u.x) * u.y + smoothstep(0.1, 0.8, u.x) + smoothstep(u.y - 1.0, v.y + 1.0, u.z)",
        "distance(u, 2.0 * v) + distance(u.x, v.y) + dot(u, u) + length(u.x - 0.5)",
        "dot(cross(u, v), c) + dot(normalize(u), v) + dot(cross(c, u), v)",
        "sqrt(u.x) + inverseSqrt(u.y) + pow(u.x, 1.7) + pow(2.0, v.y) + pow(u.z, v.z) + length(pow(u, c))",
        "exp(u.x) + exp2(u.y) + log(u.z) + log2(v.x) + length(exp(v))",
        "sin(3.0 * u.x) + cos(u.y) + tan(u.z) + asin(v.x) + acos(v.y) + atan(v.z) + atan2(u.x - 0.5, v.y - 0.5)",
        "dot(sqrt(u) + inverseSqrt(v) + exp2(u) + log(u) + log2(v) + sin(u) + cos(v) + tan(u) + sinh(u) + tanh(v), c)",
        "dot(asin(u) + acos(v) + atan(u) + atan2(u, v) + pow(v, u) + cosh(u) + abs(v) + saturate(u) + exp(c * u), v)",
        "length(clamp(u, c, v)) + length(smoothstep(c - 1.0, c + 1.0, u)) + dot(min(u, c) % (v + 0.1), fma(u, v, c))",
        "sinh(u.x) + cosh(u.y) + tanh(u.z) + radians(u.x) + degrees(v.x)",
        "fma(u.x, v.y, u.z) + f32(i32(3.0 * u.x)) * u.y + f32(u.z)",
        "select(u.x, v.y, u.y < 0.5) + length(select(u, v, u < vec3f(0.5)))",
        "select(1.0, u.z, any(u > v) && all(u > c)) * u.x",
        "dot(mat3x3f(c, c.zxy, c.yzx) * u, v * mat3x3f(c, c.zxy, c.yzx)) + (mat2x2f(u.xy, v.xy) * v.yz).x",
        "(transpose(mat2x2f(u.x, u.y, 1.0, v.z)) * 2.0)[1].x + vec4f(u.xy, v.zy).w + vec3f(u.x).y + u.zyx[1]",
        "array<f32, 3>(u.x, 2.0, v.y)[2] + Pair(3, u).at.y",
    ] {
        let source = format!(
            "struct Pair {{ count: i32, at: vec3f }}
            fn f(p: vec3f, a: vec4f, b: vec4f) -> f32 {{
                let u = 0.5 + p * vec3f(0.2, -0.25, 0.23);
                let v = 0.5 + 0.24 * vec3f(p.y, p.x, -p.z);
                let c = a.xyz;
                return {expression};
            }}"
        );
        let error = worst(&source, "f", 60);
        assert!(error < 1e-6, "{expression}: {error:e}");
    }
}

#[test]
fn statements_keep_their_order_and_called_functions_get_dual_functions() {
    let source = "
        const COUNT: i32 = 3;
        const SCALE = vec3f(1.0, -0.7, 0.5);
        fn f_wave(q: vec3f, s: f32, k: i32) -> vec2f {
            switch k {
                case 0: { return vec2f(sin(q.x), s); }
                case 1, 2: { if q.y > 10.0 { break; } return q.yz * s; }
                default: { }
            }
            return vec2f(1.0, s * s);
        }
        fn f_count(q: vec3f) -> i32 { return i32(abs(q.x) * 2.0); }
        fn f_outer(s: f32, q: vec4f) -> f32 { return f_wave(q.xyz, 0.3, 1).x + s * q.w; }
        fn f(p: vec3f, a: vec4f, b: vec4f) -> f32 {
            var sum = 0.1;
            var q = p * SCALE;
            for (var i = 0; i < COUNT; i++) {
                if i == 1 { q.y = q.y + sum; continue; }
                let wave = f_wave(q, sum, i);
                sum += wave.x;
                q[i] *= 1.0 + wave.y;
                q = q.yzx;
            }
            var k = 0;
            while k < f_count(p) { k += 1; sum += q.x * 0.1; if k > 2 { break; } }
            var left = 3.0;
            loop {
                var fresh: vec3f;
                fresh.x += sum;
                sum = sum * 0.5 + fresh.x * fresh.y + sin(fresh.x);
                continuing { left -= 1.0; break if left < 0.5; }
            }
            var spots: array<vec2f, 2>;
            spots[1].y = q.z;
            spots[k & 1] += p.xy;
            let passive = f_wave(a.xyz, b.x, 2);
            { q = vec3f(a.x); q.z = p.z; }
            let count = f_count(q);
            return sum + dot(spots[1], passive) + f_outer(a.x, vec4f(q, p.x)) + f_outer(q.z, a) * f32(count);
        }";
    let error = worst(source, "f", 200);
    assert!(error < 1e-6, "{error:e}");
    let derived = dual(source, "f").unwrap();
    assert_eq!(derived.matches("fn dual_f_wave(q: DualVec3, s: DualF32, k: i32) -> DualVec2").count(), 1);
    assert!(!derived.contains("dual_f_count"));
}

#[test]
fn what_is_detached_or_only_compared_carries_no_tangents() {
    let source = format!(
        "{DETACH}
        fn f_far(q: vec3f) -> f32 {{ return sqrt(length(q)); }}
        fn f(p: vec3f, a: vec4f, b: vec4f) -> f32 {{
            let t = detach_f32(sin(p.x) + f_far(p));
            if f_far(p * p) > 1.0 {{ return p.y * t; }}
            return length(detach_vec3(p)) * p.z;
        }}"
    );
    let derived = dual(&source, "f").unwrap();
    assert!(!derived.contains("cos(") && !derived.contains("dual_f_far") && !derived.contains("dot("), "{derived}");
    let machine = machine(&source, "f");
    assert_eq!(machine.call("dual_f", &[&[0.0, 0.0, 0.5], &[0.0; 4], &[0.0; 4]]), [0.0, 0.0, 0.5, 0.25]);
}

#[test]
fn tangents_are_finite_at_singular_points() {
    let source = "fn f(p: vec3f, a: vec4f, b: vec4f) -> f32 {
        return length(p) + distance(p, vec3f(0.0)) + sqrt(p.x) + pow(p.y, 0.5) + atan2(p.x, p.z) + asin(1.0 + p.x)
            + acos(1.0 + p.x) + abs(p.x) + f_root(p.z);
    }
    fn f_root(x: f32) -> f32 { return sqrt(x * x); }";
    let machine = machine(source, "f").rounded();
    let derived = machine.call("dual_f", &[&[0.0; 3], &[0.0; 4], &[0.0; 4]]);
    assert!(derived.iter().all(|v| v.is_finite()), "{derived:?}");
}

#[test]
fn what_has_no_rule_is_refused_by_name() {
    let of = |body: &str| format!("fn f(p: vec3f, a: vec4f, b: vec4f) -> f32 {{ {body} }}");
    let private = format!("var<private> g: f32; {}", of("return p.x;"));
    let pointer = format!("fn h(x: ptr<function, f32>) -> f32 {{ return *x; }} {}", of("var x = p.x; return h(&x);"));
    for (source, construct) in [
        (of("return reflect(p, a.xyz).x;"), "Reflect"),
        (of("return modf(p.x).fract;"), "Modf"),
        (of("return bitcast<f32>(bitcast<u32>(p.x));"), "bitcast"),
        (of("return unpack4x8unorm(pack4x8unorm(p.xyxy)).x;"), "packed"),
        (of("return dpdx(p.x) + a.x;"), "Derivative"),
        (of("return determinant(mat2x2f(p.xy, a.xy));"), "Determinant"),
        (private, "global"),
        (pointer, "pointers"),
        ("fn f(p: vec2f) -> f32 { return p.x; }".to_owned(), "vec3f"),
        ("fn f(p: vec3f, _a: f32) -> f32 { return p.x; }".to_owned(), "_a"),
        ("fn max(a: f32) -> f32 { return a; } fn f(p: vec3f) -> f32 { return max(p.x); }".to_owned(), "max"),
        (
            "fn h(m: mat2x2f) -> f32 { return m[0].x; } fn f(p: vec3f) -> f32 { return h(mat2x2f(p.xy, p.yz)); }"
                .to_owned(),
            "mat2x2f",
        ),
    ] {
        match dual(&source, "f") {
            Err(DualError::Unsupported { construct: found, .. }) => assert!(found.contains(construct), "{found}"),
            other => panic!("{source}: {other:?}"),
        }
    }
    assert!(matches!(dual(&of("return p.x;"), "g"), Err(DualError::NoFunction(_))));
    assert!(matches!(dual("fn f(", "f"), Err(DualError::Source(_))));
    assert!(matches!(dual(&of("return p;"), "f"), Err(DualError::Source(_))));
}
