//! The material that the selection wears: which one, and what it looks like.

use egui::{Color32, Rgba, RichText, TextEdit, Ui, vec2};
use egui_material_icons::icons::{ICON_ADD, ICON_CONTENT_COPY};

use super::fields::{self, MIXED};
use super::numbers::{self, Field};
use super::sheet::Sheet;
use super::theme;
use crate::document::Edit;
use crate::scene::limits::{INTENSITY, MAX_NAME, SHININESS, UNIT};
use crate::scene::{Limits, Material, MaterialId, Node, NodeKind};

/// What the nodes of a sheet wear.
#[derive(Clone, Copy, PartialEq)]
enum Worn {
    /// All the same; `None` for meshes that keep their own.
    Same(Option<MaterialId>),
    /// Not all the same.
    Mixed,
}

/// The card.
pub fn show(ui: &mut Ui, sheet: &mut Sheet<'_>) {
    fields::card(ui, "Material", |ui| {
        let worn = sheet.common(material_of).map_or(Worn::Mixed, Worn::Same);
        picker(ui, sheet, worn);
        let Worn::Same(worn) = worn else {
            ui.label(RichText::new("Different materials: choose one to give it to all.").color(theme::WEAK));
            return;
        };
        let material = worn.and_then(|id| sheet.bench().document.scene().material(id).cloned());
        match material {
            Some(material) => {
                // What is typed for one material is not for another one.
                ui.push_id(material.id, |ui| editor(ui, sheet, &material));
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

fn wear(node: &mut Node, id: Option<MaterialId>) {
    match &mut node.kind {
        NodeKind::Object(object) => object.material = id.unwrap_or(object.material),
        NodeKind::Mesh(mesh) => mesh.material = id,
        _ => {}
    }
}

fn picker(ui: &mut Ui, sheet: &mut Sheet<'_>, worn: Worn) {
    let materials = sheet.bench().document.scene().materials().to_vec();
    let of_mesh = matches!(sheet.active().kind, NodeKind::Mesh(_));
    let current = materials.iter().find(|m| worn == Worn::Same(Some(m.id)));
    let mut chosen = None;
    let mut new = false;
    let widget = fields::row(ui, "Wears", "Materials are shared: a change shows on everything that wears it", |ui| {
        let shown = match (worn, current) {
            (_, Some(material)) => material.name.as_str(),
            (Worn::Mixed, None) => MIXED,
            (Worn::Same(_), None) => "From the file",
        };
        let combo = egui::ComboBox::from_id_salt("material").selected_text(shown).width(ui.available_width() - 28.0);
        let combo = combo.height(fields::list_room(ui.ctx()));
        let response = combo.truncate().show_ui(ui, |ui| {
            if of_mesh && ui.selectable_label(worn == Worn::Same(None), "From the file").clicked() {
                chosen = Some(None);
            }
            for material in &materials {
                if swatch_label(ui, material, worn == Worn::Same(Some(material.id))).clicked() {
                    chosen = Some(Some(material.id));
                }
            }
        });
        ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("Material"));
        let (icon, text) = match current {
            Some(_) => (ICON_CONTENT_COPY, "A copy of this material, for the selection alone"),
            None => (ICON_ADD, "A new material"),
        };
        new = fields::icon_button(ui, icon, text, theme::WEAK).clicked();
        response.response.id
    });
    if let Some(id) = chosen {
        sheet.change(widget, |node| wear(node, id));
    }
    if new {
        let id = sheet.bench().document.scene().next_material_id();
        let material = match current {
            Some(m) => Material { id, name: format!("{} copy", m.name), ..Material::clone(m) },
            None => Material::new(id, "New material", [0.6; 3]),
        };
        sheet.bench().apply_by(widget, Edit::InsertMaterial(material));
        sheet.change(widget, |node| wear(node, Some(id)));
    }
}

/// Most letters of a material's name in the list.
const MOST_LETTERS: usize = 32;

/// An entry of the list with the material's colour in front.
fn swatch_label(ui: &mut Ui, material: &Material, selected: bool) -> egui::Response {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), egui::Sense::hover());
        ui.painter().rect_filled(rect, 3.0, display_color(material.albedo));
        let short = fields::elided(&material.name, MOST_LETTERS);
        let label = ui.selectable_label(selected, &short);
        ui.ctx().accesskit_node_builder(label.id, |node| node.set_label(material.name.clone()));
        if short == material.name { label } else { label.on_hover_text(&material.name) }
    })
    .inner
}

/// A linear colour as the screen shows it.
pub fn display_color(linear: [f64; 3]) -> Color32 {
    let [r, g, b] = linear.map(|v| v.clamp(0.0, 1.0) as f32);
    Rgba::from_rgb(r, g, b).into()
}

