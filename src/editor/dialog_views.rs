//! Views of the dialogs: the questions before a loss of work, and the path field.

use std::path::{Path, PathBuf};

use egui::{Button, Context, Id, Key, Label, Modal, Modifiers, RichText, TextEdit, Ui, vec2};

use super::dialogs::{Next, PathField, Purpose, Question};
use super::root::Editor;
use super::{theme, widgets};

/// The answer to a question.
#[derive(Clone, Copy, PartialEq)]
enum DialogAnswer {
    /// Do what the accented button says.
    Agree,
    Discard,
    Cancel,
}

const BUTTON: egui::Vec2 = vec2(96.0, 28.0);
/// Maximum number of characters of a name in a heading.
const NAME: usize = 36;

impl Editor {
    /// Shows the open dialog.
    pub(super) fn show_dialogs(&mut self, ctx: &Context) {
        match self.dialogs.question.take() {
            Some(Question::Unsaved(next)) => self.ask_to_save(next, ctx),
            Some(Question::Rendering(next)) => self.ask_to_stop_rendering(next, ctx),
            Some(Question::Replace(path, then)) => self.ask_to_replace(path, then, ctx),
            None => {}
        }
        self.show_path_field(ctx);
    }

    fn ask_to_save(&mut self, next: Next, ctx: &Context) {
        let title = self.state.session.document.title();
        let name = title.trim_end_matches(" *").to_owned();
        let shown = question(ctx, ("Save the changes to", &name, "They are lost otherwise."), Some("Discard"), "Save");
        let enter = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Enter)) || wants_save(ctx);
        match shown.or(enter.then_some(DialogAnswer::Agree)) {
            None => self.dialogs.question = Some(Question::Unsaved(next)),
            Some(DialogAnswer::Agree) => self.save(Some(next), ctx),
            Some(DialogAnswer::Discard) => self.perform(next, ctx),
            Some(DialogAnswer::Cancel) => {}
        }
    }

    fn ask_to_stop_rendering(&mut self, next: Next, ctx: &Context) {
        if !self.is_rendering() {
            return self.unless_lost(next, ctx);
        }
        let name = self.rendering.output.clone();
        let name = Path::new(&name).file_name().map_or(name.clone(), |name| name.to_string_lossy().into_owned());
        let text = "It is not complete yet. Frames that are complete stay.";
        match question(ctx, ("Stop rendering", &name, text), None, "Stop") {
            None => self.dialogs.question = Some(Question::Rendering(next)),
            Some(DialogAnswer::Agree) => {
                self.rendering.running = None;
                self.unless_lost(next, ctx);
            }
            Some(_) => {}
        }
    }

    /// No default key here: the Enter that ended the path may arrive twice.
    fn ask_to_replace(&mut self, path: PathBuf, then: Option<Next>, ctx: &Context) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder = path.parent().unwrap_or(Path::new("")).display();
        let text = format!("There is a file of this name in {folder} already. What it holds is lost then.");
        match question(ctx, ("Replace", &name, &text), None, "Replace") {
            None => self.dialogs.question = Some(Question::Replace(path, then)),
            Some(DialogAnswer::Agree) => self.start_saving(&path, true, then),
            Some(_) => {
                let (purpose, text) = (Purpose::Save(then), path.display().to_string());
                self.dialogs.path_field = Some(PathField { purpose, text, focused: false, problem: None });
            }
        }
    }

    fn show_path_field(&mut self, ctx: &Context) {
        let Some(field) = &mut self.dialogs.path_field else { return };
        let mut done = None;
        let response = Modal::new(Id::unique("path")).frame(frame(ctx)).show(ctx, |ui| {
            ui.set_width(460.0);
            ui.label(RichText::new(field.purpose.title()).heading().color(theme::STRONG));
            ui.add_space(6.0);
            done = path_field(ui, field);
        });
        if response.should_close() {
            done = done.or(Some(false));
        }
        let Some(agreed) = done else { return };
        let path = PathBuf::from(field.text.trim());
        if agreed {
            field.problem = field.purpose.refusal(&path);
            if field.problem.is_some() {
                field.focused = false;
                return;
            }
        }
        if let Some(PathField { purpose, .. }) = self.dialogs.path_field.take().filter(|_| agreed) {
            self.chosen(purpose, &path, false, ctx);
        }
    }
}

