//! The handles of the selected node on the screen.

use egui::{Pos2, Rect};
use glam::{DAffine3, DVec3};

use super::grip::Grip;
use super::guides;
use super::kind_rows::{mask_rows, rows_of};
use super::measures::Measures;
use super::rows::{HandleRow, Pull};
use crate::bounds;
use crate::projection::Projection;
use crate::selection::holder_of_lock;
use crate::state::EditorState;
use crate::transforms::kinds::Tool;
use isolith_geometry::Aabb;
use isolith_scene::{
    List, Node, NodeId, NodeKind, Param, ParamPath, ParamValue, Part, RadiusUnit, Shape, profile_curve, tube_curve,
};

/// Length of the reach in points of the screen.
const REACH: f64 = 90.0;
/// A handle whose movement looks shorter than this is not shown, in points for a movement over the reach.
const SHORTEST: f32 = 12.0;
/// Pick radius in points.
const GRAB: f32 = 8.0;

/// What a handle changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandleTarget {
    /// A number.
    Number,
    /// A length, at one of its ends: the direction of that end, and the share of the length on each side.
    Side(DVec3, f64),
    /// A point.
    Place,
    /// A point of a list.
    Row(usize),
    /// A new point of a list, before the one of this index.
    NewRow(usize),
}

/// Names a handle among those of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HandleKey {
    /// The row of the table.
    pub row: usize,
    /// Which of the handles of the row.
    pub part: usize,
}

impl HandleKey {
    /// The handle of a point of a list.
    pub fn of_point(row: usize, index: usize) -> Self {
        Self { row, part: 2 * index }
    }
}

/// A handle on the screen.
#[derive(Clone, Debug)]
pub struct ValueHandle {
    /// Its name among those of the node.
    pub key: HandleKey,
    /// The name of what it changes.
    pub label: String,
    /// The parameter.
    pub path: ParamPath,
    /// The description of the parameter.
    pub param: &'static Param,
    /// What it changes.
    pub target: HandleTarget,
    /// How it moves.
    pub grip: Grip,
    /// The number, for those that change one.
    pub value: f64,
    /// The least and the greatest number.
    pub range: [f64; 2],
    /// The first column's position where it is 0, for points of a list.
    pub base: DVec3,
    /// Its position in points.
    pub at: Pos2,
    /// Where the number is 0.
    pub foot: Option<Pos2>,
}

/// The handles of a node.
pub struct HandleSet {
    /// The node.
    pub node: NodeId,
    /// Its transform.
    pub world_from_local: DAffine3,
    /// The handles.
    pub handles: Vec<ValueHandle>,
    /// Lines that show what the handles change.
    pub guides: Vec<Vec<Pos2>>,
}

impl HandleSet {
    /// The handles of the selected node, if there is only one and it can be changed.
    pub fn new(state: &EditorState, projection: &Projection) -> Option<Self> {
        let scene = state.session.document.scene();
        let [id] = state.session.document.selection() else { return None };
        let node = scene.node(*id).filter(|node| node.visible && holder_of_lock(scene, node.id).is_none())?;
        // The next shape often begins where the last one has its handles.
        if state.view.tool == Tool::Draw && matches!(node.kind, NodeKind::Object(_)) {
            return None;
        }
        let world_from_local = scene.world_from_local(*id);
        if !world_from_local.is_finite() || world_from_local.matrix3.determinant() == 0.0 {
            return None;
        }
        let (part, rows) = rows_of(node);
        let m = measures(state, projection, node, part, &world_from_local);
        let mut set = Self { node: *id, world_from_local, handles: Vec::new(), guides: Vec::new() };
        for (index, row) in rows.iter().enumerate() {
            set.add_row(projection, &m, index, row);
        }
        // The handles of each mask are named by rows of their own.
        let mut first = rows.len();
        for (part, rows) in mask_rows(node) {
            let m = measures(state, projection, node, part, &world_from_local);
            for (index, row) in rows.iter().enumerate() {
                set.add_row(projection, &m, first + index, row);
            }
            first += rows.len();
        }
        let on_screen = |p: &DVec3| projection.to_screen(world_from_local.transform_point3(*p));
        set.guides = guides::lines(&m).iter().map(|line| line.iter().filter_map(on_screen).collect()).collect();
        Some(set)
    }

    /// The handle at a position of the screen.
    pub fn at(&self, pointer: Pos2) -> Option<&ValueHandle> {
        let nearest = self.handles.iter().min_by(|a, b| a.at.distance(pointer).total_cmp(&b.at.distance(pointer)));
        nearest.filter(|handle| handle.at.distance(pointer) <= GRAB)
    }

