//! The editor: the state below, the shell with its panels above, and the windows in front. Its work with documents and
//! dialogs is in separate files, each an `impl` of [`Editor`].

use std::sync::Arc;
use std::time::Duration;

use egui::{Context, Key, SurrenderFocusOn, Ui, ViewportCommand};

use super::add_palette::AddPalette;
use super::appearance::Appearance;
use super::command_palette::CommandPalette;
use super::commands::command::Command;
use super::conflict::Conflict;
use super::dialogs::Dialogs;
use super::doctor::Doctor;
use super::document_jobs::{Opening, Saving};
use super::help::Help;
use super::messages::Message;
use super::playback::Playback;
use super::preferences_window::PreferencesWindow;
use super::rendering::Rendering;
use super::safekeeping::Safekeeping;
use super::shell::Shell;
use super::snapping::SnapSettings;
use super::state::{EditorState, Example, Request};
use super::tour::Tour;
use super::view_state::{Picture, ViewSettings};
use super::welcome::Welcome;
use super::{below_list, drag_in, history_list, input_order, numbers, panels, theme, widgets};
use isolith_document::{Document, Preferences, RecentFiles};
use isolith_field::FlatScene;
use isolith_jobs::Jobs;
use isolith_mesh::MeshLibrary;
use isolith_session::{Opened, SharedStudio, folder_of};

/// Maximum number of characters of a file's name in the window's title.
const MOST_TITLE: usize = 80;

/// Most samples per pixel that the preferences can ask for.
const MOST_SAMPLES: u32 = 1024;
/// Interval between updates of the progress of jobs.
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// The editor.
pub struct Editor {
    pub(super) state: EditorState,
    shell: Shell,
    appearance: Appearance,
    pub(super) preferences_window: PreferencesWindow,
    pub(super) command_palette: CommandPalette,
    pub(super) add_palette: AddPalette,
    pub(super) dialogs: Dialogs,
    /// The document being opened.
    pub(super) opening: Option<Opening>,
    /// The document being saved.
    pub(super) saving: Option<Saving>,
    /// Keeps unsaved work; `None` if recovery is off.
    pub(super) safekeeping: Option<Safekeeping>,
    pub(super) conflict: Conflict,
    /// Rendering into files.
    pub(super) rendering: Rendering,
    /// The field doctor.
    pub(super) doctor: Doctor,
    /// The doctor shall look again once the arrays are ready.
    pub(super) wants_scan: bool,
    /// The window at the start, and what explains the program.
    pub(super) welcome: Welcome,
    pub(super) tour: Tour,
    pub(super) help: Help,
    /// The renderer for work beside the frames.
    pub(super) studio: Option<SharedStudio>,
    /// The pictures of the viewports beside the main one.
    pictures_beside: Vec<Picture>,
    /// The first view of a new document waits for its arrays and models.
    wants_view: bool,
    shown_title: String,
    /// A text field had the focus at the end of the last frame: its keys, including Escape, are not shortcuts.
    pub(super) typing: bool,
    /// A command that waits until fields have taken the typed text.
    pub(super) pending: Option<Command>,
}

impl Editor {
    /// Creates an editor for the document.
    pub fn new(document: Document) -> Self {
        let mut editor = Self {
            state: EditorState::default(),
            shell: Shell::new(panels::all()),
            appearance: Appearance::default(),
            preferences_window: PreferencesWindow::default(),
            command_palette: CommandPalette::default(),
            add_palette: AddPalette::default(),
            dialogs: Dialogs::default(),
            opening: None,
            saving: None,
            safekeeping: None,
            conflict: Conflict::default(),
            rendering: Rendering::default(),
            doctor: Doctor::default(),
            wants_scan: false,
            welcome: Welcome::default(),
            tour: Tour::default(),
            help: Help::default(),
            studio: None,
            pictures_beside: Vec::new(),
            wants_view: false,
            shown_title: String::new(),
            typing: false,
            pending: None,
        };
        editor.state.panels = editor.shell.entries();
        editor.replace_document(document);
        editor
    }

