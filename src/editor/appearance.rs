//! What the preferences say about all of the window: theme, scale, keys and units.

use std::sync::Arc;

use egui::Context;

use super::palette::ColorTheme;
use super::state::EditorState;
use super::theme;
use super::units::LengthUnit;

/// Brings the preferences into the window.
#[derive(Default)]
pub struct Appearance {
    /// The scale that the window was told last.
    scale: Option<f32>,
}

impl Appearance {
    /// Call once a frame, before all panels.
    pub fn apply(&mut self, ctx: &Context, state: &mut EditorState) {
        self.apply_scale(ctx, state);
        let values = state.preferences.values();
        let theme = ColorTheme::named(&values.theme);
        theme.make_current();
        let shown = if ctx.theme() == egui::Theme::Light { ColorTheme::Light } else { ColorTheme::Dark };
        if shown != theme {
            theme::apply(ctx, theme);
            ctx.request_repaint();
        }
        LengthUnit::named(&values.unit).install(ctx);
        Arc::new(state.key_bindings()).install(ctx);
    }

    /// Takes over a scale that was changed by keys, or brings that of the preferences into the window.
    fn apply_scale(&mut self, ctx: &Context, state: &mut EditorState) {
        let (shown, wanted) = (ctx.zoom_factor(), state.preferences.values().scale);
        if self.scale.is_some_and(|told| told == wanted && told != shown) {
            state.preferences.change(|values| values.scale = shown);
            self.scale = Some(state.preferences.values().scale);
            return;
        }
        if shown != wanted {
            ctx.set_zoom_factor(wanted);
        }
        self.scale = Some(wanted);
    }
}
