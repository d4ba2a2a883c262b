//! The GPU's field agrees with the CPU evaluator: for every shape, every operator and random trees, |gpu − cpu| ≤ 1e-4
//! (1 + |d|) at 4 096 points.

mod gradients;
mod lookahead;

use glam::{DQuat, DVec3};
use isolith::field::eval::field;
use isolith::field::{CellTree, FlatScene, PreparedShape, flatten, leaf_payload, tape_field};
use isolith::gallery;
use isolith::render::probe;
use isolith::scene::{
    Blend, BlendKernel, Group, MaterialId, Modifier, ModifierKind, Node, NodeId, NodeKind, Object, Operator, Scene,
    Shape, ShapeKind,
};
use isolith::wgsl::{Evaluator, OpSet, Options, ShapeSet, SkipMode, Structure};

use crate::contract::modifiers::{modified, modified_crowds, samples};
use crate::contract::samples::{Random, ordinary};
use crate::contract::trees::{Recipe, tree};
use crate::gpu::shared;

const POINTS: usize = 4_096;

/// Points that f32 represents exactly, so that both sides get the same input: in a wide cube, in a tight one, on planes
/// of symmetry.
fn points(random: &mut Random, count: usize) -> Vec<DVec3> {
    (0..count)
        .map(|i| {
            let mut p = random.point(if i % 2 == 0 { 4.0 } else { 1.0 });
            if i % 8 == 7 {
                p[random.index(3)] = 0.0;
            }
            p.as_vec3().as_dvec3()
        })
        .collect()
}

/// The first disagreement between the field and `values`.
fn compare(flat: &FlatScene, component: usize, points: &[DVec3], values: &[f32]) -> Result<(), String> {
    assert_eq!(points.len(), values.len());
    for (p, gpu) in points.iter().zip(values) {
        let (gpu, cpu) = (f64::from(*gpu), field(flat, &flat.components[component], *p));
        // The form of the comparison makes NaN disagree.
        let agrees = (gpu - cpu).abs() <= 1e-4 * (1.0 + cpu.abs());
        if !agrees {
            return Err(format!("at {p} the GPU says {gpu}, the CPU {cpu}"));
        }
    }
    Ok(())
}

/// Compares every component of the scene, at 4 096 points in all.
fn agree(what: &str, scene: &Scene, random: &mut Random) {
    agree_with_skip_mode(what, scene, random, SkipMode::Branches);
}

/// Like [`agree`], with the given skip mode of specialized pipelines.
fn agree_with_skip_mode(what: &str, scene: &Scene, random: &mut Random, skip_mode: SkipMode) {
    let options = Options { skip_mode, ..Options::default() };
    let flat = flatten(scene, 0.0).unwrap();
    let share = POINTS.div_ceil(flat.components.len().max(1));
    for (index, component) in flat.components.iter().enumerate() {
        let points = points(random, share);
        let mut evaluators = vec![Evaluator::Interpreter(OpSet::of(&flat))];
        evaluators.extend(Structure::of(&flat, component).map(Evaluator::StraightLine));
        for evaluator in &evaluators {
            let values = probe::field(&shared().gpu, &flat, index, &points, evaluator, options).unwrap();
            compare(&flat, index, &points, &values)
                .unwrap_or_else(|e| panic!("{what}, {evaluator:?}: {e}\n{:?}", flat.params));
        }
    }
}

fn object(shape: Shape) -> Node {
    Node::new("Object", NodeKind::Object(Object { shape, material: MaterialId(1) }))
}

fn add(scene: &mut Scene, parent: Option<NodeId>, node: Node) -> NodeId {
    scene.insert(parent, usize::MAX, node).unwrap()
}

#[test]
fn every_shape_agrees() {
    for &kind in ShapeKind::ALL {
        let mut random = Random::new(kind as u64);
        let mut scene = Scene::new();
        // The default, all zeros, random, and random with zeros; rotated and translated.
        for shape in ordinary(kind, 3) {
            let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, 6.0));
            add(&mut scene, None, object(shape).at(random.point(0.5)).rotated(turn));
        }
        agree(kind.label(), &scene, &mut random);
    }
}

#[test]
fn every_operator_agrees() {
    for operator in Operator::ALL {
        for kernel in BlendKernel::ALL {
            if !operator.has_kernel() && kernel != BlendKernel::Circular {
                continue;
            }
            let mut random = Random::new(kernel as u64);
            let mut scene = Scene::new();
            let radii: &[f64] = if kernel == BlendKernel::Circular { &[0.0, 0.01, 0.2, 3.0] } else { &[0.02, 0.5] };
            for radius in radii.iter().copied() {
                let blend = Blend { steps: 1 + random.index(5) as u32, ..Blend::new(kernel, radius) };
                let group = Group { width: 0.3, depth: 0.1, share: 0.3, ..Group::new(operator, blend) };
                let parent = add(&mut scene, None, Node::new("Group", NodeKind::Group(group)));
                for kind in [ShapeKind::Sphere, ShapeKind::Box, ShapeKind::Capsule] {
                    let node = object(kind.default_shape()).at(random.point(0.4));
                    add(&mut scene, Some(parent), node);
                }
            }
            agree(&format!("{operator:?} {kernel:?}"), &scene, &mut random);
        }
    }
}

