//! The render dialog: a window that never stands in the way of the scene.

use std::path::Path;
use std::time::Duration;

use egui::{
    Align, Button, ComboBox, Context, DragValue, Grid, Id, Label, Layout, ProgressBar, RichText, TextEdit, Ui, Window,
    vec2,
};
use egui_material_icons::icons::{ICON_CONTENT_COPY, ICON_FOLDER_OPEN, ICON_SWAP_HORIZ};

use super::dialogs::Purpose;
use super::rendering::{FILES_LISTED, RenderFormat, RenderOutcome, Rendering, Running, report_text};
use super::root::Editor;
use super::state::EditorState;
use super::{theme, widgets};
use isolith_field::Shading;
use isolith_session::{MAX_SAMPLES, MAX_SIDE, SharedStudio};

/// Sizes to choose from.
const SIZES: [(&str, [u32; 2]); 7] = [
    ("HD", [1280, 720]),
    ("Full HD", [1920, 1080]),
    ("QHD", [2560, 1440]),
    ("4K UHD", [3840, 2160]),
    ("Square", [1080, 1080]),
    ("Large square", [2048, 2048]),
    ("Portrait", [1080, 1920]),
];
/// Numbers of samples to choose from.
const SAMPLES: [u32; 6] = [1, 16, 64, 256, 1024, 4096];
/// Width of the settings and side of the preview, in points.
const SETTINGS_WIDTH: f32 = 330.0;
const PREVIEW_SIDE: f32 = 300.0;
/// Maximum number of characters of a path in a message.
const MOST_PATH: usize = 64;

/// The window.
pub(super) fn window_id() -> Id {
    Id::unique("render")
}

impl Rendering {
    /// Shows the window while it is open. Returns whether files may be replaced if the artist starts rendering.
    pub fn show(&mut self, state: &EditorState, studio: Option<&SharedStudio>, ctx: &Context) -> Option<bool> {
        let mut is_open = self.is_open;
        if !is_open {
            // A question that nobody answered is asked anew.
            self.existing.clear();
        }
        let mut agreed = None;
        Window::new("Render")
            .id(window_id())
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_pos(ctx.content_rect().center() - vec2(0.5 * (SETTINGS_WIDTH + PREVIEW_SIDE) + 30.0, 250.0))
            .show(ctx, |ui| {
                ui.horizontal_top(|ui| {
                    ui.vertical(|ui| {
                        ui.set_width(SETTINGS_WIDTH);
                        ui.add_enabled_ui(self.running.is_none(), |ui| self.fields(state, ui));
                    });
                    ui.add_space(10.0);
                    ui.vertical(|ui| {
                        ui.set_width(PREVIEW_SIDE);
                        self.picture(ui);
                    });
                });
                ui.add_space(6.0);
                self.command_line(state, studio, ui);
                ui.separator();
                agreed = self.bottom(state, studio, ui);
            });
        self.is_open &= is_open;
        agreed
    }

    fn fields(&mut self, state: &EditorState, ui: &mut Ui) {
        Grid::new("render settings").num_columns(2).spacing(vec2(10.0, 7.0)).min_col_width(84.0).show(ui, |ui| {
            self.size_rows(state, ui);
            label(ui, "Camera", "The camera that the pictures are seen by");
            self.camera_list(state, ui);
            ui.end_row();
            label(ui, "Samples", "Samples per pixel: more are smoother and take longer");
            self.samples_row(ui);
            ui.end_row();
            label(ui, "Shading", "How the scene is lit");
            let shadings = Shading::ALL.map(|shading| (shading, shading.label(), shading.help()));
            list(ui, "Render shading", &mut self.settings.shading, &shadings);
            ui.end_row();
            label(ui, "Background", "Without it, alpha is the share of the pixel that the scene covers");
            named(ui.checkbox(&mut self.settings.is_transparent, "Transparent"), "Transparent background");
            ui.end_row();
            label(ui, "Format", "The kind of file");
            let mut format = self.format;
            let formats = RenderFormat::ALL.map(|format| (format, format.label(), format.help()));
            if list(ui, "Render format", &mut format, &formats) {
                self.set_format(format);
            }
            ui.end_row();
            label(ui, "Frames", "One picture of this moment, or one for each frame of a range");
            self.frames_row(ui);
            ui.end_row();
            label(ui, "File", "Where the picture goes; #### becomes the number of the frame");
            self.file_row(ui);
            ui.end_row();
        });
    }

