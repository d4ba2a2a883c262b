//! Draws the same picture with `fidget`, for comparison. `fidget` compiles an implicit surface to machine code, culls
//! space by interval arithmetic over tiles, and simplifies the tape of each tile.
//!
//! It renders a height map: each pixel is a column of voxels, and its result is the first voxel inside, with the
//! gradient there. Its transform may be projective, so a column can be a ray of our camera: the voxels of a column are
//! evenly spaced in 1 / depth. Its result is exact to half a voxel. Finer depths take more voxels and more time, so a
//! time means little without its error.
//!
//! The comparison treats the peer as its author would. The expression is in camera space, where tiles are axis-aligned
//! boxes and intervals are tightest. Scales are multiplied into the constants. Balls are not rotated. Where two
//! operands do not blend, the simplified blend is two instructions. The frame time excludes work that depends on the
//! camera only, and the conversion of voxels to distances.

use std::ops::Range;
use std::time::Duration;

use fidget::context::Tree;
use fidget::jit::JitShape;
use fidget::raster::voxel::{EvalConfig, Image, RenderConfig, RenderSize, render};
use fidget::render::{CancelToken, ThreadPool, TileSizes};
use glam::{DAffine3, DMat3, DVec3};
use isolith::bench::cpu_time;
use isolith::field::{BACKGROUND_DEPTH, FIRST_EXTENDED_KERNEL, FlatNode, FlatScene, GBuffer, Join, LEAF_ROWS};
use isolith::geometry::{Aabb, Camera};
use isolith::scene::ShapeKind;

/// Threads that the peer draws with.
pub const THREADS: usize = 2;
/// Tile sizes that `fidget` recommends for its compiler: edge lengths in voxels, each level nested in the previous one.
pub const DEFAULT_TILES: [usize; 3] = [64, 16, 8];
/// Usually the fastest of a dozen settings for scenes of up to 145 nodes: fewer tiles need their own code, and
/// compiling it takes most of the time. For 577 nodes it is no better than the default, so measure both and take the
/// smaller time.
pub const TUNED_TILES: [usize; 3] = [128, 32, 8];

/// Voxels left free in front of and behind the scene: the peer cannot tell depths apart in the first two.
const MARGIN: f64 = 4.0;

/// A picture drawn by the peer.
pub struct PeerPicture {
    /// Distance along the pixel's ray; infinity for a miss.
    pub depth: Vec<f32>,
    /// Unit world normal; zero for a miss.
    pub normal: Vec<[f32; 3]>,
    /// CPU time of all threads for the frame.
    pub cpu: Duration,
}

impl PeerPicture {
    /// The picture in the form that the comparison with the reference takes. The peer has no leaves and no colors.
    pub fn buffers(&self, size: u32) -> GBuffer {
        GBuffer { depth: self.depth.clone(), normal: self.normal.clone(), ..GBuffer::empty(size, size) }
    }
}

/// A scene prepared for the peer and one camera.
pub struct Peer {
    shape: JitShape,
    camera: Camera,
    /// Range of depths along the view axis that contains the scene.
    range: Range<f64>,
    threads: ThreadPool,
    /// CPU time of all threads to build the expression and the peer's tape. The peer generates machine code per tile
    /// while it draws a frame, so that time counts as frame time.
    pub build: Duration,
}

impl Peer {
    /// `None` if the peer cannot express the scene, or if the camera sees none of it.
    pub fn new(flat: &FlatScene, camera: &Camera) -> Option<Self> {
        let start = cpu_time();
        let shape = JitShape::from(tree(flat, camera)?);
        let build = cpu_time() - start;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build().expect("threads can be started");
        let range = depth_range(flat, camera)?;
        Some(Self { shape, camera: *camera, range, threads: ThreadPool::Custom(pool), build })
    }

