//! The style of the editor: one palette for each theme, one accent, one set of spacings.

use egui::style::{Selection, WidgetVisuals};
use egui::{Color32, Context, CornerRadius, FontId, Margin, Shadow, Stroke, TextStyle, Visuals, vec2};

pub use super::palette::*;

/// Marks over the picture, in every theme.
pub const ON_PICTURE: Color32 = Color32::from_rgb(212, 216, 223);
/// Handles on a shape, over the picture.
pub const HANDLE: Color32 = Color32::from_rgb(255, 190, 92);
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
    for theme in ColorTheme::ALL {
        ctx.style_mut_of(theme.of_egui(), |style| style.visuals = visuals(theme));
    }
    apply(ctx, ColorTheme::current());
    ctx.all_styles_mut(|style| {
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

/// Switches to a theme.
pub fn apply(ctx: &Context, theme: ColorTheme) {
    theme.make_current();
    ctx.set_theme(theme.of_egui());
}

impl ColorTheme {
    fn of_egui(self) -> egui::Theme {
        match self {
            Self::Dark => egui::Theme::Dark,
            Self::Light => egui::Theme::Light,
        }
    }
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

fn visuals(theme: ColorTheme) -> Visuals {
    let of = |color: ThemeColor| color.of(theme);
    let (mut v, shade) = match theme {
        ColorTheme::Dark => (Visuals::dark(), 1.0),
        ColorTheme::Light => (Visuals::light(), 0.4),
    };
    let none = Color32::TRANSPARENT;
    v.widgets.noninteractive = widget(of(PANEL), of(BORDER), of(TEXT));
    v.widgets.inactive = widget(of(FIELD), none, of(TEXT));
    v.widgets.hovered = widget(of(FIELD_HOVERED), none, of(STRONG));
    v.widgets.active = widget(of(FIELD_PRESSED), none, of(STRONG));
    v.widgets.open = widget(of(FIELD_HOVERED), none, of(STRONG));
    v.selection = Selection { bg_fill: of(SELECTED), stroke: Stroke::new(1.0, of(ACCENT)) };
    v.hyperlink_color = of(ACCENT);
    v.faint_bg_color = of(STRIPE);
    v.extreme_bg_color = of(DEEP);
    v.weak_text_color = Some(of(WEAK));
    v.warn_fg_color = of(WARNING);
    v.error_fg_color = of(ERROR);
    v.panel_fill = of(PANEL);
    v.window_fill = of(WINDOW);
    v.window_stroke = Stroke::new(1.0, of(BORDER));
    v.window_corner_radius = CornerRadius::same(8);
    v.menu_corner_radius = CornerRadius::same(7);
    let black = |alpha: f32| Color32::from_black_alpha((alpha * shade) as u8);
    v.window_shadow = Shadow { offset: [0, 8], blur: 28, spread: 0, color: black(120.0) };
    v.popup_shadow = Shadow { offset: [0, 4], blur: 16, spread: 0, color: black(110.0) };
    v.indent_has_left_vline = false;
    v.slider_trailing_fill = true;
    v
}
