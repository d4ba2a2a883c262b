//! The color picker: a square of saturation and brightness, a strip of hues, a field for hex digits.
//! Colors are linear at the interface and shown as sRGB.

use egui::ecolor::HsvaGamma;
use egui::{Color32, Id, Key, Mesh, Pos2, Rect, Response, Rgba, RichText, Sense, Shape, Stroke, TextEdit, Ui, vec2};

use super::theme;

const SIDE: f32 = 210.0;
const HEIGHT: f32 = 140.0;
const STRIP: f32 = 16.0;

/// Shows the picker; true if the color changed.
pub fn show(ui: &mut Ui, linear: &mut [f32; 3]) -> bool {
    let id = ui.scope_id().with("picker");
    let mut hsv = remembered(ui, id, *linear);
    let mut changed = square(ui, &mut hsv);
    ui.add_space(4.0);
    changed |= strip(ui, &mut hsv);
    if changed {
        *linear = to_linear(hsv);
    }
    ui.add_space(4.0);
    let typed = hex_field(ui, id, *linear);
    if let Some(color) = typed {
        *linear = color;
        hsv = from_linear(color);
    }
    // Gray has no hue and black has no saturation: keep the last ones while the color is unchanged.
    ui.data_mut(|d| d.insert_temp(id, (*linear, hsv.h, hsv.s)));
    changed || typed.is_some()
}

fn remembered(ui: &Ui, id: Id, linear: [f32; 3]) -> HsvaGamma {
    let mut hsv = from_linear(linear);
    if let Some((of, h, s)) = ui.data(|d| d.get_temp::<([f32; 3], f32, f32)>(id))
        && of == linear
    {
        (hsv.h, hsv.s) = (h, s);
    }
    hsv
}

fn from_linear([r, g, b]: [f32; 3]) -> HsvaGamma {
    HsvaGamma::from(Rgba::from_rgb(r, g, b))
}

fn to_linear(hsv: HsvaGamma) -> [f32; 3] {
    let color = Rgba::from(hsv);
    [color.r(), color.g(), color.b()]
}

fn shade(h: f32, s: f32, v: f32) -> Color32 {
    HsvaGamma { h, s, v, a: 1.0 }.into()
}

/// Position of the pointer in a rectangle during a drag, 0 to 1 along both axes.
fn held_at(response: &Response, rect: Rect) -> Option<[f32; 2]> {
    let pointer = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked())?;
    let at = (pointer - rect.min) / rect.size();
    Some([at.x.clamp(0.0, 1.0), at.y.clamp(0.0, 1.0)])
}

fn square(ui: &mut Ui, hsv: &mut HsvaGamma) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, HEIGHT), Sense::click_and_drag());
    name(ui, &response, "Saturation and brightness");
    let held = held_at(&response, rect);
    if let Some([s, down]) = held {
        (hsv.s, hsv.v) = (s, 1.0 - down);
    }
    // A grid: the color is a product of both axes, and triangles interpolate only linearly.
    grid(ui, rect, [14, 14], |x, y| shade(hsv.h, x, 1.0 - y));
    let knob = rect.lerp_inside(vec2(hsv.s, 1.0 - hsv.v));
    paint_knob(ui, knob, shade(hsv.h, hsv.s, hsv.v));
    held.is_some()
}

fn strip(ui: &mut Ui, hsv: &mut HsvaGamma) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, STRIP), Sense::click_and_drag());
    name(ui, &response, "Hue");
    let held = held_at(&response, rect);
    if let Some([h, _]) = held {
        hsv.h = h.min(0.999);
    }
    grid(ui, rect, [36, 1], |x, _| shade(x, 1.0, 1.0));
    paint_knob(ui, rect.lerp_inside(vec2(hsv.h, 0.5)), shade(hsv.h, 1.0, 1.0));
    held.is_some()
}

fn name(ui: &Ui, response: &Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.to_owned()));
}

fn grid(ui: &Ui, rect: Rect, [columns, rows]: [u32; 2], color: impl Fn(f32, f32) -> Color32) {
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (x, y) = (column as f32 / columns as f32, row as f32 / rows as f32);
            mesh.colored_vertex(rect.lerp_inside(vec2(x, y)), color(x, y));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let corner = row * (columns + 1) + column;
            mesh.add_triangle(corner, corner + 1, corner + columns + 1);
            mesh.add_triangle(corner + 1, corner + columns + 2, corner + columns + 1);
        }
    }
    ui.painter().add(Shape::mesh(mesh));
}