    /// Draws a square picture, `size` pixels a side, with `depth` voxels from front to back.
    pub fn render(&self, size: u32, depth: u32, tiles: &[usize]) -> PeerPicture {
        let view = View::new(&self.camera, &self.range, size, depth);
        let shape = self.shape.clone().try_into().expect("the expression has no other variables than the point");
        let tile_sizes = Some(TileSizes::new(tiles).expect("every tile is divided by the next"));
        let eval = EvalConfig { tile_sizes, threads: Some(&self.threads), cancel: CancelToken::new() };
        let start = cpu_time();
        let image = render(shape, &view.config(), &eval).expect("nobody cancels it");
        let cpu = cpu_time() - start;
        let (depth, normal) = view.converted(&image);
        PeerPicture { depth, normal, cpu }
    }
}

/// Placement of the peer's columns in camera space. The point at (x, y, z), in pixels and voxels, is (a, b, -1) / w,
/// where a, b and w are each `[v0, v1]`, meaning v0 + v1 times x, y and z.
struct View {
    a: [f64; 2],
    b: [f64; 2],
    w: [f64; 2],
    size: RenderSize,
    world_from_camera: DMat3,
}

impl View {
    fn new(camera: &Camera, range: &Range<f64>, size: u32, depth: u32) -> Self {
        let (t, pixels) = (camera.tan_half_fov(), f64::from(size));
        let step = (range.start.recip() - range.end.recip()) / (f64::from(depth) - 2.0 * MARGIN);
        Self {
            a: [t * (1.0 / pixels - 1.0), 2.0 * t / pixels],
            b: [t * (1.0 - 1.0 / pixels), -2.0 * t / pixels],
            w: [range.end.recip() - MARGIN * step, step],
            size: RenderSize::new(size, size, depth),
            world_from_camera: DMat3::from_quat(camera.rotation),
        }
    }

    /// The peer applies its own map from a cube to pixels and voxels; this transform undoes it.
    fn config(&self) -> RenderConfig {
        let mut config = RenderConfig::from_size(self.size);
        let cube = self.size.screen_to_world();
        let through_cube = |[v0, v1]: [f64; 2], axis: usize| {
            let (scale, shift) = (f64::from(cube[(axis, axis)]), f64::from(cube[(axis, 3)]));
            [(v0 - v1 * shift / scale) as f32, (v1 / scale) as f32]
        };
        let [a, b, w] = [through_cube(self.a, 0), through_cube(self.b, 1), through_cube(self.w, 2)];
        let rows = [[a[1], 0.0, 0.0, a[0]], [0.0, b[1], 0.0, b[0]], [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, w[1], w[0]]];
        for (i, row) in rows.into_iter().enumerate() {
            for (j, value) in row.into_iter().enumerate() {
                config.world_to_model[(i, j)] = value;
            }
        }
        config
    }

    /// Normals, and distances along the rays to the midpoint between the last voxel outside and the first one inside.
    fn converted(&self, image: &Image) -> (Vec<f32>, Vec<[f32; 3]>) {
        let width = image.width();
        let pixel = |(i, pixel): (usize, &fidget::raster::voxel::GeometryPixel)| {
            if pixel.depth == 0 {
                return (BACKGROUND_DEPTH, [0.0; 3]);
            }
            let line = |[v0, v1]: [f64; 2], at: f64| v0 + v1 * at;
            let (a, b) = (line(self.a, (i % width) as f64), line(self.b, (i / width) as f64));
            let distance = DVec3::new(a, b, 1.0).length() / line(self.w, f64::from(pixel.depth) - 0.5);
            // The gradient is per pixel and voxel, at the first voxel inside; convert it by the chain rule.
            let w = line(self.w, f64::from(pixel.depth) - 1.0);
            let by = DVec3::from(pixel.normal.map(f64::from)) * w;
            let (x, y) = (by.x / self.a[1], by.y / self.b[1]);
            let normal = DVec3::new(x, y, a * x + b * y + by.z * w / self.w[1]);
            let normal = (self.world_from_camera * normal).normalize_or_zero();
            (distance as f32, normal.as_vec3().to_array())
        };
        image.iter().enumerate().map(pixel).unzip()
    }
}

