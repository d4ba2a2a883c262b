//! Joins the children of a group in order; see [`isolith_scene::EmptyOperandResult`] for empty ones.

use glam::DAffine3;

use super::blends::Joiner;
use super::collect::{Collector, Found};
use super::composition::begin_with;
use super::operand::Operand;
use isolith_scene::{EmptyOperandResult, Group, Node};

/// The result so far.
enum Stand<'a> {
    /// No operand yet.
    None,
    /// The empty set.
    Nothing,
    Operands(Vec<Operand<'a>>),
}

/// A group whose children are being joined.
struct Folding<'g, 'a> {
    group: &'g Group,
    joiner: Joiner<'g, 'a>,
    stand: Stand<'a>,
    /// The first empty child that leaves nothing of the result.
    empty: Option<&'a Node>,
    /// Whether a sibling vanished with it.
    is_lost: bool,
}

impl<'a> Collector<'a, '_> {
    /// The fold of the children of the group at `index`; without operands if the group is empty.
    pub fn fold(&mut self, index: usize, group: &Group, world: &DAffine3, outermost: &'a Node) -> Vec<Operand<'a>> {
        let (survey, scene) = (self.survey, self.scene);
        let child = |at: usize| -> &'a Node { scene.nodes()[at].as_ref() };
        let joiner = Joiner::new(group, survey.children(index).map(child));
        let mut folding = Folding { group, joiner, stand: Stand::None, empty: None, is_lost: false };
        for at in survey.children(index) {
            let node = child(at);
            let found = self.operand(at, world, outermost);
            if !self.budget.is_open() {
                return Vec::new();
            }
            match found {
                Found::Operand(operand) => folding.step(self, node, Some(operand)),
                Found::Nothing => folding.step(self, node, None),
                // Hidden, but the other children operate on it.
                Found::LeftOut if folding.needs(node) && !survey.is_folder(at) => folding.stand = Stand::Nothing,
                Found::LeftOut => {}
            }
        }
        match (folding.stand, folding.empty) {
            (Stand::Operands(fold), _) => fold,
            (_, Some(empty)) if folding.is_lost => {
                let Node { name, id, .. } = child(index);
                let operator = group.operator.label();
                self.warn(empty, format!("is empty, so nothing is left of its group {name} ({id}): {operator}"));
                Vec::new()
            }
            _ => Vec::new(),
        }
    }
}

impl<'a> Folding<'_, 'a> {
    /// Whether a hidden child is the one that all others would operate on.
    fn needs(&self, node: &Node) -> bool {
        let is_first = matches!(self.stand, Stand::None) && node.has_field() && node.adds();
        is_first && self.group.operator.needs_first() && !node.visible
    }

    /// Joins a child; `operand` is `None` if the child is empty.
    fn step(&mut self, collector: &mut Collector<'a, '_>, node: &'a Node, operand: Option<Operand<'a>>) {
        let operator = node.operation.in_group(self.group.operator);
        let share = self.group.share;
        self.stand = match (std::mem::replace(&mut self.stand, Stand::Nothing), operand) {
            (Stand::None, Some(operand)) if node.adds() => self.begin(node, operand),
            (Stand::None, operand) if !node.adds() => {
                if operand.is_some() {
                    collector.warn_nothing_before(node);
                }
                Stand::None
            }
            (Stand::None, _) => {
                self.empty = Some(node);
                Stand::Nothing
            }
            (Stand::Nothing, Some(_)) if !node.adds() => {
                if self.empty.is_some() {
                    collector.warn_nothing_before(node);
                }
                Stand::Nothing
            }
            (Stand::Nothing, Some(operand)) if operator.with_nothing(share, false) == EmptyOperandResult::Second => {
                self.begin(node, operand)
            }
            (Stand::Nothing, operand) => {
                self.is_lost |= operand.is_some();
                Stand::Nothing
            }
            (Stand::Operands(_), None) if operator.with_nothing(share, true) == EmptyOperandResult::Nothing => {
                (self.empty, self.is_lost) = (self.empty.or(Some(node)), true);
                Stand::Nothing
            }
            (stand @ Stand::Operands(_), None) => stand,
            (Stand::Operands(mut fold), Some(mut operand)) => {
                self.joiner.set_blend(node, &mut operand);
                self.joiner.join(node, operand, &mut fold, &mut collector.budget);
                Stand::Operands(fold)
            }
        };
    }

    /// Starts the fold with this operand.
    fn begin(&mut self, node: &'a Node, operand: Operand<'a>) -> Stand<'a> {
        self.joiner.begin(node, &operand);
        Stand::Operands(begin_with(operand))
    }
}
