//! The effect of modifiers on points and values.

use glam::{DMat3, DQuat, DVec3, EulerRot};

use crate::eval::{noise_value, sdf_heights};
use crate::prepare::spline;
use isolith_geometry::Aabb;
use isolith_scene::{Axis, Modifier};

/// The number of cells evaluated to either side along an infinite axis, and where there are too many cells to
/// evaluate all.
const REACH: i64 = 3;
/// The greatest index of a cell: f64 cannot count farther cells exactly.
const FARTHEST: f64 = 1e15;
/// Fewer cells than this are all evaluated.
const MOST_CELLS: u64 = 4_096;
/// The least factor of a taper; thinner parts lie beyond the content.
const NARROWEST: f64 = 1e-3;

/// A modifier with the inputs of its evaluation.
#[derive(Clone)]
pub(super) enum Deformation {
    Elongate { half: DVec3 },
    Round { radius: f64 },
    Onion { half: f64, walls: f64, spacing: f64 },
    Twist { angle: f64 },
    Bend { radius: f64, sign: f64 },
    Taper { change: f64 },
    Waves { amplitude: f64, frequency: f64, phase: f64 },
    Noise { amplitude: f64, frequency: f64, octaves: u32, seed: u32 },
    Displacement(Displacement),
    Repeat(Repeat),
    Recursion { count: u32, offset: DVec3, inverse: DMat3, scale: f64, sides: [f64; 3] },
    Idle,
}

/// Cells along each axis, see [`Modifier::Repeat`].
#[derive(Clone)]
pub(super) struct Repeat {
    counts: [u32; 3],
    spacing: DVec3,
    offset: DVec3,
    turn: f64,
    mirrored: [bool; 3],
    carved: [[u32; 2]; 3],
}

/// Heights of an image, repeated in tiles.
#[derive(Clone)]
pub(super) struct Displacement {
    rows: Vec<[f64; 4]>,
    pixels: [f64; 2],
    /// Tiles per meter.
    tiles: [f64; 2],
    axis: Axis,
}

impl Deformation {
    /// A modifier other than a mirror or a ring; `bounds` are those of its content.
    pub fn new(modifier: &Modifier, bounds: impl FnOnce() -> Aabb) -> Result<Self, &'static str> {
        let radians = f64::to_radians;
        Ok(match modifier {
            Modifier::Mirror { .. } | Modifier::Polar { .. } => return Err("it is written as copies"),
            Modifier::Elongate { length } => Self::Elongate { half: DVec3::from(*length) * 0.5 },
            Modifier::Round { radius } => Self::Round { radius: *radius },
            Modifier::Onion { thickness, walls, spacing } => {
                Self::Onion { half: 0.5 * thickness, walls: f64::from(*walls), spacing: *spacing }
            }
            Modifier::Twist { angle } => Self::Twist { angle: radians(*angle) },
            Modifier::Bend { angle: 0.0 } => Self::Idle,
            Modifier::Bend { angle } => Self::Bend { radius: radians(*angle).abs().recip(), sign: angle.signum() },
            Modifier::Taper { change } => Self::Taper { change: *change },
            Modifier::Waves { amplitude, length, phase } => {
                let frequency = std::f64::consts::TAU / length;
                Self::Waves { amplitude: *amplitude, frequency, phase: radians(*phase) }
            }
            Modifier::Noise { amplitude, size, octaves, seed } => {
                let total: f64 = (0..*octaves).map(|layer| 0.5_f64.powi(layer as i32)).sum();
                let (amplitude, frequency) = (amplitude / total, size.recip());
                Self::Noise { amplitude, frequency, octaves: *octaves, seed: *seed }
            }
            Modifier::Displacement { image, height, tile, axis } => {
                let Some(heights) = image.content().filter(|_| *height != 0.0) else { return Ok(Self::Idle) };
                let pixels = heights.size.map(|n| n as f64);
                let (rows, _) = spline(heights, [tile / pixels[0]; 2], *height);
                let tiles = [tile.recip(), pixels[0] / (tile * pixels[1])];
                Self::Displacement(Displacement { rows, pixels, tiles, axis: *axis })
            }
            Modifier::Repeat { counts, spacing, offset, turn, mirrored, carve_from, carve_to } => {
                let mut offset = DVec3::from(*offset);
                // The offset moves nothing along an axis with cells of its own, except rows of bricks.
                let has_cells = counts.map(|count| count != 1);
                for axis in [1, 2] {
                    offset[axis] = if !has_cells[axis] && has_cells[0] { offset[axis] } else { 0.0 };
                }
                offset.x = if has_cells[0] && has_cells[1] { offset.x } else { 0.0 };
                let carved = [0, 1, 2].map(|axis| [carve_from[axis], carve_to[axis]]);
                let (spacing, turn) = (DVec3::from(*spacing), radians(*turn));
                Self::Repeat(Repeat { counts: *counts, spacing, offset, turn, mirrored: *mirrored, carved })
            }
            Modifier::Recursion { count, offset, rotation, scale, mirrored } => {
                let [x, y, z] = rotation.map(radians);
                let turn = DMat3::from_quat(DQuat::from_euler(EulerRot::ZYX, z, y, x));
                let offset = DVec3::from(*offset);
                // Both sides show the content on the side of the next copy.
                let bounds = bounds();
                let middle = if bounds.is_finite() { offset + turn * (bounds.center() * *scale) } else { offset };
                let side = |axis: usize| if middle[axis] < 0.0 { -1.0 } else { 1.0 };
                let sides = [0, 1, 2].map(|axis| if mirrored[axis] { side(axis) } else { 0.0 });
                Self::Recursion { count: *count, offset, inverse: turn.transpose(), scale: *scale, sides }
            }
        })
    }

    /// Whether the value follows from that of the content.
    pub fn is_exact(&self) -> bool {
        matches!(self, Self::Elongate { .. } | Self::Round { .. } | Self::Onion { .. } | Self::Idle)
    }

    /// The value at a point, from the values of the content.
    pub fn value(&self, p: DVec3, content: &dyn Fn(DVec3) -> f64) -> f64 {
        match self {
            Self::Idle => content(p),
            Self::Elongate { half } => content(p - p.clamp(-*half, *half)),
            Self::Round { radius } => content(p) - radius,
            Self::Onion { half, walls, spacing } => {
                let f = content(p);
                // The nearest of the walls, which lie inward from the surface.
                let nearest = (-f / spacing).round_ties_even().clamp(0.0, walls - 1.0);
                (f + nearest * spacing).abs() - half
            }
            Self::Twist { angle } => content(DQuat::from_rotation_y(-angle * p.y) * p),
            Self::Bend { radius, sign } => {
                // From the center of the arc, which lies at distance `radius` on that side.
                let down = radius - sign * p.y;
                content(DVec3::new(p.x.atan2(down) * radius, sign * (radius - p.x.hypot(down)), p.z))
            }
            Self::Taper { change } => {
                let width = (1.0 + change * p.y).max(NARROWEST);
                content(DVec3::new(p.x / width, p.y, p.z / width))
            }
            Self::Waves { amplitude, frequency, phase } => {
                let wave = |x: f64| (x * frequency + phase).sin();
                content(p) + amplitude * wave(p.x) * wave(p.y) * wave(p.z)
            }
            Self::Noise { amplitude, frequency, octaves, seed } => {
                let layer = |i: u32| {
                    let finer = 2.0_f64.powi(i as i32);
                    noise_value((p * *frequency * finer).to_array(), seed + i) * amplitude / finer
                };
                content(p) + (0..*octaves).map(layer).sum::<f64>()
            }
            Self::Displacement(image) => content(p) - image.height(p),
            Self::Repeat(cells) => cells.value(p, content),
            Self::Recursion { count, offset, inverse, scale, sides } => {
                let (mut q, mut size, mut least) = (p, 1.0, content(p));
                for _ in 1..*count {
                    let fold = |x: f64, side: f64| if side == 0.0 { x } else { x.abs() * side };
                    let folded = DVec3::new(fold(q.x, sides[0]), fold(q.y, sides[1]), fold(q.z, sides[2]));
                    q = *inverse * (folded - *offset) / *scale;
                    size *= scale;
                    least = least.min(content(q) * size);
                }
                least
            }
        }
    }
}

