//! Inspector rows for any parameter, generated from its table. A row shows the value of the last path, changes all
//! paths, and shows a dash if values differ.

use std::borrow::Cow;

use egui::{Id, TextEdit, Ui, vec2};

use super::edit_session::{EditSession, WantedFile};
use super::inspector_points::{self, PointEdit};
use super::multi_edit::MultiEdit;
use super::numbers::{self, FieldResponse, NumberField};
use super::widgets::{self, MIXED};
use super::{keying, theme};
use isolith_scene::{Attached, Limits, Param, ParamOwner, ParamPath, ParamValue, Part};

/// The artist's change of a parameter.
pub enum ParamChange {
    /// A new value for the whole parameter.
    Whole(ParamValue),
    /// A new value for one of its elements.
    Element(usize, ParamValue),
    /// Added, removed or changed points.
    Points(PointEdit),
}

/// A row for a parameter of a part of the nodes.
pub fn row(ui: &mut Ui, nodes: &mut MultiEdit<'_>, part: Part, name: impl Into<Cow<'static, str>>) {
    row_with(ui, nodes, part, name, |_| {});
}

/// Like [`row`], with another label, help text or unit.
pub fn row_with(
    ui: &mut Ui,
    nodes: &mut MultiEdit<'_>,
    part: Part,
    name: impl Into<Cow<'static, str>>,
    adapt: impl FnOnce(&mut NumberField<'_>),
) {
    let paths = nodes.paths(part, name);
    if let Some((widget, change)) = edit(ui, nodes.session(), &paths, adapt) {
        apply(nodes.session(), widget, &paths, &change);
    }
}

/// Like [`row`], for one end of a range: the other end gives way, so that the least is never above the greatest.
pub fn end_row(
    ui: &mut Ui,
    nodes: &mut MultiEdit<'_>,
    part: Part,
    [name, other]: [&'static str; 2],
    give_way: fn(f64, f64) -> f64,
) {
    let paths = nodes.paths(part, name);
    let Some((widget, change)) = edit(ui, nodes.session(), &paths, |_| {}) else { return };
    let (element, new) = match change {
        ParamChange::Whole(ParamValue::Scalar(new)) => (None, new),
        ParamChange::Element(index, ParamValue::Scalar(new)) => (Some(index), new),
        _ => return,
    };
    let Some(path) = paths.into_iter().next() else { return };
    let path = ParamPath { element, ..path };
    let other = ParamPath { name: other.into(), ..path.clone() };
    nodes.change(widget, |node| {
        if let Some(ParamValue::Scalar(now)) = other.get_in(node) {
            path.set_in(node, ParamValue::Scalar(new));
            other.set_in(node, ParamValue::Scalar(give_way(now, new)));
        }
    });
}

/// A row for a parameter of a material or the environment.
pub fn single(ui: &mut Ui, session: &mut EditSession, path: ParamPath) {
    let paths = [path];
    if let Some((widget, change)) = edit(ui, session, &paths, |_| {}) {
        apply(session, widget, &paths, &change);
    }
}

/// Applies the change to every path as part of the widget's gesture. Ignores nodes without the parameter.
pub fn apply(session: &mut EditSession, widget: Id, paths: &[ParamPath], change: &ParamChange) {
    let scene = session.document.snapshot();
    let with = |path: &ParamPath| {
        let now = path.get(&scene).ok()?;
        Some(match change {
            ParamChange::Whole(value) => value.clone(),
            ParamChange::Element(index, value) => now.with_element(*index, value)?,
            ParamChange::Points(edit) => {
                let ParamValue::List(mut list) = now else { return None };
                edit.apply(&mut list);
                ParamValue::List(list)
            }
        })
    };
    let changes = paths.iter().filter_map(|path| Some((path.clone(), with(path)?)));
    session.set_params(widget, changes.collect());
}

/// Shows the row; returns the artist's change for [`apply`].
pub fn edit(
    ui: &mut Ui,
    session: &mut EditSession,
    paths: &[ParamPath],
    adapt: impl FnOnce(&mut NumberField<'_>),
) -> Option<(Id, ParamChange)> {
    let scene = session.document.snapshot();
    let shown = paths.last()?;
    let (param, value) = (shown.param(&scene).ok()?, shown.get(&scene).ok()?);
    let all: Vec<Option<ParamValue>> = paths.iter().map(|path| path.get(&scene).ok()).collect();
    let mixed = all.iter().any(|other| other.as_ref() != Some(&value));
    let differs = |index: usize| {
        let element = |value: &ParamValue| value.element(index);
        all.iter().any(|other| other.as_ref().and_then(element) != element(&value))
    };
    let mut field =
        NumberField { label: &param.label, help: param.help, limits: param.limits, default: default(&param.default) };
    adapt(&mut field);
    let top = ui.cursor().min;
    let change = match value.clone() {
        ParamValue::Vector(v) if param.is_color => {
            let color = |ui: &mut Ui| widgets::color(ui, field.label, v.to_array(), mixed);
            let (widget, picked) = widgets::row(ui, field.label, field.help, color);
            picked.map(|color| (widget, ParamChange::Whole(ParamValue::Vector(color.into()))))
        }
        ParamValue::Scalar(v) => number(ui, &field, v, mixed, ParamValue::Scalar),
        ParamValue::Count(n) => number(ui, &field, n.into(), mixed, |v| ParamValue::Count(whole(v))),
        ParamValue::Vector(v) => vector(ui, &field, v.to_array(), differs, ParamValue::Scalar),
        ParamValue::Counts(n) => vector(ui, &field, n.map(f64::from), differs, |v| ParamValue::Count(whole(v))),
        ParamValue::Flag(on) => flag(ui, &field, on, mixed),
        ParamValue::Flags(on) => flags(ui, &field, on, differs),
        ParamValue::Choice(key) => choice(ui, &field, param, (!mixed).then_some(key)),
        ParamValue::Text(text) => letters(ui, &field, text, mixed),
        ParamValue::List(list) => {
            inspector_points::list(ui, &field, &list, mixed).map(|(widget, edit)| (widget, ParamChange::Points(edit)))
        }
        ParamValue::File(file) => attachment(ui, session, &field, paths, (&file, mixed)),
        // `inspector_transform` shows rotations as angles.
        ParamValue::Rotation(_) => None,
    };
    keying::mark(ui, session, field.label, paths, top);
    change
}

/// The reset value. A vector has one only if its default is the same along every axis.
fn default(value: &ParamValue) -> Option<f64> {
    match value {
        ParamValue::Scalar(v) => Some(*v),
        ParamValue::Count(n) => Some(f64::from(*n)),
        ParamValue::Vector(v) => (v.x == v.y && v.y == v.z).then_some(v.x),
        _ => None,
    }
}

/// Rounds to a whole number of at least 0.
fn whole(v: f64) -> u32 {
    v.round().clamp(0.0, f64::from(u32::MAX)) as u32
}

fn number(
    ui: &mut Ui,
    field: &NumberField<'_>,
    value: f64,
    mixed: bool,
    of: impl Fn(f64) -> ParamValue,
) -> Option<(Id, ParamChange)> {
    let FieldResponse { widget, value } = widgets::row(ui, field.label, field.help, |ui| {
        let width = ui.available_width();
        numbers::number(ui, field, field.label, value, mixed, width)
    });
    value.map(|value| (widget, ParamChange::Whole(of(value))))
}

fn vector(
    ui: &mut Ui,
    field: &NumberField<'_>,
    values: [f64; 3],
    differs: impl Fn(usize) -> bool,
    of: impl Fn(f64) -> ParamValue,
) -> Option<(Id, ParamChange)> {
    let mixed = [0, 1, 2].map(differs);
    let changed = widgets::row(ui, field.label, field.help, |ui| numbers::vector(ui, field, values, mixed));
    let (axis, FieldResponse { widget, value }) = changed?;
    value.map(|value| (widget, ParamChange::Element(axis, of(value))))
}

fn flag(ui: &mut Ui, field: &NumberField<'_>, mut on: bool, mixed: bool) -> Option<(Id, ParamChange)> {
    let response = widgets::row(ui, field.label, field.help, |ui| {
        ui.add(egui::Checkbox::new(&mut on, "").indeterminate(mixed)).on_hover_text(field.help)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(field.label.to_owned()));
    response.changed().then(|| (response.id, ParamChange::Whole(ParamValue::Flag(on))))
}

/// A check box for each axis.
fn flags(
    ui: &mut Ui,
    field: &NumberField<'_>,
    values: [bool; 3],
    differs: impl Fn(usize) -> bool,
) -> Option<(Id, ParamChange)> {
    let mut changed = None;
    widgets::row(ui, field.label, field.help, |ui| {
        for (axis, name) in ["X", "Y", "Z"].into_iter().enumerate() {
            let mut on = values[axis];
            let check_box = egui::Checkbox::new(&mut on, name).indeterminate(differs(axis));
            let response = ui.add(check_box).on_hover_text(field.help);
            let label = format!("{} {name}", field.label);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label));
            if response.changed() {
                changed = Some((response.id, ParamChange::Element(axis, ParamValue::Flag(on))));
            }
        }
    });
    changed
}

fn choice(
    ui: &mut Ui,
    field: &NumberField<'_>,
    param: &'static Param,
    current: Option<&'static str>,
) -> Option<(Id, ParamChange)> {
    let all: Vec<usize> = (0..param.choices.len()).collect();
    let current = current.and_then(|key| param.choices.iter().position(|choice| choice.key == key));
    let (label, help) = (|index: usize| param.choices[index].label, |index: usize| param.choices[index].help);
    let (widget, chosen) =
        widgets::row(ui, field.label, field.help, |ui| widgets::choice(ui, field.label, current, &all, label, help));
    chosen.map(|index| (widget, ParamChange::Whole(ParamValue::Choice(&param.choices[index].key))))
}

fn letters(ui: &mut Ui, field: &NumberField<'_>, text: String, mixed: bool) -> Option<(Id, ParamChange)> {
    let mut text = if mixed { String::new() } else { text };
    let response = widgets::row(ui, field.label, field.help, |ui| {
        ui.add(
            TextEdit::multiline(&mut text)
                .desired_rows(1)
                .hint_text(if mixed { MIXED } else { "" })
                .desired_width(ui.available_width())
                .char_limit(most_letters(&field.limits)),
        )
        .on_hover_text(field.help)
    });
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(field.label.to_owned()));
    response.changed().then(|| (response.id, ParamChange::Whole(ParamValue::Text(text))))
}

fn most_letters(limits: &Limits) -> usize {
    limits.hard[1] as usize
}

/// A file parameter: its name, which asks for another file on a click, and a cross to remove the file.
fn attachment(
    ui: &mut Ui,
    session: &mut EditSession,
    field: &NumberField<'_>,
    paths: &[ParamPath],
    (file, mixed): (&Attached, bool),
) -> Option<(Id, ParamChange)> {
    let of_modifier = matches!(paths.last().map(|path| path.owner), Some(ParamOwner::Node(_, Part::Modifier(_))));
    // Without a file a modifier does nothing, but a shape has a default.
    let label = if of_modifier { file.name().unwrap_or("No file") } else { file.label() };
    let shown = if mixed { MIXED } else { label };
    let (choose, remove) = widgets::row(ui, field.label, field.help, |ui| {
        let is_some = file.name().is_some();
        let room = if is_some { theme::ROW_HEIGHT + ui.spacing().item_spacing.x } else { 0.0 };
        let size = vec2(ui.available_width() - room, theme::ROW_HEIGHT);
        let name = egui::Button::new(format!("{shown}…")).truncate().min_size(size);
        let choose = ui.add_sized(size, name).on_hover_text("Choose a file; the scene keeps a copy of it");
        let cross = || egui::Button::new("×").min_size(egui::Vec2::splat(theme::ROW_HEIGHT));
        let remove = is_some.then(|| ui.add(cross()).on_hover_text("Do without a file"));
        (choose, remove)
    });
    let label = field.label;
    ui.ctx().accesskit_node_builder(choose.id, |node| node.set_label(format!("{label}: {shown}")));
    if choose.clicked() {
        session.wanted_file = Some(WantedFile { paths: paths.to_vec(), instead_of: file.clone() });
    }
    let remove = remove?;
    ui.ctx().accesskit_node_builder(remove.id, |node| node.set_label(format!("{label}: none")));
    remove.clicked().then(|| (remove.id, ParamChange::Whole(ParamValue::File(file.without()))))
}
