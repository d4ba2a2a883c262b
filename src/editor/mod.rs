//! The editor: what the artist sees and does. Names egui only; the picture comes from outside as a
//! texture, and what it should show goes out as a [`ViewSettings`] and a [`FlatScene`].
//!
//! | file | what it does |
//! |---|---|
//! | `edit_session` | the document with gestures (one drag, one undo step) and messages |
//! | `commands/` | one table of everything that can be ordered: menus, toolbar, shortcuts, command palette |
//! | `outliner`, `inspector*`, `toolbar`, `status`, `viewport` | the panels |
//! | `multi_edit`, `widgets`, `numbers`, `color_picker` | fields bound to the selected nodes, and the widgets they are made of |
//! | `inspector_params` | a row for any parameter, from its table |
//! | `navigation`, `gizmo`, `overlay` | the camera, the handles and the marks over the picture |
//! | `legend` | what the colors of a picture mean that is not lit |
//! | `dialogs`, `dialog_views`, `portal`, `command_palette`, `messages` | what comes up in front |
//! | `input_order` | events in the order in which they came, however slow the frames are |
//! | `file_jobs` | files that nodes keep, read beside the frames |
//! | `recovery` | unsaved work, kept beside the frames and offered again |
//! | `conflict` | a file that another program has changed |
//! | `flattening` | the document as arrays, made beside the frames where that takes long |

mod bounds;
mod color_picker;
mod command_palette;
mod commands;
mod conflict;
mod dialog_views;
mod dialogs;
mod edit_session;
mod expression;
mod file_jobs;
mod flattening;
mod framing;
mod gizmo;
mod icons;
mod input_order;
mod insertion;
mod inspector;
mod inspector_blends;
mod inspector_kinds;
mod inspector_material;
mod inspector_modifiers;
mod inspector_params;
mod inspector_points;
mod inspector_scene;
mod inspector_transform;
mod legend;
mod messages;
mod models;
mod multi_edit;
mod navigation;
mod numbers;
mod outliner;
mod overlay;
mod picking;
mod portal;
mod recovery;
mod selection;
mod shape_change;
mod shape_icons;
mod status;
mod theme;
mod toolbar;
mod viewport;
mod widgets;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{CentralPanel, Context, Frame, Key, Margin, Panel, SurrenderFocusOn, TextureId, Ui, ViewportCommand};

pub use commands::{Command, CommandId, Menu};
pub use messages::{Message, Severity};
pub use navigation::{Navigation, Side};

use crate::document::{Document, RecentFiles};
use crate::flat::FlatScene;
use crate::flat::debug_view::ViewMode;
use crate::geometry::Camera;
use crate::mesh::MeshLibrary;
use crate::scene::{Light, Node, NodeKind, Scene};
use edit_session::EditSession;

/// Most characters of a file's name in the window's title.
const MOST_TITLE: usize = 80;

/// What the renderer has made.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// The picture, once there is one.
    pub texture: Option<TextureId>,
    /// Its size in pixels.
    pub size_px: [u32; 2],
    /// How much of it is done, 0 to 1; `None` when nothing is being drawn.
    pub progress: Option<f32>,
    /// A few words for the status bar: adapter, milliseconds.
    pub status: String,
}

/// What the renderer should make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// From where.
    pub camera: Camera,
    /// Size of the viewport in pixels; at least 1 × 1.
    pub size_px: [u32; 2],
    /// The camera or a value is being dragged: a fast picture is worth more than a fine one.
    pub navigating: bool,
    /// Whether the ground grid is wanted.
    pub show_grid: bool,
    /// Whether the selection is to be marked.
    pub show_outline: bool,
    /// What the picture is to show.
    pub view_mode: ViewMode,
}

/// An example that the File menu offers.
pub struct Example {
    /// Its entry in the menu.
    pub name: String,
    /// It stands in the submenu of test scenes: made to check the program, not to show what it can do.
    pub is_test: bool,
    /// Makes its document, or says why it cannot.
    pub open: Box<dyn Fn() -> Result<Document, String>>,
}