    /// The handle of this name.
    pub fn get(&self, key: HandleKey) -> Option<&ValueHandle> {
        self.handles.iter().find(|handle| handle.key == key)
    }

    fn add_row(&mut self, projection: &Projection, m: &Measures<'_>, index: usize, row: &HandleRow) {
        let Some(params) = m.params() else { return };
        let (Some(param), Some(value)) = (params.find(row.param), params.get(row.param)) else { return };
        let path = ParamPath { element: row.element, ..ParamPath::of_node(self.node, m.part, row.param) };
        let hard = param.limits.hard;
        let range = [hard[0].max((row.least)(m)), hard[1].min((row.most)(m))];
        for Placed { part, suffix, target, grip, value, base } in placed(m, row, &value) {
            let value = value.clamp(range[0], range[1].max(range[0]));
            let Some((at, foot)) = on_screen(&grip, value, projection, &self.world_from_local, m.reach) else {
                continue;
            };
            let key = HandleKey { row: index, part };
            let axis = row.element.map_or(String::new(), |axis| format!(" {}", ["X", "Y", "Z"][axis.min(2)]));
            let label = match target {
                HandleTarget::Row(point) => format!("Point {}", point + 1),
                HandleTarget::NewRow(before) => format!("New point {}", before + 1),
                _ if matches!(m.part, Part::Mask(_)) => format!("{} (mask)", param.label),
                _ => format!("{}{axis}{suffix}", param.label),
            };
            let path = path.clone();
            self.handles.push(ValueHandle { key, label, path, param, target, grip, value, range, base, at, foot });
        }
    }
}

/// A handle in the space of the node.
struct Placed {
    part: usize,
    suffix: &'static str,
    target: HandleTarget,
    grip: Grip,
    value: f64,
    base: DVec3,
}

impl Placed {
    fn new(part: usize, target: HandleTarget, grip: Grip, value: f64) -> Self {
        Self { part, suffix: "", target, grip, value, base: DVec3::ZERO }
    }
}

/// The handles of a row.
fn placed(m: &Measures<'_>, row: &HandleRow, value: &ParamValue) -> Vec<Placed> {
    let number = match (value, row.element) {
        (ParamValue::Vector(v), Some(axis)) => v[axis.min(2)],
        (ParamValue::Counts(n), Some(axis)) => f64::from(n[axis.min(2)]),
        (ParamValue::Scalar(v), _) => *v,
        _ => 0.0,
    };
    match (row.pull, value) {
        (Pull::Extent { axis, share, base, sides }, _) => {
            let end = |(part, side): (usize, &f64)| {
                let direction = DVec3::AXES[axis] * *side;
                let grip = Grip::Line { origin: base(m), direction, factor: share };
                let suffix = if *side > 0.0 || sides.len() == 1 { "" } else { ", other side" };
                Placed { suffix, ..Placed::new(part, HandleTarget::Side(direction, share), grip, number) }
            };
            sides.iter().enumerate().map(end).collect()
        }
        (Pull::Along { origin, direction, factor }, _) => {
            let factor = Some(factor(m)).filter(|factor| factor.is_finite() && *factor > 0.0).unwrap_or(1.0);
            let grip = Grip::Line { origin: origin(m), direction: direction(m), factor };
            vec![Placed::new(0, HandleTarget::Number, grip, number)]
        }
        (Pull::Angle { center, zero, quarter, radius, factor }, _) => {
            let radius = radius(m).max(1e-9);
            let grip = Grip::Arc { center: center(m), zero: zero(m), quarter: quarter(m), radius, factor };
            vec![Placed::new(0, HandleTarget::Number, grip, number)]
        }
        (Pull::Point, ParamValue::Vector(at)) => {
            vec![Placed::new(0, HandleTarget::Place, Grip::Place { at: *at, flat: false }, 0.0)]
        }
        (Pull::List { flat, base }, ParamValue::List(list)) => {
            let base = base(m);
            let point = |(part, target, at)| Placed {
                base,
                ..Placed::new(part, target, Grip::Place { at: at + base, flat }, 0.0)
            };
            points(m, list).into_iter().map(point).collect()
        }
        (Pull::Point | Pull::List { .. }, _) => Vec::new(),
    }
}

