//! Counts what flattening a scene takes before it starts: one pass over the nodes, however many copies they make.
//!
//! What is counted is no less than what is made, but for copies of what turns out to be the empty set only when it is
//! evaluated, such as an intersection of what does not meet.

use std::ops::Range;

use super::arrays::{MAX_FLAT_LEVELS, MAX_LIGHTS, MAX_STACK};
use super::budget::{ENTRIES, FlattenLimits, LEVELS, LIGHTS, STACK, STEPS};
use super::error::FlattenError;
use super::modify::is_idle;
use isolith_scene::{Modifier, Node, NodeKind, Object, Scene, Shape};

/// This many levels fit into the stack of any thread, 2 MiB for most.
const MOST_ON_ANY_STACK: usize = 100;
/// Bytes of stack per level: measured 5 KiB at most in a build for tests, so this has room.
const STACK_PER_LEVEL: usize = 16 << 10;
/// Further bytes of stack for evaluating a shape and writing the arrays.
const LEAST_STACK: usize = 2 << 20;

/// Scenes with fewer entries flatten within about a tenth of a second; payload rows count as well.
const QUICK: usize = 20_000;
/// A shape drawn from payload rows takes as long as this many others.
const DRAWN: usize = 100;

/// Whether flattening the scene is quick enough to wait for; also if it hits a limit at once.
pub fn is_quick(scene: &Scene) -> bool {
    let is_drawn = |node: &Node| match &node.kind {
        NodeKind::Object(object) => object.shape.kind().has_data(),
        _ => false,
    };
    let displaces = |node: &Node| active(node).any(|modifier| matches!(modifier, Modifier::Displacement { .. }));
    let drawn = scene.nodes().iter().filter(|node| is_drawn(node) || displaces(node)).count();
    let survey = Survey::new(scene, 0..scene.nodes().len(), &FlattenLimits::default());
    survey.map_or(true, |survey| survey.entries.max(scene.nodes().len() / 4) + DRAWN * drawn <= QUICK)
}

/// The modifiers that change something, in their order.
pub(super) fn active(node: &Node) -> impl DoubleEndedIterator<Item = &Modifier> {
    node.modifiers.iter().filter(|slot| slot.enabled && !is_idle(&slot.modifier)).map(|slot| &slot.modifier)
}

/// Counts of the nodes in a range, which holds whole subtrees.
pub(super) struct Survey {
    start: usize,
    nodes: Vec<Counts>,
    /// Depth of the recursion.
    pub levels: usize,
    /// Shapes and modifiers of all nodes, copies included.
    entries: usize,
}

#[derive(Clone, Copy, Default)]
struct Counts {
    /// End of the subtree, exclusive.
    end: usize,
    /// Whether a modifier of the node or of an ancestor thickens.
    is_thickened: bool,
    /// Whether the subtree contains objects, hidden or not; and whether it contains lights, cameras or meshes.
    has_object: bool,
    has_non_field: bool,
    /// Shapes and modifiers after copying; 0 where the subtree is hidden or certainly empty.
    entries: usize,
    /// Visits of nodes, copies included.
    steps: usize,
    /// Nested calls for the node and its descendants.
    levels: usize,
    /// Nested modifiers that stay in the arrays.
    deformed: usize,
}

impl Survey {
    /// Counts the nodes in `range`.
    ///
    /// # Errors
    /// They exceed a limit; the error names the innermost node for which that is so.
    pub fn new(scene: &Scene, range: Range<usize>, limits: &FlattenLimits) -> Result<Self, FlattenError> {
        let mut survey =
            Self { start: range.start, nodes: vec![Counts::default(); range.len()], levels: 0, entries: 0 };
        survey.nest(scene, &range);
        for index in range.clone().rev() {
            survey.count(scene, index);
            survey.check(&scene.nodes()[index], index, limits)?;
        }
        let lights = scene.nodes()[range.clone()].iter().filter(|node| matches!(node.kind, NodeKind::Light(_)));
        for (before, light) in lights.enumerate() {
            within(light, LIGHTS, before + 1, MAX_LIGHTS)?;
        }
        let (mut total, mut at) = (Counts::default(), range.start);
        while at < range.end {
            let top = *survey.at(at);
            let node = &scene.nodes()[at];
            total.entries = total.entries.saturating_add(top.entries);
            total.steps = total.steps.saturating_add(top.steps);
            within(node, ENTRIES, total.entries, limits.entries)?;
            within(node, STEPS, total.steps, limits.steps)?;
            survey.levels = survey.levels.max(top.levels);
            at = top.end;
        }
        survey.entries = total.entries;
        Ok(survey)
    }

    fn at(&self, index: usize) -> &Counts {
        &self.nodes[index - self.start]
    }

    /// End of the subtree at `index`, exclusive.
    pub fn end(&self, index: usize) -> usize {
        self.at(index).end
    }

    /// The children of the node at `index`.
    pub fn children(&self, index: usize) -> impl Iterator<Item = usize> + Clone {
        let end = self.end(index);
        let next = move |at: &usize| Some(self.end(*at)).filter(|at| *at < end);
        std::iter::successors(Some(index + 1).filter(|at| *at < end), next)
    }

