//! Small drawings of the shapes, and the icons of every kind of node.

use std::f32::consts::TAU;

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_FLASHLIGHT_ON, ICON_JOIN_FULL, ICON_JOIN_INNER, ICON_JOIN_LEFT, ICON_LIGHTBULB, ICON_VIDEOCAM,
    ICON_VIEW_IN_AR, ICON_WB_SUNNY,
};

use super::theme;
use crate::scene::{LightKind, Node, NodeKind, Operator, ShapeKind};

/// The drawing of a node's kind: a shape's silhouette or an icon, in the kind's colour.
pub fn paint_node(painter: &Painter, rect: Rect, node: &Node) {
    let color = node_color(node);
    match &node.kind {
        NodeKind::Object(object) => paint_shape(painter, rect, object.shape.kind(), color),
        NodeKind::Group(group) => paint_icon(painter, rect, operator_icon(group.operator), color),
        NodeKind::Mesh(_) => paint_icon(painter, rect, ICON_VIEW_IN_AR, color),
        NodeKind::Light(light) => paint_icon(painter, rect, light_icon(&light.light), color),
        NodeKind::Camera(_) => paint_icon(painter, rect, ICON_VIDEOCAM, color),
    }
}

/// The colour of a node's kind.
pub fn node_color(node: &Node) -> Color32 {
    match node.kind {
        _ if node.negative => theme::NEGATIVE,
        NodeKind::Object(_) => theme::OBJECT,
        NodeKind::Group(_) => theme::GROUP,
        NodeKind::Mesh(_) => theme::MESH,
        NodeKind::Light(_) => theme::LIGHT,
        NodeKind::Camera(_) => theme::CAMERA,
    }
}

/// The icon of an operator: which part of two circles stays.
pub fn operator_icon(operator: Operator) -> MaterialIcon {
    match operator {
        Operator::Union => ICON_JOIN_FULL,
        Operator::Intersection => ICON_JOIN_INNER,
        Operator::Difference => ICON_JOIN_LEFT,
    }
}

/// The icon of a kind of light.
pub fn light_icon(light: &LightKind) -> MaterialIcon {
    match light {
        LightKind::Directional {} => ICON_WB_SUNNY,
        LightKind::Point { .. } => ICON_LIGHTBULB,
        LightKind::Spot { .. } => ICON_FLASHLIGHT_ON,
    }
}

/// Paints an icon into the middle of `rect`.
pub fn paint_icon(painter: &Painter, rect: Rect, icon: MaterialIcon, color: Color32) {
    let font = FontId::new(rect.height(), icon.font_family());
    painter.text(rect.center(), Align2::CENTER_CENTER, icon.codepoint, font, color);
}

/// Paints the silhouette of a shape, seen a little from above.
pub fn paint_shape(painter: &Painter, rect: Rect, kind: ShapeKind, color: Color32) {
    let pen = Pen { painter, rect, stroke: Stroke::new((rect.height() / 13.0).max(1.0), color) };
    match kind {
        ShapeKind::Sphere => {
            pen.ellipse([0.0, 0.0], [0.8, 0.8], 0.0, 1.0);
            pen.ellipse([0.0, 0.0], [0.8, 0.28], 0.0, 0.5);
        }
        ShapeKind::Ellipsoid => {
            pen.ellipse([0.0, 0.0], [0.92, 0.55], 0.0, 1.0);
            pen.ellipse([0.0, 0.0], [0.92, 0.2], 0.0, 0.5);
        }
        ShapeKind::Box => pen.cube(),
        ShapeKind::BoxFrame => {
            pen.cube();
            pen.line(&[[-0.4, 0.32], [-0.4, 0.0], [-0.2, -0.1]]);
            pen.line(&[[0.4, 0.32], [0.4, 0.0], [0.2, -0.1]]);
        }
        ShapeKind::Torus => {
            pen.ellipse([0.0, 0.0], [0.92, 0.6], 0.0, 1.0);
            pen.ellipse([0.0, -0.05], [0.4, 0.2], 0.0, 1.0);
        }
        ShapeKind::Cylinder => pen.tapered(0.65, 0.65),
        ShapeKind::CappedCone => pen.tapered(0.75, 0.35),
        ShapeKind::RoundCone => {
            pen.ellipse([0.0, -0.5], [0.38, 0.38], 0.53, 0.44);
            pen.ellipse([0.0, 0.3], [0.6, 0.6], -0.03, 0.56);
            pen.line(&[[-0.37, -0.57], [-0.59, 0.18]]);
            pen.line(&[[0.37, -0.57], [0.59, 0.18]]);
        }
        ShapeKind::Capsule => {
            pen.ellipse([0.0, -0.4], [0.45, 0.45], 0.5, 0.5);
            pen.ellipse([0.0, 0.4], [0.45, 0.45], 0.0, 0.5);
            pen.line(&[[-0.45, -0.4], [-0.45, 0.4]]);
            pen.line(&[[0.45, -0.4], [0.45, 0.4]]);
        }
        ShapeKind::Plane => pen.line(&[[-0.95, 0.3], [-0.3, -0.35], [0.95, -0.3], [0.3, 0.4], [-0.95, 0.3]]),
        ShapeKind::HexagonalPrism => pen.prism(),
        ShapeKind::Octahedron => {
            pen.line(&[[0.0, -0.9], [-0.75, 0.05], [0.0, 0.9], [0.75, 0.05], [0.0, -0.9]]);
            pen.line(&[[-0.75, 0.05], [-0.15, 0.25], [0.75, 0.05]]);
            pen.line(&[[0.0, -0.9], [-0.15, 0.25], [0.0, 0.9]]);
        }
        _ => paint_drawn(&pen, kind),
    }
}

