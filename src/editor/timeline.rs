//! The panel at the bottom: play, pause, the moment, the ruler, and the keys of the selection below it.

use egui::{Align2, FontId, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use egui_material_icons::icons::{
    ICON_CHEVRON_LEFT, ICON_CHEVRON_RIGHT, ICON_PAUSE, ICON_PLAY_ARROW, ICON_REPEAT, ICON_SKIP_NEXT, ICON_SKIP_PREVIOUS,
};

use super::commands::command::Command;
use super::dope_sheet;
use super::numbers::{self, NumberField};
use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, Request};
use super::time_scale::TimeScale;
use super::{theme, widgets};
use isolith_document::Edit;
use isolith_scene::limits::{FRAMES_PER_SECOND, KEY_TIME};
use isolith_scene::{Limits, SAME_TIME, Timeline};

/// Height of the ruler in points.
const RULER: f32 = 22.0;
/// Least distance of two numbers on the ruler.
const APART: f32 = 64.0;
/// Speed of playback.
const SPEED: Limits = Limits::new([-4.0, 4.0], [-100.0, 100.0], "x");

/// The panel.
#[derive(Default)]
pub struct TimelinePanel;

impl Panel for TimelinePanel {
    fn id(&self) -> &'static str {
        "timeline"
    }

    fn title(&self) -> &'static str {
        "Timeline"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Lower(190.0)
    }

    fn slim_height(&self, state: &EditorState) -> Option<f32> {
        state.session.document.scene().animation.is_empty().then_some(theme::ROW_HEIGHT + RULER + 6.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        widgets::fixed(ui, |ui| {
            ui.horizontal(|ui| transport(state, ui));
            let scale = TimeScale::of(&state.session.document.scene().animation, ui.available_rect_before_wrap());
            let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), RULER), Sense::hover());
            ruler(state, ui, &scale, rect);
            let below = ui.available_rect_before_wrap();
            if state.session.document.scene().animation.is_empty() {
                state.playback.is_over_keys = false;
            } else {
                dope_sheet::show(state, ui, &scale);
            }
            let x = scale.x_of(state.session.document.time());
            if scale.lane.contains(x) {
                let bottom = if below.height() > 4.0 { below.bottom() } else { rect.bottom() };
                ui.painter().vline(x, rect.top()..=bottom, (1.5, theme::ACCENT));
            }
        });
    }
}

/// The buttons and numbers above the ruler.
fn transport(state: &mut EditorState, ui: &mut Ui) {
    let timeline = state.session.document.scene().animation.timeline;
    let mut go = None;
    if widgets::icon_button(ui, ICON_SKIP_PREVIOUS, "First frame", theme::TEXT).clicked() {
        go = Some(timeline.start);
    }
    if widgets::icon_button(ui, ICON_CHEVRON_LEFT, "Previous key", theme::TEXT).clicked() {
        go = near_key(state, false);
    }
    let (icon, name) = if state.playback.is_playing() { (ICON_PAUSE, "Pause") } else { (ICON_PLAY_ARROW, "Play") };
    if widgets::icon_button(ui, icon, name, theme::ACCENT).clicked() {
        state.requests.push(Request::Run(Command::Play));
    }
    if widgets::icon_button(ui, ICON_CHEVRON_RIGHT, "Next key", theme::TEXT).clicked() {
        go = near_key(state, true);
    }
    if widgets::icon_button(ui, ICON_SKIP_NEXT, "Last frame", theme::TEXT).clicked() {
        go = Some(timeline.end);
    }
    let color = if timeline.is_looping { theme::ACCENT } else { theme::WEAK };
    let repeat = widgets::icon_button(ui, ICON_REPEAT, "Loop", color);
    if repeat.clicked() {
        let changed = Timeline { is_looping: !timeline.is_looping, ..timeline };
        state.session.apply_by(repeat.id, Edit::SetTimeline(changed));
    }
    ui.add_space(6.0);
    go = numbers_of(state, ui, &timeline).or(go);
    dope_sheet::key_tools(state, ui);
    if let Some(time) = go {
        state.playback.pause();
        state.session.document.set_time(time);
    }
}

