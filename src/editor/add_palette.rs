//! The palette of everything that can be added: at the pointer, by category or by name, favorites first.

use egui::{
    Align2, Button, Color32, Context, Frame, Id, Key, Modal, Modifiers, Pos2, RichText, ScrollArea, Sense, Ui, vec2,
};
use egui_material_icons::icons::ICON_STAR;

use super::commands::command::Command;
use super::commands::entries::ICON_ROOM;
use super::commands::info::Menu;
use super::state::EditorState;
use super::{drag_in, theme, widgets};
use isolith_scene::ShapeKind;

/// A category of what can be added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Category {
    #[default]
    Favorites,
    Basic,
    Curves,
    Text,
    Landscapes,
    Fractals,
    Lights,
    Cameras,
    Meshes,
    Groups,
    More,
}

impl Category {
    const ALL: [Self; 11] = [
        Self::Favorites,
        Self::Basic,
        Self::Curves,
        Self::Text,
        Self::Landscapes,
        Self::Fractals,
        Self::Lights,
        Self::Cameras,
        Self::Meshes,
        Self::Groups,
        Self::More,
    ];

    fn label(self) -> &'static str {
        match self {
            Self::Favorites => "Favorites",
            Self::Basic => "Basic",
            Self::Curves => "Curves and profiles",
            Self::Text => "Text",
            Self::Landscapes => "Landscapes",
            Self::Fractals => "Fractals",
            Self::Lights => "Lights",
            Self::Cameras => "Cameras",
            Self::Meshes => "Meshes",
            Self::Groups => "Groups and instancers",
            Self::More => "More",
        }
    }

    /// The category of a command that adds something.
    fn of(command: Command) -> Self {
        use Command::{
            AddAreaLight, AddCamera, AddGroup, AddInstancer, AddMesh, AddPointLight, AddShape, AddSpotLight, AddSun,
        };
        match command {
            AddShape(ShapeKind::Tube | ShapeKind::Extrusion | ShapeKind::Revolution) => Self::Curves,
            AddShape(ShapeKind::Text) => Self::Text,
            AddShape(ShapeKind::Terrain | ShapeKind::Heightmap | ShapeKind::Ocean) => Self::Landscapes,
            AddShape(ShapeKind::MengerSponge | ShapeKind::Julia | ShapeKind::Kleinian | ShapeKind::Mandelbulb) => {
                Self::Fractals
            }
            AddShape(ShapeKind::MeshField) => Self::Meshes,
            AddShape(_) => Self::Basic,
            AddSun | AddPointLight | AddSpotLight | AddAreaLight => Self::Lights,
            AddCamera => Self::Cameras,
            AddMesh => Self::Meshes,
            AddGroup | AddInstancer => Self::Groups,
            _ => Self::More,
        }
    }

    /// Its commands, in the order of the menu.
    fn commands(self, state: &EditorState) -> Vec<Command> {
        match self {
            Self::Favorites => favorites(state),
            _ => addable().filter(|command| Self::of(*command) == self).collect(),
        }
    }
}

/// Everything that can be added.
fn addable() -> impl Iterator<Item = Command> {
    Command::all().filter(|command| command.info().menu == Menu::Add && *command != Command::AddAtPointer)
}

/// The favorites of a new user.
const FIRST_FAVORITES: [ShapeKind; 8] = [
    ShapeKind::Sphere,
    ShapeKind::Box,
    ShapeKind::Cylinder,
    ShapeKind::CappedCone,
    ShapeKind::Torus,
    ShapeKind::Capsule,
    ShapeKind::Tube,
    ShapeKind::Revolution,
];

/// The favorites of the user: they stand on the toolbar, and first in the palette.
pub fn favorites(state: &EditorState) -> Vec<Command> {
    match &state.preferences.values().favorites {
        None => FIRST_FAVORITES.map(Command::AddShape).to_vec(),
        Some(names) => names.iter().filter_map(|name| addable().find(|c| c.info().label == *name)).collect(),
    }
}

