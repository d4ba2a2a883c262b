//! Everything that the artist can order, in one table: it feeds the menus, the toolbar, the shortcuts
//! and the command palette.

mod add;
mod edit;
mod file;
mod view;

use std::sync::LazyLock;

use egui::{Button, Context, Key, KeyboardShortcut, Modifiers, Popup, Response, RichText, Ui};
use egui_material_icons::MaterialIcon;
use egui_material_icons::icons::{
    ICON_CHECK_BOX, ICON_CHECK_BOX_OUTLINE_BLANK, ICON_RADIO_BUTTON_CHECKED, ICON_RADIO_BUTTON_UNCHECKED,
};

use super::command_palette::CommandPalette;
use super::{Editor, icons, theme};
use crate::scene::ShapeKind;

/// Where a command stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Documents.
    File,
    /// What changes the selection.
    Edit,
    /// New nodes.
    Add,
    /// The camera and what is shown.
    View,
    /// What the picture shows; a part of the menu View.
    ViewMode,
    /// What the picture shows to whoever looks for a fault; a part of the menu of [`Menu::ViewMode`].
    Debug,
}

/// A picture of a command.
#[derive(Clone, Copy, Debug)]
pub enum Icon {
    /// A sign of the icon font.
    Material(MaterialIcon),
    /// The silhouette of a shape.
    Shape(ShapeKind),
}

impl From<MaterialIcon> for Icon {
    fn from(icon: MaterialIcon) -> Self {
        Self::Material(icon)
    }
}

type Run = Box<dyn Fn(&mut Editor, &Context) + Send + Sync>;
type IsOn = Box<dyn Fn(&Editor) -> bool + Send + Sync>;

/// Something that the artist can order.
pub struct Command {
    /// What it is called, everywhere.
    pub name: String,
    /// Its menu.
    pub menu: Menu,
    /// Whether a line stands before it in its menu.
    pub starts_group: bool,
    /// Its picture.
    pub icon: Option<Icon>,
    /// One sentence about what it does.
    pub help: String,
    /// Its keys; the first is shown.
    pub keys: Vec<KeyboardShortcut>,
    enabled: fn(&Editor) -> bool,
    /// Whether what it switches is on; none where it switches nothing.
    on: Option<IsOn>,
    run: Run,
}

/// A command's place in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandId(usize);

static TABLE: LazyLock<Vec<Command>> = LazyLock::new(|| {
    let menus = [file::commands(), edit::commands(), add::commands(), view::commands()];
    menus.into_iter().flatten().collect()
});

impl Command {
    fn new(
        menu: Menu,
        icon: impl Into<Option<Icon>>,
        name: impl Into<String>,
        help: impl Into<String>,
        run: impl Fn(&mut Editor, &Context) + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            menu,
            starts_group: false,
            icon: icon.into(),
            help: help.into(),
            keys: Vec::new(),
            enabled: |_| true,
            on: None,
            run: Box::new(run),
        }
    }

    fn key(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.keys.push(KeyboardShortcut::new(modifiers, key));
        self
    }

    fn when(mut self, enabled: fn(&Editor) -> bool) -> Self {
        self.enabled = enabled;
        self
    }

    fn switch(mut self, on: impl Fn(&Editor) -> bool + Send + Sync + 'static) -> Self {
        self.on = Some(Box::new(on));
        self
    }

    fn group(mut self) -> Self {
        self.starts_group = true;
        self
    }

    /// Name, what it does and its keys.
    pub fn tooltip(&self, ctx: &Context) -> String {
        let keys: Vec<_> = self.keys.iter().map(|k| ctx.format_shortcut(k)).collect();
        let keys = if keys.is_empty() { String::new() } else { format!("  ({})", keys.join(", ")) };
        format!("{}{keys}\n{}", self.name, self.help)
    }
}

impl CommandId {
    /// All commands, in the order of the menus.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..TABLE.len()).map(Self)
    }

    /// The command of this name. The table is fixed: a wrong name is a mistake in the program.
    pub fn named(name: &str) -> Self {
        Self(TABLE.iter().position(|c| c.name == name).expect("a command of this name stands in the table"))
    }

    /// The command.
    pub fn get(self) -> &'static Command {
        &TABLE[self.0]
    }

    /// Whether it can be run now.
    pub fn enabled(self, editor: &Editor) -> bool {
        (self.get().enabled)(editor)
    }

    /// Whether what it switches is on; none where it switches nothing.
    fn is_on(self, editor: &Editor) -> Option<bool> {
        self.get().on.as_ref().map(|on| on(editor))
    }

    /// Runs it, where it can be run.
    pub fn run(self, editor: &mut Editor, ctx: &Context) {
        if self.enabled(editor) {
            editor.session.finish();
            (self.get().run)(editor, ctx);
        }
    }
}

/// Runs the commands whose keys were pressed. Not while text is being typed, something is being
/// dragged, or a menu is open: there the keys mean other things. Only documents are saved, opened and closed at any time:
/// after what is being typed has been taken, so at the end of the frame.
pub fn run_shortcuts(editor: &mut Editor, ctx: &Context) {
    if editor.dialogs.is_open() {
        return;
    }
    let is_of_document = |command: &Command| command.menu == Menu::File;
    if let Some(command) = ctx.input_mut(|i| take_shortcut(i, is_of_document)) {
        ctx.memory_mut(|memory| memory.stop_text_input());
        Popup::close_all(ctx);
        editor.command_palette = CommandPalette::default();
        editor.pending = Some(command);
        return;
    }
    let dragging = ctx.input(|i| i.pointer.any_down());
    // Not what `Context::any_popup_open` says: that knows only of popups shown in this pass already.
    if editor.has_dialog() || editor.typing || ctx.text_edit_focused() || dragging || Popup::is_any_open(ctx) {
        return;
    }
    let log = &mut editor.session.messages.show_log;
    if *log && ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
        *log = false;
    }
    while let Some(command) = ctx.input_mut(|i| take_shortcut(i, |_| true)) {
        command.run(editor, ctx);
    }
}

