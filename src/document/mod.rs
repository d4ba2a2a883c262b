//! The scene over time: edits, undo, saving.
//!
//! [`Document::apply`] is the only gate through which a scene changes. Undo keeps snapshots: scenes share their nodes,
//! so the snapshot before an edit copies pointers and no contents.
//!
//! # Example
//!
//! An edit, and its undo:
//!
//! ```
//! use isolith_document::{Document, Edit};
//! use isolith_scene::{Group, Node, NodeKind, Scene};
//!
//! let mut document = Document::new(Scene::new());
//! let node = Node::new("Parts", NodeKind::Group(Group::UNION));
//! let new = document.apply(Edit::Insert { parent: None, position: 0, node })?;
//! assert_eq!(document.scene().nodes()[0].id, new[0]);
//! assert!(document.undo());
//! assert!(document.scene().nodes().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod change;
mod copying;
mod edit;
mod history;
mod keying;
mod keys;
mod layout;
mod links;
mod packed_copies;
mod placement;
mod preferences;
mod recent;
pub mod recovery;
mod save;
mod state_folder;
mod structure;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use change::Change;
pub use copying::extracted;
pub use edit::Edit;
use history::{History, State};
pub use history::{MAX_HISTORY_NODES, MAX_STEPS};
pub use layout::{Docked, DockedPart, MAX_LAYOUT_PARTS, PanelLayout};
pub use placement::recomposed;
pub use preferences::{
    ChangedKeys, MAX_CHANGED_KEYS, MAX_FAVORITES, PreferenceValues, Preferences, SCALES, export_keys, import_keys,
};
pub use recent::{MAX_RECENT, RecentFiles};
pub use save::{SaveOrder, Saved};
pub use state_folder::{data_folder, state_folder};

use isolith_jobs::Task;
use isolith_scene::file::{self, FileError, Stamp};
use isolith_scene::{NodeId, Scene, SceneError};

/// A scene with its selection, its history and its file.
#[derive(Debug)]
pub struct Document {
    state: State,
    revision: u64,
    history: History,
    gesture: Option<Gesture>,
    path: Option<PathBuf>,
    /// The mark of the state in the file; `None` if the file holds another state.
    saved: Option<u64>,
    /// The stamp of the file when it was read or saved.
    stamp: Option<Stamp>,
    /// The moment that is shown, in seconds.
    time: f64,
    /// The scene at that moment; `None` if nothing is animated.
    shown: Option<Arc<Scene>>,
}

/// The file that saving a document to a path would overwrite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverwriteRisk {
    /// No file, or the document's own file as it was read or saved last.
    Nothing,
    /// The document's own file, changed since by somebody else.
    ChangedByOthers,
    /// Another file.
    OtherFile,
}

/// Edits that form one step of undo.
#[derive(Debug)]
struct Gesture {
    start: State,
    /// The label of its first edit.
    label: Option<String>,
    /// A label for all of it.
    name: Option<String>,
    depth: u32,
}

impl Document {
    /// A document without a file. It counts as unchanged until the first edit.
    pub fn new(scene: Scene) -> Self {
        let state = State { scene: Arc::new(scene), selection: Vec::new(), mark: 0 };
        let mut new = Self {
            state,
            revision: 0,
            history: History::default(),
            gesture: None,
            path: None,
            saved: Some(0),
            stamp: None,
            time: 0.0,
            shown: None,
        };
        new.show();
        new
    }

