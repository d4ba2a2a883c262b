//! The overlay of the picture: boxes of the selection, lights and cameras, the compass.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, vec2};
use glam::DVec3;

use super::navigation::Side;
use super::projection::Projection;
use super::state::EditorState;
use super::{bounds, icons, lattice_overlay, shading_bar, theme};
use isolith_scene::{Node, NodeId, NodeKind};

/// Maximum number of selection boxes.
const MOST_BOXES: usize = 64;

/// Whether the renderer's outline is not enough: for the bounds of groups, and for subtracted, intersected or hidden nodes.
fn needs_box(node: &Node) -> bool {
    match node.kind {
        NodeKind::Group(_) | NodeKind::Instancer(_) => true,
        NodeKind::Object(_) | NodeKind::Mesh(_) => !node.adds() || !node.visible,
        NodeKind::Light(_) | NodeKind::Camera(_) => false,
    }
}

/// Paints the oriented boxes of the selected nodes that need them.
pub fn selection_boxes(state: &EditorState, painter: &Painter, projection: &Projection) {
    let selection = state.session.document.selection().to_vec();
    let active = selection.last().copied();
    for id in selection.into_iter().rev().take(MOST_BOXES) {
        let scene = state.session.document.scene();
        if !scene.node(id).is_some_and(|n| needs_box(n)) || lattice_overlay::has_lines(state, id) {
            continue;
        }
        let Some((world_from_local, bounds)) = bounds::oriented(scene, state.derived.library(), id) else { continue };
        let color = if Some(id) == active { *theme::ACCENT } else { theme::ACCENT.gamma_multiply(0.6) };
        let corners = bounds.corners().map(|c| projection.to_screen(world_from_local.transform_point3(c)));
        paint_box(painter, &corners, Stroke::new(3.0, Color32::from_black_alpha(110)));
        paint_box(painter, &corners, Stroke::new(1.25, color));
    }
}

/// Paints each corner of a box as three short strokes, which hide little of the picture.
pub fn paint_box(painter: &Painter, corners: &[Option<Pos2>; 8], stroke: Stroke) {
    const SHARE: f32 = 0.22;
    for (index, corner) in corners.iter().enumerate() {
        for axis in 0..3 {
            let (Some(from), Some(to)) = (corner, corners[index ^ (1 << axis)]) else { continue };
            painter.line_segment([*from, *from + (to - *from) * SHARE], stroke);
        }
    }
}

/// A light or a camera on the screen.
pub struct Marker {
    /// Its node.
    pub id: NodeId,
    /// Its position, in points.
    pub at: Pos2,
}

impl Marker {
    /// Pick radius, in points.
    pub const GRAB: f32 = 13.0;
}

/// The visible lights and cameras, without the camera at the eye.
pub fn markers(state: &EditorState, projection: &Projection) -> Vec<Marker> {
    let flat = state.flat();
    let lights = flat.lights.iter().map(|l| (l.id, l.position));
    let cameras = flat.cameras.iter().map(|c| (c.id, c.camera.position));
    let eye = state.view.navigation.eye();
    let near = state.view.navigation.distance * 1e-2;
    lights
        .chain(cameras)
        .filter(|(_, position)| position.distance(eye) > near)
        .filter_map(|(id, position)| Some(Marker { id, at: projection.to_screen(position)? }))
        .collect()
}

/// Paints the markers, with a direction arrow for selected ones.
pub fn paint_markers(state: &EditorState, painter: &Painter, projection: &Projection, markers: &[Marker]) {
    for marker in markers {
        let scene = state.session.document.scene();
        let Some(node) = scene.node(marker.id) else { continue };
        let selected = state.session.document.selection().contains(&marker.id);
        let color = icons::node_color(node);
        if selected {
            let world = scene.world_from_local(marker.id);
            let reach = projection.meters_per_point(world.translation) * 60.0;
            let ahead = world.translation + (world.matrix3 * DVec3::NEG_Z).normalize_or_zero() * reach;
            if let Some(tip) = projection.to_screen(ahead) {
                painter.arrow(marker.at, tip - marker.at, Stroke::new(1.5, color.gamma_multiply(0.8)));
            }
        }
        let ring = if selected { *theme::ACCENT } else { Color32::TRANSPARENT };
        painter.circle(marker.at, 11.0, theme::FLOATING.gamma_multiply(0.55), Stroke::new(1.5, ring));
        icons::paint_node(painter, icons::centered(Rect::from_center_size(marker.at, vec2(14.0, 14.0)), 14.0), node);
    }
}

