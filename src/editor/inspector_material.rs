//! The material of the selection, or the one chosen in the list of materials: its ball, its choice and its parameters.

use egui::{Button, Color32, Rgba, RichText, Sense, TextEdit, Ui, vec2};
use egui_material_icons::icons::{ICON_ADD, ICON_CALL_SPLIT};

use super::edit_session::EditSession;
use super::material_edits::{self, NEW, material_of, next_color, set_material, use_text, users};
use super::material_library::MaterialLibrary;
use super::multi_edit::MultiEdit;
use super::thumbnails::ThumbnailKey;
use super::widgets::{self, MIXED};
use super::{inspector_params, preset_picker, theme};
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Material, MaterialId, NodeId, NodeKind, ParamPath, Params, ReflectionModel};

/// Side of the ball in the card, in points.
const BALL: f32 = 84.0;
/// Side of a ball in the drop-down list.
const SMALL_BALL: f32 = 24.0;

/// The materials of the edited nodes.
#[derive(Clone, Copy, PartialEq)]
enum CommonMaterial {
    /// All nodes have the same material; `None` for meshes that keep their own.
    Same(Option<MaterialId>),
    /// The materials differ.
    Mixed,
}

/// The card of the selection.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary) {
    widgets::card(ui, "Material", |ui| {
        let common = edit.common(material_of).map_or(CommonMaterial::Mixed, CommonMaterial::Same);
        let CommonMaterial::Same(same) = common else {
            picker(ui, edit, library, common);
            ui.label(RichText::new("Different materials: choose one to give it to all.").color(theme::WEAK));
            return;
        };
        match same.and_then(|id| edit.session().document.scene().material(id).cloned()) {
            Some(material) => {
                let nodes = edit.ids();
                beside_ball(ui, library, &material, |ui, library| {
                    picker(ui, edit, library, common);
                    sharing(ui, edit.session(), library, &material, &nodes);
                    preset_button(ui, edit.session(), library, &material);
                });
                editor(ui, edit.session(), &material);
            }
            None => {
                picker(ui, edit, library, common);
                ui.label(RichText::new("The file's own materials are used.").color(theme::WEAK));
            }
        }
    });
}

/// The card of a material chosen in the list.
pub fn show_alone(ui: &mut Ui, session: &mut EditSession, library: &mut MaterialLibrary, id: MaterialId) {
    let Some(material) = session.document.scene().material(id).cloned() else { return };
    widgets::card(ui, "Material", |ui| {
        beside_ball(ui, library, &material, |ui, library| {
            ui.label(RichText::new(widgets::elided(&material.name, MOST_LETTERS)).strong().color(theme::STRONG));
            ui.horizontal(|ui| {
                let uses = library.uses(id);
                ui.label(RichText::new(use_text(uses)).color(theme::WEAK));
                if uses > 0 && ui.button("Select").on_hover_text("Selects what uses this material").clicked() {
                    let users = users(session.document.scene(), id);
                    session.document.select(users);
                }
            });
            preset_button(ui, session, library, &material);
        });
        editor(ui, session, &material);
    });
}

/// The ball, and the content of `add` on its right.
fn beside_ball(
    ui: &mut Ui,
    library: &mut MaterialLibrary,
    material: &Material,
    add: impl FnOnce(&mut Ui, &mut MaterialLibrary),
) {
    ui.horizontal(|ui| {
        let (rect, response) = ui.allocate_exact_size(vec2(BALL, BALL), Sense::hover());
        library.thumbnails.paint(ui, rect, ThumbnailKey::OfScene(material.id), material);
        response.on_hover_text("The material in a neutral studio, without the scene's lights");
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 5.0;
            // Text typed for one material must not reach another.
            ui.push_id(material.id, |ui| add(ui, library));
        });
    });
}

