//! Motions of copies and nodes. Counterpart of `shaders/copy/dynamics.wgsl`.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DQuat, DVec2, DVec3};

use super::hash::{Channel, copy_hash, copy_randoms};
use super::instancer::FlatDynamic;
use super::noise::{Coordinate, copy_curl, copy_noise_1, copy_noise_2};
use isolith_scene::{Dynamic, DynamicKind};

/// Change of a copy by its dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyMotion {
    /// Displacement, in the space of the instancer or of the node's parent.
    pub translation: DVec3,
    /// Rotation about the copy's origin.
    pub rotation: DQuat,
    /// Factor on the size.
    pub scale: f64,
    /// Added to the hue, in rounds.
    pub hue: f64,
    /// Factor on the emission.
    pub emission: f64,
}

impl CopyMotion {
    /// No motion.
    pub const NONE: Self =
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: 1.0, hue: 0.0, emission: 1.0 };

    fn translated(by: DVec3) -> Self {
        Self { translation: by, ..Self::NONE }
    }

    fn rotated(rotation: DQuat) -> Self {
        Self { rotation, ..Self::NONE }
    }

    /// This motion, then another one.
    fn then(self, next: Self) -> Self {
        Self {
            translation: self.translation + next.translation,
            rotation: next.rotation * self.rotation,
            scale: self.scale * next.scale,
            hue: self.hue + next.hue,
            emission: self.emission * next.emission,
        }
    }
}

/// How far dynamics take a copy at any time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Greatest displacement.
    pub displacement: f64,
    /// Greatest factor on the size.
    pub scale: f64,
    /// Greatest angle between the copy's Y axis and the one that it has at rest.
    pub tilt: f64,
}

impl Envelope {
    /// Of what stands still.
    pub const STILL: Self = Self { displacement: 0.0, scale: 1.0, tilt: 0.0 };
}

/// The curl of the noise is scaled by this before it is bounded.
const CURL_SCALE: f64 = 0.4;
/// How many times as long as along the wind a gust is across it.
const GUST_ASPECT: f64 = 2.0;
/// Wind has no direction at the source that it blows away from: there it is still, over this part of a gust.
const CALM: f64 = 0.1;
/// Values of noise over which gusts differ around a source.
const GUST_SECTORS: f64 = 3.0;

impl FlatDynamic {
    /// The motion at `time`. `at` is its place among the dynamics of its node, `seed` that of the instancer.
    pub fn new(dynamic: &Dynamic, time: f64, at: usize, seed: u32) -> Self {
        let key = copy_hash(seed, [at as i32, 0, 0], 0x1000)[0];
        let mut flat = Self {
            kind: dynamic.kind(),
            key,
            phase: Coordinate::default(),
            a: [0.0; 4],
            b: [0.0; 4],
            c: [0.0; 3],
            place: [Coordinate::default(); 3],
            rows: [DVec3::ZERO; 3],
        };
        flat.set(dynamic, time);
        flat
    }

    /// Sets the parameters.
    fn set(&mut self, dynamic: &Dynamic, time: f64) {
        let flat = self;
        let periods = |frequency: f64, phase: f64| Coordinate::new(frequency * time).moved(phase / 360.0);
        let unit = |axis: [f64; 3], or: DVec3| DVec3::from_array(axis).try_normalize().unwrap_or(or);
        let with = |v: DVec3, w: f64| [v.x, v.y, v.z, w];
        match *dynamic {
            Dynamic::Wind { .. } => flat.set_wind(dynamic, time),
            Dynamic::Sway { axis, angle, frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.a = with(unit(axis, DVec3::Z), angle.to_radians());
                flat.b[0] = spread;
            }
            Dynamic::Bob { amplitude, frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.a = with(amplitude.into(), 0.0);
                flat.b[0] = spread;
            }
            Dynamic::Orbit { axis, radius, frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.a = with(unit(axis, DVec3::Y), radius);
                flat.b[0] = spread;
            }
            Dynamic::Pulse { amplitude, frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.a[3] = amplitude;
                flat.b[0] = spread;
            }
            Dynamic::Spin { axis, frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.a = with(unit(axis, DVec3::Y), 0.0);
                flat.b[0] = spread;
            }
            Dynamic::Flicker { amplitude, frequency } => {
                flat.phase = periods(frequency, 0.0);
                flat.a[3] = amplitude;
            }
            Dynamic::ColorCycle { frequency, phase, spread } => {
                flat.phase = periods(frequency, phase);
                flat.b[0] = spread;
            }
            Dynamic::RandomWalk { amplitude, frequency } => {
                flat.phase = periods(frequency, 0.0);
                flat.a = with(amplitude.into(), 0.0);
            }
            Dynamic::FractionalBrownianMotion { amplitude, frequency, octaves } => {
                flat.phase = periods(frequency, 0.0);
                flat.a = with(amplitude.into(), 0.0);
                flat.b[1] = f64::from(octaves);
            }
            Dynamic::CurlNoise { amplitude, size, frequency } => {
                flat.phase = periods(frequency, 0.0);
                flat.a = with(amplitude.into(), 0.0);
                flat.rows = DVec3::AXES.map(|axis| axis / size);
            }
        }
    }

