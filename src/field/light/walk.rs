//! The presets against random walks of light through their layers, on a sphere in an environment. The walks share no
//! formula with `layers` but the shapes of lobes: exact Fresnel terms, light that goes back and forth below the coat, and
//! reflections between facets one after another (as Guo, Hašan and Zhao 2018 walk through layers).

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::brdf::{ShadingPoint, brdf_direct};
use super::display::display_encode;
use super::energy::{SAMPLES, energy, eye};
use super::layers::layers_of;
use super::lobes::{half_vector, smith};
use crate::FlatMaterial;
use crate::mixture::SurfaceMaterial;
use isolith_scene::{Material, material_presets};

/// Walks for each point, and the most interfaces that one meets.
const WALKS: u32 = 3_000;
const MOST: u32 = 64;
/// Mean difference of a preset that is accepted, of colors from 0 to 1 as a screen gets them.
const TOLERANCE: f64 = 0.05;

/// Gray ground, a blue sky, and a window of 30° to the upper left.
fn environment(direction: DVec3) -> DVec3 {
    let window = direction.dot(DVec3::new(-0.5, 0.6, 0.62).normalize()) > 30_f64.to_radians().cos();
    let sky = DVec3::splat(0.3).lerp(DVec3::new(0.45, 0.55, 0.75), 0.5 + 0.5 * direction.y);
    sky + if window { 2.0 } else { 0.0 }
}

/// Numbers from 0 to 1 (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Reflectance at a face; `eta` is the index beyond it by that before it.
fn fresnel(eta: f64, c: f64) -> f64 {
    let square = eta * eta - 1.0 + c * c;
    if square <= 0.0 {
        return 1.0;
    }
    let g = square.sqrt();
    let bracket = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + bracket * bracket)
}

/// What a facet does with light that comes against `from`; Z points to the side of `from`.
struct Facet {
    /// Mirrored direction, and whether it leaves the facets.
    mirrored: DVec3,
    leaves: bool,
    /// Cosine between `from` and the facet.
    cosine: f64,
    half: DVec3,
}

fn facet(from: DVec3, alpha: f64, random: &mut Random) -> Facet {
    let half = half_vector(from, alpha, [random.next(), random.next()]);
    let cosine = from.dot(half).clamp(0.0, 1.0);
    let mirrored = 2.0 * cosine * half - from;
    let (own, other) = (smith(from.z, alpha), smith(mirrored.z.max(1e-3), alpha));
    let leaves = mirrored.z > 1e-3 && random.next() < (1.0 + own) / (1.0 + own + other);
    Facet { mirrored, leaves, cosine, half }
}

/// The direction beyond a facet, seen from the side of `from`; it points to negative Z unless the facet is too steep.
fn refracted(from: DVec3, facet: &Facet, eta: f64) -> DVec3 {
    let beyond = (1.0 - (1.0 - facet.cosine * facet.cosine) / (eta * eta)).max(0.0).sqrt();
    (facet.half * (facet.cosine / eta - beyond) - from / eta).normalize()
}

/// A dielectric face: the direction in which light goes on, on the near side (`true`) or beyond.
fn face(from: DVec3, alpha: f64, eta: f64, random: &mut Random) -> (DVec3, bool) {
    for _ in 0..MOST {
        let facet = facet(from, alpha, random);
        if random.next() < fresnel(eta, facet.cosine) {
            if facet.leaves {
                return (facet.mirrored, true);
            }
        } else {
            let beyond = refracted(from, &facet, eta);
            if beyond.z < -1e-3 {
                return (beyond, false);
            }
        }
    }
    (DVec3::new(-from.x, -from.y, from.z), true)
}

/// Reflection by the base: the direction and the factors on the light.
fn base(from: DVec3, material: &SurfaceMaterial, alpha: f64, under: f64, random: &mut Random) -> (DVec3, DVec3) {
    if random.next() < material.metalness {
        let mut share = DVec3::splat(material.specular_weight.min(1.0));
        for _ in 0..MOST {
            let facet = facet(from, alpha, random);
            share *= material.base_color + (1.0 - material.base_color) * (1.0 - facet.cosine).powi(5);
            if facet.leaves {
                return (facet.mirrored, share);
            }
        }
        return (DVec3::Z, DVec3::ZERO);
    }
    // The index of refraction whose reflectance is the weighted one.
    let ratio = (material.ior / under).max(under / material.ior);
    let root = (material.specular_weight.sqrt() * (ratio - 1.0) / (ratio + 1.0)).min(0.999);
    let (direction, is_near) = face(from, alpha, (1.0 + root) / (1.0 - root), random);
    if is_near {
        return (direction, material.specular_color);
    }
    // Oren and Nayar's shape matters little beside the albedo, which their model keeps.
    let (sine, cosine) = (TAU * random.next()).sin_cos();
    let square = random.next();
    (DVec3::new(square.sqrt() * cosine, square.sqrt() * sine, (1.0 - square).sqrt()), material.base_color)
}

