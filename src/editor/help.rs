//! The help window: a page for each panel, the keys of the keymap, and what is new.

use egui::{Context, Grid, Id, Label, RichText, ScrollArea, TextEdit, Ui, Window, vec2};

use super::changelog::{NewsLine, news};
use super::commands::command::Command;
use super::help_pages::PAGES;
use super::keymap::{KeyBindings, shown};
use super::theme;

/// Size of the content, in points.
const SIZE: egui::Vec2 = vec2(620.0, 420.0);
/// Width of the list of pages, in points.
const LIST: f32 = 140.0;
/// Versions of the changelog that are shown.
const VERSIONS: usize = 2;
/// What the mouse does in the viewport, for the list of keys.
const MOUSE: [(&str, &str); 9] = [
    ("Orbit", "Drag"),
    ("Pan", "Shift drag"),
    ("Zoom", "Wheel, or Alt and the right button"),
    ("Select", "Click; Shift adds"),
    ("Enter a group", "Double click"),
    ("List what lies below", "Alt click"),
    ("Select by a box", "Ctrl drag"),
    ("Snap while dragging", "Ctrl"),
    ("Be precise while dragging", "Shift"),
];

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HelpTab {
    /// Pages.
    #[default]
    Panels,
    /// Keys.
    Keys,
    /// Changes.
    News,
}

/// State of the window.
#[derive(Default)]
pub struct Help {
    /// Whether it is open.
    pub is_open: bool,
    tab: HelpTab,
    page: usize,
    search: String,
    /// The lines of the changelog, read on the first request.
    news: Vec<NewsLine>,
}

/// The window.
pub(super) fn window_id() -> Id {
    Id::unique("help")
}

impl Help {
    /// Opens the window with a tab.
    pub fn open(&mut self, tab: HelpTab) {
        (self.is_open, self.tab) = (true, tab);
    }

    /// Opens the page of a panel.
    pub fn open_page(&mut self, id: &str) {
        self.page = PAGES.iter().position(|page| page.id == id).unwrap_or(self.page);
        self.open(HelpTab::Panels);
    }

    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &Context) {
        let mut is_open = self.is_open;
        let room = ctx.content_rect();
        Window::new("Help")
            .id(window_id())
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_pos(room.center() - 0.5 * SIZE - vec2(0.0, 40.0))
            .show(ctx, |ui| {
                ui.set_width(SIZE.x.min(room.width() - 60.0));
                ui.horizontal(|ui| {
                    for (tab, name) in
                        [(HelpTab::Panels, "Panels"), (HelpTab::Keys, "Keys"), (HelpTab::News, "What's new")]
                    {
                        ui.selectable_value(&mut self.tab, tab, name);
                    }
                });
                ui.separator();
                let height = SIZE.y.min(room.height() - 200.0);
                match self.tab {
                    HelpTab::Panels => self.pages(height, ui),
                    HelpTab::Keys => self.keys(height, ui),
                    HelpTab::News => self.changes(height, ui),
                }
            });
        self.is_open = is_open;
    }

    fn pages(&mut self, height: f32, ui: &mut Ui) {
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(LIST);
                ui.set_min_height(height);
                for (index, page) in PAGES.iter().enumerate() {
                    ui.selectable_value(&mut self.page, index, page.title);
                }
            });
            ui.separator();
            ui.vertical(|ui| {
                let Some(page) = PAGES.get(self.page) else { return };
                ScrollArea::vertical().max_height(height).auto_shrink([false, false]).show(ui, |ui| {
                    ui.label(RichText::new(page.title).heading().color(ui.visuals().strong_text_color()));
                    ui.add(Label::new(page.purpose).wrap());
                    ui.add_space(8.0);
                    for (action, how) in page.actions {
                        ui.label(RichText::new(*action).strong().color(ui.visuals().strong_text_color()));
                        ui.add(Label::new(RichText::new(*how).weak()).wrap());
                        ui.add_space(3.0);
                    }
                });
            });
        });
    }

    fn keys(&mut self, height: f32, ui: &mut Ui) {
        let bindings = KeyBindings::of(ui.ctx());
        ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut self.search).hint_text("Search keys…").desired_width(260.0);
            let response = ui.add(field);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Search keys"));
            ui.label(RichText::new(format!("Keymap: {}", bindings.keymap().label())).weak());
        });
        let rows = key_rows(ui.ctx(), &bindings, &self.search);
        ScrollArea::vertical().max_height(height - 40.0).auto_shrink([false, false]).show(ui, |ui| {
            if rows.is_empty() {
                ui.label(RichText::new("No key does this.").weak());
            }
            Grid::new("keys").num_columns(2).striped(true).spacing(vec2(24.0, 5.0)).min_col_width(170.0).show(
                ui,
                |ui| {
                    for (what, keys) in rows {
                        ui.label(what);
                        ui.label(RichText::new(keys).monospace().color(theme::ACCENT));
                        ui.end_row();
                    }
                },
            );
        });
    }

    fn changes(&mut self, height: f32, ui: &mut Ui) {
        if self.news.is_empty() {
            self.news = news(VERSIONS);
        }
        ScrollArea::vertical().max_height(height).auto_shrink([false, false]).show(ui, |ui| {
            for line in &self.news {
                match line {
                    NewsLine::Version(text) => {
                        ui.label(RichText::new(text).heading().color(ui.visuals().strong_text_color()));
                    }
                    NewsLine::Heading(text) => {
                        ui.add_space(6.0);
                        ui.label(RichText::new(text).strong().color(theme::ACCENT));
                    }
                    NewsLine::Item(text) => {
                        ui.horizontal_top(|ui| {
                            ui.label("•");
                            ui.add(Label::new(text).wrap());
                        });
                    }
                }
            }
        });
    }
}

