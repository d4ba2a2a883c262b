//! A drag of a handle: the pointer's way becomes a value, the value becomes the node.

use glam::{DAffine3, DVec3};

use super::grip::{Grip, Pointing};
use super::value_handle::{HandleKey, HandleSet, HandleTarget, ValueHandle};
use crate::edit_session::EditSession;
use crate::numbers::number_text;
use crate::steps::{rounded, rounded_point};
use isolith_geometry::Ray;
use isolith_scene::{List, Node, ParamValue};

/// How a drag follows the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// A tenth as far.
    pub precise: bool,
    /// The step of lengths in meters, 0 for none.
    pub snap: f64,
    /// The step of angles in degrees, 0 for none.
    pub angle_snap: f64,
    /// Both ends of a length, rather than one.
    pub both: bool,
    /// The length of what a pixel can tell apart, in meters.
    pub finest: f64,
}

/// A drag of a handle in progress.
pub struct ValueDrag {
    handle: ValueHandle,
    /// The node at the start.
    node: Node,
    world_from_local: DAffine3,
    /// What the pointer stood for last.
    last: DVec3,
    /// The way so far.
    way: DVec3,
    /// The node now.
    changed: Option<Node>,
    /// The name and the value, for the tag beside the handle.
    pub text: String,
}

impl ValueDrag {
    /// Starts a drag of a handle of the set with the ray of the pointer.
    pub fn begin(
        session: &EditSession,
        set: &HandleSet,
        handle: &ValueHandle,
        (ray, forward): (&Ray, DVec3),
    ) -> Option<Self> {
        let node = Node::clone(session.document.scene().node(set.node)?);
        let mut drag = Self {
            handle: handle.clone(),
            node,
            world_from_local: set.world_from_local,
            last: DVec3::ZERO,
            way: DVec3::ZERO,
            changed: None,
            text: String::new(),
        };
        drag.last = drag.pointed(ray, forward)?;
        if let (HandleTarget::NewRow(before), Grip::Place { at, .. }) = (handle.target, handle.grip) {
            let row = handle.key.row;
            drag.node = with_new_point(&drag.node, handle, before, at)?;
            drag.handle.target = HandleTarget::Row(before);
            drag.handle.key = HandleKey::of_point(row, before);
            drag.handle.label = format!("Point {}", before + 1);
            drag.changed = Some(drag.node.clone());
        }
        Some(drag)
    }

    /// The dragged handle.
    pub fn key(&self) -> HandleKey {
        self.handle.key
    }

    /// What the ray stands for: a number in X, or a place.
    fn pointed(&self, ray: &Ray, forward: DVec3) -> Option<DVec3> {
        let pointing = Pointing { ray, forward, world_from_local: &self.world_from_local };
        let number = || self.handle.grip.value(&pointing).map(|value| DVec3::X * value);
        self.handle.grip.place(&pointing).or_else(number)
    }

    /// Follows the pointer.
    pub fn follow(&mut self, ray: &Ray, forward: DVec3, pace: Pace) {
        let Some(now) = self.pointed(ray, forward) else { return };
        let mut step = now - self.last;
        if let Grip::Arc { factor, .. } = self.handle.grip {
            let turn = 360.0 / factor;
            step.x -= (step.x / turn).round() * turn;
        }
        self.way += step * if pace.precise { 0.1 } else { 1.0 };
        self.last = now;
        let changed = match self.handle.target {
            HandleTarget::Number => self.with_number(self.way.x, pace).map(|(node, value)| (node, self.told(value))),
            HandleTarget::Side(direction, share) => {
                // The opposite end stays where it is: half of the way lengthens, half of it moves the middle.
                let way = if pace.both { self.way.x } else { 0.5 * self.way.x };
                self.with_number(way, pace).map(|(node, value)| {
                    let shift = if pace.both { 0.0 } else { (value - self.handle.value) * share };
                    (shifted(node, direction * shift), self.told(value))
                })
            }
            HandleTarget::Place | HandleTarget::Row(_) | HandleTarget::NewRow(_) => self.with_place(pace),
        };
        if let Some((node, text)) = changed {
            (self.changed, self.text) = (Some(node), text);
        }
    }

    fn told(&self, value: f64) -> String {
        format!("{} {}", self.handle.label, with_unit(value, self.handle.param.limits.unit))
    }

