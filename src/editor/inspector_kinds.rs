//! Cards for the kinds of nodes: shape, mesh, light, camera.

use egui::{RichText, Ui};

use super::multi_edit::MultiEdit;
use super::widgets::{self, MIXED};
use super::{inspector_model, inspector_params, shape_change, theme};
use isolith_jobs::Task;
use isolith_scene::{CameraNode, MarchSettings, MeshNode, Node, NodeKind, Object, Params, Part, ShapeKind};

fn object(n: &Node) -> Option<&Object> {
    if let NodeKind::Object(o) = &n.kind { Some(o) } else { None }
}

fn object_mut(n: &mut Node) -> Option<&mut Object> {
    if let NodeKind::Object(o) = &mut n.kind { Some(o) } else { None }
}

/// The kind of the shape and its parameters, generated from the table of shapes.
pub fn shape(ui: &mut Ui, edit: &mut MultiEdit<'_>, tasks: &[Task]) {
    widgets::card(ui, "Shape", |ui| {
        edit.choice(
            ui,
            ("Primitive", "Another shape in the same place, about the same size"),
            ShapeKind::ALL,
            (ShapeKind::label, ShapeKind::help),
            |n| object(n).map(|o| o.shape.kind()),
            |n, kind| {
                if let Some(o) = object_mut(n) {
                    o.shape = shape_change::changed(&o.shape, kind);
                }
            },
        );
        let Some(kind) = edit.common(|n| object(n).map(|o| o.shape.kind())).flatten() else {
            ui.label(RichText::new("Different shapes: no common parameters").color(theme::WEAK));
            return;
        };
        for param in kind.params() {
            inspector_params::row(ui, edit, Part::Shape, param.name);
        }
        if kind.params().is_empty() {
            ui.label(RichText::new("No parameters: position and rotation say all.").color(theme::WEAK));
        }
        inspector_model::show(ui, edit, tasks);
    });
}

/// The file of a mesh, and the clip that poses it.
pub fn mesh(ui: &mut Ui, edit: &mut MultiEdit<'_>, mesh: &MeshNode) {
    widgets::card(ui, "Mesh", |ui| {
        let help = "A .gltf or .glb file, relative to the scene's folder";
        let path = |n: &Node| if let NodeKind::Mesh(m) = &n.kind { Some(m.path.clone()) } else { None };
        let (current, hint) = if edit.common(path).is_some() { (&*mesh.path, "models/thing.glb") } else { ("", MIXED) };
        // An incomplete path names no file: look for the file only at the end of typing.
        let (widget, typed) = widgets::row(ui, "File", help, |ui| widgets::line(ui, "File", current, hint));
        if let Some(path) = typed {
            edit.change(widget, |n| {
                if let NodeKind::Mesh(m) = &mut n.kind {
                    m.path.clone_from(&path);
                }
            });
        }
        let choose = ui.button("Choose a file…").on_hover_text("Another file for all meshes that use this one");
        if choose.clicked() && !current.is_empty() {
            edit.session().wanted_mesh = Some(mesh.path.clone());
        }
        let help = "The animation clip that poses the model, by its name or its number; empty for the rest pose";
        let clip = |n: &Node| if let NodeKind::Mesh(m) = &n.kind { Some(m.clip.clone()) } else { None };
        let (current, hint) = if edit.common(clip).is_some() { (&*mesh.clip, "at rest") } else { ("", MIXED) };
        let (widget, typed) = widgets::row(ui, "Clip", help, |ui| widgets::line(ui, "Clip", current, hint));
        if let Some(clip) = typed {
            edit.change(widget, |n| {
                if let NodeKind::Mesh(m) = &mut n.kind {
                    m.clip.clone_from(&clip);
                }
            });
        }
        if !mesh.clip.is_empty() {
            inspector_params::row(ui, edit, Part::Mesh, "clip_time");
            inspector_params::row(ui, edit, Part::Mesh, "clip_speed");
        }
    });
}

/// How a part of the scene is marched: folded, since few parts need more than the usual settings.
pub fn march(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let is_usual = edit.common(|node| node.march.is_usual()) == Some(true);
    widgets::folded_card(ui, "Ray march", !is_usual, |ui| {
        for param in MarchSettings::default().params() {
            inspector_params::row(ui, edit, Part::March, param.name);
        }
    });
}

/// Type, color, strength, size and falloff.
pub fn light(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Light", |ui| {
        inspector_params::row(ui, edit, Part::Light, "light.type");
        let mut names = Vec::new();
        if let Some(params) = Part::Light.params(edit.active()) {
            params.visit("", &mut |prefix, param, _| names.push(format!("{prefix}{}", param.name)));
        }
        let (falloff, names): (Vec<_>, Vec<_>) = names.into_iter().partition(|name| is_falloff(name));
        for name in names {
            match &*name {
                "light.type" => {}
                "light.inner" => {
                    inspector_params::end_row(ui, edit, Part::Light, ["light.inner", "light.outer"], f64::max);
                }
                "light.outer" => {
                    inspector_params::end_row(ui, edit, Part::Light, ["light.outer", "light.inner"], f64::min);
                }
                _ => inspector_params::row(ui, edit, Part::Light, name),
            }
        }
        if !falloff.is_empty() {
            let title = RichText::new("Falloff (advanced)").color(theme::WEAK);
            egui::CollapsingHeader::new(title).id_salt("falloff").show_unindented(ui, |ui| {
                for name in falloff {
                    inspector_params::row(ui, edit, Part::Light, name);
                }
            });
        }
    });
}

/// Whether a parameter of a light is rarely needed.
fn is_falloff(name: &str) -> bool {
    ["constant", "linear", "quadratic"].iter().any(|last| name.ends_with(last))
}

/// Angle of view and clipping.
pub fn camera(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Camera", |ui| {
        for param in CameraNode::default().params() {
            inspector_params::row(ui, edit, Part::Camera, param.name);
        }
    });
}
