//! The description of a command: label, icon, menu, keys and condition.

use egui::{Context, Key, KeyboardShortcut, Modifiers};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_CHECK_BOX, ICON_CHECK_BOX_OUTLINE_BLANK, ICON_RADIO_BUTTON_CHECKED, ICON_RADIO_BUTTON_UNCHECKED,
};

use super::command::Command;
use crate::keymap::{KeyBindings, Keymap, shown};
use crate::state::EditorState;
use crate::{icons, theme};
use isolith_scene::ShapeKind;

/// The menu of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Open, save, close.
    File,
    /// Changes of the selection.
    Edit,
    /// Ways to select; a submenu of Edit.
    Select,
    /// Operators, and operations of nodes; a submenu of Edit.
    Combine,
    /// Ready-made settings of instancers; a submenu of Edit.
    Presets,
    /// Parts of a copied node; a submenu of Edit.
    PastePart,
    /// Aligning, distributing, origins and order; a submenu of Edit.
    Arrange,
    /// Instancers, fields and meshes made of the selection; a submenu of Edit.
    Convert,
    /// Linked objects, shared and unused materials; a submenu of Edit.
    Sharing,
    /// New nodes.
    Add,
    /// The camera and the picture.
    View,
    /// Shadings; a submenu of View.
    Shading,
    /// Views along an axis; a submenu of View.
    Sides,
    /// Views for debugging; a submenu of View.
    Debug,
    /// Samples per pixel; a submenu of View.
    Samples,
    /// Views to come back to; a submenu of View.
    Bookmarks,
    /// Viewports beside each other; a submenu of View.
    Split,
    /// Transforms, and tools of the viewport; a submenu of View.
    Tool,
    /// Axes of the tools; a submenu of View.
    Orientation,
    /// Pivots of the tools; a submenu of View.
    Pivot,
    /// How drags snap; a submenu of View.
    Snap,
    /// Keymaps; a submenu of View.
    Keymap,
    /// What explains the program.
    Help,
}

/// An icon of a command.
#[derive(Clone, Copy, Debug)]
pub enum Icon {
    /// A glyph of the icon font.
    Material(MaterialIcon),
    /// The silhouette of a shape.
    Shape(ShapeKind),
}

impl From<MaterialIcon> for Icon {
    fn from(icon: MaterialIcon) -> Self {
        Self::Material(icon)
    }
}

/// Whether a command is enabled.
pub type Condition = fn(&EditorState) -> bool;

/// Whether the switch of a command is on.
pub type SwitchState = fn(&EditorState, Command) -> bool;

/// A row of the table.
pub struct CommandInfo {
    /// The command.
    pub command: Command,
    /// Its name, everywhere.
    pub label: String,
    /// Its menu.
    pub menu: Menu,
    /// Whether a separator precedes it in its menu.
    pub starts_group: bool,
    /// Its icon.
    pub icon: Option<Icon>,
    /// One sentence about its effect.
    pub help: String,
    /// Its shortcuts.
    keys: Vec<KeyboardShortcut>,
    /// The only keymap that has them; `None` for all.
    keymap: Option<Keymap>,
    /// Whether it is enabled.
    pub is_enabled: Condition,
    /// Whether its switch is on; `None` for a command that is not a switch.
    pub is_on: Option<SwitchState>,
}

impl CommandInfo {
    pub(super) fn new(
        menu: Menu,
        command: Command,
        icon: impl Into<Option<Icon>>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            command,
            label: label.into(),
            menu,
            starts_group: false,
            icon: icon.into(),
            help: help.into(),
            keys: Vec::new(),
            keymap: None,
            is_enabled: |_| true,
            is_on: None,
        }
    }

    pub(super) fn key(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.keys.push(KeyboardShortcut::new(modifiers, key));
        self
    }

    /// The same in another menu.
    pub(super) fn within(self, menu: Menu) -> Self {
        Self { menu, ..self }
    }

    /// The same with its shortcuts in one keymap only.
    pub(super) fn only_in(mut self, keymap: Keymap) -> Self {
        self.keymap = Some(keymap);
        self
    }

    /// Its shortcuts in a keymap that nobody has changed.
    pub fn keys(&self, keymap: Keymap) -> &[KeyboardShortcut] {
        if self.keymap.is_none_or(|only| only == keymap) { &self.keys } else { &[] }
    }

    /// Its shortcuts as the user has them.
    pub fn keys_in<'a>(&'a self, bindings: &'a KeyBindings) -> &'a [KeyboardShortcut] {
        bindings.keys(&self.label, self.keys(bindings.keymap()))
    }

    pub(super) fn when(mut self, is_enabled: Condition) -> Self {
        self.is_enabled = is_enabled;
        self
    }

    pub(super) fn switch(mut self, is_on: SwitchState) -> Self {
        self.is_on = Some(is_on);
        self
    }

    pub(super) fn group(mut self) -> Self {
        self.starts_group = true;
        self
    }

    /// Name, shortcuts and help.
    pub fn tooltip(&self, ctx: &Context) -> String {
        let keys: Vec<_> = self.keys_in(&KeyBindings::of(ctx)).iter().map(|k| shown(ctx, k)).collect();
        let keys = if keys.is_empty() { String::new() } else { format!("  ({})", keys.join(", ")) };
        format!("{}{keys}\n{}", self.label, self.help)
    }

    /// A check box, or a radio button for one of several choices.
    fn mark(&self, on: bool) -> MaterialIcon {
        use Menu::{Debug, Keymap, Orientation, Pivot, Samples, Shading, Snap, Tool};
        match (self.menu, on) {
            (Snap, _) if self.command == Command::ToggleSnap => {
                if on {
                    ICON_CHECK_BOX
                } else {
                    ICON_CHECK_BOX_OUTLINE_BLANK
                }
            }
            (Shading | Debug | Samples | Snap | Tool | Orientation | Pivot | Keymap, true) => ICON_RADIO_BUTTON_CHECKED,
            (Shading | Debug | Samples | Snap | Tool | Orientation | Pivot | Keymap, false) => {
                ICON_RADIO_BUTTON_UNCHECKED
            }
            (_, true) => ICON_CHECK_BOX,
            (_, false) => ICON_CHECK_BOX_OUTLINE_BLANK,
        }
    }

    /// Paints the icon at the left end of a menu entry, or the state of a switch.
    pub fn paint_icon(&self, ui: &egui::Ui, entry: egui::Rect, enabled: bool, on: Option<bool>) {
        let icon = on.map(|on| Icon::Material(self.mark(on))).or(self.icon);
        let square = egui::Rect::from_center_size(
            entry.left_center() + egui::vec2(ui.spacing().button_padding.x + 10.0, 0.0),
            egui::Vec2::splat(16.0),
        );
        let square = icons::centered(square, 16.0);
        let dim = if enabled { 1.0 } else { 0.45 };
        match icon {
            Some(Icon::Material(icon)) => {
                icons::paint_icon(ui.painter(), square, icon, theme::WEAK.gamma_multiply(dim));
            }
            Some(Icon::Shape(kind)) => {
                icons::paint_shape(ui.painter(), square, kind, theme::OBJECT.gamma_multiply(dim));
            }
            None => {}
        }
    }
}
