//! Number fields: drag, type, reset. Typed text takes effect at the end of typing, except after Escape.

use std::cell::RefCell;

use egui::{Context, DragValue, Event, Id, Key, Response, RichText, Ui, vec2};

use super::steps::rounded;
use super::theme;
use super::theme::MIXED;
use super::units::{FieldUnit, LengthUnit};
use isolith_scene::Limits;
use isolith_scene::limits::Rule;

/// The description of a number field.
#[derive(Clone, Copy)]
pub struct NumberField<'a> {
    /// The label on its left.
    pub label: &'a str,
    /// One sentence, as a tooltip.
    pub help: &'a str,
    /// Soft limits for dragging, hard limits for typing.
    pub limits: Limits,
    /// The reset value; `None` if there is no natural one.
    pub default: Option<f64>,
}

impl NumberField<'_> {
    /// Rounds and clamps a number to the limits.
    fn taken(&self, value: f64) -> f64 {
        let Limits { soft, hard: [least, _], rule, .. } = self.limits;
        let value = if rule == Rule::Whole { value.round() } else { value };
        let [low, high] = self.limits.signed_range();
        let value = value.clamp(low, high);
        // The smallest allowed magnitude keeps the sign.
        if rule == Rule::Magnitude && value.abs() < least { soft[0].copysign(value) } else { value }
    }
}

/// The response of a number field.
pub struct FieldResponse {
    /// Identifies the gesture.
    pub widget: Id,
    /// The new value, if the artist has changed it.
    pub value: Option<f64>,
}

/// A number field of the given width. `mixed` shows a dash until the value changes.
pub fn number(ui: &mut Ui, field: &NumberField<'_>, name: &str, value: f64, mixed: bool, width: f32) -> FieldResponse {
    prefixed_number(ui, field, name, value, mixed, width, None)
}

fn prefixed_number(
    ui: &mut Ui,
    field: &NumberField<'_>,
    name: &str,
    value: f64,
    mixed: bool,
    width: f32,
    axis: Option<usize>,
) -> FieldResponse {
    let (Limits { soft, unit, .. }, hard) = (field.limits, field.limits.signed_range());
    let unit = FieldUnit::new(unit, LengthUnit::of(ui.ctx()));
    let dragged = ui.ctx().is_being_dragged(ui.next_auto_id());
    // A value typed beyond the soft range must not jump when a drag begins.
    let range = if dragged { soft[0].min(value)..=soft[1].max(value) } else { hard[0]..=hard[1] };
    let mut edited = value;
    let typed = RefCell::new(None);
    // A third of a row has room for fewer digits.
    let text_of = if axis.is_some() { narrow_text } else { number_text };
    let shown = if mixed { MIXED.to_owned() } else { text_of(value / unit.one) };
    let was_canceled = canceled(ui, ui.next_auto_id());
    let parse = |text: &str| {
        if was_canceled {
            return None;
        }
        typed.replace(Some(text.to_owned()));
        // Unchanged text keeps the digits beyond those shown.
        if text == shown { (!mixed).then_some(value) } else { unit.typed(text) }
    };
    let mut drag = DragValue::new(&mut edited)
        .range(range)
        .clamp_existing_to_range(false)
        .update_while_editing(false)
        .speed(drag_speed(soft, value))
        .max_decimals(4)
        .min_size(vec2(width, theme::ROW_HEIGHT))
        .clip_text(true)
        .custom_formatter(move |value, _| if mixed { MIXED.into() } else { text_of(value / unit.one) })
        .custom_parser(parse);
    if !unit.sign.is_empty() && axis.is_none() {
        drag = drag.suffix(RichText::new(format!(" {}", unit.sign)).color(theme::WEAK));
    }
    let response = ui.add(drag);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
    if let Some(axis) = axis {
        paint_axis_mark(ui, &response, axis);
    }
    let escaped = ui.input(|i| i.key_pressed(Key::Escape));
    if response.lost_focus() && escaped {
        cancel(ui, response.id);
    }
    let is_done = response.lost_focus() && !escaped;
    let finished = typed.take().filter(|text| is_done && *text != shown);
    let mut answer =
        FieldResponse { widget: response.id, value: (response.changed() && edited != value).then_some(edited) };
    if let Some(text) = finished {
        if mixed {
            // Even if the number equals the value of the active node, the other nodes must get it.
            answer.value = unit.typed(&text);
        }
        refuse(ui, response.id, refusal(name, &text, field, unit));
    }
    answer.value = answer.value.map(|value| field.taken(value));
    let chosen = from_menu(ui, &response, field, value, unit).map(|value| field.taken(value));
    answer.value = by_wheel(ui, &response, field, value).or(chosen).or(answer.value);
    if !field.help.is_empty() && !dragged {
        response.on_hover_text(field.help);
    }
    answer
}

