//! Projection from the world to the screen and back, for one frame.

use egui::{Pos2, Rect, vec2};
use glam::{DVec2, DVec3};

use super::view_state::ViewState;
use isolith_geometry::{Camera, Ray};

/// The camera and the viewport of one frame.
pub struct Projection {
    camera: Camera,
    rect: Rect,
    pixels_per_point: f32,
    size_px: DVec2,
}

impl Projection {
    /// The projection of the viewport.
    pub fn new(view: &ViewState, pixels_per_point: f32) -> Self {
        let [width, height] = view.size_px.map(f64::from);
        let camera = view.navigation.camera();
        Self { camera, rect: view.rect, pixels_per_point, size_px: DVec2::new(width, height) }
    }

    /// The projection of the viewport as it was last shown.
    pub fn of(view: &ViewState) -> Self {
        Self::new(view, view.size_px[0] as f32 / view.rect.width().max(1.0))
    }

    /// The position of a world point on the screen, in points; `None` behind the eye or far outside.
    pub fn to_screen(&self, p: DVec3) -> Option<Pos2> {
        let (pixel, _) = self.camera.project(p, self.size_px)?;
        let point = pixel / f64::from(self.pixels_per_point);
        // Far outside, f32 would wrap lines around the screen.
        (point.abs().max_element() < 1e5).then(|| self.rect.min + vec2(point.x as f32, point.y as f32))
    }

    /// Meters per screen point at the depth of a world point.
    pub fn meters_per_point(&self, p: DVec3) -> f64 {
        let depth = (p - self.camera.position).dot(self.camera.rotation * DVec3::NEG_Z).max(0.0);
        self.camera.footprint(self.size_px.y) * depth * f64::from(self.pixels_per_point)
    }

    /// The pixel under a point of the screen, relative to the picture's corner.
    pub fn pixel(&self, at: Pos2) -> DVec2 {
        let p = (at - self.rect.min) * self.pixels_per_point;
        DVec2::new(f64::from(p.x), f64::from(p.y))
    }

    /// The ray through a point of the screen.
    pub fn ray(&self, at: Pos2) -> Ray {
        self.camera.ray(self.pixel(at), self.size_px)
    }

    /// The picture's size in pixels.
    pub fn size_px(&self) -> DVec2 {
        self.size_px
    }
}
