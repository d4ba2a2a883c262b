//! Messages to the artist: toasts that fade, and a log of the latest ones.

use std::collections::VecDeque;

use egui::{Align2, Area, Context, Frame, Id, Order, RichText, Ui, vec2};
use egui_material_icons::icons::{ICON_CHECK_CIRCLE, ICON_CLOSE, ICON_ERROR, ICON_INFO, ICON_WARNING};

use super::theme;

/// The severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Information.
    Info,
    /// An action has succeeded.
    Success,
    /// A problem that deserves attention.
    Warning,
    /// An action has failed.
    Error,
}

impl Severity {
    /// Its color.
    pub fn color(self) -> egui::Color32 {
        match self {
            Self::Info => *theme::ACCENT,
            Self::Success => *theme::SUCCESS,
            Self::Warning => *theme::WARNING,
            Self::Error => *theme::ERROR,
        }
    }

    /// Its icon, colored.
    pub fn icon(self) -> RichText {
        let icon = match self {
            Self::Info => ICON_INFO,
            Self::Success => ICON_CHECK_CIRCLE,
            Self::Warning => ICON_WARNING,
            Self::Error => ICON_ERROR,
        };
        icon.rich_text().color(self.color()).size(theme::ICON_SIZE)
    }

    /// Duration of its toast, in seconds.
    fn seconds(self) -> f64 {
        match self {
            Self::Info | Self::Success => 3.0,
            Self::Warning => 6.0,
            Self::Error => 10.0,
        }
    }
}

/// A message to the artist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its severity.
    pub severity: Severity,
    /// One or two plain sentences.
    pub text: String,
}

impl Message {
    /// An information.
    pub fn info(text: impl Into<String>) -> Self {
        Self { severity: Severity::Info, text: text.into() }
    }

    /// A success.
    pub fn success(text: impl Into<String>) -> Self {
        Self { severity: Severity::Success, text: text.into() }
    }

    /// A warning.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, text: text.into() }
    }

    /// An error.
    pub fn error(text: impl Into<String>) -> Self {
        Self { severity: Severity::Error, text: text.into() }
    }
}

struct LogEntry {
    message: Message,
    count: u32,
    /// End of its toast, in seconds of the program's clock; `None` until the toast is shown.
    until: Option<f64>,
    dismissed: bool,
}

/// The latest messages, newest last.
#[derive(Default)]
pub struct Messages {
    entries: VecDeque<LogEntry>,
}

impl Messages {
    const KEPT: usize = 200;
    const TOASTS: usize = 4;

    /// Adds a message. A repetition of the last message only increases its count.
    pub fn push(&mut self, message: Message) {
        if let Some(last) = self.entries.back_mut().filter(|e| e.message == message) {
            last.count += 1;
            last.until = None;
            last.dismissed = false;
            return;
        }
        self.entries.push_back(LogEntry { message, count: 1, until: None, dismissed: false });
        if self.entries.len() > Self::KEPT {
            self.entries.pop_front();
        }
    }

    /// All stored messages, oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Message> {
        self.entries.iter().map(|e| &e.message)
    }

    /// The last message, if it is a warning or an error whose toast was shown a short time ago.
    pub fn recent(&self, now: f64) -> Option<&Message> {
        const REMAINS: f64 = 20.0;
        let last = self
            .entries
            .back()
            .filter(|entry| !entry.dismissed && entry.until.is_none_or(|until| now < until + REMAINS))?;
        matches!(last.message.severity, Severity::Warning | Severity::Error).then_some(&last.message)
    }

    /// Shows the toasts in the lower right corner of `area`.
    pub fn show_toasts(&mut self, ctx: &Context, area: egui::Rect) {
        let now = ctx.input(|i| i.time);
        let mut offset = 12.0;
        for (index, entry) in self.entries.iter_mut().enumerate().rev().take(Self::TOASTS) {
            let until = *entry.until.get_or_insert(now + entry.message.severity.seconds());
            if entry.dismissed || now >= until {
                continue;
            }
            ctx.request_repaint_after_secs((until - now) as f32);
            let response = Area::new(Id::unique("toast").with(index))
                .order(Order::Foreground)
                .pivot(Align2::RIGHT_BOTTOM)
                .fixed_pos(area.right_bottom() - vec2(12.0, offset))
                .show(ctx, |ui| toast(ui, entry));
            offset += response.response.rect.height() + 8.0;
        }
    }

    /// Shows all messages, newest last.
    pub fn show_all(&self, ui: &mut Ui) {
        if self.entries.is_empty() {
            ui.label(RichText::new("No messages").color(theme::WEAK));
        }
        egui::ScrollArea::vertical().stick_to_bottom(true).auto_shrink(false).show(ui, |ui| {
            for entry in &self.entries {
                ui.horizontal_wrapped(|ui| {
                    ui.label(entry.message.severity.icon());
                    ui.label(entry.text());
                });
            }
        });
    }

    /// Forgets all messages.
    pub fn clear(&mut self) {
        self.entries.clear();
    }
}

impl LogEntry {
    fn text(&self) -> String {
        if self.count > 1 { format!("{} ({}×)", self.message.text, self.count) } else { self.message.text.clone() }
    }
}

fn toast(ui: &mut Ui, entry: &mut LogEntry) {
    let color = entry.message.severity.color();
    let frame = Frame::popup(ui.style()).inner_margin(10.0).stroke((1.0, color.gamma_multiply(0.5)));
    frame.show(ui, |ui| {
        ui.set_max_width(360.0);
        ui.horizontal(|ui| {
            ui.label(entry.message.severity.icon());
            ui.add(egui::Label::new(entry.text()).wrap());
            let close = egui::Button::new(ICON_CLOSE.rich_text().color(theme::WEAK)).frame(false);
            if ui.add(close).on_hover_text("Dismiss").clicked() {
                entry.dismissed = true;
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repeated_message_counts_up_and_the_log_is_bounded() {
        let mut messages = Messages::default();
        messages.push(Message::error("no"));
        messages.push(Message::error("no"));
        assert_eq!(messages.entries.len(), 1);
        assert_eq!(messages.entries[0].text(), "no (2×)");
        for i in 0..1_000 {
            messages.push(Message::info(i.to_string()));
        }
        assert_eq!(messages.entries.len(), Messages::KEPT);
        assert_eq!(messages.iter().next_back(), Some(&Message::info("999")));
    }
}
