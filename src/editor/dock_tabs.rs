//! The tabs of the docked panels: how they look, and what a drag or a click on them does.

use egui::{Align2, Color32, CursorIcon, FontId, Id, LayerId, Margin, Order, Painter, Rect, Response, Role, Sense};
use egui::{Stroke, StrokeKind, Style, Ui, UiBuilder, Vec2, Visuals, WidgetInfo, WidgetText, vec2};
use egui_material_icons::icons::ICON_CLOSE;
use egui_tiles::UiResponse;
use egui_tiles::{Behavior, EditAction, ResizeState, SimplificationOptions, TabState, Tabs, Tile, TileId, Tiles};

use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, Request};
use super::{icons, theme};

/// Height of a bar of tabs, in points.
pub const BAR: f32 = 24.0;
/// Width of the line between panels, in points.
pub const GAP: f32 = 1.0;
/// Least size of a docked panel, in points.
pub const LEAST: f32 = 80.0;
/// Size of the text of tabs, in points.
const TEXT: f32 = 12.0;
/// Room for the sign that closes a tab, in points.
const CLOSE: f32 = 16.0;

/// Shows the panels of one frame.
pub struct DockTabs<'a> {
    panels: &'a mut [Box<dyn Panel>],
    state: &'a mut EditorState,
    /// The tabs that show no bar: those of the viewport while it is alone.
    without_bar: Option<TileId>,
    /// The artist has dragged a line between panels.
    pub is_resized: bool,
    /// The artist has changed the layout.
    pub is_changed: bool,
    /// The panels to close.
    pub closed: Vec<TileId>,
}

impl<'a> DockTabs<'a> {
    /// For these panels; these tabs show no bar.
    pub fn new(panels: &'a mut [Box<dyn Panel>], state: &'a mut EditorState, without_bar: Option<TileId>) -> Self {
        Self { panels, state, without_bar, is_resized: false, is_changed: false, closed: Vec::new() }
    }

    fn is_fixed(&self, tiles: &Tiles<usize>, id: TileId) -> bool {
        match tiles.get(id) {
            Some(Tile::Pane(index)) => is_fixed(self.panels[*index].as_ref()),
            Some(Tile::Container(container)) => container.children().any(|child| self.is_fixed(tiles, *child)),
            None => false,
        }
    }
}

/// Whether this panel is always there.
pub fn is_fixed(panel: &dyn Panel) -> bool {
    panel.place() == PanelPlace::Center
}

/// Which parts of the tree are merged: each panel keeps a bar of tabs, by which it is dragged.
pub fn simplification() -> SimplificationOptions {
    SimplificationOptions { all_panes_must_have_tabs: true, flatten_tabs_in_tabs: true, ..Default::default() }
}