#[test]
fn random_trees_agree() {
    for seed in 100..112 {
        let scene = tree(seed, Recipe { blends: true, stretching: seed % 2 == 0, kinds: ShapeKind::ALL });
        agree(&format!("tree {seed}"), &scene, &mut Random::new(seed));
    }
}

/// Thirty shapes joined and fifteen cut away.
fn long_rows(random: &mut Random) -> Scene {
    let mut scene = Scene::new();
    let blend = Blend::new(BlendKernel::Quadratic, 0.1);
    let group = Group::new(Operator::Union, blend);
    let parent = add(&mut scene, None, Node::new("Group", NodeKind::Group(group)));
    for i in 0..45 {
        let kind = random.pick(&[ShapeKind::Sphere, ShapeKind::Box, ShapeKind::Torus]);
        let node = object(kind.default_shape()).at(random.point(2.0)).scaled(DVec3::splat(0.5));
        add(&mut scene, Some(parent), if i < 30 { node } else { node.subtracted() });
    }
    scene
}

/// Runs of operands are skipped correctly in long rows, at every place and in both skip modes.
#[test]
fn runs_agree() {
    for (seed, skip_mode) in [(1, SkipMode::Branches), (2, SkipMode::Selects)] {
        let mut random = Random::new(seed);
        let scene = long_rows(&mut random);
        let flat = flatten(&scene, 0.0).unwrap();
        assert!(flat.nodes.iter().filter(|n| n.is_run()).count() >= 6, "nothing is skipped here");
        assert!(Structure::of(&flat, &flat.components[0]).is_some(), "too large for a pipeline");
        agree_with_skip_mode("runs", &scene, &mut random, skip_mode);
    }
}

/// A template's pipeline serves all its structures: few shapes, and enough shapes for skipping.
#[test]
fn templates_agree() {
    let few = gallery::random(16, 1);
    let mut many = Scene::new();
    let group =
        NodeKind::Group(Group::new(Operator::Union, Blend { steps: 3, ..Blend::new(BlendKernel::Stairs, 0.1) }));
    let parent = add(&mut many, None, Node::new("Group", group));
    for (i, kind) in ShapeKind::ALL.iter().take(6).enumerate() {
        add(&mut many, Some(parent), object(kind.default_shape()).at(DVec3::X * 0.4 * i as f64));
    }
    for (scene, skip_mode) in [(&few, SkipMode::Branches), (&few, SkipMode::Selects), (&many, SkipMode::Selects)] {
        let (flat, mut random) = (flatten(scene, 0.0).unwrap(), Random::new(1));
        let used = flat.nodes.iter().filter(|node| node.is_leaf()).map(|n| ShapeKind::ALL[(n.code & 0xffff) as usize]);
        let used = ShapeSet::of(used);
        for (index, component) in flat.components.iter().enumerate() {
            let template = Structure::template(&flat, component, used).expect("it is small");
            let (points, options) = (points(&mut random, 500), Options { skip_mode, ..Options::default() });
            let evaluator = Evaluator::StraightLine(template);
            let values = probe::field(&shared().gpu, &flat, index, &points, &evaluator, options).unwrap();
            compare(&flat, index, &points, &values).unwrap_or_else(|e| panic!("{skip_mode:?}: {e}"));
        }
    }
}

