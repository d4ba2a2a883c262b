//! Lists of points: a row of numbers for each point, in a scroll area of its own.

use egui::{Id, RichText, ScrollArea, Ui, vec2};

use super::numbers::{self, NumberField};
use super::theme;
use isolith_scene::{Limits, List};

/// Maximum height of the list, in screen points.
const MOST_HEIGHT: f32 = 220.0;
/// Width of the button in front of each row.
const NUMBER_WIDTH: f32 = 30.0;

/// An action on a row.
#[derive(Clone, Copy)]
enum PointChange {
    Set(usize, f64),
    Insert,
    Remove,
    Up,
    Down,
}

/// A change of one row of a list.
#[derive(Clone, Copy)]
pub struct PointEdit {
    index: usize,
    change: PointChange,
}

impl PointEdit {
    /// Applies the change if the list has such a row.
    pub fn apply(self, list: &mut List) {
        if self.index < list.rows.len() {
            apply(list, self.index, self.change);
        }
    }
}

/// The points of a parameter. The button in front of a row adds, removes and moves.
pub fn list(ui: &mut Ui, field: &NumberField<'_>, shown: &List, is_mixed: bool) -> Option<(Id, PointEdit)> {
    let label = field.label;
    if is_mixed {
        super::widgets::row(ui, label, field.help, |ui| {
            ui.label(super::widgets::MIXED).on_hover_text("Different points: choose one node to edit its own");
        });
        return None;
    }
    ui.horizontal(|ui| {
        ui.label(RichText::new(label).color(theme::WEAK)).on_hover_text(field.help);
        ui.label(RichText::new(format!("{}, {}", shown.rows.len(), shown.columns.join(" "))).color(theme::WEAK));
    });
    let mut done = None;
    ScrollArea::vertical().id_salt(label).max_height(MOST_HEIGHT).show(ui, |ui| {
        for index in 0..shown.rows.len() {
            if let Some((widget, change)) = row(ui, shown, index, &field.limits) {
                done = Some((widget, PointEdit { index, change }));
            }
        }
    });
    done
}

fn row(ui: &mut Ui, list: &List, index: usize, limits: &Limits) -> Option<(Id, PointChange)> {
    let mut done = None;
    ui.horizontal(|ui| {
        let gap = 4.0;
        ui.spacing_mut().item_spacing.x = gap;
        ui.spacing_mut().button_padding.x = 4.0;
        let count = list.columns.len() as f32;
        let width = ((ui.available_width() - NUMBER_WIDTH - (count + 2.0) * gap) / count).floor().max(20.0);
        let button = egui::Button::new(format!("{}", index + 1)).min_size(vec2(NUMBER_WIDTH, theme::ROW_HEIGHT));
        let response = egui::containers::menu::MenuButton::from_button(button).ui(ui, |ui| {
            let choices = [
                ("Add behind", PointChange::Insert, list.rows.len() < list.count[1]),
                ("Remove", PointChange::Remove, list.rows.len() > list.count[0]),
                ("Move up", PointChange::Up, index > 0),
                ("Move down", PointChange::Down, index + 1 < list.rows.len()),
            ];
            for (text, change, allowed) in choices {
                let entry = ui.add_enabled(allowed, egui::Button::new(text));
                if entry.clicked() {
                    done = Some((entry.id, change));
                    ui.close();
                }
            }
        });
        let name = format!("Point {}", index + 1);
        ui.ctx().accesskit_node_builder(response.0.id, |node| node.set_label(name.clone()));
        response.0.on_hover_text("Adds a point behind it, removes or moves it");
        for (column, title) in list.columns.iter().enumerate() {
            let label = format!("{name} {title}");
            // No unit: there is room only for the number.
            let limits = Limits { unit: "", ..list.limits(column, limits) };
            let field = NumberField { label: &label, help: title, limits, default: None };
            let answer = numbers::number(ui, &field, &label, list.rows[index][column], false, width);
            if let Some(value) = answer.value {
                done = Some((answer.widget, PointChange::Set(column, value)));
            }
        }
    });
    done
}

fn apply(list: &mut List, index: usize, change: PointChange) {
    match change {
        PointChange::Set(column, value) => list.rows[index][column] = value,
        PointChange::Remove if list.rows.len() > list.count[0] => drop(list.rows.remove(index)),
        PointChange::Up if index > 0 => list.rows.swap(index, index - 1),
        PointChange::Down if index + 1 < list.rows.len() => list.rows.swap(index, index + 1),
        PointChange::Insert if list.rows.len() < list.count[1] => {
            // Half-way to the next point, or beyond the last point by its distance to the point before.
            let here = list.rows[index];
            let other = list.rows.get(index + 1).or(list.rows.get(index.wrapping_sub(1))).copied().unwrap_or(here);
            let share = if index + 1 < list.rows.len() { 0.5 } else { -1.0 };
            let mut new: [f64; 4] = std::array::from_fn(|c| here[c] + (other[c] - here[c]) * share);
            new[3] = new[3].max(0.0);
            list.rows.insert(index + 1, new);
        }
        PointChange::Remove | PointChange::Up | PointChange::Down | PointChange::Insert => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(count: usize) -> List {
        let rows = (0..count).map(|i| [i as f64, 0.0, 0.0, 0.1]).collect();
        List { rows, columns: &["X", "Y", "Z", "Radius"], count: [2, 4] }
    }

    #[test]
    fn rows_are_added_removed_and_moved_within_the_limits() {
        let firsts = |list: &List| list.rows.iter().map(|row| row[0]).collect::<Vec<_>>();
        let after = |count, index, change| {
            let mut list = sample(count);
            apply(&mut list, index, change);
            firsts(&list)
        };
        assert_eq!(after(3, 0, PointChange::Insert), [0.0, 0.5, 1.0, 2.0]);
        assert_eq!(after(3, 2, PointChange::Insert), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(after(4, 2, PointChange::Insert), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(after(3, 1, PointChange::Remove), [0.0, 2.0]);
        assert_eq!(after(2, 1, PointChange::Remove), [0.0, 1.0]);
        assert_eq!(after(3, 1, PointChange::Up), [1.0, 0.0, 2.0]);
        assert_eq!(after(3, 1, PointChange::Down), [0.0, 2.0, 1.0]);
        assert_eq!(after(3, 0, PointChange::Up), [0.0, 1.0, 2.0]);
        assert_eq!(after(3, 1, PointChange::Set(0, 7.0)), [0.0, 7.0, 2.0]);
    }
}
