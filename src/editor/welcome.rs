//! The welcome window: templates, recent files, and the examples by their pictures.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{
    Align, Align2, Button, ColorImage, Context, FontId, Frame, Id, Layout, Modal, Rect, RichText, ScrollArea, Sense,
    TextureHandle, TextureOptions, Ui, pos2, vec2,
};
use egui_material_icons::icons::{ICON_DESCRIPTION, ICON_FOLDER_OPEN, ICON_NOTE_ADD};

use super::commands::command::Command;
use super::intent::Intent;
use super::state::{EditorState, Example};
use super::{theme, widgets};
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_session::{SharedStudio, StillPreview, folder_of, read_file};

/// Size of the content, in points.
const SIZE: egui::Vec2 = vec2(900.0, 560.0);
/// Width of the column at the left, in points.
const LEFT: f32 = 250.0;
/// Width and height of a card, in points.
const CARD: egui::Vec2 = vec2(142.0, 150.0);
/// Most recent files in the list, and those with a picture: a picture takes a renderer of its own.
const RECENT: usize = 7;
const RECENT_PICTURES: usize = 4;
/// Side of the picture of a recent file, in pixels.
const PICTURE_SIDE: u32 = 96;
/// Maximum number of characters of a file's name.
const NAME: usize = 26;
/// The same below a card.
const CARD_NAME: usize = 22;

/// A picture of an example, as the bytes of an image file.
pub type ThumbnailOf = fn(&str) -> Option<&'static [u8]>;

/// What the artist chose.
#[derive(Clone, Debug, PartialEq)]
pub enum WelcomeChoice {
    /// Open a document.
    Intend(Intent),
    /// Run a command.
    Run(Command),
    /// Close the window.
    Close,
}

/// State of the window.
#[derive(Default)]
pub struct Welcome {
    /// Whether it is open.
    pub is_open: bool,
    /// Scenes to start from.
    pub templates: Vec<Example>,
    /// The pictures of examples and templates.
    pub thumbnail_of: Option<ThumbnailOf>,
    pictures: HashMap<String, Option<TextureHandle>>,
    recent: HashMap<PathBuf, Option<TextureHandle>>,
    drawing: Option<(PathBuf, Job<Result<StillPreview, String>>)>,
}