/// The positions of a handle and of its 0; `None` if it is behind the eye or moves toward it.
fn on_screen(
    grip: &Grip,
    value: f64,
    projection: &Projection,
    world_from_local: &DAffine3,
    reach: f64,
) -> Option<(Pos2, Option<Pos2>)> {
    let seen = |p: DVec3| projection.to_screen(world_from_local.transform_point3(p));
    let local = grip.position(value);
    let at = seen(local).filter(|_| local.is_finite())?;
    match *grip {
        Grip::Line { origin, direction, .. } => {
            let beside = seen(local + direction * reach)?;
            (beside.distance(at) >= SHORTEST).then_some((at, seen(origin)))
        }
        Grip::Arc { center, zero, quarter, radius, .. } => {
            let middle = seen(center)?;
            let [a, b] = [seen(center + zero * radius)? - middle, seen(center + quarter * radius)? - middle];
            // A circle seen from its edge cannot be followed.
            let area = a.x * b.y - a.y * b.x;
            (area.abs() > 0.1 * a.length() * b.length()).then_some((at, Some(middle)))
        }
        Grip::Place { .. } => Some((at, None)),
    }
}

/// The points of a list, and the places for new ones half-way on the curve between them.
fn points(m: &Measures<'_>, list: &List) -> Vec<(usize, HandleTarget, DVec3)> {
    let place = |row: &[f64; 4]| {
        if list.columns.len() > 2 { DVec3::new(row[0], row[1], row[2]) } else { DVec3::new(row[0], row[1], 0.0) }
    };
    let mut all: Vec<_> =
        list.rows.iter().enumerate().map(|(i, row)| (2 * i, HandleTarget::Row(i), place(row))).collect();
    if list.rows.len() < list.count[1] {
        let middles = middles(m, list);
        all.extend(middles.into_iter().enumerate().map(|(i, at)| (2 * i + 1, HandleTarget::NewRow(i + 1), at)));
    }
    all
}

fn middles(m: &Measures<'_>, list: &List) -> Vec<DVec3> {
    let NodeKind::Object(object) = &m.node.kind else { return Vec::new() };
    match &object.shape {
        Shape::Tube { points, closed, .. } => tube_curve(points, *closed)
            .iter()
            .filter_map(|span| match span.as_slice() {
                [] => None,
                [only] => Some(only.middle),
                several => Some(several[several.len() / 2].start()),
            })
            .collect(),
        Shape::Extrusion { corners, smooth, .. } | Shape::Revolution { corners, smooth, .. } => {
            let arcs = profile_curve(corners, *smooth);
            let each = (arcs.len() / list.rows.len().max(1)).max(1);
            arcs.chunks(each).map(|span| if each > 1 { span[each / 2].start() } else { span[0].middle }).collect()
        }
        _ => Vec::new(),
    }
}

fn measures<'a>(
    state: &EditorState,
    projection: &Projection,
    node: &'a Node,
    part: Part,
    world_from_local: &DAffine3,
) -> Measures<'a> {
    let local_from_world = world_from_local.inverse();
    let turn = state.view.navigation.rotation;
    let local = |direction: DVec3| local_from_world.transform_vector3(direction).normalize_or(DVec3::X);
    let (right, up) = (local(turn * DVec3::X), local(turn * DVec3::Y));
    let meters = projection.meters_per_point(world_from_local.translation) * REACH;
    let stretch = world_from_local.transform_vector3(right).length().max(1e-12);
    let mut m = Measures { node, part, right, up, reach: meters / stretch, seam: DVec3::ZERO, blend_unit: 1.0 };
    if let NodeKind::Group(group) = &node.kind {
        let (seam, size) = seam(state, node.id).unwrap_or((world_from_local.translation, 1.0));
        m.seam = local_from_world.transform_point3(seam);
        m.reach = projection.meters_per_point(seam) * REACH / stretch;
        let unit = if group.blend.unit == RadiusUnit::Size { size } else { 1.0 };
        m.blend_unit = unit / world_from_local.transform_vector3(m.outward()).length().max(1e-12);
    }
    m
}

/// The point between the first two operands of a group, and the size of the smaller one.
fn seam(state: &EditorState, group: NodeId) -> Option<(DVec3, f64)> {
    let scene = state.session.document.scene();
    let mut operands = scene
        .children(Some(group))
        .filter(|child| child.has_field() && child.visible)
        .filter_map(|child| bounds::of_nodes(scene, state.derived.library(), &[child.id]));
    let (a, b) = (operands.next()?, operands.next()?);
    let size = |bounds: &Aabb| bounds.half().max_element();
    let middle = (a.min.max(b.min) + a.max.min(b.max)) * 0.5;
    Some((middle, size(&a).min(size(&b)))).filter(|(middle, size)| middle.is_finite() && *size > 0.0)
}

/// The rectangle of a handle, for pointing devices and readers of the screen.
pub fn grab_rect(at: Pos2) -> Rect {
    Rect::from_center_size(at, egui::Vec2::splat(2.0 * GRAB))
}