/// The frame that is shown, and the fields of the timeline. Returns the moment of another frame.
fn numbers_of(state: &mut EditorState, ui: &mut Ui, timeline: &Timeline) -> Option<f64> {
    let time = state.session.document.time();
    let frames = |[least, most]: [f64; 2]| [timeline.frame_at(least), timeline.frame_at(most)];
    let moments = Limits::new(frames([timeline.start, timeline.end]), frames(KEY_TIME.hard), "");
    let frame =
        field(ui, ("Frame", "The frame that is shown; frame 0 is at 0 seconds"), moments, timeline.frame_at(time));
    ui.label(RichText::new(format!("{time:.2} s")).color(theme::WEAK));
    ui.add_space(6.0);
    let ends =
        Limits::new([timeline.frame_at(timeline.start), timeline.frame_at(timeline.end)], frames(KEY_TIME.hard), "");
    let ends = Limits { soft: [ends.soft[0] - 100.0, ends.soft[1] + 100.0], ..ends };
    let start = field(ui, ("Start", "The first frame that is played"), ends, timeline.frame_at(timeline.start));
    let end = field(ui, ("End", "The last frame that is played"), ends, timeline.frame_at(timeline.end));
    let rate = field(ui, ("FPS", "Frames per second"), FRAMES_PER_SECOND, timeline.frames_per_second);
    for (widget, changed) in [
        start.map(|(widget, frame)| (widget, Timeline { start: timeline.time_of(frame), ..*timeline })),
        end.map(|(widget, frame)| (widget, Timeline { end: timeline.time_of(frame), ..*timeline })),
        rate.map(|(widget, rate)| (widget, Timeline { frames_per_second: rate, ..*timeline })),
    ]
    .into_iter()
    .flatten()
    {
        state.session.apply_by(widget, Edit::SetTimeline(changed));
    }
    if let Some((_, speed)) =
        field(ui, ("Speed", "Speed of playback; negative plays backward"), SPEED, state.playback.speed)
    {
        state.playback.speed = if speed == 0.0 { 1.0 } else { speed };
    }
    frame.map(|(_, frame)| timeline.time_of(frame.round()))
}

/// A label and a number.
fn field(ui: &mut Ui, (label, help): (&str, &str), limits: Limits, value: f64) -> Option<(egui::Id, f64)> {
    ui.label(RichText::new(label).color(theme::WEAK)).on_hover_text(help);
    let field = NumberField { label, help, limits, default: None };
    let response = numbers::number(ui, &field, label, (value * 1e4).round() / 1e4, false, 52.0);
    response.value.map(|value| (response.widget, value))
}

/// The moment of the next key after the one that is shown, or of the one before it.
fn near_key(state: &EditorState, is_after: bool) -> Option<f64> {
    let now = state.session.document.time();
    let tracks = dope_sheet::shown_tracks(state);
    let times = tracks.iter().flat_map(|track| track.keys.iter().map(|key| key.time));
    if is_after {
        times.filter(|time| *time > now + SAME_TIME).reduce(f64::min)
    } else {
        times.filter(|time| *time < now - SAME_TIME).reduce(f64::max)
    }
}

/// The frames, and the handle of the moment: a drag scrubs.
fn ruler(state: &mut EditorState, ui: &mut Ui, scale: &TimeScale, rect: Rect) {
    let timeline = state.session.document.scene().animation.timeline;
    let lane = Rect::from_x_y_ranges(scale.lane, rect.y_range());
    let response = ui.interact(lane, ui.scope_id().with("ruler"), Sense::CLICK | Sense::DRAG);
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, "Ruler"));
    let response = response.on_hover_text("The moment that is shown: click or drag");
    let painter = ui.painter().with_clip_rect(lane);
    painter.rect_filled(lane, 3.0, theme::BAR);
    let played = scale.x_of(timeline.start)..=scale.x_of(timeline.end);
    painter.rect_filled(Rect::from_x_y_ranges(played, lane.y_range()), 0.0, theme::CARD);
    let per_frame = f64::from(scale.x_of(timeline.time_of(1.0)) - scale.x_of(0.0)).max(1e-9);
    let step = step_of(f64::from(APART) / per_frame);
    let first = (timeline.frame_at(scale.range[0]) / step).ceil();
    for index in 0..256 {
        let frame = (first + f64::from(index)) * step;
        let x = scale.x_of(timeline.time_of(frame));
        if x > lane.right() {
            break;
        }
        painter.vline(x, lane.bottom() - 6.0..=lane.bottom(), (1.0, theme::FAINT));
        let text = pos2(x + 3.0, lane.center().y - 2.0);
        painter.text(text, Align2::LEFT_CENTER, format!("{frame}"), FontId::proportional(11.0), *theme::WEAK);
    }
    state.playback.is_scrubbing = response.dragged();
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked()) {
        state.playback.pause();
        let time = timeline.snapped(scale.time_at(pointer.x)).clamp(scale.range[0], scale.range[1]);
        state.session.document.set_time(time);
    }
}

/// The least of 1, 2, 5, 10, 20… that is at least this many frames.
fn step_of(least: f64) -> f64 {
    let mut step = 1.0;
    for factor in [2.0, 2.5, 2.0].into_iter().cycle().take(60) {
        if step >= least {
            break;
        }
        step *= factor;
    }
    step
}

#[cfg(test)]
mod tests {
    use super::step_of;

    #[test]
    fn steps_of_the_ruler_are_round() {
        assert_eq!([0.1, 1.0, 1.5, 3.0, 6.0, 11.0, 170.0].map(step_of), [1.0, 1.0, 2.0, 5.0, 10.0, 20.0, 200.0]);
    }
}
