//! The cards of each kind of node: shape, mesh, light, camera.

use egui::{RichText, TextEdit, Ui, vec2};
use glam::DVec3;

use super::edit_session::{ParamTarget, WantedFile};
use super::multi_edit::MultiEdit;
use super::numbers::NumberField;
use super::widgets::{self, MIXED};
use super::{inspector_points, shape_change, theme};
use crate::scene::limits::{ATTENUATION, CLIP, CONE, FOV, INTENSITY, MAX_TEXT, RANGE};
use crate::scene::{
    Attached, Attenuation, CameraNode, Light, LightKind, Limits, MeshNode, Node, NodeKind, Object, Param, ParamValue,
    ShapeKind,
};

pub(super) const fn field<'a>(label: &'a str, help: &'a str, limits: Limits, default: Option<f64>) -> NumberField<'a> {
    NumberField { label, help, limits, default, taken_as: None }
}

pub(super) fn no_help<T>(_: T) -> &'static str {
    ""
}

fn object(n: &Node) -> Option<&Object> {
    if let NodeKind::Object(o) = &n.kind { Some(o) } else { None }
}

fn object_mut(n: &mut Node) -> Option<&mut Object> {
    if let NodeKind::Object(o) = &mut n.kind { Some(o) } else { None }
}

/// The shape's kind and its parameters, made from the table of shapes.
pub fn shape(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Shape", |ui| {
        edit.choice(
            ui,
            ("Primitive", "Another shape in the same place, about the same size"),
            ShapeKind::ALL,
            (ShapeKind::label, ShapeKind::help),
            |n| object(n).map(|o| o.shape.kind()),
            |n, kind| {
                if let Some(o) = object_mut(n) {
                    o.shape = shape_change::changed(&o.shape, kind);
                }
            },
        );
        let Some(kind) = edit.common(|n| object(n).map(|o| o.shape.kind())).flatten() else {
            ui.label(RichText::new("Different shapes: no common parameters").color(theme::WEAK));
            return;
        };
        let defaults = kind.default_shape().values();
        for (index, (param, default)) in kind.params().iter().zip(defaults).enumerate() {
            parameter(ui, edit, index, param, default);
        }
        if kind.params().is_empty() {
            ui.label(RichText::new("No parameters: position and rotation say all.").color(theme::WEAK));
        }
    });
}

fn parameter(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize, param: &Param, default: ParamValue) {
    let label = param_label(param.name);
    let value = |n: &Node| object(n).and_then(|o| o.shape.values().get(index).cloned());
    let set = |n: &mut Node, v: ParamValue| {
        if let Some(o) = object_mut(n) {
            o.shape.set_value(index, v);
        }
    };
    match default {
        ParamValue::Scalar(default) => {
            let get = |n: &Node| if let Some(ParamValue::Scalar(v)) = value(n) { Some(v) } else { None };
            let field = field(&label, param.help, param.limits, Some(default));
            edit.number(ui, &field, get, |n, v| set(n, ParamValue::Scalar(v)));
        }
        ParamValue::Vector(default) => {
            let get =
                |n: &Node| -> Option<DVec3> { if let Some(ParamValue::Vector(v)) = value(n) { Some(v) } else { None } };
            // One reset value for three fields only where the default is the same along every axis.
            let same = default.x == default.y && default.y == default.z;
            let field = field(&label, param.help, param.limits, same.then_some(default.x));
            edit.vector(ui, &field, get, |n, v| set(n, ParamValue::Vector(v)));
        }
        ParamValue::Flag(_) => {
            let get = |n: &Node| matches!(value(n), Some(ParamValue::Flag(true)));
            edit.toggle(ui, (&label, "", param.help), get, |n, v| set(n, ParamValue::Flag(v)));
        }
        ParamValue::Text(_) => {
            let Some(ParamValue::Text(text)) = value(edit.active()) else { return };
            let is_mixed = edit.common(value).is_none();
            let mut text = if is_mixed { String::new() } else { text };
            let response = widgets::row(ui, &label, param.help, |ui| {
                ui.add(
                    TextEdit::multiline(&mut text)
                        .desired_rows(1)
                        .hint_text(if is_mixed { MIXED } else { "" })
                        .desired_width(ui.available_width())
                        .char_limit(MAX_TEXT),
                )
            });
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label.clone()));
            if response.changed() {
                edit.change(response.id, |n| set(n, ParamValue::Text(text.clone())));
            }
        }
        ParamValue::File(default) => {
            let Some(ParamValue::File(file)) = value(edit.active()) else { return };
            let target = ParamTarget::Shape(index);
            let shown = if edit.common(value).is_some() { file.label() } else { MIXED };
            attachment(ui, edit, (&label, param.help), (target, &file, shown), &default);
        }
        ParamValue::List(_) => {
            let get = |n: &Node| if let Some(ParamValue::List(v)) = value(n) { Some(v) } else { None };
            inspector_points::list(ui, edit, (&label, param), get, |n, v| set(n, ParamValue::List(v)));
        }
    }
}

