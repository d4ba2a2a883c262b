//! The bar in the upper right corner of the viewport: a button for each shading, and a menu with the views for
//! debugging.

use egui::epaint::Vertex;
use egui::{Align, Button, Color32, Frame, Layout, Mesh, Pos2, Rect, Response, RichText, Sense, Ui, UiBuilder, vec2};
use egui_material_icons::icons::ICON_KEYBOARD_ARROW_DOWN;

use super::commands::command::Command;
use super::commands::entries::shading_entries;
use super::legend::capitalized;
use super::state::{EditorState, Request};
use super::theme;
use isolith_field::Shading;

/// Height of the bar with its margin, in points.
pub const HEIGHT: f32 = 40.0;

/// Distance from the edges of the viewport, in points.
const MARGIN: f32 = 10.0;
/// Size of a button, in points.
const BUTTON: egui::Vec2 = vec2(32.0, 26.0);
/// Radius of the balls on the buttons, in points.
const BALL: f32 = 8.5;

/// Shows the bar over the picture.
pub fn show(state: &mut EditorState, ui: &mut Ui) {
    let corner = state.view.rect.right_top() + vec2(-MARGIN, MARGIN);
    let room = Rect::from_min_max(corner - vec2(300.0, 0.0), corner + vec2(0.0, HEIGHT - MARGIN));
    let mut bar = ui.new_child(UiBuilder::new().max_rect(room).layout(Layout::right_to_left(Align::Min)));
    let frame = Frame::new().fill(theme::FLOATING.gamma_multiply(0.88)).corner_radius(7.0).inner_margin(2.0);
    let chosen = frame.show(&mut bar, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let mut chosen = menu(state, ui);
        let shown = state.view.lit_by();
        for main in Shading::MAIN.into_iter().rev() {
            // Its button shows the kind of solid that is chosen.
            let shading = shown.filter(|shown| shown.main() == main).unwrap_or(main);
            if button(ui, shading, shown == Some(shading)).clicked() {
                chosen = Some(Command::ShowShading(shading));
            }
        }
        chosen
    });
    state.requests.extend(chosen.inner.map(Request::Run));
}

/// The menu; its button names the view for debugging that is open.
fn menu(state: &EditorState, ui: &mut Ui) -> Option<Command> {
    let arrow = ICON_KEYBOARD_ARROW_DOWN.rich_text().size(theme::ICON_SIZE);
    let text = match state.view.lit_by() {
        Some(_) => (RichText::new(""), arrow.color(theme::WEAK)),
        None => {
            let name = RichText::new(capitalized(state.view.view_mode.name())).color(theme::ACCENT);
            (name, arrow.color(theme::ACCENT))
        }
    };
    ui.spacing_mut().button_padding.x = 4.0;
    let opener = Button::new(text).frame_when_inactive(false).min_size(vec2(20.0, BUTTON.y));
    let (button, menu) = egui::containers::menu::MenuButton::from_button(opener).ui(ui, |ui| {
        ui.spacing_mut().button_padding.x = 8.0;
        ui.set_min_width(210.0);
        shading_entries(ui, state)
    });
    ui.ctx().accesskit_node_builder(button.id, |node| node.set_label("Viewport shading"));
    button.on_hover_text("All shadings, and views for debugging");
    menu.and_then(|menu| menu.inner)
}

fn button(ui: &mut Ui, shading: Shading, is_on: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(BUTTON, Sense::click());
    let info = Command::ShowShading(shading).info();
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::RadioButton, true, is_on, shading.label()));
    let fill = match (is_on, response.hovered()) {
        (true, _) => *theme::SELECTED,
        (false, true) => *theme::FIELD,
        (false, false) => Color32::TRANSPARENT,
    };
    let outline = if is_on { *theme::ACCENT } else { Color32::TRANSPARENT };
    ui.painter().rect(rect, f32::from(theme::RADIUS), fill, (1.0, outline), egui::StrokeKind::Inside);
    paint_ball(ui, rect.center(), |normal| ball_color(shading, normal));
    response.on_hover_text(format!("{}  (Z for the next one)\n{}", shading.label(), info.help))
}

