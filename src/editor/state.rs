//! The state of panels: the document with its selection and messages, the view, and derived data. A panel that needs
//! more sends a [`Request`].

use std::sync::Arc;

use super::bringing::Bringing;
use super::commands::command::Command;
use super::edit_session::EditSession;
use super::file_jobs::FileJobs;
use super::intent::Intent;
use super::keymap::{KeyBindings, Keymap};
use super::material_library::MaterialLibrary;
use super::messages::{Message, Severity};
use super::navigation::Navigation;
use super::packing::Packing;
use super::playback::Playback;
use super::units::LengthUnit;
use super::view_slots::SideViews;
use super::view_state::{Picture, ViewSettings, ViewState, grid_of};
use isolith_document::{Document, Preferences};
use isolith_field::debug_view::ViewMode;
use isolith_field::{FlatScene, Shading};
use isolith_scene::{NodeId, NodeKind, Scene, Shape};
use isolith_session::{Notice, NoticeLevel, ReadDocument, SceneSession};

/// An example of the File menu.
pub struct Example {
    /// Its menu entry.
    pub name: String,
    /// Whether it belongs to the submenu of test scenes, which check the program rather than show its features.
    pub is_test: bool,
    /// Creates its document, or returns an error.
    pub open: ReadDocument,
}

/// A request of a panel. The editor carries it out after that panel, in the same frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Run this command.
    Run(Command),
    /// Replace the document, or end the program.
    Intend(Intent),
    /// Toggle the panel of this id.
    TogglePanel(&'static str),
    /// Show this many viewports: 1, 2 or 4.
    SplitView(usize),
    /// Put all panels back into their usual places.
    ResetLayout,
}

/// A list entry for a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelEntry {
    /// Its unique id.
    pub id: &'static str,
    /// Its title.
    pub title: &'static str,
    /// Whether it is open.
    pub is_open: bool,
}

/// The state that panels share.
pub struct EditorState {
    /// The document with gestures, and the messages.
    pub session: EditSession,
    /// The view of the document.
    pub view: ViewState,
    /// The other viewports.
    pub views: SideViews,
    /// The clock of the timeline.
    pub playback: Playback,
    /// Data derived from the document, and the jobs that take longer than a frame.
    pub derived: SceneSession,
    /// Its materials: use counts, thumbnails, the one in the foreground.
    pub materials: MaterialLibrary,
    /// Jobs that read and write files for it.
    pub files: FileJobs,
    /// Packs models into it.
    pub packing: Packing,
    /// A model that is copied below the scene's folder.
    pub bringing: Bringing,
    /// The picture of this frame.
    pub picture: Picture,
    /// The examples of the File menu.
    pub examples: Vec<Example>,
    /// Whether recovery is on.
    pub can_recover: bool,
    /// The node to rename in place.
    pub renaming: Option<NodeId>,
    /// The shapes that were edited last, one of each kind: a new one begins with their values.
    pub last_shapes: Vec<Shape>,
    /// The revision of the document when they were taken.
    shapes_seen: u64,
    /// What was copied or pasted last.
    pub copied: Option<Arc<Scene>>,
    /// Whether the list of undo steps is open.
    pub show_history: bool,
    /// What the user prefers.
    pub preferences: Preferences,
    /// The panels that can be hidden.
    pub panels: Vec<PanelEntry>,
    /// Pending requests of panels, oldest first.
    pub requests: Vec<Request>,
}

impl Default for EditorState {
    fn default() -> Self {
        Self {
            session: EditSession::new(Document::new(Scene::new())),
            view: ViewState::default(),
            views: SideViews::default(),
            playback: Playback::default(),
            derived: SceneSession::default(),
            materials: MaterialLibrary::default(),
            files: FileJobs::default(),
            packing: Packing::default(),
            bringing: Bringing::default(),
            picture: Picture::default(),
            examples: Vec::new(),
            can_recover: false,
            renaming: None,
            last_shapes: Vec::new(),
            shapes_seen: 0,
            copied: None,
            show_history: false,
            preferences: Preferences::default(),
            panels: Vec::new(),
            requests: Vec::new(),
        }
    }
}

impl EditorState {
    /// The view for the renderer.
    pub fn wanted_view(&self) -> ViewSettings {
        let ViewState { navigation, shading, view_mode, size_px, is_navigating, .. } = self.view;
        self.settings_of((navigation, size_px, shading, view_mode), is_navigating)
    }

    /// The view of a viewport for the renderer.
    pub(super) fn settings_of(
        &self,
        (navigation, size_px, shading, view_mode): (Navigation, [u32; 2], Shading, ViewMode),
        is_navigating: bool,
    ) -> ViewSettings {
        let ViewState { passes, samples, show_grid, show_outline, .. } = self.view;
        ViewSettings {
            camera: navigation.camera(),
            size_px,
            navigating: is_navigating || self.session.is_changing() || self.playback.is_moving(),
            show_grid,
            grid: grid_of(&navigation, LengthUnit::named(&self.preferences.values().unit).meters()),
            show_outline,
            shading,
            view_mode,
            passes,
            // A view in parallel has no eye near the scene.
            has_cut_offs: !navigation.orthographic,
            samples,
        }
    }

    /// The keymap in use.
    pub fn keymap(&self) -> Keymap {
        Keymap::named(&self.preferences.values().keymap)
    }

    /// The keys in use: the keymap with the user's changes.
    pub fn key_bindings(&self) -> KeyBindings {
        let keymap = self.keymap();
        KeyBindings::new(keymap, self.preferences.values().keys.get(keymap.label()))
    }

    /// Switches to a keymap, and keeps it for the next start.
    pub fn use_keymap(&mut self, keymap: Keymap) {
        self.preferences.change(|values| values.keymap = keymap.label().to_owned());
    }

    /// The flat scene; the last valid one if the document exceeds a limit.
    pub fn flat(&self) -> &Arc<FlatScene> {
        self.derived.flat()
    }

    /// Remembers the values of the selected shape after a change.
    fn remember_shape(&mut self) {
        let document = &self.session.document;
        if self.shapes_seen == document.revision() {
            return;
        }
        self.shapes_seen = document.revision();
        let node = match document.selection() {
            [only] => document.scene().node(*only),
            _ => None,
        };
        if let Some(NodeKind::Object(object)) = node.map(|node| &node.kind) {
            let shape = object.shape.clone();
            self.last_shapes.retain(|last| last.kind() != shape.kind());
            self.last_shapes.push(shape);
        }
    }

    /// Updates the derived data and forwards its notices as messages.
    pub fn follow_document(&mut self) {
        self.remember_shape();
        self.materials.follow(&self.session.document);
        self.derived.follow(&self.session.document);
        for Notice { level, text } in self.derived.take_notices() {
            let severity = match level {
                NoticeLevel::Info => Severity::Info,
                NoticeLevel::Warning => Severity::Warning,
                NoticeLevel::Error => Severity::Error,
            };
            self.session.messages.push(Message { severity, text });
        }
    }
}