impl Welcome {
    /// Shows the window while it is open; returns the choice.
    pub fn show(&mut self, state: &mut EditorState, ctx: &Context) -> Option<WelcomeChoice> {
        if !self.is_open {
            return None;
        }
        let room = ctx.content_rect().size() - vec2(40.0, 40.0);
        let size = SIZE.min(room - vec2(48.0, 48.0));
        let mut choice = None;
        let frame = Frame::window(&ctx.global_style()).inner_margin(24.0);
        let response = Modal::new(Id::unique("welcome")).frame(frame).show(ctx, |ui| {
            ui.set_width(size.x);
            ui.label(RichText::new("Isolith").size(26.0).strong().color(ui.visuals().strong_text_color()));
            ui.label(RichText::new("Build scenes of distance fields with your hands.").weak());
            ui.add_space(12.0);
            let height = size.y - 120.0;
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(LEFT);
                    choice = self.start(state, height, ui);
                });
                ui.add_space(16.0);
                ui.vertical(|ui| choice = self.examples(state, height, ui).or(choice.take()));
            });
            ui.separator();
            choice = bottom(state, ui).or(choice.take());
        });
        if response.should_close() {
            choice = choice.or(Some(WelcomeChoice::Close));
        }
        choice
    }

    /// Draws the pictures of recent files, one after the other. Call once a frame.
    pub fn follow_pictures(&mut self, state: &EditorState, studio: Option<&SharedStudio>, ctx: &Context) {
        if !self.is_open {
            // Dropping the job cancels it.
            self.drawing = None;
            return;
        }
        if let Some(end) = self.drawing.as_ref().and_then(|(_, job)| job.poll()) {
            let Some((path, _)) = self.drawing.take() else { return };
            let texture = match end {
                JobEnd::Done(Ok(StillPreview { size, pixels, .. })) => {
                    let bytes: Vec<u8> = pixels.into_iter().flatten().collect();
                    let image = ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), &bytes);
                    Some(ctx.load_texture("recent", image, TextureOptions::LINEAR))
                }
                // A file that cannot be drawn keeps its icon; opening it says why.
                _ => None,
            };
            self.recent.insert(path, texture);
            ctx.request_repaint();
        }
        let Some(studio) = studio.filter(|_| self.drawing.is_none()) else { return };
        let mut paths = state.files.recent().paths().iter().take(RECENT_PICTURES);
        if let Some(path) = paths.find(|path| !self.recent.contains_key(*path)) {
            self.drawing = Some((path.clone(), draw(state.derived.jobs(), studio.clone(), path)));
        }
    }

    /// New scenes and recent files.
    fn start(&mut self, state: &EditorState, height: f32, ui: &mut Ui) -> Option<WelcomeChoice> {
        let mut choice = None;
        heading(ui, "New");
        let empty = (ICON_NOTE_ADD.codepoint, "Empty", "An empty scene with a light");
        if line_button(ui, None, empty.0, empty.1, empty.2) {
            choice = Some(WelcomeChoice::Intend(Intent::New));
        }
        for index in 0..self.templates.len() {
            let name = self.templates[index].name.clone();
            let picture = self.picture(&format!("template-{}", name.to_lowercase()), ui.ctx());
            if line_button(ui, picture.as_ref(), ICON_DESCRIPTION.codepoint, &name, "A scene to start from") {
                choice = Some(WelcomeChoice::Intend(Intent::Template(index)));
            }
        }
        ui.add_space(8.0);
        heading(ui, "Open");
        if line_button(ui, None, ICON_FOLDER_OPEN.codepoint, "Open…", "Opens a scene file") {
            choice = Some(WelcomeChoice::Intend(Intent::Choose));
        }
        let room = (height - ui.min_rect().height() - 8.0).max(60.0);
        ScrollArea::vertical().id_salt("recent files").max_height(room).show(ui, |ui| {
            for path in state.files.recent().paths().iter().take(RECENT) {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                let picture = self.recent.get(path).cloned().flatten();
                let name = widgets::elided(&name, NAME);
                if line_button(ui, picture.as_ref(), ICON_DESCRIPTION.codepoint, &name, &path.display().to_string()) {
                    choice = Some(WelcomeChoice::Intend(Intent::Open(path.clone())));
                }
            }
        });
        choice
    }

    /// The examples that show something, by their pictures.
    fn examples(&mut self, state: &EditorState, height: f32, ui: &mut Ui) -> Option<WelcomeChoice> {
        let mut choice = None;
        heading(ui, "Examples");
        ScrollArea::vertical().id_salt("examples").max_height(height - 30.0).auto_shrink([false, false]).show(
            ui,
            |ui| {
                ui.horizontal_wrapped(|ui| {
                    ui.spacing_mut().item_spacing = vec2(8.0, 8.0);
                    for (index, example) in state.examples.iter().enumerate().filter(|(_, example)| !example.is_test) {
                        let picture = self.picture(&example.name.replace(' ', "-"), ui.ctx());
                        if card(ui, picture.as_ref(), &example.name) {
                            choice = Some(WelcomeChoice::Intend(Intent::Example(index)));
                        }
                    }
                });
            },
        );
        choice
    }

    /// The texture of a picture, decoded on the first request.
    fn picture(&mut self, name: &str, ctx: &Context) -> Option<TextureHandle> {
        let bytes = || self.thumbnail_of.and_then(|of| of(name));
        if !self.pictures.contains_key(name) {
            let texture = bytes()
                .and_then(decoded)
                .map(|image| ctx.load_texture(format!("picture of {name}"), image, TextureOptions::LINEAR));
            self.pictures.insert(name.to_owned(), texture);
        }
        self.pictures.get(name).cloned().flatten()
    }
}

fn decoded(bytes: &[u8]) -> Option<ColorImage> {
    let image = image::load_from_memory(bytes).ok()?.into_rgba8();
    let size = [image.width() as usize, image.height() as usize];
    Some(ColorImage::from_rgba_unmultiplied(size, image.as_raw()))
}

/// Reads and draws a file.
fn draw(jobs: &Jobs, studio: SharedStudio, path: &Path) -> Job<Result<StillPreview, String>> {
    let (read, folder): (Arc<_>, _) = (read_file(path), folder_of(path));
    jobs.start(Task::hidden("Drawing a recent file"), move |task| {
        let document = read(task)?;
        studio.thumbnail(document.resting(), folder, [PICTURE_SIDE; 2], task)
    })
}

