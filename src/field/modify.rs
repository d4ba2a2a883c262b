//! Effects of modifiers on bounds and steps, and their rows for the evaluators.
//!
//! A deformation stretches space. Its field is divided by the largest stretch (its Lipschitz constant), which is
//! known only near the content. So every deformation has a bound with a margin m: at a distance d from the bound the
//! field is max(d, min(g, 2m − d)), where g is the divided field. This never grows faster than 1 per meter, has the
//! sign of g within, and is simply d far away. Values up to m describe the content, larger ones its bound: where
//! modifiers around it make a surface of larger values, m grows to these.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use super::lower_bound::LowerBound;
use super::modifier_params::{
    BendParams, DisplacementParams, ElongateParams, NoiseParams, OnionParams, RecursionParams, RepeatParams,
    RoundParams, TaperParams, TwistParams, WavesParams,
};
use super::modifier_reach::too_fine;
use super::modifier_table::modifier_rows;
use super::operand::Modified;
use super::prepare::spline;
use isolith_geometry::Aabb;
use isolith_scene::{Axis, EvalParams, Heights, Modifier};

/// Why a modifier cannot act.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum ModifierRefusal {
    /// It makes no sense here; the artist gets the reason.
    Cannot(String),
    /// One point would need this many copies, more than [`MAX_NEIGHBORS`].
    TooMany(usize),
}

/// Rows of displacing images with their steepest slopes, by the modifier: all copies share them.
pub(super) type Splines = HashMap<*const Modifier, (Rc<[[f64; 4]]>, f64)>;

/// Cells of an endless repetition in each direction: as many as f32 can count and place.
pub const REPEAT_REACH: f64 = 1e6;
/// Most copies evaluated for one point.
pub const MAX_NEIGHBORS: u32 = 64;
/// Most cells counted to one side, so that the counts of three axes can be multiplied; far more than
/// [`MAX_NEIGHBORS`].
const MOST_SIDEWAYS: u32 = 1 << 16;
/// Margin around a bound relative to its size.
const MARGIN: f64 = 0.1;
/// The least margin, in meters.
const LEAST_MARGIN: f64 = 1e-6;
/// Most that values to be read widen a margin, relative to the size of the content: what is moved outward farther
/// looks like its bounds anyway.
const MOST_READ: f64 = 4.0;
/// Stands for infinity: far beyond any camera, and its square still fits f32.
const ENDLESS: f64 = 1e18;
/// A bend turns by at most this angle on each side, in radians.
const MOST_BENT: f64 = 0.95 * std::f64::consts::PI;
/// Content on the inner side of a bend fills at most this fraction of its radius.
const MOST_INWARD: f64 = 0.9;
/// A taper narrows at most to this fraction.
const NARROWEST: f64 = 0.05;