    /// Reads a file, and removes the temporaries of this user's killed processes.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        Self::open_by(path, &Task::new("Opening"))
    }

    /// Like [`Document::open`], as a part of a task: reports progress to it, and stops when the task is canceled.
    pub fn open_by(path: &Path, task: &Task) -> Result<Self, FileError> {
        let (scene, stamp) = file::load_stamped(path, task)?;
        file::remove_leftovers();
        Ok(Self { path: Some(path.to_path_buf()), stamp: Some(stamp), ..Self::new(scene) })
    }

    /// A document restored after a crash. Its state was never saved, so it counts as changed. `stamp` is that of its
    /// file when the lost document was read from it.
    pub fn recovered(scene: Scene, path: Option<PathBuf>, stamp: Option<Stamp>) -> Self {
        Self { path, stamp, saved: None, ..Self::new(scene) }
    }

    /// The current scene at the moment that is shown. Edits refer to its values, see [`Document::apply`].
    pub fn scene(&self) -> &Scene {
        self.shown.as_ref().unwrap_or(&self.state.scene)
    }

    /// A snapshot of that scene for work on another thread. Later edits do not affect it.
    pub fn snapshot(&self) -> Arc<Scene> {
        Arc::clone(self.shown.as_ref().unwrap_or(&self.state.scene))
    }

    /// The current scene with its resting values, as files hold it. Without animation it is [`Document::scene`].
    pub fn resting(&self) -> &Arc<Scene> {
        &self.state.scene
    }

    /// The moment that is shown, in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Shows another moment. It is not a step of undo, and no change of the document.
    pub fn set_time(&mut self, time: f64) {
        if time.is_finite() && time != self.time {
            self.time = time;
            self.show();
        }
    }

    /// Evaluates the scene at the moment that is shown.
    fn show(&mut self) {
        let scene = &self.state.scene;
        self.shown = (!scene.animation.is_empty()).then(|| Arc::new(scene.at(self.time).into_owned()));
    }

    /// A number that grows with every change of the scene, including undo and redo.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The selected nodes, in the order of selection.
    pub fn selection(&self) -> &[NodeId] {
        &self.state.selection
    }

    /// Selects exactly these nodes. Drops unknown and repeated ids. Selecting is not a step of undo, but undo and redo
    /// restore the selection that belonged to the scene.
    pub fn select(&mut self, ids: Vec<NodeId>) {
        self.state.selection = ids;
        self.state.drop_unknown();
    }

    /// Changes the scene, or changes nothing and returns the reason. Returns the ids of the added nodes: for
    /// [`Edit::Duplicate`] the top nodes of the copies, for [`Edit::Group`] the group.
    ///
    /// Makes one step of undo, unless a gesture is open: a gesture makes one step of all its edits. An edit that
    /// changes nothing makes no step. Removed nodes leave the selection, which otherwise stays.
    ///
    /// A changed value of an animated parameter sets a key at the moment that is shown.
    pub fn apply(&mut self, edit: Edit) -> Result<Vec<NodeId>, SceneError> {
        let alone = self.gesture.is_none();
        if alone {
            self.begin_gesture();
        }
        let label = edit.label(self.scene());
        let result = self.perform(edit);
        if result.as_ref().is_ok_and(|change| change.changed) {
            self.revision += 1;
            self.state.mark = self.revision;
            self.state.drop_unknown();
            if let Some(gesture) = &mut self.gesture {
                gesture.label.get_or_insert(label);
            }
        }
        if alone {
            self.end_gesture();
        }
        result.map(|change| change.added)
    }

    fn perform(&mut self, edit: Edit) -> Result<Change, SceneError> {
        let change = match &self.shown {
            None => edit.perform(&mut self.state.scene)?,
            Some(shown) => {
                let mut next = Arc::clone(&self.state.scene);
                let change = keying::perform(edit, &mut next, shown, self.time)?;
                self.state.scene = next;
                change
            }
        };
        if change.changed {
            self.show();
        }
        Ok(change)
    }

    /// Whether a gesture is in progress.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Starts a gesture, such as a drag: all edits until the matching [`Document::end_gesture`] form one step. Gestures
    /// nest; the outermost counts.
    pub fn begin_gesture(&mut self) {
        match &mut self.gesture {
            Some(gesture) => gesture.depth += 1,
            None => self.gesture = Some(Gesture { start: self.state.clone(), label: None, name: None, depth: 1 }),
        }
    }

    /// Like [`Document::begin_gesture`], with the label of the step. A gesture within another does not name it.
    pub fn begin_step(&mut self, label: impl Into<String>) {
        let is_outermost = self.gesture.is_none();
        self.begin_gesture();
        if let Some(gesture) = self.gesture.as_mut().filter(|_| is_outermost) {
            gesture.name = Some(label.into());
        }
    }

    /// Ends a gesture. A gesture that leaves the scene unchanged makes no step. Does nothing without a gesture.
    pub fn end_gesture(&mut self) {
        let Some(mut gesture) = self.gesture.take() else { return };
        gesture.depth -= 1;
        if gesture.depth > 0 {
            self.gesture = Some(gesture);
            return;
        }
        let Some(label) = gesture.label else { return };
        if gesture.start.scene == self.state.scene {
            self.state.mark = gesture.start.mark;
        } else {
            self.history.push(gesture.name.unwrap_or(label), gesture.start);
        }
    }

    /// Reverts all edits of an open gesture and ends it. Does nothing without a gesture.
    pub fn cancel_gesture(&mut self) {
        let Some(gesture) = self.gesture.take() else { return };
        if gesture.label.is_some() {
            self.revision += 1;
            let selection = std::mem::take(&mut self.state.selection);
            self.state = State { selection, ..gesture.start };
            self.state.drop_unknown();
            self.show();
        }
    }

    /// Undoes one step and restores the selection of that time; false if there is none. An open gesture ends first and
    /// is the step that is undone.
    pub fn undo(&mut self) -> bool {
        self.close_gesture();
        let gone = self.history.undo(&mut self.state);
        self.revision += u64::from(gone);
        self.show();
        gone
    }

    /// Redoes one step and restores the selection of that time; false if there is none.
    pub fn redo(&mut self) -> bool {
        self.close_gesture();
        let gone = self.history.redo(&mut self.state);
        self.revision += u64::from(gone);
        self.show();
        gone
    }

    /// The label of the step that [`Document::undo`] would undo.
    pub fn undo_label(&self) -> Option<&str> {
        let open = self.gesture.as_ref().and_then(|g| g.label.as_ref().map(|label| g.name.as_ref().unwrap_or(label)));
        let open = open.map(String::as_str);
        open.or_else(|| self.undo_labels().next())
    }

    /// The label of the step that [`Document::redo`] would redo.
    pub fn redo_label(&self) -> Option<&str> {
        self.redo_labels().next()
    }

    /// Labels of the steps to undo, latest first: for a list of the history.
    pub fn undo_labels(&self) -> impl Iterator<Item = &str> {
        self.history.undo_labels()
    }

    /// Labels of the steps to redo, next first.
    pub fn redo_labels(&self) -> impl Iterator<Item = &str> {
        self.history.redo_labels()
    }

    /// Whether the scene differs from the file. Undoing back to the saved state counts as unchanged.
    pub fn is_changed(&self) -> bool {
        Some(self.state.mark) != self.saved
    }

    /// The document's file.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The file's name, followed by `*` if there are unsaved changes.
    pub fn title(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        let name = name.map_or_else(|| "Untitled".into(), |n| n.to_string_lossy());
        if self.is_changed() { format!("{name} *") } else { name.into_owned() }
    }

    /// Saves to the document's file. On failure the file is unchanged and the document stays changed.
    pub fn save(&mut self) -> Result<(), FileError> {
        match self.path.clone() {
            Some(path) => self.save_as(&path),
            None => Err(FileError::new(Path::new("Untitled"), "has no file yet; choose one to save to")),
        }
    }

    /// Saves to a file, which becomes the document's file. On failure nothing changes.
    pub fn save_as(&mut self, path: &Path) -> Result<(), FileError> {
        let saved = self.save_order(path).write()?;
        self.take_saved(saved);
        Ok(())
    }

    /// The file that saving to this path would overwrite. Saving does not ask, so callers check this first.
    pub fn would_replace(&self, path: &Path) -> OverwriteRisk {
        self.save_order(path).would_replace()
    }

    /// The stamp of the file when it was read or saved last.
    pub fn stamp(&self) -> Option<Stamp> {
        self.stamp
    }

    /// Whether somebody else seems to have changed the file. Cheap enough for periodic checks.
    pub fn seems_outdated(&self) -> bool {
        matches!((&self.path, self.stamp), (Some(path), Some(stamp)) if stamp.seems_outdated(path))
    }

    fn close_gesture(&mut self) {
        if let Some(gesture) = &mut self.gesture {
            gesture.depth = 1;
        }
        self.end_gesture();
    }
}
