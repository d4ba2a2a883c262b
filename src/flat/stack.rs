//! The order of operands that needs few accumulators.
//!
//! A fold keeps one accumulator, and each group after the first operand needs another while it is evaluated. So a hundred
//! groups, each the second child of the one before, would need a hundred, and a walk's stack is compiled into the kernel:
//! lavapipe took 43 s for 128 places. Evaluated from the inside out they need one: the deepest group comes first, and what
//! preceded it joins it by the mirrored join, which gives the same value to the last bit (Sethi and Ullman, "The generation
//! of optimal code for arithmetic expressions", 1970).

use std::rc::Rc;

use super::arrays::Join;
use super::composition::group_of;
use super::operand::{Operand, Value};

/// Folds that need no more are left as they are: their kernels stay alike.
const SHALLOW: u32 = 8;

/// The fold with its deepest operands first, as far as its joins can be mirrored, where it needs more than a few
/// accumulators.
pub(super) fn shallow<'a>(fold: &[Operand<'a>]) -> Option<Vec<Operand<'a>>> {
    if need(fold) <= SHALLOW {
        return None;
    }
    let mut fold = fold.to_vec();
    while need(&fold) > SHALLOW {
        let Some(at) = deepest(&fold) else { break };
        let rest = fold.split_off(at + 1);
        let Some(Operand { join, blend, detail, value: Value::Fold(inner), .. }) = fold.pop() else { break };
        let before = if fold.len() == 1 { fold.swap_remove(0) } else { group_of(fold) };
        let join = mirrored(join).unwrap_or(join);
        fold = Rc::unwrap_or_clone(inner);
        fold.push(Operand { join, blend, detail, ..before });
        fold.extend(rest);
    }
    Some(fold)
}

/// Accumulators that have to be put aside within a fold.
fn need(fold: &[Operand<'_>]) -> u32 {
    fold.iter().map(|operand| operand.depth).max().unwrap_or(0)
}

/// The operand that needs most, if it can come first.
fn deepest(fold: &[Operand<'_>]) -> Option<usize> {
    let at = (0..fold.len()).max_by_key(|i| fold[*i].depth)?;
    let is_movable = at > 0 && matches!(fold[at].value, Value::Fold(_)) && mirrored(fold[at].join).is_some();
    is_movable.then_some(at)
}

/// The join with its operands exchanged.
fn mirrored(join: Join) -> Option<Join> {
    match join {
        Join::Union | Join::Intersection | Join::Xor => Some(join),
        Join::Difference => Some(Join::ReverseDifference),
        Join::ReverseDifference => Some(Join::Difference),
        Join::First | Join::Pipe | Join::Groove | Join::Tongue | Join::Engrave | Join::Morph | Join::Paint => None,
    }
}

#[cfg(test)]
mod tests {
    use crate::flat::eval::field;
    use crate::flat::{FlatScene, flatten};
    use crate::scene::{Blend, Group, MaterialId, Node, NodeId, NodeKind, Object, Operator, Scene, Shape};

    /// `depth` groups, each the last child of the one before, of a ball, where `wide` another, and the next group.
    fn nest(depth: usize, operators: &[Operator], wide: bool) -> Scene {
        let mut scene = Scene::new();
        let mut parent: Option<NodeId> = None;
        let ball = |scene: &mut Scene, parent, i: usize| {
            let at = 0.37 * i as f64;
            let object = Object { shape: Shape::Sphere { radius: 0.5 + 0.002 * i as f64 }, material: MaterialId(1) };
            let node = Node::new("ball", NodeKind::Object(object)).at(0.4 * glam::DVec3::new(at.cos(), at.sin(), 0.0));
            scene.insert(parent, usize::MAX, node).expect("room");
        };
        for i in 0..depth {
            let blend = Blend { radius: if i % 3 == 0 { 0.1 } else { 0.0 }, ..Blend::HARD };
            let group = Group { operator: operators[i % operators.len()], blend, ..Group::UNION };
            let node = Node::new("group", NodeKind::Group(group));
            parent = Some(scene.insert(parent, usize::MAX, node).expect("room"));
            ball(&mut scene, parent, i);
            if wide {
                ball(&mut scene, parent, i + 7);
            }
        }
        ball(&mut scene, parent, depth);
        scene
    }

    fn flat(scene: &Scene) -> FlatScene {
        flatten(scene, 0.0).expect("within the limits")
    }

    #[test]
    fn nested_groups_need_few_accumulators() {
        use Operator::{Difference, Intersection, Union, Xor};
        for operators in [&[Union, Difference][..], &[Difference], &[Intersection, Difference, Union], &[Xor, Union]] {
            for wide in [false, true] {
                let flat = flat(&nest(100, operators, wide));
                let stack = flat.components.iter().map(|c| c.stack).max();
                assert!(stack <= Some(super::SHALLOW), "{stack:?} by {operators:?}");
            }
        }
        // What cannot be exchanged stays.
        assert!(flat(&nest(20, &[Operator::Groove], false)).components[0].stack > super::SHALLOW);
    }

    /// The value by the definition of the operators, in the artist's order.
    fn by_hand(scene: &Scene, operators: &[Operator], wide: bool, depth: usize, p: glam::DVec3) -> f64 {
        use crate::flat::eval::{BlendParams, op_difference, op_intersection, op_union, op_xor};
        let balls: Vec<f64> = scene
            .nodes()
            .iter()
            .filter_map(|node| match &node.kind {
                NodeKind::Object(Object { shape: Shape::Sphere { radius }, .. }) => {
                    Some((p - node.transform.translation).length() - radius)
                }
                _ => None,
            })
            .collect();
        let each = if wide { 2 } else { 1 };
        let mut inner = balls[depth * each];
        for i in (0..depth).rev() {
            let blend = Blend { radius: if i % 3 == 0 { 0.1 } else { 0.0 }, ..Blend::HARD };
            let blend_params = BlendParams::blend(blend.support());
            let join = |a: f64, b: f64| match operators[i % operators.len()] {
                Operator::Union => op_union(a, b, &blend_params, 0).value,
                Operator::Intersection => op_intersection(a, b, &blend_params, 0).value,
                Operator::Difference => op_difference(a, b, &blend_params, 0).value,
                _ => op_xor(a, b, &blend_params, 0).value,
            };
            let first = balls[i * each];
            let so_far = if wide { join(first, balls[i * each + 1]) } else { first };
            inner = join(so_far, inner);
        }
        inner
    }

    #[test]
    fn exchanged_operands_give_the_same_field() {
        use Operator::{Difference, Intersection, Union, Xor};
        for operators in
            [&[Union, Difference][..], &[Difference], &[Difference, Intersection, Union], &[Xor, Difference]]
        {
            for wide in [false, true] {
                let scene = nest(24, operators, wide);
                let flat = flat(&scene);
                assert_eq!(flat.components.len(), 1, "{operators:?}");
                let component = &flat.components[0];
                for i in 0..500 {
                    let at = f64::from(i);
                    let p = 1.2 * glam::DVec3::new((0.7 * at).sin(), (1.3 * at).cos(), (0.3 * at).sin() * 0.5);
                    let expected = by_hand(&scene, operators, wide, 24, p);
                    let found = field(&flat, component, p - component.origin);
                    // The arrays are rounded to f32.
                    assert!((found - expected).abs() < 1e-5, "{operators:?}, {wide}: {found} for {expected} at {p}");
                }
            }
        }
    }
}