/// The color of the ball of a shading where its surface faces `[x, y, z]`: right, down and to the viewer.
fn ball_color(shading: Shading, [x, y, z]: [f32; 3]) -> Color32 {
    let toward = |[a, b, c]: [f32; 3]| (x * a + y * b + z * c).max(0.0);
    let key = toward([-0.55, -0.62, 0.56]);
    let gloss = toward([-0.33, -0.38, 0.86]).powi(24);
    let of = |color: [f32; 3], light: f32, more: [f32; 3]| {
        let [r, g, b] = [0, 1, 2].map(|c| ((color[c] * light + more[c]) * 255.0).clamp(0.0, 255.0) as u8);
        Color32::from_rgb(r, g, b)
    };
    match shading {
        Shading::Solid => of([0.80, 0.80, 0.78], 0.32 + 0.68 * key, [0.06 * gloss; 3]),
        Shading::Porcelain => of([0.95, 0.95, 0.93], 0.42 + 0.5 * key, [0.7 * gloss; 3]),
        Shading::Bronze => of([0.86, 0.52, 0.25], 0.2 + 0.8 * key.powi(2), [0.6 * gloss, 0.5 * gloss, 0.4 * gloss]),
        Shading::Wax => {
            of([0.70, 0.16, 0.11], 0.4 + 0.7 * key, [0.3 * gloss + 0.25 * (1.0 - z).powi(2), 0.3 * gloss, 0.3 * gloss])
        }
        Shading::Material => of([0.97, 0.55, 0.26], 0.42 + 0.58 * key, [0.5 * gloss; 3]),
        Shading::Rendered => {
            let rim = toward([0.72, 0.45, 0.1]).powi(3);
            let shade = (key * 1.5).min(1.0).powi(2);
            of(
                [1.0, 0.52, 0.22],
                0.06 + 0.94 * shade,
                [0.75 * gloss + 0.2 * rim, 0.75 * gloss + 0.3 * rim, 0.75 * gloss + 0.65 * rim],
            )
        }
    }
}

/// Paints a ball: rings of triangles with a color at each corner.
fn paint_ball(ui: &Ui, center: Pos2, color: impl Fn([f32; 3]) -> Color32) {
    const RINGS: u32 = 8;
    const SECTORS: u32 = 28;
    let mut mesh = Mesh::default();
    let mut corner = |radius: f32, angle: f32, fade: f32| {
        let (sin, cos) = angle.sin_cos();
        let flat = radius.min(1.0);
        let color = color([cos * flat, sin * flat, (1.0 - flat * flat).max(0.0).sqrt()]).gamma_multiply(fade);
        mesh.vertices.push(Vertex { pos: center + vec2(cos, sin) * radius * BALL, uv: egui::epaint::WHITE_UV, color });
    };
    corner(0.0, 0.0, 1.0);
    // The last ring is transparent, which smooths the edge.
    for ring in 1..=RINGS + 1 {
        let radius = if ring > RINGS { 1.0 + 0.7 / BALL } else { (ring as f32 / RINGS as f32).sqrt() };
        for sector in 0..SECTORS {
            let angle = sector as f32 / SECTORS as f32 * std::f32::consts::TAU;
            corner(radius, angle, if ring > RINGS { 0.0 } else { 1.0 });
        }
    }
    for sector in 0..SECTORS {
        let next = (sector + 1) % SECTORS;
        mesh.add_triangle(0, 1 + sector, 1 + next);
        for ring in 0..RINGS {
            let [inner, outer] = [1 + ring * SECTORS, 1 + (ring + 1) * SECTORS];
            mesh.add_triangle(inner + sector, outer + sector, outer + next);
            mesh.add_triangle(inner + sector, outer + next, inner + next);
        }
    }
    ui.painter().add(mesh);
}