/// Depth range along the view axis of the visible part of the scene; `None` if the camera sees none of it.
fn depth_range(flat: &FlatScene, camera: &Camera) -> Option<Range<f64>> {
    let camera_from_world = DAffine3::from_rotation_translation(camera.rotation, camera.position).inverse();
    let t = camera.tan_half_fov();
    let mut all = f64::INFINITY..f64::NEG_INFINITY;
    for component in &flat.components {
        let corners =
            component.bounds.translated(component.origin).corners().map(|c| camera_from_world.transform_point3(c));
        let beside = |side: fn(DVec3) -> f64| corners.iter().all(|c| side(*c) > -c.z * t);
        if beside(|c| c.x) || beside(|c| -c.x) || beside(|c| c.y) || beside(|c| -c.y) {
            continue;
        }
        let depths = Aabb::from_points(corners);
        all = all.start.min(-depths.max.z)..all.end.max(-depths.min.z);
    }
    let range = all.start.max(camera.near)..all.end.min(camera.far);
    (range.start < range.end).then_some(range)
}

/// The whole scene as one expression in camera space: the hard union of its components. `None` if the peer cannot
/// express it: meshes, unbounded shapes, shapes without a closed form, operators beyond the first three.
pub fn tree(flat: &FlatScene, camera: &Camera) -> Option<Tree> {
    if !flat.meshes.is_empty() || flat.components.iter().any(|c| !c.bounds.is_finite()) {
        return None;
    }
    let world_from_camera = DAffine3::from_rotation_translation(camera.rotation, camera.position);
    let components = flat.components.iter().map(|component| {
        let entries = component.first as usize..(component.first + component.count) as usize;
        let component_from_camera = DAffine3::from_translation(-component.origin) * world_from_camera;
        fold(flat, entries, &component_from_camera)
    });
    components.collect::<Option<Vec<_>>>()?.into_iter().reduce(|a, b| a.min(b))
}

/// Folds the siblings in `range` in order. Ignores runs: they only serve culling.
fn fold(flat: &FlatScene, range: Range<usize>, space: &DAffine3) -> Option<Tree> {
    let mut so_far: Option<Tree> = None;
    let mut at = range.start;
    while at < range.end {
        let node = &flat.nodes[at];
        if node.is_run() {
            at += 1;
            continue;
        }
        if Join::ALL[node.join() as usize].is_extended() || node.kernel() >= FIRST_EXTENDED_KERNEL {
            return None;
        }
        let end = at + node.extent as usize;
        let next = if node.is_group() { fold(flat, at + 1..end, space)? } else { leaf(flat, node, space)? };
        so_far = Some(match so_far {
            None => next,
            Some(before) => joined(node, flat.params[node.params as usize][0], before, next),
        });
        at = end;
    }
    so_far
}

/// Joins the running result `a` and the next operand `b`.
fn joined(node: &FlatNode, support: f32, a: Tree, b: Tree) -> Tree {
    const INTERSECTION: u32 = Join::Intersection as u32;
    const DIFFERENCE: u32 = Join::Difference as u32;
    let blend = |difference: Tree| blend(difference, support, node.kernel());
    match node.join() {
        INTERSECTION => a.max(b.clone()) + blend(a - b),
        DIFFERENCE => a.max(-b.clone()) + blend(a + b),
        _ => a.min(b.clone()) - blend(a - b),
    }
}

/// The amount that a blend subtracts from the smaller of two operands that differ by `difference`. `and` yields its
/// left side if that is 0, else its right side: where nothing blends, the peer drops the rest of the expression.
fn blend(difference: Tree, support: f32, kernel: u32) -> Tree {
    if !support.recip().is_finite() {
        return Tree::constant(0.0);
    }
    let h = (Tree::constant(1.0) - difference.abs() * support.recip()).max(0.0);
    let value = match kernel {
        0 => {
            let u = Tree::constant(1.0) - h.clone();
            (h.clone() + 1.0 - (Tree::constant(2.0) - u.square()).sqrt()) * (0.5 * support)
        }
        1 => h.square() * (0.25 * support),
        _ => h.square() * h.clone() * (support / 6.0),
    };
    h.and(value)
}