    fn set_wind(&mut self, dynamic: &Dynamic, time: f64) {
        let Dynamic::Wind { direction, angle, steady, gust_size, speed, softness, flutter, frequency, .. } = *dynamic
        else {
            return;
        };
        let Dynamic::Wind { radius, source, core, radial, .. } = *dynamic else { return };
        let along = DVec3::new(direction[0], 0.0, direction[2]).try_normalize().unwrap_or(DVec3::X);
        let across = DVec3::new(-along.z, 0.0, along.x);
        self.phase = Coordinate::new(frequency * time);
        self.a = [along.x, along.y, along.z, angle.to_radians()];
        self.b = [steady, softness, flutter.to_radians(), radius];
        self.c = [radial, core, gust_size.recip()];
        self.place[0] = Coordinate::new(-speed * time / gust_size);
        let straight = (1.0 - radial) / gust_size;
        self.rows = [along * straight, across * (straight / GUST_ASPECT), source.into()];
    }

    /// How far it takes a copy at any time.
    pub fn envelope(&self) -> Envelope {
        let [x, y, z, w] = self.a;
        let still = Envelope::STILL;
        let is_upright = x == 0.0 && z == 0.0;
        match self.kind {
            DynamicKind::Bob
            | DynamicKind::RandomWalk
            | DynamicKind::FractionalBrownianMotion
            | DynamicKind::CurlNoise => Envelope { displacement: DVec3::new(x, y, z).length(), ..still },
            DynamicKind::Orbit => Envelope { displacement: w.abs(), ..still },
            DynamicKind::Pulse => Envelope { scale: 1.0 + w.abs(), ..still },
            // Quivers along the wind and across it.
            DynamicKind::Wind => Envelope { tilt: (w + 2.0 * self.b[2]).min(FRAC_PI_2), ..still },
            DynamicKind::Sway => Envelope { tilt: if is_upright { 0.0 } else { w.abs().min(PI) }, ..still },
            DynamicKind::Spin => Envelope { tilt: if is_upright { 0.0 } else { PI }, ..still },
            DynamicKind::Flicker | DynamicKind::ColorCycle => still,
        }
    }

    fn coordinates(&self, position: DVec3) -> [Coordinate; 3] {
        [0, 1, 2].map(|i| self.place[i].moved(self.rows[i].dot(position)))
    }

    /// The motion of one copy at `position`. `at` is its place among the dynamics.
    fn motion(&self, seed: u32, at: usize, cell: [i32; 3], position: DVec3) -> CopyMotion {
        let randoms = copy_randoms(seed, cell, Channel::Dynamics as u32 + at as u32);
        let axis = DVec3::new(self.a[0], self.a[1], self.a[2]);
        let turns = self.phase.fraction + self.b[0] * randoms[0];
        match self.kind {
            DynamicKind::Wind => self.wind(randoms, position),
            DynamicKind::Sway => CopyMotion::rotated(DQuat::from_axis_angle(axis, self.a[3] * (TAU * turns).sin())),
            DynamicKind::Bob => CopyMotion::translated(axis * (TAU * turns).sin()),
            DynamicKind::Orbit => {
                let [u, v] = copy_basis(axis);
                let (sin, cos) = (TAU * turns).sin_cos();
                CopyMotion::translated((u * cos + v * sin) * self.a[3])
            }
            DynamicKind::Pulse => CopyMotion { scale: 1.0 + self.a[3] * (TAU * turns).sin(), ..CopyMotion::NONE },
            DynamicKind::Spin => CopyMotion::rotated(DQuat::from_axis_angle(axis, TAU * turns)),
            DynamicKind::Flicker => {
                let noise = 0.5 + 0.5 * copy_noise_1(self.key, self.own_time(randoms[0]));
                CopyMotion { emission: 1.0 - self.a[3] * noise, ..CopyMotion::NONE }
            }
            DynamicKind::ColorCycle => CopyMotion { hue: turns, ..CopyMotion::NONE },
            DynamicKind::RandomWalk => CopyMotion::translated(axis * self.walk(randoms, self.key, 1)),
            DynamicKind::FractionalBrownianMotion => {
                CopyMotion::translated(axis * self.walk(randoms, self.key, self.b[1] as u32))
            }
            DynamicKind::CurlNoise => {
                let flow = DVec3::from_array(copy_curl(self.key, self.coordinates(position), self.phase.fraction));
                let flow = flow * CURL_SCALE;
                CopyMotion::translated(axis * (flow / (1.0 + flow.length_squared()).sqrt()))
            }
        }
    }

