//! The layout of panels.

use egui::{CentralPanel, CursorIcon, Frame, Id, Margin, Rect, Sense, Ui, UiBuilder, vec2};

use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, PanelEntry};
use super::theme;

/// Maximum width of a side panel, in points.
const WIDEST: f32 = 520.0;

/// Default width of the lower panel at the left while the upper one is hidden, in points.
const ALONE: f32 = 240.0;
/// Room between the panels at the left, in points.
const GAP: f32 = 12.0;
/// Minimum height of the lower panel at the left, in points, and its maximum as a share of the side.
const LEAST_BELOW: f32 = 90.0;
const MOST_BELOW: f32 = 0.65;

/// The panels with their places.
pub struct Shell {
    panels: Vec<Placed>,
    /// Height of the lower panel at the left, in points; `None` before the first frame.
    lower_height: Option<f32>,
    /// What the panel at the left leaves to the one below it, in this frame.
    below_left: Option<Rect>,
}

struct Placed {
    panel: Box<dyn Panel>,
    place: PanelPlace,
    is_open: bool,
}

impl Placed {
    /// Bars always stay; side panels can be hidden.
    fn can_close(&self) -> bool {
        matches!(
            self.place,
            PanelPlace::Lower(_) | PanelPlace::Left(..) | PanelPlace::BelowLeft(_) | PanelPlace::Right(..)
        )
    }
}

impl Shell {
    /// Creates a shell with each panel in its default place.
    pub fn new(panels: Vec<Box<dyn Panel>>) -> Self {
        let placed = |panel: Box<dyn Panel>| Placed { place: panel.place(), panel, is_open: true };
        let mut panels: Vec<_> = panels.into_iter().map(placed).collect();
        // Bars take the whole width; the center takes the remaining area.
        panels.sort_by_key(|placed| match placed.place {
            PanelPlace::Top => 0,
            PanelPlace::Bottom => 1,
            PanelPlace::Lower(_) => 2,
            PanelPlace::Left(..) => 3,
            PanelPlace::BelowLeft(_) => 4,
            PanelPlace::Right(..) => 5,
            PanelPlace::Center => 6,
        });
        Self { panels, lower_height: None, below_left: None }
    }

    /// The number of panels.
    pub fn len(&self) -> usize {
        self.panels.len()
    }

    /// Shows the panel of this index. Call it for all panels in order; the caller carries out the requests of each
    /// before the next.
    pub fn show(&mut self, index: usize, state: &mut EditorState, ui: &mut Ui) {
        let lower = self.lower_height();
        let Some(Placed { panel, place, is_open: true }) = self.panels.get_mut(index) else { return };
        let frame = |fill, margin| Frame::new().fill(fill).inner_margin(margin);
        let side = frame(theme::PANEL, Margin::same(8));
        let id = panel.id();
        let slim = panel.slim_height(state);
        let mut add = |ui: &mut Ui| panel.ui(state, ui);
        match *place {
            PanelPlace::Top => {
                egui::Panel::top(id).frame(frame(theme::BAR, Margin::symmetric(8, 5))).show(ui, add);
            }
            PanelPlace::Bottom => {
                egui::Panel::bottom(id).frame(frame(theme::BAR, Margin::symmetric(10, 3))).show(ui, add);
            }
            PanelPlace::Lower(height) => {
                let frame = frame(theme::PANEL, Margin::symmetric(8, 5));
                match slim {
                    Some(height) => {
                        egui::Panel::bottom(Id::unique(id).with("slim")).resizable(false).exact_size(height + 10.0)
                    }
                    None => {
                        egui::Panel::bottom(id).resizable(true).default_size(height).size_range(LEAST_BELOW..=WIDEST)
                    }
                }
                .frame(frame)
                .show(ui, add);
            }
            PanelPlace::Left(width, least) => {
                let panel = egui::Panel::left(id).frame(side).default_size(width).size_range(least..=WIDEST);
                self.below_left = panel.show(ui, |ui| upper_part(ui, lower, add)).inner;
            }
            PanelPlace::BelowLeft(_) => match self.below_left.take() {
                Some(rect) => {
                    add(&mut ui.new_child(UiBuilder::new().scope_id(Id::unique(id)).max_rect(rect)));
                    let height = divider(ui, rect);
                    self.lower_height = height.or(self.lower_height);
                }
                // It has the side for itself.
                None => {
                    let panel = egui::Panel::left(id).frame(side);
                    panel.default_size(ALONE).size_range(0.5 * ALONE..=WIDEST).show(ui, add);
                }
            },
            PanelPlace::Right(width, least) => {
                let panel = egui::Panel::right(id).frame(side);
                panel.default_size(width).size_range(least..=WIDEST).show(ui, add);
            }
            PanelPlace::Center => {
                CentralPanel::default().frame(Frame::new().fill(theme::LINE)).show(ui, add);
            }
        }
    }

