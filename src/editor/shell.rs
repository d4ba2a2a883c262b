//! The layout of panels: bars at the top and the bottom, and docked panels between them.

use egui::{CentralPanel, Frame, Margin, Ui};

use super::dock::Dock;
use super::dock_tabs::is_fixed;
use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, PanelEntry};
use super::theme;
use isolith_document::PanelLayout;

/// The panels with their places.
pub struct Shell {
    bars: Vec<Box<dyn Panel>>,
    dock: Dock,
}

impl Shell {
    /// Creates a shell with each panel in its default place.
    pub fn new(panels: Vec<Box<dyn Panel>>) -> Self {
        let (mut bars, docked): (Vec<_>, Vec<_>) =
            panels.into_iter().partition(|panel| matches!(panel.place(), PanelPlace::Top | PanelPlace::Bottom));
        bars.sort_by_key(|panel| panel.place() == PanelPlace::Bottom);
        Self { bars, dock: Dock::new(docked) }
    }

    /// The number of parts that are shown one after the other: the bars, and the docked panels together.
    pub fn len(&self) -> usize {
        self.bars.len() + 1
    }

    /// Shows a part. Call it for all parts in order; the caller carries out the requests of each before the next.
    pub fn show(&mut self, index: usize, state: &mut EditorState, ui: &mut Ui) {
        let Some(panel) = self.bars.get_mut(index) else {
            CentralPanel::default().frame(Frame::new().fill(*theme::LINE)).show(ui, |ui| self.dock.show(state, ui));
            return;
        };
        let frame = |margin| Frame::new().fill(*theme::BAR).inner_margin(margin);
        let (id, place) = (panel.id(), panel.place());
        let mut add = |ui: &mut Ui| panel.ui(state, ui);
        match place {
            PanelPlace::Top => egui::Panel::top(id).frame(frame(Margin::symmetric(8, 5))).show(ui, &mut add),
            _ => egui::Panel::bottom(id).frame(frame(Margin::symmetric(10, 3))).show(ui, &mut add),
        };
    }

    /// Toggles the panel of this id.
    pub fn toggle(&mut self, id: &str) {
        self.dock.toggle(id);
    }

    /// Arranges the panels by a layout, or as usual.
    pub fn arrange(&mut self, layout: Option<&PanelLayout>) {
        self.dock.arrange(layout);
    }

    /// Shows 1, 2 or 4 viewports in the room of those that are shown, in points.
    pub fn split(&mut self, count: usize, room: egui::Vec2) {
        self.dock.split(count, room);
    }

    /// The layout, if the artist has changed it since the last call.
    pub fn take_changed_layout(&mut self) -> Option<PanelLayout> {
        self.dock.take_change().then(|| self.dock.layout())
    }

    /// The panels that can be hidden.
    pub fn entries(&self) -> Vec<PanelEntry> {
        let panels = self.dock.panels().iter().enumerate().filter(|(_, panel)| !is_fixed(panel.as_ref()));
        let entries = panels.map(|(index, panel)| PanelEntry {
            id: panel.id(),
            title: panel.title(),
            is_open: self.dock.is_open(index),
        });
        entries.collect()
    }