    fn size_rows(&mut self, state: &EditorState, ui: &mut Ui) {
        label(ui, "Size", "Width and height in pixels");
        let size = &mut self.settings.size;
        ui.horizontal(|ui| {
            for (index, name) in ["Width", "Height"].into_iter().enumerate() {
                let drag = DragValue::new(&mut size[index]).range(1..=MAX_SIDE).speed(4.0).suffix(" px");
                named(ui.add_sized(vec2(86.0, theme::ROW_HEIGHT), drag), &format!("Render {}", name.to_lowercase()))
                    .on_hover_text(name);
            }
            let swap = Button::new(ICON_SWAP_HORIZ.rich_text().size(theme::ICON_SIZE)).frame(false);
            if named(ui.add(swap), "Swap width and height").on_hover_text("Swap width and height").clicked() {
                size.swap(0, 1);
            }
        });
        ui.end_row();
        ui.label("");
        let of_view = state.view.size_px;
        let preset = SIZES.iter().find(|(_, preset)| preset == size).map(|(name, _)| *name);
        let shown = preset.unwrap_or(if *size == of_view { "Viewport" } else { "Custom" });
        let combo = ComboBox::from_id_salt("render size preset").selected_text(shown).width(200.0);
        let response = combo.show_ui(ui, |ui| {
            for (name, [width, height]) in SIZES.iter().copied().chain([("Viewport", of_view)]) {
                let text = format!("{name}  {width} × {height}");
                if ui.selectable_label(*size == [width, height], text).clicked() {
                    *size = [width, height];
                }
            }
        });
        named(response.response, "Size preset");
        ui.end_row();
    }

    fn camera_list(&mut self, state: &EditorState, ui: &mut Ui) {
        let cameras = &state.flat().cameras;
        let first = cameras.first().map_or("Whole scene", |first| first.name.as_str());
        let shown = self.settings.camera.as_deref().unwrap_or(first).to_owned();
        let combo = ComboBox::from_id_salt("render camera").selected_text(widgets::elided(&shown, 26)).width(200.0);
        let response = combo.show_ui(ui, |ui| {
            if cameras.is_empty() {
                ui.label(RichText::new("The scene has no camera: it is seen whole.").weak());
            }
            for (index, camera) in cameras.iter().enumerate() {
                // A command names a camera; of several with one name it takes the first.
                if cameras[..index].iter().any(|other| other.name == camera.name) {
                    continue;
                }
                if ui.selectable_label(shown == camera.name, &camera.name).clicked() {
                    self.settings.camera = (index > 0).then(|| camera.name.clone());
                }
            }
        });
        named(response.response, "Render camera");
    }