/// Help, and whether the window comes at the next start.
fn bottom(state: &mut EditorState, ui: &mut Ui) -> Option<WelcomeChoice> {
    let mut choice = None;
    ui.horizontal(|ui| {
        for (text, command) in
            [("Take the tour", Command::StartTour), ("Keys", Command::ShowKeys), ("What's new", Command::ShowNews)]
        {
            if ui.add(Button::new(text).min_size(vec2(0.0, 28.0))).clicked() {
                choice = Some(WelcomeChoice::Run(command));
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = ui.add(Button::new("Close").min_size(vec2(96.0, 28.0)));
            ui.ctx().accesskit_node_builder(close.id, |node| node.set_label("Close the welcome"));
            if close.clicked() {
                choice = Some(WelcomeChoice::Close);
            }
            let mut shows = !state.preferences.values().skips_welcome;
            if ui.checkbox(&mut shows, "Show at the start").changed() {
                state.preferences.change(|values| values.skips_welcome = !shows);
            }
        });
    });
    choice
}

fn heading(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).strong().color(ui.visuals().strong_text_color()));
}

/// A line with a picture or an icon; returns whether it was clicked.
fn line_button(ui: &mut Ui, picture: Option<&TextureHandle>, icon: &str, text: &str, help: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 36.0), Sense::click());
    if response.hovered() {
        ui.painter().rect_filled(rect, 6.0, ui.visuals().widgets.hovered.bg_fill);
    }
    let square = Rect::from_center_size(rect.left_center() + vec2(20.0, 0.0), vec2(30.0, 30.0));
    match picture {
        Some(texture) => paint(ui, texture, square),
        None => {
            let (font, color) = (FontId::proportional(20.0), *theme::ACCENT);
            ui.painter().text(square.center(), Align2::CENTER_CENTER, icon, font, color);
        }
    }
    let font = egui::TextStyle::Body.resolve(ui.style());
    let color = ui.visuals().text_color();
    ui.painter().text(rect.left_center() + vec2(44.0, 0.0), Align2::LEFT_CENTER, text, font, color);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("Start with {text}")));
    response.on_hover_text(help).clicked()
}

/// An example; returns whether it was clicked.
fn card(ui: &mut Ui, picture: Option<&TextureHandle>, name: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(CARD, Sense::click());
    let fill = match response.hovered() {
        true => ui.visuals().widgets.hovered.bg_fill,
        false => ui.visuals().faint_bg_color,
    };
    ui.painter().rect_filled(rect, 7.0, fill);
    let picture_rect = Rect::from_min_size(rect.min, vec2(CARD.x, CARD.y - 26.0)).shrink(3.0);
    match picture {
        Some(texture) => paint(ui, texture, picture_rect),
        None => {
            let (font, color) = (FontId::proportional(34.0), ui.visuals().weak_text_color());
            ui.painter().text(picture_rect.center(), Align2::CENTER_CENTER, ICON_DESCRIPTION.codepoint, font, color);
        }
    }
    let label = Rect::from_min_max(pos2(rect.left() + 4.0, rect.bottom() - 26.0), rect.right_bottom());
    let mut chars = name.chars();
    let title = chars.next().map_or_else(String::new, |first| first.to_uppercase().to_string() + chars.as_str());
    let font = egui::TextStyle::Small.resolve(ui.style());
    let (text, color) = (widgets::elided(&title, CARD_NAME), ui.visuals().text_color());
    ui.painter().text(label.center(), Align2::CENTER_CENTER, text, font, color);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(format!("Example {name}")));
    response.clicked()
}

/// Paints as much of a picture as fills the rectangle without distortion.
fn paint(ui: &Ui, texture: &TextureHandle, rect: Rect) {
    let size = texture.size_vec2();
    let scale = (rect.width() / size.x).max(rect.height() / size.y);
    let shown = rect.size() / (size * scale);
    let uv = Rect::from_center_size(pos2(0.5, 0.5), shown);
    let shape = egui::epaint::RectShape::filled(rect, 5.0, egui::Color32::WHITE);
    ui.painter().add(shape.with_texture(texture.id(), uv));
}