/// The field and its buttons; returns whether the artist has agreed or canceled.
fn path_field(ui: &mut Ui, field: &mut PathField) -> Option<bool> {
    let mut done = None;
    let edit = TextEdit::singleline(&mut field.text)
        .hint_text("/path/to/file")
        .desired_width(f32::INFINITY)
        .margin(egui::Margin::symmetric(8, 6));
    let response = ui.add(edit);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Path"));
    if !field.focused {
        field.focused = true;
        response.request_focus();
        select_name(ui.ctx(), response.id, &field.text);
    }
    if response.changed() {
        field.problem = None;
    }
    let saves = matches!(field.purpose, Purpose::Save(_)) && wants_save(ui.ctx());
    if saves || (response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter))) {
        done = Some(true);
    }
    if let Some(problem) = &field.problem {
        ui.add(Label::new(RichText::new(problem).color(theme::ERROR)).wrap());
    }
    ui.add_space(10.0);
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let saves = matches!(field.purpose, Purpose::Save(_) | Purpose::RenderTo | Purpose::ExportKeys);
        let ok = if saves { "Save" } else { "Open" };
        if accented(ui, ok) {
            done = Some(true);
        }
        if ui.add(Button::new("Cancel").min_size(BUTTON)).clicked() {
            done = Some(false);
        }
    });
    done
}

/// A question about an object of this name; returns the answer.
fn question(
    ctx: &Context,
    (verb, name, text): (&str, &str, &str),
    discard: Option<&str>,
    agree: &str,
) -> Option<DialogAnswer> {
    let mut answer = None;
    let response = Modal::new(Id::unique("question").with(verb)).frame(frame(ctx)).show(ctx, |ui| {
        ui.set_width(380.0);
        ui.add_space(4.0);
        let short = widgets::elided(name, NAME);
        let title = RichText::new(format!("{verb} “{short}”?")).heading().color(theme::STRONG);
        let title = ui.add(Label::new(title).wrap());
        if short != name {
            title.on_hover_text(name);
        }
        ui.add_space(2.0);
        ui.add(Label::new(RichText::new(text).color(theme::WEAK)).wrap());
        ui.add_space(14.0);
        ui.horizontal(|ui| {
            if discard.is_some_and(|text| ui.add(Button::new(text).min_size(BUTTON)).clicked()) {
                answer = Some(DialogAnswer::Discard);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if accented(ui, agree) {
                    answer = Some(DialogAnswer::Agree);
                }
                if ui.add(Button::new("Cancel").min_size(BUTTON)).clicked() {
                    answer = Some(DialogAnswer::Cancel);
                }
            });
        });
    });
    answer.or(response.should_close().then_some(DialogAnswer::Cancel))
}

/// Ctrl S agrees if the question is about saving.
fn wants_save(ctx: &Context) -> bool {
    ctx.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::S))
}

fn accented(ui: &mut Ui, text: &str) -> bool {
    let text = RichText::new(text).color(theme::ON_ACCENT);
    ui.add(Button::new(text).fill(*theme::ACCENT).min_size(BUTTON)).clicked()
}

/// Selects the file's name without folder and extension, so that typing replaces it.
fn select_name(ctx: &Context, field: Id, path: &str) {
    let end = path.chars().count();
    let start = path.rfind('/').map_or(0, |i| path[..=i].chars().count());
    let stem = path.rfind('.').map_or(end, |i| path[..i].chars().count());
    let mut state = egui::text_edit::TextEditState::default();
    let [start, end] = [start, if stem > start { stem } else { end }].map(egui::text::CCursor::new);
    state.cursor.set_char_range(Some(egui::text::CCursorRange::two(start, end)));
    state.store(ctx, field);
}

fn frame(ctx: &Context) -> egui::Frame {
    egui::Frame::window(&ctx.global_style()).inner_margin(18.0)
}
