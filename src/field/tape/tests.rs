//! Tests of the tapes against the CPU evaluator, which skips nothing.

mod modified;

use std::sync::Arc;
use std::time::Duration;

use glam::{DQuat, DVec3};

use super::*;
use crate::{Component, FlatNode, FlatScene, Join, eval, flatten};
use isolith_scene::{
    Blend, BlendKernel, Group, Material, MaterialId, Node, NodeId, NodeKind, Object, Operation, Operator, Scene, Shape,
    ShapeKind,
};

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    fn once_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        DVec3::new(self.between(low.x, high.x), self.between(low.y, high.y), self.between(low.z, high.z))
    }

    fn shape(&mut self) -> Shape {
        ShapeKind::ALL[self.below(ShapeKind::ALL.len())].default_shape()
    }

    /// A half space or another infinite shape would leave nothing bounded, or nothing.
    fn bounded_shape(&mut self) -> Shape {
        let shape = self.shape();
        if shape.bounds().is_finite() { shape } else { Shape::Sphere { radius: 0.6 } }
    }

    fn kernel(&mut self) -> BlendKernel {
        BlendKernel::ALL[self.below(BlendKernel::ALL.len())]
    }

    fn group(&mut self, most_radius: f64) -> NodeKind {
        let operator = if self.once_in(2) { Operator::Union } else { Operator::ALL[self.below(Operator::ALL.len())] };
        let radius = if self.once_in(3) { 0.0 } else { self.between(0.0, most_radius) };
        let blend = Blend { steps: 1 + self.below(5) as u32, ..Blend::new(self.kernel(), radius) };
        let (width, depth, share) = (self.between(0.0, 0.3), self.between(0.0, 0.2), self.between(0.0, 1.0));
        NodeKind::Group(Group { width, depth, share, ..Group::new(operator, blend) })
    }
}

const MATERIAL: MaterialId = MaterialId(1);

fn empty_scene() -> Scene {
    let mut scene = Scene::new();
    if scene.material(MATERIAL).is_none() {
        scene.insert_material(Material::new(MATERIAL, "Gray", [0.5; 3])).unwrap();
    }
    scene
}

fn add(scene: &mut Scene, parent: Option<NodeId>, node: Node) -> NodeId {
    scene.insert(parent, usize::MAX, node).unwrap()
}

fn object(shape: Shape) -> Node {
    Node::new("", NodeKind::Object(Object { shape, material: MATERIAL }))
}

/// One component of nested groups with every operator, kernel and shape, cut, scaled and turned leaves,
/// and rows long enough for runs.
fn random_tree(seed: u64, count: usize) -> Scene {
    let random = &mut Random(seed);
    let mut scene = empty_scene();
    let blend = Blend::new(random.kernel(), 0.1);
    let root = NodeKind::Group(Group::new(Operator::Union, blend));
    let mut groups = vec![add(&mut scene, None, Node::new("", root))];
    add(&mut scene, Some(groups[0]), object(Shape::Sphere { radius: 0.5 }));
    while scene.nodes().len() < count {
        let parent = if random.once_in(3) { groups[0] } else { groups[random.below(groups.len())] };
        let place = random.point(DVec3::splat(-1.5), DVec3::splat(1.5));
        let turned = DQuat::from_euler(glam::EulerRot::XYZ, random.between(0.0, 6.0), random.between(0.0, 6.0), 0.0);
        let size = random.between(0.2, 0.6);
        let scale = if random.once_in(4) { DVec3::new(size, 1.5 * size, 0.7 * size) } else { DVec3::splat(size) };
        let mut node = if random.once_in(5) {
            Node::new("", random.group(0.3)).at(0.5 * place)
        } else {
            object(random.bounded_shape()).at(place).rotated(turned).scaled(scale)
        };
        let is_group = !matches!(node.kind, NodeKind::Object(_));
        if random.once_in(5) {
            node.operation = Operation::Subtract;
        }
        let id = add(&mut scene, Some(parent), node);
        if is_group {
            add(&mut scene, Some(id), object(random.bounded_shape()).at(place).scaled(DVec3::splat(0.8)));
            groups.push(id);
        }
    }
    scene
}