/// The silhouettes of shapes that are drawn point by point, and of landscapes.
fn paint_drawn(pen: &Pen<'_>, kind: ShapeKind) {
    match kind {
        ShapeKind::Tube => {
            pen.wave(0.45, [-0.15, -0.3]);
            pen.wave(0.45, [0.15, 0.3]);
            pen.ellipse([-0.8, 0.0], [0.17, 0.3], 0.0, 1.0);
            pen.ellipse([0.8, 0.0], [0.17, 0.3], 0.75, 0.5);
        }
        ShapeKind::Extrusion => {
            let corner = |i: u8, by: f32| {
                let angle = TAU * f32::from(i) / 10.0;
                let r = if i % 2 == 0 { 0.75 } else { 0.34 };
                [r * angle.sin() + by, -r * angle.cos() - by]
            };
            pen.line(&std::array::from_fn::<_, 11, _>(|i| corner(i as u8, -0.1)));
            pen.line(&std::array::from_fn::<_, 5, _>(|i| corner(i as u8, 0.15)));
        }
        ShapeKind::Revolution => {
            pen.line(&[[-0.5, -0.85], [-0.3, -0.45], [-0.65, 0.1], [-0.2, 0.7], [-0.5, 0.85]]);
            pen.line(&[[0.5, -0.85], [0.3, -0.45], [0.65, 0.1], [0.2, 0.7], [0.5, 0.85]]);
            pen.ellipse([0.0, -0.85], [0.5, 0.12], 0.0, 1.0);
            pen.ellipse([0.0, 0.85], [0.5, 0.12], 0.0, 0.5);
        }
        ShapeKind::Terrain => {
            pen.line(&[[-0.95, 0.5], [-0.4, -0.5], [-0.1, 0.0], [0.3, -0.75], [0.95, 0.5], [-0.95, 0.5]]);
            pen.line(&[[0.05, -0.25], [0.25, -0.1], [0.35, -0.25], [0.55, -0.2]]);
        }
        ShapeKind::Ocean => {
            pen.wave(0.25, [-0.45, -0.45]);
            pen.wave(0.25, [0.0, 0.0]);
            pen.wave(0.25, [0.45, 0.45]);
        }
        _ => {}
    }
}

/// Draws in a square from −1 to 1, y down.
struct Pen<'a> {
    painter: &'a Painter,
    rect: Rect,
    stroke: Stroke,
}

impl Pen<'_> {
    fn at(&self, [x, y]: [f32; 2]) -> Pos2 {
        self.rect.center() + vec2(x, y) * self.rect.height() * 0.5
    }

    fn line(&self, points: &[[f32; 2]]) {
        self.painter.add(Shape::line(points.iter().map(|p| self.at(*p)).collect(), self.stroke));
    }

    /// Part of an ellipse; `start` and `share` in turns, clockwise from +X.
    fn ellipse(&self, center: [f32; 2], radii: [f32; 2], start: f32, share: f32) {
        let points = (0..=32).map(|i| {
            let angle = TAU * (start + share * i as f32 / 32.0);
            self.at([center[0] + radii[0] * angle.cos(), center[1] + radii[1] * angle.sin()])
        });
        self.painter.add(Shape::line(points.collect(), self.stroke));
    }

    /// Two crests from left to right, `height` high, between two heights.
    fn wave(&self, height: f32, [from, to]: [f32; 2]) {
        let points = (0..=32).map(|i| {
            let t = i as f32 / 32.0;
            self.at([2.0 * t - 1.0, from + (to - from) * t - height * (TAU * 1.5 * t).sin() * 0.5])
        });
        self.painter.add(Shape::line(points.collect(), self.stroke));
    }

    fn cube(&self) {
        self.line(&[
            [0.0, -0.85],
            [0.78, -0.45],
            [0.78, 0.45],
            [0.0, 0.85],
            [-0.78, 0.45],
            [-0.78, -0.45],
            [0.0, -0.85],
        ]);
        self.line(&[[-0.78, -0.45], [0.0, -0.05], [0.78, -0.45]]);
        self.line(&[[0.0, -0.05], [0.0, 0.85]]);
    }

    fn tapered(&self, bottom: f32, top: f32) {
        self.ellipse([0.0, -0.6], [top, top * 0.35], 0.0, 1.0);
        self.ellipse([0.0, 0.6], [bottom, bottom * 0.35], 0.0, 0.5);
        self.line(&[[-top, -0.6], [-bottom, 0.6]]);
        self.line(&[[top, -0.6], [bottom, 0.6]]);
    }

    fn prism(&self) {
        let top = [[-0.8, -0.4], [-0.4, -0.68], [0.4, -0.68], [0.8, -0.4], [0.4, -0.12], [-0.4, -0.12], [-0.8, -0.4]];
        self.line(&top);
        self.line(&[[-0.8, -0.4], [-0.8, 0.4], [-0.4, 0.68], [0.4, 0.68], [0.8, 0.4], [0.8, -0.4]]);
        self.line(&[[-0.4, -0.12], [-0.4, 0.68]]);
        self.line(&[[0.4, -0.12], [0.4, 0.68]]);
    }
}

/// A square of the given side in the middle of `rect`.
pub fn centered(rect: Rect, side: f32) -> Rect {
    Rect::from_center_size(pos2(rect.center().x.round(), rect.center().y.round()), vec2(side, side))
}