impl Displacement {
    /// The height at a point. The image is viewed from the direction of the axis, and every other tile is mirrored.
    fn height(&self, p: DVec3) -> f64 {
        let [across, down] = match self.axis {
            Axis::X => [-p.z, -p.y],
            Axis::Y => [p.x, p.z],
            Axis::Z => [p.x, -p.y],
        };
        let tile = |at: f64| {
            let at = at.rem_euclid(2.0);
            if at > 1.0 { 2.0 - at } else { at }
        };
        let place = [tile(across * self.tiles[0] + 0.5), tile(down * self.tiles[1] + 0.5)];
        sdf_heights([0, 1].map(|i| place[i] * self.pixels[i]), self.pixels, &|row| self.rows[row])
    }
}

impl Repeat {
    /// The minimum over all copies, or over those around the point if there are too many.
    fn value(&self, p: DVec3, content: &dyn Fn(DVec3) -> f64) -> f64 {
        let cells = self.counts.map(u64::from).iter().product::<u64>();
        let is_all = cells > 0 && cells <= MOST_CELLS;
        let around = |x: f64, axis: usize| {
            let count = i64::from(self.counts[axis]);
            let middle = (x / self.spacing[axis]).round().clamp(-FARTHEST, FARTHEST) as i64;
            let (low, high) = if is_all { (0, count - 1) } else { (middle - REACH, middle + REACH) };
            if count == 0 { low..=high } else { low.max(0).min(count - 1)..=high.min(count - 1).max(0) }
        };
        let mut least = f64::INFINITY;
        for z in around(p.z, 2) {
            for y in around(p.y, 1) {
                for x in around(p.x - self.offset.x * y as f64, 0) {
                    let index = DVec3::new(x as f64, y as f64, z as f64);
                    if !self.is_carved([x, y, z]) {
                        least = least.min(content(self.point(p, index)));
                    }
                }
            }
        }
        least
    }

    fn is_carved(&self, index: [i64; 3]) -> bool {
        (0..3).all(|axis| {
            let [from, to] = self.carved[axis].map(i64::from);
            (from..to).contains(&index[axis])
        })
    }

    /// Maps the point into a copy.
    fn point(&self, p: DVec3, index: DVec3) -> DVec3 {
        let shift = DVec3::new(self.offset.x * index.y, self.offset.y * index.x, self.offset.z * index.x);
        let back = DQuat::from_rotation_y(-self.turn * index.element_sum());
        let mut q = back * (p - index * self.spacing - shift);
        for axis in 0..3 {
            if self.mirrored[axis] && index[axis].rem_euclid(2.0) == 1.0 {
                q[axis] = -q[axis];
            }
        }
        q
    }
}
