//! The presets on a ball in an environment, as pictures: what the renderer computes from prefiltered maps against the
//! integral over all directions. The ball is convex, so that no light is reflected twice.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::brdf::{ShadingPoint, brdf_direct};
use super::energy::{Samples, energy};
use super::environment::{EnvironmentLight, environment_background, environment_on};
use super::environment_map::{EnvironmentMap, PlacedMap};
use super::flip::{PIXELS_PER_DEGREE, Picture, flip};
use super::layers::layers_of;
use crate::FlatMaterial;
use crate::mixture::SurfaceMaterial;
use isolith_scene::{EnvironmentImage, Material, material_presets};

/// Pixels along a side.
const SIDE: usize = 32;
/// Samples along each side of the square, for each lobe.
const SAMPLES: u32 = 16;
/// The eye is so many radii away from the middle of the ball.
const AWAY: f64 = 5.0;
/// Mean difference on the ball that is accepted, over all presets and of any.
const TOLERANCE: f64 = 0.05;
const MOST: f64 = 0.1;

/// A studio: a gray floor, a sky, a wide and bright lamp, and a narrow one.
fn studio() -> PlacedMap {
    let size = [128, 64];
    let color = |i: usize| {
        let (x, y) = (i % size[0], i / size[0]);
        let height = 1.0 - y as f32 / 32.0;
        match (x, y) {
            (84..=99, 10..=23) => [4.0, 3.8, 3.4],
            (36..=39, 12..=30) => [5.0, 5.4, 6.0],
            _ if height < 0.0 => [0.16, 0.14, 0.12],
            _ => [0.30 + 0.1 * height, 0.36 + 0.2 * height, 0.42 + 0.4 * height],
        }
    };
    let image = EnvironmentImage { size, texels: (0..size[0] * size[1]).map(color).collect(), pixels: 0 };
    PlacedMap { map: EnvironmentMap::new(&image).into(), strength: 0.8, rotation: 0.6 }
}

/// The point of the ball that a pixel shows, and the direction of its ray; `None` beside the ball.
fn seen(pixel: usize) -> (DVec3, Option<DVec3>) {
    let place = |at: usize| (at as f64 + 0.5) / (0.5 * SIDE as f64) - 1.0;
    let across = 0.22;
    let at = DVec3::new(place(pixel % SIDE) * across, -place(pixel / SIDE) * across, -1.0);
    let direction = at.normalize();
    let eye = DVec3::Z * AWAY;
    let nearest = -eye.dot(direction);
    let square = 1.0 - (AWAY * AWAY - nearest * nearest);
    (direction, (square > 0.0).then(|| eye + direction * (nearest - square.sqrt())))
}

/// The integral of what is reflected toward the eye. `shift` turns the samples, so that neighbors err differently.
fn integral(point: &ShadingPoint, environment: &EnvironmentLight<'_>, shift: [f64; 2]) -> DVec3 {
    let normal = point.normal;
    let side = normal.any_orthonormal_vector();
    let world = DMat3::from_cols(side, normal.cross(side), normal);
    let to_eye = world.transpose() * point.to_eye;
    let layers = layers_of(&point.material, to_eye.z);
    energy(to_eye, [layers.alpha, layers.coat_alpha], Samples { side: SAMPLES, shift }, |to_light| {
        let there = world * to_light;
        environment_background(there, environment) * brdf_direct(point, there)
    })
}

/// The picture, if the ball reflects this.
fn picture(environment: &EnvironmentLight<'_>, reflected: impl Fn(&DVec3, DVec3, usize) -> DVec3) -> Picture {
    let color = |pixel: usize| {
        let (direction, normal) = seen(pixel);
        normal.map_or_else(
            || environment_background(direction, environment),
            |normal| reflected(&normal, -direction, pixel),
        )
    };
    // As a screen shows them.
    let shown = |pixel: usize| color(pixel).clamp(DVec3::ZERO, DVec3::ONE);
    Picture { width: SIDE, colors: (0..SIDE * SIDE).map(shown).collect() }
}

/// The mean difference on the ball between `model` and the integral for `truth`.
fn difference(model: &SurfaceMaterial, truth: &SurfaceMaterial, placed: &PlacedMap) -> f64 {
    let environment = EnvironmentLight { map: Some(placed), ..EnvironmentLight::default() };
    let at = |material: &SurfaceMaterial, normal: &DVec3, to_eye: DVec3| ShadingPoint {
        material: *material,
        position: *normal,
        normal: *normal,
        to_eye,
    };
    let drawn = picture(&environment, |normal, to_eye, _| {
        environment_on(&at(model, normal, to_eye), &environment, *normal) + model.emission
    });
    let integrated = picture(&environment, |normal, to_eye, pixel| {
        // The sequence R2 (Roberts 2018).
        let shift = [0.754_877_666, 0.569_840_291].map(|step: f64| (step * pixel as f64).fract() - 0.5);
        integral(&at(truth, normal, to_eye), &environment, shift) + truth.emission
    });
    let off = flip(&drawn, &integrated, PIXELS_PER_DEGREE);
    let on_ball: Vec<f64> = (0..off.len()).filter(|pixel| seen(*pixel).1.is_some()).map(|pixel| off[pixel]).collect();
    on_ball.iter().sum::<f64>() / on_ball.len() as f64
}

fn surface(material: &Material) -> SurfaceMaterial {
    SurfaceMaterial::from(&FlatMaterial::new(material))
}

#[test]
fn presets_look_as_the_integral_over_the_environment() {
    let placed = studio();
    let all: Vec<Material> = material_presets().collect();
    let of = |material: &Material| (difference(&surface(material), &surface(material), &placed), material.name.clone());
    let mut found: Vec<(f64, String)> = all.par_iter().map(of).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mean = found.iter().map(|(off, _)| off).sum::<f64>() / found.len() as f64;
    assert!(mean <= TOLERANCE && found[0].0 <= MOST, "mean {mean}: {found:?}");
}

#[test]
fn another_roughness_does_not_look_like_it() {
    let placed = studio();
    let gold = surface(&material_presets().find(|material| material.name == "Gold").expect("it is a preset"));
    let rough = SurfaceMaterial { roughness: 0.6, ..gold };
    let gray = SurfaceMaterial { base_color: DVec3::splat(0.5), ..gold };
    for other in [rough, gray] {
        let off = difference(&other, &gold, &placed);
        assert!(off > 1.5 * TOLERANCE, "{off}");
    }
}
