//! The keys of the selected nodes, or of everything: a row for each animated parameter.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Align2, FontId, Pos2, Rect, Response, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};
use egui_material_icons::icons::{ICON_CONTENT_PASTE, ICON_DELETE};

use super::edit_session::EditSession;
use super::keying::{diamond, track_name};
use super::playback::{KeyDrag, KeyId, Playback};
use super::state::EditorState;
use super::time_scale::TimeScale;
use super::{theme, widgets};
use isolith_document::Edit;
use isolith_scene::limits::KEY_TIME;
use isolith_scene::{KeyInterpolation, Keyframe, MaterialId, NodeId, ParamOwner, ParamPath, Scene, Timeline, Track};

/// Height of a row in points.
const ROW: f32 = 20.0;
/// Half the height of a key in points, and how near a press must be.
const KEY: f32 = 5.0;
const NEAR: f32 = 7.0;

/// The tracks of the selected nodes and their materials; all tracks without a selection.
pub fn shown_tracks(state: &EditorState) -> Vec<Arc<Track>> {
    let document = &state.session.document;
    let (scene, selection) = (document.scene(), document.selection());
    let nodes: BTreeSet<NodeId> = selection.iter().copied().collect();
    let materials: BTreeSet<MaterialId> =
        selection.iter().filter_map(|id| scene.node(*id)).flat_map(|node| node.materials()).collect();
    let is_shown = |track: &&Arc<Track>| match track.path.owner {
        _ if nodes.is_empty() => true,
        ParamOwner::Node(id, _) => nodes.contains(&id),
        ParamOwner::Material(id) => materials.contains(&id),
        ParamOwner::Environment | ParamOwner::Display => false,
    };
    scene.animation.tracks().iter().filter(is_shown).cloned().collect()
}

/// The rows.
pub fn show(state: &mut EditorState, ui: &mut Ui, scale: &TimeScale) {
    let tracks = shown_tracks(state);
    let area = ui.available_rect_before_wrap();
    state.playback.is_over_keys = ui.rect_contains_pointer(area);
    let scene = state.session.document.snapshot();
    forget_lost(&mut state.playback, &scene);
    if tracks.is_empty() {
        let hint = "The selection has no keys. K sets some for its position, rotation and scale.";
        ui.label(RichText::new(hint).color(theme::WEAK));
        return;
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, tracks.len(), |ui, rows| {
        for track in &tracks[rows] {
            row(state, ui, scale, &scene, track);
        }
    });
}

/// Forgets selected keys that are gone.
fn forget_lost(playback: &mut Playback, scene: &Scene) {
    let is_there = |(path, bits): &KeyId| {
        let track = scene.animation.track(path);
        track.is_some_and(|track| track.keys.iter().any(|key| key.time.to_bits() == *bits))
    };
    playback.selected.retain(is_there);
}

fn row(state: &mut EditorState, ui: &mut Ui, scale: &TimeScale, scene: &Scene, track: &Track) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let name = track_name(scene, &track.path);
    let lane = Rect::from_x_y_ranges(scale.lane, rect.y_range());
    let names = rect.with_max_x(lane.left() - 6.0);
    let painter = ui.painter().with_clip_rect(names.intersect(ui.clip_rect()));
    painter.text(names.left_center(), Align2::LEFT_CENTER, &name, FontId::proportional(12.5), *theme::TEXT);
    let response = ui.interact(lane, ui.scope_id().with(("keys", &track.path)), Sense::CLICK | Sense::DRAG);
    response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, format!("Keys of {name}")));
    ui.painter().hline(lane.x_range(), rect.bottom(), (1.0, theme::LINE));
    for pair in track.keys.windows(2).filter(|pair| pair[0].interpolation == KeyInterpolation::Hold) {
        let [from, to] = [&pair[0], &pair[1]].map(|key| scale.x_of(key.time));
        ui.painter().hline(from..=to, lane.center().y, (3.0, theme::FAINT));
    }
    for key in &track.keys {
        let is_selected = state.playback.selected.contains(&id_of(track, key));
        let color = if is_selected { *theme::KEYED } else { *theme::TEXT };
        diamond(ui, pos2(scale.x_of(key.time), lane.center().y), KEY, color, true);
    }
    answer(state, ui, scale, track, &response);
    response.context_menu(|ui| key_menu(state, ui));
}

