//! Energy: what a material reflects in all, by integration over the directions of light.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

use super::brdf::{ShadingPoint, brdf_ambient, brdf_direct};
use super::layers::{Layers, layers_direct, layers_mean_reflectance, layers_of, layers_reflectance};
use super::lobes::{density, half_vector};
use crate::FlatMaterial;
use crate::mixture::SurfaceMaterial;
use isolith_scene::Material;

/// The samples of an integral, for each kind of sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples {
    /// Along each side of the square.
    pub side: u32,
    /// Turns them, in their distance: other shifts err differently.
    pub shift: [f64; 2],
}

/// Those of most tests.
pub(super) const SAMPLES: Samples = Samples { side: 80, shift: [0.0; 2] };

/// The direction to the eye at this cosine from the normal, which is Z.
pub(super) fn eye(cosine: f64) -> DVec3 {
    DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// The light that arrives at the eye under uniform light of 1: the integral of `reflected` / π over the hemisphere, by
/// samples of both lobes and of the cosine, each weighted by the sum of the densities (Veach 1997). The normal is Z.
pub(super) fn energy(
    to_eye: DVec3,
    alphas: [f64; 2],
    Samples { side, shift }: Samples,
    reflected: impl Fn(DVec3) -> DVec3,
) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let mut add = |to_light: DVec3| {
        if to_light.z > 0.0 {
            let lobes: f64 = alphas.iter().map(|alpha| density(to_eye, *alpha, to_light)).sum();
            sum += reflected(to_light) * FRAC_1_PI / (lobes + to_light.z * FRAC_1_PI);
        }
    };
    for at in 0..side * side {
        let unit = [at % side, at / side].map(|i| f64::from(i) + 0.5);
        let unit = [0, 1].map(|i| ((unit[i] + shift[i]) / f64::from(side)).fract());
        for alpha in alphas {
            let half = half_vector(to_eye, alpha, unit);
            add(2.0 * to_eye.dot(half) * half - to_eye);
        }
        let (sine, cosine) = (TAU * unit[0]).sin_cos();
        let radius = unit[1].sqrt();
        add(DVec3::new(radius * cosine, radius * sine, (1.0 - unit[1]).sqrt()));
    }
    sum / f64::from(side * side)
}

fn point(material: SurfaceMaterial, to_eye: DVec3) -> ShadingPoint {
    ShadingPoint { material, position: DVec3::ZERO, normal: DVec3::Z, to_eye }
}

/// The light that a material sends to the eye under uniform light.
fn furnace(material: SurfaceMaterial, cosine: f64) -> DVec3 {
    let seen = point(material, eye(cosine));
    let layers = layers_of(&material, cosine);
    energy(seen.to_eye, [layers.alpha, layers.coat_alpha], SAMPLES, |to_light| brdf_direct(&seen, to_light))
}

/// White, with nothing that takes light away.
fn white() -> SurfaceMaterial {
    SurfaceMaterial::from(&FlatMaterial::new(&Material { base_color: [1.0; 3], ..Material::default() }))
}

const ROUGHNESS: [f64; 6] = [0.0, 0.15, 0.35, 0.6, 0.8, 1.0];
const COSINES: [f64; 4] = [0.08, 0.3, 0.7, 1.0];

/// White materials of every kind.
fn whites() -> Vec<SurfaceMaterial> {
    let mut all = Vec::new();
    for roughness in ROUGHNESS {
        for (metalness, ior, diffuse_roughness) in
            [(0.0, 1.5, 0.0), (0.0, 1.1, 0.7), (0.0, 2.4, 1.0), (0.5, 1.5, 0.3), (1.0, 1.5, 0.0)]
        {
            for (coat_weight, coat_ior, coat_roughness) in [(0.0, 1.6, 0.0), (1.0, 1.6, 0.1), (0.6, 1.3, 0.7)] {
                all.push(SurfaceMaterial {
                    roughness,
                    metalness,
                    ior,
                    diffuse_roughness,
                    coat_weight,
                    coat_ior,
                    coat_roughness,
                    ..white()
                });
            }
        }
    }
    all
}

/// What the quadrature itself is off by.
const QUADRATURE: f64 = 2e-3;

