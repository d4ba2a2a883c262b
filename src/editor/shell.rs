//! The layout of panels.

use egui::{CentralPanel, Frame, Margin, Ui};

use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, PanelEntry};
use super::theme;

/// Maximum width of a side panel, in points.
const WIDEST: f32 = 520.0;

/// The panels with their places.
pub struct Shell {
    panels: Vec<Placed>,
}

struct Placed {
    panel: Box<dyn Panel>,
    place: PanelPlace,
    is_open: bool,
}

impl Placed {
    /// Bars always stay; side panels can be hidden.
    fn can_close(&self) -> bool {
        matches!(self.place, PanelPlace::Left(..) | PanelPlace::Right(..))
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
            PanelPlace::Left(..) => 2,
            PanelPlace::Right(..) => 3,
            PanelPlace::Center => 4,
        });
        Self { panels }
    }

    /// The number of panels.
    pub fn len(&self) -> usize {
        self.panels.len()
    }

    /// Shows the panel of this index. Call it for all panels in order; the caller carries out the requests of each
    /// before the next.
    pub fn show(&mut self, index: usize, state: &mut EditorState, ui: &mut Ui) {
        let Some(Placed { panel, place, is_open: true }) = self.panels.get_mut(index) else { return };
        let frame = |fill, margin| Frame::new().fill(fill).inner_margin(margin);
        let side = frame(theme::PANEL, Margin::same(8));
        let id = panel.id();
        let add = |ui: &mut Ui| panel.ui(state, ui);
        match *place {
            PanelPlace::Top => {
                egui::Panel::top(id).frame(frame(theme::BAR, Margin::symmetric(8, 5))).show(ui, add);
            }
            PanelPlace::Bottom => {
                egui::Panel::bottom(id).frame(frame(theme::BAR, Margin::symmetric(10, 3))).show(ui, add);
            }
            PanelPlace::Left(width, least) => {
                let panel = egui::Panel::left(id).frame(side);
                panel.default_size(width).size_range(least..=WIDEST).show(ui, add);
            }
            PanelPlace::Right(width, least) => {
                let panel = egui::Panel::right(id).frame(side);
                panel.default_size(width).size_range(least..=WIDEST).show(ui, add);
            }
            PanelPlace::Center => {
                CentralPanel::default().frame(Frame::new().fill(theme::LINE)).show(ui, add);
            }
        }
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
    fn the_panels_have_names_of_their_own() {
        let panels = super::super::panels::all();
        let ids: HashSet<_> = panels.iter().map(|panel| panel.id()).collect();
        let titles: HashSet<_> = panels.iter().map(|panel| panel.title()).collect();
        assert!(ids.len() == panels.len() && titles.len() == panels.len());
        let central = panels.iter().filter(|panel| panel.place() == PanelPlace::Center).count();
        assert_eq!(central, 1);
    }
}
