//! The nodes at the start of a transform, and the effect of a motion of the world on them.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::kinds::PivotPoint;
use crate::edit_session::EditSession;
use crate::selection;
use crate::steps::rounded_point;
use isolith_geometry::Transform;
use isolith_scene::limits::SCALE;
use isolith_scene::{BlendOverride, Node, NodeId, NodeKind, RadiusUnit};

/// A motion of the world around a pivot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SelectionMotion {
    /// By an offset.
    Offset(DVec3),
    /// Around an axis, a unit vector, by an angle in degrees.
    Turn(DVec3, f64),
    /// By a factor along each of the axes.
    Stretch(DVec3),
    /// Turned around the pivot, and then moved by an offset: onto a surface.
    Onto(DQuat, DVec3),
}

/// A transform that has ended, to be repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LastMotion {
    /// What was done.
    pub motion: SelectionMotion,
    /// The axes of a stretch.
    pub axes: DMat3,
    /// The pivot, in the world.
    pub pivot: DVec3,
    /// Each node had its own pivot.
    pub is_individual: bool,
}

/// A node's placement at the start.
struct Start {
    id: NodeId,
    transform: Transform,
    world_from_parent: DAffine3,
}

/// The selected nodes at the start, and the blends below them.
pub struct Starts {
    nodes: Vec<Start>,
    /// Nodes with lengths in meters that the transform does not scale.
    blends: Vec<Node>,
    /// The pivot in the world.
    pub pivot: DVec3,
    /// Each node turns and scales around its own origin.
    pub is_individual: bool,
}

/// The pivot of the selection in the world; `None` if no node can move.
pub fn pivot_of(session: &EditSession, point: PivotPoint) -> Option<DVec3> {
    let scene = session.document.scene();
    let ids: Vec<_> =
        selection::roots(session).into_iter().filter(|id| selection::holder_of_lock(scene, *id).is_none()).collect();
    let place = |id: NodeId| scene.world_from_local(id).translation;
    if ids.is_empty() {
        return None;
    }
    match point {
        PivotPoint::World => Some(DVec3::ZERO),
        PivotPoint::Active => session.document.selection().last().map(|id| place(*id)),
        PivotPoint::Median | PivotPoint::Individual => {
            Some(ids.iter().map(|id| place(*id)).sum::<DVec3>() / ids.len() as f64)
        }
    }
}

impl Starts {
    /// The selected nodes that are not locked; `None` if there are none.
    pub fn new(session: &EditSession, point: PivotPoint) -> Option<Self> {
        let scene = session.document.scene();
        let ids: Vec<NodeId> = selection::roots(session)
            .into_iter()
            .filter(|id| selection::holder_of_lock(scene, *id).is_none())
            .collect();
        let start = |id: &NodeId| {
            let node = scene.node(*id)?;
            let world_from_parent = node.parent.map_or(DAffine3::IDENTITY, |parent| scene.world_from_local(parent));
            Some(Start { id: *id, transform: node.transform, world_from_parent })
        };
        let nodes: Vec<Start> = ids.iter().filter_map(start).collect();
        if nodes.is_empty() {
            return None;
        }
        let pivot = pivot_of(session, point)?;
        let mut blends = Vec::new();
        for id in &ids {
            let below = scene.index_of(*id).map_or(0..0, |index| scene.subtree(index));
            blends.extend(scene.nodes()[below].iter().filter(|node| has_lengths(node)).map(|node| Node::clone(node)));
        }
        Some(Self { nodes, blends, pivot, is_individual: point == PivotPoint::Individual })
    }

    /// The ids of the nodes.
    pub fn ids(&self) -> Vec<NodeId> {
        self.nodes.iter().map(|start| start.id).collect()
    }

    /// Applies a motion. `axes` are those of a stretch; `finest` is the length of what a pixel can tell apart.
    pub fn apply(
        &self,
        session: &mut EditSession,
        widget: egui::Id,
        motion: SelectionMotion,
        axes: &DMat3,
        finest: f64,
    ) {
        for start in &self.nodes {
            let moved = self.moved(start, motion, axes, finest);
            if moved.translation.is_finite() && moved.rotation.is_finite() && moved.scale.is_finite() {
                session.change(widget, &[start.id], |node| node.transform = moved);
            }
        }
        if let SelectionMotion::Stretch(factors) = motion {
            let factor = (factors.x * factors.y * factors.z).abs().cbrt();
            for blend in &self.blends {
                session.change(widget, &[blend.id], |node| scale_lengths(node, blend, factor));
            }
        }
    }