/// Applies a modifier to its content; an error says why it cannot act. Modifiers around it make surfaces of its field
/// up to the value `read_to`.
pub(super) fn modify(
    modifier: &Modifier,
    content: &LowerBound,
    read_to: f64,
    splines: &mut Splines,
) -> Result<Modified, ModifierRefusal> {
    let same = Modified {
        rows: Vec::new(),
        data: Rc::default(),
        bounds: content.bounds,
        cull_box: content.cull_box,
        bound_slope: content.bound_slope,
        copies: 1,
        warning: None,
    };
    let radians = f64::to_radians;
    let mut modified = match *modifier {
        Modifier::Mirror { .. } | Modifier::Polar { .. } => unreachable!("these are copied, see operands"),
        Modifier::Repeat { .. } => repeat(modifier, content, read_to, same)?,
        Modifier::Recursion { count, offset, rotation, scale, mirrored } => {
            let turn = rotation.map(f64::to_radians);
            let rotation = DQuat::from_euler(EulerRot::ZYX, turn[2], turn[1], turn[0]);
            recursion(count, offset.into(), DMat3::from_quat(rotation), scale, mirrored, same)
        }
        Modifier::Twist { angle } => twist(radians(angle), bounded(content, "twisted")?, content.radius, read_to, same),
        Modifier::Bend { angle } => bend(radians(angle), bounded(content, "bent")?, read_to, same),
        Modifier::Taper { change } => taper(change, bounded(content, "tapered")?, read_to, same),
        Modifier::Elongate { length } => {
            let half = DVec3::from(length) * 0.5;
            let grown = |b: Aabb| Aabb::new(b.min - half, b.max + half);
            let rows = ElongateParams { half: half.to_array() }.to_rows();
            Modified { rows, bounds: grown(same.bounds), cull_box: grown(same.cull_box), ..same }
        }
        Modifier::Round { radius } => grown(same, radius, RoundParams { radius }.to_rows()),
        Modifier::Onion { thickness, walls, spacing } => {
            let half = 0.5 * thickness;
            grown(same, half, OnionParams { half, walls: f64::from(walls), spacing }.to_rows())
        }
        Modifier::Waves { amplitude, length, phase } => {
            let frequency = std::f64::consts::TAU / length;
            // |∇ sin x sin y sin z| is at most 1.
            let slope = 1.0 / (1.0 + amplitude * frequency);
            grown(same, amplitude, WavesParams { amplitude, frequency, phase: radians(phase), slope }.to_rows())
        }
        Modifier::Noise { amplitude, size, octaves, seed } => noise(amplitude, size, octaves, seed, same),
        Modifier::Displacement { ref image, height, tile, axis } => {
            let image = image.content().expect("idle without an image");
            let side = tile / image.size[0] as f64;
            let made = splines.entry(std::ptr::from_ref(modifier)).or_insert_with(|| {
                let (data, steepest) = spline(image, [side; 2], height);
                (data.into(), steepest)
            });
            displacement(image, made.clone(), height, tile, axis, same)
        }
    };
    if let Some(warning) = too_fine(modifier, &content.bounds) {
        modified.warning = Some(warning);
    }
    modified.rows.resize(modifier_rows(modifier.kind()), [0.0; 4]);
    if !modified.cull_box.is_finite() {
        modified.bound_slope = 0.0;
    }
    Ok(modified)
}

/// Whether a modifier changes nothing and needs no entry.
pub(super) fn is_idle(modifier: &Modifier) -> bool {
    match *modifier {
        Modifier::Mirror { axes, .. } => axes == [false; 3],
        Modifier::Polar { .. } | Modifier::Onion { .. } => false,
        Modifier::Repeat { counts, carve_to, .. } => counts == [1; 3] && carve_to == [0; 3],
        Modifier::Recursion { count, .. } => count == 1,
        Modifier::Twist { angle } | Modifier::Bend { angle } => angle == 0.0,
        Modifier::Taper { change } => change == 0.0,
        Modifier::Elongate { length } => length == [0.0; 3],
        Modifier::Round { radius } => radius == 0.0,
        Modifier::Waves { amplitude, .. } | Modifier::Noise { amplitude, .. } => amplitude == 0.0,
        Modifier::Displacement { ref image, height, .. } => height == 0.0 || image.content().is_none(),
    }
}

/// Steepest slope of value noise between −1 and 1 with cells of size 1 and weights 3u² − 2u³: 2√3. At cell
/// coordinate u the weights' slope over the spread of the two sides' values is at most √3, and the squares of
/// the slopes along the three axes, each over its spread, add up to at most the variance of the values
/// (Parseval's identity for multilinear functions).
const NOISE_SLOPE: f64 = 3.464_101_615_137_755;

/// The bounds of content that must be bounded to be `deformed`.
fn bounded(content: &LowerBound, deformed: &str) -> Result<Aabb, ModifierRefusal> {
    if content.bounds.is_finite() {
        return Ok(content.bounds);
    }
    Err(ModifierRefusal::Cannot(format!("has no end, so it cannot be {deformed}")))
}

/// The margin around the bounds of a deformation's content of this size: the usual one, or what is read.
fn margin(usual: f64, size: f64, read_to: f64) -> f64 {
    usual.max(read_to.min(MOST_READ * size)).max(LEAST_MARGIN)
}