/// One blended union of leaves of the same kind, `spread` meters wide.
fn crowd(seed: u64, count: usize, spread: f64, radius: f64) -> Scene {
    let random = &mut Random(seed);
    let mut scene = empty_scene();
    let blend = Blend::new(BlendKernel::Circular, radius);
    let root = add(&mut scene, None, Node::new("", NodeKind::Group(Group::new(Operator::Union, blend))));
    for _ in 0..count {
        let place = random.point(DVec3::splat(-0.5 * spread), DVec3::splat(0.5 * spread));
        add(&mut scene, Some(root), object(Shape::Sphere { radius: random.between(0.1, 0.2) }).at(place));
    }
    scene
}

/// Counts of right and wrong tapes at random points: as the field, as bounds.
#[derive(Debug, Default)]
struct Verdict {
    tapes: usize,
    bounds: usize,
    wrong: usize,
}

fn verdict(flat: &FlatScene, tree: &CellTree, points: usize) -> Verdict {
    let component = &flat.components[0];
    let grid = &tree.grids[0];
    let high = grid.low + grid.side * DVec3::from(grid.counts.map(f64::from));
    let (mut random, mut verdict) = (Random(77), Verdict::default());
    for _ in 0..points {
        let p = random.point(grid.low - 0.1 * grid.side, high + 0.1 * grid.side);
        let reference = eval::field(flat, component, p);
        let by_tape = tape_field(flat, component, tree, p);
        let right = match tree.tape_at(0, p) {
            Cell::Tape(_) => {
                verdict.tapes += 1;
                (by_tape - reference).abs() <= 1e-9 * reference.abs().max(1.0)
            }
            Cell::Empty { .. } => {
                verdict.bounds += 1;
                by_tape * reference > 0.0 && by_tape.abs() <= reference.abs()
            }
            // The tape bounds the distance to the bounds, which fields of intersections do not contain.
            Cell::Outside => reference > 0.0 && by_tape > 0.0 && by_tape <= component.bounds.distance(p) + 1e-12,
        };
        verdict.wrong += usize::from(!right);
    }
    verdict
}

#[test]
fn tapes_have_the_value_of_the_whole_component() {
    let (mut built, mut tapes, mut bounds) = (0, 0, 0);
    for seed in 0..40 {
        let flat = flatten(&random_tree(seed, 30 + 3 * seed as usize), 0.0).unwrap();
        if flat.components.is_empty() || !has_tape(&flat, &flat.components[0]) {
            continue;
        }
        let tree = CellTree::build(&flat, &flat.components[0]);
        let verdict = verdict(&flat, &tree, 400);
        assert_eq!(verdict.wrong, 0, "seed {seed}: {verdict:?}");
        built += 1;
        tapes += verdict.tapes;
        bounds += verdict.bounds;
    }
    assert!(built >= 20 && tapes > 1000 && bounds > 1000, "{built} {tapes} {bounds}");
}

#[test]
fn runs_are_passed_over_and_tapes_are_short() {
    let flat = flatten(&crowd(3, 200, 3.0, 0.1), 0.0).unwrap();
    assert!(flat.nodes.iter().any(FlatNode::is_run));
    let tree = CellTree::build(&flat, &flat.components[0]);
    let verdict = verdict(&flat, &tree, 2000);
    assert_eq!(verdict.wrong, 0, "{verdict:?}");
    let longest = tapes(&tree).into_iter().map(<[_]>::len).max().unwrap();
    assert!(longest <= 24, "{longest}");
}

/// More than any tree takes.
const TOO_LONG: Duration = Duration::from_secs(100);