fn editor(ui: &mut Ui, sheet: &mut Sheet<'_>, material: &Material) {
    let mut name = material.name.clone();
    let response = fields::row(ui, "Name", "", |ui| {
        ui.add(TextEdit::singleline(&mut name).char_limit(MAX_NAME).desired_width(ui.available_width()))
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Material name"));
    if response.changed() {
        sheet.bench().change_material(response.id, Material { name, ..material.clone() });
    }
    color(ui, sheet, ("Colour", "Diffuse reflectance"), material, |m| &mut m.albedo);
    number(ui, sheet, ("Highlight", "Strength of the highlight; 0 is matt"), (UNIT, 0.25), material, |m| {
        &mut m.specular
    });
    roughness(ui, sheet, material);
    color(ui, sheet, ("Glow", "Light that it emits"), material, |m| &mut m.emission);
    let strength = material.emission.iter().copied().fold(0.0, f64::max);
    if strength > 0.0 {
        glow_strength(ui, sheet, material, strength);
    }
}

type Part<T> = fn(&mut Material) -> &mut T;

fn color(ui: &mut Ui, sheet: &mut Sheet<'_>, text: (&str, &str), material: &Material, part: Part<[f64; 3]>) {
    let mut edited = material.clone();
    let value = *part(&mut edited);
    let (widget, changed) = fields::row(ui, text.0, text.1, |ui| fields::color(ui, text.0, value, false));
    if let Some(value) = changed {
        *part(&mut edited) = value;
        sheet.bench().change_material(widget, edited);
    }
}

fn number(
    ui: &mut Ui,
    sheet: &mut Sheet<'_>,
    (label, help): (&str, &str),
    (limits, default): (Limits, f64),
    material: &Material,
    part: Part<f64>,
) {
    let mut edited = material.clone();
    let value = *part(&mut edited);
    let field = Field { label, help, limits, default: Some(default), taken_as: None };
    let answer = fields::row(ui, label, help, |ui| {
        let width = ui.available_width();
        numbers::number(ui, &field, label, value, false, width)
    });
    if let Some(value) = answer.value {
        *part(&mut edited) = value;
        sheet.bench().change_material(answer.widget, edited);
    }
}

/// The roughness, 0 to 1, whose GGX lobe is as wide as the Blinn-Phong lobe of this exponent: exponent = 2 / r⁴ − 2
/// (Walter et al., "Microfacet models for refraction", 2007, with alpha = r²).
fn roughness_of(shininess: f64) -> f64 {
    (2.0 / (shininess + 2.0)).sqrt().sqrt()
}

/// The exponent of a roughness, within its limits.
fn shininess_of(roughness: f64) -> f64 {
    (2.0 / roughness.powi(4) - 2.0).clamp(SHININESS.hard[0], SHININESS.hard[1])
}

fn roughness(ui: &mut Ui, sheet: &mut Sheet<'_>, material: &Material) {
    let (label, help) = ("Roughness", "Small is a small, sharp highlight");
    let range = [roughness_of(SHININESS.hard[1]), roughness_of(SHININESS.hard[0])];
    let limits = Limits { soft: range, hard: range, unit: "" };
    let field = Field { label, help, limits, default: Some(roughness_of(48.0)), taken_as: None };
    let answer = fields::row(ui, label, help, |ui| {
        let width = ui.available_width();
        numbers::number(ui, &field, label, roughness_of(material.shininess), false, width)
    });
    if let Some(roughness) = answer.value {
        let shininess = shininess_of(roughness);
        sheet.bench().change_material(answer.widget, Material { shininess, ..material.clone() });
    }
}

/// Emission beyond 1 cannot be picked as a colour: its brightest channel is a number of its own.
fn glow_strength(ui: &mut Ui, sheet: &mut Sheet<'_>, material: &Material, strength: f64) {
    let (label, help) = ("Glow strength", "Its brightest channel");
    let field = Field { label, help, limits: INTENSITY, default: None, taken_as: None };
    let answer = fields::row(ui, field.label, field.help, |ui| {
        let width = ui.available_width();
        numbers::number(ui, &field, field.label, strength, false, width)
    });
    if let Some(new) = answer.value {
        let emission = material.emission.map(|v| v * new / strength);
        sheet.bench().change_material(answer.widget, Material { emission, ..material.clone() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roughness_is_the_other_way_to_write_the_exponent() {
        for shininess in [1.0, 16.0, 48.0, 256.0, 1e4] {
            let roughness = roughness_of(shininess);
            assert!((0.0..1.0).contains(&roughness), "{roughness}");
            assert!((shininess_of(roughness) / shininess - 1.0).abs() < 1e-9, "{shininess}");
        }
        assert!(roughness_of(256.0) < roughness_of(16.0));
        assert_eq!(shininess_of(0.0), SHININESS.hard[1]);
        assert_eq!(shininess_of(1.0), SHININESS.hard[0]);
    }
}