fn picker(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary, common: CommonMaterial) {
    let materials = edit.session().document.scene().materials().to_vec();
    let of_mesh = matches!(edit.active().kind, NodeKind::Mesh(_));
    let current = materials.iter().find(|m| common == CommonMaterial::Same(Some(m.id)));
    let shown = match (common, current) {
        (_, Some(material)) => material.name.as_str(),
        (CommonMaterial::Mixed, None) => MIXED,
        (CommonMaterial::Same(_), None) => "From the file",
    };
    let mut chosen = None;
    let mut new = false;
    let widget = ui.horizontal(|ui| {
        let combo = egui::ComboBox::from_id_salt("material").selected_text(shown).width(ui.available_width() - 26.0);
        let combo = combo.height(widgets::list_room(ui.ctx()));
        let response = combo.truncate().show_ui(ui, |ui| {
            if of_mesh && ui.selectable_label(common == CommonMaterial::Same(None), "From the file").clicked() {
                chosen = Some(None);
            }
            for material in &materials {
                let is_current = common == CommonMaterial::Same(Some(material.id));
                if entry(ui, library, material, is_current).clicked() {
                    chosen = Some(Some(material.id));
                }
            }
        });
        ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("Material"));
        new = widgets::icon_button(ui, ICON_ADD, "A new material for the selection", theme::WEAK).clicked();
        response.response.on_hover_text("The material of the selection; others may share it").id
    });
    if let Some(id) = chosen {
        edit.change(widget.inner, |node| set_material(node, id));
    }
    if new {
        let nodes = edit.ids();
        let session = edit.session();
        session.finish();
        let color = next_color(session.document.scene());
        material_edits::insert_for(session, &nodes, Material::new(MaterialId(0), NEW, color));
    }
}

/// Maximum number of characters of a material's name in the list.
const MOST_LETTERS: usize = 32;

/// A list entry with a ball.
pub fn entry(ui: &mut Ui, library: &mut MaterialLibrary, material: &Material, selected: bool) -> egui::Response {
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(SMALL_BALL, SMALL_BALL), Sense::hover());
        if ui.is_rect_visible(rect) {
            library.thumbnails.paint(ui, rect, ThumbnailKey::OfScene(material.id), material);
        }
        let short = widgets::elided(&material.name, MOST_LETTERS);
        let label = ui.selectable_label(selected, &short);
        ui.ctx().accesskit_node_builder(label.id, |node| node.set_label(material.name.clone()));
        if short == material.name { label } else { label.on_hover_text(&material.name) }
    })
    .inner
}

/// How many nodes use the material, and a copy of it for the selection.
fn sharing(ui: &mut Ui, session: &mut EditSession, library: &MaterialLibrary, material: &Material, nodes: &[NodeId]) {
    let uses = library.uses(material.id);
    ui.horizontal(|ui| {
        let others = uses.saturating_sub(nodes.len());
        let color = if others > 0 { theme::WARNING } else { theme::WEAK };
        let text = ui.label(RichText::new(use_text(uses)).color(color));
        if others == 0 {
            text.on_hover_text("Nothing else uses this material");
            return;
        }
        text.on_hover_text("A change of this material shows on everything that uses it");
        let button = Button::new((ICON_CALL_SPLIT.rich_text().size(14.0), RichText::new("Make unique")));
        let button = ui.add(button);
        ui.ctx().accesskit_node_builder(button.id, |node| node.set_label("Make unique"));
        if button.on_hover_text("Gives the selection a copy of this material of its own").clicked() {
            session.finish();
            material_edits::make_unique(session, nodes);
        }
    });
}

fn preset_button(ui: &mut Ui, session: &mut EditSession, library: &mut MaterialLibrary, material: &Material) {
    let opener = ui.button("Preset…").on_hover_text("Replaces the values of this material by ready-made ones");
    if let Some(preset) = preset_picker::show(&opener, library) {
        session.finish();
        material_edits::apply_preset(session, material.id, &preset, library.preset_names());
    }
}

/// Converts a linear color for display.
pub fn display_color(linear: [f64; 3]) -> Color32 {
    let [r, g, b] = linear.map(|v| v.clamp(0.0, 1.0) as f32);
    Rgba::from_rgb(r, g, b).into()
}

/// The part of the card that a parameter stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    /// At the top, always open.
    First,
    Specular,
    Coat,
    Opacity,
    Textures,
    Advanced,
    /// The material's model does not use it.
    Unused,
}