/// Number of passes in which egui takes the text of a field after it has lost the focus, even by Escape.
const PASSES_OF_LOSS: u64 = 2;

fn cancel(ui: &Ui, widget: Id) {
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|d| d.insert_temp(widget.with("canceled"), pass));
}

fn canceled(ui: &Ui, widget: Id) -> bool {
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data(|d| d.get_temp::<u64>(widget.with("canceled"))).is_some_and(|before| pass <= before + PASSES_OF_LOSS)
}

/// As many digits as needed: no decimals for whole numbers, at most four in general, more for small numbers.
pub fn number_text(value: f64) -> String {
    const DECIMALS: i32 = 4;
    // With more decimals than this, only scientific notation is readable.
    const MOST_DECIMALS: i32 = 9;
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return "0".into();
    }
    let decimals = if size < 1e-3 { DECIMALS - 1 - size.log10().floor() as i32 } else { DECIMALS };
    if decimals > MOST_DECIMALS {
        // Angles derived from a rotation have errors of this size.
        return if size < 1e-9 { "0".into() } else { format!("{value:.3e}") };
    }
    let text = format!("{value:.0$}", decimals as usize);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Why a field does not take the typed text as it is; `None` if it does.
fn refusal(name: &str, typed: &str, field: &NumberField<'_>, unit: FieldUnit) -> Option<String> {
    let [least, most] = field.limits.signed_range();
    let with_unit = |number: f64| format!("{} {}", number / unit.one, unit.sign).trim_end().to_owned();
    match unit.typed(typed) {
        None => Some(format!("{name}: “{typed}” is not a number, so it stays as it was.")),
        Some(value) if value < least => {
            Some(format!("{name}: {typed} is less than {}, the least there can be.", with_unit(least)))
        }
        Some(value) if value > most => {
            Some(format!("{name}: {typed} is more than {}, the most there can be.", with_unit(most)))
        }
        Some(value) if field.taken(value) != value => {
            let taken = with_unit(field.taken(value));
            let rounded = field.taken(value) == value.round() && value != value.round();
            let reason = if rounded { "is no whole number" } else { "is not possible" };
            Some(format!("{name}: {typed} {reason}; it is {taken} now."))
        }
        Some(_) => None,
    }
}

/// Key of the refusal for the editor.
fn refused() -> Id {
    Id::unique("what was typed and refused")
}

/// Stores a refusal for the editor. A field ends its edit in two passes: store it only once.
pub fn refuse(ui: &Ui, widget: Id, reason: Option<String>) {
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data_mut(|d| {
        let told = widget.with("refused");
        if reason.is_none() || d.get_temp::<u64>(told).is_some_and(|before| pass <= before + PASSES_OF_LOSS) {
            return;
        }
        d.insert_temp(told, pass);
        d.insert_temp(refused(), reason.unwrap_or_default());
    });
}

/// Takes the latest refusal, to report it.
pub fn take_refusal(ctx: &Context) -> Option<String> {
    ctx.data_mut(|d| d.remove_temp(refused()))
}