    /// Height of the lower panel at the left, if it is open.
    fn lower_height(&self) -> Option<f32> {
        let heights = self.panels.iter().map(|placed| match placed.place {
            PanelPlace::BelowLeft(height) if placed.is_open => Some(self.lower_height.unwrap_or(height)),
            _ => None,
        });
        heights.flatten().next()
    }

    /// Toggles the panel of this id.
    pub fn toggle(&mut self, id: &str) {
        for placed in self.panels.iter_mut().filter(|placed| placed.panel.id() == id && placed.can_close()) {
            placed.is_open ^= true;
        }
    }

    /// The panels that can be hidden.
    pub fn entries(&self) -> Vec<PanelEntry> {
        let entry = |placed: &Placed| PanelEntry {
            id: placed.panel.id(),
            title: placed.panel.title(),
            is_open: placed.is_open,
        };
        self.panels.iter().filter(|placed| placed.can_close()).map(entry).collect()
    }

    /// Tells all panels that another document is open.
    pub fn forget(&mut self) {
        self.panels.iter_mut().for_each(|placed| placed.panel.forget());
    }
}

/// Shows a panel in the upper part of `ui` if the lower part, of this height, is for another; returns the lower part.
fn upper_part(ui: &mut Ui, lower: Option<f32>, add: impl FnOnce(&mut Ui)) -> Option<Rect> {
    let Some(height) = lower else {
        add(ui);
        return None;
    };
    let whole = ui.available_rect_before_wrap();
    let most = (whole.height() * MOST_BELOW).max(LEAST_BELOW);
    let edge = (whole.bottom() - height.clamp(LEAST_BELOW, most)).round();
    let mut upper = ui.new_child(UiBuilder::new().max_rect(whole.with_max_y(edge - 0.5 * GAP)));
    upper.shrink_clip_rect(whole.with_max_y(edge - 0.5 * GAP).expand2(vec2(8.0, 2.0)));
    add(&mut upper);
    ui.allocate_rect(whole, Sense::hover());
    Some(whole.with_min_y(edge + 0.5 * GAP))
}

