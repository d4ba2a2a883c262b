//! What the passes read besides the flat scene. Each struct has a counterpart of the same name in `shaders/common/`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use isolith_field::standpoint::Standpoint;
use isolith_field::{CellTree, Component, FlatScene};
use isolith_geometry::Camera;

/// Who looks, from where. One a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuView {
    /// Half the picture's width at distance 1, to the right.
    pub right: [f32; 3],
    /// Nothing nearer is seen.
    pub near: f32,
    /// Half the picture's height at distance 1, upward.
    pub up: [f32; 3],
    /// Nothing farther is seen.
    pub far: f32,
    /// Unit direction of view.
    pub forward: [f32; 3],
    /// Width of a pixel at distance 1.
    pub footprint: f32,
    /// Background above.
    pub sky: [f32; 3],
    /// Lights in the buffer.
    pub light_count: u32,
    /// Background at the horizon and below.
    pub horizon: [f32; 3],
    /// Of the picture, in pixels.
    pub width: u32,
    /// Light from everywhere.
    pub ambient: [f32; 3],
    /// Of the picture, in pixels.
    pub height: u32,
}

impl GpuView {
    /// The view of `camera` on a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2], flat: &FlatScene, light_count: u32) -> Self {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        let tan = camera.tan_half_fov();
        let f32s = |v: DVec3| v.as_vec3().to_array();
        let color = |c: [f64; 3]| c.map(|v| v as f32);
        Self {
            right: f32s(camera.rotation * DVec3::X * (tan * width / height)),
            near: camera.near as f32,
            up: f32s(camera.rotation * DVec3::Y * tan),
            far: camera.far as f32,
            forward: f32s(camera.rotation * DVec3::NEG_Z),
            footprint: camera.footprint(height) as f32,
            sky: color(flat.environment.sky),
            light_count,
            horizon: color(flat.environment.horizon),
            width: size[0],
            ambient: color(flat.environment.ambient),
            height: size[1],
        }
    }
}

/// A component as it stands to the eye.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuComponent {
    /// The eye, or the point that `ray_origin_depth` puts before it, relative to what all positions here are relative to: the component's
    /// origin, or a point near the eye, see [`Standpoint`].
    pub eye: [f32; 3],
    /// First entry.
    pub first: u32,
    /// Lower corner of the bounds.
    pub low: [f32; 3],
    /// Entry after the last.
    pub end: u32,
    /// Upper corner of the bounds.
    pub high: [f32; 3],
    /// First of its rows.
    pub params: u32,
    /// See [`Component::half_space`]; all zero for none.
    pub half_space: [f32; 4],
    /// Lower corner of its grid of cells; all zero where there is none.
    pub grid_low: [f32; 3],
    /// Side of a cell at the top.
    pub grid_side: f32,
    /// Cells at the top along each axis.
    pub grid_counts: [u32; 3],
    /// Where its top cells stand in the texture of tapes; the headers of its contents stand before.
    pub tapes: u32,
    /// See [`Standpoint::ray_origin_depth`].
    pub ray_origin_depth: f32,
    /// Where the field is not below the negative of this, two faces in one place may have been rounded apart.
    pub flush: f32,
    /// Fills the last eight bytes.
    pub _padding: [u32; 2],
}

/// What two faces in one place may be rounded apart, relative to the coordinates they are computed from: each by a few
/// roundings of 2^-24.
const FLUSH_ROUNDING: f64 = 4.0 / 16_777_216.0;

/// See [`GpuComponent::flush`]. Relative to a point near the eye, rounding moves what is seen by no more than is allowed.
fn flush(component: &Component, at: &Standpoint) -> f64 {
    let rounding = FLUSH_ROUNDING * component.flush_extent;
    if at.shift == DVec3::ZERO { rounding } else { rounding.min(at.most_moved) }
}

/// Uniforms at dynamic offsets begin at multiples of this: what every device can do.
pub const UNIFORM_STRIDE: usize = 256;

/// The bytes of `all`, each at its multiple of [`UNIFORM_STRIDE`].
pub fn strided<T: Pod>(all: impl ExactSizeIterator<Item = T>) -> Vec<u8> {
    const { assert!(size_of::<T>() <= UNIFORM_STRIDE) };
    let mut bytes = vec![0; all.len() * UNIFORM_STRIDE];
    for (slot, one) in bytes.chunks_exact_mut(UNIFORM_STRIDE).zip(all) {
        slot[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(&one));
    }
    bytes
}

/// Where bounds without end are said to end: far beyond any camera, near enough for f32 arithmetic.
pub const UNBOUNDED: f32 = 1e18;

impl GpuComponent {
    /// As it stands to the eye.
    pub fn new(component: &Component, at: &Standpoint) -> Self {
        // Rounding must never cut the surface off, and a ray should begin outside.
        let slack = (component.bounds.max - component.bounds.min).max_element().min(1e6) * 1e-5 + 1e-9;
        let bounds = component.bounds.expanded(slack).translated(-at.shift);
        let [x, y, z, d] = component.half_space.unwrap_or_default();
        let half_space = [x, y, z, d + DVec3::new(x, y, z).dot(at.shift)];
        let clamp = |v: Vec3| v.clamp(Vec3::splat(-UNBOUNDED), Vec3::splat(UNBOUNDED)).to_array();
        Self {
            eye: at.eye.as_vec3().to_array(),
            first: component.first,
            low: clamp(bounds.min.as_vec3()),
            end: component.first + component.count,
            high: clamp(bounds.max.as_vec3()),
            params: component.params,
            half_space: half_space.map(|v| v as f32),
            grid_low: [0.0; 3],
            grid_side: 0.0,
            grid_counts: [0; 3],
            tapes: 0,
            ray_origin_depth: at.ray_origin_depth as f32,
            flush: flush(component, at) as f32,
            _padding: [0; 2],
        }
    }
}

impl GpuComponent {
    /// The same with a tree of cells that begins at `tapes` in the texture of tapes.
    pub fn with_grid(self, tree: &CellTree, tapes: u32, at: &Standpoint) -> Self {
        let grid = &tree.grids[0];
        let (grid_low, grid_side) = ((grid.low - at.shift).as_vec3().to_array(), grid.side as f32);
        Self { grid_low, grid_side, grid_counts: grid.counts, tapes: tapes + tree.start as u32, ..self }
    }
}

/// One dispatch: which component, which part of the picture, how far.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct DispatchParams {
    /// Upper left pixel.
    pub origin: [u32; 2],
    /// First pixel outside.
    pub end: [u32; 2],
    /// Index of the component.
    pub component: u32,
    /// Steps that an invocation may take.
    pub max_steps: u32,
    /// 0 begins a march, later relaunches continue it.
    pub relaunch: u32,
    /// 1 in the last relaunch.
    pub last_relaunch: u32,
    /// Which list of subtiles.
    pub list: u32,
    /// Where its subtiles start.
    pub first_subtile: u32,
    /// 1 where a march goes on with the rays that were left, compacted; 0 for all pixels of the subtiles.
    pub compacted: u32,
    /// Where the rays that are left stand in the buffer of rays.
    pub rays: u32,
    /// Where the lists of subtiles with hits begin.
    pub hits: u32,
    /// Fills the last eight bytes.
    pub _padding: u32,
}