    /// Installs fonts and style. Call once, before the first frame.
    pub fn setup(ctx: &Context) {
        theme::install(ctx);
        ctx.add_plugin(input_order::InputOrder::default());
        // A field takes its text on a press elsewhere, because the click that follows may select another node.
        ctx.options_mut(|options| options.input_options.surrender_focus_on = SurrenderFocusOn::Presses);
    }

    /// Whether events wait for a later frame, which is asked for.
    pub fn input_waits(ctx: &Context) -> bool {
        ctx.plugin_opt::<input_order::InputOrder>().is_some_and(|order| order.lock().is_waiting())
    }

    /// Sets the list of recent files, which persists between runs.
    pub fn set_recent(&mut self, recent: RecentFiles) {
        self.state.files.set_recent(recent);
    }

    /// Sets the preferences, which persist between runs.
    pub fn set_preferences(&mut self, preferences: Preferences) {
        self.state.preferences = preferences;
        if let Some(samples) = self.state.preferences.values().samples {
            self.state.view.samples = samples.clamp(1, MOST_SAMPLES);
        }
        self.state.view.snap = SnapSettings::kept(self.state.preferences.values());
        if let Some(mebibytes) = self.state.preferences.values().brick_mebibytes {
            self.state.derived.set_brick_budget(mebibytes);
        }
        if let Some(problem) = self.state.preferences.take_problem() {
            self.report(Message::warning(problem));
        }
        self.shell.arrange(self.state.preferences.values().layout.as_ref());
        self.state.panels = self.shell.entries();
    }

    /// Sets the examples of the File menu.
    pub fn set_examples(&mut self, examples: Vec<Example>) {
        self.state.examples = examples;
    }

    /// Asks for paths in the window, never by the system's dialogs.
    pub fn ask_for_paths_in_window(&mut self) {
        self.dialogs.in_window = true;
    }

    /// Shows everything and handles the input of one frame. Afterward [`Editor::flat`] and
    /// [`Editor::view`] belong to this frame: they include a dragged value.
    pub fn show(&mut self, ui: &mut Ui, picture: &Picture) {
        let ctx = ui.ctx().clone();
        self.state.set_pictures(picture, &self.pictures_beside);
        self.state.begin_views();
        self.appearance.apply(&ctx, &mut self.state);
        let for_jobs = ctx.clone();
        self.state.derived.jobs().set_wake(move || for_jobs.request_repaint());
        self.poll_documents(&ctx);
        self.poll_recovery();
        self.poll_dialogs(&ctx);
        self.guard_closing(&ctx);
        // What is dropped onto the welcome is meant for what it hides.
        self.welcome.is_open &= ctx.input(|i| i.raw.dropped_files.is_empty());
        self.take_dropped_files(&ctx);
        if self.state.session.is_changing() && ctx.input(|i| i.key_pressed(Key::Escape)) {
            self.state.session.cancel();
        }
        let [width, height] = self.rendering.settings.size.map(f64::from);
        self.state.view.frame_aspect = width.max(1.0) / height.max(1.0);
        self.run_shortcuts(&ctx);
        let now = ctx.input(|i| i.time);
        if let Some(later) = self.state.playback.advance(&mut self.state.session, now) {
            ctx.request_repaint_after(later);
        }
        let before = self.state.session.document.revision();
        for index in 0..self.shell.len() {
            self.shell.show(index, &mut self.state, ui);
            self.answer_requests(&ctx);
        }
        self.state.end_views();
        self.follow_panels(&ctx, before);
        if let Some(reason) = numbers::take_refusal(&ctx) {
            self.report(Message::warning(reason));
        }
        if let Some(later) = self.state.files.poll(self.state.derived.jobs(), &mut self.state.session) {
            ctx.request_repaint_after(later);
        }
        self.state.packing.poll(&mut self.state.session);
        self.use_brought_model();
        self.show_in_front(&ctx);
        if let Some(command) = self.pending.take() {
            self.run(command, &ctx);
        }
        self.state.session.settle(&ctx);
        self.follow_document();
        // The balls of animated materials wait until the moment stays.
        if !self.state.playback.is_moving() {
            self.state.materials.thumbnails.update(&ctx, self.state.derived.jobs());
        }
        if self.state.derived.jobs().foremost().is_some() {
            ctx.request_repaint_after(PROGRESS_EVERY);
        }
        self.send_title(&ctx);
        self.watch_file(&ctx);
        self.follow_recovery(&ctx);
        self.typing = ctx.text_edit_focused();
    }

