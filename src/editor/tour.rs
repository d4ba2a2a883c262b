//! The tour: six steps through the window, each beside what it is about. It never stands in the way: the scene can be
//! edited meanwhile.

use egui::{Align, Align2, Area, Button, Context, Frame, Id, Layout, Order, Rect, RichText, vec2};

use super::state::EditorState;
use super::theme;

/// Width of the text, in points.
const WIDTH: f32 = 330.0;

/// The part of the window that a step is about.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Viewport,
    Above,
    Left,
    Right,
    Below,
}

struct Step {
    title: &'static str,
    text: &'static str,
    part: Part,
}

const STEPS: [Step; 6] = [
    Step {
        title: "Look around",
        text: "Drag in the picture to turn the view, drag with Shift to move it, and turn the wheel to come closer. \
               Home shows everything, F what is selected.",
        part: Part::Viewport,
    },
    Step {
        title: "Add shapes",
        text: "Press Shift A where something shall stand: it stands on what is under the pointer. The buttons up here \
               are your favorites; the stars of that list choose them.",
        part: Part::Above,
    },
    Step {
        title: "Move and shape",
        text: "Click a thing to select it, then press G, R or S to move, turn or scale it: X, Y, Z and numbers work. \
               Drag the dots on it to change its size. Ctrl snaps, Shift is precise, Esc takes it back.",
        part: Part::Viewport,
    },
    Step {
        title: "Combine",
        text: "Select several things and press U, I or D to join, intersect or subtract them. The order in this list \
               counts: what stands first is cut by what follows. Drag rows to change it.",
        part: Part::Left,
    },
    Step {
        title: "Change everything",
        text: "Here stands all about what is selected: blends, modifiers, materials, motion. Drag a number or type it, \
               3*2 works. The diamond beside a value animates it.",
        part: Part::Right,
    },
    Step {
        title: "Animate and render",
        text: "Space plays the timeline. F12 renders pictures into files. F3 finds every command by its name, F10 \
               finds what is wrong or slow, and F1 explains each panel. Ctrl Z takes anything back.",
        part: Part::Below,
    },
];

/// State of the tour.
#[derive(Default)]
pub struct Tour {
    step: Option<usize>,
}

impl Tour {
    /// Begins with the first step.
    pub fn start(&mut self) {
        self.step = Some(0);
    }

    /// Ends it; false if it has not begun.
    pub fn end(&mut self) -> bool {
        self.step.take().is_some()
    }

    /// Shows the step.
    pub fn show(&mut self, state: &EditorState, ctx: &Context) {
        let Some(index) = self.step else { return };
        let Some(step) = STEPS.get(index) else {
            self.step = None;
            return;
        };
        let part = rect_of(step.part, state.view.rect, ctx.content_rect());
        let painter = ctx.layer_painter(egui::LayerId::new(Order::Foreground, Id::unique("tour frame")));
        painter.rect_stroke(part.shrink(2.0), 6.0, (2.0, theme::ACCENT), egui::StrokeKind::Inside);
        let (pivot, anchor) = match step.part {
            Part::Viewport => (Align2::CENTER_BOTTOM, part.center_bottom() - vec2(0.0, 24.0)),
            Part::Above => (Align2::CENTER_TOP, part.center_bottom() + vec2(0.0, 14.0)),
            Part::Left => (Align2::LEFT_CENTER, part.right_center() + vec2(14.0, 0.0)),
            Part::Right => (Align2::RIGHT_CENTER, part.left_center() - vec2(14.0, 0.0)),
            Part::Below => (Align2::CENTER_BOTTOM, part.center_top() - vec2(0.0, 14.0)),
        };
        let mut next = Some(index);
        let area = Area::new(Id::unique("tour")).order(Order::Foreground).pivot(pivot).fixed_pos(anchor);
        area.constrain(true).show(ctx, |ui| {
            Frame::window(ui.style()).inner_margin(16.0).show(ui, |ui| {
                ui.set_width(WIDTH);
                ui.label(RichText::new(step.title).heading().color(ui.visuals().strong_text_color()));
                ui.add_space(2.0);
                ui.add(egui::Label::new(step.text).wrap());
                ui.add_space(10.0);
                ui.horizontal(|ui| {
                    ui.label(RichText::new(format!("{} of {}", index + 1, STEPS.len())).weak());
                    if ui.button("Skip the tour").clicked() {
                        next = None;
                    }
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        let text = if index + 1 == STEPS.len() { "Done" } else { "Next" };
                        let button = Button::new(RichText::new(text).color(theme::ON_ACCENT)).fill(*theme::ACCENT);
                        if ui.add(button.min_size(vec2(70.0, 26.0))).clicked() {
                            next = Some(index + 1).filter(|next| *next < STEPS.len());
                        }
                        if index > 0 && ui.add(Button::new("Back").min_size(vec2(60.0, 26.0))).clicked() {
                            next = Some(index - 1);
                        }
                    });
                });
            });
        });
        self.step = next;
    }
}

/// The rectangle of a part: what the viewport leaves on that side, or the viewport if it leaves nothing.
fn rect_of(part: Part, view: Rect, window: Rect) -> Rect {
    let rect = match part {
        Part::Viewport => view,
        Part::Above => window.with_max_y(view.top()),
        Part::Left => Rect::from_min_max(egui::pos2(window.left(), view.top()), view.left_bottom()),
        Part::Right => Rect::from_min_max(view.right_top(), egui::pos2(window.right(), view.bottom())),
        Part::Below => window.with_min_y(view.bottom()),
    };
    if rect.width() < 20.0 || rect.height() < 12.0 { view } else { rect }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_point_at_what_surrounds_the_viewport() {
        let window = Rect::from_min_size(egui::Pos2::ZERO, vec2(1000.0, 800.0));
        let view = Rect::from_min_max(egui::pos2(200.0, 80.0), egui::pos2(700.0, 600.0));
        assert_eq!(rect_of(Part::Left, view, window).max, egui::pos2(200.0, 600.0));
        assert_eq!(rect_of(Part::Below, view, window).min, egui::pos2(0.0, 600.0));
        assert_eq!(rect_of(Part::Right, view.with_max_x(1000.0), window), view.with_max_x(1000.0), "nothing is there");
        assert!(STEPS.iter().all(|step| step.text.len() < 260), "a step is read at a glance");
    }
}
