//! Textures of materials. Counterpart of `shaders/light/texture.wgsl` and `shaders/light/textured.wgsl`.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::model_look::model_look;
use crate::FlatScene;
use crate::eval::noise_value;
use crate::flat_texture::{FlatImage, FlatTexture, FlatTextures, GpuPlacedTextures, OPACITY_SLOT, TILES, TextureSet};
use crate::mixture::{Mixture, SurfaceMaterial};
use isolith_scene::{TexelForm, TexelLevel};

/// A projection that weighs less is left out.
const LEAST_WEIGHT: f64 = 1.0 / 256.0;
/// Most looks along the longer side of a footprint.
const LOOKS: f64 = 4.0;

/// A point in the space of a texture.
#[derive(Clone, Copy, Debug)]
struct Sample {
    /// In tiles.
    at: DVec3,
    /// Edges of the pixel's footprint on the surface.
    across: DVec3,
    along: DVec3,
    /// Along the axes of the texture.
    normal: DVec3,
    /// Of the three projections.
    weights: DVec3,
}

/// Textures start again after [`TILES`] tiles.
fn texture_wrapped(at: DVec3) -> DVec3 {
    at - TILES * (at / TILES + 0.5).floor()
}

/// Weights of the projections along the axes: powers of the normal's coordinates.
pub fn texture_weights(normal: DVec3, sharpness: f64) -> DVec3 {
    let size = normal.abs();
    let weights = (size / size.max_element().max(1e-9)).max(DVec3::splat(1e-9)).powf(sharpness);
    let weights = (weights / weights.element_sum() - LEAST_WEIGHT).max(DVec3::ZERO);
    weights / weights.element_sum()
}

