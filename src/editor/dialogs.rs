//! The dialogs as data: questions before a loss of work, and requests for paths. `dialog_views` shows them; `choosing`
//! and `documents` act on the answers.

use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;
use std::time::Instant;

use super::edit_session::WantedFile;
use isolith_scene::Attached;
use isolith_session::{Opened, folder_of};

/// A step that is ready to run: its document has been read.
pub enum Next {
    /// Start a new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Show this document, read from this file.
    Show(Box<Opened>, Option<PathBuf>),
    /// Save to this path, then continue. The flag allows overwriting a file that another program has changed.
    Save(PathBuf, bool, Option<Box<Next>>),
    /// Close the window.
    Quit,
}

/// The purpose of a path.
pub enum Purpose {
    /// Open a scene.
    Open,
    /// Save, then continue with the step that needed the saving.
    Save(Option<Next>),
    /// Add a mesh.
    Mesh,
    /// Use another file for all meshes of this one.
    Relink(String),
    /// Store a file in the scene.
    Attach(WantedFile),
    /// Render pictures into files of this name.
    RenderTo,
    /// Write the changed keys to a file.
    ExportKeys,
    /// Read changed keys from a file.
    ImportKeys,
}

impl Purpose {
    /// The title of the dialog.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Open => "Open a scene",
            Self::Save(_) => "Save the scene",
            Self::Mesh => "Add a mesh",
            Self::RenderTo => "Render into a file",
            Self::ExportKeys => "Export the keymap",
            Self::ImportKeys => "Import a keymap",
            Self::Relink(_) => "Find the model",
            Self::Attach(WantedFile {
                instead_of: Attached::Heights(_) | Attached::Texture(_) | Attached::Environment(_),
                ..
            }) => "Choose an image",
            Self::Attach(WantedFile { instead_of: Attached::Font(_), .. }) => "Choose a font",
        }
    }

    /// Why the path cannot serve this purpose, before any reading or writing.
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
            Self::Save(_) | Self::ExportKeys => {}
            Self::RenderTo => {
                let folder = folder_of(path).filter(|folder| !folder.is_dir())?;
                return Some(format!("There is no folder {}.", folder.display()));
            }
            // Its reader reports problems in more detail.
            Self::Attach(_) => return None,
            Self::Open | Self::Mesh | Self::Relink(_) | Self::ImportKeys => {
                return (!path.exists()).then(|| format!("There is no file {name}."));
            }
        }
        let path = with_ending(path);
        if path.is_dir() {
            return Some(format!("{} is a folder, not a file.", path.display()));
        }
        let folder = folder_of(&path).filter(|folder| !folder.is_dir())?;
        Some(format!("There is no folder {}.", folder.display()))
    }
}

/// The system's dialog, open on its own thread.
pub struct SystemDialog {
    /// The purpose of the path.
    pub purpose: Purpose,
    /// Receives the answer.
    pub answer: Receiver<SystemAnswer>,
    /// When it was opened.
    pub since: Instant,
}

/// The answer of the system's dialog.
pub enum SystemAnswer {
    /// The chosen path; `None` if the artist has canceled.
    Chosen(Option<PathBuf>),
    /// The system has no such dialog.
    NoDialog,
}

/// The built-in path dialog, for systems without one.
pub struct PathField {
    /// The purpose of the path.
    pub purpose: Purpose,
    /// The typed text.
    pub text: String,
    /// Whether the field has received the focus once.
    pub focused: bool,
    /// Why the typed path is not suitable.
    pub problem: Option<String>,
}

/// A question before a loss of work.
pub enum Question {
    /// The document has unsaved changes.
    Unsaved(Next),
    /// Pictures are being rendered.
    Rendering(Next),
    /// A file of this name exists.
    Replace(PathBuf, Option<Next>),
}

/// The open dialogs.
#[derive(Default)]
pub struct Dialogs {
    /// The pending question.
    pub question: Option<Question>,
    /// The system's dialog, if open.
    pub system: Option<SystemDialog>,
    /// The built-in path dialog, if open.
    pub path_field: Option<PathField>,
    /// Ask for paths in the window instead of by the system's dialog.
    pub in_window: bool,
    /// The artist has agreed to close the window.
    pub closing: bool,
}

impl Dialogs {
    /// Whether a dialog in the window is open.
    pub fn is_open(&self) -> bool {
        self.question.is_some() || self.path_field.is_some()
    }
}

/// The extensions of scene files; new ones get the first. Both have the same content.
pub const ENDINGS: [&str; 2] = ["isolith", "json"];

/// The path to save to for a chosen path: with the extension of a scene file, that of an existing one if there is one.
pub fn with_ending(path: &Path) -> PathBuf {
    if path.extension().is_some() {
        return path.to_path_buf();
    }
    let [new, other] = ENDINGS.map(|ending| path.with_extension(ending));
    if other.exists() && !new.exists() { other } else { new }
}
