//! What panels are given: the document with its selection and messages, how it is looked at, and what is made of it. What a
//! panel orders that reaches beyond this is a [`Request`].

use std::sync::Arc;

use super::commands::command::Command;
use super::edit_session::EditSession;
use super::file_jobs::FileJobs;
use super::intent::Intent;
use super::messages::{Message, Severity};
use super::view_state::{Picture, ViewSettings, ViewState};
use isolith_document::Document;
use isolith_field::FlatScene;
use isolith_scene::{NodeId, Scene};
use isolith_session::{Notice, NoticeLevel, ReadDocument, SceneSession};

/// An example that the File menu offers.
pub struct Example {
    /// Its entry in the menu.
    pub name: String,
    /// It stands in the submenu of test scenes: made to check the program, not to show what it can do.
    pub is_test: bool,
    /// Makes its document, or says why it cannot.
    pub open: ReadDocument,
}

/// What a panel orders. It is done when the panel has been shown, in the same frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Run this command.
    Run(Command),
    /// Replace the document, or end the program.
    Intend(Intent),
    /// Show the panel of this id, or hide it.
    TogglePanel(&'static str),
}

/// A panel, for those that list all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelEntry {
    /// Tells it from the others.
    pub id: &'static str,
    /// What it is called.
    pub title: &'static str,
    /// Whether it is shown.
    pub is_open: bool,
}

/// See the module.
pub struct EditorState {
    /// The document with gestures, and the messages.
    pub session: EditSession,
    /// How it is looked at.
    pub view: ViewState,
    /// What is made of it, and where everything runs that takes longer than a frame.
    pub derived: SceneSession,
    /// Files that are read and written for it.
    pub files: FileJobs,
    /// The picture of this frame.
    pub picture: Picture,
    /// What the File menu offers.
    pub examples: Vec<Example>,
    /// Whether there may be lost work to offer.
    pub can_recover: bool,
    /// A node that is to be renamed in place.
    pub renaming: Option<NodeId>,
    /// The panels that can be shown and hidden.
    pub panels: Vec<PanelEntry>,
    /// What panels have ordered, the oldest first.
    pub requests: Vec<Request>,
}

impl Default for EditorState {
    fn default() -> Self {
        Self {
            session: EditSession::new(Document::new(Scene::new())),
            view: ViewState::default(),
            derived: SceneSession::default(),
            files: FileJobs::default(),
            picture: Picture::default(),
            examples: Vec::new(),
            can_recover: false,
            renaming: None,
            panels: Vec::new(),
            requests: Vec::new(),
        }
    }
}

impl EditorState {
    /// What the renderer should show.
    pub fn wanted_view(&self) -> ViewSettings {
        let ViewState { navigation, view_mode, show_grid, show_outline, size_px, is_navigating, .. } = &self.view;
        ViewSettings {
            camera: navigation.camera(),
            size_px: *size_px,
            navigating: *is_navigating || self.session.is_changing(),
            show_grid: *show_grid,
            show_outline: *show_outline,
            view_mode: *view_mode,
        }
    }

    /// The document as arrays; the last good ones where the document is beyond a limit.
    pub fn flat(&self) -> &Arc<FlatScene> {
        self.derived.flat()
    }

    /// Brings what is made of the document up to date, and passes on what is to be said about it.
    pub fn follow_document(&mut self) {
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