    fn moved(&self, start: &Start, motion: SelectionMotion, axes: &DMat3, finest: f64) -> Transform {
        let Transform { translation, rotation, scale } = start.transform;
        let parent_from_world = start.world_from_parent.inverse();
        let place = start.world_from_parent.transform_point3(translation);
        let linear = match motion {
            SelectionMotion::Offset(_) => DMat3::IDENTITY,
            SelectionMotion::Turn(axis, degrees) => DMat3::from_axis_angle(axis, degrees.to_radians()),
            SelectionMotion::Stretch(factors) => *axes * DMat3::from_diagonal(factors) * axes.transpose(),
            SelectionMotion::Onto(turn, _) => DMat3::from_quat(turn),
        };
        let pivot = if self.is_individual { place } else { self.pivot };
        let target = match motion {
            SelectionMotion::Offset(offset) => place + offset,
            SelectionMotion::Onto(_, offset) => self.pivot + linear * (place - self.pivot) + offset,
            _ => pivot + linear * (place - pivot),
        };
        // A node at the pivot stays there to the bit. Elsewhere a cleaner number costs no more than a fraction of what
        // can be seen.
        let translation = match target == place {
            true => translation,
            false => rounded_point(parent_from_world.transform_point3(target), finest * 1e-3),
        };
        match motion {
            SelectionMotion::Offset(_) => Transform { translation, ..start.transform },
            SelectionMotion::Onto(turn, _) if turn == DQuat::IDENTITY => Transform { translation, ..start.transform },
            SelectionMotion::Turn(..) | SelectionMotion::Onto(..) => {
                let in_parent = parent_from_world.matrix3 * linear * start.world_from_parent.matrix3;
                Transform { translation, rotation: (turn_of(&in_parent) * rotation).normalize(), scale }
            }
            SelectionMotion::Stretch(_) => {
                let world_from_node = start.world_from_parent.matrix3 * DMat3::from_quat(rotation);
                let factor = |axis: usize| {
                    let direction = world_from_node.col(axis).normalize_or(DVec3::AXES[axis]);
                    let stretched = linear * direction;
                    stretched.length().copysign(stretched.dot(direction))
                };
                Transform { translation, rotation, scale: within(scale * DVec3::from([0, 1, 2].map(factor))) }
            }
        }
    }
}

/// The scale within its limits, and without the last digits that come from rounding.
fn within(scale: DVec3) -> DVec3 {
    let [least, most] = SCALE.hard;
    DVec3::from(scale.to_array().map(|v| {
        let digits = 10.0_f64.powf(9.0 - v.abs().max(1e-9).log10().ceil());
        let short = (v * digits).round() / digits;
        short.abs().clamp(least, most).copysign(v)
    }))
}

/// The rotation nearest to a linear map, by Gram-Schmidt.
pub fn turn_of(m: &DMat3) -> DQuat {
    let x = m.x_axis.normalize_or(DVec3::X);
    let y = (m.y_axis - x * x.dot(m.y_axis)).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)))
}

fn has_lengths(node: &Node) -> bool {
    match node.kind {
        NodeKind::Group(group) => {
            group.operator.has_width()
                || group.operator.has_depth()
                || (group.blend.unit == RadiusUnit::Meters && group.blend.radius > 0.0)
        }
        _ => false,
    }
}

/// Scales the lengths of a group that its transform leaves alone.
fn scale_lengths(node: &mut Node, start: &Node, factor: f64) {
    if let (NodeKind::Group(group), NodeKind::Group(was)) = (&mut node.kind, &start.kind) {
        if was.blend.unit == RadiusUnit::Meters {
            group.blend.radius = short(was.blend.radius * factor);
        }
        (group.width, group.depth) = (short(was.width * factor), short(was.depth * factor));
    }
    if let BlendOverride::Radius(radius) = start.blend_override {
        node.blend_override = BlendOverride::Radius(short(radius * factor));
    }
}