/// The line above the lower panel; returns the panel's new height if the line is dragged.
fn divider(ui: &Ui, below: Rect) -> Option<f32> {
    let at = below.top() - 0.5 * GAP;
    let rect = Rect::from_x_y_ranges(below.x_range(), at - 0.5 * GAP..=at + 0.5 * GAP);
    let response = ui.interact(rect, Id::unique("divider at the left"), Sense::drag());
    let color = if response.hovered() || response.dragged() { theme::ACCENT } else { theme::LINE };
    ui.painter().hline(below.x_range().expand(8.0), at, (1.0, color));
    response.on_hover_and_drag_cursor(CursorIcon::ResizeVertical);
    let dragged = ui.ctx().is_being_dragged(Id::unique("divider at the left"));
    let pointer = ui.input(|i| i.pointer.interact_pos()).filter(|_| dragged)?;
    Some(below.bottom() - pointer.y)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::sync::mpsc::{Sender, channel};

    use egui_kittest::Harness;

    use super::*;

    struct Probe(&'static str, PanelPlace, Sender<(&'static str, egui::Rect)>);

    impl Panel for Probe {
        fn id(&self) -> &'static str {
            self.0
        }
        fn title(&self) -> &'static str {
            self.0
        }
        fn place(&self) -> PanelPlace {
            self.1
        }
        fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
            state.view.show_grid = false;
            let _ = self.2.send((self.0, ui.max_rect()));
            ui.allocate_space(ui.available_size());
        }
    }

    #[test]
    fn panels_stand_where_the_shell_says_and_can_be_hidden() {
        let (sender, shown) = channel();
        let probe = |id, place| Box::new(Probe(id, place, sender.clone())) as Box<dyn Panel>;
        let (left, right) = (PanelPlace::Left(100.0, 50.0), PanelPlace::Right(120.0, 50.0));
        // Any order: the center takes the remaining area.
        let shell = Shell::new(vec![probe("c", PanelPlace::Center), probe("r", right), probe("l", left)]);
        let names: Vec<_> = shell.entries().iter().map(|entry| entry.id).collect();
        assert_eq!(names, ["l", "r"], "the center is always there");
        let mut harness = Harness::builder().with_size(egui::vec2(600.0, 400.0)).build_ui_state(
            |ui, (shell, state): &mut (Shell, EditorState)| {
                (0..shell.len()).for_each(|index| shell.show(index, state, ui));
            },
            (shell, EditorState::default()),
        );
        harness.run();
        let mut places: Vec<_> = shown.try_iter().collect();
        let [l, r, c] = ["l", "r", "c"].map(|id| places.iter().rfind(|(name, _)| *name == id).expect("shown").1);
        assert!(l.right() <= c.left() && c.right() <= r.left(), "{l} {c} {r}");
        assert!(!harness.state().1.view.show_grid, "a panel changes the state");
        harness.state_mut().0.toggle("l");
        harness.state_mut().0.toggle("c");
        harness.run();
        places = shown.try_iter().collect();
        assert!(places.iter().any(|(id, rect)| *id == "c" && rect.left() < c.left()), "{places:?}");
        assert!(places.iter().all(|(id, _)| *id != "l"));
    }

    #[test]
    fn a_panel_at_the_left_stands_below_another_or_alone() {
        let (sender, shown) = channel();
        let probe = |id, place| Box::new(Probe(id, place, sender.clone())) as Box<dyn Panel>;
        let panels = vec![
            probe("c", PanelPlace::Center),
            probe("b", PanelPlace::BelowLeft(150.0)),
            probe("l", PanelPlace::Left(100.0, 50.0)),
        ];
        let mut harness = Harness::builder().with_size(egui::vec2(600.0, 400.0)).build_ui_state(
            |ui, (shell, state): &mut (Shell, EditorState)| {
                (0..shell.len()).for_each(|index| shell.show(index, state, ui));
            },
            (Shell::new(panels), EditorState::default()),
        );
        let places = |harness: &mut Harness<'_, (Shell, EditorState)>, toggled: &str| {
            harness.state_mut().0.toggle(toggled);
            harness.run();
            let places: Vec<_> = shown.try_iter().collect();
            ["l", "b", "c"].map(|id| places.iter().rfind(|(name, _)| *name == id).map(|found| found.1))
        };
        let [Some(l), Some(b), Some(c)] = places(&mut harness, "") else { panic!("all three") };
        assert!(l.bottom() < b.top() && l.x_range() == b.x_range() && b.right() <= c.left(), "{l} {b} {c}");
        assert!((b.height() - 150.0).abs() < 20.0, "{b}");
        let [None, Some(b), Some(c)] = places(&mut harness, "l") else { panic!("the upper one is hidden") };
        assert!(b.top() < 20.0 && b.right() <= c.left(), "{b} {c}");
        places(&mut harness, "l");
        let [Some(l), None, _] = places(&mut harness, "b") else { panic!("the lower one is hidden") };
        assert!(l.bottom() > 380.0, "{l}");
    }

    #[test]
    fn the_panels_have_names_of_their_own() {
        let panels = super::super::panels::all();
        let ids: HashSet<_> = panels.iter().map(|panel| panel.id()).collect();
        let titles: HashSet<_> = panels.iter().map(|panel| panel.title()).collect();
        assert!(ids.len() == panels.len() && titles.len() == panels.len());
        let central = panels.iter().filter(|panel| panel.place() == PanelPlace::Center).count();
        assert_eq!(central, 1);
    }
}