/// The field of a leaf. The space's scale is applied to the shape's size, so that the field needs no scale.
fn leaf(flat: &FlatScene, node: &FlatNode, space: &DAffine3) -> Option<Tree> {
    let params = &flat.params[node.params as usize..];
    let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
    let scale = f64::from(params[0][1]);
    let [x, y, z] = [1, 2, 3].map(|i| params[i].map(f64::from));
    let rows = DMat3::from_cols_array_2d(&[0, 1, 2].map(|i| [x[i], y[i], z[i]]));
    let shift = DVec3::new(x[3], y[3], z[3]);
    let mut local = DAffine3 { matrix3: rows * scale, translation: shift * scale } * *space;
    if kind == ShapeKind::Sphere && is_rotation(&local.matrix3) {
        local = DAffine3::from_translation(local.matrix3.inverse() * local.translation);
    }
    let (px, py, pz) = Tree::axes();
    let p = [0, 1, 2].map(|i| {
        let [cx, cy, cz] = [0, 1, 2].map(|j| local.matrix3.col(j)[i] as f32);
        px.clone() * cx + py.clone() * cy + pz.clone() * cz + local.translation[i] as f32
    });
    let mut parameters = [0.0; 8];
    for (row, four) in parameters.chunks_mut(4).take(kind.parameter_rows()).enumerate() {
        four.copy_from_slice(&params[LEAF_ROWS + row].map(|v| (f64::from(v) * scale) as f32));
    }
    shape(kind, p, &parameters)
}

fn is_rotation(m: &DMat3) -> bool {
    (m.transpose() * *m).abs_diff_eq(DMat3::IDENTITY, 1e-6)
}

/// Branch-free distance of a shape; `None` for kinds that the comparison leaves out.
fn shape(kind: ShapeKind, p: [Tree; 3], q: &[f32; 8]) -> Option<Tree> {
    let [x, y, z] = p;
    Some(match kind {
        ShapeKind::Sphere => length([x, y, z]) - q[0],
        ShapeKind::Plane => y,
        ShapeKind::Box => {
            let half = [0.5 * q[0], 0.5 * q[1], 0.5 * q[2]];
            let rounding = q[3].min(half[0].min(half[1].min(half[2])));
            solid([x.abs() - (half[0] - rounding), y.abs() - (half[1] - rounding), z.abs() - (half[2] - rounding)])
                - rounding
        }
        ShapeKind::Torus => length([length([x, z]) - q[0], y]) - q[1],
        ShapeKind::Cylinder => {
            let half = 0.5 * q[1];
            let rounding = q[2].min(q[0].min(half));
            solid([length([x, z]) - (q[0] - rounding), y.abs() - (half - rounding)]) - rounding
        }
        ShapeKind::CappedCone => capped_cone(length([x, z]), y, q),
        ShapeKind::RoundCone => round_cone(length([x, z]), y, q),
        ShapeKind::Capsule => {
            let from_start = [x - q[0], y - q[1], z - q[2]];
            length(from_segment(from_start, [q[3] - q[0], q[4] - q[1], q[5] - q[2]])) - q[6]
        }
        ShapeKind::HexagonalPrism => {
            let mirror = [-0.5, 0.75_f32.sqrt()];
            let (x, z) = (x.abs(), z.abs());
            let behind = (x.clone() * mirror[0] + z.clone() * mirror[1]).max(0.0) * 2.0;
            let (x, z) = (x - behind.clone() * mirror[0], z - behind * mirror[1]);
            let beside = x - q[0];
            let (outside, along) = (beside.max(0.0), (z.abs() - q[0] / 3.0_f32.sqrt()).max(0.0));
            let profile = outside.and(length([outside.clone(), along])) + beside.min(0.0);
            solid([profile, y.abs() - 0.5 * q[1]])
        }
        ShapeKind::BoxFrame => box_frame([x, y, z], q),
        _ => return None,
    })
}

/// Distance to the intersection of half spaces along perpendicular axes.
fn solid<const N: usize>(d: [Tree; N]) -> Tree {
    beyond(d.clone()) + greatest(d).min(0.0)
}