/// Commands with their keys, and gestures of the mouse, whose names or keys contain the text.
fn key_rows(ctx: &Context, bindings: &KeyBindings, search: &str) -> Vec<(String, String)> {
    let of_command = |command: Command| {
        let info = command.info();
        let keys: Vec<_> = info.keys_in(bindings).iter().map(|key| shown(ctx, key)).collect();
        (!keys.is_empty()).then(|| (info.label.clone(), keys.join(", ")))
    };
    let mouse = MOUSE.iter().map(|(what, how)| (format!("{what} (viewport)"), (*how).to_owned()));
    let wanted = search.trim().to_lowercase();
    let fits = |(what, keys): &(String, String)| {
        what.to_lowercase().contains(&wanted) || keys.to_lowercase().contains(&wanted)
    };
    Command::all().filter_map(of_command).chain(mouse).filter(fits).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::keymap::Keymap;

    #[test]
    fn every_panel_has_a_page() {
        let pages: HashSet<_> = PAGES.iter().map(|page| page.id).collect();
        assert_eq!(pages.len(), PAGES.len());
        // Those beside the viewport are viewports.
        for panel in crate::panels::all().into_iter().filter(|panel| !panel.id().starts_with("view-")) {
            assert!(pages.contains(panel.id()), "there is no page of help about {}", panel.title());
        }
        assert!(PAGES.iter().all(|page| !page.purpose.is_empty() && !page.actions.is_empty()));
    }

    #[test]
    fn keys_are_those_of_the_keymap_and_found_by_name_and_by_key() {
        let ctx = Context::default();
        let names = |keymap, search: &str| {
            key_rows(&ctx, &KeyBindings::new(keymap, None), search)
                .into_iter()
                .map(|(what, _)| what)
                .collect::<Vec<_>>()
        };
        assert!(names(Keymap::Blender, "move").contains(&"Move".to_owned()));
        assert!(names(Keymap::Blender, "F12").contains(&"Render…".to_owned()));
        assert_ne!(names(Keymap::Blender, ""), names(Keymap::Industry, ""));
        assert!(names(Keymap::Industry, "no such key").is_empty());
        let with_keys = Command::all().filter(|command| !command.info().keys(Keymap::Blender).is_empty()).count();
        assert_eq!(names(Keymap::Blender, "").len(), with_keys + MOUSE.len());
    }
}
