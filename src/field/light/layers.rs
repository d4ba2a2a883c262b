//! The layers of OpenPBR. Counterpart of `shaders/light/layers.wgsl`, which describes them.
//!
//! | part | source |
//! |---|---|
//! | layers, coat, darkening, indices of refraction | OpenPBR 1.1 |
//! | microfacets | GGX (Walter et al. 2007) with height-correlated shadowing (Heitz 2014), Schlick's Fresnel term |
//! | tint of metals | F82 (Kutz, Hašan and Edmondson 2021) |
//! | light that is reflected several times | Turquin 2019 |
//! | diffuse reflection | energy-preserving Oren-Nayar (Portsmouth, Kutz and Hill 2025) |
//! | mean reflectance of a dielectric | Kulla and Conty 2017 |

use glam::DVec3;

use super::albedo::albedo_specular;
use crate::mixture::SurfaceMaterial;

/// Width of GGX for a roughness of 0: a highlight of a light without size.
const LEAST_ALPHA: f64 = 0.002;
/// Cosine to the eye at the outline.
const LEAST_COSINE: f64 = 0.01;
/// Reflectance below which a dielectric reflects less than everything at grazing angles.
const LEAST_REFLECTANCE: f64 = 0.02;
/// 1/2 - 2/(3 π)
const FACING_LOSS: f64 = 0.287_793_41;
/// 2/3 - 28/(15 π)
const MEAN_LOSS: f64 = 0.072_488_21;

/// What a material reflects toward the eye, without what depends on the light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layers {
    /// Diffuse reflection, once.
    pub diffuse: DVec3,
    /// Diffuse reflection that follows another one between the facets.
    pub diffuse_again: DVec3,
    /// Roughness of the diffuse reflection.
    pub diffuse_roughness: f64,
    /// Reflectance of the base's microfacets that face eye and light.
    pub facing: DVec3,
    /// What it gains toward grazing angles: the factor of (1 - c)⁵.
    pub grazing: DVec3,
    /// What a tint takes away: the factor of c (1 - c)⁶.
    pub tinted: DVec3,
    /// Width of GGX.
    pub alpha: f64,
    /// Reflectance of the coat.
    pub coat_facing: f64,
    /// What it gains toward grazing angles.
    pub coat_grazing: f64,
    /// Width of GGX of the coat.
    pub coat_alpha: f64,
    /// Albedo of the diffuse part under light from everywhere.
    pub diffuse_albedo: DVec3,
    /// Albedo of the specular part.
    pub specular_albedo: DVec3,
    /// Albedo of the coat.
    pub coat_albedo: f64,
}

fn layers_alpha(roughness: f64) -> f64 {
    (roughness * roughness).max(LEAST_ALPHA)
}

/// Reflectance of a face between media whose indices of refraction have this ratio.
pub(super) fn layers_reflectance(ratio: f64) -> f64 {
    ((ratio - 1.0) / (ratio + 1.0)).powi(2)
}

/// The layers of a material that the eye sees at this angle.
pub fn layers_of(material: &SurfaceMaterial, cosine: f64) -> Layers {
    let mu = cosine.clamp(LEAST_COSINE, 1.0);
    let (coat, metal) = (material.coat_weight, material.metalness);
    let color = material.base_color.clamp(DVec3::ZERO, DVec3::ONE);
    let rough = material.roughness.powi(2);
    let blurred = (rough * rough + 2.0 * material.coat_roughness.powi(4)).min(1.0).powf(0.25);
    let alpha = layers_alpha(material.roughness + (blurred - material.roughness) * coat);
    let albedo = albedo_specular(mu, alpha);
    let again = (1.0 - albedo.whole) / albedo.whole;

    let below = material.ior / (1.0 + (material.coat_ior - 1.0) * coat);
    let facing = (material.specular_weight * layers_reflectance(below)).min(1.0);
    let grazing = (facing / LEAST_REFLECTANCE).min(1.0) - facing;
    let gain = 1.0 + facing * again;
    let gloss = gain * (facing * albedo.whole + grazing * albedo.grazing);

    let metal_gain = metal * material.specular_weight.min(1.0) * (1.0 + color * again);
    let tint = (color + (1.0 - color) * 0.462_664_36) * (1.0 - material.specular_color) * 17.651_252;
    let dielectric = (1.0 - metal) * gain * material.specular_color;
    let mut layers = Layers {
        facing: dielectric * facing + metal_gain * color,
        grazing: dielectric * grazing + metal_gain * (1.0 - color),
        tinted: metal_gain * tint,
        alpha,
        ..Layers::default()
    };
    layers.specular_albedo = (layers.facing * albedo.whole + layers.grazing * albedo.grazing
        - layers.tinted * albedo.tinted)
        .max(DVec3::ZERO);
    layers_add_diffuse(&mut layers, color, material.diffuse_roughness, (1.0 - metal) * (1.0 - gloss), mu);
    layers_add_coat(&mut layers, material, mu);
    layers
}

