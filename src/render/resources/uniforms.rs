//! Input of the passes besides the flat scene. Each struct has a counterpart of the same name in `shaders/common/`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};

use isolith_field::copies::GpuInstancer;
use isolith_field::standpoint::Standpoint;
use isolith_field::{CellTree, Component, FlatScene};
use isolith_geometry::Camera;

/// The camera, the background and the lights of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuView {
    /// Half the picture's width at distance 1, to the right.
    pub right: [f32; 3],
    /// Near limit of visible points.
    pub near: f32,
    /// Half the picture's height at distance 1, upward.
    pub up: [f32; 3],
    /// Far limit of visible points.
    pub far: f32,
    /// Unit direction of view.
    pub forward: [f32; 3],
    /// Width of a pixel at distance 1.
    pub footprint: f32,
    /// Color of the background above.
    pub sky: [f32; 3],
    /// Number of lights in the buffer.
    pub light_count: u32,
    /// Color of the background at the horizon and below.
    pub horizon: [f32; 3],
    /// Width of the picture, in pixels.
    pub width: u32,
    /// Ambient light.
    pub ambient: [f32; 3],
    /// Height of the picture, in pixels.
    pub height: u32,
    /// Offset from pixel centers to the place of this sample, in pixels.
    pub jitter: [f32; 2],
    /// Factor of the exposure.
    pub exposure: f32,
    /// Index of the sample; see [`crate::Renderer::next_sample`].
    pub sample_index: u32,
    /// 1: the background is without color and coverage.
    pub transparent: u32,
    /// 1: whatever has any opacity covers all samples.
    pub first_surfaces: u32,
    /// Padding.
    pub padding_1: u32,
    /// Padding.
    pub padding_2: u32,
}

impl GpuView {
    /// The view of `camera` on a picture of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2], flat: &FlatScene, light_count: u32) -> Self {
        let (width, height) = (f64::from(size[0]), f64::from(size[1]));
        let tan = camera.tan_half_fov();
        let f32s = |v: DVec3| v.as_vec3().to_array();
        let [sky, horizon, ambient] = flat.environment.gradient().map(|color| color.map(|v| v as f32));
        Self {
            right: f32s(camera.rotation * DVec3::X * (tan * width / height)),
            near: camera.near as f32,
            up: f32s(camera.rotation * DVec3::Y * tan),
            far: camera.far as f32,
            forward: f32s(camera.rotation * DVec3::NEG_Z),
            footprint: camera.footprint(height) as f32,
            sky,
            light_count,
            horizon,
            width: size[0],
            ambient,
            height: size[1],
            exposure: flat.display.exposure.exp2() as f32,
            ..Self::zeroed()
        }
    }

    /// The same view for another sample, moved by `offset` pixels.
    pub fn of_sample(self, sample_index: u32, is_transparent: bool, offset: DVec2) -> Self {
        let jitter = offset.as_vec2().to_array();
        Self { jitter, sample_index, transparent: is_transparent.into(), ..self }
    }
}

/// A component relative to the eye.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct GpuComponent {
    /// The eye, or the point at `ray_origin_depth` before it. It is relative to the same point as all positions here:
    /// the component's origin, or a point near the eye, see [`Standpoint`].
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
    /// Lower corner of its grid of cells; all zero if it has none.
    pub grid_low: [f32; 3],
    /// Side of a top cell.
    pub grid_side: f32,
    /// Number of top cells along each axis.
    pub grid_counts: [u32; 3],
    /// Place of its top cells in the texture of tapes; the headers of their contents precede them.
    pub tapes: u32,
    /// See [`Standpoint::ray_origin_depth`].
    pub ray_origin_depth: f32,
    /// Rounding bound: where the field is not below the negative of this, rounding may have separated two faces in one
    /// place.
    pub flush: f32,
    /// The same for a point at [`Self::eye`]; it grows with the distance, up to `flush`.
    pub flush_near: f32,
    /// Of the type of an instancer: its index among the types.
    pub kind: u32,
    /// Share of the light that passes it, for queries of the whole scene.
    pub translucency: f32,
    /// Padding.
    pub padding_0: u32,
    /// Padding.
    pub padding_1: u32,
    /// Padding.
    pub padding_2: u32,
}