fn trees(tape_cache: &mut TapeCache, flat: &FlatScene) -> Vec<Option<Arc<CellTree>>> {
    tape_cache.trees(flat, &vec![true; flat.components.len()])
}

/// All tapes of a tree.
fn tapes(tree: &CellTree) -> Vec<&[[u32; 2]]> {
    let mut found = Vec::new();
    let words = &tree.words[tree.start..];
    let mut cells: Vec<usize> = (0..tree.grids[0].counts.iter().product::<u32>() as usize).collect();
    while let Some(cell) = cells.pop() {
        let [first, second] = words[cell];
        let offset = (first & OFFSET_MASK) as usize;
        match first >> CELL_SHIFT {
            CELL_TAPE => found.push(&words[offset..offset + second as usize]),
            CELL_REFINED => cells.extend(offset..offset + BLOCK_CELLS),
            _ => {}
        }
    }
    found
}

#[test]
fn every_tape_can_be_walked_within_the_stack_of_its_component() {
    for seed in 0..12 {
        let flat = flatten(&random_tree(seed, 80), 0.0).unwrap();
        let Some(component) = flat.components.first().filter(|c| has_tape(&flat, c)) else { continue };
        for tape in tapes(&CellTree::build(&flat, component)) {
            let (mut aside, mut most) = (0_u32, 0);
            let mut fresh = true;
            for tape_entry in tape.iter().map(|words| TapeEntry(*words)) {
                assert!(
                    tape_entry.entry() < component.count as usize && tape_entry.row() < component.param_rows as usize
                );
                match tape_entry.op() {
                    TapeOp::Leaf => assert_eq!(tape_entry.join() == Join::First as u32, fresh, "seed {seed}"),
                    TapeOp::Begin => aside += 1,
                    TapeOp::End => aside -= 1,
                    TapeOp::Negate => assert!(!fresh),
                }
                fresh = tape_entry.op() == TapeOp::Begin;
                most = most.max(aside);
            }
            assert!(aside == 0 && most <= component.stack && !tape.is_empty() && !fresh);
        }
    }
}

/// Moves and resizes a node a little, or changes how a group joins.
fn edit(scene: &mut Scene, random: &mut Random) {
    let index = random.below(scene.nodes().len());
    let mut node = Node::clone(&scene.nodes()[index]);
    node.transform.translation += random.point(DVec3::splat(-0.1), DVec3::splat(0.1));
    match &mut node.kind {
        NodeKind::Group(group) if random.once_in(2) => group.blend.radius *= random.between(0.5, 1.5),
        NodeKind::Object(object) if random.once_in(3) => object.shape = random.shape(),
        _ => {}
    }
    scene.replace(node).unwrap();
}

#[test]
fn what_an_edit_reached_is_made_anew_and_all_else_is_as_in_a_fresh_tree() {
    let mut compared = 0;
    for seed in 0..8 {
        let mut scene = if seed < 4 { random_tree(seed, 60) } else { crowd(seed, 100, 2.0, 0.15) };
        let (mut tape_cache, mut random) = (TapeCache::default(), Random(seed + 100));
        trees(&mut tape_cache, &flatten(&scene, 0.0).unwrap());
        for step in 0..6 {
            edit(&mut scene, &mut random);
            let flat = flatten(&scene, 0.0).unwrap();
            for (component, tree) in flat.components.iter().zip(&trees(&mut tape_cache, &flat)) {
                let Some(tree) = tree else { continue };
                assert!(**tree == CellTree::build(&flat, component), "seed {seed}, step {step}");
                compared += 1;
            }
        }
    }
    assert!(compared > 20);
}

