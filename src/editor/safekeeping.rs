//! State of the recovery of unsaved work, and the list of lost work.

use std::collections::HashMap;
use std::time::SystemTime;

use egui::{
    Button, ColorImage, Context, Id, Key, Modal, Rect, RichText, ScreenshotCallback, TextureHandle, TextureOptions, Ui,
    ViewportCommand, vec2,
};

use super::theme;
use isolith_document::recovery::{Lost, ReadSnapshot, Recovery, Thumbnail};
use isolith_jobs::Job;

/// Size of a thumbnail in the list.
const PICTURE_SIZE: egui::Vec2 = vec2(144.0, 90.0);

/// The recovery store with the state of its list.
pub struct Safekeeping {
    /// Keeps and finds unsaved work.
    pub recovery: Recovery,
    /// Lost work of other processes. This process owns it and may offer it until it lets it go.
    pub lost: Vec<Lost>,
    /// The lost document being read.
    pub reading: Option<Job<(Lost, ReadSnapshot)>>,
    textures: HashMap<String, TextureHandle>,
    /// Whether the list is open.
    pub is_open: bool,
    /// The id of the entry whose Discard button waits for a second click.
    pub confirming: Option<String>,
    /// The last revision seen.
    pub seen: Option<u64>,
    /// Time of the first change after the last thumbnail, in seconds of the program's clock.
    pub changed_at: f64,
    /// Time of the last thumbnail, in seconds of the program's clock.
    pub pictured_at: f64,
    /// The last thumbnail shows the current revision.
    pub is_pictured: bool,
}

/// The artist's decision about lost work.
pub enum RecoveryChoice {
    /// Open the entry of this index.
    Recover(usize),
    /// Discard the entry of this index.
    Discard(usize),
    /// Decide later.
    Later,
}

impl Safekeeping {
    /// Keeps unsaved work by `recovery` and offers the lost work there.
    pub fn new(recovery: Recovery) -> Self {
        let lost = recovery.lost();
        Self {
            is_open: !lost.is_empty(),
            recovery,
            lost,
            reading: None,
            textures: HashMap::new(),
            confirming: None,
            seen: None,
            changed_at: 0.0,
            pictured_at: f64::NEG_INFINITY,
            is_pictured: true,
        }
    }

    /// Shows the list; returns the decision.
    pub fn show(&mut self, ctx: &Context, may_open: bool) -> Option<RecoveryChoice> {
        for lost in &self.lost {
            if let Some(picture) = lost.picture().filter(|_| !self.textures.contains_key(&lost.id())) {
                let image = ColorImage::from_rgb(picture.size_px().map(|side| side as usize), picture.bytes());
                let texture = ctx.load_texture("lost work", image, TextureOptions::LINEAR);
                self.textures.insert(lost.id(), texture);
            }
        }
        let mut choice = None;
        let frame = egui::Frame::window(&ctx.global_style()).inner_margin(18.0);
        let response = Modal::new(Id::unique("lost work")).frame(frame).show(ctx, |ui| {
            ui.set_width(620.0);
            ui.label(RichText::new("Recover unsaved work?").heading().color(theme::STRONG));
            ui.add_space(2.0);
            let text = match may_open {
                true => "Isolith has ended before this was saved.",
                false => "Save or undo the changes to the open scene before you recover another one.",
            };
            ui.label(RichText::new(text).color(theme::WEAK));
            ui.add_space(10.0);
            egui::ScrollArea::vertical().max_height(360.0).show(ui, |ui| {
                for index in 0..self.lost.len() {
                    choice = self.row(ui, index, may_open).or(choice.take());
                    ui.add_space(8.0);
                }
            });
            ui.add_space(6.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.add(Button::new("Decide later").min_size(vec2(110.0, 28.0))).clicked() {
                    choice = Some(RecoveryChoice::Later);
                }
            });
        });
        if may_open && ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Enter)) {
            choice = choice.or(Some(RecoveryChoice::Recover(0)));
        }
        if response.should_close() {
            choice = choice.or(Some(RecoveryChoice::Later));
        }
        choice
    }

    fn row(&mut self, ui: &mut Ui, index: usize, may_open: bool) -> Option<RecoveryChoice> {
        let lost = &self.lost[index];
        let (id, name) = (lost.id(), lost.name().to_owned());
        let mut choice = None;
        ui.horizontal(|ui| {
            let (space, _) = ui.allocate_exact_size(PICTURE_SIZE, egui::Sense::hover());
            ui.painter().rect_filled(space, theme::RADIUS, theme::LINE);
            if let Some(texture) = self.textures.get(&id) {
                let size = texture.size_vec2() * (PICTURE_SIZE / texture.size_vec2()).min_elem();
                let whole = Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
                let at = Rect::from_center_size(space.center(), size);
                ui.painter().image(texture.id(), at, whole, egui::Color32::WHITE);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let size = vec2(92.0, 28.0);
                let text = RichText::new("Recover").color(theme::ON_ACCENT);
                let button = ui.add_enabled(may_open, Button::new(text).fill(*theme::ACCENT).min_size(size));
                ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(format!("Recover {name}")));
                if button.clicked() {
                    choice = Some(RecoveryChoice::Recover(index));
                }
                let is_asked = self.confirming.as_deref() == Some(&*id);
                let (text, color) = if is_asked { ("Really discard", theme::ERROR) } else { ("Discard", theme::TEXT) };
                let button = ui.add(Button::new(RichText::new(text).color(color)).min_size(size));
                ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(format!("{text} {name}")));
                if button.clicked() {
                    match is_asked {
                        true => choice = Some(RecoveryChoice::Discard(index)),
                        false => self.confirming = Some(id.clone()),
                    }
                }
                ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| {
                    ui.add_space(16.0);
                    ui.add(egui::Label::new(RichText::new(&name).color(theme::STRONG)).truncate());
                    let when = format!("{}, {}", age(lost.changed(), SystemTime::now()), date(lost.changed()));
                    ui.add(egui::Label::new(RichText::new(when).color(theme::WEAK)).truncate());
                    let path = lost.path().map_or("never saved".into(), |path| path.display().to_string());
                    ui.add(egui::Label::new(RichText::new(path).color(theme::WEAK)).truncate());
                });
            });
        });
        choice
    }
}

