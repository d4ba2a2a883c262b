//! Asks for file paths, by the system's dialog or in the window, and continues with the chosen path.

use std::path::Path;
use std::sync::mpsc::{TryRecvError, channel};
use std::time::{Duration, Instant};

use egui::Context;

use super::bringing::ModelUse;
use super::dialogs::{ENDINGS, Next, PathField, Purpose, Question, SystemAnswer, SystemDialog, with_ending};
use super::intent::Intent;
use super::messages::Message;
use super::root::Editor;
use super::{insertion, portal};
use isolith_document::Edit;
use isolith_scene::{MeshNode, Node, NodeId, NodeKind, Object, Shape};

/// An artist cannot cancel a dialog faster than this: a quicker cancel means that no dialog opened.
const NO_DIALOG: Duration = Duration::from_millis(600);

/// Why a mesh cannot be added yet.
const SAVE_FIRST: &str = "Save the scene first: mesh files are named relative to the scene's folder.";

impl Editor {
    /// Asks for a path to save to, then continues with `then`.
    pub fn choose_save_path(&mut self, then: Option<Next>, ctx: &Context) {
        self.choose(Purpose::Save(then), ctx);
    }

    /// Adds a mesh file, unless the scene has no file that it could be named from.
    pub(super) fn add_mesh_of_saved(&mut self, path: &Path) {
        if self.state.session.document.path().is_none() {
            self.report(Message::info(SAVE_FIRST));
        } else {
            self.add_mesh(path);
        }
    }

    /// Asks for a mesh file and adds it.
    pub fn choose_mesh(&mut self, ctx: &Context) {
        if self.state.session.document.path().is_none() {
            self.report(Message::info(SAVE_FIRST));
        } else {
            self.choose(Purpose::Mesh, ctx);
        }
    }

