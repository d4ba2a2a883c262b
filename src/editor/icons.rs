//! Icons for every kind of node. `shape_icons` draws the shapes.

use egui::{Align2, Color32, FontId, Painter, Rect, pos2, vec2};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_ACCOUNT_TREE, ICON_ADJUST, ICON_ANIMATION, ICON_ARROW_SELECTOR_TOOL, ICON_DEPLOYED_CODE, ICON_DRAW,
    ICON_FILTER_CENTER_FOCUS, ICON_FLASHLIGHT_ON, ICON_FLUORESCENT, ICON_FORMAT_PAINT, ICON_GRID_ON, ICON_JOIN,
    ICON_JOIN_FULL, ICON_JOIN_INNER, ICON_JOIN_LEFT, ICON_LIGHTBULB, ICON_MY_LOCATION, ICON_OPEN_IN_FULL,
    ICON_OPEN_WITH, ICON_PLUMBING, ICON_PUBLIC, ICON_ROTATE_RIGHT, ICON_SCREENSHOT_MONITOR, ICON_STYLUS,
    ICON_VERTICAL_ALIGN_BOTTOM, ICON_VERTICAL_ALIGN_TOP, ICON_VIDEOCAM, ICON_VIEW_IN_AR, ICON_WB_SUNNY,
    ICON_WORKSPACES,
};

pub use super::shape_icons::paint_shape;
use super::theme;
use super::transforms::kinds::{Orientation, PivotPoint, Tool, TransformKind};
use isolith_scene::{LightKind, Node, NodeKind, Operator};

/// Paints the icon of a node: a shape's silhouette or a glyph, in the color of its kind.
pub fn paint_node(painter: &Painter, rect: Rect, node: &Node) {
    let color = node_color(node);
    match &node.kind {
        NodeKind::Object(object) => paint_shape(painter, rect, object.shape.kind(), color),
        NodeKind::Group(group) => paint_icon(painter, rect, operator_icon(group.operator), color),
        NodeKind::Instancer(_) => paint_icon(painter, rect, ICON_GRID_ON, color),
        NodeKind::Mesh(_) => paint_icon(painter, rect, ICON_VIEW_IN_AR, color),
        NodeKind::Light(light) => paint_icon(painter, rect, light_icon(&light.light), color),
        NodeKind::Camera(_) => paint_icon(painter, rect, ICON_VIDEOCAM, color),
    }
}

/// The color of a node's kind.
pub fn node_color(node: &Node) -> Color32 {
    match node.kind {
        _ if !node.adds() => *theme::NEGATIVE,
        NodeKind::Object(_) => *theme::OBJECT,
        NodeKind::Group(_) | NodeKind::Instancer(_) => *theme::GROUP,
        NodeKind::Mesh(_) => *theme::MESH,
        NodeKind::Light(_) => *theme::LIGHT,
        NodeKind::Camera(_) => *theme::CAMERA,
    }
}

/// Icon of an operator: the part of two circles that remains.
pub fn operator_icon(operator: Operator) -> MaterialIcon {
    match operator {
        Operator::Union => ICON_JOIN_FULL,
        Operator::Intersection => ICON_JOIN_INNER,
        Operator::Difference => ICON_JOIN_LEFT,
        Operator::Xor => ICON_JOIN,
        Operator::Pipe => ICON_PLUMBING,
        Operator::Groove => ICON_VERTICAL_ALIGN_BOTTOM,
        Operator::Tongue => ICON_VERTICAL_ALIGN_TOP,
        Operator::Engrave => ICON_STYLUS,
        Operator::Morph => ICON_ANIMATION,
        Operator::Paint => ICON_FORMAT_PAINT,
    }
}

/// Icon of a tool.
pub fn tool_icon(tool: Tool) -> MaterialIcon {
    match tool {
        Tool::Select => ICON_ARROW_SELECTOR_TOOL,
        Tool::Transform(TransformKind::Move) => ICON_OPEN_WITH,
        Tool::Transform(TransformKind::Rotate) => ICON_ROTATE_RIGHT,
        Tool::Transform(TransformKind::Scale) => ICON_OPEN_IN_FULL,
        Tool::Draw => ICON_DRAW,
    }
}

/// Icon of the axes of the tools.
pub fn orientation_icon(orientation: Orientation) -> MaterialIcon {
    match orientation {
        Orientation::World => ICON_PUBLIC,
        Orientation::Local => ICON_DEPLOYED_CODE,
        Orientation::Parent => ICON_ACCOUNT_TREE,
        Orientation::View => ICON_SCREENSHOT_MONITOR,
    }
}

/// Icon of the point around which the tools turn and scale.
pub fn pivot_icon(pivot: PivotPoint) -> MaterialIcon {
    match pivot {
        PivotPoint::Median => ICON_ADJUST,
        PivotPoint::Individual => ICON_WORKSPACES,
        PivotPoint::Active => ICON_MY_LOCATION,
        PivotPoint::World => ICON_FILTER_CENTER_FOCUS,
    }
}

/// Icon of a kind of light.
pub fn light_icon(light: &LightKind) -> MaterialIcon {
    match light {
        LightKind::Sun { .. } => ICON_WB_SUNNY,
        LightKind::Point { .. } => ICON_LIGHTBULB,
        LightKind::Spot { .. } => ICON_FLASHLIGHT_ON,
        LightKind::Rectangle { .. } => ICON_FLUORESCENT,
    }
}

/// Paints an icon in the center of `rect`.
pub fn paint_icon(painter: &Painter, rect: Rect, icon: MaterialIcon, color: impl Into<Color32>) {
    let font = FontId::new(rect.height(), icon.font_family());
    painter.text(rect.center(), Align2::CENTER_CENTER, icon.codepoint, font, color.into());
}

/// A square of the given side in the center of `rect`.
pub fn centered(rect: Rect, side: f32) -> Rect {
    Rect::from_center_size(pos2(rect.center().x.round(), rect.center().y.round()), vec2(side, side))
}
