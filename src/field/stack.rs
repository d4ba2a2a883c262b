//! Reorders operands so that evaluation needs few accumulators.
//!
//! A fold keeps one accumulator, and each group after the first operand needs another during its evaluation. So a
//! hundred groups, each the second child of the one before, would need a hundred, and the stack of an evaluator is
//! compiled into the kernel: lavapipe took 43 s for 128 places. Evaluated from the inside out they need one: the
//! deepest group comes first, and the operands before it join it by the mirrored join, which gives the same value to
//! the last bit (Sethi and Ullman, "The generation of optimal code for arithmetic expressions", 1970). The content of
//! a modifier is a fold of its own: it is ordered separately, and the modifier needs one place more.

use std::rc::Rc;

use super::arrays::Join;
use super::composition::{group_of, size_of_fold};
use super::operand::{Operand, Value};

/// Folds that need no more than this stay as they are, so that their kernels stay alike.
const SHALLOW: u32 = 8;

/// The fold with its deepest operands first, as far as its joins can be mirrored; `None` if few accumulators suffice.
pub(super) fn shallow<'a>(fold: &[Operand<'a>]) -> Option<Vec<Operand<'a>>> {
    (need(fold) > SHALLOW).then(|| deepest_first(fold.to_vec()))
}

fn deepest_first(mut fold: Vec<Operand<'_>>) -> Vec<Operand<'_>> {
    fold.iter_mut().for_each(order_contents);
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
    fold
}

/// Orders the contents of the modifiers in an operand.
fn order_contents(operand: &mut Operand<'_>) {
    if operand.depth <= SHALLOW {
        return;
    }
    let inner = match &mut operand.value {
        Value::Leaf { .. } => return,
        Value::Fold(inner) => {
            Rc::make_mut(inner).iter_mut().for_each(order_contents);
            inner
        }
        Value::Modified { content, .. } => {
            *content = Rc::new(deepest_first(content.to_vec()));
            content
        }
    };
    let (entries, depth) = size_of_fold(inner);
    (operand.entries, operand.depth) = (entries.saturating_add(1), depth + 1);
}

/// Accumulators to put aside within a fold.
fn need(fold: &[Operand<'_>]) -> u32 {
    fold.iter().map(|operand| operand.depth).max().unwrap_or(0)
}

/// The deepest operand, if it can come first.
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
    use crate::eval::field;
    use crate::{FlatScene, flatten};
    use isolith_scene::{Blend, Group, MaterialId, Modifier, Node, NodeId, NodeKind, Object, Operator, Scene, Shape};

    /// The offset by which a group is rounded.
    const ROUNDED: f64 = 0.01;

    /// `depth` nested groups, each the last child of the one before. Each holds a ball, a second one if `wide`, and
    /// the next group; those in `rounded` are rounded.
    fn nest(depth: usize, operators: &[Operator], wide: bool, rounded: &[usize]) -> Scene {
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
            let round = Modifier::Round { radius: ROUNDED };
            let node = if rounded.contains(&i) { node.modified(round) } else { node };
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
                // Each modifier needs a place for itself and for its content.
                for rounded in [&[][..], &[0], &[50], &[0, 30, 60]] {
                    let flat = flat(&nest(100, operators, wide, rounded));
                    let stack = flat.components.iter().map(|c| c.stack).max();
                    let most = super::SHALLOW + rounded.len() as u32;
                    assert!(stack <= Some(most), "{stack:?} by {operators:?}, rounded {rounded:?}");
                }
            }
        }
        // Joins that cannot be mirrored keep their order.
        for rounded in [&[][..], &[0]] {
            assert!(flat(&nest(20, &[Operator::Groove], false, rounded)).components[0].stack > super::SHALLOW + 1);
        }
    }

    /// The value by the definition of the operators, in the artist's order.
    fn by_hand(
        scene: &Scene,
        operators: &[Operator],
        (wide, rounded): (bool, &[usize]),
        depth: usize,
        p: glam::DVec3,
    ) -> f64 {
        use crate::eval::{BlendParams, op_difference, op_intersection, op_union, op_xor};
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
            inner = join(so_far, inner) - if rounded.contains(&i) { ROUNDED } else { 0.0 };
        }
        inner
    }

    #[test]
    fn exchanged_operands_give_the_same_field() {
        use Operator::{Difference, Intersection, Union, Xor};
        for operators in
            [&[Union, Difference][..], &[Difference], &[Difference, Intersection, Union], &[Xor, Difference]]
        {
            for (wide, rounded) in [(false, &[][..]), (true, &[]), (false, &[0]), (true, &[0, 5]), (false, &[13])] {
                let scene = nest(24, operators, wide, rounded);
                let flat = flat(&scene);
                assert_eq!(flat.components.len(), 1, "{operators:?}");
                let component = &flat.components[0];
                for i in 0..500 {
                    let at = f64::from(i);
                    let p = 1.2 * glam::DVec3::new((0.7 * at).sin(), (1.3 * at).cos(), (0.3 * at).sin() * 0.5);
                    let expected = by_hand(&scene, operators, (wide, rounded), 24, p);
                    let found = field(&flat, component, p - component.origin);
                    // The arrays are rounded to f32.
                    let is_same = (found - expected).abs() < 1e-5;
                    assert!(is_same, "{operators:?}, {wide}, {rounded:?}: {found} for {expected} at {p}");
                }
            }
        }
    }
}