fn id_of(track: &Track, key: &Keyframe) -> KeyId {
    (track.path.clone(), key.time.to_bits())
}

/// The key of the track under the pointer.
fn key_under(track: &Track, scale: &TimeScale, pointer: Pos2) -> Option<KeyId> {
    let distance = |key: &Keyframe| (scale.x_of(key.time) - pointer.x).abs();
    let nearest = track.keys.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(nearest) <= NEAR).then(|| id_of(track, nearest))
}

/// Clicks select, drags move.
fn answer(state: &mut EditorState, ui: &Ui, scale: &TimeScale, track: &Track, response: &Response) {
    let (origin, pointer, modifiers) = ui.input(|i| (i.pointer.press_origin(), i.pointer.interact_pos(), i.modifiers));
    let selected = &mut state.playback.selected;
    if response.clicked() || response.secondary_clicked() {
        let key = response.interact_pointer_pos().and_then(|at| key_under(track, scale, at));
        match key {
            None if modifiers.shift => {}
            None => selected.clear(),
            Some(key) if modifiers.shift && response.clicked() => {
                if !selected.remove(&key) {
                    selected.insert(key);
                }
            }
            Some(key) if response.secondary_clicked() && selected.contains(&key) => {}
            Some(key) => *selected = BTreeSet::from([key]),
        }
    }
    if response.drag_started()
        && let Some(origin) = origin
        && let Some(key) = key_under(track, scale, origin)
    {
        if !selected.contains(&key) {
            *selected = BTreeSet::from([key]);
        }
        let keys = selected.clone();
        let originals = tracks_with(state.session.document.scene(), &keys);
        let from = scale.time_at(origin.x);
        state.playback.drag = Some(KeyDrag { originals, keys, from, copies: modifiers.command });
    }
    if response.dragged()
        && let (Some(pointer), Some(drag)) = (pointer, state.playback.drag.take())
    {
        let timeline = state.session.document.scene().animation.timeline;
        let by = scale.time_at(pointer.x) - drag.from;
        let (tracks, moved) = shifted(&drag, &timeline, by);
        state.session.apply_by(response.id, Edit::SetTracks(tracks));
        state.playback.selected = moved;
        state.playback.drag = Some(drag);
    }
    if response.drag_stopped() {
        state.playback.drag = None;
    }
}

/// Copies of the tracks that hold these keys.
fn tracks_with(scene: &Scene, keys: &BTreeSet<KeyId>) -> Vec<Track> {
    let paths: BTreeSet<&ParamPath> = keys.iter().map(|(path, _)| path).collect();
    paths.into_iter().filter_map(|path| scene.animation.track(path)).map(|track| Track::clone(track)).collect()
}

/// The tracks with the keys moved, or copied, by some seconds in whole frames, and where these keys are now. They
/// replace others that stand there.
fn shifted(drag: &KeyDrag, timeline: &Timeline, by: f64) -> (Vec<Track>, BTreeSet<KeyId>) {
    let frames = timeline.frame_at(by).round();
    let mut moved = BTreeSet::new();
    let tracks = drag.originals.iter().map(|original| {
        let is_moved = |key: &&Keyframe| drag.keys.contains(&id_of(original, key));
        let stays = |key: &&Keyframe| drag.copies || !is_moved(key);
        let mut track = Track { keys: original.keys.iter().filter(stays).cloned().collect(), ..original.clone() };
        for key in original.keys.iter().filter(is_moved) {
            // Without a step the key keeps every digit of its moment.
            let time = if frames == 0.0 { key.time } else { key.time + timeline.time_of(frames) };
            let key = Keyframe { time: time.clamp(KEY_TIME.hard[0], KEY_TIME.hard[1]), ..key.clone() };
            moved.insert(id_of(&track, &key));
            track.set(key);
        }
        track
    });
    (tracks.collect(), moved)
}

