//! What the viewport shows and from where, and what goes out to the renderer.

use egui::{Pos2, Rect, TextureId, vec2};
use glam::DVec3;

use super::navigation::Navigation;
use isolith_field::debug_view::ViewMode;
use isolith_geometry::Camera;

/// What the renderer has made.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// The picture, once there is one.
    pub texture: Option<TextureId>,
    /// Its size in pixels.
    pub size_px: [u32; 2],
    /// How much of it is done, 0 to 1; `None` when nothing is being drawn.
    pub progress: Option<f32>,
    /// Whether the full picture waits for what is being prepared for it.
    pub is_waiting: bool,
    /// A few words for the status bar: adapter, milliseconds.
    pub status: String,
}

/// What the renderer should make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// From where.
    pub camera: Camera,
    /// Size of the viewport in pixels; at least 1 × 1.
    pub size_px: [u32; 2],
    /// The camera or a value is being dragged: a fast picture is worth more than a fine one.
    pub navigating: bool,
    /// Whether the ground grid is wanted.
    pub show_grid: bool,
    /// Whether the selection is to be marked.
    pub show_outline: bool,
    /// What the picture is to show.
    pub view_mode: ViewMode,
}

/// What the pointer does in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PointerActivity {
    /// It is elsewhere.
    #[default]
    Away,
    /// It rests over the picture.
    Hovering,
    /// It turns the camera.
    Orbiting,
    /// It moves the camera sideways.
    Panning,
    /// It moves the camera to and fro.
    Zooming,
    /// It moves the selection, so far by this.
    Moving(DVec3),
}

/// How the document is looked at.
pub struct ViewState {
    /// The camera.
    pub navigation: Navigation,
    /// What the picture shows.
    pub view_mode: ViewMode,
    /// Whether the ground grid is shown.
    pub show_grid: bool,
    /// Whether the selection is marked.
    pub show_outline: bool,
    /// Where the picture is, in points.
    pub rect: Rect,
    /// Its size in pixels, at least 1 × 1.
    pub size_px: [u32; 2],
    /// Whether the camera is being moved, or something in the picture is.
    pub is_navigating: bool,
    /// What the pointer does in it.
    pub pointer: PointerActivity,
    /// The picture is to stay as it is until something changes.
    pub stops_drawing: bool,
}

impl Default for ViewState {
    fn default() -> Self {
        Self {
            navigation: Navigation::default(),
            view_mode: ViewMode::Shaded,
            show_grid: true,
            show_outline: true,
            rect: Rect::from_min_size(Pos2::ZERO, vec2(640.0, 480.0)),
            size_px: [640, 480],
            is_navigating: false,
            pointer: PointerActivity::Away,
            stops_drawing: false,
        }
    }
}

impl ViewState {
    /// Width by height.
    pub fn aspect(&self) -> f64 {
        let [width, height] = self.size_px.map(f64::from);
        width / height
    }
}