    fn with_number(&self, way: f64, pace: Pace) -> Option<(Node, f64)> {
        let (step, finest) = match self.handle.grip {
            Grip::Arc { .. } => (pace.angle_snap, 0.1),
            Grip::Line { direction, factor, .. } => {
                let meters = self.world_from_local.transform_vector3(direction).length() * factor;
                (pace.snap, pace.finest / meters.clamp(1e-6, 1e6))
            }
            Grip::Place { .. } => return None,
        };
        let finest = 10.0_f64.powf(finest.log10().round());
        let [low, high] = self.handle.range;
        let is_count = matches!(self.handle.path.get_in(&self.node), Some(ParamValue::Count(_)));
        let step = if step > 0.0 { step } else { finest };
        let value = rounded(self.handle.value + way, if is_count { 1.0 } else { step });
        let value = value.clamp(low, high.max(low));
        let mut node = self.node.clone();
        let new = if is_count { ParamValue::Count(value as u32) } else { ParamValue::Scalar(value) };
        self.handle.path.set_in(&mut node, new).then_some((node, value))
    }

    fn with_place(&self, pace: Pace) -> Option<(Node, String)> {
        let Grip::Place { at, flat } = self.handle.grip else { return None };
        let place = at + self.way - self.handle.base;
        let place = rounded_point(place, if pace.snap > 0.0 { pace.snap } else { pace.finest });
        let mut node = self.node.clone();
        let value = match self.handle.target {
            HandleTarget::Row(index) => {
                let ParamValue::List(mut list) = self.handle.path.get_in(&node)? else { return None };
                let [x, y, z] = place.to_array();
                let row = list.rows.get_mut(index)?;
                *row = if flat { [x, y, row[2], row[3]] } else { [x, y, z, row[3]] };
                ParamValue::List(list)
            }
            _ => ParamValue::Vector(place),
        };
        let [x, y, z] = place.to_array().map(number_text);
        let depth = if flat { String::new() } else { format!(", {z}") };
        let text = format!("{} {x}, {y}{depth} m", self.handle.label);
        self.handle.path.set_in(&mut node, value).then_some((node, text))
    }

    /// Changes the node.
    pub fn apply(&self, session: &mut EditSession, widget: egui::Id) {
        if let Some(changed) = &self.changed {
            session.change(widget, &[self.node.id], |node| {
                (node.kind, node.transform) = (changed.kind.clone(), changed.transform);
            });
        }
    }
}

/// The node moved within its own space.
fn shifted(mut node: Node, by: DVec3) -> Node {
    node.transform.translation += node.transform.to_affine().matrix3 * by;
    node
}

/// A number with its unit.
pub fn with_unit(value: f64, unit: &str) -> String {
    let space = if unit.is_empty() || unit == "°" { "" } else { " " };
    format!("{}{space}{unit}", number_text(value))
}

/// The node with a point more, at a place of its own space; `None` if the list is full.
pub fn with_new_point(node: &Node, handle: &ValueHandle, before: usize, at: DVec3) -> Option<Node> {
    let at = at - handle.base;
    with_list(node, handle, |list| {
        let behind = list.rows.get(before.checked_sub(1)?)?;
        let ahead = list.rows.get(before).or(list.rows.first())?;
        let radius = 0.5 * (behind[3] + ahead[3]);
        let row = if list.columns.len() > 2 { [at.x, at.y, at.z, radius] } else { [at.x, at.y, 0.0, 0.0] };
        (list.rows.len() < list.count[1]).then(|| list.rows.insert(before, row))
    })
}

/// The node without a point; `None` if the list needs it.
pub fn without_point(node: &Node, handle: &ValueHandle, index: usize) -> Option<Node> {
    with_list(node, handle, |list| {
        if list.rows.len() <= list.count[0] || index >= list.rows.len() {
            return None;
        }
        list.rows.remove(index);
        Some(())
    })
}

fn with_list(node: &Node, handle: &ValueHandle, change: impl FnOnce(&mut List) -> Option<()>) -> Option<Node> {
    let ParamValue::List(mut list) = handle.path.get_in(node)? else { return None };
    change(&mut list)?;
    let mut node = node.clone();
    handle.path.set_in(&mut node, ParamValue::List(list)).then_some(node)
}
