//! Opening, saving, quitting: the question before work is lost, and the dialogs for files.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use egui::{Context, Id, Key, Modal, RichText, TextEdit, ViewportCommand, vec2};

use super::messages::Message;
use super::workbench::WantedFile;
use super::{Editor, insertion, theme};
use crate::document::Document;
use crate::scene::{Attached, MeshNode, Node, NodeKind};

/// Something that replaces the document or ends the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Intent {
    /// A new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Open this file.
    Open(PathBuf),
    /// Open the example of this number.
    Example(usize),
    /// Close the window.
    Quit,
}

/// What a path is wanted for.
#[derive(Clone, Debug, PartialEq)]
enum Purpose {
    Open,
    /// Then goes on with what the saving was asked for.
    Save(Option<Intent>),
    Mesh,
    /// A file that nodes keep.
    Attach(WantedFile),
}

impl Purpose {
    fn title(&self) -> &'static str {
        match self {
            Self::Open => "Open a scene",
            Self::Save(_) => "Save the scene",
            Self::Mesh => "Add a mesh",
            Self::Attach(WantedFile { instead_of: Attached::Heights(_), .. }) => "Choose an image",
            Self::Attach(WantedFile { instead_of: Attached::Font(_), .. }) => "Choose a font",
        }
    }
}

/// The system's dialog, open on a thread of its own.
struct SystemDialog {
    purpose: Purpose,
    answer: Receiver<Option<PathBuf>>,
    since: Instant,
}

/// Our own dialog, for where the system has none.
struct PathField {
    purpose: Purpose,
    text: String,
    focused: bool,
}

/// What is being asked.
#[derive(Default)]
pub struct Dialogs {
    question: Option<Intent>,
    system: Option<SystemDialog>,
    path_field: Option<PathField>,
    /// Ask for paths in the window instead of by the system's dialog.
    pub in_window: bool,
    /// The artist has agreed to close the window.
    pub closing: bool,
}

/// Nobody cancels a dialog faster than this: there was none.
const NO_DIALOG: Duration = Duration::from_millis(600);

impl Dialogs {
    /// Whether the window waits for an answer.
    pub fn is_open(&self) -> bool {
        self.question.is_some() || self.path_field.is_some()
    }
}

impl Editor {
    /// Does it, after asking where work would be lost.
    pub fn intend(&mut self, intent: Intent, ctx: &Context) {
        self.bench.finish();
        let harmless = intent == Intent::Choose;
        if self.bench.document.is_changed() && !harmless {
            self.dialogs.question = Some(intent);
        } else {
            self.perform(intent, ctx);
        }
    }

