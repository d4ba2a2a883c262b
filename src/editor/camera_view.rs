//! Looking through a camera of the scene: its frame, safe areas, and moving it with the view. Bookmarks of views.

use egui::{Color32, CornerRadius, Id, Painter, Rect, Stroke, StrokeKind, vec2};
use glam::{DAffine3, DQuat, DVec3};

use super::messages::Message;
use super::navigation::Navigation;
use super::state::EditorState;
use super::view_state::Through;
use super::{selection, theme};
use isolith_document::Edit;
use isolith_geometry::Camera;
use isolith_scene::{Bookmark, NodeId, NodeKind, check};

/// Share of the viewport that the frame fills.
const SHARE: f64 = 0.94;
/// Where action and titles are safe on every screen, as shares of the frame (EBU R 95).
const SAFE: [f32; 2] = [0.93, 0.9];
/// Farthest from the view that a camera is while one looks through it, in parts of its distance from the origin.
const SAME: f64 = 1e-9;

/// The camera that a node is, where it stands now.
fn camera_of(state: &EditorState, id: NodeId) -> Option<Camera> {
    let scene = state.session.document.scene();
    let NodeKind::Camera(camera) = &scene.node(id)?.kind else { return None };
    let (_, rotation, position) = scene.world_from_local(id).to_scale_rotation_translation();
    let fov_y = camera.fov_y.to_radians();
    Some(Camera { position, rotation: rotation.normalize(), fov_y, near: camera.near, far: camera.far })
}

/// Looks through a camera, with its frame inside of the viewport.
pub fn look_through(state: &mut EditorState, id: NodeId, focus: DVec3) {
    let Some(camera) = camera_of(state, id) else { return };
    let share = share(state);
    let mut view = state.view.navigation;
    show(&mut view, &camera, focus, share);
    state.view.navigation = view;
    state.view.through = Some(Through { camera: id, view, share });
}

/// Height of the frame as a share of the viewport's.
fn share(state: &EditorState) -> f64 {
    SHARE * (state.view.aspect() / state.view.frame_aspect).min(1.0)
}

fn show(view: &mut Navigation, camera: &Camera, focus: DVec3, share: f64) {
    view.look_through(camera, focus);
    view.fov_y = 2.0 * ((0.5 * camera.fov_y).tan() / share).atan();
}

/// Keeps view and camera together: the view follows a camera that moves; a locked camera follows the view, by the
/// gesture of this widget; otherwise a change of the view leaves the camera.
pub fn follow(state: &mut EditorState, widget: Id) {
    let Some(through) = state.view.through else { return };
    let Some(camera) = camera_of(state, through.camera) else {
        state.view.through = None;
        return;
    };
    let now = state.view.navigation;
    if now == through.view {
        let tolerance = SAME * (1.0 + camera.position.length());
        let is_same =
            camera.position.distance(now.eye()) < tolerance && camera.rotation.dot(now.rotation).abs() > 1.0 - SAME;
        let share = share(state);
        if !is_same || share != through.share {
            let mut view = now;
            show(&mut view, &camera, now.target, share);
            state.view.navigation = view;
            state.view.through = Some(Through { view, share, ..through });
        }
        return;
    }
    let scene = state.session.document.scene();
    let is_free = selection::holder_of_lock(scene, through.camera).is_none();
    if !state.view.locks_camera || !is_free || now.orthographic || now.fov_y != through.view.fov_y {
        state.view.through = None;
        return;
    }
    let parent = scene.node(through.camera).and_then(|node| node.parent);
    let world = parent.map_or(DAffine3::IDENTITY, |parent| scene.world_from_local(parent));
    let local = world.inverse() * DAffine3::from_rotation_translation(now.rotation, now.eye());
    let (_, rotation, translation): (DVec3, DQuat, DVec3) = local.to_scale_rotation_translation();
    if translation.is_finite() && rotation.is_finite() {
        state.session.change(widget, &[through.camera], |node| {
            (node.transform.rotation, node.transform.translation) = (rotation.normalize(), translation);
        });
    }
    state.view.through = Some(Through { view: now, ..through });
}

/// Paints the frame of the camera, and dims what is outside.
pub fn paint(state: &EditorState, painter: &Painter) {
    let Some(through) = state.view.through else { return };
    let whole = state.view.rect;
    let height = whole.height() * through.share as f32;
    let frame = Rect::from_center_size(whole.center(), vec2(height * state.view.frame_aspect as f32, height));
    let dim = Color32::from_black_alpha(110);
    let outside = [
        whole.with_max_y(frame.top()),
        whole.with_min_y(frame.bottom()),
        Rect::from_x_y_ranges(whole.left()..=frame.left(), frame.y_range()),
        Rect::from_x_y_ranges(frame.right()..=whole.right(), frame.y_range()),
    ];
    for part in outside.into_iter().filter(Rect::is_positive) {
        painter.rect_filled(part, 0.0, dim);
    }
    let color = if state.view.locks_camera { *theme::WARNING } else { theme::ON_PICTURE };
    painter.rect_stroke(frame, CornerRadius::ZERO, Stroke::new(1.5, color), StrokeKind::Outside);
    if state.view.show_safe_areas {
        for share in SAFE {
            let area = Rect::from_center_size(frame.center(), frame.size() * share);
            let stroke = Stroke::new(1.0, theme::ON_PICTURE.gamma_multiply(0.6));
            painter.rect_stroke(area, CornerRadius::same(3), stroke, StrokeKind::Inside);
        }
    }
}

/// Keeps the view in a bookmark.
pub fn set_bookmark(state: &mut EditorState, index: usize) {
    let Navigation { target, distance, rotation, fov_y, orthographic, .. } = state.view.navigation;
    let (target, rotation) = (target.to_array(), rotation.to_array());
    let kept = Bookmark { target, distance, rotation, fov_y, orthographic };
    state.session.apply(Edit::SetBookmark(index, Some(kept)));
    state.session.messages.push(Message::success(format!("Bookmark {} is this view.", index + 1)));
}

/// Shows the view of a bookmark.
pub fn show_bookmark(state: &mut EditorState, index: usize) {
    match state.session.document.scene().bookmarks.get(index).copied().flatten() {
        Some(Bookmark { target, distance, rotation, fov_y, orthographic }) => {
            let rotation = check::settled_rotation(DQuat::from_array(rotation));
            let target = DVec3::from_array(target);
            state.view.navigation =
                Navigation { target, distance, rotation, fov_y, orthographic, leaves_axis: orthographic };
        }
        None => {
            let text = format!("Bookmark {} is empty. *Set bookmark* keeps a view there.", index + 1).replace('*', "");
            state.session.messages.push(Message::info(text));
        }
    }
}
