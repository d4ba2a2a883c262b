//! What shading needs of an environment that is not a gradient: its light as spherical harmonics and as images for
//! rough reflections. Computed once per image; the shader reads the same words (`shaders/light/environment.wgsl`).

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use rayon::prelude::*;

use isolith_scene::{Attachment, Environment, EnvironmentImage, EnvironmentKind};

/// Levels of [`EnvironmentMap`]: the image, and [`ROUGH_LEVELS`] for reflections.
pub const LEVELS: usize = 1 + ROUGH_LEVELS;
/// Images for reflections. That with the index k is for the roughness (k / (n − 1))^1.5.
pub const ROUGH_LEVELS: usize = 6;
/// Sizes of the images for reflections, at most.
const ROUGH_SIZES: [[usize; 2]; ROUGH_LEVELS] = [[256, 128], [256, 128], [128, 64], [64, 32], [32, 16], [32, 16]];
/// Directions that a texel of the images for reflections averages: the fewer texels, the more.
const SAMPLES: std::ops::RangeInclusive<usize> = 64..=1024;
/// Directions that all texels of such an image average together, within these limits.
const LEVEL_SAMPLES: usize = 1 << 21;

/// An equirectangular image with shared exponents: 9 bits of each color, and 5 of the exponent.
#[derive(Clone, Debug, PartialEq)]
pub struct MapLevel {
    /// Columns and lines.
    pub size: [usize; 2],
    /// Texels, line by line.
    pub texels: Vec<u32>,
}

/// The light of an environment, see the module. Not rotated, and of strength 1.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// The image, then the images for reflections, the smoothest first.
    pub levels: Vec<MapLevel>,
    /// Irradiance by π: factors of 1, y, z, x, xy, yz, 3z² − 1, xz, x² − y² (Ramamoorthi and Hanrahan, "An efficient
    /// representation for irradiance environment maps", 2001).
    pub harmonics: [DVec3; 9],
}

/// An environment map as a scene uses it.
#[derive(Clone, Debug)]
pub struct PlacedMap {
    /// The map.
    pub map: Arc<EnvironmentMap>,
    /// Factor on its colors.
    pub strength: f64,
    /// Turn about the vertical axis, in radians.
    pub rotation: f64,
}

impl PartialEq for PlacedMap {
    fn eq(&self, other: &Self) -> bool {
        let is_same = Arc::ptr_eq(&self.map, &other.map) || self.map == other.map;
        is_same && [self.strength, self.rotation] == [other.strength, other.rotation]
    }
}

impl PlacedMap {
    /// The map of the environment; `None` for a gradient.
    pub fn of(environment: &Environment) -> Option<Self> {
        match &environment.background {
            EnvironmentKind::Gradient { .. } => None,
            EnvironmentKind::Color { color } => {
                let texel = color.map(|v| v as f32);
                // As many texels as the sums over directions need to be exact.
                let image = EnvironmentImage { size: [64, 32], texels: vec![texel; 2048], pixels: 2048 };
                Some(Self { map: Arc::new(EnvironmentMap::new(&image)), strength: 1.0, rotation: 0.0 })
            }
            EnvironmentKind::Image { image, strength, rotation } => {
                Some(Self { map: of_image(image), strength: *strength, rotation: rotation.to_radians() })
            }
        }
    }

    /// A world direction in the map's space.
    pub fn map_from_world(&self, direction: DVec3) -> DVec3 {
        let (sine, cosine) = self.rotation.sin_cos();
        let DVec3 { x, y, z } = direction;
        DVec3::new(cosine * x - sine * z, y, sine * x + cosine * z)
    }
}

/// The map of an image, made once: the last one is kept.
fn of_image(image: &Attachment<EnvironmentImage>) -> Arc<EnvironmentMap> {
    type Last = Option<(Attachment<EnvironmentImage>, Arc<EnvironmentMap>)>;
    static LAST: Mutex<Last> = Mutex::new(None);
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, map)) = last.as_ref().filter(|(known, _)| known.is_same(image)) {
        return Arc::clone(map);
    }
    let nothing = EnvironmentImage { size: [1, 1], texels: vec![[0.0; 3]], pixels: 1 };
    let map = Arc::new(EnvironmentMap::new(image.content().unwrap_or(&nothing)));
    *last = Some((image.clone(), Arc::clone(&map)));
    map
}

impl EnvironmentMap {
    /// The map of an image.
    pub fn new(image: &EnvironmentImage) -> Self {
        let whole = MapLevel::new(image.size, |i| DVec3::from(image.texels[i].map(f64::from)));
        let mut reduced = vec![whole.clone()];
        while let Some(next) = reduced.last().and_then(MapLevel::halved) {
            reduced.push(next);
        }
        let rough = (0..ROUGH_LEVELS).map(|k| rough_level(&reduced, k));
        let harmonics = harmonics(reduced.iter().find(|level| level.size[0] <= 128).unwrap_or(&whole));
        Self { levels: std::iter::once(whole.clone()).chain(rough).collect(), harmonics }
    }

