//! What helps at the start: welcome, tour, help.

use egui::{Context, Id, Pos2};

use super::help::HelpTab;
use super::root::Editor;
use super::state::Example;
use super::welcome::{ThumbnailOf, WelcomeChoice};
use super::{doctor_view, help, history_list, render_view};
use isolith_session::ReadDocument;

impl Editor {
    /// Sets the scenes to start from, and the pictures of them and of the examples, by their names.
    pub fn set_templates(&mut self, templates: Vec<Example>, thumbnail_of: ThumbnailOf) {
        self.welcome.templates = templates;
        self.welcome.thumbnail_of = Some(thumbnail_of);
    }

    /// Shows the welcome, unless the user does without it.
    pub fn welcome_at_start(&mut self) {
        self.welcome.is_open = !self.state.preferences.values().skips_welcome;
    }

    /// Shows the welcome.
    pub(super) fn open_welcome(&mut self) {
        self.welcome.is_open = true;
    }

    /// The reader of a template, and its name.
    pub(super) fn template(&self, index: usize) -> Option<(String, ReadDocument)> {
        self.welcome.templates.get(index).map(|template| (template.name.clone(), template.open.clone()))
    }

    /// Opens the page of the panel under the pointer.
    pub(super) fn open_help(&mut self, ctx: &Context) {
        let pointer = ctx.pointer_latest_pos().unwrap_or_default();
        let id = self.panel_at(pointer, ctx);
        self.help.open_page(id);
    }

    /// Shows what helps, in front of the panels.
    pub(super) fn show_first_run(&mut self, ctx: &Context) {
        // A question about lost work comes first.
        if !self.is_offering() {
            let choice = self.welcome.show(&mut self.state, ctx);
            self.welcome.follow_pictures(&self.state, self.studio.as_ref(), ctx);
            if choice.is_some() {
                self.welcome.is_open = false;
            }
            match choice {
                Some(WelcomeChoice::Intend(intent)) => self.intend(intent, ctx),
                Some(WelcomeChoice::Run(command)) => self.run(command, ctx),
                Some(WelcomeChoice::Close) | None => {}
            }
        }
        if !self.welcome.is_open && !self.help.is_open && !self.has_dialog() {
            self.tour.show(&self.state, ctx);
        }
        self.help.show(ctx);
    }

    /// Closes the window beside the scene that lies above the others, or ends the tour; false if none is open. A picture that is being
    /// rendered keeps its own.
    pub(super) fn close_foremost(&mut self, ctx: &Context) -> bool {
        let is_rendering = self.is_rendering();
        let windows = [
            (&mut self.help.is_open, help::window_id(), true),
            (&mut self.state.show_history, history_list::window_id(), true),
            (&mut self.doctor.is_open, doctor_view::window_id(), true),
            (&mut self.rendering.is_open, render_view::window_id(), !is_rendering),
        ];
        let height = |id: Id| ctx.memory(|memory| memory.layer_ids().position(|layer| layer.id == id));
        let open = windows.into_iter().filter(|(is_open, _, may_close)| **is_open && *may_close);
        let Some((is_open, ..)) = open.max_by_key(|(_, id, _)| height(*id)) else { return self.tour.end() };
        *is_open = false;
        true
    }

    /// Opens the help with its keys, or with what is new.
    pub(super) fn open_help_tab(&mut self, tab: HelpTab) {
        self.help.open(tab);
    }

    /// The id of the help page about what is at a point.
    fn panel_at(&self, at: Pos2, ctx: &Context) -> &'static str {
        let (view, window) = (self.state.view.rect, ctx.content_rect());
        if at.y < view.top() {
            "toolbar"
        } else if at.x < view.left() {
            // The materials stand below the outliner.
            if at.y > view.center().y { "materials" } else { "outliner" }
        } else if at.x > view.right() {
            "inspector"
        } else if at.y > window.bottom() - 28.0 {
            "status"
        } else if at.y > view.bottom() {
            "timeline"
        } else {
            "viewport"
        }
    }
}