impl Behavior<usize> for DockTabs<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut usize) -> UiResponse {
        let panel = &mut self.panels[*pane];
        let whole = ui.max_rect();
        let margin = match panel.place() {
            PanelPlace::Center | PanelPlace::Beside(_) => Margin::ZERO,
            PanelPlace::Lower(_) => Margin::symmetric(8, 5),
            _ => Margin::same(8),
        };
        let is_view = matches!(panel.place(), PanelPlace::Center | PanelPlace::Beside(_));
        let fill = if is_view { theme::LINE } else { theme::PANEL };
        ui.painter().rect_filled(whole, 0.0, fill);
        // The panel's id, not the place, identifies its widgets: it can be moved while it is in use.
        let builder = UiBuilder::new().scope_id(Id::unique(panel.id())).max_rect(whole - margin);
        let mut inner = ui.new_child(builder);
        inner.set_clip_rect(whole.intersect(ui.clip_rect()));
        panel.ui(self.state, &mut inner);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &usize) -> WidgetText {
        self.panels[*pane].title().into()
    }

    fn is_tab_closable(&self, tiles: &Tiles<usize>, id: TileId) -> bool {
        !self.is_fixed(tiles, id)
    }

    fn is_tile_draggable(&self, tiles: &Tiles<usize>, id: TileId) -> bool {
        !self.is_fixed(tiles, id)
    }

    fn is_tab_bar_visible(&self, id: TileId, _: &Tabs) -> bool {
        self.without_bar != Some(id)
    }

    fn tab_ui(&mut self, tiles: &mut Tiles<usize>, ui: &mut Ui, id: Id, tile: TileId, tab: &TabState) -> Response {
        let title = self.tab_title_for_tile(tiles, tile).text().to_owned();
        let color = if tab.active { theme::TEXT } else { theme::WEAK };
        let galley = ui.painter().layout_no_wrap(title.clone(), FontId::proportional(TEXT), color.into());
        let close = if tab.closable { CLOSE + 4.0 } else { 0.0 };
        let (_, rect) = ui.allocate_space(vec2(galley.size().x + 20.0 + close, ui.available_height()));
        let is_draggable = self.is_tile_draggable(tiles, tile);
        let sense = if is_draggable { Sense::click_and_drag() } else { Sense::click() };
        let response = ui.interact(rect, id, sense);
        response.widget_info(|| WidgetInfo::selected(Role::Tab, ui.is_enabled(), tab.active, &title));
        let mut closes = response.middle_clicked();
        if !tab.is_being_dragged {
            let is_over = ui.rect_contains_pointer(rect);
            if tab.active {
                ui.painter().rect_filled(rect, 0.0, theme::PANEL);
            }
            let at = Align2::LEFT_CENTER.align_size_within_rect(galley.size(), rect.shrink2(vec2(10.0, 0.0)));
            ui.painter().galley(at.min, galley, color.into());
            if tab.closable {
                let place =
                    Rect::from_center_size(rect.right_center() - vec2(4.0 + 0.5 * CLOSE, 0.0), Vec2::splat(CLOSE));
                let cross = ui.interact(place, id.with("close"), Sense::click());
                cross.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Close {title}")));
                if is_over || cross.has_focus() {
                    let color = if cross.hovered() || cross.has_focus() { theme::TEXT } else { theme::FAINT };
                    icons::paint_icon(ui.painter(), place.shrink(2.0), ICON_CLOSE, color);
                }
                closes |= cross.on_hover_text(format!("Closes {title}; View › Panels opens it again")).clicked();
            }
        }
        let response = if is_draggable {
            response.on_hover_text(format!("{title}: drag it to another place")).on_hover_cursor(CursorIcon::Grab)
        } else {
            response
        };
        response.context_menu(|ui| {
            ui.set_min_width(150.0);
            closes |= ui.add_enabled(tab.closable, egui::Button::new("Close")).clicked();
            if ui.button("Reset layout").clicked() {
                self.state.requests.push(Request::ResetLayout);
            }
        });
        if closes && tab.closable {
            self.closed.push(tile);
            self.is_changed = true;
        }
        response
    }

    fn drag_ui(&mut self, tiles: &Tiles<usize>, ui: &mut Ui, tile: TileId) {
        egui::Frame::popup(ui.style()).show(ui, |ui| ui.label(self.tab_title_for_tile(tiles, tile)));
    }

    fn tab_bar_height(&self, _: &Style) -> f32 {
        BAR
    }

    fn gap_width(&self, _: &Style) -> f32 {
        GAP
    }

    fn min_size(&self) -> f32 {
        LEAST
    }

    fn simplification_options(&self) -> SimplificationOptions {
        simplification()
    }

    fn resize_stroke(&self, _: &Style, resize: ResizeState) -> Stroke {
        match resize {
            ResizeState::Idle => Stroke::new(GAP, theme::LINE),
            ResizeState::Hovering | ResizeState::Dragging => Stroke::new(2.0, theme::ACCENT),
        }
    }

    fn tab_bar_color(&self, _: &Visuals) -> Color32 {
        theme::BAR.into()
    }

    /// In front of the picture, which is painted later than the bars.
    fn paint_drag_preview(&self, _: &Visuals, painter: &Painter, _: Option<Rect>, place: Rect) {
        let painter = painter.clone().with_layer_id(LayerId::new(Order::Foreground, Id::unique("place of a panel")));
        painter.rect(place, 4.0, theme::ACCENT.gamma_multiply(0.25), (2.0, theme::ACCENT), StrokeKind::Inside);
    }

    fn on_edit(&mut self, action: EditAction) {
        self.is_resized |= action == EditAction::TileResized;
        self.is_changed |= action != EditAction::TileDragged;
    }
}
