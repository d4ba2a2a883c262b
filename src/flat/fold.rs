//! The children of a group, joined one after the other; see [`crate::scene::Remainder`] for those that are empty.

use glam::DAffine3;

use super::collect::{Collector, Found};
use super::joints::Joiner;
use super::operands::{Operand, begin_with};
use crate::scene::{Group, Node, Operator, Remainder};

/// What stands so far.
enum Stand<'a> {
    /// No operand has been met.
    None,
    /// The empty set.
    Nothing,
    Operands(Vec<Operand<'a>>),
}

impl<'a> Collector<'a, '_> {
    /// The fold of the children of the group at `index`; no operand where it is empty.
    pub fn fold(&mut self, index: usize, group: &Group, world: &DAffine3, outermost: &'a Node) -> Vec<Operand<'a>> {
        let (survey, scene) = (self.survey, self.scene);
        let child = |at: usize| -> &'a Node { scene.nodes()[at].as_ref() };
        let mut joiner = Joiner::new(group, survey.children(index).map(child));
        let mut stand = Stand::None;
        // The child that is empty, and whether a sibling is gone with it.
        let (mut empty, mut is_lost) = (None, false);
        for at in survey.children(index) {
            let node = child(at);
            let found = self.operand(at, world, outermost);
            if !self.budget.is_open() {
                return Vec::new();
            }
            let operand = match found {
                Found::LeftOut => {
                    // Hidden, but the others work on it.
                    let is_first = matches!(stand, Stand::None) && node.has_field() && !node.negative;
                    if is_first && group.operator.needs_first() && !node.visible && !survey.is_folder(at) {
                        stand = Stand::Nothing;
                    }
                    continue;
                }
                Found::Nothing => None,
                Found::Operand(operand) => Some(operand),
            };
            let operator = if node.negative { Operator::Difference } else { group.operator };
            stand = match (stand, operand) {
                (Stand::None, Some(operand)) if !node.negative => begin(&mut joiner, node, operand),
                (Stand::None, operand) if node.negative => {
                    if operand.is_some() {
                        self.warn_nothing_to_cut(node);
                    }
                    Stand::None
                }
                (Stand::None, _) => {
                    empty = Some(node);
                    Stand::Nothing
                }
                (Stand::Nothing, Some(_)) if node.negative => {
                    if empty.is_some() {
                        self.warn_nothing_to_cut(node);
                    }
                    Stand::Nothing
                }
                (Stand::Nothing, Some(operand)) => match operator.with_nothing(group.share, false) {
                    Remainder::Second => begin(&mut joiner, node, operand),
                    Remainder::Nothing | Remainder::First => {
                        is_lost = true;
                        Stand::Nothing
                    }
                },
                (Stand::Operands(fold), None) => match operator.with_nothing(group.share, true) {
                    Remainder::Nothing => {
                        (empty, is_lost) = (empty.or(Some(node)), true);
                        Stand::Nothing
                    }
                    Remainder::First | Remainder::Second => Stand::Operands(fold),
                },
                (Stand::Operands(mut fold), Some(mut operand)) => {
                    joiner.set_joint(node, &mut operand);
                    joiner.join(node, operand, &mut fold, &mut self.budget);
                    Stand::Operands(fold)
                }
                (Stand::Nothing, None) => Stand::Nothing,
            };
        }
        match (stand, empty) {
            (Stand::Operands(fold), _) => fold,
            (_, Some(empty)) if is_lost => {
                let Node { name, id, .. } = child(index);
                let operator = group.operator.label();
                self.warn(empty, format!("is empty, so nothing is left of its group {name} ({id}): {operator}"));
                Vec::new()
            }
            _ => Vec::new(),
        }
    }
}

/// The fold begins with this operand.
fn begin<'a>(joiner: &mut Joiner<'_, 'a>, node: &'a Node, operand: Operand<'a>) -> Stand<'a> {
    joiner.begin(node, &operand);
    Stand::Operands(begin_with(operand))
}