/// Rounding distance of two coincident faces, relative to the coordinates that they are computed from: each moves by a
/// few roundings of 2^-24.
const FLUSH_ROUNDING: f64 = 4.0 / 16_777_216.0;

/// See [`GpuComponent::flush`]. Relative to a point near the eye, rounding moves visible points by at most the allowed
/// amount.
fn flush(component: &Component, at: &Standpoint) -> f64 {
    let rounding = FLUSH_ROUNDING * component.flush_extent;
    if at.shift == DVec3::ZERO { rounding } else { rounding.min(at.most_moved) }
}

/// See [`GpuComponent::flush_near`]. Relative to a point near the eye, rounding moves the nearest visible points by at
/// most the allowed amount.
fn flush_near(component: &Component, at: &Standpoint) -> f64 {
    if at.shift == DVec3::ZERO { FLUSH_ROUNDING * component.flush_placement } else { at.most_moved }
}

/// Alignment of uniforms at dynamic offsets, valid on every device.
pub const UNIFORM_STRIDE: usize = 256;

/// Alignment of instancers in their buffer.
pub const INSTANCER_STRIDE: usize = size_of::<GpuInstancer>().next_multiple_of(UNIFORM_STRIDE);

/// The bytes of `all`, each aligned to [`UNIFORM_STRIDE`].
pub fn strided<T: Pod>(all: impl ExactSizeIterator<Item = T>) -> Vec<u8> {
    const { assert!(size_of::<T>() <= UNIFORM_STRIDE) };
    let mut bytes = vec![0; all.len() * UNIFORM_STRIDE];
    for (slot, one) in bytes.chunks_exact_mut(UNIFORM_STRIDE).zip(all) {
        slot[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(&one));
    }
    bytes
}

/// Stand-in for an infinite bound: far beyond any camera, but small enough for f32 arithmetic.
pub const UNBOUNDED: f32 = 1e18;

impl GpuComponent {
    /// The component relative to the eye.
    pub fn new(component: &Component, at: &Standpoint) -> Self {
        // Rounding must never cut the surface off, and a ray should start outside.
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
            flush_near: flush_near(component, at) as f32,
            kind: component.instanced.map_or(0, |of| of.kind),
            translucency: 0.0,
            padding_0: 0,
            padding_1: 0,
            padding_2: 0,
        }
    }
}

impl GpuComponent {
    /// Adds a tree of cells that starts at `tapes` in the texture of tapes.
    pub fn with_grid(self, tree: &CellTree, tapes: u32, at: &Standpoint) -> Self {
        let grid = &tree.grids[0];
        let (grid_low, grid_side) = ((grid.low - at.shift).as_vec3().to_array(), grid.side as f32);
        Self { grid_low, grid_side, grid_counts: grid.counts, tapes: tapes + tree.start as u32, ..self }
    }
}

/// Parameters of one dispatch: its component, its part of the picture, its step limit.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct DispatchParams {
    /// Upper left pixel.
    pub origin: [u32; 2],
    /// First pixel outside.
    pub end: [u32; 2],
    /// Index of the component.
    pub component: u32,
    /// Step limit of an invocation.
    pub max_steps: u32,
    /// 0 starts a march; later relaunches continue it.
    pub relaunch: u32,
    /// 1 in the last relaunch.
    pub last_relaunch: u32,
    /// Index of its list of subtiles.
    pub list: u32,
    /// First subtile of the list.
    pub first_subtile: u32,
    /// 1 for a march that continues with the compacted list of unfinished rays; 0 for all pixels of the subtiles.
    pub compacted: u32,
    /// Place of the unfinished rays in the buffer of rays.
    pub rays: u32,
    /// Place of the lists of subtiles with hits.
    pub hits: u32,
    /// Limit of the cells of an instancer that an invocation looks at.
    pub max_cells: u32,
    /// Where rays from the eye begin to see the component.
    pub near: f32,
    /// Where they cease to.
    pub far: f32,
    /// Width of a pixel at distance 1 by which the accepted error of a hit is measured.
    pub footprint: f32,
    /// Limit of the steps of a ray through one copy.
    pub copy_steps: u32,
    /// Pixels from one ray to the next.
    pub spacing: u32,
    /// Padding.
    pub padding_1: u32,
}