#[test]
fn an_unchanged_component_keeps_its_tree() {
    let mut scene = crowd(1, 60, 2.0, 0.1);
    // Far from the first, so that an edit of one does not move the other.
    let blend = Blend::new(BlendKernel::Cubic, 0.1);
    let other = Node::new("", NodeKind::Group(Group::new(Operator::Union, blend))).at(DVec3::splat(9.0));
    let other = add(&mut scene, None, other);
    for i in 0..40 {
        add(&mut scene, Some(other), object(Shape::Sphere { radius: 0.2 }).at(DVec3::X * 0.1 * f64::from(i)));
    }
    let mut tape_cache = TapeCache::default();
    let same = |a: &[Option<Arc<CellTree>>], b: &[Option<Arc<CellTree>>], i: usize| {
        Arc::ptr_eq(a[i].as_ref().unwrap(), b[i].as_ref().unwrap())
    };
    let before = trees(&mut tape_cache, &flatten(&scene, 0.0).unwrap());
    let again = trees(&mut tape_cache, &flatten(&scene, 0.0).unwrap());
    assert_eq!([0, 1].map(|i| same(&before, &again, i)), [true, true]);
    let last = scene.nodes().len() - 20;
    let mut node = Node::clone(&scene.nodes()[last]);
    node.transform.translation.y += 0.01;
    scene.replace(node).unwrap();
    let after = trees(&mut tape_cache, &flatten(&scene, 0.0).unwrap());
    assert_eq!([0, 1].map(|i| same(&before, &after, i)), [true, false]);
}

#[test]
fn trees_made_beside_the_frames_are_never_those_of_an_older_scene() {
    let mut scene = crowd(3, 120, 2.0, 0.15);
    let (mut tape_cache, mut random) = (TapeCache::default(), Random(12));
    let flat = flatten(&scene, 0.0).unwrap();
    let all = vec![true; flat.components.len()];
    assert_eq!(tape_cache.ready_trees(&flat, &all, Duration::ZERO), [None], "nothing is there yet, and nobody waits");
    let mut given = 0;
    for step in 0..30 {
        if step % 3 == 0 {
            edit(&mut scene, &mut random);
        }
        let flat = flatten(&scene, 0.0).unwrap();
        // Call at once or after a while, so that the worker may be at any point.
        std::thread::sleep(Duration::from_millis(step % 7));
        let most = if step % 5 == 4 { TOO_LONG } else { Duration::ZERO };
        for tree in tape_cache.ready_trees(&flat, &all, most).into_iter().flatten() {
            assert!(*tree == CellTree::build(&flat, &flat.components[0]), "step {step}");
            given += 1;
        }
    }
    assert!(given > 0);
    let flat = flatten(&scene, 0.0).unwrap();
    let tree = trees(&mut tape_cache, &flat).remove(0).unwrap();
    assert!(*tree == CellTree::build(&flat, &flat.components[0]) && tape_cache.building() == 0);
}

#[test]
fn tapes_for_a_narrower_blend_are_caught() {
    let wide = flatten(&crowd(5, 100, 1.6, 0.3), 0.0).unwrap();
    let mut narrow = wide.clone();
    for node in &narrow.nodes {
        narrow.params[node.params as usize][0] *= 0.2;
    }
    let [right, wrong] = [&wide, &narrow].map(|flat| CellTree::build(flat, &flat.components[0]));
    assert_eq!(verdict(&wide, &right, 2000).wrong, 0);
    assert!(verdict(&wide, &wrong, 2000).wrong > 20);
}

/// The number of random points in random cubes where the tape made for the cube gives another value, if it is made
/// for the fraction `share` of the reach of the cube.
fn wrong_in_cubes(share: f64) -> usize {
    let flat = flatten(&random_tree(7, 80), 0.0).unwrap();
    let component = &flat.components[0];
    let entries = entry::Entries::new(&flat, component);
    let full_tape = program::full_tape(&entries, &[], 0..component.count as usize);
    let (mut simplifier, mut random, mut tape, mut wrong) = (program::Simplifier::default(), Random(8), Vec::new(), 0);
    for _ in 0..300 {
        let (center, half) = (random.point(DVec3::splat(-1.5), DVec3::splat(1.5)), random.between(0.01, 0.3));
        let reach = share * (2.0 * half * 3.0_f64.sqrt() + 1e-6);
        simplifier.run(&full_tape, &entries, center, reach, &mut tape);
        let tape_entries: Vec<_> = tape.iter().map(|step| step.tape_entry.0).collect();
        for _ in 0..10 {
            let p = random.point(center - half, center + half);
            let (by_tape, reference) = (
                field::fold(&flat, component, &tape_entries, p, &|_, _| unreachable!()),
                eval::field(&flat, component, p),
            );
            wrong += usize::from((by_tape - reference).abs() > 1e-9);
        }
    }
    wrong
}