/// The most common parameters, in the order of the card.
const FIRST: [&str; 7] = [
    "base_color",
    "base_metalness",
    "specular_roughness",
    "model.specular",
    "model.shininess",
    "emission_luminance",
    "emission_color",
];

/// What Blinn and Phong do without.
const OF_LAYERS: [&str; 4] = ["base_metalness", "base_diffuse", "specular_", "coat_"];

impl Section {
    fn of(path: &str, model: ReflectionModel) -> Self {
        let by_layers = matches!(model, ReflectionModel::OpenPbr {});
        match path {
            path if !by_layers && OF_LAYERS.iter().any(|start| path.starts_with(start)) => Self::Unused,
            path if FIRST.contains(&path) => Self::First,
            path if path.starts_with("specular_") => Self::Specular,
            path if path.starts_with("coat_") => Self::Coat,
            "geometry_opacity" | "opacity_threshold" => Self::Opacity,
            path if path.split('.').next() == Some("textures") => Self::Textures,
            _ => Self::Advanced,
        }
    }
}

fn editor(ui: &mut Ui, session: &mut EditSession, material: &Material) {
    ui.push_id(material.id, |ui| {
        let mut name = material.name.clone();
        let help = "The name of the material";
        let response = widgets::row(ui, "Name", help, |ui| {
            let field = TextEdit::singleline(&mut name).char_limit(MAX_NAME).desired_width(ui.available_width());
            ui.add(field).on_hover_text(help)
        });
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Material name"));
        if response.changed() {
            session.change_material(response.id, Material { name, ..material.clone() });
        }
        let mut paths = Vec::new();
        material.visit("", &mut |prefix, param, _| paths.push(format!("{prefix}{}", param.name)));
        let of = |section| paths.iter().filter(move |path| Section::of(path, material.model) == section);
        let mut rows = |ui: &mut Ui, paths: Vec<&String>| {
            for path in paths {
                inspector_params::single(ui, session, ParamPath::of_material(material.id, path.clone()));
            }
        };
        let mut first: Vec<_> = of(Section::First).collect();
        first.sort_by_key(|path| FIRST.iter().position(|name| name == path));
        rows(ui, first);
        let folded = [
            ("Specular", Section::Specular),
            ("Coat", Section::Coat),
            ("Opacity", Section::Opacity),
            ("Textures", Section::Textures),
            ("Advanced", Section::Advanced),
        ];
        for (title, section) in folded {
            let paths: Vec<_> = of(section).collect();
            if !paths.is_empty() {
                let header = egui::CollapsingHeader::new(RichText::new(title).color(theme::TEXT));
                header.show_unindented(ui, |ui| rows(ui, paths));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_shows_only_what_it_uses() {
        let phong = ReflectionModel::BlinnPhong { specular: 0.2, shininess: 10.0 };
        let layers = ReflectionModel::OpenPbr {};
        let sections = |model| {
            let mut found = Vec::new();
            let material = Material { model, ..Material::default() };
            material.visit("", &mut |prefix, param, _| {
                let path = format!("{prefix}{}", param.name);
                found.push((Section::of(&path, model), path));
            });
            move |section: Section| -> Vec<String> {
                found.iter().filter(|(of, _)| *of == section).map(|(_, path)| path.clone()).collect()
            }
        };
        let (by_phong, by_layers) = (sections(phong), sections(layers));
        assert!(by_layers(Section::Unused).is_empty());
        assert!(by_layers(Section::Coat).len() >= 4 && by_layers(Section::Specular).len() >= 3);
        assert!(by_phong(Section::Coat).is_empty() && by_phong(Section::Specular).is_empty());
        let first = by_phong(Section::First);
        assert!(
            ["base_color", "model.specular", "model.shininess", "emission_color"]
                .iter()
                .all(|name| first.iter().any(|path| path == name)),
            "{first:?}"
        );
        assert!(by_phong(Section::Advanced).contains(&"model.type".to_owned()), "the way back");
        assert!(by_layers(Section::Advanced).contains(&"model.type".to_owned()));
    }
}