/// Compares every component that can have tapes with the CPU evaluator of the same tapes. A point near the border of
/// two cells may fall into either.
#[test]
fn tapes_agree() {
    const NEAR: f64 = 1e-5;
    let mut crowds = vec![gallery::crowd(60, true, 3), gallery::crowd(200, true, 4), gallery::boxes(40, 5)];
    crowds.extend(modified_crowds());
    for (scene, seed) in crowds.iter().zip(1..) {
        let flat = flatten(scene, 0.0).unwrap();
        let tree = CellTree::build(&flat, &flat.components[0]);
        let points = points(&mut Random::new(seed), POINTS);
        let mut ops = OpSet::of(&flat);
        if flat.components[0].is_modified() {
            // Compile one pipeline for all of them.
            ops = OpSet { modifiers: OpSet::all().modifiers, stack: 4, ..ops };
        }
        let evaluator = Evaluator::Tape(ops);
        for skip_mode in [SkipMode::Branches, SkipMode::Selects] {
            let options = Options { skip_mode, ..Options::default() };
            let values = probe::field(&shared().gpu, &flat, 0, &points, &evaluator, options).unwrap();
            for (p, gpu) in points.iter().zip(values) {
                let around = [DVec3::ZERO, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
                let cpu = around.map(|d| tape_field(&flat, &flat.components[0], &tree, *p + d * NEAR));
                let reference = field(&flat, &flat.components[0], *p);
                let is_same = |gpu: f64, cpu: f64| (gpu - cpu).abs() <= 1e-4 * (1.0 + cpu.abs());
                // The GPU skips copies by their bounds, which may give a larger value than cells without a tape.
                let is_between = |gpu: f64, cpu: f64| cpu <= gpu && gpu <= reference;
                let agrees = |cpu: &f64| is_same(gpu.into(), *cpu) || is_between(gpu.into(), *cpu);
                assert!(cpu.iter().any(agrees), "crowd {seed}: at {p} the GPU says {gpu}, the CPU {cpu:?}");
            }
        }
    }
}

#[test]
fn a_disagreement_is_caught() {
    let mut scene = Scene::new();
    add(&mut scene, None, object(ShapeKind::Torus.default_shape()));
    let flat = flatten(&scene, 0.0).unwrap();
    let points = points(&mut Random::new(1), 64);
    let values = |change: &dyn Fn(f64) -> f64| -> Vec<f32> {
        points.iter().map(|p| change(field(&flat, &flat.components[0], *p)) as f32).collect()
    };
    assert_eq!(compare(&flat, 0, &points, &values(&|f| f)), Ok(()));
    assert!(compare(&flat, 0, &points, &values(&|f| f + 1e-3)).is_err());
    assert!(compare(&flat, 0, &points, &values(&|f| f * 1.001)).is_err());
    assert!(compare(&flat, 0, &points, &values(&|f| -f)).is_err());
    assert!(compare(&flat, 0, &points, &values(&|_| f64::NAN)).is_err());
}

/// Every modifier, alone and on top of another, over asymmetric content.
#[test]
fn every_modifier_agrees() {
    for &kind in ModifierKind::ALL {
        let mut random = Random::new(kind as u64);
        for (i, modifier) in samples(kind, 2).into_iter().enumerate() {
            let other = if i == 0 { Modifier::Bend { angle: 30.0 } } else { Modifier::Round { radius: 0.02 } };
            for modifiers in [vec![modifier.clone()], vec![modifier, other]] {
                if flatten(&modified(&modifiers), 0.0).is_ok() {
                    agree(&format!("{modifiers:?}"), &modified(&modifiers), &mut random);
                }
            }
        }
    }
}

/// Shapes with a payload, in blends that use all its values, below modifiers and below two levels of copies.
#[test]
fn data_are_found_below_blends_and_modifiers() {
    let mut scene = Scene::new();
    let blend = Blend { steps: 3, ..Blend::new(BlendKernel::Stairs, 0.2) };
    let group = |operator| {
        let group = Group { width: 0.1, depth: 0.05, ..Group::new(operator, blend) };
        Node::new("Group", NodeKind::Group(group))
    };
    let twisted = group(Operator::Groove).modified(ModifierKind::Twist.default_modifier());
    let mirrored = group(Operator::Union).modified(ModifierKind::Mirror.default_modifier());
    let top = add(&mut scene, None, group(Operator::Union));
    let parents = [top, add(&mut scene, Some(top), twisted.at(DVec3::X)), add(&mut scene, Some(top), mirrored)];
    let kinds: Vec<ShapeKind> = ShapeKind::ALL.iter().copied().filter(|kind| kind.has_data()).collect();
    let mut random = Random::new(8);
    for (i, kind) in kinds.iter().chain([&ShapeKind::Box, &ShapeKind::Tube]).enumerate() {
        let node = object(kind.default_shape()).at(random.point(0.6)).scaled(DVec3::splat(0.5));
        add(&mut scene, Some(parents[i % 3]), node);
    }
    let flat = flatten(&scene, 0.0).unwrap();
    let mut rows = 0;
    for node in flat.nodes.iter().filter(|node| node.is_leaf()) {
        let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
        let data = PreparedShape::new(&kind.default_shape()).payload;
        let found = leaf_payload(kind, &flat.params[node.params as usize..]);
        assert_eq!(found, data.iter().map(|row| row.map(|v| v as f32)).collect::<Vec<_>>(), "{kind:?}");
        rows += data.len();
    }
    let [component] = &flat.components[..] else { panic!("one component") };
    assert!(component.is_modified() && rows == component.payload_rows as usize);
    let structure = Structure::of(&flat, component).unwrap();
    assert_eq!(structure.rows(), (component.param_rows - component.payload_rows) as usize);
    agree("data", &scene, &mut random);
}
