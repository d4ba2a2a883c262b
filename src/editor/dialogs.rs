//! What is asked before work is lost, and for which files: the questions as data. `dialog_views` shows them, `choosing` and
//! `documents` go on with the answers.

use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;
use std::time::Instant;

use super::edit_session::WantedFile;
use isolith_scene::Attached;
use isolith_session::{Opened, folder_of};

/// An intent that can be carried out: its document has been opened.
pub enum Next {
    /// A new scene.
    New,
    /// Ask which file to open.
    Choose,
    /// Show this document, which was read from this file.
    Show(Box<Opened>, Option<PathBuf>),
    /// Save to this path, though the file is another one where the flag says so; then go on.
    Save(PathBuf, bool, Option<Box<Next>>),
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
        let folder = folder_of(&path).filter(|folder| !folder.is_dir())?;
        Some(format!("There is no folder {}.", folder.display()))
    }
}

/// The system's dialog, open on a thread of its own.
pub struct SystemDialog {
    /// What for.
    pub purpose: Purpose,
    /// What is chosen in it.
    pub answer: Receiver<SystemAnswer>,
    /// When it was opened.
    pub since: Instant,
}

/// What comes of the system's dialog.
pub enum SystemAnswer {
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
    /// The system's dialog, where one is open.
    pub system: Option<SystemDialog>,
    /// The path being typed.
    pub path_field: Option<PathField>,
    /// Ask for paths in the window instead of by the system's dialog.
    pub in_window: bool,
    /// The artist has agreed to close the window.
    pub closing: bool,
}

impl Dialogs {
    /// Whether the window waits for an answer.
    pub fn is_open(&self) -> bool {
        self.question.is_some() || self.path_field.is_some()
    }
}

/// The path that a scene is saved to where this one was chosen.
pub fn with_ending(path: &Path) -> PathBuf {
    if path.extension().is_none() { path.with_extension("json") } else { path.to_path_buf() }
}