#[test]
fn tapes_for_smaller_cells_are_caught() {
    assert_eq!(wrong_in_cubes(1.0), 0);
    assert!(wrong_in_cubes(0.25) > 20);
}

#[test]
fn a_component_whose_tapes_cannot_be_made_is_walked_without() {
    let mut scene = crowd(3, 60, 2.0, 0.15);
    let far = scene.nodes().iter().map(|node| Node::clone(node)).collect::<Vec<_>>();
    let shift = 1 + far.len() as u64;
    let moved = |id: isolith_scene::NodeId| isolith_scene::NodeId(id.0 + shift);
    let second = far.iter().map(|node| Node { id: moved(node.id), parent: node.parent.map(moved), ..node.clone() });
    scene.insert_subtree(None, usize::MAX, second.collect()).unwrap();
    let mut flat = flatten(&scene, 0.0).unwrap();
    assert_eq!(flat.components.len(), 2);
    let leaf = flat.nodes.iter().position(FlatNode::is_leaf).unwrap();
    // An unknown shape.
    flat.nodes[leaf].code |= 0x0800;
    let mut tape_cache = TapeCache::default();
    let waited = trees(&mut tape_cache, &flat);
    assert_eq!([waited[0].is_some(), waited[1].is_some()], [false, true]);
    let [failure] = &tape_cache.take_failures()[..] else { panic!("one failure") };
    assert!(failure.contains("internal error") && tape_cache.take_failures().is_empty(), "{failure}");
    // Neither the cache nor the worker tries it again.
    assert!(trees(&mut tape_cache, &flat)[0].is_none() && tape_cache.take_failures().is_empty());
    let mut beside = TapeCache::default();
    let all = [true; 2];
    let trees = beside.ready_trees(&flat, &all, TOO_LONG);
    assert_eq!([trees[0].is_some(), trees[1].is_some()], [false, true]);
    assert_eq!((beside.take_failures().len(), beside.building()), (1, 0));
}

#[test]
fn making_tapes_is_canceled_between_components() {
    let flat = flatten(&crowd(3, 60, 2.0, 0.15), 0.0).unwrap();
    let cancel = crate::Cancel::default();
    let mut tape_cache = TapeCache::default();
    tape_cache.set_cancel(&cancel);
    cancel.cancel();
    assert_eq!(trees(&mut tape_cache, &flat), [None]);
}

#[test]
fn the_largest_components_have_tapes_where_there_are_too_many() {
    let mut flat = flatten(&crowd(3, 60, 2.0, 0.15), 0.0).unwrap();
    let first = flat.components[0].clone();
    let many = crate::MAX_CACHED_ENTRIES / first.count as usize;
    flat.components = vec![Component { count: first.count - 1, ..first.clone() }; 2];
    flat.components.extend(vec![first; many]);
    let found: Vec<(usize, super::worker::ComponentKey)> =
        (0..flat.components.len()).map(|i| (i, (flat.ids[0], i as u32))).collect();
    let mut kept = found.clone();
    super::tape_cache::within_room(&flat, &mut kept);
    assert_eq!(kept, found[2..]);
    let mut few = found[..3].to_vec();
    super::tape_cache::within_room(&flat, &mut few);
    assert_eq!(few, found[..3]);
}