/// Energy-preserving Oren-Nayar; `share` is the light that reaches it.
fn layers_add_diffuse(layers: &mut Layers, color: DVec3, roughness: f64, share: f64, mu: f64) {
    let scale = 1.0 / (1.0 + FACING_LOSS * roughness);
    let mean = scale * (1.0 + MEAN_LOSS * roughness);
    let loss = (FACING_LOSS - layers_oren_nayar(mu)).max(0.0);
    let again = color * color * mean / (1.0 - color * (1.0 - mean));
    layers.diffuse_roughness = roughness;
    layers.diffuse = color * (scale * share);
    layers.diffuse_again = again * (share * scale * roughness * loss / (FACING_LOSS - MEAN_LOSS));
    let once = 1.0 - scale * roughness * loss;
    layers.diffuse_albedo = share * (color * once + again * (1.0 - once));
}

/// Puts the coat over the base.
fn layers_add_coat(layers: &mut Layers, material: &SurfaceMaterial, mu: f64) {
    let ior = material.coat_ior.max(1.0);
    layers.coat_alpha = layers_alpha(material.coat_roughness);
    let albedo = albedo_specular(mu, layers.coat_alpha);
    let facing = layers_reflectance(ior);
    let grazing = (facing / LEAST_REFLECTANCE).min(1.0) - facing;
    let gain = material.coat_weight * (1.0 + facing * (1.0 - albedo.whole) / albedo.whole);
    layers.coat_facing = gain * facing;
    layers.coat_grazing = gain * grazing;
    layers.coat_albedo = gain * (facing * albedo.whole + grazing * albedo.grazing);

    let base = (layers.diffuse_albedo + layers.specular_albedo).clamp(DVec3::ZERO, DVec3::ONE);
    let bounded = ior.clamp(1.0, 3.0);
    let fresnel = facing + grazing * (1.0 - mu).powi(5);
    let diffuse = 1.0 - (1.0 - layers_mean_reflectance(bounded)) / (bounded * bounded);
    let inside = diffuse + (fresnel - diffuse) * material.metalness * (1.0 - material.roughness);
    let darkening = (1.0 - inside) / (1.0 - base * inside);
    let path = 1.0 / (1.0 - (1.0 - mu * mu) / (ior * ior + 1e-4)).sqrt();
    let tint = material.coat_color.max(DVec3::splat(1e-6)).powf(path);
    let darkened = DVec3::ONE.lerp(darkening, material.coat_darkening);
    let passes = (1.0 - layers.coat_albedo / material.coat_weight.max(1e-6)) * darkened * tint;
    let under = DVec3::ONE.lerp(passes, material.coat_weight);
    for part in [
        &mut layers.diffuse,
        &mut layers.diffuse_again,
        &mut layers.facing,
        &mut layers.grazing,
        &mut layers.tinted,
        &mut layers.diffuse_albedo,
        &mut layers.specular_albedo,
    ] {
        *part *= under;
    }
}

/// Mean reflectance of a dielectric under diffuse light, for indices of refraction from 1 to 3.
pub(super) fn layers_mean_reflectance(ior: f64) -> f64 {
    ((10_893.0 * ior - 1_438.2) / (-774.4 * ior * ior + 10_212.0 * ior + 1.0)).ln()
}

/// Of Oren and Nayar's albedo: what grows with roughness and with the angle.
fn layers_oren_nayar(cosine: f64) -> f64 {
    let x = 1.0 - cosine;
    x * (0.057_108_528_9 + x * (0.491_881_867 + x * (-0.332_181_442 + 0.071_442_995_3 * x)))
}

/// GGX with the height-correlated shadowing of Smith, times π; `incident` and `mu` are the cosines to light and eye.
fn layers_spread(alpha: f64, normal: DVec3, halfway: DVec3, incident: f64, mu: f64) -> f64 {
    let a2 = alpha * alpha;
    let d = a2 * normal.dot(halfway).powi(2) + normal.cross(halfway).length_squared();
    let shadow = incident * (mu * mu * (1.0 - a2) + a2).sqrt() + mu * (incident * incident * (1.0 - a2) + a2).sqrt();
    a2 / (d * d) * 0.5 / shadow.max(1e-6)
}

/// The share of the light from `to_light` that is reflected, as `brdf_direct` gives it; `halfway` is of unit length.
pub fn layers_direct(layers: &Layers, normal: DVec3, to_eye: DVec3, to_light: DVec3, halfway: DVec3) -> DVec3 {
    let incident = normal.dot(to_light).max(0.0);
    let mu = normal.dot(to_eye).clamp(LEAST_COSINE, 1.0);
    let c = halfway.dot(to_light).clamp(0.0, 1.0);
    let r5 = (1.0 - c).powi(5);
    let base = layers.facing + layers.grazing * r5 - layers.tinted * (c * (1.0 - c) * r5);
    let coat = layers.coat_facing + layers.coat_grazing * r5;
    let specular = base.max(DVec3::ZERO) * layers_spread(layers.alpha, normal, halfway, incident, mu)
        + coat * layers_spread(layers.coat_alpha, normal, halfway, incident, mu);
    let s = to_light.dot(to_eye) - incident * mu;
    let t = if s > 0.0 { s / incident.max(mu).max(LEAST_COSINE) } else { s };
    let once = layers.diffuse * (1.0 + layers.diffuse_roughness * t);
    let again = layers.diffuse_again * (FACING_LOSS - layers_oren_nayar(incident)).max(0.0);
    (once + again + specular) * incident
}
