//! Models on disk: what their files hold that is not drawn is told, and they are read again when their files change or
//! the artist asks for it.

use std::collections::HashMap;
use std::sync::{Arc, Weak};

use egui::Context;

use super::Editor;
use super::messages::Message;
use crate::flat::FlatMesh;
use crate::mesh::{ReloadOutcome, TriangleMesh, Watcher};

/// Looks after the files of the meshes.
#[derive(Default)]
pub(super) struct Models {
    /// Started when there is something to look after.
    watcher: Option<Watcher>,
    /// That of the meshes that the watcher knows.
    revision: Option<u64>,
    /// What has been told about, by path.
    told: HashMap<String, Weak<TriangleMesh>>,
}

/// Most things that one message says about a model.
const THINGS_TOLD: usize = 4;

impl Editor {
    /// Reads all models again, in the background.
    pub(super) fn reload_models(&mut self) {
        if let Some(watcher) = &self.models.watcher {
            watcher.read_all();
        }
    }

    /// Takes what was read again. Once a frame.
    pub(super) fn poll_models(&mut self, ctx: &Context) {
        let news: Vec<_> = self.models.watcher.iter().flat_map(|watcher| watcher.news().collect::<Vec<_>>()).collect();
        for fresh in news {
            let path = fresh.source().path().to_owned();
            let message = match self.meshes.replace(fresh) {
                ReloadOutcome::Fresh(_) => Message::info(format!("{path} was read again")),
                ReloadOutcome::Kept(error) => Message::error(format!("{error}. It is shown as it was before")),
                ReloadOutcome::Broken(error) => Message::error(error.to_string()),
                ReloadOutcome::Unwanted => continue,
            };
            self.report(message);
        }
        let revision = self.meshes.revision();
        if self.models.revision == Some(revision) {
            return;
        }
        self.models.revision = Some(revision);
        self.find_mesh_problem();
        self.tell_what_is_not_drawn();
        self.watch_models(ctx);
        // The messages, and the picture with the new mesh.
        ctx.request_repaint();
    }

    /// Loads all meshes, and keeps in mind the first that cannot be read.
    pub(super) fn find_mesh_problem(&mut self) {
        let mut problem = None;
        for FlatMesh { id, path, .. } in &self.flat.scene.meshes {
            if let Err(error) = self.meshes.get(path) {
                problem.get_or_insert_with(|| (*id, error.to_string()));
            }
        }
        self.flat.mesh_problem = problem;
    }

    fn tell_what_is_not_drawn(&mut self) {
        let mut messages = Vec::new();
        for FlatMesh { path, .. } in &self.flat.scene.meshes {
            let Some(Ok(mesh)) = self.meshes.known(path) else { continue };
            let told = self.models.told.insert(path.clone(), Arc::downgrade(mesh));
            let is_told = told.is_some_and(|told| told.as_ptr() == Arc::as_ptr(mesh));
            if is_told || mesh.warnings.is_empty() {
                continue;
            }
            let things = mesh.warnings.iter().take(THINGS_TOLD).map(String::as_str).collect::<Vec<_>>().join("; ");
            let more = mesh.warnings.len().saturating_sub(THINGS_TOLD);
            let more = if more > 0 { format!("; and {more} more") } else { String::new() };
            messages.push(Message::warning(format!("{path}: {things}{more}")));
        }
        for message in messages {
            self.report(message);
        }
    }

    fn watch_models(&mut self, ctx: &Context) {
        let sources = self.meshes.sources();
        if self.models.watcher.is_none() && !sources.is_empty() {
            let ctx = ctx.clone();
            match Watcher::start(move || ctx.request_repaint()) {
                Ok(watcher) => self.models.watcher = Some(watcher),
                Err(error) => self.report(Message::warning(format!("Models are not looked after: {error}"))),
            }
        }
        if let Some(watcher) = &self.models.watcher {
            watcher.watch(sources);
        }
    }
}