/// Makes something a favorite, or no longer; kept for the next start.
fn toggle_favorite(state: &mut EditorState, command: Command) {
    let mut all = favorites(state);
    if all.contains(&command) {
        all.retain(|other| *other != command);
    } else {
        all.push(command);
    }
    let names = all.iter().map(|command| command.info().label.clone()).collect();
    state.preferences.change(|values| values.favorites = Some(names));
}

/// State of the palette while it is open.
#[derive(Default)]
pub struct AddPalette {
    open: bool,
    at: Pos2,
    text: String,
    chosen: usize,
    focus: bool,
    category: Category,
}

/// Size of the palette without its margin, and width of the categories, in points.
const SIZE: egui::Vec2 = vec2(432.0, 326.0);
const CATEGORIES: f32 = 140.0;

impl AddPalette {
    /// Opens the palette beside a position of the screen.
    pub fn open(&mut self, at: Pos2) {
        *self = Self { open: true, focus: true, at, category: self.category, ..Self::default() };
    }

    /// Whether the palette is open.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Shows the palette if it is open; returns the chosen command.
    pub fn show(&mut self, state: &mut EditorState, ctx: &Context) -> Option<Command> {
        if !self.open {
            return None;
        }
        let found = self.found(state);
        let (up, down, enter, escape) = ctx.input_mut(|i| {
            let mut key = |key| i.consume_key(Modifiers::NONE, key);
            (key(Key::ArrowUp), key(Key::ArrowDown), key(Key::Enter), key(Key::Escape))
        });
        let last = found.len().saturating_sub(1);
        self.chosen = (self.chosen + usize::from(down)).min(last).saturating_sub(usize::from(up));
        let mut run = found.get(self.chosen).copied().filter(|_| enter);
        let id = Id::unique("palette of what can be added");
        let screen = ctx.content_rect();
        // The first entries lie near the pointer.
        let corner = (self.at - vec2(CATEGORIES + 30.0, 40.0)).min(screen.max - SIZE - vec2(30.0, 30.0));
        let corner = corner.max(screen.min + vec2(4.0, 4.0));
        let response = Modal::new(id)
            .area(Modal::default_area(id).anchor(Align2::LEFT_TOP, corner - screen.min))
            .backdrop_color(Color32::TRANSPARENT)
            .frame(Frame::popup(&ctx.global_style()).inner_margin(10.0))
            .show(ctx, |ui| {
                ui.set_width(SIZE.x);
                ui.set_height(SIZE.y);
                self.content(state, ui, &found, up || down)
            });
        run = run.or(response.inner);
        let outside = response.backdrop_response.clicked() && !self.focus;
        self.focus = false;
        if escape || outside || enter || run.is_some() {
            self.open = false;
            ctx.memory_mut(|m| m.stop_text_input());
            if run.is_none() {
                state.view.add_at = None;
            }
        }
        run
    }

    /// What the text finds, or the category.
    fn found(&self, state: &EditorState) -> Vec<Command> {
        let wanted = self.text.to_lowercase();
        let words: Vec<&str> = wanted.split_whitespace().collect();
        if words.is_empty() {
            return self.category.commands(state);
        }
        let label = |command: &Command| command.info().label.to_lowercase();
        let kind = |command: &Command| Category::of(*command).label().to_lowercase();
        let fits = |command: &Command| words.iter().all(|w| label(command).contains(w) || kind(command).contains(w));
        let mut found: Vec<_> = addable().filter(fits).collect();
        found.sort_by_key(|command| !label(command).starts_with(wanted.trim()));
        found
    }

