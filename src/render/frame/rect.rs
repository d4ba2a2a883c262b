//! Rectangles of pixels: what components may cover, and the parts that they are cut into.

use bytemuck::Zeroable as _;
use glam::{DVec2, DVec3};

use crate::resources::uniforms::DispatchParams;
use isolith_field::Component;
use isolith_geometry::SampleView;

/// Side of a tile, in pixels: the area that a cone starts with.
pub const TILE: u32 = 8;
/// Projection from the world to pixels.
pub(super) struct ScreenProjection {
    eye: DVec3,
    forward: DVec3,
    /// Pixels to the right per meter at depth 1.
    right: DVec3,
    /// Pixels downward per meter at depth 1.
    down: DVec3,
    /// Center of the picture.
    center: DVec2,
    /// Depth along the view axis below which points are not visible. In a corner, the near limit along the ray is less
    /// along the axis.
    near: f64,
}

impl ScreenProjection {
    pub(super) fn new(SampleView { camera, offset }: &SampleView, size: [u32; 2]) -> Self {
        let half = DVec2::new(f64::from(size[0]), f64::from(size[1])) * 0.5;
        let scale = half.y / camera.tan_half_fov();
        // A moved picture reaches farther from the view axis.
        let corner = (half + offset.abs()) / scale;
        Self {
            eye: camera.position,
            forward: camera.rotation * DVec3::NEG_Z,
            right: camera.rotation * DVec3::X * scale,
            down: camera.rotation * DVec3::NEG_Y * scale,
            center: half - *offset,
            near: (camera.near * 0.5 / (1.0 + corner.length_squared()).sqrt()).max(1e-12),
        }
    }
}

/// Margin around the image of a component, in pixels: half a pixel from a pixel's corner to its center, half for the
/// jitter of samples, and a sixteenth for rounding.
const MARGIN: f64 = 1.0625;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rect {
    /// Upper left pixel.
    pub origin: [u32; 2],
    /// First pixel outside.
    pub end: [u32; 2],
}

impl Rect {
    /// The pixels that the component's bounds may cover; `None` if it is out of view.
    pub(super) fn around(component: &Component, projection: &ScreenProjection, size: [u32; 2]) -> Option<Self> {
        let whole = Self { origin: [0, 0], end: size };
        let bounds = component.world_bounds();
        if !bounds.is_finite() {
            return Some(whole);
        }
        let pixels = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut behind = 0;
        for corner in bounds.translated(-projection.eye).corners() {
            let depth = corner.dot(projection.forward);
            if depth < projection.near {
                behind += 1;
                continue;
            }
            let p = projection.center + DVec2::new(corner.dot(projection.right), corner.dot(projection.down)) / depth;
            low = low.min(p);
            high = high.max(p);
        }
        match behind {
            8 => return None,
            0 => {}
            // A part of it lies beside or behind the eye, so its projection has no simple outline.
            _ => return Some(whole),
        }
        let low = (low - MARGIN).floor().max(DVec2::ZERO);
        let high = (high + MARGIN).ceil().min(pixels);
        if low.cmpge(high).any() {
            return None;
        }
        let snap = |v: f64| (v as u32) / TILE * TILE;
        Some(Self { origin: [snap(low.x), snap(low.y)], end: [high.x as u32, high.y as u32] })
    }

    pub(super) fn pixels(&self) -> f64 {
        f64::from(self.end[0] - self.origin[0]) * f64::from(self.end[1] - self.origin[1])
    }

    pub(super) fn tiles(&self) -> u32 {
        [0, 1].map(|i| (self.end[i] - self.origin[i]).div_ceil(TILE)).iter().product()
    }

    pub(super) fn params(&self, component: u32) -> DispatchParams {
        DispatchParams { origin: self.origin, end: self.end, component, ..DispatchParams::zeroed() }
    }

    /// Width and height of parts that cost at most `most`, but no less than one tile.
    pub(super) fn part(&self, per_pixel: f64, most: f64) -> [u32; 2] {
        let pixels = (most / per_pixel.max(1e-9)).max(f64::from(TILE * TILE));
        let width = self.end[0] - self.origin[0];
        let rows = ((pixels / f64::from(width)).min(1e9) as u32 / TILE * TILE).max(TILE);
        let columns = if f64::from(width * TILE) > pixels {
            ((pixels / f64::from(TILE)) as u32 / TILE * TILE).max(TILE)
        } else {
            width
        };
        [columns, rows]
    }

    /// Number of parts.
    pub(super) fn parts(&self, per_pixel: f64, most: f64) -> usize {
        let part = self.part(per_pixel, most);
        [0, 1].map(|i| (self.end[i] - self.origin[i]).div_ceil(part[i]) as usize).iter().product()
    }

    /// Cuts the rectangle into parts, see [`Rect::part`].
    pub(super) fn cut(&self, per_pixel: f64, most: f64, mut each: impl FnMut(Self)) {
        let [columns, rows] = self.part(per_pixel, most);
        let mut y = self.origin[1];
        while y < self.end[1] {
            let bottom = y.saturating_add(rows).min(self.end[1]);
            let mut x = self.origin[0];
            while x < self.end[0] {
                let right = x.saturating_add(columns).min(self.end[0]);
                each(Self { origin: [x, y], end: [right, bottom] });
                x = right;
            }
            y = bottom;
        }
    }
}
