//! The window of the field doctor: findings with their repairs, and what a picture costs.

use egui::{
    Align, Button, Color32, ComboBox, Context, DragValue, Frame, Id, Label, Layout, Margin, ProgressBar, Rect,
    RichText, ScrollArea, Sense, Ui, Window, vec2,
};
use egui_material_icons::icons::{ICON_CHECK_CIRCLE, ICON_ERROR, ICON_SPEED, ICON_WARNING};

use super::doctor::{Doctor, DoctorTab, repair};
use super::root::Editor;
use super::state::EditorState;
use super::{theme, widgets};
use isolith_field::doctor::{Finding, FindingKind, Repair};
use isolith_scene::NodeId;
use isolith_session::{NodeCost, SceneCost, SharedStudio};

/// Size of the window's content, in points.
const SIZE: egui::Vec2 = vec2(430.0, 440.0);
/// Maximum number of characters of a node's name.
const NAME: usize = 34;
/// Most nodes in the list of costs.
const NODES_LISTED: usize = 60;
/// Pictures per second to aim at.
const AIMS: [u32; 3] = [30, 60, 120];
/// Colors of the passes in the bar.
const COLORS: [Color32; 6] = [
    Color32::from_rgb(96, 156, 224),
    Color32::from_rgb(126, 200, 136),
    Color32::from_rgb(232, 178, 92),
    Color32::from_rgb(196, 130, 214),
    Color32::from_rgb(226, 112, 104),
    Color32::from_rgb(120, 196, 200),
];

/// What the artist asks for.
enum Wish {
    Scan,
    Select(NodeId),
    Repair(Vec<Repair>),
}

impl Editor {
    /// Opens the window, and looks at the scene.
    pub(super) fn open_doctor(&mut self) {
        self.doctor.is_open = true;
        self.examine_scene();
    }

    fn examine_scene(&mut self) {
        self.state.session.finish();
        self.doctor.scan(&self.state);
        self.doctor.measure(&self.state, self.studio.as_ref());
    }

    /// What the field doctor has found; `None` before it has looked.
    pub fn findings(&self) -> Option<Vec<Finding>> {
        self.doctor.findings.as_ref().map(|_| self.doctor.all_findings())
    }

    /// Shows the window, and follows its jobs.
    pub(super) fn show_doctor(&mut self, ctx: &Context) {
        self.doctor.poll(ctx, self.state.session.document.scene());
        match self.doctor.show(&self.state, self.studio.as_ref(), ctx) {
            None => {}
            Some(Wish::Scan) => self.examine_scene(),
            Some(Wish::Select(node)) => {
                self.state.session.finish();
                self.state.session.document.select(vec![node]);
                self.state.frame_selected();
            }
            Some(Wish::Repair(repairs)) => {
                repair(&mut self.state.session, &repairs);
                self.state.follow_document();
                self.wants_scan = true;
            }
        }
        // The arrays of what was repaired may take a job.
        if self.wants_scan && !self.state.derived.is_preparing() {
            self.wants_scan = false;
            self.examine_scene();
        }
    }
}

/// The window.
pub(super) fn window_id() -> Id {
    Id::unique("field doctor")
}

impl Doctor {
    fn show(&mut self, state: &EditorState, studio: Option<&SharedStudio>, ctx: &Context) -> Option<Wish> {
        let mut is_open = self.is_open;
        let mut wish = None;
        let place = ctx.content_rect().right_top() + vec2(-SIZE.x - 340.0, 110.0);
        Window::new("Field doctor")
            .id(window_id())
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_pos(place.max(ctx.content_rect().left_top() + vec2(8.0, 90.0)))
            .show(ctx, |ui| {
                ui.set_width(SIZE.x);
                ui.horizontal(|ui| {
                    ui.selectable_value(&mut self.tab, DoctorTab::Findings, "Findings");
                    ui.selectable_value(&mut self.tab, DoctorTab::Cost, "Cost");
                });
                ui.separator();
                let room = SIZE.y.min(ctx.content_rect().height() - 300.0).max(120.0);
                wish = match self.tab {
                    DoctorTab::Findings => self.findings_list(state, room, ui),
                    DoctorTab::Cost => self.costs(state, studio, room, ui),
                };
                ui.separator();
                wish = self.bottom(state, ui).or(wish.take());
            });
        self.is_open &= is_open;
        wish
    }