fn grown(same: Modified, by: f64, rows: Vec<[f64; 4]>) -> Modified {
    let reach = if same.bound_slope > 0.0 { by / same.bound_slope } else { 0.0 };
    Modified { rows, bounds: same.bounds.expanded(by), cull_box: same.cull_box.expanded(reach), ..same }
}

fn noise(amplitude: f64, size: f64, octaves: u32, seed: u32, same: Modified) -> Modified {
    let total = 2.0 - 0.5_f64.powi(octaves as i32 - 1);
    // Each octave has half the height and half the size of the one before, so the same steepness.
    let steepness = amplitude / total * f64::from(octaves) * NOISE_SLOPE / size;
    let params = NoiseParams {
        amplitude: amplitude / total,
        frequency: 1.0 / size,
        layers: octaves,
        seed,
        slope: 1.0 / (1.0 + steepness),
        reach: amplitude,
    };
    grown(same, amplitude, params.to_rows())
}

/// The surface moves outward by h, so the field is f − h; its slope is at most 1 plus that of the heights.
fn displacement(
    image: &Heights,
    (data, steepest): (Rc<[[f64; 4]]>, f64),
    height: f64,
    tile: f64,
    axis: Axis,
    same: Modified,
) -> Modified {
    let [columns, lines] = image.size.map(|n| n as f64);
    let side = tile / columns;
    let heights = || image.values.iter().map(|v| v * height);
    let (least, greatest) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    let params = DisplacementParams {
        tiles: [1.0 / tile, 1.0 / (side * lines)],
        cells: [columns, lines],
        slope: 1.0 / (1.0 + steepest),
        least,
        greatest,
        axis: axis as u32,
    };
    Modified { data, ..grown(same, greatest.max(0.0), params.to_rows()) }
}

/// A deformation whose field is at least the distance to its bound along some axis: the largest of three
/// perpendicular components is at least 1/√3 of their length.
fn enclosed(same: Modified, bounds: Aabb, rows: Vec<[f64; 4]>) -> Modified {
    Modified { rows, bounds, cull_box: bounds, bound_slope: 1.0 / 3.0_f64.sqrt(), ..same }
}

/// Greatest distance of a box from the Y axis.
fn radius_of(b: &Aabb) -> f64 {
    b.min.x.abs().max(b.max.x.abs()).hypot(b.min.z.abs().max(b.max.z.abs()))
}

/// Largest stretch of a twist that moves a point by `slope` meters across the axis per meter along it (the larger
/// singular value of a shear).
fn shear(slope: f64) -> f64 {
    0.5 * (slope + (slope * slope + 4.0).sqrt())
}

fn twist(angle: f64, content: Aabb, radius: f64, read_to: f64, same: Modified) -> Modified {
    let radius = radius_of(&content).min(radius);
    let (middle, half) = (content.center().y, content.half().y);
    let margin = margin(MARGIN * radius.max(0.1 * half), radius.max(half), read_to);
    let stretch = shear(angle.abs() * (radius + margin));
    let bounds = Aabb::new(DVec3::new(-radius, content.min.y, -radius), DVec3::new(radius, content.max.y, radius));
    let params = TwistParams { rate: angle, slope: 1.0 / stretch, radius, margin, center: middle, half };
    enclosed(same, bounds, params.to_rows())
}