    /// Tells all panels that another document is open.
    pub fn forget(&mut self) {
        self.bars.iter_mut().chain(self.dock.panels_mut()).for_each(|panel| panel.forget());
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::sync::mpsc::{Receiver, Sender, channel};

    use egui::{Rect, vec2};
    use egui_kittest::Harness;
    use isolith_document::{Docked, DockedPart};

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

    const LEFT: PanelPlace = PanelPlace::Left(100.0, 50.0);
    const BELOW: PanelPlace = PanelPlace::BelowLeft(150.0);
    const RIGHT: PanelPlace = PanelPlace::Right(120.0, 50.0);
    const LOWER: PanelPlace = PanelPlace::Lower(130.0);

    type Shown = Receiver<(&'static str, Rect)>;

    fn window(places: &[(&'static str, PanelPlace)]) -> (Harness<'static, (Shell, EditorState)>, Shown) {
        let (sender, shown) = channel();
        let probes = places.iter().map(|(id, place)| Box::new(Probe(id, *place, sender.clone())) as Box<dyn Panel>);
        let state = (Shell::new(probes.collect()), EditorState::default());
        let mut harness = Harness::builder().with_size(vec2(800.0, 600.0)).build_ui_state(
            |ui, (shell, state): &mut (Shell, EditorState)| {
                (0..shell.len()).for_each(|index| shell.show(index, state, ui));
            },
            state,
        );
        harness.run();
        (harness, shown)
    }

    /// The place of each panel in the last frame; `None` for those that are hidden.
    fn places<const N: usize>(
        harness: &mut Harness<'static, (Shell, EditorState)>,
        shown: &Shown,
        ids: [&str; N],
    ) -> [Option<Rect>; N] {
        harness.run();
        let _ = shown.try_iter().count();
        harness.step();
        let last: Vec<_> = shown.try_iter().collect();
        ids.map(|id| last.iter().rfind(|(name, _)| *name == id).map(|found| found.1))
    }

    #[test]
    fn panels_stand_where_they_ask_to_and_can_be_hidden() {
        // Any order: the center takes the remaining area.
        let (mut harness, shown) =
            window(&[("c", PanelPlace::Center), ("low", LOWER), ("r", RIGHT), ("b", BELOW), ("l", LEFT)]);
        let names: Vec<_> = harness.state().0.entries().iter().map(|entry| entry.id).collect();
        assert_eq!(names, ["low", "r", "b", "l"], "the center is always there");
        let ids = ["l", "b", "c", "r", "low"];
        let [Some(l), Some(b), Some(c), Some(r), Some(low)] = places(&mut harness, &shown, ids) else {
            panic!("all are shown")
        };
        assert!(l.right() <= c.left() && c.right() <= r.left() && r.bottom() < low.top(), "{l} {c} {r} {low}");
        assert!(l.bottom() < b.top() && l.x_range() == b.x_range(), "{l} {b}");
        assert!(low.left() < 20.0 && low.right() > 780.0, "{low}");
        assert!(!harness.state().1.view.show_grid, "a panel changes the state");
        harness.state_mut().0.toggle("l");
        harness.state_mut().0.toggle("c");
        let [None, Some(alone), Some(same), ..] = places(&mut harness, &shown, ids) else { panic!("one is hidden") };
        assert!(alone.top() < 60.0 && same == c, "{alone} {same} {c}");
        harness.state_mut().0.toggle("b");
        let [None, None, Some(wide), ..] = places(&mut harness, &shown, ids) else { panic!("two are hidden") };
        assert!(wide.left() < 12.0, "{wide}");
        harness.state_mut().0.toggle("b");
        harness.state_mut().0.toggle("l");
        assert_eq!(places(&mut harness, &shown, ids), [Some(l), Some(b), Some(c), Some(r), Some(low)], "as it was");
    }

    #[test]
    fn panels_keep_their_width_when_the_window_changes() {
        let (mut harness, shown) = window(&[("c", PanelPlace::Center), ("r", RIGHT), ("l", LEFT)]);
        let widths = |places: [Option<Rect>; 3]| places.map(|place| place.expect("shown").width());
        let [l, c, r] = widths(places(&mut harness, &shown, ["l", "c", "r"]));
        harness.set_size(vec2(1200.0, 700.0));
        let [wide_l, wide_c, wide_r] = widths(places(&mut harness, &shown, ["l", "c", "r"]));
        assert_eq!([l, r], [wide_l, wide_r]);
        assert!((wide_c - c - 400.0).abs() < 1.0, "{c} {wide_c}");
        // Too small for all: the center keeps some room, and everything comes back.
        harness.set_size(vec2(300.0, 400.0));
        let [_, small, _] = widths(places(&mut harness, &shown, ["l", "c", "r"]));
        assert!(small >= 140.0, "{small}");
        harness.set_size(vec2(800.0, 600.0));
        assert_eq!(widths(places(&mut harness, &shown, ["l", "c", "r"])), [l, c, r]);
    }

    #[test]
    fn a_layout_comes_back_and_a_poor_one_loses_no_panel() {
        let all = [("c", PanelPlace::Center), ("low", LOWER), ("r", RIGHT), ("b", BELOW), ("l", LEFT)];
        let ids = ["l", "b", "c", "r", "low"];
        let (mut harness, shown) = window(&all);
        let before = places(&mut harness, &shown, ids);
        let tabs = |panels: &[&str]| Docked::Tabs {
            panels: panels.iter().map(|id| (*id).to_owned()).collect(),
            front: panels.last().map(|id| (*id).to_owned()),
        };
        let part = |size, part| DockedPart { size, part };
        let root = Docked::Row(vec![
            part(180.0, tabs(&["l", "r"])),
            part(0.0, tabs(&["c"])),
            part(150.0, tabs(&["b", "gone"])),
        ]);
        let layout = PanelLayout { root, closed: vec!["b".into(), "c".into()] };
        harness.state_mut().0.arrange(Some(&layout));
        let [None, None, Some(c), Some(r), Some(low)] = places(&mut harness, &shown, ids) else {
            panic!("what is closed or behind is hidden, the center never, and the missing one comes back")
        };
        assert!(r.right() <= c.left() && (r.width() - 164.0).abs() < 2.0 && low.top() > c.bottom(), "{r} {c} {low}");
        let kept = harness.state_mut().0.dock.layout();
        harness.state_mut().0.arrange(None);
        assert_eq!(places(&mut harness, &shown, ids), before, "reset");
        harness.state_mut().0.arrange(Some(&kept));
        assert_eq!(places(&mut harness, &shown, ids), [None, None, Some(c), Some(r), Some(low)]);
        assert_eq!(harness.state_mut().0.dock.layout(), kept);
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