/// The compass: the world's axes in the current view; a click looks along one.
pub struct Compass {
    balls: [(Side, Pos2, f32); 6],
    center: Pos2,
}

impl Compass {
    const ARM: f32 = 28.0;
    const BALL: f32 = 8.0;

    /// The compass in the upper right corner of the viewport, below the bar of shadings.
    pub fn new(rect: Rect, rotation: glam::DQuat) -> Self {
        let center = rect.right_top() + vec2(-50.0, 50.0 + shading_bar::HEIGHT);
        let inverse = rotation.inverse();
        let sides = [Side::Right, Side::Top, Side::Front, Side::Left, Side::Bottom, Side::Back];
        let mut balls = sides.map(|side| {
            let seen = (inverse * side.direction()).as_vec3();
            (side, center + vec2(seen.x, -seen.y) * Self::ARM, seen.z)
        });
        balls.sort_by(|a, b| a.2.total_cmp(&b.2));
        Self { balls, center }
    }

    /// The side under the pointer; the nearest one wins.
    pub fn side_at(&self, pointer: Pos2) -> Option<Side> {
        self.balls.iter().rev().find(|(_, at, _)| at.distance(pointer) <= Self::BALL + 1.0).map(|ball| ball.0)
    }

    /// Paints the compass, far balls first.
    pub fn paint(&self, painter: &Painter, hovered: Option<Side>) {
        if hovered.is_some() {
            painter.circle_filled(self.center, Self::ARM + 14.0, Color32::from_white_alpha(10));
        }
        for (side, at, depth) in self.balls {
            let direction = side.direction();
            let axis = (0..3).find(|a| direction[*a] != 0.0).unwrap_or(0);
            let positive = direction[axis] > 0.0;
            let dim = 0.55 + 0.45 * (depth + 1.0) * 0.5;
            let color = theme::AXES[axis].gamma_multiply(dim);
            if positive {
                painter.line_segment([self.center, at], Stroke::new(2.0, color));
                painter.circle_filled(at, Self::BALL, color);
                let font = FontId::proportional(11.0);
                painter.text(at, Align2::CENTER_CENTER, ["X", "Y", "Z"][axis], font, Color32::from_black_alpha(200));
            } else {
                painter.circle(at, Self::BALL - 2.0, color.gamma_multiply(0.25), Stroke::new(1.25, color));
            }
            if hovered == Some(side) {
                painter.circle_stroke(at, Self::BALL + 1.0, Stroke::new(1.5, Color32::WHITE));
            }
        }
    }
}

/// Paints the line of a lasso, and its end back to the start.
pub fn lasso(painter: &Painter, line: &[Pos2]) {
    painter.add(egui::Shape::line(line.to_vec(), Stroke::new(1.5, theme::ACCENT)));
    if let (Some(first), Some(last)) = (line.first(), line.last()) {
        painter.add(egui::Shape::dashed_line(&[*last, *first], Stroke::new(1.0, theme::ACCENT), 4.0, 4.0));
    }
}

/// A hint for beginners in the center of an empty viewport.
pub fn empty_hint(painter: &Painter, rect: Rect) {
    let at = rect.center() + vec2(0.0, -10.0);
    painter.text(at, Align2::CENTER_BOTTOM, "An empty scene", FontId::proportional(20.0), theme::ON_PICTURE);
    let text = "Shift A adds a shape where the pointer is; File, Examples opens a scene";
    let mut job =
        egui::text::LayoutJob::simple(text.into(), FontId::proportional(13.5), theme::ON_PICTURE, rect.width() - 24.0);
    job.halign = egui::Align::Center;
    painter.galley(at + vec2(0.0, 8.0), painter.layout_job(job), theme::ON_PICTURE);
}
