//! The document as arrays: at once where that is quick, otherwise by a thread beside the frames, which stops when
//! something newer is wanted.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use egui::Context;

use super::Editor;
use crate::flat::{Cancel, FlatScene, Flattener, is_quick};
use crate::guard::guarded;
use crate::scene::{NodeId, Scene};

/// The flat scene of a revision of the document.
#[derive(Default)]
pub(super) struct Flattened {
    flattener: Flattener,
    /// The last one that could be made.
    pub scene: Arc<FlatScene>,
    /// The revision that was looked at last.
    revision: Option<u64>,
    pub problem: Option<String>,
    /// A mesh that cannot be read, and why.
    pub mesh_problem: Option<(NodeId, String)>,
    away: Option<Away>,
    /// The document is a new one, whose first view has to wait for its arrays.
    wants_view: bool,
}

/// What a thread is at.
struct Away {
    cancel: Cancel,
    answer: Receiver<FlattenResult>,
}

/// What a thread gives back: what it flattens with, and what came of it; nothing where it was canceled.
type FlattenResult = (Flattener, Result<Option<Arc<FlatScene>>, String>);

/// How soon a thread is looked after again.
const LATER: Duration = Duration::from_millis(20);

impl Flattened {
    /// Whether a thread is at work.
    pub fn is_under_way(&self) -> bool {
        self.away.is_some()
    }

    /// Forgets everything for another document.
    pub fn reset(&mut self) {
        self.stop();
        *self = Self { wants_view: true, ..Self::default() };
    }

    fn stop(&mut self) {
        if let Some(away) = self.away.take() {
            away.cancel.cancel();
        }
    }

    fn take(&mut self, result: Result<Arc<FlatScene>, String>) {
        match result {
            Ok(flat) => (self.scene, self.problem) = (flat, None),
            Err(problem) => self.problem = Some(problem),
        }
    }

    /// Brings the arrays up to date with this revision, or has a thread do it.
    fn follow(&mut self, scene: &Scene, revision: u64) {
        self.revision = Some(revision);
        self.stop();
        if let Some(flat) = self.flattener.update(scene, 0.0) {
            self.take(Ok(flat));
        } else if is_quick(scene) {
            let result = self.flattener.flatten(scene, 0.0).map_err(|error| error.to_string());
            self.take(result);
        } else {
            self.order(scene.clone());
        }
    }

    fn order(&mut self, scene: Scene) {
        let (sender, answer) = channel();
        let (cancel, mut flattener) = (Cancel::default(), std::mem::take(&mut self.flattener));
        let told = cancel.clone();
        let work = move || {
            let made = guarded(|| flattener.flatten_until(&scene, 0.0, &told));
            let result = made.and_then(|made| made.map_err(|error| error.to_string()));
            // The receiver is gone when something newer is wanted.
            let _ = sender.send((flattener, result));
        };
        match std::thread::Builder::new().name("flatten".into()).spawn(work) {
            Ok(_) => self.away = Some(Away { cancel, answer }),
            Err(error) => self.problem = Some(format!("no thread can be started: {error}")),
        }
    }

    /// Takes over what the thread has made; true if there was anything.
    fn poll(&mut self) -> bool {
        let Some(away) = &self.away else { return false };
        let result = match away.answer.try_recv() {
            Err(TryRecvError::Empty) => return false,
            Err(TryRecvError::Disconnected) => Err("the scene could not be prepared".into()),
            Ok((flattener, result)) => {
                self.flattener = flattener;
                result.transpose().unwrap_or_else(|| Err("preparing the scene was canceled".into()))
            }
        };
        self.away = None;
        self.take(result);
        true
    }
}

impl Editor {
    /// Follows the document; also once for another document, before its first frame.
    pub(super) fn refresh_flat(&mut self) {
        let revision = self.session.document.revision();
        let is_new = self.flat.revision != Some(revision);
        if is_new {
            self.flat.follow(self.session.document.scene(), revision);
        }
        if !self.flat.poll() && !is_new {
            return;
        }
        self.find_mesh_problem();
        if self.flat.wants_view && !self.flat.is_under_way() {
            self.flat.wants_view = false;
            self.show_as_saved();
        }
    }

    /// Whether the arrays are still being made; has the window look again soon then.
    pub(super) fn is_flattening(&self, ctx: &Context) -> bool {
        if self.flat.is_under_way() {
            ctx.request_repaint_after(LATER);
        }
        self.flat.is_under_way()
    }
}