#[test]
fn a_white_material_under_uniform_light_neither_gains_nor_loses_light() {
    for material in whites() {
        for cosine in COSINES {
            let [found, ..] = furnace(material, cosine).to_array();
            assert!((0.97..=1.0 + QUADRATURE).contains(&found), "{found} at {cosine}: {material:?}");
        }
    }
}

#[test]
fn a_metal_that_reflects_once_fails_the_furnace() {
    let material = SurfaceMaterial { metalness: 1.0, roughness: 1.0, ..white() };
    let once = Layers { facing: DVec3::ONE, ..Layers { alpha: 1.0, coat_alpha: 1.0, ..Layers::default() } };
    for cosine in COSINES {
        let to_eye = eye(cosine);
        let single = energy(to_eye, [1.0; 2], SAMPLES, |to_light| {
            layers_direct(&once, DVec3::Z, to_eye, to_light, (to_eye + to_light).normalize())
        });
        assert!(single.x < 0.8, "{single}");
        assert!(furnace(material, cosine).x > 0.97);
    }
}

#[test]
fn the_ambient_share_is_the_energy() {
    for (at, white) in whites().into_iter().enumerate() {
        let base_color = [DVec3::new(0.9, 0.5, 0.1), DVec3::new(0.02, 0.2, 0.6)][at % 2];
        let specular_color = DVec3::new(1.0, 0.7, 0.4);
        let material = SurfaceMaterial { base_color, specular_color, coat_color: base_color, ..white };
        for cosine in COSINES {
            let found = furnace(material, cosine);
            let promised = brdf_ambient(&point(material, eye(cosine)));
            let off = (found - promised).abs().max_element();
            assert!(off < 0.02 && found.max_element() <= 1.0, "{found} {promised} at {cosine}: {material:?}");
        }
    }
}

/// The albedo of a dielectric is that of the exact Fresnel term, within what Schlick's simpler one is off by.
#[test]
fn means_of_reflectance_are_those_of_fresnel() {
    let fresnel = |ior: f64, c: f64| {
        let g = (ior * ior - 1.0 + c * c).sqrt();
        let bracket = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
        0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + bracket * bracket)
    };
    for ior in [1.1, 1.33, 1.5, 1.8, 2.4, 3.0] {
        let steps = 2_000;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
        let mean: f64 = (0..steps).map(|i| fresnel(ior, at(i)) * 2.0 * at(i)).sum::<f64>() / f64::from(steps);
        assert!((layers_mean_reflectance(ior) - mean).abs() < 5e-3, "{ior}: {mean}");
        assert!((layers_reflectance(ior) - fresnel(ior, 1.0)).abs() < 1e-12);
        assert!((layers_reflectance(ior) - layers_reflectance(1.0 / ior)).abs() < 1e-12);
    }
}

/// What does not depend on the side of the eye by design is reciprocal: one reflection by facets or by a diffuse
/// surface. Layers below others, and further reflections, are seen from the eye alone.
#[test]
fn single_reflections_are_reciprocal() {
    let directions = [eye(0.9), DVec3::new(-0.3, 0.5, 0.6).normalize(), DVec3::new(0.1, -0.8, 0.3).normalize()];
    for material in whites() {
        let layers = Layers { diffuse_again: DVec3::ZERO, ..layers_of(&material, 0.7) };
        for a in directions {
            for b in directions {
                let halfway = (a + b).normalize();
                let there = layers_direct(&layers, DVec3::Z, a, b, halfway) / b.z;
                let back = layers_direct(&layers, DVec3::Z, b, a, halfway) / a.z;
                assert!((there - back).abs().max_element() < 1e-9 * there.max_element().max(1.0), "{there} {back}");
            }
        }
    }
}

#[test]
fn a_smooth_metal_shows_its_colors_at_the_angles_that_name_them() {
    let (color, tint) = (DVec3::new(0.9, 0.6, 0.3), DVec3::new(0.8, 0.9, 0.5));
    let metal = SurfaceMaterial { base_color: color, specular_color: tint, metalness: 1.0, roughness: 0.0, ..white() };
    let facing = furnace(metal, 1.0);
    assert!((facing - color).abs().max_element() < 0.01, "{facing}");
    let schlick = color + (1.0 - color) * (6.0_f64 / 7.0).powi(5);
    let edge = furnace(metal, 1.0 / 7.0);
    assert!((edge - schlick * tint).abs().max_element() < 0.02, "{edge}");
}