    fn show_in_front(&mut self, ctx: &Context) {
        self.show_preferences(ctx);
        self.show_dialogs(ctx);
        self.show_conflict(ctx);
        self.show_recovery(ctx);
        self.show_rendering(ctx);
        self.show_doctor(ctx);
        self.show_first_run(ctx);
        if let Some(command) = self.command_palette.show(&self.state, ctx) {
            self.run(command, ctx);
        }
        if let Some(command) = self.add_palette.show(&mut self.state, ctx) {
            self.run(command, ctx);
            self.state.view.add_at = None;
        }
        if let Some(command) = drag_in::follow(&mut self.state, ctx) {
            self.state.view.is_dropping = true;
            self.run(command, ctx);
            (self.state.view.is_dropping, self.state.view.add_at) = (false, None);
        }
        below_list::show(&mut self.state, ctx);
        history_list::show(&mut self.state, ctx);
        let corner = self.state.view.rect;
        self.state.session.messages.show_toasts(ctx, corner);
    }

    /// Keeps a layout that the artist has changed. Shows the panels once more that were shown before a later one has
    /// changed the document.
    fn follow_panels(&mut self, ctx: &Context, revision: u64) {
        if self.state.session.document.revision() != revision {
            ctx.request_repaint();
        }
        if ctx.input(|i| i.pointer.any_down()) {
            return;
        }
        if let Some(layout) = self.shell.take_changed_layout() {
            self.state.panels = self.shell.entries();
            if self.state.preferences.values().layout.as_ref() != Some(&layout) {
                self.state.preferences.change(|values| values.layout = Some(layout));
            }
        }
    }

    /// Carries out the requests of the panel shown last.
    fn answer_requests(&mut self, ctx: &Context) {
        for request in std::mem::take(&mut self.state.requests) {
            match request {
                Request::Run(command) => self.run(command, ctx),
                Request::Intend(intent) => self.intend(intent, ctx),
                Request::TogglePanel(id) => {
                    self.shell.toggle(id);
                    self.state.panels = self.shell.entries();
                }
                Request::SplitView(count) => {
                    let room = self
                        .state
                        .views
                        .room()
                        .map_or(self.state.view.rect, |beside| beside.union(self.state.view.rect))
                        .size();
                    self.shell.split(count, room);
                    self.state.panels = self.shell.entries();
                }
                Request::ResetLayout => {
                    self.shell.arrange(None);
                    self.state.preferences.change(|values| values.layout = None);
                    self.state.panels = self.shell.entries();
                }
            }
        }
    }

    /// Sets the pictures of the viewports beside the main one, for the next frame.
    pub fn set_pictures_beside(&mut self, pictures: Vec<Picture>) {
        self.pictures_beside = pictures;
    }

    /// The viewport under the keys, 0 for the main one; [`Editor::view`] is its view.
    pub fn active_view(&self) -> usize {
        self.state.views.active
    }

    /// The views of the others that are shown.
    pub fn views_beside(&self) -> Vec<(usize, ViewSettings)> {
        self.state.views_beside()
    }

    /// The view for the renderer.
    pub fn view(&self) -> ViewSettings {
        self.state.wanted_view()
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.state.session.document
    }

