//! Files that are dropped on the window: scenes are opened, models added, images become textures or the environment.

use std::path::{Path, PathBuf};

use egui::Context;

use super::edit_session::WantedFile;
use super::intent::Intent;
use super::messages::Message;
use super::picking::pick_node;
use super::projection::Projection;
use super::root::Editor;
use super::{dialogs, material_edits};
use isolith_document::Edit;
use isolith_scene::{Attached, Attachment, MaterialId, NodeId, ParamPath, ParamValue};

/// The extensions of models.
const MODELS: [&str; 2] = ["gltf", "glb"];

impl Editor {
    /// Takes the files that are dropped in this frame. Of several scenes the first counts.
    pub(super) fn take_dropped_files(&mut self, ctx: &Context) {
        let paths: Vec<PathBuf> =
            ctx.input(|i| i.raw.dropped_files.iter().map(|file| file.path().to_path_buf()).collect());
        if paths.is_empty() || self.has_dialog() {
            return;
        }
        self.state.session.finish();
        let ending = |path: &Path| path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if let Some(scene) = paths.iter().find(|path| dialogs::ENDINGS.contains(&&*ending(path))) {
            self.intend(Intent::Open(scene.clone()), ctx);
            return;
        }
        let pointer = ctx.pointer_latest_pos().filter(|at| self.state.view.rect.contains(*at));
        for path in paths {
            let ending = ending(&path);
            let texture = Attached::Texture(Attachment::NONE);
            let environment = Attached::Environment(Attachment::NONE);
            let under = pointer.and_then(|at| pick_node(&self.state, &Projection::of(&self.state.view).ray(at)));
            if MODELS.contains(&&*ending) {
                self.state.view.add_at = pointer;
                self.add_mesh_of_saved(&path);
            } else if texture.endings().contains(&&*ending)
                && let Some(material) = under.and_then(|id| self.own_material(id))
            {
                self.read_texture(material, texture, &path);
            } else if environment.endings().contains(&&*ending) {
                self.read_environment(environment, &path);
            } else {
                self.report(Message::warning(refusal(&path, texture.endings().contains(&&*ending))));
            }
        }
    }

    /// The material of a node.
    fn own_material(&self, id: NodeId) -> Option<MaterialId> {
        material_edits::material_of(self.document().scene().node(id)?)
    }

    /// Makes the image the color of the material. The file is read by a job.
    fn read_texture(&mut self, material: MaterialId, instead_of: Attached, path: &Path) {
        let of = |name: &'static str| ParamPath::of_material(material, name);
        self.choose_then_read(
            "Use an image",
            &[(of("textures.type"), "triplanar"), (of("textures.color.type"), "image")],
        );
        self.read_into(of("textures.color.image"), instead_of, path);
    }

    /// Makes the image what is around the scene.
    fn read_environment(&mut self, instead_of: Attached, path: &Path) {
        self.choose_then_read("Use an image", &[(ParamPath::of_environment("type"), "image")]);
        self.read_into(ParamPath::of_environment("image"), instead_of, path);
    }

    /// Sets choices by the keys that files have for them, unless they are set.
    fn choose_then_read(&mut self, label: &str, choices: &[(ParamPath, &str)]) {
        self.state.session.document.begin_step(label);
        for (path, key) in choices {
            let scene = self.state.session.document.snapshot();
            let known = path.param(&scene).ok().and_then(|param| param.choices.iter().find(|c| c.key == *key));
            let Some(choice) = known else { continue };
            let value = ParamValue::Choice(&choice.key);
            if path.get(&scene).ok().as_ref() != Some(&value) {
                self.state.session.apply(Edit::SetParam { path: path.clone(), value });
            }
        }
        self.state.session.document.end_gesture();
    }

    fn read_into(&mut self, parameter: ParamPath, instead_of: Attached, path: &Path) {
        let wanted = WantedFile { paths: vec![parameter], instead_of };
        self.state.files.read(self.state.derived.jobs(), wanted, path);
    }
}

/// Why a file is of no use, and what would be.
fn refusal(path: &Path, is_image: bool) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match is_image {
        true => format!("{name}: drop an image on an object to give it this color."),
        false => format!("{name} cannot be used. Drop a scene, a glTF model, or an image on an object."),
    }
}
