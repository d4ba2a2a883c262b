//! Opening, saving, quitting: what is asked before work is lost, and for which files. `dialog_views` shows it.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use egui::{Context, ViewportCommand};

use super::edit_session::WantedFile;
use super::messages::Message;
use super::{Editor, insertion, portal};
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

/// An intent that can be carried out: its document has been read.
pub enum Next {
    /// A new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Show this document, which was read from this file.
    Show(Box<Document>, Option<PathBuf>),
    /// Close the window.
    Quit,
}

/// What a path is wanted for.
pub enum Purpose {
    /// To open a scene.
    Open,
    /// To save; then goes on with what the saving was asked for.
    Save(Option<Next>),
    /// To add a mesh.
    Mesh,
    /// For a file that nodes keep.
    Attach(WantedFile),
}

impl Purpose {
    /// What the dialog is called.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Open => "Open a scene",
            Self::Save(_) => "Save the scene",
            Self::Mesh => "Add a mesh",
            Self::Attach(WantedFile { instead_of: Attached::Heights(_), .. }) => "Choose an image",
            Self::Attach(WantedFile { instead_of: Attached::Font(_), .. }) => "Choose a font",
        }
    }

    /// Why the path cannot serve this purpose, before anything is read or written.
    pub fn refusal(&self, path: &Path) -> Option<String> {
        let name = path.display();
        if path.as_os_str().is_empty() {
            return Some("Type the name of a file.".into());
        }
        let is_folder = |path: &Path| path.is_dir() || path.to_string_lossy().ends_with(std::path::is_separator);
        if is_folder(path) {
            return Some(format!("{name} is a folder, not a file."));
        }
        match self {
            Self::Save(_) => {}
            // Its reader says more.
            Self::Attach(_) => return None,
            Self::Open | Self::Mesh => return (!path.exists()).then(|| format!("There is no file {name}.")),
        }
        let path = with_ending(path);
        if path.is_dir() {
            return Some(format!("{} is a folder, not a file.", path.display()));
        }
        let folder = super::folder_of(&path).filter(|folder| !folder.is_dir())?;
        Some(format!("There is no folder {}.", folder.display()))
    }
}

/// The system's dialog, open on a thread of its own.
struct SystemDialog {
    purpose: Purpose,
    answer: Receiver<SystemAnswer>,
    since: Instant,
}

enum SystemAnswer {
    /// What was chosen, if anything.
    Chosen(Option<PathBuf>),
    /// There is no such dialog here.
    NoDialog,
}

/// Our own dialog, for where the system has none.
pub struct PathField {
    /// What for.
    pub purpose: Purpose,
    /// What is typed.
    pub text: String,
    /// It has been given the keyboard.
    pub focused: bool,
    /// Why what was typed does not do.
    pub problem: Option<String>,
}

/// A question before something is lost.
pub enum Question {
    /// The document has changes that are not saved.
    Unsaved(Next),
    /// There is a file of this name already.
    Replace(PathBuf, Option<Next>),
}

/// What is being asked.
#[derive(Default)]
pub struct Dialogs {
    /// A question that waits for its answer.
    pub question: Option<Question>,
    system: Option<SystemDialog>,
    /// The path being typed.
    pub path_field: Option<PathField>,
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
    /// Does it, after asking where work would be lost. What cannot be read is refused before that.
    pub fn intend(&mut self, intent: Intent, ctx: &Context) {
        self.session.finish();
        let Some(next) = self.prepare(intent) else { return };
        if self.session.document.is_changed() && !matches!(next, Next::Choose) {
            self.dialogs.question = Some(Question::Unsaved(next));
        } else {
            self.perform(next, ctx);
        }
    }

    fn prepare(&mut self, intent: Intent) -> Option<Next> {
        let read = match intent {
            Intent::New => return Some(Next::New),
            Intent::Choose => return Some(Next::Choose),
            Intent::Quit => return Some(Next::Quit),
            Intent::Open(path) => {
                Document::open(&path).map(|document| (document, Some(path))).map_err(|error| error.to_string())
            }
            Intent::Example(index) => (self.examples.get(index)?.open)().map(|document| (document, None)),
        };
        match read {
            Ok((document, path)) => Some(Next::Show(Box::new(document), path)),
            Err(reason) => {
                self.report(Message::error(reason));
                None
            }
        }
    }

