//! The material of the selection: its choice and its parameters.

use egui::{Color32, Rgba, RichText, TextEdit, Ui, vec2};
use egui_material_icons::icons::{ICON_ADD, ICON_CONTENT_COPY};

use super::multi_edit::MultiEdit;
use super::widgets::{self, MIXED};
use super::{inspector_params, theme};
use isolith_document::Edit;
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Material, MaterialId, Node, NodeKind, ParamPath, Params};

/// The materials of the edited nodes.
#[derive(Clone, Copy, PartialEq)]
enum CommonMaterial {
    /// All nodes have the same material; `None` for meshes that keep their own.
    Same(Option<MaterialId>),
    /// The materials differ.
    Mixed,
}

/// The card.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Material", |ui| {
        let common = edit.common(material_of).map_or(CommonMaterial::Mixed, CommonMaterial::Same);
        picker(ui, edit, common);
        let CommonMaterial::Same(common) = common else {
            ui.label(RichText::new("Different materials: choose one to give it to all.").color(theme::WEAK));
            return;
        };
        let material = common.and_then(|id| edit.session().document.scene().material(id).cloned());
        match material {
            Some(material) => {
                // Text typed for one material must not reach another.
                ui.push_id(material.id, |ui| editor(ui, edit, &material));
            }
            None => {
                ui.label(RichText::new("The file's own materials are used.").color(theme::WEAK));
            }
        }
    });
}

fn material_of(node: &Node) -> Option<MaterialId> {
    match &node.kind {
        NodeKind::Object(object) => Some(object.material),
        NodeKind::Mesh(mesh) => mesh.material,
        _ => None,
    }
}

fn set_material(node: &mut Node, id: Option<MaterialId>) {
    match &mut node.kind {
        NodeKind::Object(object) => object.material = id.unwrap_or(object.material),
        NodeKind::Mesh(mesh) => mesh.material = id,
        _ => {}
    }
}

fn picker(ui: &mut Ui, edit: &mut MultiEdit<'_>, common: CommonMaterial) {
    let materials = edit.session().document.scene().materials().to_vec();
    let of_mesh = matches!(edit.active().kind, NodeKind::Mesh(_));
    let current = materials.iter().find(|m| common == CommonMaterial::Same(Some(m.id)));
    let mut chosen = None;
    let mut new = false;
    let widget =
        widgets::row(ui, "Material", "Materials are shared: a change shows on everything that uses it", |ui| {
            let shown = match (common, current) {
                (_, Some(material)) => material.name.as_str(),
                (CommonMaterial::Mixed, None) => MIXED,
                (CommonMaterial::Same(_), None) => "From the file",
            };
            let combo =
                egui::ComboBox::from_id_salt("material").selected_text(shown).width(ui.available_width() - 28.0);
            let combo = combo.height(widgets::list_room(ui.ctx()));
            let response = combo.truncate().show_ui(ui, |ui| {
                if of_mesh && ui.selectable_label(common == CommonMaterial::Same(None), "From the file").clicked() {
                    chosen = Some(None);
                }
                for material in &materials {
                    if swatch_label(ui, material, common == CommonMaterial::Same(Some(material.id))).clicked() {
                        chosen = Some(Some(material.id));
                    }
                }
            });
            ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("Material"));
            let (icon, text) = match current {
                Some(_) => (ICON_CONTENT_COPY, "A copy of this material, for the selection alone"),
                None => (ICON_ADD, "A new material"),
            };
            new = widgets::icon_button(ui, icon, text, theme::WEAK).clicked();
            response.response.id
        });
    if let Some(id) = chosen {
        edit.change(widget, |node| set_material(node, id));
    }
    if new {
        let id = edit.session().document.scene().next_material_id();
        let material = match current {
            Some(m) => Material { id, name: format!("{} copy", m.name), ..Material::clone(m) },
            None => Material::new(id, "New material", [0.6; 3]),
        };
        edit.session().apply_by(widget, Edit::InsertMaterial(material));
        edit.change(widget, |node| set_material(node, Some(id)));
    }
}

/// Maximum number of characters of a material's name in the list.
const MOST_LETTERS: usize = 32;

/// A list entry with a color swatch.
fn swatch_label(ui: &mut Ui, material: &Material, selected: bool) -> egui::Response {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), egui::Sense::hover());
        ui.painter().rect_filled(rect, 3.0, display_color(material.base_color));
        let short = widgets::elided(&material.name, MOST_LETTERS);
        let label = ui.selectable_label(selected, &short);
        ui.ctx().accesskit_node_builder(label.id, |node| node.set_label(material.name.clone()));
        if short == material.name { label } else { label.on_hover_text(&material.name) }
    })
    .inner
}

/// Converts a linear color for display.
pub fn display_color(linear: [f64; 3]) -> Color32 {
    let [r, g, b] = linear.map(|v| v.clamp(0.0, 1.0) as f32);
    Rgba::from_rgb(r, g, b).into()
}

fn editor(ui: &mut Ui, edit: &mut MultiEdit<'_>, material: &Material) {
    let mut name = material.name.clone();
    let response = widgets::row(ui, "Name", "", |ui| {
        ui.add(TextEdit::singleline(&mut name).char_limit(MAX_NAME).desired_width(ui.available_width()))
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Material name"));
    if response.changed() {
        edit.session().change_material(response.id, Material { name, ..material.clone() });
    }
    let mut paths = Vec::new();
    material.visit("", &mut |prefix, param, _| paths.push(format!("{prefix}{}", param.name)));
    for path in paths {
        inspector_params::single(ui, edit.session(), ParamPath::of_material(material.id, path));
    }
}