fn bend(angle: f64, content: Aabb, read_to: f64, same: Modified) -> Modified {
    let sign = angle.signum();
    let reach = content.min.x.abs().max(content.max.x.abs());
    // Toward the center of the arc, and away from it.
    let [low, high] = if sign > 0.0 { [content.min.y, content.max.y] } else { [-content.max.y, -content.min.y] };
    let inward = if high > 0.0 { MOST_INWARD / high } else { f64::INFINITY };
    let around = if reach > 0.0 { MOST_BENT / reach } else { f64::INFINITY };
    let curvature = angle.abs().min(inward).min(around);
    let mut warning = (curvature < angle.abs()).then(|| {
        let degrees = (curvature.to_degrees() * 100.0).round() / 100.0;
        if inward < around {
            format!("is bent by {degrees}°/m only: its inner side would fold over")
        } else {
            format!("is bent by {degrees}°/m only: its ends would meet")
        }
    });
    let radius = 1.0 / curvature;
    let open = (std::f64::consts::PI - reach * curvature).min(std::f64::consts::FRAC_PI_2);
    let room = radius - high;
    let size = content.half().max_element();
    let wide = margin(MARGIN * size, size, read_to);
    let margin = wide.min(0.5 * room * open.sin()).max(LEAST_MARGIN);
    if warning.is_none() && read_to > margin && margin < wide {
        warning = Some(format!("is bent too tightly for its surface to be moved outward by more than {margin:.3} m"));
    }
    let stretch = (radius / (room - margin).max(1e-3 * room)).max(1.0);
    let bounds = bent_bounds(curvature, sign, reach, [low, high], &content);
    let params = BendParams {
        radius,
        slope: 1.0 / stretch,
        margin,
        side: sign,
        reach: reach * curvature,
        low,
        high,
        center: bounds.center().to_array(),
        half: bounds.half().to_array(),
    };
    Modified { warning, ..enclosed(same, bounds, params.to_rows()) }
}

/// The box around an arc: it contains the ends, and the points where the arc passes an axis.
fn bent_bounds(curvature: f64, sign: f64, reach: f64, [low, high]: [f64; 2], content: &Aabb) -> Aabb {
    let radius = 1.0 / curvature;
    let end = reach * curvature;
    let mut flat = Aabb::EMPTY;
    let quarters = [0.0, 0.5, 1.0].map(|q| q * std::f64::consts::PI).into_iter().filter(|a| *a <= end);
    for angle in quarters.chain([end]) {
        for r in [radius - low, radius - high] {
            for side in [-1.0, 1.0] {
                let at = DVec3::new(side * r * angle.sin(), sign * (radius - r * angle.cos()), 0.0);
                flat = flat.union(&Aabb::new(at, at));
            }
        }
    }
    let z = |v: f64| DVec3::Z * v;
    Aabb::new(flat.min + z(content.min.z), flat.max + z(content.max.z))
}