    /// The document, for changes by code outside the panels.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.state.session.document
    }

    /// The flat scene; the last valid one if the document exceeds a limit.
    pub fn flat(&self) -> &Arc<FlatScene> {
        self.state.flat()
    }

    /// The meshes of the scene that are ready.
    pub fn meshes(&self) -> &MeshLibrary {
        self.state.derived.library()
    }

    /// The names of the files being read for nodes.
    pub fn files_being_read(&self) -> impl Iterator<Item = &str> {
        self.state.files.files_being_read()
    }

    /// The jobs beside the frames.
    pub fn jobs(&self) -> &Jobs {
        self.state.derived.jobs()
    }

    /// Whether any job is running or its result waits for the next frame.
    pub fn is_busy(&self) -> bool {
        !self.jobs().is_idle()
            || self.state.derived.is_preparing()
            || self.opening.is_some()
            || self.saving.is_some()
            || self.is_rendering()
            || self.doctor.is_busy()
            || self.wants_scan
            || self.state.files.is_busy()
            || self.state.packing.is_busy()
            || self.state.bringing.is_busy()
            || self.conflict.is_looking()
            || self.is_recovering()
    }

    /// Whether the artist has stopped drawing until the next change; resets the flag.
    pub fn take_stop_drawing(&mut self) -> bool {
        std::mem::take(&mut self.state.view.stops_drawing)
    }

    /// Reports a message to the artist.
    pub fn report(&mut self, message: Message) {
        self.state.session.messages.push(message);
    }

    /// The messages so far, oldest first.
    pub fn messages(&self) -> impl DoubleEndedIterator<Item = &Message> {
        self.state.session.messages.iter()
    }

    /// The window's title.
    pub fn title(&self) -> String {
        format!("{} – Isolith", widgets::elided(&self.state.session.document.title(), MOST_TITLE))
    }

    /// Whether the artist has agreed to close the window: there is nothing left to save.
    pub fn wants_close(&self) -> bool {
        self.dialogs.closing
    }

    /// Whether a dialog is open.
    pub fn has_dialog(&self) -> bool {
        self.dialogs.is_open()
            || self.preferences_window.is_open()
            || self.command_palette.is_open()
            || self.add_palette.is_open()
            || self.state.view.below.is_some()
            || self.conflict.is_open()
            || self.is_offering()
            || self.welcome.is_open
    }

    /// Replaces the current document.
    pub(super) fn replace_document(&mut self, document: Document) {
        self.leave_document();
        self.state.derived.reset(document.path().and_then(folder_of));
        self.state.session.document = document;
        self.follow_document();
    }

    /// Shows a document prepared by a job.
    pub(super) fn show_opened(&mut self, opened: Opened) {
        self.leave_document();
        self.state.session.document = self.state.derived.adopt(opened);
        self.follow_document();
    }

    fn leave_document(&mut self) {
        self.state.session.finish();
        self.state.playback = Playback::default();
        self.state.view.transforming = None;
        (self.state.view.entered, self.state.view.walk, self.state.view.below) = (None, None, None);
        self.state.view.isolated.clear();
        self.state.reset_views();
        self.state.view.through = None;
        self.opening = None;
        self.state.files.forget_attachments();
        self.state.packing.forget();
        self.state.bringing.forget();
        self.state.materials.forget();
        self.forget_kept();
        self.doctor.forget();
        self.shell.forget();
        self.wants_view = true;
    }

    /// Updates the data derived from the document; called once for a new document, too, before its first frame.
    fn follow_document(&mut self) {
        self.state.follow_document();
        if self.wants_view && !self.state.derived.is_preparing() {
            self.wants_view = false;
            self.state.show_as_saved();
        }
    }

    fn send_title(&mut self, ctx: &Context) {
        let title = self.title();
        if title != self.shown_title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.shown_title = title;
        }
    }
}