/// A file that a parameter keeps: its name as it is shown, which asks for another when clicked, and a cross to do without.
pub fn attachment(
    ui: &mut Ui,
    edit: &mut MultiEdit<'_>,
    (label, help): (&str, &str),
    (target, file, shown): (ParamTarget, &Attached, &str),
    default: &Attached,
) {
    let (choose, remove) = widgets::row(ui, label, help, |ui| {
        let is_some = file.name().is_some();
        let room = if is_some { theme::ROW_HEIGHT + ui.spacing().item_spacing.x } else { 0.0 };
        let size = vec2(ui.available_width() - room, theme::ROW_HEIGHT);
        let name = egui::Button::new(format!("{shown}…")).truncate().min_size(size);
        let choose = ui.add_sized(size, name).on_hover_text("Choose a file; the scene keeps a copy of it");
        let cross = || egui::Button::new("×").min_size(egui::Vec2::splat(theme::ROW_HEIGHT));
        let remove = is_some.then(|| ui.add(cross()).on_hover_text("Do without a file"));
        (choose, remove)
    });
    ui.ctx().accesskit_node_builder(choose.id, |node| node.set_label(format!("{label}: {shown}")));
    if choose.clicked() {
        let nodes = edit.ids();
        edit.session().wanted_file = Some(WantedFile { nodes, target, instead_of: file.clone() });
    }
    if let Some(remove) = remove {
        ui.ctx().accesskit_node_builder(remove.id, |node| node.set_label(format!("{label}: none")));
        if remove.clicked() {
            edit.change(remove.id, |n| {
                target.set(n, default);
            });
        }
    }
}

/// `bottom_radius` → `Bottom radius`.
pub fn sentence_case(name: &str) -> String {
    let spaced = name.replace('_', " ");
    let mut chars = spaced.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str())
}

/// The label of a shape's parameter: files call a bevel `rounding`.
fn param_label(name: &str) -> String {
    if name == "rounding" { "Bevel".to_owned() } else { sentence_case(name) }
}

/// The file of a mesh.
pub fn mesh(ui: &mut Ui, edit: &mut MultiEdit<'_>, mesh: &MeshNode) {
    widgets::card(ui, "Mesh", |ui| {
        let help = "A .gltf or .glb file, relative to the scene's folder";
        let path = |n: &Node| if let NodeKind::Mesh(m) = &n.kind { Some(m.path.clone()) } else { None };
        let (current, hint) = if edit.common(path).is_some() { (&*mesh.path, "models/thing.glb") } else { ("", MIXED) };
        // Half a path names no file, so it is not looked for before it is typed to its end.
        let (widget, typed) = widgets::row(ui, "File", help, |ui| widgets::line(ui, "File", current, hint));
        if let Some(path) = typed {
            edit.change(widget, |n| {
                if let NodeKind::Mesh(m) = &mut n.kind {
                    m.path.clone_from(&path);
                }
            });
        }
    });
}

fn light_of(n: &Node) -> Option<&Light> {
    if let NodeKind::Light(l) = &n.kind { Some(l) } else { None }
}

fn set_light(n: &mut Node, change: impl FnOnce(&mut Light)) {
    if let NodeKind::Light(l) = &mut n.kind {
        change(l);
    }
}

fn attenuation(n: &Node) -> Option<Attenuation> {
    match light_of(n)?.light {
        LightKind::Sun {} => None,
        LightKind::Point { attenuation } | LightKind::Spot { attenuation, .. } => Some(attenuation),
    }
}

fn set_attenuation(n: &mut Node, change: impl FnOnce(&mut Attenuation)) {
    set_light(n, |l| match &mut l.light {
        LightKind::Sun {} => {}
        LightKind::Point { attenuation } | LightKind::Spot { attenuation, .. } => change(attenuation),
    });
}

/// Index of a kind of light in the list.
fn light_index(n: &Node) -> Option<usize> {
    Some(match light_of(n)?.light {
        LightKind::Sun {} => 0,
        LightKind::Point { .. } => 1,
        LightKind::Spot { .. } => 2,
    })
}

fn light_kind(index: usize, attenuation: Attenuation) -> LightKind {
    match index {
        0 => LightKind::Sun {},
        1 => LightKind::Point { attenuation },
        _ => LightKind::Spot { attenuation, inner: 20.0, outer: 30.0 },
    }
}