    pub(super) fn choose(&mut self, purpose: Purpose, ctx: &Context) {
        // The artist asks again, so the open system dialog is out of sight: ignore its answer.
        let is_unanswered = self.dialogs.system.take().is_some();
        if self.dialogs.in_window || is_unanswered {
            self.ask_in_window(purpose);
            return;
        }
        let dialog = self.system_dialog(&purpose);
        let (sender, answer) = channel();
        let (ctx, saving) = (ctx.clone(), saves(&purpose));
        let spawned = std::thread::Builder::new().name("file dialog".into()).spawn(move || {
            let answer = match portal::has_dialogs() {
                false => SystemAnswer::NoDialog,
                true if saving => SystemAnswer::Chosen(dialog.save_file()),
                true => SystemAnswer::Chosen(dialog.pick_file()),
            };
            // The receiver is gone if the window is: nothing waits for the answer.
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
            Purpose::Mesh | Purpose::Relink(_) => dialog.add_filter("glTF", &["gltf", "glb"]),
            Purpose::Attach(wanted) => dialog.add_filter("Files that can be used", wanted.instead_of.endings()),
            Purpose::RenderTo => dialog.add_filter("Pictures", &["png", "exr"]),
            Purpose::ExportKeys | Purpose::ImportKeys => dialog.add_filter("Keymap", &["json"]),
            Purpose::Open | Purpose::Save(_) => dialog.add_filter("Isolith scene", &ENDINGS),
        };
        let path = self.state.session.document.path();
        if let Some(folder) = path.and_then(Path::parent).filter(|f| f.is_absolute()) {
            dialog = dialog.set_directory(folder);
        }
        if matches!(purpose, Purpose::Save(_)) {
            dialog = dialog.set_file_name(suggested_name(path));
        } else if matches!(purpose, Purpose::RenderTo) {
            dialog = dialog.set_file_name(suggested_name(Some(Path::new(&self.rendering.output))));
        }
        dialog
    }

    fn ask_in_window(&mut self, purpose: Purpose) {
        let path = self.state.session.document.path();
        let text = match (&purpose, path) {
            (Purpose::RenderTo, _) => self.rendering.output.clone(),
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

    /// Takes the answer of the system's dialog and asks for the files that panels request. Call once a frame.
    pub(super) fn poll_dialogs(&mut self, ctx: &Context) {
        if let Some(wanted) = self.state.session.wanted_file.take() {
            self.state.session.finish();
            self.choose(Purpose::Attach(wanted), ctx);
        }
        if let Some(old) = self.state.session.wanted_mesh.take() {
            self.state.session.finish();
            self.choose(Purpose::Relink(old), ctx);
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
                // The system's dialog has asked whether to replace the file, unless the file gets an extension here.
                let was_asked = path == with_ending(path);
                self.chosen(purpose, path, was_asked, ctx);
            }
        }
    }

    /// Continues with a path that [`Purpose::refusal`] accepts.
    pub(super) fn chosen(&mut self, purpose: Purpose, path: &Path, may_replace: bool, ctx: &Context) {
        match purpose {
            Purpose::Open => self.intend(Intent::Open(path.to_path_buf()), ctx),
            Purpose::Save(then) => {
                let path = with_ending(path);
                if self.is_own(&path) {
                    self.start_saving(&path, false, then);
                } else if may_replace || !path.exists() {
                    self.start_saving(&path, true, then);
                } else {
                    self.dialogs.question = Some(Question::Replace(path, then));
                }
            }
            Purpose::Mesh => self.add_mesh(path),
            Purpose::RenderTo => self.rendering.choose_path(path),
            Purpose::Relink(old) => self.relink(&old, path),
            Purpose::Attach(wanted) => self.state.files.read(self.state.derived.jobs(), wanted, path),
            Purpose::ExportKeys => self.export_keys(&with_ending(path)),
            Purpose::ImportKeys => self.import_keys(path),
        }
    }

    /// Whether the path names the document's own file, under any alias.
    fn is_own(&self, path: &Path) -> bool {
        let own = self.state.session.document.path();
        own.is_some_and(|own| match (own.canonicalize(), path.canonicalize()) {
            (Ok(own), Ok(path)) => own == path,
            _ => own == path,
        })
    }

    fn add_mesh(&mut self, path: &Path) {
        let name = path.file_stem().map_or_else(|| "Mesh".into(), |s| s.to_string_lossy().into_owned());
        match self.named_from_scene(path) {
            Some(relative) => self.insert_mesh(name, relative),
            None => self.bring(path, ModelUse::Add(name)),
        }
    }

    /// Copies a model from elsewhere below the scene's folder, then uses it.
    fn bring(&mut self, path: &Path, wanted: ModelUse) {
        self.state.bringing.start(self.state.derived.jobs(), &self.state.session, path, wanted);
    }

    /// Uses the model that was copied. Call once a frame.
    pub(super) fn use_brought_model(&mut self) {
        match self.state.bringing.poll(&mut self.state.session) {
            Some((ModelUse::Add(name), path)) => self.insert_mesh(name, path),
            Some((ModelUse::Relink(old), path)) => self.relink_to(&old, &path),
            None => {}
        }
    }

    fn insert_mesh(&mut self, name: String, relative: String) {
        insertion::node(&mut self.state, Node::new(name, NodeKind::Mesh(MeshNode::new(relative))));
    }

    /// Gives all meshes of a file another file, and all fields of one. Those without a file get one if they are
    /// selected.
    fn relink(&mut self, old: &str, path: &Path) {
        match self.named_from_scene(path) {
            Some(relative) => self.relink_to(old, &relative),
            None => self.bring(path, ModelUse::Relink(old.to_owned())),
        }
    }

    fn relink_to(&mut self, old: &str, relative: &str) {
        let scene = self.state.session.document.snapshot();
        let chosen: Vec<NodeId> = self.state.session.document.selection().to_vec();
        let step = if old.is_empty() { "Choose a model".to_owned() } else { format!("Relink {old}") };
        self.state.session.document.begin_step(step);
        for node in scene.nodes() {
            if old.is_empty() && !chosen.contains(&node.id) {
                continue;
            }
            let mut kind = node.kind.clone();
            let place = match &mut kind {
                NodeKind::Mesh(mesh) => &mut mesh.path,
                NodeKind::Object(Object { shape: Shape::MeshField { file, .. }, .. }) => &mut file.path,
                _ => continue,
            };
            if place == old {
                relative.clone_into(place);
                self.state.session.apply(Edit::Replace(Node { kind, ..Node::clone(node) }));
            }
        }
        self.state.session.document.end_gesture();
    }

    /// The path of a file as scenes name it: from their folder, with slashes; `None` for a file that is elsewhere.
    fn named_from_scene(&self, path: &Path) -> Option<String> {
        let folder =
            self.state.session.document.path().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default();
        let relative = path.strip_prefix(&folder).ok().filter(|_| path.is_absolute()).unwrap_or(path);
        if relative.is_absolute() {
            return None;
        }
        let parts: Vec<_> = relative.iter().map(|p| p.to_string_lossy()).collect();
        Some(parts.join("/"))
    }
}

/// Whether a file is written, so that it need not exist.
fn saves(purpose: &Purpose) -> bool {
    matches!(purpose, Purpose::Save(_) | Purpose::RenderTo | Purpose::ExportKeys)
}

fn suggested_name(path: Option<&Path>) -> String {
    path.and_then(Path::file_name).map_or_else(|| format!("scene.{}", ENDINGS[0]), |n| n.to_string_lossy().into_owned())
}