/// How much of a detail is left if this many of its periods are within the footprint.
fn texture_fade(periods: f64) -> f64 {
    let x = ((periods - 0.25) / 0.5).clamp(0.0, 1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

/// Share of 1 within the width around x of a wave that is 1 for `share` of every unit, from 0 on.
fn texture_pulse(x: f64, width: f64, share: f64) -> f64 {
    let wide = width.max(1e-3);
    let low = x - x.floor() - 0.5 * wide;
    let high = low + wide;
    let rest = |x: f64| (x - x.floor()).min(share);
    (((high.floor() - low.floor()) * share + rest(high) - rest(low)) / wide).clamp(0.0, 1.0)
}

/// Share of the second color of a checker, integrated over the footprint.
pub fn texture_checker(at: DVec2, width: DVec2) -> f64 {
    let x = 2.0 * texture_pulse(at.x, width.x, 0.5) - 1.0;
    let y = 2.0 * texture_pulse(at.y, width.y, 0.5) - 1.0;
    0.5 - 0.5 * x * y
}

/// Share of the mortar.
fn texture_bricks(at: DVec2, width: DVec2, row: f64, joint: f64) -> f64 {
    let (line, tall, thick) = (at.y / row, width.y / row, (joint / row).min(1.0));
    let between_rows = texture_pulse(line + 0.5 * thick, tall, thick);
    let shifted = at.x + 0.5 * (line.floor() - 2.0 * (0.5 * line.floor()).floor());
    let exact = texture_pulse(shifted + 0.5 * joint, width.x, joint);
    let between_bricks = joint + (exact - joint) * texture_fade(tall);
    1.0 - (1.0 - between_rows) * (1.0 - between_bricks)
}

/// Layers of noise between −1 and 1; those that the footprint hides fade out.
fn texture_noise(at: DVec3, width: f64, layers: u32, seed: u32) -> f64 {
    let (mut sum, mut size, mut height, mut frequency) = (0.0, 0.0, 1.0, 1.0);
    for layer in 0..layers.min(10) {
        let left = texture_fade(width * frequency);
        size += height;
        if left > 0.0 {
            sum += height * left * noise_value((at * frequency).to_array(), seed + layer);
        }
        height *= 0.5;
        frequency *= 2.0;
    }
    sum / size
}

/// Share of the second color of a pattern that fills the space.
fn texture_solid(texture: &FlatTexture, sample: &Sample) -> f64 {
    let (scale, [a, b]) = (f64::from(texture.scale), [texture.a, texture.b].map(f64::from));
    let at = sample.at * scale;
    let width = scale * sample.across.length().max(sample.along.length());
    if texture.kind == FlatTexture::NOISE {
        return (0.5 + 0.8 * texture_noise(at, width, a as u32, b as u32)).clamp(0.0, 1.0);
    }
    let is_wood = texture.kind == FlatTexture::WOOD;
    let (frequency, seed) = if is_wood { (0.25, 0) } else { (0.5, b as u32) };
    let wander = a * texture_noise(at * frequency, width * frequency, 4, seed);
    let phase = wander + if is_wood { at.truncate().length() } else { at.x };
    let wave = 0.5 + 0.5 * (TAU * (phase - phase.floor())).cos();
    let (shown, mean) = if is_wood { (wave, 0.5) } else { (wave.powi(4), 0.2734375) };
    mean + (shown - mean) * texture_fade(width * (1.0 + a))
}

/// A coordinate of a texel within the image.
fn texture_wrapped_texel(x: i64, size: i64, wrap: u32) -> i64 {
    if wrap == 2 {
        return x.clamp(0, size - 1);
    }
    let period = if wrap == 1 { 2 * size } else { size };
    let rest = x.rem_euclid(period);
    if rest >= size { period - 1 - rest } else { rest }
}

/// A texel of a level.
fn texture_texel(level: &TexelLevel, form: TexelForm, x: i64, y: i64) -> DVec3 {
    let word = level.texels[level.index(x as u32, y as u32)];
    if form == TexelForm::Value {
        return DVec3::splat(f32::from_bits(word).into());
    }
    let value = DVec3::from([0, 10, 20].map(|bit| f64::from(word >> bit & 1023) / 1023.0));
    if form == TexelForm::Color { value * value } else { value }
}

/// An image at a place in a level, interpolated between four texels.
fn texture_level(image: &FlatImage, level: usize, at: DVec2, wrap: u32) -> DVec3 {
    let form = image.pyramid.form;
    let level = &image.pyramid.levels[image.skipped + level];
    let size = level.size.map(i64::from);
    let place = at * DVec2::new(size[0] as f64, size[1] as f64) - 0.5;
    let corner = place.floor();
    let share = place - corner;
    let [x, y] = [(corner.x, size[0]), (corner.y, size[1])]
        .map(|(x, size)| [0, 1].map(|next| texture_wrapped_texel(x as i64 + next, size, wrap)));
    let row = |y: i64| {
        let [left, right] = x.map(|x| texture_texel(level, form, x, y));
        left.lerp(right, share.x)
    };
    row(y[0]).lerp(row(y[1]), share.y)
}

/// An image over a footprint with these edges.
fn textured_image(image: &FlatImage, at: DVec2, across: DVec2, along: DVec2, wrap: u32) -> DVec3 {
    let levels = image.pyramid.levels.len() - image.skipped;
    let finest = DVec2::from(image.pyramid.levels[image.skipped].size.map(f64::from));
    let (a, b) = (across * finest, along * finest);
    let is_across = a.length_squared() > b.length_squared();
    let (way, longer) = if is_across { (across, a.length()) } else { (along, b.length()) };
    let shorter = a.perp_dot(b).abs() / longer.max(1e-9);
    let looks = (longer / shorter.max(1.0)).ceil().clamp(1.0, LOOKS);
    let detail = shorter.max(longer / looks).max(1.0).log2().clamp(0.0, (levels - 1) as f64);
    let (fine, share) = (detail as usize, detail.fract());
    let start = if wrap == 2 { at } else { at - 2.0 * (at * 0.5).floor() };
    let mut sum = DVec3::ZERO;
    for look in 0..looks as usize {
        let place = start + way * ((look as f64 + 0.5) / looks - 0.5);
        sum += texture_level(image, fine, place, wrap) * (1.0 - share);
        if share > 0.0 {
            sum += texture_level(image, fine + 1, place, wrap) * share;
        }
    }
    sum / looks
}

/// What a texture shows: a color or a value, or for normal maps slopes along the axes of the texture.
fn textured_value(images: &[FlatImage], texture: &FlatTexture, sample: &Sample, is_slope: bool) -> DVec3 {
    let [first, second] = [texture.first, texture.second].map(|color| DVec3::from(color.map(f64::from)));
    if texture.kind >= FlatTexture::NOISE {
        return first.lerp(second, texture_solid(texture, sample));
    }
    let (scale, [row, joint]) = (f64::from(texture.scale), [texture.a, texture.b].map(f64::from));
    let mut sum = DVec3::ZERO;
    for axis in (0..3).filter(|axis| sample.weights[*axis] > 0.0) {
        let side = if sample.normal[axis] < 0.0 { -1.0 } else { 1.0 };
        let (right, down) = match axis {
            0 => (DVec3::NEG_Z * side, DVec3::NEG_Y),
            1 => (DVec3::X, DVec3::Z * side),
            _ => (DVec3::X * side, DVec3::NEG_Y),
        };
        let [at, across, along] =
            [sample.at, sample.across, sample.along].map(|v| DVec2::new(right.dot(v), down.dot(v)) * scale);
        let width = (across * across + along * along).powf(0.5);
        let mut shown = match texture.kind {
            FlatTexture::IMAGE => {
                textured_image(&images[texture.image as usize], at + 0.5, across, along, texture.wrap)
            }
            FlatTexture::CHECKER => first.lerp(second, texture_checker(at, width)),
            _ => first.lerp(second, texture_bricks(DVec2::new(at.x, -at.y), width, row, joint)),
        };
        if is_slope {
            let slope = shown * 2.0 - 1.0;
            shown = (right * slope.x - down * slope.y) / slope.z.max(0.1);
        }
        sum += shown * sample.weights[axis];
    }
    sum
}

/// A point of the surface, relative to the eye, with the edges of the pixel's footprint on its tangent plane.
#[derive(Clone, Copy, Debug)]
pub struct TexturedPoint {
    /// Relative to the eye.
    pub position: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Across the ray.
    pub across: DVec3,
    /// Along the ray.
    pub along: DVec3,
}

/// The point that a pixel of this width shows; `direction` is that of the ray.
pub fn textured_point(direction: DVec3, depth: f64, normal: DVec3, footprint: f64) -> TexturedPoint {
    let width = footprint * depth;
    let facing = normal.dot(direction).abs().max(0.0625);
    let side = normal.cross(direction);
    let other = if normal.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
    let across = if side.length() > 1e-4 { side.normalize() } else { normal.cross(other).normalize() };
    let along = across.cross(normal) * (width / facing);
    TexturedPoint { position: direction * depth, normal, across: across * width, along }
}

/// What the copies of an array add to the place of a texture, in tiles.
fn texture_repeated(placed: &GpuPlacedTextures, position: DVec3) -> DVec3 {
    if placed.repeated == 0 {
        return DVec3::ZERO;
    }
    let [first, last] = [placed.first, placed.last].map(|v| DVec3::from(v.map(f64::from)));
    let at = DVec3::from(placed.cells.map(|row| {
        let [x, y, z, shift] = row.map(f64::from);
        DVec3::new(x, y, z).dot(position) + shift
    }));
    let mut cell = at.round().clamp(first, last);
    cell.x = (at.x - f64::from(placed.skew) * cell.y).round().clamp(first.x, last.x);
    let [x, y, z] = placed.steps.map(|[x, y, z, _]| DVec3::from([x, y, z].map(f64::from)));
    x * cell.x + y * cell.y + z * cell.z
}

/// A point in the space of the textures of a set, and the axes of that space.
fn textured_sample(set: &TextureSet, placed: &GpuPlacedTextures, point: &TexturedPoint) -> (Sample, [DVec3; 3]) {
    let wide = placed.rows.map(|row| row.map(f64::from));
    let rows = DMat3::from_cols_array_2d(&wide.map(|[x, y, z, _]| [x, y, z])).transpose();
    let axes = [0, 1, 2].map(|i| rows.row(i).normalize());
    let normal = DVec3::from(axes.map(|axis| axis.dot(point.normal))).normalize();
    let sample = Sample {
        at: rows * point.position + DVec3::from(wide.map(|[.., shift]| shift))
            - texture_repeated(placed, point.position),
        across: rows * point.across,
        along: rows * point.along,
        normal,
        weights: texture_weights(normal, set.sharpness.into()),
    };
    (sample, axes)
}

/// The opacity that a texture gives at a point, read by `detail` footprints; `None` if none does. `copy_from_eye` leads to
/// the space of the copy that shows it.
pub fn textured_opacity(
    textures: &FlatTextures,
    placed: &GpuPlacedTextures,
    point: &TexturedPoint,
    copy_from_eye: Option<DAffine3>,
    detail: f64,
) -> Option<f64> {
    let set = textures.sets.get(placed.textures as usize)?;
    let texture = &set.slots[OPACITY_SLOT];
    if texture.kind == 0 {
        return None;
    }
    let there = copy_from_eye.filter(|_| placed.copied_by > 0).map(|space| textured_copied(point, &space));
    let (sample, _) = textured_sample(set, placed, there.as_ref().unwrap_or(point));
    let at = texture_wrapped(sample.at);
    let sample = Sample { at, across: sample.across * detail, along: sample.along * detail, ..sample };
    Some(textured_value(&textures.images, texture, &sample, false).x.clamp(0.0, 1.0))
}

/// Places along a side of a tile where the mean of an opacity is taken.
const MEAN_PLACES: u32 = 16;

/// The mean over a tile of what `shown` makes of the opacity of a set.
pub fn mean_texture_opacity(textures: &FlatTextures, set: usize, shown: impl Fn(f64) -> f64) -> f64 {
    let texture = &textures.sets[set].slots[OPACITY_SLOT];
    let places = (0..MEAN_PLACES * MEAN_PLACES).map(|i| {
        let place = DVec3::new((i % MEAN_PLACES).into(), (i / MEAN_PLACES).into(), 0.0);
        (place + DVec3::new(0.5, 0.5, 0.0)) / f64::from(MEAN_PLACES)
    });
    let value = |at: DVec3| {
        let (across, along) = (DVec3::ZERO, DVec3::ZERO);
        let sample = Sample { at, across, along, normal: DVec3::Z, weights: DVec3::Z };
        shown(textured_value(&textures.images, texture, &sample, false).x.clamp(0.0, 1.0))
    };
    places.map(value).sum::<f64>() / f64::from(MEAN_PLACES * MEAN_PLACES)
}

/// A material with its textures, and by how much they bend the normal.
fn textured_material(
    material: SurfaceMaterial,
    textures: &FlatTextures,
    placed: &GpuPlacedTextures,
    point: &TexturedPoint,
) -> (SurfaceMaterial, DVec3) {
    let (mut material, mut bend) = (material, DVec3::ZERO);
    let set = &textures.sets[placed.textures as usize];
    let (sample, axes) = textured_sample(set, placed, point);
    if set.slots[0].kind == FlatTexture::LOOKS {
        let width = (sample.across.length() * sample.along.length()).sqrt();
        let looks = model_look(&textures.looks[set.slots[0].a as usize], texture_wrapped(sample.at), width);
        let rest = 1.0 - looks.share;
        material.base_color = material.base_color * rest + looks.color;
        material.metalness = material.metalness * rest + looks.metalness;
        material.roughness = material.roughness * rest + looks.roughness;
        material.emission = material.emission * rest + looks.emission;
        return (material, axes[0] * looks.bend.x + axes[1] * looks.bend.y + axes[2] * looks.bend.z);
    }
    let stride = ((1.0 / 1024.0) / sample.across.length().max(sample.along.length())).max(1.0);
    let value = |slot: usize, offset: DVec3| {
        let there = Sample { at: texture_wrapped(sample.at + offset * stride), ..sample };
        let texture = &set.slots[slot];
        (texture.kind != 0).then(|| textured_value(&textures.images, texture, &there, slot == 2))
    };
    if let Some(color) = value(0, DVec3::ZERO) {
        material.base_color = color * f64::from(set.base_weight);
    }
    if let Some(roughness) = value(1, DVec3::ZERO) {
        material.roughness = roughness.x.clamp(0.0, 1.0);
    }
    if let Some(slope) = value(2, DVec3::ZERO) {
        bend += (axes[0] * slope.x + axes[1] * slope.y + axes[2] * slope.z) * f64::from(set.strength);
    }
    if let Some(height) = value(3, DVec3::ZERO) {
        for (offset, edge) in [(sample.across, point.across), (sample.along, point.along)] {
            let next = value(3, offset).unwrap_or(height);
            let slope = edge * ((next.x - height.x) / (stride * edge.length_squared()));
            bend -= slope * f64::from(placed.bump);
        }
    }
    (material, bend)
}

/// The point in the space of the copy that shows it.
fn textured_copied(point: &TexturedPoint, copy_from_eye: &DAffine3) -> TexturedPoint {
    let along = |v: DVec3| copy_from_eye.transform_vector3(v);
    TexturedPoint {
        position: copy_from_eye.transform_point3(point.position),
        normal: along(point.normal).normalize(),
        across: along(point.across),
        along: along(point.along),
    }
}

/// A bend in the space of a copy, in the world. `normal` is the normal in that space.
fn textured_world_bend(bend: DVec3, normal: DVec3, copy_from_eye: &DAffine3) -> DVec3 {
    let world = copy_from_eye.matrix3.transpose();
    world * bend / (world * normal).length()
}

/// The material of a mixture with all its textures, and the normal that they bend. `placed` are the textures of the
/// scene's materials, see [`crate::gpu_textures`]. `copy_from_eye` leads to the space of the copy that shows it.
pub fn textured_mixture(
    mixture: &Mixture,
    flat: &FlatScene,
    placed: &[GpuPlacedTextures],
    point: &TexturedPoint,
    copy_from_eye: Option<DAffine3>,
) -> (SurfaceMaterial, DVec3) {
    let FlatScene { materials, textures, .. } = flat;
    let sum: f64 = mixture.weights.iter().sum();
    let (mut mixed, mut bend) = (SurfaceMaterial::default(), DVec3::ZERO);
    for (id, weight) in mixture.ids.into_iter().zip(mixture.weights).filter(|(_, weight)| *weight > 0.0) {
        let plain = SurfaceMaterial::from(&materials[id as usize]);
        let placed = &placed[id as usize];
        let (material, bends) = match copy_from_eye.filter(|_| placed.copied_by > 0) {
            _ if placed.textures == GpuPlacedTextures::NONE => (plain, DVec3::ZERO),
            Some(space) => {
                let there = textured_copied(point, &space);
                let (material, bends) = textured_material(plain, textures, placed, &there);
                (material, textured_world_bend(bends, there.normal, &space))
            }
            None => textured_material(plain, textures, placed, point),
        };
        mixed.add(&material, weight / sum);
        bend += bends * (weight / sum);
    }
    let bend = bend * (4.0 / bend.length().max(1e-9)).min(1.0);
    (mixed, (point.normal + bend).normalize())
}
