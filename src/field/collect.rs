//! The visible part of a scene as folds of operands in world space, one fold per component.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use glam::{DAffine3, DVec3};

use super::arrays::{MAX_STACK, Warning};
use super::blends::has_own_radius;
use super::budget::{Budget, Cancel, FlattenLimits, STACK, TEXELS};
use super::composition::{apart, begin_with, group_of, polar_copies, size_of_fold, united};
use super::cuts::{self, Cut};
use super::flat_bricks::FlatBricks;
use super::flat_texture::TexturedMaterials;
use super::leaf::leaf;
use super::lower_bound::{LowerBound, fold_bounds};
use super::modifier_reach::read_within;
use super::modify::{MAX_NEIGHBORS, ModifierRefusal, Splines, modify};
use super::operand::{Operand, Value};
use super::prepare::PreparedShape;
use super::survey::{Survey, active};
use isolith_bricks::MAX_BRICK_TEXELS;
use isolith_geometry::singular_values;
use isolith_scene::{Modifier, Node, NodeId, NodeKind, Object, Operation, Operator, Scene};

/// The folds of all components, and the warnings met on the way.
pub(super) struct Components<'a> {
    pub operands: Vec<Vec<Operand<'a>>>,
    pub warnings: Vec<Warning>,
    /// Whether a node at the top is subtracted from the components before it, or keeps a part of them.
    pub has_cuts: bool,
    /// The amounts taken, and the first limit that was hit.
    pub budget: Budget,
}

/// Whether a node at the top is opened: its children are components of their own.
pub(super) fn is_opened(scene: &Scene, node: &Node) -> bool {
    is_plain_group(node) && !scene.children(Some(node.id)).any(has_own_radius)
}

/// The same, as far as the node itself decides it.
fn is_plain_group(node: &Node) -> bool {
    let NodeKind::Group(group) = &node.kind else { return false };
    let is_hard = group.operator == Operator::Union && group.blend.radius == 0.0;
    node.adds() && active(node).next().is_none() && is_hard
}

/// The fold of the component whose outermost node is at `index`; `None` if that node is not exactly one component, or
/// if there are warnings.
pub(super) fn component_of(scene: &Scene, index: usize) -> Option<Vec<Operand<'_>>> {
    let limits = FlattenLimits::default();
    let survey = Survey::new(scene, scene.subtree(index), &limits).ok().filter(|survey| !survey.is_deep())?;
    let node: &Node = &scene.nodes()[index];
    let parent = node.parent.map_or(DAffine3::IDENTITY, |p| scene.world_from_local(p));
    let mut nobody = |_: &Node, _: &DAffine3| {};
    let mut collector = Collector::new(scene, &survey, Budget::new(limits, &Cancel::default()), &mut nobody);
    let Found::Operand(operand) = collector.operand(index, &parent, node) else { return None };
    let mut parts = apart(operand);
    let is_one = parts.len() == 1 && collector.warnings.is_empty() && collector.budget.is_open();
    if is_one { parts.pop().map(begin_with) } else { None }
}

/// Collects the components; lights, meshes and cameras go to `non_field` with their world transform.
pub(super) fn collect<'a>(
    scene: &'a Scene,
    survey: &Survey,
    budget: Budget,
    non_field: &mut dyn FnMut(&'a Node, &DAffine3),
) -> Components<'a> {
    let mut collector = Collector::new(scene, survey, budget, non_field);
    let (mut operands, mut cuts) = (Vec::new(), Vec::new());
    collector.split(0..scene.nodes().len(), DAffine3::IDENTITY, &mut operands, &mut cuts);
    let Collector { warnings, mut budget, .. } = collector;
    let has_cuts = !cuts.is_empty();
    if budget.is_open() {
        cuts::apply(&mut operands, cuts, &mut budget);
    }
    Components { operands, warnings, has_cuts, budget }
}

/// The node at `index` as a type of its instancer: its fold in the space of a copy, `None` if it is empty; with the
/// warnings met on the way.
pub(super) fn type_of<'a>(
    scene: &'a Scene,
    survey: &Survey,
    index: usize,
    budget: Budget,
) -> (Option<Vec<Operand<'a>>>, Vec<Warning>, Budget) {
    let mut ignored: Vec<&Node> = Vec::new();
    let mut non_field = |node: &'a Node, _: &DAffine3| ignored.push(node);
    let mut collector = Collector::new(scene, survey, budget, &mut non_field);
    let node: &'a Node = &scene.nodes()[index];
    let operand = match collector.operand(index, &DAffine3::IDENTITY, node) {
        Found::Operand(operand) => Some(begin_with(operand)),
        Found::LeftOut | Found::Nothing => None,
    };
    let Collector { mut warnings, budget, .. } = collector;
    let reason = "is below a type of an instancer, where only objects and groups are copied";
    warnings.extend(ignored.into_iter().map(|node| Warning {
        node: node.id,
        name: node.name.clone(),
        reason: reason.into(),
    }));
    (operand, warnings, budget)
}