    fn content(&mut self, state: &mut EditorState, ui: &mut Ui, found: &[Command], moved: bool) -> Option<Command> {
        if widgets::search(ui, &mut self.text, ("Add…", "Find something to add"), self.focus).changed() {
            self.chosen = 0;
        }
        ui.add_space(4.0);
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(CATEGORIES);
                self.categories(state, ui);
            });
            ui.add_space(2.0);
            ui.vertical(|ui| self.entries(state, ui, found, moved)).inner
        })
        .inner
    }

    fn categories(&mut self, state: &EditorState, ui: &mut Ui) {
        ui.spacing_mut().item_spacing.y = 1.0;
        let typed = !self.text.trim().is_empty();
        for category in Category::ALL {
            if category != Category::Favorites && category.commands(state).is_empty() {
                continue;
            }
            let is_on = !typed && category == self.category;
            let button = Button::selectable(is_on, category.label()).min_size(vec2(CATEGORIES, 26.0));
            let response = ui.add(button);
            ui.ctx()
                .accesskit_node_builder(response.id, |node| node.set_label(format!("Category {}", category.label())));
            if response.clicked() {
                (self.category, self.chosen) = (category, 0);
                self.text.clear();
            }
        }
    }

    fn entries(&mut self, state: &mut EditorState, ui: &mut Ui, found: &[Command], moved: bool) -> Option<Command> {
        let mut run = None;
        let starred = favorites(state);
        let room = ui.available_height();
        ScrollArea::vertical().max_height(room).auto_shrink([false, false]).show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(2.0, 1.0);
            if found.is_empty() {
                let text =
                    if self.text.trim().is_empty() { "A star adds a favorite." } else { "Nothing has this name." };
                ui.label(RichText::new(text).color(theme::WEAK));
            }
            for (index, command) in found.iter().enumerate() {
                let info = command.info();
                ui.horizontal(|ui| {
                    let width = ui.available_width() - 36.0;
                    let button = Button::selectable(index == self.chosen, (RichText::new(ICON_ROOM), &*info.label))
                        .min_size(vec2(width, 26.0))
                        .sense(Sense::click_and_drag())
                        .shortcut_text("");
                    let response = ui.add_enabled(command.is_enabled(state), button);
                    info.paint_icon(ui, response.rect, true, None);
                    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("New {}", info.label)));
                    if index == self.chosen && moved {
                        response.scroll_to_me(None);
                    }
                    if drag_in::begin(state, &response, *command) {
                        self.open = false;
                    }
                    if response.on_hover_text(&info.help).clicked() {
                        run = Some(*command);
                    }
                    if star(ui, &info.label, starred.contains(command)) {
                        toggle_favorite(state, *command);
                    }
                });
            }
        });
        run
    }
}

/// The star of an entry; returns whether it was clicked.
fn star(ui: &mut Ui, name: &str, is_on: bool) -> bool {
    let color = if is_on { theme::LIGHT } else { theme::RESTING };
    let text = ICON_STAR.rich_text().size(15.0).color(color);
    let response = ui.add(Button::new(text).frame_when_inactive(false).min_size(vec2(26.0, 26.0)));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("Favorite: {name}")));
    response.on_hover_text("On the toolbar, and first in this list").clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_that_can_be_added_has_one_category() {
        let state = EditorState::default();
        let mut counts = 0;
        for category in Category::ALL.into_iter().filter(|category| *category != Category::Favorites) {
            counts += category.commands(&state).len();
        }
        assert_eq!(counts, addable().count());
        assert!(Category::Fractals.commands(&state).len() >= 4 && Category::Curves.commands(&state).len() >= 3);
        assert_eq!(favorites(&state).len(), 8);
    }

    #[test]
    fn a_category_is_found_by_its_name_too() {
        let mut palette = AddPalette { text: "light".into(), ..AddPalette::default() };
        let state = EditorState::default();
        assert_eq!(palette.found(&state).len(), 4, "the sun is a light, too");
        palette.text = "cone".into();
        assert!(palette.found(&state).contains(&Command::AddShape(ShapeKind::CappedCone)));
    }
}
