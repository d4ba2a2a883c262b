//! The GPU's gradients and materials agree with the CPU evaluator, for every operator, kernel and evaluator. Normals
//! are these gradients, and the weights of blends combine them. Shapes have their own test beside `render::wgsl::dual`.

use glam::{DVec3, Vec3Swizzles as _};
use isolith::field::eval::{MIXED, Mixture, SurfacePoint, surface};
use isolith::field::{Component, FlatScene, flatten};
use isolith::render::probe::{self, ProbedSurface};
use isolith::scene::{
    Blend, BlendKernel, Group, Material, MaterialId, Node, NodeId, NodeKind, Object, Operator, Scene, Shape,
};
use isolith::wgsl::{Evaluator, OpSet, Options, SkipMode, Structure};

use crate::contract::samples::Random;
use crate::gpu::shared;

/// Number of points at random places, and of points on the surface.
const POINTS: usize = 600;
/// Tolerance of gradients and colors.
const TOLERANCE: f64 = 2e-3;
/// Distance from a point, in meters: where the gradient turns by more than [`KINK`] within it, rounding decides.
const NEAR: f64 = 2e-5;
const KINK: f64 = 5e-3;

const COLORS: [[f64; 3]; 4] = [[1.0, 0.1, 0.0], [0.0, 0.9, 0.2], [0.1, 0.0, 0.8], [0.7, 0.7, 0.1]];

/// A box, a ball joined to it, and a group of two joined to both: leaves and groups join by different code.
fn scene(group: Group) -> Scene {
    let mut scene = Scene::new();
    for (i, color) in COLORS.into_iter().enumerate() {
        scene.insert_material(Material::new(MaterialId(i as u64 + 2), "", color)).unwrap();
    }
    let mut add = |parent: Option<NodeId>, node: Node| scene.insert(parent, usize::MAX, node).unwrap();
    let object = |i: u64, shape, at: [f64; 3]| {
        Node::new("", NodeKind::Object(Object { shape, material: MaterialId(i + 2) })).at(at.into())
    };
    let top = add(None, Node::new("Blend", NodeKind::Group(group)));
    add(Some(top), object(0, Shape::Box { size: [0.9, 0.6, 0.8], rounding: 0.05 }, [0.0; 3]));
    add(Some(top), object(1, Shape::Sphere { radius: 0.42 }, [0.1, 0.33, 0.16]));
    let inner = add(Some(top), Node::new("Inner", NodeKind::Group(group)).at([-0.3, 0.05, 0.1].into()));
    add(Some(inner), object(2, Shape::Cylinder { radius: 0.45, height: 0.5, rounding: 0.1 }, [0.2, 0.1, 0.0]));
    add(
        Some(inner),
        object(3, Shape::Capsule { start: [-0.4, -0.3, 0.0], end: [0.3, 0.3, 0.1], radius: 0.2 }, [0.0; 3]),
    );
    scene
}

/// Points where the gradient is smooth: half of them anywhere, the others on the surface.
fn places(flat: &FlatScene, component: &Component, random: &mut Random) -> [Vec<DVec3>; 2] {
    let at = |p: DVec3| surface(flat, component, p);
    let smooth = |p: &DVec3| {
        let here = at(*p);
        DVec3::AXES.iter().flat_map(|axis| [*axis, -*axis]).all(|way| {
            let beside = at(*p + way * NEAR);
            (beside.gradient - here.gradient).length() < KINK && difference(&beside, here.material.base_color) < KINK
        })
    };
    let rounded = |p: DVec3| p.as_vec3().as_dvec3();
    let anywhere = (0..POINTS).map(|_| rounded(random.point(0.9))).filter(smooth).collect();
    let on_surface = |mut p: DVec3| {
        for _ in 0..30 {
            let found = at(p);
            p -= found.gradient * (found.distance / found.gradient.length_squared().max(0.05));
        }
        rounded(p)
    };
    let touches = |p: &DVec3| at(*p).distance.abs() < 1e-6;
    let surface = (0..POINTS).map(|_| on_surface(random.point(0.7))).filter(|p| touches(p) && smooth(p)).collect();
    [anywhere, surface]
}

fn difference(found: &SurfacePoint, albedo: DVec3) -> f64 {
    (found.material.base_color - albedo).length()
}