/// The number with as many decimals as a third of a row has room for; what is not 0 never becomes 0, but for what rounding
/// leaves.
fn narrow_text(value: f64) -> String {
    const MOST: usize = 6;
    // Of a turn by 180 degrees, three millionths of a degree may be left.
    if value.abs() < 1e-6 {
        return "0".into();
    }
    if value.abs() >= 1e6 || value.abs() < 1e-4 {
        return format!("{value:.1e}").replace(".0e", "e");
    }
    let text = number_text(value);
    if text.len() <= MOST {
        return text;
    }
    let shorter = [1e-3, 1e-2, 0.1, 1.0].map(|step| number_text(rounded(value, step)));
    let mut fitting = shorter.into_iter().filter(|short| short.len() <= MOST && short != "0");
    fitting.next().unwrap_or(text)
}

/// Three numbers side by side, marked in the axes' colors. Returns the index of the changed axis.
pub fn vector(
    ui: &mut Ui,
    field: &NumberField<'_>,
    values: [f64; 3],
    mixed: [bool; 3],
) -> Option<(usize, FieldResponse)> {
    let gap = 4.0;
    let width = ((ui.available_width() - 2.0 * gap) / 3.0).floor();
    let mut changed = None;
    ui.spacing_mut().item_spacing.x = gap;
    ui.spacing_mut().button_padding.x = 4.0;
    for axis in 0..3 {
        let name = format!("{} {}", field.label, ["X", "Y", "Z"][axis]);
        let answer = prefixed_number(ui, field, &name, values[axis], mixed[axis], width, Some(axis));
        if answer.value.is_some() {
            changed = Some((axis, answer));
        }
    }
    changed
}

/// Change per point of a drag: 700 points cross the soft range, or 20 units of it; large values change faster.
fn drag_speed(soft: [f64; 2], value: f64) -> f64 {
    let crossing = 700.0;
    let span = (soft[1] - soft[0]).min(20.0);
    (span / crossing).max(value.abs() * 0.004)
}

fn paint_axis_mark(ui: &Ui, response: &Response, axis: usize) {
    let rect = response.rect;
    let bar = egui::Rect::from_min_max(rect.left_top() + vec2(0.0, 5.0), rect.left_bottom() + vec2(2.5, -5.0));
    ui.painter().rect_filled(bar, 1.0, theme::AXES[axis]);
}

/// Key of the number that was copied last.
fn copied() -> Id {
    Id::unique("number copied last")
}

/// The value that the artist chooses by the context menu, or by Backspace over the field: the default, or the one that
/// was copied.
fn from_menu(ui: &Ui, response: &Response, field: &NumberField<'_>, value: f64, unit: FieldUnit) -> Option<f64> {
    let mut chosen = None;
    response.context_menu(|ui| {
        if let Some(default) = field.default {
            let text = format!("Reset to {} {}", number_text(default / unit.one), unit.sign);
            if ui.button(text.trim_end()).clicked() {
                chosen = Some(default);
                ui.close();
            }
        }
        if ui.button("Copy value").clicked() {
            ui.ctx().copy_text(value.to_string());
            ui.data_mut(|d| d.insert_temp(copied(), value));
            ui.close();
        }
        let copied = ui.data(|d| d.get_temp::<f64>(copied()));
        let text = copied.map_or_else(
            || "Paste value".into(),
            |v| format!("Paste value {} {}", number_text(v / unit.one), unit.sign),
        );
        if ui.add_enabled(copied.is_some(), egui::Button::new(text.trim_end())).clicked() {
            chosen = copied;
            ui.close();
        }
    });
    let typing = ui.ctx().text_edit_focused();
    let resets = !typing && response.hovered() && ui.input(|i| i.key_pressed(Key::Backspace));
    chosen.or(field.default.filter(|_| resets))
}