fn taper(change: f64, content: Aabb, read_to: f64, same: Modified) -> Modified {
    let width = |y: f64, change: f64| 1.0 + change * y;
    let narrow = |change: f64| width(content.min.y, change).min(width(content.max.y, change));
    let mut warning = None;
    let mut used = change;
    if narrow(change) < NARROWEST {
        // The end that becomes too narrow decides: 1 + c y = NARROWEST there.
        let at = if change < 0.0 { content.max.y } else { content.min.y };
        used = (NARROWEST - 1.0) / at;
        warning = Some(format!("is tapered by {:.3}/m only: it would narrow to nothing", used));
    }
    let ends = [width(content.min.y, used), width(content.max.y, used)];
    let (narrowest, widest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let size = content.half().max_element();
    let margin = margin(MARGIN * size, size, read_to);
    let radius = radius_of(&content) + 1.5 * margin / narrowest;
    let (a, b) = (1.0 / narrowest, radius * used.abs() / narrowest);
    let sum = a * a + b * b + 1.0;
    let stretch = (0.5 * (sum + (sum * sum - 4.0 * a * a).max(0.0).sqrt())).sqrt().max(1.0);
    // Content on one side of the axis is nearest to it where it is narrow.
    let far = |v: f64, outward: bool| if (v >= 0.0) == outward { v * widest } else { v * narrowest };
    let corner = |v: DVec3, outward| DVec3::new(far(v.x, outward), v.y, far(v.z, outward));
    let bounds = Aabb::new(corner(content.min, false), corner(content.max, true));
    let params = TaperParams {
        rate: used,
        slope: 1.0 / stretch,
        margin,
        center: bounds.center().to_array(),
        low: content.min.y,
        half: bounds.half().to_array(),
        high: content.max.y,
    };
    Modified { warning, ..enclosed(same, bounds, params.to_rows()) }
}

fn recursion(count: u32, offset: DVec3, rotation: DMat3, scale: f64, mirrored: [bool; 3], same: Modified) -> Modified {
    let parent_from_child = DAffine3 { matrix3: rotation * scale, translation: offset };
    let all_levels = |content: Aabb| {
        let (mut level, mut all) = (content, content);
        for _ in 1..count {
            level = level.transformed(&parent_from_child);
            for axis in (0..3).filter(|a| mirrored[*a]) {
                let mut flip = DVec3::ONE;
                flip[axis] = -1.0;
                level = level.union(&level.transformed(&DAffine3::from_scale(flip)));
            }
            all = all.union(&level);
        }
        all
    };
    // Folds space to the side of the next copy.
    let child = if same.bounds.is_finite() { parent_from_child.transform_point3(same.bounds.center()) } else { offset };
    let flag = |i: usize| (1 << i) + if child[i] < 0.0 { 8 << i } else { 0 };
    let inverse = rotation.transpose();
    let (center, half) = finite_box(&same.cull_box);
    let params = RecursionParams {
        offset: offset.to_array(),
        scale,
        inverse_x: inverse.row(0).to_array(),
        count,
        inverse_y: inverse.row(1).to_array(),
        mirrored: (0..3).filter(|i| mirrored[*i]).map(flag).sum(),
        inverse_z: inverse.row(2).to_array(),
        center: center.to_array(),
        slope: same.bound_slope,
        half: half.to_array(),
    };
    let rows = params.to_rows();
    Modified { rows, bounds: all_levels(same.bounds), cull_box: all_levels(same.cull_box), copies: count, ..same }
}

/// Center and half extent, with finite numbers in place of infinity.
fn finite_box(bounds: &Aabb) -> (DVec3, DVec3) {
    let limit = DVec3::splat(ENDLESS);
    let b = Aabb::new(bounds.min.clamp(-limit, limit), bounds.max.clamp(-limit, limit));
    (b.center(), b.half())
}

/// The cells along one axis: first and last cell, center and half extent of the content in its cell, number of
/// neighbors to evaluate.
struct Cells {
    first: f64,
    last: f64,
    middle: f64,
    half: f64,
    candidates: u32,
}

/// The number of cells to evaluate around a point, for content that reaches `half` from the middle of cells `spacing`
/// apart: one if it keeps clear of the walls, two (the cell and its nearer neighbor) up to 7/8 of a cell, and so on.
/// Omitted content is farther away than an eighth of a cell.
fn candidates(half: f64, spacing: f64) -> u32 {
    let reach = half / spacing;
    if reach <= 0.375 { 1 } else { 2 * ((reach + 0.125).ceil() as u32).clamp(1, MOST_SIDEWAYS) }
}

/// Sets the number of cells to evaluate along each axis so that those left out are farther away than `read_to`.
/// Returns their product.
fn visit(axes: &mut [Cells], counts: [u32; 3], spacing: [f64; 3], read_to: f64) -> u64 {
    for (i, axis) in axes.iter_mut().enumerate() {
        axis.candidates = match counts[i] {
            0 => candidates(axis.half + read_to, spacing[i]),
            1 => 1,
            n => candidates(axis.half + read_to, spacing[i]).min(2 * n),
        };
    }
    axes.iter().map(|axis| u64::from(axis.candidates)).product()
}

fn repeat(
    modifier: &Modifier,
    content: &LowerBound,
    read_to: f64,
    same: Modified,
) -> Result<Modified, ModifierRefusal> {
    let Modifier::Repeat { counts, spacing, mut offset, turn, mirrored, carve_from, carve_to } = *modifier else {
        unreachable!("called for repeats only")
    };
    let turn = turn.to_radians();
    // The box of the lower bound, extended by the bounds of the surface.
    let held = if content.bound_slope > 0.0 { content.cull_box.union(&content.bounds) } else { content.bounds };
    let (mut center, mut half) = finite_box(&held);
    if turn != 0.0 {
        let radius = radius_of(&held).min(content.radius);
        (center.x, center.z, half.x, half.z) = (0.0, 0.0, radius.min(ENDLESS), radius.min(ENDLESS));
    }
    for axis in (0..3).filter(|a| mirrored[*a]) {
        half[axis] += center[axis].abs();
        center[axis] = 0.0;
    }
    let mut axes = Vec::with_capacity(3);
    for i in 0..3 {
        let (first, last) = match counts[i] {
            0 => (-REPEAT_REACH, REPEAT_REACH),
            n => (0.0, f64::from(n - 1)),
        };
        if counts[i] != 1 && half[i] >= ENDLESS {
            let axis = ["X", "Y", "Z"][i];
            return Err(ModifierRefusal::Cannot(format!("has no end along {axis}, so it cannot be repeated along it")));
        }
        axes.push(Cells { first, last, middle: center[i], half: half[i], candidates: 1 });
    }
    let mut warning = None;
    let mut copies = visit(&mut axes, counts, spacing, read_to);
    if copies > u64::from(MAX_NEIGHBORS) && read_to > 0.0 {
        warning = Some("has more copies within reach than are evaluated where its surface is moved outward".into());
        copies = visit(&mut axes, counts, spacing, 0.0);
    }
    // An offset along an axis with cells of its own would leave these cells; bricks need both X and Y.
    for i in [1, 2] {
        offset[i] = if counts[i] == 1 && counts[0] != 1 { offset[i] } else { 0.0 };
    }
    offset[0] = if counts[0] != 1 && counts[1] != 1 { offset[0] } else { 0.0 };
    if copies > u64::from(MAX_NEIGHBORS) {
        return Err(ModifierRefusal::TooMany(copies as usize));
    }
    let bounds = repeated_bounds(&Aabb::from_center_half(center, half), &axes, counts, spacing, offset);
    let bound_slope = content.bound_slope.min(1.0);
    let each = |f: &dyn Fn(&Cells) -> f64| [f(&axes[0]), f(&axes[1]), f(&axes[2])];
    let finite = |corner: DVec3| corner.clamp(DVec3::splat(-ENDLESS), DVec3::splat(ENDLESS)).to_array();
    let params = RepeatParams {
        spacing,
        turn,
        first: each(&|a| a.first),
        mirrored: mirrored.iter().enumerate().map(|(i, on)| u32::from(*on) << i).sum(),
        last: each(&|a| a.last),
        candidates: axes.iter().rev().fold(0, |code, a| code * 128 + a.candidates),
        middle: each(&|a| a.middle),
        slope: bound_slope,
        half: each(&|a| a.half),
        offset,
        carve_from: carve_from.map(f64::from),
        carve_to: carve_to.map(f64::from),
        least: finite(bounds.min),
        greatest: finite(bounds.max),
    };
    let rows = params.to_rows();
    Ok(Modified { rows, bounds, cull_box: bounds, bound_slope, copies: copies as u32, warning, ..same })
}

fn repeated_bounds(cell: &Aabb, axes: &[Cells], counts: [u32; 3], spacing: [f64; 3], offset: [f64; 3]) -> Aabb {
    let mut out = *cell;
    let last = [axes[0].last, axes[1].last];
    for i in 0..3 {
        if counts[i] == 0 || axes[i].half >= ENDLESS {
            (out.min[i], out.max[i]) = (f64::NEG_INFINITY, f64::INFINITY);
            continue;
        }
        out.max[i] += axes[i].last * spacing[i];
        // Offset of the last copies: rows along Y shift X, copies along X shift Y and Z.
        let steps = if i == 0 { last[1] } else { last[0] };
        let endless = counts[usize::from(i == 0)] == 0;
        let shift = if offset[i] == 0.0 { 0.0 } else { offset[i] * steps };
        if endless && shift != 0.0 {
            (out.min[i], out.max[i]) = (f64::NEG_INFINITY, f64::INFINITY);
        } else {
            out.min[i] += shift.min(0.0);
            out.max[i] += shift.max(0.0);
        }
    }
    out
}
