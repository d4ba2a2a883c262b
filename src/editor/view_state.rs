//! The view of the viewport, and the data exchanged with the renderer.

use egui::{Event, Pos2, Rect, TextureId, vec2};

use super::choice_walk::{BelowList, Walk};
use super::commands::command::Command;
use super::navigation::Navigation;
use super::snapping::SnapSettings;
use super::transforms::kinds::{Orientation, PivotPoint, Tool, TransformKind};
use super::transforms::starts::LastMotion;
use isolith_field::Shading;
use isolith_field::debug_view::ViewMode;
use isolith_geometry::Camera;
use isolith_scene::{NodeId, ShapeKind};

/// The output of the renderer.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// The picture; `None` before the first.
    pub texture: Option<TextureId>,
    /// Its size in pixels.
    pub size_px: [u32; 2],
    /// Fraction of it that is done, 0 to 1; `None` while the renderer is idle.
    pub progress: Option<f32>,
    /// Whether the full picture waits for pipelines or tapes.
    pub is_waiting: bool,
    /// Number of accumulated samples, and of those that are wanted; `None` if the picture has no samples.
    pub samples: Option<[u32; 2]>,
    /// Whether samples are being added.
    pub is_sampling: bool,
    /// Text for the status bar: adapter, milliseconds.
    pub status: String,
}

/// The input of the renderer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// The camera.
    pub camera: Camera,
    /// Size of the viewport in pixels; at least 1 × 1.
    pub size_px: [u32; 2],
    /// The artist drags the camera or a value: speed is more important than quality.
    pub navigating: bool,
    /// Whether to show the grid.
    pub show_grid: bool,
    /// The grid.
    pub grid: GridView,
    /// Whether to outline the selection.
    pub show_outline: bool,
    /// The shading of the lit picture.
    pub shading: Shading,
    /// The view mode.
    pub view_mode: ViewMode,
    /// Number of passes over parts of the scene after which the picture is shown; `None` for all.
    pub passes: Option<u32>,
    /// Whether parts of the scene are cut off by their distance from the eye.
    pub has_cut_offs: bool,
    /// Samples per pixel that accumulate while nothing changes.
    pub samples: u32,
}

/// The grid of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridView {
    /// The axis across it: 1 for the ground.
    pub axis: usize,
    /// Side of a fine cell, in meters; ten of them make a coarse one.
    pub cell: f64,
    /// Whether it fades with distance.
    pub fades: bool,
}

/// A camera that one looks through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Through {
    /// The camera.
    pub camera: NodeId,
    /// The view that shows it.
    pub view: Navigation,
    /// Height of the frame as a share of the viewport's.
    pub share: f64,
}

/// Samples per pixel of a new view.
const SAMPLES: u32 = 64;

/// The action of the pointer in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PointerActivity {
    /// Outside the picture.
    #[default]
    Away,
    /// Over the picture, without a drag.
    Hovering,
    /// Turns the camera.
    Orbiting,
    /// Moves the camera sideways.
    Panning,
    /// Moves the camera forward and backward.
    Zooming,
    /// Flies through the scene.
    Flying,
    /// Drags the gizmo.
    Moving,
    /// Transforms the selection, with all keys for it.
    Transforming,
    /// Over a handle of a shape; whether it is that of a point.
    OverHandle(bool),
    /// Drags a handle of a shape.
    Shaping,
    /// Drags a box around what is to be selected.
    Boxing,
    /// Draws a line around what is to be selected.
    Lassoing,
    /// Draws a new shape, or is about to.
    Drawing,
}