/// The value after turns of the wheel with Ctrl, which egui takes for a zoom; without Ctrl the panel scrolls.
fn by_wheel(ui: &Ui, response: &Response, field: &NumberField<'_>, value: f64) -> Option<f64> {
    if !response.hovered() || !response.enabled() {
        return None;
    }
    let (turns, precise) = ui.input(|i| {
        let turn = |event: &Event| match event {
            Event::MouseWheel { delta, modifiers, .. } if modifiers.command && delta.y != 0.0 => delta.y.signum(),
            _ => 0.0,
        };
        (i.events.iter().map(turn).sum::<f32>(), i.modifiers.shift)
    });
    if turns == 0.0 {
        return None;
    }
    // A round step of about a fiftieth of the value or of the range that is dragged.
    let step = drag_speed(field.limits.soft, value) * if precise { 1.0 } else { 10.0 };
    let step = if field.limits.rule == Rule::Whole { 1.0 } else { 10.0_f64.powf(step.log10().round()) };
    Some(field.taken(rounded(value + f64::from(turns) * step, step)))
}

#[cfg(test)]
mod tests {
    use super::super::expression;
    use super::*;
    use isolith_scene::limits::{SCALE, SIDES, SIZE};

    #[test]
    fn whole_numbers_have_no_decimals_and_zero_has_no_sign() {
        for (value, text) in [
            (2.0, "2"),
            (-3.0, "-3"),
            (2.5, "2.5"),
            (100.0, "100"),
            (1.0 / 3.0, "0.3333"),
            (0.0, "0"),
            (-0.0, "0"),
            (-1e-12, "0"),
            (29.999_999_999, "30"),
            (-0.000_04, "-0.00004"),
            (0.000_012_34, "0.00001234"),
            (2.5e-8, "2.500e-8"),
            (1e6, "1000000"),
        ] {
            assert_eq!(number_text(value), text, "{value}");
        }
    }

    #[test]
    fn three_numbers_fit_side_by_side() {
        for (value, text) in [
            (58.0693, "58.069"),
            (-11.7198, "-11.72"),
            (-0.322_14, "-0.322"),
            (0.0592, "0.0592"),
            (-4e-5, "-4e-5"),
            (3.1e-8, "0"),
            (1e9, "1e9"),
            (-1.26e7, "-1.3e7"),
        ] {
            assert_eq!(narrow_text(value), text);
        }
    }

    #[test]
    fn what_is_shown_can_be_typed() {
        for value in [0.1, -7.25, 1e-4, 3e-8, 123_456.789, 1e9] {
            let typed = expression::evaluate(&number_text(value)).unwrap();
            assert!((typed - value).abs() <= 1e-4_f64.min(value.abs() * 1e-3), "{value}: {typed}");
        }
    }

    #[test]
    fn what_becomes_of_a_number_is_said() {
        let field = |limits| NumberField { label: "", help: "", limits, default: None };
        let said = |typed, field: &NumberField<'_>| {
            refusal("N", typed, field, FieldUnit::new(field.limits.unit, LengthUnit::Meters))
        };
        assert_eq!(said("5", &field(SIDES)), None);
        assert_eq!(said("5.4", &field(SIDES)).unwrap(), "N: 5.4 is no whole number; it is 5 now.");
        assert!(said("2", &field(SIDES)).unwrap().contains("is less than 3"));
        assert!(said("1/0", &field(SIZE)).unwrap().contains("is not a number"));
        assert_eq!(said("0", &field(SCALE)).unwrap(), "N: 0 is not possible; it is 0.01 now.");
        assert_eq!(said("-2", &field(SCALE)), None);
        assert!(said("-2e6", &field(SCALE)).unwrap().contains("is less than -1000000"));
    }

    #[test]
    fn a_magnitude_of_zero_keeps_its_sign_and_becomes_small() {
        let field = NumberField { label: "", help: "", limits: SCALE, default: None };
        for (typed, taken) in [(0.0, SCALE.soft[0]), (-0.0, -SCALE.soft[0]), (-2.0, -2.0), (5e6, 1e6)] {
            assert_eq!(field.taken(typed), taken);
        }
    }
}