/// Length of the positive parts. The root of 0 has no derivative, so `and` yields a constant there.
fn beyond<const N: usize>(d: [Tree; N]) -> Tree {
    greatest(d.clone()).max(0.0).and(length(d.map(|d| d.max(0.0))))
}

fn greatest<const N: usize>(d: [Tree; N]) -> Tree {
    d.into_iter().reduce(|a, b| a.max(b)).expect("there is an axis")
}

/// The twelve edges of a cuboid: outside, the least distance to four bars along each axis; inside, the distance to the
/// surface.
fn box_frame(p: [Tree; 3], q: &[f32; 8]) -> Tree {
    let outer = [0, 1, 2].map(|i| p[i].abs() - 0.5 * q[i]);
    let reaches = |i: usize| 0.5 * q[i] <= q[3];
    let inner = [0, 1, 2].map(|i| if reaches(i) { Tree::constant(1e18) } else { outer[i].clone() + q[3] });
    let side = [0, 1, 2].map(|i| outer[i].max(-inner[i].clone()));
    let bar = |i: usize| beyond([0, 1, 2].map(|j| if i == j { outer[j].clone() } else { side[j].clone() }));
    let [x, y, z] = inner;
    let least = x.min(y.clone()).min(z.clone());
    let middle = x.min(y.clone()).max(x.max(y).min(z));
    let inside = greatest(outer.clone()).max(-beyond([least, middle]));
    bar(0).min(bar(1)).min(bar(2)) + inside.min(0.0)
}

/// A convex profile in the half plane through the axis: the distance to its three sides, with the sign from its planes.
fn capped_cone(radius: Tree, y: Tree, q: &[f32; 8]) -> Tree {
    let (bottom, top, half) = (q[0], q[1], 0.5 * q[2]);
    let square = |d: [Tree; 2]| d[0].square() + d[1].square();
    let bottom_cap = square([(radius.clone() - bottom).max(0.0), y.clone() + half]);
    let top_cap = square([(radius.clone() - top).max(0.0), y.clone() - half]);
    let from_top = [radius.clone() - top, y.clone() - half];
    let side = square(from_segment(from_top.clone(), [bottom - top, -q[2]]));
    let [beside, above] = from_top;
    let plane = beside * q[2] + above * (bottom - top);
    let sign = plane.max(y.abs() - half).compare(0.0);
    sign * bottom_cap.min(top_cap).min(side).sqrt()
}

/// The hull of two balls is a family of balls whose radius changes linearly along the axis; the nearest one gives the
/// distance.
fn round_cone(radius: Tree, y: Tree, q: &[f32; 8]) -> Tree {
    let (bottom, top, height) = (q[0], q[1], q[2]);
    let y = y + 0.5 * height;
    let sine = (bottom - top) / height;
    if sine >= 1.0 || sine.is_nan() {
        return length([radius, y]) - bottom;
    }
    if sine <= -1.0 {
        return length([radius, y - height]) - top;
    }
    let tangent = sine / (1.0 - sine * sine).sqrt();
    let along = (y.clone() - radius.clone() * tangent).max(0.0).min(height);
    length([radius, y - along.clone()]) + along * sine - bottom
}

/// The vector from the nearest point of a segment. Both points are relative to the segment's start.
fn from_segment<const N: usize>(from_start: [Tree; N], axis: [f32; N]) -> [Tree; N] {
    let square: f32 = axis.iter().map(|a| a * a).sum();
    let dot = from_start.iter().zip(axis).fold(Tree::constant(0.0), |sum, (p, a)| sum + p.clone() * a);
    let t = (dot * square.max(1e-30).recip()).max(0.0).min(1.0);
    std::array::from_fn(|i| from_start[i].clone() - t.clone() * axis[i])
}

fn length<const N: usize>(v: [Tree; N]) -> Tree {
    v.into_iter().map(|v| v.square()).reduce(|a, b| a + b).expect("there is a coordinate").sqrt()
}