    fn findings_list(&mut self, state: &EditorState, room: f32, ui: &mut Ui) -> Option<Wish> {
        let mut wish = None;
        let findings = self.all_findings();
        ScrollArea::vertical().max_height(room).min_scrolled_height(room).auto_shrink([false, false]).show(ui, |ui| {
            if self.findings.is_some() && findings.is_empty() {
                ui.add_space(0.3 * room);
                ui.vertical_centered(|ui| {
                    if !self.is_busy() {
                        ui.label(ICON_CHECK_CIRCLE.rich_text().size(34.0).color(*theme::SUCCESS));
                    }
                    ui.label(match (self.is_busy(), self.cost.is_some()) {
                        (true, _) => "Nothing found so far.",
                        (false, true) => "Nothing to complain about.",
                        (false, false) => "Nothing is wrong. What nodes cost was not measured.",
                    });
                });
            }
            if self.findings.is_none() && !self.is_busy() {
                let text = "Looks for nodes whose field breaks its promise, which make rays slow, or which do nothing.";
                ui.add(Label::new(RichText::new(text).weak()).wrap());
            }
            for (index, finding) in findings.iter().enumerate() {
                ui.push_id(index, |ui| wish = row(state, finding, ui).or(wish.take()));
            }
        });
        self.options(ui);
        let repairs: Vec<Repair> = findings.iter().filter_map(|finding| finding.repair).collect();
        if repairs.len() > 1 && !self.is_outdated(state) {
            let button = ui.button(format!("Repair all {}", repairs.len()));
            if button.on_hover_text("One step of undo takes all of it back").clicked() {
                wish = Some(Wish::Repair(repairs));
            }
        }
        wish
    }

    /// What to look for besides, for those who print.
    fn options(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label(RichText::new("For printing:").weak());
            ui.checkbox(&mut self.loose_parts, "Loose parts").on_hover_text("Parts that are not joined to the largest");
            ui.checkbox(&mut self.walls.0, "Walls below").on_hover_text("Walls that are thinner than this");
            let limit = DragValue::new(&mut self.walls.1).range(0.01..=1e6).speed(0.05).suffix(" mm");
            let response = ui.add_enabled(self.walls.0, limit);
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Least thickness of walls"));
        });
    }

    fn costs(&mut self, state: &EditorState, studio: Option<&SharedStudio>, room: f32, ui: &mut Ui) -> Option<Wish> {
        let mut wish = None;
        let Some(cost) = &self.cost else {
            let text = match (studio.is_some(), self.is_busy()) {
                (false, _) => "There is no renderer to measure with.",
                (true, true) => "Measuring…",
                (true, false) => "Scan the scene, and what a picture of the viewport takes stands here.",
            };
            ui.label(RichText::new(text).weak());
            ui.add_space(room);
            return None;
        };
        budget_bar(cost, &mut self.aim, ui);
        ui.add_space(4.0);
        ScrollArea::vertical().max_height(room - 90.0).auto_shrink([false, false]).show(ui, |ui| {
            for node in cost.nodes.iter().take(NODES_LISTED) {
                wish = cost_row(state, cost, node, ui).or(wish.take());
            }
        });
        wish
    }

    fn bottom(&mut self, state: &EditorState, ui: &mut Ui) -> Option<Wish> {
        let mut wish = None;
        if let Some(problem) = &self.problem {
            ui.add(Label::new(RichText::new(problem).color(ui.visuals().error_fg_color)).wrap());
        }
        ui.horizontal(|ui| match self.task() {
            Some(task) => {
                let share = task.progress().unwrap_or(0.0);
                let bar = ProgressBar::new(share).desired_width(ui.available_width() - 96.0).desired_height(20.0);
                let text = format!("{:.0} %  ·  {}", 100.0 * share, task.stage());
                ui.add(bar.text(RichText::new(text).color(ui.visuals().text_color())));
                if ui.button("Cancel").clicked() {
                    task.cancel();
                }
            }
            None => {
                let count = self.findings.as_ref().map(|_| self.all_findings().len());
                let text = match (count, self.is_outdated(state)) {
                    (_, true) => "The scene has changed since.".to_owned(),
                    (Some(0), _) => "No findings".to_owned(),
                    (Some(1), _) => "One finding".to_owned(),
                    (Some(count), _) => format!("{count} findings"),
                    (None, _) => String::new(),
                };
                ui.label(RichText::new(text).weak());
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let text = RichText::new("Scan").color(theme::ON_ACCENT);
                    let button = ui.add(Button::new(text).fill(*theme::ACCENT).min_size(vec2(84.0, 24.0)));
                    ui.ctx().accesskit_node_builder(button.id, |node| node.set_label("Scan the scene"));
                    if button.clicked() {
                        wish = Some(Wish::Scan);
                    }
                });
            }
        });
        wish
    }
}