/// Color, strength, kind and reach.
pub fn light(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Light", |ui| {
        edit.choice(
            ui,
            ("Type", "Where the light comes from; it shines along the node's −Z"),
            &[0, 1, 2],
            (|i: usize| ["Sun", "Point", "Spot"][i], no_help),
            light_index,
            |n, index| {
                let kept = attenuation(n).unwrap_or_default();
                set_light(n, |l| l.light = light_kind(index, kept));
            },
        );
        let get = |n: &Node| light_of(n).map(|l| l.color);
        edit.color(ui, ("Color", "Color of the light"), get, |n, v| set_light(n, |l| l.color = v));
        let intensity = field("Intensity", "Factor on the color", INTENSITY, Some(2.0));
        let get = |n: &Node| light_of(n).map(|l| l.intensity);
        edit.number(ui, &intensity, get, |n, v| set_light(n, |l| l.intensity = v));
        spot(ui, edit);
        reach(ui, edit);
    });
}

fn spot(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    fn angles(n: &Node) -> Option<(f64, f64)> {
        if let LightKind::Spot { inner, outer, .. } = light_of(n)?.light { Some((inner, outer)) } else { None }
    }
    fn set(n: &mut Node, change: impl FnOnce(&mut f64, &mut f64)) {
        set_light(n, |l| {
            if let LightKind::Spot { inner, outer, .. } = &mut l.light {
                change(inner, outer);
            }
        });
    }
    let inner = field("Inner angle", "Half angle within which the light is full", CONE, Some(20.0));
    edit.number(ui, &inner, |n| angles(n).map(|a| a.0), |n, v| set(n, |i, o| (*i, *o) = (v, o.max(v))));
    let outer = field("Outer angle", "Half angle at which the light has faded out", CONE, Some(30.0));
    edit.number(ui, &outer, |n| angles(n).map(|a| a.1), |n, v| set(n, |i, o| (*i, *o) = (i.min(v), v)));
}

fn reach(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    type ParamAccess = fn(&mut Attenuation) -> &mut f64;
    fn row(ui: &mut Ui, edit: &mut MultiEdit<'_>, field: &NumberField<'_>, part: ParamAccess) {
        let get = |n: &Node| attenuation(n).map(|mut a| *part(&mut a));
        edit.number(ui, field, get, |n, v| set_attenuation(n, |a| *part(a) = v));
    }
    if attenuation(edit.active()).is_none() {
        return;
    }
    let default = Attenuation::default();
    let range = field("Range", "Nothing is lit beyond this distance", RANGE, Some(default.range));
    row(ui, edit, &range, |a| &mut a.range);
    let rows: [(NumberField<'_>, ParamAccess); 3] = [
        (
            field(
                "Constant",
                "Weakening by 1 / (constant + linear d + quadratic d²)",
                ATTENUATION,
                Some(default.constant),
            ),
            |a| &mut a.constant,
        ),
        (field("Linear", "Weakening per meter", ATTENUATION, Some(default.linear)), |a| &mut a.linear),
        (field("Quadratic", "Weakening per square meter", ATTENUATION, Some(default.quadratic)), |a| &mut a.quadratic),
    ];
    let title = RichText::new("Falloff (advanced)").color(theme::WEAK);
    egui::CollapsingHeader::new(title).id_salt("falloff").show_unindented(ui, |ui| {
        for (field, part) in rows {
            row(ui, edit, &field, part);
        }
    });
}

/// Angle of view and clipping.
pub fn camera(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    type ParamAccess = fn(&mut CameraNode) -> &mut f64;
    let rows: [(NumberField<'_>, ParamAccess); 3] = [
        (field("Field of view", "Full vertical angle of view", FOV, Some(40.0)), |c| &mut c.fov_y),
        (field("Clip start", "Nothing nearer is seen", CLIP, Some(0.01)), |c| &mut c.near),
        (field("Clip end", "Nothing farther is seen", CLIP, Some(1_000.0)), |c| &mut c.far),
    ];
    widgets::card(ui, "Camera", |ui| {
        for (field, part) in rows {
            let get = |n: &Node| if let NodeKind::Camera(mut c) = n.kind { Some(*part(&mut c)) } else { None };
            edit.number(ui, &field, get, |n, v| {
                if let NodeKind::Camera(c) = &mut n.kind {
                    *part(c) = v;
                }
            });
        }
    });
}

#[cfg(test)]
mod tests {
    #[test]
    fn parameter_names_become_labels() {
        assert_eq!(super::sentence_case("bottom_radius"), "Bottom radius");
        assert_eq!(super::sentence_case(""), "");
        assert_eq!(super::param_label("rounding"), "Bevel");
        assert_eq!(super::param_label("top_radius"), "Top radius");
    }
}