    /// The time of one copy: each has a stretch of the noise of its own.
    fn own_time(&self, random: f64) -> Coordinate {
        // Whole numbers apart, so that the sum is exact.
        let own = (random * 16_777_216.0) as i32;
        Coordinate { whole: self.phase.whole.wrapping_add(own.wrapping_mul(1_021)), ..self.phase }
    }

    /// Noise over time along each axis, between −1 and 1, in layers.
    fn walk(&self, randoms: [f64; 3], key: u32, octaves: u32) -> DVec3 {
        let (mut sum, mut weight, mut whole) = (DVec3::ZERO, 1.0, 0.0);
        for octave in 0..octaves {
            let times = f64::from(1 << octave);
            let value = |axis: usize| {
                let own = self.own_time(randoms[axis]);
                let fraction = own.fraction * times;
                let floor = fraction.floor();
                let at = Coordinate {
                    whole: own.whole.wrapping_mul(1 << octave).wrapping_add(floor as i32),
                    fraction: fraction - floor,
                };
                copy_noise_1(key.wrapping_add(octave * 3 + axis as u32), at)
            };
            sum += weight * DVec3::new(value(0), value(1), value(2));
            whole += weight;
            weight *= 0.5;
        }
        sum / whole
    }

    /// A tilt with the wind about the copy's root, and a quiver.
    fn wind(&self, randoms: [f64; 3], position: DVec3) -> CopyMotion {
        let [steady, softness, flutter, radius] = self.b;
        let [radial, core, gusts] = self.c;
        let off = position - self.rows[2];
        let way = DVec3::new(off.x, 0.0, off.z);
        let outward = way / (way.length_squared() + (CALM / gusts).powi(2)).sqrt();
        let along = DVec3::new(self.a[0], 0.0, self.a[2]) * (1.0 - radial) + outward * radial;
        let across = DVec3::new(-along.z, 0.0, along.x);
        let [s, t] = [0, 1].map(|i| self.place[i].moved(self.rows[i].dot(position)));
        let (s, t) = (s.moved(radial * way.length() * gusts), t.moved(radial * GUST_SECTORS * outward.x));
        // From 0 to 1: a gust never turns the wind around.
        let gust = copy_noise_2(self.key, [s, t]);
        let mut strength = steady + (1.0 - steady) * gust;
        if radius > 0.0 {
            let beyond = (off.length() / radius - core).max(0.0) / (1.0 - core);
            let near = (1.0 - beyond * beyond).max(0.0);
            strength *= near * near;
        }
        // 1 for the softest copies.
        strength *= 1.0 - (1.0 - softness) * randoms[1];
        let turns = self.phase.fraction + randoms[0];
        let quiver = DVec2::new((TAU * turns).sin(), (TAU * (turns + randoms[2])).sin()) * (flutter * strength);
        let tilt = along * (self.a[3] * strength + quiver.x) + across * quiver.y;
        let angle = tilt.length().min(FRAC_PI_2);
        if angle == 0.0 {
            return CopyMotion::NONE;
        }
        // About the horizontal axis at right angles to the tilt.
        let axis = DVec3::new(tilt.z, 0.0, -tilt.x) / tilt.length();
        CopyMotion::rotated(DQuat::from_axis_angle(axis, angle))
    }
}

/// Two unit vectors at right angles to a unit axis and to each other (Duff et al., "Building an Orthonormal Basis,
/// Revisited", 2017).
pub fn copy_basis(axis: DVec3) -> [DVec3; 2] {
    let sign = if axis.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    let u = DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
    [u, DVec3::new(b, sign + axis.y * axis.y * a, -axis.y)]
}

/// The motion by all dynamics, in order. `position`: place of the copy before.
pub fn copy_motion(dynamics: &[FlatDynamic], seed: u32, cell: [i32; 3], position: DVec3) -> CopyMotion {
    let motions = dynamics.iter().enumerate().map(|(at, dynamic)| dynamic.motion(seed, at, cell, position));
    motions.fold(CopyMotion::NONE, CopyMotion::then)
}

/// How far all dynamics together take a copy.
pub fn copy_envelope(dynamics: &[FlatDynamic]) -> Envelope {
    dynamics.iter().map(FlatDynamic::envelope).fold(Envelope::STILL, |all, one| Envelope {
        displacement: all.displacement + one.displacement,
        scale: all.scale * one.scale,
        tilt: all.tilt + one.tilt,
    })
}