/// The largest error of any material's weight.
fn weights_apart(found: &Mixture, meant: &Mixture) -> f64 {
    let weight = |of: &Mixture, id: u32| {
        let held = of.ids.iter().zip(of.weights).filter(|(held, _)| **held == id);
        held.map(|(_, weight)| weight).sum::<f64>()
    };
    let ids = found.ids.iter().chain(&meant.ids);
    ids.map(|id| (weight(found, *id) - weight(meant, *id)).abs()).fold(0.0, f64::max)
}

/// The first disagreement between the CPU evaluator and `found`.
fn compare(flat: &FlatScene, component: &Component, points: &[DVec3], found: &[ProbedSurface]) -> Result<(), String> {
    assert_eq!(points.len(), found.len());
    for (p, gpu) in points.iter().zip(found) {
        let cpu = surface(flat, component, *p);
        let apart = (gpu.gradient - cpu.gradient).length();
        // The form of the comparison makes NaN disagree.
        if !(apart < TOLERANCE
            && difference(&cpu, gpu.base_color) < TOLERANCE
            && (gpu.distance - cpu.distance).abs() < 1e-5
            && weights_apart(&gpu.materials, &cpu.materials) < TOLERANCE)
        {
            return Err(format!("at {p} the GPU says {gpu:?}, the CPU {cpu:?}"));
        }
    }
    Ok(())
}

fn groups() -> impl Iterator<Item = (String, Group)> {
    Operator::ALL.into_iter().flat_map(|operator| {
        let kernels = if operator.has_kernel() { BlendKernel::ALL.as_slice() } else { &BlendKernel::ALL[..1] };
        kernels.iter().map(move |&kernel| {
            let blend = Blend { steps: 3, ..Blend::new(kernel, 0.15) };
            let group = Group { width: 0.2, depth: 0.08, share: 0.3, ..Group::new(operator, blend) };
            (format!("{operator:?} {kernel:?}"), group)
        })
    })
}

#[test]
fn gradients_of_every_operator_agree() {
    for (seed, (name, group)) in groups().enumerate() {
        let flat = flatten(&scene(group), 0.0).unwrap();
        let [component] = &flat.components[..] else { panic!("{name}: {} components", flat.components.len()) };
        let [anywhere, on_surface] = places(&flat, component, &mut Random::new(seed as u64));
        assert!(
            anywhere.len() * 2 > POINTS && on_surface.len() * 6 > POINTS,
            "{name}: {} {}",
            anywhere.len(),
            on_surface.len()
        );
        let all = [on_surface.clone(), anywhere].concat();
        let ops = OpSet::of(&flat);
        // Away from surfaces, tapes hold a bound and no gradient.
        for (evaluator, points) in [
            (Evaluator::Interpreter(ops.clone()), &all),
            (Evaluator::Tape(ops), &on_surface),
            (Evaluator::StraightLine(Structure::of(&flat, component).expect("it is small")), &all),
        ] {
            let options = Options { skip_mode: SkipMode::Selects, ..Options::default() };
            let found = probe::surface(&shared().gpu, &flat, 0, points, &evaluator, options).unwrap();
            compare(&flat, component, points, &found).unwrap_or_else(|fault| panic!("{name}, {evaluator:?}: {fault}"));
        }
    }
}