/// What a node contributes to its group.
#[allow(clippy::large_enum_variant, reason = "none is kept, and nearly all are operands")]
pub(super) enum Found<'a> {
    /// No operand: hidden, or without a field.
    LeftOut,
    /// The empty set.
    Nothing,
    /// An operand whose join is not set yet.
    Operand(Operand<'a>),
}

pub(super) struct Collector<'a, 'b> {
    pub scene: &'a Scene,
    pub survey: &'b Survey,
    pub budget: Budget,
    non_field: &'b mut dyn FnMut(&'a Node, &DAffine3),
    warnings: Vec<Warning>,
    /// The warnings again, so that each is given only once.
    warned: HashSet<(NodeId, String)>,
    /// Whether the collector is inside a modifier, whose lights, cameras and meshes are already collected.
    is_muted: bool,
    /// The greatest value of the field from which modifiers around make surfaces, in meters of the space that
    /// transforms lead to.
    read_to: f64,
    /// Prepared shapes with a payload, by the node's index: copies share them, wherever they stand.
    drawn: HashMap<usize, Rc<PreparedShape>>,
    /// The bricks of models so far, for their limit.
    bricks: FlatBricks,
    splines: Splines,
    textured: TexturedMaterials<'a>,
    /// Modifiers that cannot act on their content, by the node's index and the number of modifiers before them.
    refused: HashSet<(usize, usize)>,
}