/// The name of a node, cut to a readable length.
fn name_of(state: &EditorState, node: NodeId) -> String {
    let scene = state.session.document.scene();
    widgets::elided(scene.node(node).map_or("", |node| node.name.as_str()), NAME)
}

/// A finding with its repair.
fn row(state: &EditorState, finding: &Finding, ui: &mut Ui) -> Option<Wish> {
    let mut wish = None;
    let (icon, color) = match finding.kind {
        kind if kind.is_grave() => (ICON_ERROR, ui.visuals().error_fg_color),
        FindingKind::Slow | FindingKind::SmallSteps => (ICON_SPEED, ui.visuals().warn_fg_color),
        _ => (ICON_WARNING, ui.visuals().warn_fg_color),
    };
    let fill = ui.visuals().faint_bg_color;
    Frame::new().fill(fill).corner_radius(6.0).inner_margin(Margin::symmetric(9, 6)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            ui.label(icon.rich_text().size(theme::ICON_SIZE).color(color));
            let name = name_of(state, finding.node);
            let button = ui.add(Button::new(RichText::new(&name).strong()).frame(false));
            ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(format!("Find {name}")));
            if button.on_hover_text("Selects the node and frames it").clicked() {
                wish = Some(Wish::Select(finding.node));
            }
            ui.label(finding.kind.title());
            if let Some(repair) = finding.repair {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let button = ui.small_button(repair.label());
                    let said = format!("{}: {name}", repair.label());
                    ui.ctx().accesskit_node_builder(button.id, |node| node.set_label(said));
                    if button.clicked() {
                        wish = Some(Wish::Repair(vec![repair]));
                    }
                });
            }
        });
        if !finding.detail.is_empty() {
            ui.add(Label::new(capitalized(&finding.detail) + ".").wrap());
        }
        ui.add(Label::new(RichText::new(finding.kind.meaning().to_owned() + ".").weak().small()).wrap());
    });
    ui.add_space(2.0);
    wish
}

fn capitalized(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().to_string() + chars.as_str())
}