/// The editor.
pub struct Editor {
    session: EditSession,
    flat: flattening::Flattened,
    meshes: MeshLibrary,
    models: models::Models,
    navigation: Navigation,
    viewport: viewport::Viewport,
    outliner: outliner::Outliner,
    inspector: inspector::Inspector,
    command_palette: command_palette::CommandPalette,
    dialogs: dialogs::Dialogs,
    recent: RecentFiles,
    examples: Vec<Example>,
    /// Files that nodes are to keep, on their way.
    file_jobs: Vec<file_jobs::FileJob>,
    /// Keeps what is not saved; none where nothing is to be kept.
    safekeeping: Option<recovery::Safekeeping>,
    conflict: conflict::Conflict,
    show_grid: bool,
    show_outline: bool,
    view_mode: ViewMode,
    shown_title: String,
    /// Text was being typed at the end of the last frame: its keys, Escape too, are not shortcuts.
    typing: bool,
    /// A command that waits until fields have taken what was typed into them.
    pending: Option<CommandId>,
}

impl Editor {
    /// An editor for the document.
    pub fn new(document: Document) -> Self {
        let mut editor = Self {
            session: EditSession::new(Document::new(Scene::new())),
            flat: flattening::Flattened::default(),
            meshes: MeshLibrary::new(None),
            models: models::Models::default(),
            navigation: Navigation::default(),
            viewport: viewport::Viewport::default(),
            outliner: outliner::Outliner::default(),
            inspector: inspector::Inspector::default(),
            command_palette: command_palette::CommandPalette::default(),
            dialogs: dialogs::Dialogs::default(),
            recent: RecentFiles::default(),
            examples: Vec::new(),
            file_jobs: Vec::new(),
            safekeeping: None,
            conflict: conflict::Conflict::default(),
            show_grid: true,
            show_outline: true,
            view_mode: ViewMode::Shaded,
            shown_title: String::new(),
            typing: false,
            pending: None,
        };
        editor.replace_document(document);
        editor
    }

    /// Installs fonts and the theme. Once, before the first frame.
    pub fn setup(ctx: &Context) {
        theme::install(ctx);
        ctx.add_plugin(input_order::InputOrder::default());
        // A field takes what was typed when the pointer is pressed elsewhere: the click may already select another node.
        ctx.options_mut(|options| options.input_options.surrender_focus_on = SurrenderFocusOn::Presses);
    }

    /// Remembers files between runs in this list.
    pub fn set_recent(&mut self, recent: RecentFiles) {
        self.recent = recent;
    }

    /// Offers examples in the File menu.
    pub fn set_examples(&mut self, examples: Vec<Example>) {
        self.examples = examples;
    }

    /// Asks for paths in the window, never by the system's dialogs.
    pub fn ask_for_paths_in_window(&mut self) {
        self.dialogs.in_window = true;
    }

    /// Shows everything and takes the input of one frame. Afterward [`Editor::flat`] and
    /// [`Editor::view`] are those of this frame: a dragged value is in them already.
    pub fn show(&mut self, ui: &mut Ui, picture: &Picture) {
        let ctx = ui.ctx().clone();
        self.poll_dialogs(&ctx);
        self.guard_closing(&ctx);
        self.open_dropped(&ctx);
        if self.session.is_changing() && ctx.input(|i| i.key_pressed(Key::Escape)) {
            self.session.cancel();
        }
        commands::run_shortcuts(self, &ctx);
        self.show_panels(ui, picture);
        if let Some(reason) = numbers::take_refusal(&ctx) {
            self.report(Message::warning(reason));
        }
        self.poll_file_jobs(&ctx);
        self.show_dialogs(&ctx);
        self.show_conflict(&ctx);
        self.show_recovery(&ctx);
        command_palette::show(self, &ctx);
        let corner = self.viewport.rect();
        self.session.messages.show_toasts(&ctx, corner);
        if self.session.messages.show_log {
            self.session.messages.show_log(&ctx);
        }
        if let Some(command) = self.pending.take() {
            command.run(self, &ctx);
        }
        self.session.settle(&ctx);
        self.refresh_flat();
        self.poll_models(&ctx);
        self.is_flattening(&ctx);
        self.send_title(&ctx);
        self.watch_file(&ctx);
        self.follow_recovery(&ctx, picture);
        self.typing = ctx.text_edit_focused();
    }