    fn samples_row(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let samples = &mut self.settings.samples;
            let drag = DragValue::new(samples).range(1..=MAX_SAMPLES).speed(0.5);
            named(ui.add_sized(vec2(86.0, theme::ROW_HEIGHT), drag), "Render samples");
            let combo = ComboBox::from_id_salt("render samples preset").selected_text("Presets").width(100.0);
            let response = combo.show_ui(ui, |ui| {
                for preset in SAMPLES {
                    ui.selectable_value(samples, preset, preset.to_string());
                }
            });
            named(response.response, "Samples preset");
        });
    }

    fn frames_row(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let mut has_frames = self.has_frames;
            if named(ui.checkbox(&mut has_frames, "Range"), "Render a range of frames").changed() {
                self.set_frames(has_frames);
            }
            ui.add_enabled_ui(self.has_frames, |ui| {
                for (index, name) in ["First frame to render", "Last frame to render"].into_iter().enumerate() {
                    let drag = DragValue::new(&mut self.frames[index]).speed(0.2);
                    named(ui.add_sized(vec2(64.0, theme::ROW_HEIGHT), drag), name).on_hover_text(name);
                }
            });
        });
    }

    fn file_row(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let field = TextEdit::singleline(&mut self.output).desired_width(196.0).hint_text("/path/to/picture.png");
            let response = named(ui.add(field), "Render file");
            if response.changed() {
                self.follow_ending();
            }
            response.on_hover_text(&self.output);
            let button = Button::new(ICON_FOLDER_OPEN.rich_text().size(theme::ICON_SIZE)).frame(false);
            self.wants_path |=
                named(ui.add(button), "Choose the file to render").on_hover_text("Choose the file").clicked();
        });
    }

    /// The picture so far.
    fn picture(&self, ui: &mut Ui) {
        let (rect, _) = ui.allocate_exact_size(vec2(PREVIEW_SIDE, PREVIEW_SIDE), egui::Sense::hover());
        ui.painter().rect_filled(rect, 5.0, ui.visuals().extreme_bg_color);
        let Some(preview) = &self.preview else {
            let text = if self.running.is_some() { "The first sample is on its way…" } else { "No picture yet" };
            let (font, color) = (egui::TextStyle::Body.resolve(ui.style()), ui.visuals().weak_text_color());
            ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, color);
            return;
        };
        let size = preview.texture.size_vec2();
        let shown = size * (PREVIEW_SIDE / size.x.max(size.y));
        let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        let place = egui::Rect::from_center_size(rect.center(), shown);
        ui.painter().image(preview.texture.id(), place, whole, egui::Color32::WHITE);
        let [samples, wanted] = preview.samples;
        let file = preview.file.as_deref().and_then(Path::file_name).map(|name| name.to_string_lossy());
        let name = widgets::elided(&file.unwrap_or_default(), 30);
        ui.label(RichText::new(format!("{name}  ·  {samples} of {wanted} samples")).weak().small());
    }

    /// The command that does the same, to be copied.
    fn command_line(&self, state: &EditorState, studio: Option<&SharedStudio>, ui: &mut Ui) {
        let document = &state.session.document;
        let adapter = studio.and_then(|studio| studio.adapter());
        let Some(command) = self.command(document, adapter.as_deref()) else {
            if document.path().is_none() {
                let text = "Save the scene, and the equal command of the command line stands here.";
                ui.label(RichText::new(text).weak().small());
            }
            return;
        };
        ui.horizontal(|ui| {
            let button = Button::new(ICON_CONTENT_COPY.rich_text().size(theme::ICON_SIZE)).frame(false);
            if named(ui.add(button), "Copy the command").on_hover_text("Copy the command").clicked() {
                ui.ctx().copy_text(command.clone());
            }
            let text = RichText::new(&command).monospace().small();
            ui.add(Label::new(text).truncate()).on_hover_text(&command);
        });
        if document.is_changed() {
            let text = "The command reads the file: save the scene first, and its pictures are the same.";
            ui.label(RichText::new(text).weak().small());
        }
    }

    /// Progress, the end, questions, and the buttons.
    fn bottom(&mut self, state: &EditorState, studio: Option<&SharedStudio>, ui: &mut Ui) -> Option<bool> {
        if let Some(running) = &self.running {
            progress(running, ui);
            return None;
        }
        if !self.existing.is_empty() {
            return self.ask_to_replace(ui);
        }
        let refused = self.wanted(&state.session.document).err();
        let reason = refused.or_else(|| studio.is_none().then(|| "There is no renderer.".to_owned()));
        match (&self.outcome, &reason) {
            (_, Some(reason)) => colored(ui, reason, ui.visuals().warn_fg_color),
            (Some(RenderOutcome::Done(report)), _) => {
                colored(ui, &report_text(report), *theme::SUCCESS);
                for warning in report.warnings.iter().take(FILES_LISTED) {
                    colored(ui, &format!("{}: {}", warning.name, warning.reason), ui.visuals().warn_fg_color);
                }
            }
            (Some(RenderOutcome::Failed(reason)), _) => colored(ui, reason, ui.visuals().error_fg_color),
            (Some(RenderOutcome::Canceled), _) => colored(ui, "Canceled.", ui.visuals().weak_text_color()),
            (None, None) => {}
        }
        let mut agreed = None;
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let name = if self.has_frames { "Render frames" } else { "Render picture" };
            if ui.add_enabled_ui(reason.is_none(), |ui| accented(ui, name)).inner {
                agreed = Some(false);
            }
            if named(ui.add(Button::new("Close").min_size(vec2(96.0, 28.0))), "Close the render dialog").clicked() {
                self.is_open = false;
            }
        });
        agreed
    }

    fn ask_to_replace(&mut self, ui: &mut Ui) -> Option<bool> {
        let count = self.existing.len();
        let title = match &*self.existing {
            [one] => format!("{} exists already.", widgets::elided(&one.display().to_string(), MOST_PATH)),
            many => format!("{} of the files exist already:", many.len()),
        };
        colored(ui, &title, ui.visuals().warn_fg_color);
        if count > 1 {
            let names = self.existing.iter().take(FILES_LISTED).filter_map(|path| path.file_name());
            let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
            let more = if count > FILES_LISTED { format!(" and {} more", count - FILES_LISTED) } else { String::new() };
            ui.label(RichText::new(names.join(", ") + &more).weak());
        }
        let mut agreed = None;
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if accented(ui, if count > 1 { "Replace all" } else { "Replace file" }) {
                agreed = Some(true);
            }
            if named(ui.add(Button::new("Keep").min_size(vec2(96.0, 28.0))), "Keep the files").clicked() {
                self.existing.clear();
            }
        });
        agreed
    }
}