/// The choice of what happens to the selected keys, beside the numbers of the timeline.
pub fn key_tools(state: &mut EditorState, ui: &mut Ui) {
    if state.playback.selected.is_empty() {
        return;
    }
    ui.add_space(6.0);
    let keys = tracks_with(state.session.document.scene(), &state.playback.selected);
    let chosen: BTreeSet<_> =
        selected_keys(&keys, &state.playback.selected).map(|key| key.interpolation as u8).collect();
    let all = KeyInterpolation::ALL;
    let current = (chosen.len() == 1).then(|| all.into_iter().find(|one| chosen.contains(&(*one as u8)))).flatten();
    ui.scope(|ui| {
        ui.set_max_width(96.0);
        let (_, picked) =
            widgets::choice(ui, "Interpolation", current, &all, KeyInterpolation::label, KeyInterpolation::help);
        if let Some(picked) = picked {
            interpolate(state, picked);
        }
    });
    if widgets::icon_button(ui, ICON_CONTENT_PASTE, "Copy keys to this moment", theme::TEXT).clicked() {
        copy_here(state);
    }
    if widgets::icon_button(ui, ICON_DELETE, "Delete keys", theme::TEXT).clicked() {
        delete(&mut state.session, &mut state.playback);
    }
}

/// The same as a menu.
fn key_menu(state: &mut EditorState, ui: &mut Ui) {
    if state.playback.selected.is_empty() {
        ui.label(RichText::new("No key is selected").color(theme::WEAK));
        return;
    }
    for interpolation in KeyInterpolation::ALL {
        if ui.button(interpolation.label()).on_hover_text(interpolation.help()).clicked() {
            interpolate(state, interpolation);
        }
    }
    ui.separator();
    if ui.button("Copy keys to this moment").clicked() {
        copy_here(state);
    }
    if ui.button("Delete keys").clicked() {
        delete(&mut state.session, &mut state.playback);
    }
}

fn selected_keys<'a>(tracks: &'a [Track], selected: &'a BTreeSet<KeyId>) -> impl Iterator<Item = &'a Keyframe> {
    let of_track = |track: &'a Track| track.keys.iter().filter(|key| selected.contains(&id_of(track, key)));
    tracks.iter().flat_map(of_track)
}

fn interpolate(state: &mut EditorState, interpolation: KeyInterpolation) {
    let selected = &state.playback.selected;
    let mut tracks = tracks_with(state.session.document.scene(), selected);
    for track in &mut tracks {
        let path = track.path.clone();
        for key in track.keys.iter_mut().filter(|key| selected.contains(&(path.clone(), key.time.to_bits()))) {
            key.interpolation = interpolation;
        }
    }
    state.session.apply(Edit::SetTracks(tracks));
}

/// Copies the selected keys so that the first of them stands at the moment that is shown.
fn copy_here(state: &mut EditorState) {
    let document = &state.session.document;
    let keys = state.playback.selected.clone();
    let originals = tracks_with(document.scene(), &keys);
    let Some(first) = selected_keys(&originals, &keys).map(|key| key.time).reduce(f64::min) else { return };
    let by = document.time() - first;
    let timeline = document.scene().animation.timeline;
    let (tracks, copies) = shifted(&KeyDrag { originals, keys, from: first, copies: true }, &timeline, by);
    state.session.apply(Edit::SetTracks(tracks));
    state.playback.selected = copies;
}

/// Deletes the selected keys.
pub fn delete(session: &mut EditSession, playback: &mut Playback) {
    let keys = std::mem::take(&mut playback.selected);
    session.apply(Edit::RemoveKeys(keys.into_iter().map(|(path, bits)| (path, f64::from_bits(bits))).collect()));
}
