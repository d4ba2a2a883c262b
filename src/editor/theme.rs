//! The style of the editor: one palette, one accent, one set of spacings.

use egui::style::{Selection, WidgetVisuals};
use egui::{Color32, Context, CornerRadius, FontId, Margin, Shadow, Stroke, TextStyle, Visuals, vec2};

/// The accent color: selection, focus, the primary button.
pub const ACCENT: Color32 = Color32::from_rgb(110, 168, 254);
/// Background of selected rows.
pub const SELECTED: Color32 = Color32::from_rgb(42, 66, 104);
/// Background of panels.
pub const PANEL: Color32 = Color32::from_rgb(27, 29, 34);
/// Background of cards in panels.
pub const CARD: Color32 = Color32::from_rgb(34, 37, 43);
/// Background of the bars at the top and the bottom.
pub const BAR: Color32 = Color32::from_rgb(22, 24, 28);
/// Background of fields for text and numbers.
pub const FIELD: Color32 = Color32::from_rgb(46, 50, 58);
/// Thin lines between areas.
pub const LINE: Color32 = Color32::from_rgb(14, 15, 18);
/// Normal text.
pub const TEXT: Color32 = Color32::from_rgb(212, 216, 223);
/// Labels and hints.
pub const WEAK: Color32 = Color32::from_rgb(146, 152, 164);
/// Controls at rest, barely visible.
pub const FAINT: Color32 = Color32::from_rgb(86, 92, 103);
/// Switches of rows without the pointer.
pub const RESTING: Color32 = Color32::from_rgb(64, 68, 78);
/// Parameters that change with time.
pub const ANIMATED: Color32 = Color32::from_rgb(126, 200, 136);
/// Keys at the moment that is shown, and selected keys.
pub const KEYED: Color32 = Color32::from_rgb(244, 200, 96);
/// Errors.
pub const ERROR: Color32 = Color32::from_rgb(240, 112, 104);
/// Warnings.
pub const WARNING: Color32 = Color32::from_rgb(232, 178, 92);
/// Success.
pub const SUCCESS: Color32 = Color32::from_rgb(126, 200, 136);
/// Groups.
pub const GROUP: Color32 = Color32::from_rgb(226, 184, 110);
/// Objects.
pub const OBJECT: Color32 = Color32::from_rgb(126, 182, 224);
/// Handles on a shape.
pub const HANDLE: Color32 = Color32::from_rgb(255, 190, 92);
/// Subtracted nodes.
pub const NEGATIVE: Color32 = Color32::from_rgb(232, 128, 118);
/// Lights.
pub const LIGHT: Color32 = Color32::from_rgb(244, 214, 120);
/// Cameras.
pub const CAMERA: Color32 = Color32::from_rgb(168, 150, 232);
/// Meshes.
pub const MESH: Color32 = Color32::from_rgb(126, 200, 160);
/// The X, Y and Z axes.
pub const AXES: [Color32; 3] =
    [Color32::from_rgb(226, 94, 94), Color32::from_rgb(124, 190, 84), Color32::from_rgb(86, 142, 236)];

/// Text of a field whose value differs among the selected nodes.
pub const MIXED: &str = "–";
/// Height of fields and buttons in points.
pub const ROW_HEIGHT: f32 = 24.0;
/// Side of an icon in points.
pub const ICON_SIZE: f32 = 16.0;
/// Corner radius of fields and buttons.
pub const RADIUS: u8 = 5;

/// Installs fonts and style. Call once, before the first frame.
pub fn install(ctx: &Context) {
    egui_material_icons::initialize(ctx);
    ctx.set_theme(egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        style.visuals = visuals();
        style.animation_time = 0.1;
        style.interaction.selectable_labels = false;
        style.interaction.tooltip_delay = 0.4;
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(11.5)),
            (TextStyle::Body, FontId::proportional(13.5)),
            (TextStyle::Button, FontId::proportional(13.5)),
            (TextStyle::Heading, FontId::proportional(16.0)),
            (TextStyle::Monospace, FontId::monospace(12.5)),
        ]
        .into();
        let spacing = &mut style.spacing;
        spacing.item_spacing = vec2(6.0, 6.0);
        spacing.button_padding = vec2(8.0, 3.0);
        spacing.interact_size = vec2(32.0, ROW_HEIGHT);
        spacing.menu_margin = Margin::same(6);
        spacing.window_margin = Margin::same(14);
        spacing.indent = 16.0;
        spacing.icon_width = 16.0;
        spacing.icon_width_inner = 9.0;
        spacing.combo_height = 420.0;
        spacing.tooltip_width = 320.0;
        spacing.scroll = egui::style::ScrollStyle::thin();
        spacing.scroll.bar_width = 7.0;
        spacing.scroll.floating_allocated_width = 0.0;
        spacing.scroll.dormant_background_opacity = 0.0;
        spacing.scroll.active_background_opacity = 0.0;
        spacing.scroll.interact_background_opacity = 0.2;
        spacing.scroll.dormant_handle_opacity = 0.25;
        spacing.scroll.fade.strength = 0.0;
    });
}

fn widget(fill: Color32, border: Color32, text: Color32) -> WidgetVisuals {
    WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, border),
        corner_radius: CornerRadius::same(RADIUS),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    }
}

fn visuals() -> Visuals {
    let mut v = Visuals::dark();
    let none = Color32::TRANSPARENT;
    v.widgets.noninteractive = widget(PANEL, Color32::from_rgb(48, 52, 60), TEXT);
    v.widgets.inactive = widget(FIELD, none, TEXT);
    v.widgets.hovered = widget(Color32::from_rgb(58, 63, 73), none, Color32::WHITE);
    v.widgets.active = widget(Color32::from_rgb(66, 72, 84), none, Color32::WHITE);
    v.widgets.open = widget(Color32::from_rgb(58, 63, 73), none, Color32::WHITE);
    v.selection = Selection { bg_fill: SELECTED, stroke: Stroke::new(1.0, ACCENT) };
    v.hyperlink_color = ACCENT;
    v.faint_bg_color = Color32::from_rgb(31, 33, 39);
    v.extreme_bg_color = Color32::from_rgb(18, 20, 24);
    v.weak_text_color = Some(WEAK);
    v.warn_fg_color = WARNING;
    v.error_fg_color = ERROR;
    v.panel_fill = PANEL;
    v.window_fill = Color32::from_rgb(36, 39, 46);
    v.window_stroke = Stroke::new(1.0, Color32::from_rgb(58, 62, 72));
    v.window_corner_radius = CornerRadius::same(8);
    v.menu_corner_radius = CornerRadius::same(7);
    v.window_shadow = Shadow { offset: [0, 8], blur: 28, spread: 0, color: Color32::from_black_alpha(120) };
    v.popup_shadow = Shadow { offset: [0, 4], blur: 16, spread: 0, color: Color32::from_black_alpha(110) };
    v.indent_has_left_vline = false;
    v.slider_trailing_fill = true;
    v
}