    pub(super) fn perform(&mut self, next: Next, ctx: &Context) {
        match next {
            Next::New => self.replace_document(super::new_document()),
            Next::Choose => self.choose(Purpose::Open, ctx),
            Next::Show(document, path) => {
                if let Some(path) = path {
                    self.recent.add(&path);
                }
                self.replace_document(*document);
            }
            Next::Quit => {
                self.dialogs.closing = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }

    /// Saves, asking for a path where there is none; then goes on with `then`.
    pub fn save(&mut self, then: Option<Next>, ctx: &Context) {
        self.session.finish();
        match self.session.document.path().map(Path::to_path_buf) {
            None => self.choose_save_path(then, ctx),
            Some(path) => self.save_unless_changed(&path, then, ctx),
        }
    }

    /// Asks where to save; then goes on with `then`.
    pub fn choose_save_path(&mut self, then: Option<Next>, ctx: &Context) {
        self.choose(Purpose::Save(then), ctx);
    }

    /// Asks for a mesh file and adds it.
    pub fn choose_mesh(&mut self, ctx: &Context) {
        if self.session.document.path().is_none() {
            self.report(Message::info("Save the scene first: mesh files are named relative to the scene's folder."));
        } else {
            self.choose(Purpose::Mesh, ctx);
        }
    }

    pub(super) fn save_to(&mut self, path: &Path, then: Option<Next>, ctx: &Context) {
        match self.session.document.save_as(path) {
            Ok(()) => {
                self.forget_kept();
                self.recent.add(path);
                self.meshes.set_folder(super::folder_of(path));
                self.report(Message::success(format!("Saved {}", path.display())));
                if let Some(next) = then {
                    self.perform(next, ctx);
                }
            }
            Err(error) => self.report(Message::error(error.to_string())),
        }
    }

    fn choose(&mut self, purpose: Purpose, ctx: &Context) {
        // Who asks again while the system's dialog is open does not see it: its answer is not waited for any more.
        let is_unanswered = self.dialogs.system.take().is_some();
        if self.dialogs.in_window || is_unanswered {
            self.ask_in_window(purpose);
            return;
        }
        let dialog = self.system_dialog(&purpose);
        let (sender, answer) = channel();
        let (ctx, saving) = (ctx.clone(), matches!(purpose, Purpose::Save(_)));
        let spawned = std::thread::Builder::new().name("file dialog".into()).spawn(move || {
            let answer = match portal::has_dialogs() {
                false => SystemAnswer::NoDialog,
                true if saving => SystemAnswer::Chosen(dialog.save_file()),
                true => SystemAnswer::Chosen(dialog.pick_file()),
            };
            // The receiver is gone when the window is: then nobody waits for the answer.
            let _ = sender.send(answer);
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
        let path = self.session.document.path();
        if let Some(folder) = path.and_then(Path::parent).filter(|f| f.is_absolute()) {
            dialog = dialog.set_directory(folder);
        }
        if matches!(purpose, Purpose::Save(_)) {
            dialog = dialog.set_file_name(suggested_name(path));
        }
        dialog
    }

    fn ask_in_window(&mut self, purpose: Purpose) {
        let path = self.session.document.path();
        let text = match (&purpose, path) {
            (Purpose::Save(_), Some(path)) => path.display().to_string(),
            (Purpose::Save(_), None) => std::path::absolute(suggested_name(None))
                .map_or_else(|_| suggested_name(None), |p| p.display().to_string()),
            (_, Some(path)) => path
                .parent()
                .map_or_else(String::new, |folder| format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR)),
            (_, None) => String::new(),
        };
        self.dialogs.path_field = Some(PathField { purpose, text, focused: false, problem: None });
    }

    /// Takes the answer of the system's dialog, and asks for what panels want. Once a frame.
    pub(super) fn poll_dialogs(&mut self, ctx: &Context) {
        if let Some(wanted) = self.session.wanted_file.take() {
            self.session.finish();
            self.choose(Purpose::Attach(wanted), ctx);
        }
        let Some(dialog) = &self.dialogs.system else { return };
        let answer = match dialog.answer.try_recv() {
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => SystemAnswer::NoDialog,
            Ok(answer) => answer,
        };
        let Some(SystemDialog { purpose, since, .. }) = self.dialogs.system.take() else { return };
        match answer {
            SystemAnswer::Chosen(Some(path)) => self.chosen_in_system(purpose, &path, ctx),
            SystemAnswer::Chosen(None) if since.elapsed() >= NO_DIALOG => {}
            SystemAnswer::Chosen(None) | SystemAnswer::NoDialog => {
                self.dialogs.in_window = true;
                self.ask_in_window(purpose);
            }
        }
    }

    fn chosen_in_system(&mut self, purpose: Purpose, path: &Path, ctx: &Context) {
        match purpose.refusal(path) {
            Some(reason) => self.report(Message::error(reason)),
            None => {
                // The system's dialog has asked whether to replace the file, unless it gets another name here.
                let was_asked = path == with_ending(path);
                self.chosen(purpose, path, was_asked, ctx);
            }
        }
    }

    /// Goes on with a path that [`Purpose::refusal`] has nothing against.
    pub(super) fn chosen(&mut self, purpose: Purpose, path: &Path, may_replace: bool, ctx: &Context) {
        match purpose {
            Purpose::Open => self.intend(Intent::Open(path.to_path_buf()), ctx),
            Purpose::Save(then) => {
                let path = with_ending(path);
                if self.is_own(&path) {
                    self.save_unless_changed(&path, then, ctx);
                } else if may_replace || !path.exists() {
                    self.save_to(&path, then, ctx);
                } else {
                    self.dialogs.question = Some(Question::Replace(path, then));
                }
            }
            Purpose::Mesh => self.add_mesh(path),
            Purpose::Attach(wanted) => self.read_file(wanted, path, ctx),
        }
    }

    /// Whether it is the document's own file, by whatever name.
    fn is_own(&self, path: &Path) -> bool {
        let own = self.session.document.path();
        own.is_some_and(|own| match (own.canonicalize(), path.canonicalize()) {
            (Ok(own), Ok(path)) => own == path,
            _ => own == path,
        })
    }

    fn add_mesh(&mut self, path: &Path) {
        let folder = self.session.document.path().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
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

    /// Refuses to close the window while work would be lost, and asks.
    pub(super) fn guard_closing(&mut self, ctx: &Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        if requested && !self.dialogs.closing && self.session.document.is_changed() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            if !self.has_dialog() {
                self.intend(Intent::Quit, ctx);
            }
        }
    }
}

/// The path that a scene is saved to where this one was chosen.
fn with_ending(path: &Path) -> PathBuf {
    if path.extension().is_none() { path.with_extension("json") } else { path.to_path_buf() }
}

fn suggested_name(path: Option<&Path>) -> String {
    path.and_then(Path::file_name).map_or_else(|| "scene.json".into(), |n| n.to_string_lossy().into_owned())
}