    /// Irradiance by π of a surface with this normal.
    pub fn irradiance(&self, normal: DVec3) -> DVec3 {
        let sum: DVec3 = self.harmonics.iter().zip(basis(normal)).map(|(factor, value)| *factor * value).sum();
        sum.max(DVec3::ZERO)
    }

    /// Radiance around a direction, blurred as by a reflection of this roughness.
    pub fn reflected(&self, direction: DVec3, roughness: f64) -> DVec3 {
        let at = roughness.clamp(0.0, 1.0).powf(2.0 / 3.0) * (ROUGH_LEVELS - 1) as f64;
        let below = (at as usize).min(ROUGH_LEVELS - 2);
        let [a, b] = [1, 2].map(|next| self.levels[below + next].radiance(direction));
        a.lerp(b, at - below as f64)
    }
}

/// The values that [`EnvironmentMap::harmonics`] are factors of.
fn basis(DVec3 { x, y, z }: DVec3) -> [f64; 9] {
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// The factors of [`basis`] for the irradiance by π.
fn harmonics(level: &MapLevel) -> [DVec3; 9] {
    // The squares of the norms of the basis, and the factors of the cosine's lobe by π.
    let norms = [0.25, 0.75, 0.75, 0.75, 3.75, 3.75, 0.3125, 3.75, 0.9375].map(|n| n / PI);
    let lobe = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    let mut sums = [DVec3::ZERO; 9];
    for (i, texel) in level.texels.iter().enumerate() {
        let direction = level.direction(i);
        let light = unpacked(*texel) * level.solid_angle(i / level.size[0]);
        sums.iter_mut().zip(basis(direction)).for_each(|(sum, value)| *sum += light * value);
    }
    std::array::from_fn(|i| sums[i] * norms[i] * lobe[i])
}

/// An image for reflections, made of the image and its reductions by halves: means weighted by the lobe of GGX seen
/// head-on (Karis, "Real shading in Unreal Engine 4", 2013; Křivánek and Colbert, "Real-time shading with filtered
/// importance sampling", 2008).
fn rough_level(reduced: &[MapLevel], k: usize) -> MapLevel {
    let size = [0, 1].map(|axis| ROUGH_SIZES[k][axis].min(reduced[0].size[axis]));
    let roughness = (k as f64 / (ROUGH_LEVELS - 1) as f64).powf(1.5);
    let a2 = roughness.powi(4);
    let samples = (LEVEL_SAMPLES / (size[0] * size[1])).clamp(*SAMPLES.start(), *SAMPLES.end());
    let place = MapLevel { size, texels: Vec::new() };
    // The reduction whose texels are as large as the solid angle `solid`.
    let sampled = |direction: DVec3, solid: f64| {
        let texel = 4.0 * PI / (reduced[0].size[0] * reduced[0].size[1]) as f64;
        let at = (0.5 * (solid / texel).log2()).clamp(0.0, (reduced.len() - 1) as f64);
        let below = at as usize;
        let above = (below + 1).min(reduced.len() - 1);
        reduced[below].radiance(direction).lerp(reduced[above].radiance(direction), at - below as f64)
    };
    let average = |normal: DVec3| {
        if k == 0 {
            return sampled(normal, 4.0 * PI / (size[0] * size[1]) as f64);
        }
        let (right, up) = normal.any_orthonormal_pair();
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for i in 0..samples {
            let (u, turn) = ((i as f64 + 0.5) / samples as f64, 2.0 * PI * radical_inverse(i as u32));
            let cosine = ((1.0 - u) / (1.0 + (a2 - 1.0) * u)).sqrt();
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let half = right * (sine * turn.cos()) + up * (sine * turn.sin()) + normal * cosine;
            let direction = 2.0 * cosine * half - normal;
            let weight = direction.dot(normal);
            if weight > 0.0 {
                // The density of the direction is that of the half vector by 4 cos.
                let density = a2 / (PI * (cosine * cosine * (a2 - 1.0) + 1.0).powi(2)) * 0.25;
                sum += sampled(direction, 1.0 / (samples as f64 * density)) * weight;
                weights += weight;
            }
        }
        sum / f64::max(weights, 1e-9)
    };
    MapLevel::new(size, |i| average(place.direction(i)))
}

/// The bits of a number in reverse order behind the point (van der Corput).
fn radical_inverse(number: u32) -> f64 {
    f64::from(number.reverse_bits()) / 4_294_967_296.0
}

impl MapLevel {
    fn new(size: [usize; 2], color: impl Fn(usize) -> DVec3 + Sync) -> Self {
        Self { size, texels: (0..size[0] * size[1]).into_par_iter().map(|i| packed(color(i))).collect() }
    }

    /// The level with half as many columns and lines; `None` if there is one texel.
    fn halved(&self) -> Option<Self> {
        let [columns, lines] = self.size;
        let size = [columns.div_ceil(2), lines.div_ceil(2)];
        let mean = |i: usize| {
            let (x, y) = (i % size[0] * 2, i / size[0] * 2);
            let places = [[0, 0], [1, 0], [0, 1], [1, 1]];
            let [sum, weight] = places.iter().fold([DVec3::ZERO; 2], |[sum, weight], [dx, dy]| {
                let (x, y) = ((x + dx).min(columns - 1), (y + dy).min(lines - 1));
                // Lines near the poles cover less.
                let solid = self.solid_angle(y);
                [sum + unpacked(self.texels[y * columns + x]) * solid, weight + solid]
            });
            sum / weight
        };
        (columns > 1 || lines > 1).then(|| Self::new(size, mean))
    }

    /// The direction of the middle of a texel.
    fn direction(&self, i: usize) -> DVec3 {
        let [columns, lines] = self.size.map(|n| n as f64);
        let around = ((i % self.size[0]) as f64 + 0.5) / columns * 2.0 * PI;
        let down = ((i / self.size[0]) as f64 + 0.5) / lines * PI;
        DVec3::new(-around.sin() * down.sin(), down.cos(), around.cos() * down.sin())
    }

    /// The solid angle of a texel in this line.
    fn solid_angle(&self, line: usize) -> f64 {
        let [columns, lines] = self.size.map(|n| n as f64);
        let [above, below] = [0.0, 1.0].map(|edge| ((line as f64 + edge) / lines * PI).cos());
        (above - below) * 2.0 * PI / columns
    }

    /// The radiance from a unit direction, between the four nearest texels.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let [columns, lines] = self.size.map(|n| n as f64);
        let x = (0.5 + direction.x.atan2(-direction.z) / (2.0 * PI)) * columns - 0.5;
        let y = (direction.y.clamp(-1.0, 1.0).acos() / PI * lines - 0.5).clamp(0.0, lines - 1.0);
        let [left, top] = [x.floor(), y.floor()];
        let texel = |dx: f64, dy: f64| {
            let column = (left + dx + columns) as usize % self.size[0];
            let line = ((top + dy) as usize).min(self.size[1] - 1);
            unpacked(self.texels[line * self.size[0] + column])
        };
        let upper = texel(0.0, 0.0).lerp(texel(1.0, 0.0), x - left);
        let lower = texel(0.0, 1.0).lerp(texel(1.0, 1.0), x - left);
        upper.lerp(lower, y - top)
    }
}