    /// Whether the recursion may be too deep for the stack of a thread of usual size.
    pub fn is_deep(&self) -> bool {
        self.levels > MOST_ON_ANY_STACK
    }

    /// A sufficient stack for the recursion, in bytes.
    pub fn stack_bytes(&self) -> usize {
        LEAST_STACK + self.levels * STACK_PER_LEVEL
    }

    /// Whether the subtree at `index` is hidden or certainly empty.
    pub fn is_nothing(&self, index: usize) -> bool {
        self.at(index).entries == 0
    }

    /// Whether the group at `index` only holds lights, cameras and meshes, and so is not an operand.
    pub fn is_folder(&self, index: usize) -> bool {
        !self.at(index).has_object && self.at(index).has_non_field
    }

    /// Sets the end of each subtree, and which nodes are thickened from above.
    fn nest(&mut self, scene: &Scene, range: &Range<usize>) {
        let depths = scene.depths();
        for index in range.clone().rev() {
            let mut end = index + 1;
            while end < range.end && depths[end] > depths[index] {
                end = self.end(end);
            }
            self.nodes[index - self.start].end = end;
        }
        let mut open: Vec<usize> = Vec::new();
        for index in range.clone() {
            while open.last().is_some_and(|parent| self.end(*parent) <= index) {
                open.pop();
            }
            let above = open.last().is_some_and(|parent| self.at(*parent).is_thickened);
            let own = || active(&scene.nodes()[index]).any(Modifier::thickens);
            self.nodes[index - self.start].is_thickened = above || own();
            if self.end(index) > index + 1 {
                open.push(index);
            }
        }
    }

    /// Counts the node at `index`; its descendants are counted already.
    fn count(&mut self, scene: &Scene, index: usize) {
        let node = &scene.nodes()[index];
        let mut counts = Counts { steps: 1, levels: 1, ..*self.at(index) };
        match &node.kind {
            NodeKind::Object(object) => {
                counts.has_object = true;
                counts.entries = usize::from(!is_nothing(object, counts.is_thickened));
            }
            NodeKind::Mesh(_) | NodeKind::Light(_) | NodeKind::Camera(_) => counts.has_non_field = true,
            NodeKind::Group(_) | NodeKind::Instancer(_) => {
                for child in self.children(index) {
                    let child = self.at(child);
                    counts.has_object |= child.has_object;
                    counts.has_non_field |= child.has_non_field;
                    counts.entries = counts.entries.saturating_add(child.entries);
                    counts.steps = counts.steps.saturating_add(child.steps);
                    counts.levels = counts.levels.max(1 + child.levels);
                    counts.deformed = counts.deformed.max(child.deformed);
                }
            }
        }
        if !node.visible {
            counts.entries = 0;
        }
        if matches!(node.kind, NodeKind::Instancer(_)) {
            // No operand; its types are flattened on their own, as deep as they are.
            (counts.has_object, counts.has_non_field, counts.entries) = (false, true, 0);
        } else if counts.entries == 0 {
            // Flattening passes it by.
            (counts.steps, counts.levels, counts.deformed) = (1, 1, 0);
        } else {
            active(node).for_each(|modifier| counts.modify(modifier));
        }
        self.nodes[index - self.start] = counts;
    }

    fn check(&self, node: &Node, index: usize, limits: &FlattenLimits) -> Result<(), FlattenError> {
        let counts = self.at(index);
        within(node, LEVELS, counts.levels, MAX_FLAT_LEVELS)?;
        within(node, STACK, counts.deformed, MAX_STACK as usize)?;
        within(node, ENTRIES, counts.entries, limits.entries)?;
        within(node, STEPS, counts.steps, limits.steps)
    }
}

impl Counts {
    /// Adds what a modifier takes to the counts of its content.
    fn modify(&mut self, modifier: &Modifier) {
        let copies = match modifier {
            Modifier::Mirror { axes, .. } => {
                let axes = axes.iter().filter(|on| **on).count();
                self.levels += axes;
                1 << axes
            }
            Modifier::Polar { count, .. } => *count as usize,
            _ => {
                self.entries = self.entries.saturating_add(1);
                self.deformed += 1;
                1
            }
        };
        self.levels += 1;
        self.entries = self.entries.saturating_mul(copies);
        self.steps = self.steps.saturating_mul(copies).saturating_add(copies);
    }
}

/// Whether an object is certainly empty, see [`isolith_scene::EmptyOperandResult`].
fn is_nothing(object: &Object, is_thickened: bool) -> bool {
    match &object.shape {
        Shape::Text { text, .. } => text.chars().all(char::is_whitespace),
        shape => !is_thickened && !shape.kind().has_data() && Shape::is_point(&shape.bounds()),
    }
}

fn within(node: &Node, what: &'static str, value: usize, limit: usize) -> Result<(), FlattenError> {
    if value > limit { Err(FlattenError::new(node, what, value, limit)) } else { Ok(()) }
}
