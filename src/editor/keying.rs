//! Keys of parameters at the moment that is shown: the mark beside each parameter of the inspector, and the command
//! that sets keys of the selection.

use egui::{Color32, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::edit_session::EditSession;
use super::{selection, theme};
use isolith_document::Edit;
use isolith_scene::{Animation, KeyInterpolation, Keyframe, ParamOwner, ParamPath, Part, Scene};

/// Side of a mark in points.
const MARK: f32 = 9.0;

/// How a parameter changes with time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum KeyState {
    /// It does not.
    Still,
    /// It does, but has no key at the moment.
    Animated,
    /// It has a key at the moment.
    Keyed,
}

impl KeyState {
    /// The state of a parameter at a moment.
    pub fn of(animation: &Animation, path: &ParamPath, time: f64) -> Self {
        let states = animation.tracks_of(path).map(|track| match track.key_at(time) {
            Some(_) => Self::Keyed,
            None => Self::Animated,
        });
        states.max().unwrap_or(Self::Still)
    }

    /// The color of its mark.
    pub fn color(self) -> Color32 {
        match self {
            Self::Still => *theme::FAINT,
            Self::Animated => *theme::ANIMATED,
            Self::Keyed => *theme::KEYED,
        }
    }
}

/// The paths at which a parameter gets its keys: those of its elements if they are animated on their own.
fn key_paths(animation: &Animation, path: &ParamPath) -> Vec<ParamPath> {
    let known: Vec<_> = animation.tracks_of(path).map(|track| track.path.clone()).collect();
    if known.is_empty() { vec![path.clone()] } else { known }
}

/// Keys of these parameters at this moment, with the values that they have now.
fn keys_at(scene: &Scene, paths: &[ParamPath], time: f64) -> Vec<(ParamPath, Keyframe)> {
    let key = |path: ParamPath| {
        let value = path.get(scene).ok()?;
        let track = scene.animation.track(&path);
        let before = track.and_then(|track| track.keys.iter().rfind(|key| key.time <= time).or(track.keys.first()));
        let interpolation = before.map_or_else(KeyInterpolation::default, |key| key.interpolation);
        Some((path, Keyframe { time, value, interpolation }))
    };
    paths.iter().flat_map(|path| key_paths(&scene.animation, path)).filter_map(key).collect()
}

/// Sets keys of position, rotation and scale of the selected nodes that are not locked.
pub fn key_transforms(session: &mut EditSession) {
    let scene = session.document.snapshot();
    let free = session.document.selection().iter().filter(|id| selection::holder_of_lock(&scene, **id).is_none());
    let paths: Vec<ParamPath> = free
        .flat_map(|id| ["translation", "rotation", "scale"].map(|name| ParamPath::of_node(*id, Part::Transform, name)))
        .collect();
    if !paths.is_empty() {
        session.apply(Edit::SetKeys(keys_at(&scene, &paths, session.document.time())));
    }
}

/// Sets keys of these parameters at the moment that is shown, or removes them if all have one.
fn toggle(session: &mut EditSession, paths: &[ParamPath]) {
    let (scene, time) = (session.document.snapshot(), session.document.time());
    let is_keyed = |path: &ParamPath| KeyState::of(&scene.animation, path, time) == KeyState::Keyed;
    let edit = if paths.iter().all(is_keyed) {
        let keys = paths.iter().flat_map(|path| key_paths(&scene.animation, path));
        Edit::RemoveKeys(keys.map(|path| (path, time)).collect())
    } else {
        Edit::SetKeys(keys_at(&scene, paths, time))
    };
    session.apply(edit);
}

/// The mark of a parameter, in the margin beside its row, whose upper left corner is `top`: a filled diamond for a key
/// at this moment, a hollow one for a parameter that is animated. A click sets or removes the key.
pub fn mark(ui: &mut Ui, session: &mut EditSession, label: &str, paths: &[ParamPath], top: Pos2) {
    let Some(path) = paths.last() else { return };
    let document = &session.document;
    let (scene, time) = (document.scene(), document.time());
    let animatable = path.param(scene).is_ok_and(|param| param.animatable);
    if !animatable || !paths.iter().all(|path| path.get(scene).is_ok()) {
        return;
    }
    let states = paths.iter().map(|path| KeyState::of(&scene.animation, path, time));
    let state = states.min().unwrap_or(KeyState::Still);
    let center = pos2(top.x - 0.5 * MARK - 0.5, top.y + 0.5 * theme::ROW_HEIGHT);
    let rect = Rect::from_center_size(center, vec2(MARK, theme::ROW_HEIGHT));
    // Not in the order of the Tab key, which leads from field to field.
    let response = ui.interact(rect, ui.scope_id().with(("key", path)), Sense::CLICK);
    let line = rect.union(Rect::from_min_size(top, vec2(ui.available_width(), theme::ROW_HEIGHT)));
    if state != KeyState::Still || ui.rect_contains_pointer(line) {
        let color = if response.hovered() { *theme::STRONG } else { state.color() };
        diamond(ui, center, 0.5 * MARK, color, state == KeyState::Keyed);
    }
    let (name, help) = match state {
        KeyState::Keyed => (format!("Remove key: {label}"), "Removes the key at this moment"),
        KeyState::Animated => (format!("Insert key: {label}"), "Animated; sets a key at this moment"),
        KeyState::Still => (format!("Insert key: {label}"), "Animates it: sets a key at this moment"),
    };
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), &name));
    if response.on_hover_text(help).clicked() {
        toggle(session, paths);
    }
}

/// A diamond, filled or as an outline.
pub fn diamond(ui: &Ui, center: Pos2, radius: f32, color: Color32, is_filled: bool) {
    let corners = [vec2(0.0, -radius), vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0)];
    let points = corners.map(|corner| center + corner).to_vec();
    let fill = if is_filled { color } else { Color32::TRANSPARENT };
    ui.painter().add(Shape::convex_polygon(points, fill, Stroke::new(1.2, color)));
}

/// The name of a track for people.
pub fn track_name(scene: &Scene, path: &ParamPath) -> String {
    let param = path.param(scene);
    let label = param.as_ref().map_or_else(|_| path.name.to_string(), |param| param.label.to_string());
    let is_color = param.is_ok_and(|param| param.is_color);
    let element = path.element.map_or("", |index| {
        let names = if is_color { [" red", " green", " blue"] } else { [" X", " Y", " Z"] };
        names.get(index).copied().unwrap_or("")
    });
    let owner = match path.owner {
        ParamOwner::Node(id, _) => scene.node(id).map(|node| node.name.clone()),
        ParamOwner::Material(id) => scene.material(id).map(|material| material.name.clone()),
        ParamOwner::Environment => Some("World".into()),
        ParamOwner::Display => Some("Display".into()),
    };
    format!("{}: {label}{element}", owner.unwrap_or_default())
}
