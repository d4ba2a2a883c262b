//! Tests of the tapes of modifiers' contents.

use super::*;
use isolith_scene::{Attachment, Modifier, ModifierKind};

/// Forty balls and boxes in one blend, below modifiers; `beside` adds as many more beside them, joined with a blend.
fn modified_crowd(seed: u64, modifiers: &[Modifier], beside: bool) -> Scene {
    let random = &mut Random(seed);
    let mut scene = empty_scene();
    let group = |radius: f64| NodeKind::Group(Group::new(Operator::Union, Blend::new(BlendKernel::Circular, radius)));
    let mut crowds = Vec::new();
    if beside {
        let outer = add(&mut scene, None, Node::new("", group(0.1)));
        crowds.push(outer);
    }
    let parent = crowds.first().copied();
    let held = modifiers.iter().fold(Node::new("", group(0.08)), |node, modifier| node.modified(modifier.clone()));
    crowds.push(add(&mut scene, parent, held.at(DVec3::new(0.3, 0.2, -0.1)).scaled(DVec3::splat(0.8))));
    for crowd in crowds {
        for _ in 0..40 {
            let place = random.point(DVec3::splat(-0.8), DVec3::splat(0.8));
            let shape = if random.once_in(2) { Shape::Sphere { radius: 0.15 } } else { random.bounded_shape() };
            add(&mut scene, Some(crowd), object(shape).at(place).scaled(DVec3::splat(0.3)));
        }
    }
    scene
}

/// Every modifier that flattening keeps as a modifier, with parameters that have an effect.
fn all_modifiers() -> Vec<Modifier> {
    let of_kind = |kind: &ModifierKind| match kind.default_modifier() {
        Modifier::Twist { .. } => Modifier::Twist { angle: 70.0 },
        Modifier::Bend { .. } => Modifier::Bend { angle: 25.0 },
        Modifier::Elongate { .. } => Modifier::Elongate { length: [0.5, 0.0, 0.2] },
        Modifier::Repeat { counts, spacing, offset, turn, mirrored, carve_from, carve_to } => {
            let spacing = spacing.map(|s| 1.2 * s);
            Modifier::Repeat { counts, spacing, offset, turn, mirrored, carve_from, carve_to }
        }
        Modifier::Displacement { height, tile, axis, .. } => {
            let image = Attachment::drawn("bumps.png", [8; 2], |x, y| (20 * (x ^ y)) as u8);
            Modifier::Displacement { image, height, tile, axis }
        }
        other => other,
    };
    let copied = [ModifierKind::Mirror, ModifierKind::Polar];
    ModifierKind::ALL.iter().filter(|kind| !copied.contains(kind)).map(of_kind).collect()
}

/// Counts of wrong tape values: another sign, or not safe to step by. And counts of values near the surface equal to
/// those of the CPU evaluator; only cells without a tape may be lower there.
fn wrong_and_exact(flat: &FlatScene, tree: &CellTree, seed: u64, points: usize) -> (usize, usize) {
    let component = &flat.components[0];
    let random = &mut Random(seed);
    let (mut wrong, mut exact) = (0, 0);
    let bounds = component.bounds.expanded(0.1);
    for _ in 0..points {
        let p = random.point(bounds.min, bounds.max);
        let (reference, by_tape) = (eval::field(flat, component, p), tape_field(flat, component, tree, p));
        exact += usize::from(reference.abs() < 0.02 && (reference - by_tape).abs() <= 1e-9);
        let mut right = reference * by_tape > 0.0;
        // Within this distance no point may be on the other side.
        for _ in 0..4 {
            let way = random.point(DVec3::splat(-1.0), DVec3::splat(1.0)).normalize_or_zero() * by_tape.abs() * 0.999;
            right &= eval::field(flat, component, p + way) * reference >= 0.0;
        }
        wrong += usize::from(!right);
    }
    (wrong, exact)
}

#[test]
fn contents_of_modifiers_have_tapes_of_their_own() {
    let all = all_modifiers();
    let (mut exact_all, mut built) = (0, 0);
    for (i, modifier) in all.iter().enumerate() {
        let other = all[(i + 3) % all.len()].clone();
        for (j, modifiers) in [vec![modifier.clone()], vec![modifier.clone(), other]].iter().enumerate() {
            for beside in [false, true] {
                let seed = (4 * i + 2 * j) as u64 + u64::from(beside);
                let Ok(flat) = flatten(&modified_crowd(seed, modifiers, beside), 0.0) else { continue };
                let component = &flat.components[0];
                assert!(has_tape(&flat, component), "{modifiers:?}");
                let tree = CellTree::build(&flat, component);
                assert_eq!(tree.grids.len(), 1 + modifiers.len());
                assert!(tree.grids[modifiers.len()] != Grid::ONE_CELL, "{modifiers:?}: the innermost content is large");
                let (wrong, exact) = wrong_and_exact(&flat, &tree, seed, 300);
                assert_eq!(wrong, 0, "{modifiers:?}, beside: {beside}");
                exact_all += exact;
                built += 1;
            }
        }
    }
    assert!(built > 30 && exact_all > 200, "{built} trees, {exact_all} exact values near a surface");
}

#[test]
fn tapes_below_a_shell_that_are_made_for_the_bare_surface_are_caught() {
    let shell = |radius| {
        let flat = flatten(&modified_crowd(5, &[Modifier::Round { radius }], false), 0.0).unwrap();
        let tree = CellTree::build(&flat, &flat.components[0]);
        (flat, tree)
    };
    let ((flat, right), (_, wrong)) = (shell(0.12), shell(0.001));
    assert_eq!(wrong_and_exact(&flat, &right, 1, 2000).0, 0);
    assert!(wrong_and_exact(&flat, &wrong, 1, 2000).0 > 20);
}

#[test]
fn an_edit_below_a_modifier_makes_anew_what_it_reached_and_nothing_else() {
    let mut scene = modified_crowd(7, &[Modifier::Twist { angle: 40.0 }, Modifier::Round { radius: 0.02 }], true);
    let (mut tape_cache, mut random) = (TapeCache::default(), Random(3));
    trees(&mut tape_cache, &flatten(&scene, 0.0).unwrap());
    let is_leaf = |i: &usize| matches!(scene.nodes()[*i].kind, NodeKind::Object(_));
    let leaves: Vec<usize> = (0..scene.nodes().len()).filter(is_leaf).collect();
    for step in 0..12 {
        let mut node = Node::clone(&scene.nodes()[leaves[random.below(leaves.len())]]);
        node.transform.translation += random.point(DVec3::splat(-0.05), DVec3::splat(0.05));
        scene.replace(node).unwrap();
        let flat = flatten(&scene, 0.0).unwrap();
        let made = trees(&mut tape_cache, &flat);
        let tree = made[0].as_ref().expect("it is large");
        assert!(**tree == CellTree::build(&flat, &flat.components[0]), "step {step}");
        let again = trees(&mut tape_cache, &flat);
        assert!(Arc::ptr_eq(tree, again[0].as_ref().expect("it is large")), "step {step}: nothing has changed");
    }
}