/// The passes of a picture beside what there is time for.
fn budget_bar(cost: &SceneCost, aim: &mut u32, ui: &mut Ui) {
    let budget = 1.0 / f64::from(*aim);
    let [width, height] = cost.size;
    ui.horizontal(|ui| {
        let text = format!("{:.1} ms for {width} × {height} pixels", 1e3 * cost.seconds);
        ui.label(RichText::new(text).strong()).on_hover_text(&cost.adapter);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let combo = ComboBox::from_id_salt("aim").selected_text(format!("{aim} per second")).width(110.0);
            let response = combo.show_ui(ui, |ui| {
                for choice in AIMS {
                    ui.selectable_value(aim, choice, format!("{choice} per second"));
                }
            });
            ui.ctx().accesskit_node_builder(response.response.id, |node| node.set_label("Pictures per second"));
        });
    });
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
    ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    // The whole bar is the budget, or the picture if that takes longer.
    let all = budget.max(cost.seconds);
    let on_device: f64 = cost.passes.iter().map(|pass| pass.seconds).sum();
    let mut at = rect.left();
    for (index, pass) in cost.passes.iter().enumerate() {
        // Clocks of single passes slow a picture down: their shares of the picture count, not their sum.
        let share = pass.seconds / on_device.max(1e-12) * cost.seconds / all;
        let width = rect.width() * share as f32;
        let part = Rect::from_x_y_ranges(at..=at + width, rect.y_range());
        ui.painter().rect_filled(part, 0.0, COLORS[index % COLORS.len()]);
        at += width;
    }
    if cost.passes.is_empty() {
        let part = Rect::from_x_y_ranges(
            rect.left()..=rect.left() + rect.width() * (cost.seconds / all) as f32,
            rect.y_range(),
        );
        ui.painter().rect_filled(part, 3.0, COLORS[0]);
    }
    let limit = rect.left() + rect.width() * (budget / all) as f32;
    ui.painter().vline(limit, rect.y_range().expand(2.0), (2.0, ui.visuals().strong_text_color()));
    response.on_hover_text(format!("The line is the budget: {:.1} ms", 1e3 * budget));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (index, pass) in cost.passes.iter().enumerate() {
            let share = 100.0 * pass.seconds / on_device.max(1e-12);
            let (dot, _) = ui.allocate_exact_size(vec2(9.0, 9.0), Sense::hover());
            ui.painter().rect_filled(dot, 2.0, COLORS[index % COLORS.len()]);
            ui.label(RichText::new(format!("{} {share:.0} %", pass.name)).small())
                .on_hover_text(pass_meaning(pass.name));
        }
    });
    let verdict = match cost.seconds <= budget {
        true => format!("{:.0} % of the budget", 100.0 * cost.seconds / budget),
        false => format!("{:.1} times the budget", cost.seconds / budget),
    };
    let color = if cost.seconds <= budget { *theme::SUCCESS } else { ui.visuals().warn_fg_color };
    ui.label(RichText::new(verdict).color(color));
}

/// What a pass does, in plain words.
fn pass_meaning(name: &str) -> &'static str {
    match name {
        "mesh" => "Draws triangle meshes",
        "hiz" => "Finds what meshes hide",
        "resolution" => "Chooses rays of parts with a resolution of their own",
        "cone" => "Skips empty space around each part",
        "trace" => "Marches rays to the surfaces of fields",
        "surface" => "Normals and materials of what is seen",
        "shadow" => "Soft shadows and occlusion",
        "shade" => "Light and background",
        _ => "The finished picture",
    }
}

/// A node with its share.
fn cost_row(state: &EditorState, cost: &SceneCost, node: &NodeCost, ui: &mut Ui) -> Option<Wish> {
    let share = cost.share(node);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 22.0), Sense::click());
    let bar = Rect::from_min_size(rect.min, vec2(rect.width() * share as f32, rect.height()));
    ui.painter().rect_filled(bar, 3.0, COLORS[0].gamma_multiply(0.35));
    if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, ui.visuals().widgets.hovered.bg_fill.gamma_multiply(0.4));
    }
    let others = if node.others > 0 { format!(" and {} more", node.others) } else { String::new() };
    let name = name_of(state, node.node) + &others;
    let font = egui::TextStyle::Body.resolve(ui.style());
    let text = format!("{:.0} %  ·  {:.1} per pixel", 100.0 * share, cost.per_pixel(node));
    let (strong, weak) = (ui.visuals().text_color(), ui.visuals().weak_text_color());
    ui.painter().text(rect.left_center() + vec2(6.0, 0.0), egui::Align2::LEFT_CENTER, &name, font.clone(), strong);
    ui.painter().text(rect.right_center() - vec2(6.0, 0.0), egui::Align2::RIGHT_CENTER, text, font, weak);
    ui.ctx().accesskit_node_builder(response.id, |builder| builder.set_label(format!("Cost of {name}")));
    let help = "Share of the shapes, modifiers and groups that a picture reads, and evaluations of the field per pixel";
    response.on_hover_text(help).clicked().then_some(Wish::Select(node.node))
}