#[test]
fn a_wrong_gradient_is_caught() {
    for (name, group) in groups() {
        let flat = flatten(&scene(group), 0.0).unwrap();
        let component = &flat.components[0];
        let [_, points] = places(&flat, component, &mut Random::new(1));
        let found = |change: &dyn Fn(SurfacePoint) -> ProbedSurface| -> Result<(), String> {
            let values: Vec<_> = points.iter().map(|p| change(surface(&flat, component, *p))).collect();
            compare(&flat, component, &points, &values)
        };
        let right = |s: SurfacePoint| ProbedSurface {
            gradient: s.gradient,
            distance: s.distance,
            materials: s.materials,
            base_color: s.material.base_color,
        };
        assert_eq!(found(&right), Ok(()), "{name}");
        assert!(found(&|s| ProbedSurface { gradient: s.gradient * 1.01, ..right(s) }).is_err(), "{name}");
        assert!(found(&|s| ProbedSurface { gradient: -s.gradient, ..right(s) }).is_err(), "{name}");
        assert!(found(&|s| ProbedSurface { gradient: DVec3::NAN, ..right(s) }).is_err(), "{name}");
        assert!(found(&|s| ProbedSurface { base_color: s.material.base_color.zxy(), ..right(s) }).is_err(), "{name}");
        let other = |m: Mixture| Mixture { ids: m.ids.map(|id| id.wrapping_add(1)), ..m };
        assert!(found(&|s| ProbedSurface { materials: other(s.materials), ..right(s) }).is_err(), "{name}");
        // Hard joins have different gradients inside the blend.
        if group.operator.has_radius() && group.operator != Operator::Paint {
            let hard = flatten(&scene(Group { blend: Blend { radius: 0.02, ..group.blend }, ..group }), 0.0).unwrap();
            let of_hard = |p: &DVec3| ProbedSurface {
                gradient: surface(&hard, &hard.components[0], *p).gradient,
                ..right(surface(&flat, component, *p))
            };
            let values: Vec<_> = points.iter().map(of_hard).collect();
            assert!(compare(&flat, component, &points, &values).is_err(), "{name}");
        }
    }
}

/// Six balls of six materials in one blend: all of them contribute at the center.
fn six() -> Scene {
    let mut scene = Scene::new();
    let blend = Blend::new(BlendKernel::Quadratic, 1.5);
    let top = scene.insert(None, usize::MAX, Node::new("Blend", NodeKind::Group(Group::new(Operator::Union, blend))));
    let top = top.expect("room");
    for i in 0..6 {
        let color = [0, 1, 2].map(|bit| f64::from(u8::from((i + 1) >> bit & 1 == 1)));
        scene.insert_material(Material::new(MaterialId(i + 2), "", color)).expect("room");
        let object = Object { shape: Shape::Sphere { radius: 0.4 }, material: MaterialId(i + 2) };
        let (sine, cosine) = (i as f64).sin_cos();
        let node = Node::new("", NodeKind::Object(object)).at(DVec3::new(0.4 * cosine, 0.4 * sine, 0.05 * i as f64));
        scene.insert(Some(top), usize::MAX, node).expect("room");
    }
    scene
}

/// Tolerance of mixtures where more than four materials meet: rounding decides between nearly equal weights, which two
/// of six are dropped, a third of the total.
const LEFT_OUT: f64 = 0.35;

#[test]
fn of_more_than_four_materials_the_heaviest_are_mixed_by_every_evaluator() {
    let flat = flatten(&six(), 0.0).expect("within the limits");
    let [component] = &flat.components[..] else { panic!("one component") };
    let mut random = Random::new(7);
    let points: Vec<DVec3> = (0..POINTS).map(|_| random.point(0.8).as_vec3().as_dvec3()).collect();
    let meant: Vec<SurfacePoint> = points.iter().map(|p| surface(&flat, component, *p)).collect();
    let crowded = meant.iter().filter(|s| s.materials.weights.iter().sum::<f64>() < 1.0 - 1e-9).count();
    assert!(crowded > POINTS / 10, "hardly a point has more than {MIXED} materials: {crowded}");
    let structure = Structure::of(&flat, component).expect("it is small");
    for (evaluator, exact) in
        [(Evaluator::Interpreter(OpSet::of(&flat)), true), (Evaluator::StraightLine(structure), false)]
    {
        let options = Options { skip_mode: SkipMode::Selects, ..Options::default() };
        let found = probe::surface(&shared().gpu, &flat, 0, &points, &evaluator, options).expect("surfaces");
        let mut close = 0;
        for (gpu, cpu) in found.iter().zip(&meant) {
            assert!((gpu.materials.weights.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{gpu:?}");
            let apart = (gpu.base_color - cpu.material.base_color).abs().max_element();
            assert!(apart < LEFT_OUT, "{evaluator:?}: {gpu:?}, {cpu:?}");
            close += usize::from(apart < TOLERANCE);
        }
        let least = if exact { points.len() * 99 / 100 } else { points.len() / 2 };
        assert!(close >= least, "{evaluator:?}: {close} of {}", points.len());
    }
}