fn short(length: f64) -> f64 {
    let digits = 10.0_f64.powf(9.0 - length.abs().max(1e-9).log10().ceil());
    (length * digits).round() / digits
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_document::Document;
    use isolith_scene::{Blend, BlendKernel, Group, Operator, Scene};

    /// A group, turned and scaled, with an empty group in it.
    fn session() -> (EditSession, [NodeId; 2]) {
        let mut scene = Scene::new();
        let blend = Blend::new(BlendKernel::Circular, 0.2);
        let group = Node::new("Outer", NodeKind::Group(Group::new(Operator::Union, blend)))
            .at(DVec3::new(1.0, 2.0, 3.0))
            .rotated(DQuat::from_rotation_y(0.7))
            .scaled(DVec3::splat(2.0));
        let outer = scene.insert(None, 0, group).unwrap();
        let inner = Node::new("Inner", NodeKind::Group(Group::UNION)).at(DVec3::X).rotated(DQuat::from_rotation_z(0.3));
        let inner = scene.insert(Some(outer), 0, inner).unwrap();
        (EditSession::new(Document::new(scene)), [outer, inner])
    }

    fn moved(motion: SelectionMotion, chosen: usize) -> (DAffine3, DAffine3, EditSession) {
        let (mut session, ids) = session();
        session.document.select(vec![ids[chosen]]);
        let before = session.document.scene().world_from_local(ids[chosen]);
        let starts = Starts::new(&session, PivotPoint::Median).unwrap();
        starts.apply(&mut session, egui::Id::NULL, motion, &DMat3::IDENTITY, 1e-9);
        let after = session.document.scene().world_from_local(ids[chosen]);
        (before, after, session)
    }

    #[test]
    fn a_node_in_a_turned_and_scaled_group_moves_and_turns_as_in_the_world() {
        let (before, after, _) = moved(SelectionMotion::Offset(DVec3::new(0.5, 0.0, -1.0)), 1);
        assert!((after.translation - before.translation - DVec3::new(0.5, 0.0, -1.0)).length() < 1e-9);
        assert!((after.matrix3 - before.matrix3).abs_diff_eq(DMat3::ZERO, 1e-12));
        let axis = DVec3::new(1.0, 2.0, -1.0).normalize();
        let (before, after, _) = moved(SelectionMotion::Turn(axis, 40.0), 1);
        let wanted = DMat3::from_axis_angle(axis, 40.0_f64.to_radians()) * before.matrix3;
        assert!(after.matrix3.abs_diff_eq(wanted, 1e-9) && after.translation == before.translation);
    }

    #[test]
    fn each_node_turns_around_its_own_origin_or_all_around_one() {
        let mut scene = Scene::new();
        let group = |x: f64| Node::new("G", NodeKind::Group(Group::UNION)).at(DVec3::X * x);
        let ids = [1.0, 3.0].map(|x| scene.insert(None, 0, group(x)).unwrap());
        let turned = |point: PivotPoint| {
            let mut session = EditSession::new(Document::new(scene.clone()));
            session.document.select(ids.to_vec());
            let starts = Starts::new(&session, point).unwrap();
            let motion = SelectionMotion::Turn(DVec3::Y, 180.0);
            starts.apply(&mut session, egui::Id::NULL, motion, &DMat3::IDENTITY, 1e-6);
            ids.map(|id| session.document.scene().node(id).unwrap().transform.translation.x)
        };
        assert_eq!(turned(PivotPoint::Median), [3.0, 1.0]);
        assert_eq!(turned(PivotPoint::Individual), [1.0, 3.0]);
        assert_eq!(turned(PivotPoint::Active), [5.0, 3.0], "the last one is the active one");
        assert_eq!(turned(PivotPoint::World), [-1.0, -3.0]);
    }

    #[test]
    fn scaling_a_group_scales_its_blends() {
        let (before, after, session) = moved(SelectionMotion::Stretch(DVec3::splat(1.5)), 0);
        assert!(after.matrix3.abs_diff_eq(before.matrix3 * 1.5, 1e-9));
        let radius = |node: &Node| match node.kind {
            NodeKind::Group(group) => group.blend.radius,
            _ => panic!("a group"),
        };
        assert_eq!(radius(&session.document.scene().nodes()[0]), 0.3);
        let (.., session) = moved(SelectionMotion::Turn(DVec3::Y, 10.0), 0);
        assert_eq!(radius(&session.document.scene().nodes()[0]), 0.2);
    }

    #[test]
    fn a_stretch_along_an_axis_changes_the_axes_that_it_meets() {
        let mut scene = Scene::new();
        let node = Node::new("G", NodeKind::Group(Group::UNION)).rotated(DQuat::from_rotation_z(90_f64.to_radians()));
        let id = scene.insert(None, 0, node).unwrap();
        let mut session = EditSession::new(Document::new(scene));
        session.document.select(vec![id]);
        let starts = Starts::new(&session, PivotPoint::Median).unwrap();
        let motion = SelectionMotion::Stretch(DVec3::new(3.0, 1.0, 1.0));
        starts.apply(&mut session, egui::Id::NULL, motion, &DMat3::IDENTITY, 1e-9);
        assert_eq!(session.document.scene().nodes()[0].transform.scale, DVec3::new(1.0, 3.0, 1.0));
        // A mirror image.
        let motion = SelectionMotion::Stretch(DVec3::new(-1.0, 1.0, 1.0));
        starts.apply(&mut session, egui::Id::NULL, motion, &DMat3::IDENTITY, 1e-9);
        assert_eq!(session.document.scene().nodes()[0].transform.scale, DVec3::new(1.0, -1.0, 1.0));
    }
}
