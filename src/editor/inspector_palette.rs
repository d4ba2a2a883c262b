//! The palette of an instancer: the materials of which each copy takes one.

use egui::{Align, Layout, RichText, Sense, Ui, vec2};
use egui_material_icons::icons::{ICON_ADD, ICON_DELETE};

use super::instancing::{instancer, instancer_mut};
use super::material_library::MaterialLibrary;
use super::multi_edit::MultiEdit;
use super::thumbnails::ThumbnailKey;
use super::{inspector_material, theme, widgets};
use isolith_scene::{MAX_PALETTE, MaterialId, Node};

/// Side of a swatch, in points.
const SWATCH: f32 = 24.0;

fn palette(node: &Node) -> Vec<MaterialId> {
    instancer(node).map(|instancer| instancer.palette.clone()).unwrap_or_default()
}

/// The swatches, and a button to add materials.
pub fn show(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary) {
    match edit.common(palette) {
        Some(palette) => {
            if palette.is_empty() {
                ui.label(RichText::new("No palette: copies keep the materials of their types").color(theme::WEAK));
            }
            for (index, id) in palette.into_iter().enumerate() {
                ui.push_id(index, |ui| entry(ui, edit, library, index, id));
            }
        }
        None => {
            ui.label(RichText::new("Different palettes: choose one instancer to edit its own").color(theme::WEAK));
        }
    }
    add(ui, edit, library);
}

fn entry(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary, index: usize, id: MaterialId) {
    let Some(material) = edit.session().document.scene().material(id).cloned() else { return };
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(SWATCH, SWATCH), Sense::hover());
        if ui.is_rect_visible(rect) {
            library.thumbnails.paint(ui, rect, ThumbnailKey::OfScene(id), &material);
        }
        ui.label(widgets::elided(&material.name, 28)).on_hover_text(&material.name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let name = format!("Remove {} from the palette", material.name);
            let remove = widgets::icon_button(ui, ICON_DELETE, &name, theme::WEAK);
            if remove.clicked() {
                edit.change(remove.id, |node| {
                    if let Some(instancer) = instancer_mut(node).filter(|instancer| index < instancer.palette.len()) {
                        instancer.palette.remove(index);
                    }
                });
            }
        });
    });
}

fn add(ui: &mut Ui, edit: &mut MultiEdit<'_>, library: &mut MaterialLibrary) {
    if palette(edit.active()).len() >= MAX_PALETTE {
        let text = format!("{MAX_PALETTE} materials are the most that a palette can have");
        ui.label(RichText::new(text).color(theme::WEAK));
        return;
    }
    let button = ui.menu_button(format!("{} Add to palette", ICON_ADD.codepoint), |ui| {
        widgets::scrolling(ui, widgets::list_room(&ui.ctx().clone()), |ui| {
            let materials = edit.session().document.scene().materials().to_vec();
            for material in &materials {
                let entry = inspector_material::entry(ui, library, material, false);
                if entry.clicked() {
                    let id = material.id;
                    edit.change(entry.id, |node| {
                        if let Some(instancer) = instancer_mut(node) {
                            instancer.palette.push(id);
                        }
                    });
                    ui.close();
                }
            }
        });
    });
    button.response.on_hover_text("Another material that copies may have");
}