    fn show_panels(&mut self, ui: &mut Ui, picture: &Picture) {
        let bar = Frame::new().fill(theme::BAR).inner_margin(Margin::symmetric(8, 5));
        let side = Frame::new().fill(theme::PANEL).inner_margin(Margin::same(8));
        Panel::top("toolbar").frame(bar).show(ui, |ui| toolbar::show(self, ui));
        let narrow = Frame::new().fill(theme::BAR).inner_margin(Margin::symmetric(10, 3));
        Panel::bottom("status").frame(narrow).show(ui, |ui| status::show(self, ui, picture));
        Panel::left("outliner").frame(side).default_size(240.0).size_range(160.0..=520.0).show(ui, |ui| {
            let chosen = widgets::fixed(ui, |ui| self.outliner.show(ui, &mut self.session));
            for command in chosen {
                command.run(self, &ui.ctx().clone());
            }
        });
        Panel::right("inspector").frame(side).default_size(300.0).size_range(240.0..=520.0).show(ui, |ui| {
            widgets::fixed(ui, |ui| self.inspector.show(ui, &mut self.session));
        });
        CentralPanel::default().frame(Frame::new().fill(theme::LINE)).show(ui, |ui| viewport::show(self, ui, picture));
    }

    /// What the renderer should show.
    pub fn view(&self) -> ViewSettings {
        ViewSettings {
            camera: self.navigation.camera(),
            size_px: self.viewport.size_px(),
            navigating: self.viewport.is_navigating() || self.session.is_changing(),
            show_grid: self.show_grid,
            show_outline: self.show_outline,
            view_mode: self.view_mode,
        }
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.session.document
    }

    /// The document, for changes from outside the panels.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.session.document
    }

    /// The document as arrays; the last good ones where the document is beyond a limit.
    pub fn flat(&self) -> &Arc<FlatScene> {
        &self.flat.scene
    }

    /// The meshes that the scene names.
    pub fn meshes(&mut self) -> &mut MeshLibrary {
        &mut self.meshes
    }

    /// The flat scene and the meshes together, for the renderer.
    pub fn flat_and_meshes(&mut self) -> (&Arc<FlatScene>, &mut MeshLibrary) {
        (&self.flat.scene, &mut self.meshes)
    }

    /// Tells the artist something.
    pub fn report(&mut self, message: Message) {
        self.session.messages.push(message);
    }

    /// The messages so far, oldest first.
    pub fn messages(&self) -> impl DoubleEndedIterator<Item = &Message> {
        self.session.messages.iter()
    }

    /// The window's title.
    pub fn title(&self) -> String {
        format!("{} – Isolith", widgets::elided(&self.session.document.title(), MOST_TITLE))
    }

    /// Whether the artist has agreed to close the window: nothing is left to save.
    pub fn wants_close(&self) -> bool {
        self.dialogs.closing
    }

    /// Whether a question waits for its answer.
    pub fn has_dialog(&self) -> bool {
        self.dialogs.is_open() || self.command_palette.is_open() || self.conflict.is_open() || self.is_offering()
    }

    fn replace_document(&mut self, document: Document) {
        self.session.finish();
        self.file_jobs.clear();
        self.forget_kept();
        self.meshes.set_folder(document.path().and_then(folder_of));
        self.session.document = document;
        self.outliner = outliner::Outliner::default();
        self.flat.reset();
        self.refresh_flat();
    }

    fn open_dropped(&mut self, ctx: &Context) {
        let dropped = ctx.input(|i| i.raw.dropped_files.first().map(|file| file.path().to_path_buf()));
        if let Some(path) = dropped.filter(|_| !self.has_dialog()) {
            self.intend(dialogs::Intent::Open(path), ctx);
        }
    }

    fn send_title(&mut self, ctx: &Context) {
        let title = self.title();
        if title != self.shown_title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.shown_title = title;
        }
    }

    fn rename_active(&mut self) {
        if let Some(&id) = self.session.document.selection().last() {
            self.outliner.start_rename(self.session.document.scene(), id);
        }
    }
}

/// What "New" gives: a sun and nothing else.
pub fn new_document() -> Document {
    let mut scene = Scene::new();
    let direction = glam::DQuat::from_euler(glam::EulerRot::YXZ, 0.6, -0.9, 0.0);
    // Bright clay is not to be white on its lit side.
    let light = Light { intensity: 1.2, ..Light::sun() };
    let sun = Node::new("Sun", NodeKind::Light(light)).rotated(direction).at(glam::DVec3::new(2.0, 4.0, 3.0));
    scene.insert(None, 0, sun).expect("an empty scene takes a light");
    Document::new(scene)
}

/// The folder of a scene's file; the current one for a bare name.
fn folder_of(file: &Path) -> Option<PathBuf> {
    file.parent().map(|folder| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() })
}
