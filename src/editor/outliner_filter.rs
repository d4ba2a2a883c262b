//! The filter of the outliner by kind, and the quick choice of a group's operator in its row.

use egui::{Button, Color32, Id, Popup, RichText, Sense, Ui, vec2};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::ICON_FILTER_LIST;

use super::{icons, theme};
use isolith_scene::{Node, NodeKind, Operation, Operator};

/// What the outliner lists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KindFilter {
    /// Everything.
    #[default]
    All,
    /// Objects.
    Objects,
    /// Groups.
    Groups,
    /// Instancers.
    Instancers,
    /// Meshes.
    Meshes,
    /// Lights.
    Lights,
    /// Cameras.
    Cameras,
    /// What is subtracted.
    Subtracted,
    /// What is hidden.
    Hidden,
    /// What is locked.
    Locked,
}

impl KindFilter {
    const ALL: [Self; 10] = [
        Self::All,
        Self::Objects,
        Self::Groups,
        Self::Instancers,
        Self::Meshes,
        Self::Lights,
        Self::Cameras,
        Self::Subtracted,
        Self::Hidden,
        Self::Locked,
    ];

    fn label(self) -> &'static str {
        match self {
            Self::All => "Everything",
            Self::Objects => "Objects",
            Self::Groups => "Groups",
            Self::Instancers => "Instancers",
            Self::Meshes => "Meshes",
            Self::Lights => "Lights",
            Self::Cameras => "Cameras",
            Self::Subtracted => "Subtracted",
            Self::Hidden => "Hidden",
            Self::Locked => "Locked",
        }
    }

    /// Whether it lists the node.
    pub fn takes(self, node: &Node) -> bool {
        match self {
            Self::All => true,
            Self::Objects => matches!(node.kind, NodeKind::Object(_)),
            Self::Groups => matches!(node.kind, NodeKind::Group(_)),
            Self::Instancers => matches!(node.kind, NodeKind::Instancer(_)),
            Self::Meshes => matches!(node.kind, NodeKind::Mesh(_)),
            Self::Lights => matches!(node.kind, NodeKind::Light(_)),
            Self::Cameras => matches!(node.kind, NodeKind::Camera(_)),
            Self::Subtracted => node.operation == Operation::Subtract,
            Self::Hidden => !node.visible,
            Self::Locked => node.locked,
        }
    }
}

/// The button that opens the choice; its color tells that something is left out.
pub fn button(ui: &mut Ui, kind: &mut KindFilter) {
    let color = if *kind == KindFilter::All { theme::WEAK } else { theme::ACCENT };
    let text = ICON_FILTER_LIST.rich_text().size(16.0).color(color);
    let opener = ui.add(Button::new(text).frame(false).min_size(egui::vec2(22.0, 22.0)));
    ui.ctx().accesskit_node_builder(opener.id, |node| node.set_label("Filter by kind"));
    let opener = opener.on_hover_text(format!("Filter by kind: {}", kind.label().to_lowercase()));
    Popup::menu(&opener).show(|ui| {
        ui.set_min_width(140.0);
        for choice in KindFilter::ALL {
            if ui.add(Button::selectable(choice == *kind, choice.label())).clicked() {
                *kind = choice;
                ui.close();
            }
        }
    });
}

/// The icon of a group's row as a button that lists the operators; returns the chosen one.
pub fn operators(ui: &mut Ui, node: &Node, current: Operator) -> Option<(Id, Operator)> {
    let id = ui.scope_id().with(("operator", node.id));
    let opener = ui.interact(ui.max_rect(), id, Sense::click());
    let name = format!("Operation of {}", node.name);
    ui.ctx().accesskit_node_builder(opener.id, |entry| {
        entry.set_role(egui::accesskit::Role::Button);
        entry.set_label(name);
    });
    let opener = opener.on_hover_text(format!("{}: click for another operation", current.label()));
    if opener.hovered() {
        ui.painter().rect_stroke(ui.max_rect(), 3.0, (1.0, theme::RESTING), egui::StrokeKind::Inside);
    }
    let mut chosen = None;
    Popup::menu(&opener).show(|ui| {
        ui.set_min_width(150.0);
        for operator in &Operator::ALL {
            let text = (icons::operator_icon(*operator).rich_text(), RichText::new(operator.label()));
            let entry = ui.add(Button::selectable(*operator == current, text)).on_hover_text(operator.help());
            if entry.clicked() && *operator != current {
                chosen = Some(*operator);
                ui.close();
            }
        }
    });
    chosen.map(|operator| (opener.id, operator))
}

/// A small switch at the end of a row.
pub fn switch(ui: &mut Ui, icon: MaterialIcon, name: &str, color: impl Into<Color32>) -> egui::Response {
    let text = icon.rich_text().size(14.0).color(color);
    let response = ui.add(egui::Button::new(text).frame(false).min_size(vec2(20.0, 20.0)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    response.on_hover_text(name)
}