impl Editor {
    /// Hands over the renderer for work beside the frames: pictures in files, thumbnails.
    pub fn set_studio(&mut self, studio: SharedStudio) {
        self.studio = Some(studio);
    }

    /// Whether pictures are being rendered into files.
    pub fn is_rendering(&self) -> bool {
        self.rendering.running.is_some()
    }

    /// Shows the dialog, and follows its job.
    pub(super) fn show_rendering(&mut self, ctx: &Context) {
        if let Some(message) = self.rendering.poll(ctx) {
            self.report(message);
        }
        if std::mem::take(&mut self.rendering.wants_path) {
            self.choose(Purpose::RenderTo, ctx);
        }
        let agreed = self.rendering.show(&self.state, self.studio.as_ref(), ctx);
        if let (Some(may_replace), Some(studio)) = (agreed, &self.studio) {
            self.state.session.finish();
            let (document, jobs) = (&self.state.session.document, self.state.derived.jobs());
            self.rendering.start(document, studio, jobs, may_replace);
        }
    }
}

/// Progress, time left, and the button that cancels.
fn progress(running: &Running, ui: &mut Ui) {
    let task = running.task();
    ui.horizontal(|ui| {
        let share = task.progress().unwrap_or(0.0);
        let left = running.time_left().map_or(String::new(), |left| format!("  ·  {} left", duration_text(left)));
        let stage = if task.stage().is_empty() { String::new() } else { format!("  ·  {}", task.stage()) };
        let text = format!("{:.0} %{left}{stage}", share * 100.0);
        ui.add(
            ProgressBar::new(share)
                .desired_width(ui.available_width() - 112.0)
                .desired_height(22.0)
                .text(RichText::new(text).color(ui.visuals().text_color())),
        );
        let button = Button::new("Cancel").min_size(vec2(96.0, 28.0));
        if named(ui.add_enabled(!task.is_canceled(), button), "Cancel rendering").clicked() {
            task.cancel();
        }
    });
}

/// Seconds, or minutes and seconds, or hours and minutes.
pub fn duration_text(time: Duration) -> String {
    let seconds = time.as_secs_f64().ceil() as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds % 3600 / 60),
    }
}

fn label(ui: &mut Ui, text: &str, help: &str) {
    ui.label(RichText::new(text).weak()).on_hover_text(help);
}

fn colored(ui: &mut Ui, text: &str, color: egui::Color32) {
    ui.add(Label::new(RichText::new(text).color(color)).wrap());
}

fn accented(ui: &mut Ui, text: &str) -> bool {
    let button = Button::new(RichText::new(text).color(theme::ON_ACCENT)).fill(*theme::ACCENT);
    ui.add(button.min_size(vec2(110.0, 28.0))).clicked()
}

/// Gives a widget its accessible name.
fn named(response: egui::Response, name: &str) -> egui::Response {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    response
}

/// A drop-down list of values with names and help; returns whether another one was chosen.
fn list<T: Copy + PartialEq>(ui: &mut Ui, name: &str, value: &mut T, options: &[(T, &str, &str)]) -> bool {
    let shown = options.iter().find(|(option, ..)| option == value).map_or("", |(_, label, _)| *label);
    let before = *value;
    let response = ComboBox::from_id_salt(name).selected_text(shown).width(200.0).show_ui(ui, |ui| {
        for (option, label, help) in options {
            ui.selectable_value(value, *option, *label).on_hover_text(*help);
        }
    });
    named(response.response, name);
    *value != before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_left_are_read_at_a_glance() {
        let text = |seconds| duration_text(Duration::from_secs_f64(seconds));
        assert_eq!((text(0.2), text(59.5), text(3599.0)), ("1 s".into(), "1 min 0 s".into(), "59 min 59 s".into()));
        assert_eq!(text(7300.0), "2 h 1 min");
    }
}