/// Steps of a texel with the exponent 0.
const STEP: f64 = 1.0 / 16_777_216.0;

/// A color as 9 bits each of red, green and blue, and 5 bits of their exponent.
fn packed(color: DVec3) -> u32 {
    let most = color.max_element().clamp(0.0, 65_408.0);
    let mut exponent = ((most / (512.0 * STEP)).log2().ceil()).clamp(0.0, 31.0);
    if (most / (STEP * exponent.exp2())).round() > 511.0 {
        exponent = (exponent + 1.0).min(31.0);
    }
    let [r, g, b] = color.to_array().map(|v| (v.max(0.0) / (STEP * exponent.exp2())).round().min(511.0) as u32);
    r | (g << 9) | (b << 18) | ((exponent as u32) << 27)
}

/// The color of a texel.
fn unpacked(texel: u32) -> DVec3 {
    let step = STEP * f64::from(texel >> 27).exp2();
    DVec3::from([0, 9, 18].map(|shift| f64::from((texel >> shift) & 511) * step))
}

/// Words of the header of [`map_words`].
pub const MAP_HEADER: usize = 64;

/// The words that the shader reads: a header, and the texels of all levels. Without a map only the header. The header
/// holds the harmonics times the strength, the strength, the sine and cosine of the rotation, and for each level its
/// size and the place of its texels.
pub fn map_words(placed: Option<&PlacedMap>) -> Vec<u32> {
    let Some(PlacedMap { map, strength, rotation }) = placed else { return vec![0; MAP_HEADER] };
    let harmonics = map.harmonics.iter().flat_map(|factor| (*factor * *strength).to_array());
    let numbers = harmonics.chain([*strength, rotation.sin(), rotation.cos()]);
    let mut words: Vec<u32> = numbers.map(|number| (number as f32).to_bits()).collect();
    let mut place = MAP_HEADER;
    for level in &map.levels {
        words.extend([level.size[0], level.size[1], place].map(|word| word as u32));
        place += level.texels.len();
    }
    words.resize(MAP_HEADER, 0);
    words.extend(map.levels.iter().flat_map(|level| &level.texels));
    words
}

#[cfg(test)]
mod tests;