fn paint_knob(ui: &Ui, at: Pos2, color: Color32) {
    ui.painter().circle(at, 6.0, color, Stroke::new(3.0, Color32::from_black_alpha(120)));
    ui.painter().circle_stroke(at, 6.0, Stroke::new(1.5, Color32::WHITE));
}

/// A field with the sRGB color in hex digits; returns the linear color of the typed digits.
fn hex_field(ui: &mut Ui, id: Id, linear: [f32; 3]) -> Option<[f32; 3]> {
    let mut typed = None;
    ui.horizontal(|ui| {
        let shown = Color32::from(Rgba::from_rgb(linear[0], linear[1], linear[2]));
        let (rect, _) = ui.allocate_exact_size(vec2(theme::ROW_HEIGHT, theme::ROW_HEIGHT), Sense::hover());
        ui.painter().rect_filled(rect, 4.0, shown);
        let text_id = id.with("hex");
        let actual = format!("#{:02x}{:02x}{:02x}", shown.r(), shown.g(), shown.b());
        let mut text = ui.data(|d| d.get_temp::<String>(text_id)).unwrap_or_else(|| actual.clone());
        let response = ui.add(TextEdit::singleline(&mut text).desired_width(90.0).char_limit(7));
        name(ui, &response, "Hex");
        if response.lost_focus() && text != actual && !ui.input(|i| i.key_pressed(Key::Escape)) {
            typed = parse_hex(&text);
            let reason = || format!("“{text}” is no color: type six hex digits, such as #e5d4b6.");
            super::numbers::refuse(ui, response.id, typed.is_none().then(reason));
        }
        let typing = response.has_focus();
        // Keep text in the middle of typing; otherwise show the color.
        ui.data_mut(|d| {
            d.remove::<String>(text_id);
            if typing {
                d.insert_temp(text_id, text);
            }
        });
        ui.label(RichText::new("sRGB").small().color(theme::WEAK));
    });
    typed
}

/// Parses `#e5d4b6`, `e5d4b6` or `#fff` to a linear color.
fn parse_hex(text: &str) -> Option<[f32; 3]> {
    let digits = text.trim().trim_start_matches('#');
    let color = Color32::from_hex(&format!("#{digits}")).ok().filter(|_| digits.len() == 3 || digits.len() == 6)?;
    let color = Rgba::from(color);
    Some([color.r(), color.g(), color.b()])
}

/// A button filled with a color; a click opens the picker. `value` is linear. `mixed` shows a dash instead.
pub fn button(ui: &mut Ui, label: &str, value: &mut [f32; 3], mixed: bool) -> (Response, bool) {
    let size = vec2(ui.available_width(), theme::ROW_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::ColorWell, ui.is_enabled(), label));
    let color = Rgba::from_rgb(value[0], value[1], value[2]).into();
    let fill: Color32 = if mixed { *theme::FIELD } else { color };
    let border = if response.hovered() { theme::TEXT } else { theme::RESTING };
    ui.painter().rect(rect, f32::from(theme::RADIUS), fill, Stroke::new(1.0, border), egui::StrokeKind::Inside);
    if mixed {
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_value(theme::MIXED));
        let font = egui::TextStyle::Button.resolve(ui.style());
        ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, theme::MIXED, font, *theme::TEXT);
    }
    let mut changed = false;
    let close = egui::PopupCloseBehavior::CloseOnClickOutside;
    egui::Popup::menu(&response).close_behavior(close).show(|ui| {
        egui::Frame::new().inner_margin(4.0).show(ui, |ui| changed = show(ui, value));
    });
    (response, changed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_digits_are_srgb_and_nonsense_is_refused() {
        assert_eq!(parse_hex("#ffffff"), Some([1.0; 3]));
        assert_eq!(parse_hex("000"), Some([0.0; 3]));
        let half = parse_hex("#808080").unwrap()[0];
        assert!((half - 0.2158).abs() < 1e-3, "{half}");
        for text in ["", "#12", "#gggggg", "#12345678"] {
            assert_eq!(parse_hex(text), None, "{text}");
        }
    }

    #[test]
    fn colors_survive_the_way_through_hue_and_saturation() {
        for color in [[0.8, 0.1, 0.3], [0.05, 0.9, 0.9], [0.2, 0.2, 0.2], [0.0, 0.0, 0.0]] {
            let back = to_linear(from_linear(color));
            for c in 0..3 {
                assert!((back[c] - color[c]).abs() < 1e-4, "{color:?} {back:?}");
            }
        }
    }
}