/// The light of one walk that begins at the eye; `lit` is the light from a direction.
fn walk(to_eye: DVec3, material: &SurfaceMaterial, lit: &dyn Fn(DVec3) -> DVec3, random: &mut Random) -> DVec3 {
    let [alpha, coat_alpha] =
        [material.roughness, material.coat_roughness].map(|roughness| (roughness * roughness).max(0.002));
    if random.next() >= material.coat_weight {
        let (direction, share) = base(to_eye, material, alpha, 1.0, random);
        return share * lit(direction);
    }
    let flipped = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
    let (mut direction, is_out) = face(to_eye, coat_alpha, material.coat_ior, random);
    if is_out {
        return lit(direction);
    }
    let mut light = DVec3::ONE;
    let absorbed = |direction: DVec3| material.coat_color.max(DVec3::splat(1e-6)).powf(0.5 / direction.z.abs());
    for _ in 0..MOST {
        light *= absorbed(direction);
        let (up, share) = base(-direction, material, alpha, material.coat_ior, random);
        light *= share * absorbed(up);
        // From below, mirrored so that Z points to the side that light comes from.
        let (next, is_inside) = face(flipped(-up), coat_alpha, 1.0 / material.coat_ior, random);
        direction = flipped(next);
        if !is_inside {
            return light * lit(direction);
        }
    }
    DVec3::ZERO
}

/// Mean difference of the encoded colors of a sphere between the model and the walks.
fn difference(material: &SurfaceMaterial) -> f64 {
    let mut random = Random(24);
    let mut sum = 0.0;
    let places = [(20.0, 2.4), (45.0, 0.4), (45.0, 2.3), (60.0, 4.0), (75.0, 1.6)];
    for (angle, around) in places {
        let (sine, cosine) = f64::to_radians(angle).sin_cos();
        let normal = DVec3::new(sine * f64::cos(around), sine * f64::sin(around), cosine);
        let side = (DVec3::Z - normal * cosine).normalize();
        let world = DMat3::from_cols(side, normal.cross(side), normal);
        let lit = |direction: DVec3| environment(world * direction);
        let to_eye = eye(cosine);
        let point = ShadingPoint { material: *material, position: DVec3::ZERO, normal: DVec3::Z, to_eye };
        let layers = layers_of(material, cosine);
        let model = energy(to_eye, [layers.alpha, layers.coat_alpha], SAMPLES, |to_light| {
            brdf_direct(&point, to_light) * lit(to_light)
        });
        let walks: DVec3 = (0..WALKS).map(|_| walk(to_eye, material, &lit, &mut random)).sum();
        let off = display_encode(model) - display_encode(walks / f64::from(WALKS));
        sum += off.abs().element_sum() / 3.0;
    }
    sum / places.len() as f64
}

fn surface(material: &Material) -> SurfaceMaterial {
    SurfaceMaterial::from(&FlatMaterial::new(material))
}

#[test]
fn presets_look_as_random_walks_through_their_layers_do() {
    let all: Vec<_> =
        material_presets().map(|material| (difference(&surface(&material)), material.name.clone())).collect();
    let mean = all.iter().map(|(off, _)| off).sum::<f64>() / all.len() as f64;
    let (worst, name) = all.iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are presets");
    assert!(*worst < TOLERANCE && mean < TOLERANCE / 2.0, "{name}: {worst}, mean {mean}: {all:?}");
}

#[test]
fn another_material_does_not_look_like_its_walks() {
    let gold = surface(&material_presets().find(|material| material.name == "Gold").expect("it is a preset"));
    let rough = SurfaceMaterial { roughness: 0.9, ..gold };
    let mut random = Random(1);
    let (to_eye, lit) = (eye(0.7), |direction: DVec3| environment(DVec3::new(direction.x, direction.z, -direction.y)));
    let mean = |material: &SurfaceMaterial, random: &mut Random| {
        (0..WALKS).map(|_| walk(to_eye, material, &lit, random)).sum::<DVec3>() / f64::from(WALKS)
    };
    let gray = SurfaceMaterial { base_color: DVec3::splat(0.5), ..gold };
    assert!((mean(&gold, &mut random) - mean(&gray, &mut random)).length() > 0.1);
    assert!((mean(&gold, &mut random) - mean(&rough, &mut random)).length() > 0.02);
}