    fn perform(&mut self, intent: Intent, ctx: &Context) {
        match intent {
            Intent::New => self.replace_document(super::new_document()),
            Intent::Choose => self.choose(Purpose::Open, ctx),
            Intent::Open(path) => self.open(&path),
            Intent::Example(index) => {
                let opened = self.examples.get(index).map(|example| (example.open)());
                match opened {
                    Some(Ok(document)) => self.replace_document(document),
                    Some(Err(reason)) => self.report(Message::error(reason)),
                    None => {}
                }
            }
            Intent::Quit => {
                self.dialogs.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    fn open(&mut self, path: &Path) {
        match Document::open(path) {
            Ok(document) => {
                self.recent.add(path);
                self.replace_document(document);
            }
            Err(error) => self.report(Message::error(error.to_string())),
        }
    }

    /// Saves, asking for a path where there is none; then goes on with `then`.
    pub fn save(&mut self, then: Option<Intent>, ctx: &Context) {
        self.bench.finish();
        match self.bench.document.path().map(Path::to_path_buf) {
            None => self.choose_save_path(then, ctx),
            Some(path) => self.save_unless_changed(&path, then, ctx),
        }
    }

    /// Asks where to save; then goes on with `then`.
    pub fn choose_save_path(&mut self, then: Option<Intent>, ctx: &Context) {
        self.choose(Purpose::Save(then), ctx);
    }

    /// Asks for a mesh file and adds it.
    pub fn choose_mesh(&mut self, ctx: &Context) {
        if self.bench.document.path().is_none() {
            self.report(Message::info("Save the scene first: mesh files are named relative to the scene's folder."));
        } else {
            self.choose(Purpose::Mesh, ctx);
        }
    }

    pub(super) fn save_to(&mut self, path: &Path, then: Option<Intent>, ctx: &Context) {
        match self.bench.document.save_as(path) {
            Ok(()) => {
                self.forget_kept();
                self.recent.add(path);
                self.meshes.set_folder(super::folder_of(path));
                self.report(Message::success(format!("Saved {}", path.display())));
                if let Some(intent) = then {
                    self.perform(intent, ctx);
                }
            }
            Err(error) => self.report(Message::error(error.to_string())),
        }
    }

    fn choose(&mut self, purpose: Purpose, ctx: &Context) {
        if self.dialogs.system.is_some() {
            return;
        }
        if self.dialogs.in_window {
            self.ask_in_window(purpose);
            return;
        }
        let dialog = self.system_dialog(&purpose);
        let (sender, answer) = channel();
        let (ctx, saving) = (ctx.clone(), matches!(purpose, Purpose::Save(_)));
        let spawned = std::thread::Builder::new().name("file dialog".into()).spawn(move || {
            let path = if saving { dialog.save_file() } else { dialog.pick_file() };
            // The receiver is gone when the window is: then nobody waits for the answer.
            let _ = sender.send(path);
            ctx.request_repaint();
        });
        match spawned {
            Ok(_) => self.dialogs.system = Some(SystemDialog { purpose, answer, since: Instant::now() }),
            Err(_) => self.ask_in_window(purpose),
        }
    }

    fn system_dialog(&self, purpose: &Purpose) -> rfd::FileDialog {
        let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
        dialog = match purpose {
            Purpose::Mesh => dialog.add_filter("glTF", &["gltf", "glb"]),
            Purpose::Attach(wanted) => dialog.add_filter("Files that can be used", wanted.instead_of.endings()),
            Purpose::Open | Purpose::Save(_) => dialog.add_filter("Isolith scene", &["json"]),
        };
        let path = self.bench.document.path();
        if let Some(folder) = path.and_then(Path::parent).filter(|f| f.is_absolute()) {
            dialog = dialog.set_directory(folder);
        }
        if matches!(purpose, Purpose::Save(_)) {
            dialog = dialog.set_file_name(suggested_name(path));
        }
        dialog
    }

    fn ask_in_window(&mut self, purpose: Purpose) {
        let path = self.bench.document.path();
        let text = match (&purpose, path) {
            (Purpose::Save(_), Some(path)) => path.display().to_string(),
            (Purpose::Save(_), None) => std::path::absolute(suggested_name(None))
                .map_or_else(|_| suggested_name(None), |p| p.display().to_string()),
            (_, Some(path)) => path
                .parent()
                .map_or_else(String::new, |folder| format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR)),
            (_, None) => String::new(),
        };
        self.dialogs.path_field = Some(PathField { purpose, text, focused: false });
    }

    /// Takes the answer of the system's dialog, and asks for what panels want. Once a frame.
    pub(super) fn poll_dialogs(&mut self, ctx: &Context) {
        if let Some(wanted) = self.bench.wanted_file.take() {
            self.bench.finish();
            self.choose(Purpose::Attach(wanted), ctx);
        }
        let Some(dialog) = &self.dialogs.system else { return };
        let answer = match dialog.answer.try_recv() {
            Err(std::sync::mpsc::TryRecvError::Empty) => return,
            Err(std::sync::mpsc::TryRecvError::Disconnected) => None,
            Ok(answer) => answer,
        };
        let Some(SystemDialog { purpose, since, .. }) = self.dialogs.system.take() else { return };
        match answer {
            Some(path) => self.chosen(purpose, &path, ctx),
            None if since.elapsed() < NO_DIALOG => {
                self.dialogs.in_window = true;
                self.ask_in_window(purpose);
            }
            None => {}
        }
    }

    fn chosen(&mut self, purpose: Purpose, path: &Path, ctx: &Context) {
        match purpose {
            Purpose::Open => self.intend(Intent::Open(path.to_path_buf()), ctx),
            Purpose::Save(then) => {
                let path = if path.extension().is_none() { path.with_extension("json") } else { path.to_path_buf() };
                self.save_unless_changed(&path, then, ctx);
            }
            Purpose::Mesh => self.add_mesh(path),
            Purpose::Attach(wanted) => self.read_file(wanted, path, ctx),
        }
    }

    fn add_mesh(&mut self, path: &Path) {
        let folder = self.bench.document.path().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
        let relative = path.strip_prefix(&folder).ok().filter(|_| path.is_absolute()).unwrap_or(path);
        if relative.is_absolute() {
            let text = "Only files in the scene's folder or below it can be used. Copy the mesh there first.";
            self.report(Message::error(text));
            return;
        }
        let parts: Vec<_> = relative.iter().map(|p| p.to_string_lossy()).collect();
        let name = relative.file_stem().map_or_else(|| "Mesh".into(), |s| s.to_string_lossy().into_owned());
        let mesh = MeshNode { path: parts.join("/"), material: None };
        insertion::node(self, Node::new(name, NodeKind::Mesh(mesh)));
    }

    /// Shows what is being asked.
    pub(super) fn show_dialogs(&mut self, ctx: &Context) {
        self.show_question(ctx);
        self.show_path_field(ctx);
    }

    fn show_question(&mut self, ctx: &Context) {
        let Some(intent) = self.dialogs.question.clone() else { return };
        let name = self.bench.document.title();
        let name = name.trim_end_matches(" *").to_owned();
        let mut answer = None;
        let response = Modal::new(Id::unique("unsaved changes")).frame(frame(ctx)).show(ctx, |ui| {
            ui.set_width(380.0);
            ui.add_space(4.0);
            ui.label(RichText::new(format!("Save the changes to “{name}”?")).heading().color(egui::Color32::WHITE));
            ui.add_space(2.0);
            ui.label(RichText::new("They are lost otherwise.").color(theme::WEAK));
            ui.add_space(14.0);
            ui.horizontal(|ui| {
                let size = vec2(96.0, 28.0);
                if ui.add(egui::Button::new("Discard").min_size(size)).clicked() {
                    answer = Some(Answer::Discard);
                }
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    let text = RichText::new("Save").color(egui::Color32::BLACK);
                    if ui.add(egui::Button::new(text).fill(theme::ACCENT).min_size(size)).clicked() {
                        answer = Some(Answer::Save);
                    }
                    if ui.add(egui::Button::new("Cancel").min_size(size)).clicked() {
                        answer = Some(Answer::Cancel);
                    }
                });
            });
        });
        if ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Enter)) {
            answer = answer.or(Some(Answer::Save));
        }
        if response.should_close() {
            answer = answer.or(Some(Answer::Cancel));
        }
        let Some(answer) = answer else { return };
        self.dialogs.question = None;
        match answer {
            Answer::Save => self.save(Some(intent), ctx),
            Answer::Discard => self.perform(intent, ctx),
            Answer::Cancel => {}
        }
    }

    fn show_path_field(&mut self, ctx: &Context) {
        let Some(field) = &mut self.dialogs.path_field else { return };
        let mut done = None;
        let response = Modal::new(Id::unique("path")).frame(frame(ctx)).show(ctx, |ui| {
            ui.set_width(460.0);
            ui.label(RichText::new(field.purpose.title()).heading().color(egui::Color32::WHITE));
            ui.add_space(6.0);
            let edit = TextEdit::singleline(&mut field.text)
                .hint_text("/path/to/file")
                .desired_width(f32::INFINITY)
                .margin(egui::Margin::symmetric(8, 6));
            let response = ui.add(edit);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Path"));
            if !field.focused {
                field.focused = true;
                response.request_focus();
                select_name(ctx, response.id, &field.text);
            }
            if response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter)) {
                done = Some(true);
            }
            ui.add_space(10.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let size = vec2(96.0, 28.0);
                let ok = if matches!(field.purpose, Purpose::Save(_)) { "Save" } else { "Open" };
                let text = RichText::new(ok).color(egui::Color32::BLACK);
                if ui.add(egui::Button::new(text).fill(theme::ACCENT).min_size(size)).clicked() {
                    done = Some(true);
                }
                if ui.add(egui::Button::new("Cancel").min_size(size)).clicked() {
                    done = Some(false);
                }
            });
        });
        if response.should_close() {
            done = done.or(Some(false));
        }
        let Some(agreed) = done else { return };
        let Some(field) = self.dialogs.path_field.take() else { return };
        let text = field.text.trim();
        if agreed && !text.is_empty() {
            self.chosen(field.purpose, Path::new(text), ctx);
        }
    }

    /// Refuses to close the window while work would be lost, and asks.
    pub(super) fn guard_closing(&mut self, ctx: &Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        if requested && !self.dialogs.closing && self.bench.document.is_changed() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.intend(Intent::Quit, ctx);
        }
    }
}

/// Selects the file's name, without folder and ending, so that typing replaces it.
fn select_name(ctx: &Context, field: Id, path: &str) {
    let end = path.chars().count();
    let start = path.rfind('/').map_or(0, |i| path[..=i].chars().count());
    let stem = path.rfind('.').map_or(end, |i| path[..i].chars().count());
    let mut state = egui::text_edit::TextEditState::default();
    let [start, end] = [start, if stem > start { stem } else { end }].map(egui::text::CCursor::new);
    state.cursor.set_char_range(Some(egui::text::CCursorRange::two(start, end)));
    state.store(ctx, field);
}

fn frame(ctx: &Context) -> egui::Frame {
    egui::Frame::window(&ctx.global_style()).inner_margin(18.0)
}

enum Answer {
    Save,
    Discard,
    Cancel,
}

fn suggested_name(path: Option<&Path>) -> String {
    path.and_then(Path::file_name).map_or_else(|| "scene.json".into(), |n| n.to_string_lossy().into_owned())
}