/// Takes the first key press out of the input that belongs to one of these commands.
fn take_shortcut(input: &mut egui::InputState, is_wanted: impl Fn(&Command) -> bool) -> Option<CommandId> {
    let mut found = None;
    input.events.retain(|event| {
        let egui::Event::Key { key, pressed: true, repeat: false, modifiers, .. } = event else { return true };
        if found.is_some() {
            return true;
        }
        // Exactly these modifiers: Ctrl Z is not Shift Ctrl Z.
        let fits = |k: &KeyboardShortcut| k.logical_key == *key && modifiers.matches_exact(k.modifiers);
        found = CommandId::all().find(|c| is_wanted(c.get()) && c.get().keys.iter().any(fits));
        found.is_none()
    });
    found
}

/// The entries of one menu; returns the command chosen.
pub fn menu_entries(ui: &mut Ui, editor: &Editor, menu: Menu) -> Option<CommandId> {
    let mut chosen = None;
    for (index, command) in CommandId::all().filter(|c| c.get().menu == menu).enumerate() {
        if command.get().starts_group && index > 0 {
            ui.separator();
        }
        if entry(ui, command, command.enabled(editor), command.is_on(editor)).clicked() {
            chosen = Some(command);
        }
    }
    chosen
}

/// The entries of the context menu of the selection; returns the command chosen.
pub fn context_entries(ui: &mut Ui) -> Option<CommandId> {
    const GROUPS: [&[&str]; 4] = [
        &["Rename", "Duplicate", "Delete"],
        &["Group", "Ungroup", "Toggle subtract"],
        &["Move up", "Move down"],
        &["Toggle visible", "Toggle lock", "Frame selected"],
    ];
    let mut chosen = None;
    for (index, names) in GROUPS.iter().enumerate() {
        if index > 0 {
            ui.separator();
        }
        for name in *names {
            let command = CommandId::named(name);
            if entry(ui, command, true, None).clicked() {
                chosen = Some(command);
            }
        }
    }
    chosen
}

/// An entry of a menu; one that switches something has a mark of whether it is on instead of its icon.
fn entry(ui: &mut Ui, id: CommandId, enabled: bool, on: Option<bool>) -> Response {
    let command = id.get();
    let mut button = Button::new((RichText::new(ICON_ROOM), command.name.as_str())).min_size(egui::vec2(190.0, 0.0));
    if let Some(key) = command.keys.first() {
        button = button.shortcut_text(RichText::new(ui.ctx().format_shortcut(key)).color(theme::FAINT));
    }
    let response = ui.add_enabled(enabled, button);
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_label(command.name.clone());
        if let Some(on) = on {
            node.set_toggled(on.into());
        }
    });
    match on {
        Some(on) => paint(ui, response.rect, Icon::Material(command.mark(on)), enabled),
        None => command.paint_icon(ui, response.rect, enabled),
    }
    if response.hovered() {
        // Not as a tooltip: it would hide the next entries. The status bar shows it.
        ui.ctx().data_mut(|d| d.insert_temp(hovered_help(), command.help.clone()));
    }
    response
}

/// Room for an icon in front of a name.
pub const ICON_ROOM: &str = "      ";

/// Where the help of the hovered menu entry waits for the status bar.
pub fn hovered_help() -> egui::Id {
    egui::Id::unique("help of the hovered command")
}

impl Command {
    /// A check box, or a radio button for one of several choices.
    fn mark(&self, on: bool) -> MaterialIcon {
        match (self.menu, on) {
            (Menu::ViewMode | Menu::Debug, true) => ICON_RADIO_BUTTON_CHECKED,
            (Menu::ViewMode | Menu::Debug, false) => ICON_RADIO_BUTTON_UNCHECKED,
            (_, true) => ICON_CHECK_BOX,
            (_, false) => ICON_CHECK_BOX_OUTLINE_BLANK,
        }
    }

    /// Paints the icon at the left end of a menu entry.
    pub fn paint_icon(&self, ui: &Ui, entry: egui::Rect, enabled: bool) {
        if let Some(icon) = self.icon {
            paint(ui, entry, icon, enabled);
        }
    }
}

/// Paints an icon at the left end of a menu entry.
fn paint(ui: &Ui, entry: egui::Rect, icon: Icon, enabled: bool) {
    let square = egui::Rect::from_center_size(
        entry.left_center() + egui::vec2(ui.spacing().button_padding.x + 10.0, 0.0),
        egui::Vec2::splat(16.0),
    );
    let square = icons::centered(square, 16.0);
    let dim = if enabled { 1.0 } else { 0.45 };
    match icon {
        Icon::Material(icon) => {
            icons::paint_icon(ui.painter(), square, icon, theme::WEAK.gamma_multiply(dim));
        }
        Icon::Shape(kind) => {
            icons::paint_shape(ui.painter(), square, kind, theme::OBJECT.gamma_multiply(dim));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_and_keys_are_unique_and_everything_is_explained() {
        let mut names = HashSet::new();
        let mut keys = HashSet::new();
        for id in CommandId::all() {
            let command = id.get();
            assert!(names.insert(&command.name), "{} twice", command.name);
            assert!(!command.help.is_empty(), "{}", command.name);
            for key in &command.keys {
                assert!(keys.insert(*key), "{}: {key:?} twice", command.name);
            }
        }
    }
}