/// The view of the document.
pub struct ViewState {
    /// The camera.
    pub navigation: Navigation,
    /// The camera that one looks through.
    pub through: Option<Through>,
    /// Width divided by height of its frame: that of the pictures of the render dialog.
    pub frame_aspect: f64,
    /// Whether that camera moves with the view.
    pub locks_camera: bool,
    /// Whether its frame shows where action and titles are safe.
    pub show_safe_areas: bool,
    /// The shading of the lit picture.
    pub shading: Shading,
    /// The view mode.
    pub view_mode: ViewMode,
    /// Number of passes over parts of the scene after which the picture is shown; `None` for all.
    pub passes: Option<u32>,
    /// Samples per pixel that accumulate while nothing changes.
    pub samples: u32,
    /// Whether to show the ground grid.
    pub show_grid: bool,
    /// Whether to outline the selection.
    pub show_outline: bool,
    /// What the gizmo does.
    pub tool: Tool,
    /// Whose axes it follows.
    pub orientation: Orientation,
    /// The point around which it turns and scales.
    pub pivot: PivotPoint,
    /// How drags snap.
    pub snap: SnapSettings,
    /// The shape that the draw tool draws.
    pub drawn: ShapeKind,
    /// The last transform, to be repeated.
    pub last_motion: Option<LastMotion>,
    /// The transform that follows the pointer and takes all keys.
    pub transforming: Option<TransformKind>,
    /// Where in the picture the next node is added; `None` for the view's target.
    pub add_at: Option<Pos2>,
    /// What is dragged from a palette into the picture.
    pub dragging_in: Option<Command>,
    /// It is dropped there in this frame.
    pub is_dropping: bool,
    /// The group in which clicks select; `None` for the whole scene.
    pub entered: Option<NodeId>,
    /// The clicks at one place so far.
    pub walk: Option<Walk>,
    /// The list of what lies below the pointer, while it is open.
    pub below: Option<BelowList>,
    /// What is hidden while something is shown alone.
    pub isolated: Vec<NodeId>,
    /// The next drag selects by a box.
    pub wants_box: bool,
    /// The next drag selects by a lasso.
    pub wants_lasso: bool,
    /// Where the context menu was opened.
    pub menu_at: Option<Pos2>,
    /// The path of the copy of an instancer under the pointer.
    pub copy_path: Option<String>,
    /// The keys and texts of this frame that belong to it.
    pub modal_events: Vec<Event>,
    /// The picture's rectangle, in points.
    pub rect: Rect,
    /// Its size in pixels, at least 1 × 1.
    pub size_px: [u32; 2],
    /// Whether the camera or an object in the picture is moving.
    pub is_navigating: bool,
    /// The action of the pointer in the picture.
    pub pointer: PointerActivity,
    /// Keep the current picture until the next change.
    pub stops_drawing: bool,
}

impl Default for ViewState {
    fn default() -> Self {
        Self {
            navigation: Navigation::default(),
            through: None,
            frame_aspect: 16.0 / 9.0,
            locks_camera: false,
            show_safe_areas: false,
            shading: Shading::default(),
            view_mode: ViewMode::Shaded,
            passes: None,
            samples: SAMPLES,
            show_grid: true,
            show_outline: true,
            tool: Tool::Transform(TransformKind::Move),
            orientation: Orientation::World,
            pivot: PivotPoint::Median,
            snap: SnapSettings::default(),
            drawn: ShapeKind::Box,
            last_motion: None,
            transforming: None,
            add_at: None,
            dragging_in: None,
            is_dropping: false,
            entered: None,
            walk: None,
            below: None,
            isolated: Vec::new(),
            wants_box: false,
            wants_lasso: false,
            menu_at: None,
            copy_path: None,
            modal_events: Vec::new(),
            rect: Rect::from_min_size(Pos2::ZERO, vec2(640.0, 480.0)),
            size_px: [640, 480],
            is_navigating: false,
            pointer: PointerActivity::Away,
            stops_drawing: false,
        }
    }
}

/// The grid, with cells of a power of ten of this unit, in meters: on the ground, or across an orthographic view along an
/// axis.
pub fn grid_of(navigation: &Navigation, unit: f64) -> GridView {
    let is_flat = navigation.orthographic;
    let size = match is_flat {
        true => 2.0 * navigation.distance * (0.5 * navigation.fov_y).tan(),
        false => navigation.eye().y.abs().max(1e-3),
    };
    let cell = unit * 10.0_f64.powf((size / unit).log10().floor()) * 0.1;
    GridView { axis: navigation.axis().unwrap_or(1), cell, fades: !is_flat }
}

impl ViewState {
    /// Width divided by height.
    pub fn aspect(&self) -> f64 {
        let [width, height] = self.size_px.map(f64::from);
        width / height
    }

    /// The grid of the view.
    pub fn grid(&self, unit: f64) -> GridView {
        grid_of(&self.navigation, unit)
    }

    /// Whether a grid is in the picture.
    pub fn shows_grid(&self) -> bool {
        self.show_grid && self.view_mode == ViewMode::Shaded
    }

    /// The shading that the picture has; `None` while a view for debugging hides it.
    pub fn lit_by(&self) -> Option<Shading> {
        (self.view_mode == ViewMode::Shaded).then_some(self.shading)
    }

    /// Shows the lit picture in this shading.
    pub fn show_shading(&mut self, shading: Shading) {
        (self.shading, self.view_mode) = (shading, ViewMode::Shaded);
    }

    /// Shows the next shading; the first after the last.
    pub fn cycle_shading(&mut self) {
        let next = match self.lit_by().map(Shading::main) {
            None => self.shading,
            Some(Shading::Solid) => Shading::Material,
            Some(Shading::Material) => Shading::Rendered,
            Some(_) => Shading::Solid,
        };
        self.show_shading(next);
    }

    /// Shows a view for debugging, or the lit picture again if that view is open.
    pub fn toggle_view_mode(&mut self, view_mode: ViewMode) {
        self.view_mode = if self.view_mode == view_mode { ViewMode::Shaded } else { view_mode };
    }
}