impl<'a, 'b> Collector<'a, 'b> {
    fn new(
        scene: &'a Scene,
        survey: &'b Survey,
        budget: Budget,
        non_field: &'b mut dyn FnMut(&'a Node, &DAffine3),
    ) -> Self {
        Self {
            scene,
            survey,
            budget,
            non_field,
            warnings: Vec::new(),
            warned: HashSet::new(),
            is_muted: false,
            read_to: 0.0,
            drawn: HashMap::new(),
            bricks: FlatBricks::default(),
            splines: Splines::default(),
            textured: TexturedMaterials::new(scene.materials()),
            refused: HashSet::new(),
        }
    }

    fn is_opened(&self, index: usize) -> bool {
        let nodes = self.scene.nodes();
        is_plain_group(&nodes[index]) && !self.survey.children(index).any(|child| has_own_radius(&nodes[child]))
    }

    /// Splits the children in `range` of a hard union: each becomes a component, and hard unions among them are
    /// opened. A child that subtracts or intersects acts on those before it.
    fn split(
        &mut self,
        range: std::ops::Range<usize>,
        world: DAffine3,
        out: &mut Vec<Vec<Operand<'a>>>,
        cuts: &mut Vec<Cut<'a>>,
    ) {
        let start = out.len();
        let mut at = range.start;
        while at < range.end && self.budget.is_open() {
            let node: &'a Node = &self.scene.nodes()[at];
            let first = at;
            at = self.survey.end(at);
            if !node.visible {
                continue;
            }
            if self.is_opened(first) {
                self.split(first + 1..at, world * node.transform.to_affine(), out, cuts);
                continue;
            }
            let operand = match self.operand(first, &world, node) {
                Found::Operand(operand) => Some(operand),
                Found::Nothing if node.operation == Operation::Intersect => None,
                Found::Nothing | Found::LeftOut => continue,
            };
            if node.adds() {
                out.extend(operand.into_iter().flat_map(apart).map(begin_with));
                continue;
            }
            match &operand {
                Some(_) if out.len() == start => self.warn_nothing_before(node),
                None if out.len() > start => self.warn(node, "is empty, so nothing is left of what it keeps".into()),
                _ => {}
            }
            cuts.push(Cut { from: start..out.len(), operation: node.operation, operand });
        }
    }

    /// What the node at `index` contributes to its group.
    pub fn operand(&mut self, index: usize, parent: &DAffine3, outermost: &'a Node) -> Found<'a> {
        let node: &'a Node = &self.scene.nodes()[index];
        if !node.visible || !self.budget.take_steps(node, 1) {
            return Found::LeftOut;
        }
        let world = *parent * node.transform.to_affine();
        if !node.has_field() || self.survey.is_nothing(index) {
            self.non_fields(index, &world);
            let is_operand = node.has_field() && !self.survey.is_folder(index);
            return if is_operand { Found::Nothing } else { Found::LeftOut };
        }
        let modifiers: Vec<&Modifier> = active(node).collect();
        let operand = if modifiers.is_empty() {
            self.content(index, &world, outermost)
        } else {
            // Lights, cameras and meshes ignore modifiers; collect them once, not once per copy.
            self.non_fields(index, &world);
            let was_muted = std::mem::replace(&mut self.is_muted, true);
            let operand = self.modified(index, &modifiers, &world, outermost);
            self.is_muted = was_muted;
            operand
        };
        operand.map_or(Found::Nothing, Found::Operand)
    }

    /// The node at `index`, an object or a group, without its modifiers; `None` if it is empty.
    fn content(&mut self, index: usize, world: &DAffine3, outermost: &'a Node) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        match &node.kind {
            NodeKind::Object(object) => self.object(index, object, world, outermost),
            NodeKind::Group(group) => {
                let mut fold = self.fold(index, group, world, outermost);
                if fold.len() < 2 {
                    return fold.pop();
                }
                let is_open = self.budget.take_steps(node, fold.len());
                is_open.then(|| Operand { node, outermost, ..group_of(fold) }).filter(|group| self.is_nested(group))
            }
            NodeKind::Instancer(_) | NodeKind::Mesh(_) | NodeKind::Light(_) | NodeKind::Camera(_) => None,
        }
    }

    /// Whether the operand is nested no deeper than evaluators support. Opening it into components removes up to two
    /// levels.
    fn is_nested(&mut self, operand: &Operand<'a>) -> bool {
        self.budget.hold(operand.outermost, STACK, operand.depth.saturating_sub(2) as usize, MAX_STACK as usize)
    }

    fn object(
        &mut self,
        index: usize,
        object: &'a Object,
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        if !self.budget.take_entries(outermost, 1) {
            return None;
        }
        let mut operand = leaf(node, outermost, world, object, self.drawn.get(&index).cloned());
        let Value::Leaf { prepared, object_from_world, .. } = &mut operand.value else {
            unreachable!("made as a leaf")
        };
        if self.textured.is_placed(object.material) {
            *object_from_world = Some(Rc::new(world.inverse()));
        }
        if object.shape.is_blank(&prepared.bounds) {
            return None;
        }
        if prepared.kind.has_data() {
            self.drawn.entry(index).or_insert_with(|| prepared.clone());
        }
        if let Some(bricks) = &prepared.bricks {
            self.bricks.place(bricks);
            if !self.budget.hold(node, TEXELS, self.bricks.texels(), MAX_BRICK_TEXELS) {
                return None;
            }
        }
        self.budget.take_rows(node, prepared.payload.len()).then_some(operand)
    }

    /// Collects the lights, meshes and cameras of the subtree at `index`, whose own world transform is `world`.
    fn non_fields(&mut self, index: usize, world: &DAffine3) {
        if self.is_muted {
            return;
        }
        let scene = self.scene;
        let node: &'a Node = &scene.nodes()[index];
        if !node.has_field() {
            (self.non_field)(node, world);
        }
        let survey = self.survey;
        if matches!(node.kind, NodeKind::Instancer(_)) {
            // Its children are types, not nodes of the scene.
            return;
        }
        for at in survey.children(index) {
            let child: &'a Node = &scene.nodes()[at];
            if child.visible {
                self.non_fields(at, &(*world * child.transform.to_affine()));
            }
        }
    }

    /// The node at `index` with these modifiers, the last one outermost.
    fn modified(
        &mut self,
        index: usize,
        modifiers: &[&'a Modifier],
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        let Some((last, rest)) = modifiers.split_last() else { return self.content(index, world, outermost) };
        let copies = match **last {
            Modifier::Mirror { axes, blend } => {
                let axes: Vec<usize> = (0..3).filter(|i| axes[*i]).collect();
                return self.mirrored(index, rest, world, outermost, &axes, blend);
            }
            Modifier::Polar { count, radius, mirrored } => polar_copies(count, radius, mirrored),
            _ => return self.deformed(index, (last, rest), world, outermost),
        };
        let mut operands = Vec::new();
        for copy in &copies {
            // If one copy is empty, all are.
            operands.push(self.modified(index, rest, &(*world * *copy), outermost)?);
        }
        self.union_of(node, outermost, operands, 0.0)
    }

    /// The node and its mirror images across the planes perpendicular to `axes`.
    fn mirrored(
        &mut self,
        index: usize,
        rest: &[&'a Modifier],
        world: &DAffine3,
        outermost: &'a Node,
        axes: &[usize],
        blend: f64,
    ) -> Option<Operand<'a>> {
        let Some((axis, axes)) = axes.split_last() else { return self.modified(index, rest, world, outermost) };
        let mut flip = DVec3::ONE;
        flip[*axis] = -1.0;
        let mut sides = Vec::new();
        for copy in [DAffine3::IDENTITY, DAffine3::from_scale(flip)] {
            sides.push(self.mirrored(index, rest, &(*world * copy), outermost, axes, blend)?);
        }
        self.union_of(&self.scene.nodes()[index], outermost, sides, blend)
    }

    fn union_of(
        &mut self,
        node: &'a Node,
        outermost: &'a Node,
        copies: Vec<Operand<'a>>,
        radius: f64,
    ) -> Option<Operand<'a>> {
        let (entries, _) = size_of_fold(&copies);
        let union = if self.budget.take_steps(node, entries) { united(node, outermost, copies, radius) } else { None };
        union.filter(|union| self.is_nested(union))
    }

    /// The node under a modifier that stays in the arrays.
    fn deformed(
        &mut self,
        index: usize,
        (last, rest): (&'a Modifier, &[&'a Modifier]),
        world: &DAffine3,
        outermost: &'a Node,
    ) -> Option<Operand<'a>> {
        let node: &'a Node = &self.scene.nodes()[index];
        if self.refused.contains(&(index, rest.len())) {
            return self.modified(index, rest, world, outermost);
        }
        let (least, greatest) = singular_values(&world.matrix3);
        let read_to = if self.read_to > 0.0 { self.read_to / least } else { 0.0 };
        let outside = std::mem::replace(&mut self.read_to, read_within(last, read_to));
        let content = self.modified(index, rest, &DAffine3::IDENTITY, outermost);
        self.read_to = outside;
        let content = begin_with(content?);
        let lower_bound = fold_bounds(&content);
        if lower_bound.bounds.is_empty() || !self.budget.take_entries(outermost, 1) {
            return None;
        }
        let modified = match modify(last, &lower_bound, read_to, &mut self.splines) {
            Ok(modified) => modified,
            Err(ModifierRefusal::Cannot(reason)) => {
                self.warn(node, reason);
                // Whether it can act does not depend on where a copy stands: later copies do not collect the content
                // twice.
                self.refused.insert((index, rest.len()));
                return self.modified(index, rest, world, outermost);
            }
            Err(ModifierRefusal::TooMany(copies)) => {
                let what = "the number of copies that reach into each other and are evaluated at once";
                self.budget.hit(node, what, copies, MAX_NEIGHBORS as usize);
                return None;
            }
        };
        if !self.budget.take_rows(node, modified.data.len()) {
            return None;
        }
        if let Some(warning) = &modified.warning {
            self.warn(node, warning.clone());
        }
        let cull_box = modified.cull_box.transformed(world);
        let bounds = modified.bounds.transformed(world);
        let bound_slope = if cull_box.is_finite() { modified.bound_slope * least / greatest } else { 0.0 };
        let value = Value::Modified {
            local_from_world: world.inverse(),
            distance_scale: least,
            kind: last.kind(),
            modified,
            content: Rc::new(content),
        };
        let operand = Operand::first(node, outermost, LowerBound::new(bounds, cull_box, bound_slope), value);
        self.is_nested(&operand).then_some(operand)
    }

    pub fn warn(&mut self, node: &Node, reason: String) {
        // Copies would repeat the warning.
        if self.warned.insert((node.id, reason.clone())) {
            self.warnings.push(Warning { node: node.id, name: node.name.clone(), reason });
        }
    }

    pub fn warn_nothing_before(&mut self, node: &Node) {
        let reason = match node.operation {
            Operation::Intersect => {
                "intersects, but nothing stands before it in its group of which it could keep a part"
            }
            _ => "is subtracted, but nothing stands before it in its group that it could be cut from",
        };
        self.warn(node, reason.into());
    }
}