/// Captures the part of the window in `area`, in pixels, and passes it to `give`.
pub fn take_picture(ctx: &Context, area: Rect, give: impl Fn(Thumbnail) + Send + 'static) {
    let callback = ScreenshotCallback::new(move |image| {
        let window = Rect::from_min_size(egui::Pos2::ZERO, vec2(image.width() as f32, image.height() as f32));
        let area = area.intersect(window);
        if !area.is_positive() {
            return;
        }
        let corner = [area.min.x as usize, area.min.y as usize];
        let size = [area.width() as u32, area.height() as u32];
        let pixel = |x: u32, y: u32| {
            let [r, g, b, _] = image[(corner[0] + x as usize, corner[1] + y as usize)].to_array();
            [r, g, b]
        };
        if let Some(picture) = Thumbnail::of(size, pixel) {
            give(picture);
        }
    });
    ctx.send_viewport_cmd(ViewportCommand::Screenshot(callback));
}

/// The age in words.
fn age(then: SystemTime, now: SystemTime) -> String {
    let minutes = now.duration_since(then).unwrap_or_default().as_secs() / 60;
    let (count, unit) = match minutes {
        0 => return "just now".into(),
        1..60 => (minutes, "minute"),
        60..1_440 => (minutes / 60, "hour"),
        _ => (minutes / 1_440, "day"),
    };
    format!("{count} {unit}{} ago", if count == 1 { "" } else { "s" })
}

/// Date and time of day, in UTC because the time zone is unknown.
fn date(then: SystemTime) -> String {
    let seconds = then.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_secs();
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    // Count days from 1 March of the year 0, in eras of 400 years, so that the leap day comes last.
    let days = days + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = era * 400 + year + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02} {:02}:{:02} UTC", rest / 3_600, rest / 60 % 60)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn times_are_told_in_words_and_by_date() {
        let at = |seconds: u64| SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        for (passed, words) in [
            (0, "just now"),
            (59, "just now"),
            (60, "1 minute ago"),
            (3_599, "59 minutes ago"),
            (3_600, "1 hour ago"),
            (90_000, "1 day ago"),
            (900_000, "10 days ago"),
        ] {
            assert_eq!(age(at(1_000), at(1_000 + passed)), words);
        }
        assert_eq!(age(at(2_000), at(1_000)), "just now", "a clock that was set back");
        for (seconds, text) in [
            (0, "1970-01-01 00:00 UTC"),
            (951_782_399, "2000-02-28 23:59 UTC"),
            (951_782_400, "2000-02-29 00:00 UTC"),
            (951_868_800, "2000-03-01 00:00 UTC"),
            (1_735_689_599, "2024-12-31 23:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00 UTC"),
        ] {
            assert_eq!(date(at(seconds)), text);
        }
    }
}
