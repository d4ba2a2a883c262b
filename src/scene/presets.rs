//! Materials to begin with.
//!
//! The colors of metals are reflectances of smooth surfaces at normal incidence, from table 9.2 of Akenine-Möller et al.,
//! Real-Time Rendering, fourth edition (2018); indices of refraction are those that handbooks give for the sodium line.
//! The rest is chosen by eye. Colors are linear Rec. 709.

use crate::{Material, MaterialId, OpacityTexture, Textures};

/// The ready-made materials, each under its name. Their ids are the same, so a scene gives each a new one.
pub fn material_presets() -> impl Iterator<Item = Material> {
    let all = dielectrics().into_iter().chain(coated()).chain(metals()).chain(emitting()).chain(clear());
    all.map(|(name, material)| Material { name: name.into(), id: MaterialId(1), ..material })
}

type Preset = (&'static str, Material);

/// A dielectric of this color, roughness and index of refraction.
fn dielectric(base_color: [f64; 3], specular_roughness: f64, specular_ior: f64) -> Material {
    Material { base_color, specular_roughness, specular_ior, ..Material::default() }
}

/// Without a visible highlight.
fn dry(base_color: [f64; 3], base_diffuse_roughness: f64, specular_weight: f64) -> Material {
    Material { base_diffuse_roughness, specular_weight, ..dielectric(base_color, 0.9, 1.5) }
}

fn metal(base_color: [f64; 3], specular_roughness: f64) -> Material {
    Material { base_color, base_metalness: 1.0, specular_roughness, ..Material::default() }
}

/// A clear coat of this roughness and index of refraction over a base.
fn coat(base: Material, coat_roughness: f64, coat_ior: f64) -> Material {
    Material { coat_weight: 1.0, coat_roughness, coat_ior, ..base }
}

fn emission(base_color: [f64; 3], emission_color: [f64; 3], emission_luminance: f64) -> Material {
    Material { emission_color, emission_luminance, ..dielectric(base_color, 0.5, 1.5) }
}

fn dielectrics() -> Vec<Preset> {
    vec![
        ("Clay", dry([0.48, 0.27, 0.18], 0.8, 0.4)),
        ("Terracotta", dry([0.51, 0.16, 0.07], 0.9, 0.3)),
        ("Plaster", dry([0.75, 0.73, 0.69], 0.6, 0.4)),
        ("Chalk", dry([0.86, 0.86, 0.84], 1.0, 0.1)),
        ("Charcoal", dry([0.02, 0.02, 0.02], 0.9, 0.2)),
        ("Concrete", dry([0.33, 0.32, 0.30], 0.9, 0.5)),
        ("Paper", dry([0.79, 0.76, 0.68], 0.5, 0.3)),
        ("Felt", dry([0.10, 0.22, 0.13], 1.0, 0.05)),
        ("Velvet", dry([0.22, 0.015, 0.04], 1.0, 0.0)),
        ("Rubber", dielectric([0.022, 0.022, 0.024], 0.62, 1.52)),
        ("Plastic", dielectric([0.05, 0.22, 0.62], 0.22, 1.46)),
        ("Matte plastic", dielectric([0.62, 0.13, 0.05], 0.55, 1.46)),
        ("Wax", dielectric([0.80, 0.66, 0.42], 0.42, 1.44)),
        ("Skin", dielectric([0.66, 0.37, 0.27], 0.48, 1.40)),
        ("Leather", dielectric([0.16, 0.055, 0.024], 0.46, 1.48)),
        ("Ivory", dielectric([0.77, 0.68, 0.51], 0.24, 1.54)),
        ("Jade", dielectric([0.09, 0.34, 0.16], 0.12, 1.66)),
        ("Marble", dielectric([0.78, 0.76, 0.73], 0.18, 1.50)),
        ("Ice", dielectric([0.62, 0.82, 0.92], 0.06, 1.31)),
        ("Ruby", dielectric([0.42, 0.006, 0.03], 0.03, 1.77)),
        ("Obsidian", dielectric([0.012, 0.012, 0.014], 0.05, 1.49)),
    ]
}

fn coated() -> Vec<Preset> {
    let flakes = Material { base_metalness: 0.65, ..dielectric([0.48, 0.012, 0.018], 0.42, 1.5) };
    let pearl = Material { base_metalness: 0.3, ..dielectric([0.82, 0.76, 0.72], 0.35, 1.6) };
    let stained = dielectric([0.30, 0.12, 0.045], 0.6, 1.5);
    let blued = Material { coat_color: [0.35, 0.55, 1.0], ..metal([0.562, 0.565, 0.578], 0.3) };
    vec![
        ("Porcelain", coat(dielectric([0.86, 0.85, 0.82], 0.35, 1.5), 0.03, 1.5)),
        ("Glazed ceramic", coat(dielectric([0.02, 0.25, 0.27], 0.4, 1.5), 0.06, 1.52)),
        ("Car paint", coat(flakes, 0.02, 1.5)),
        ("Pearl", coat(pearl, 0.12, 1.53)),
        ("Lacquered wood", coat(stained, 0.08, 1.54)),
        ("Blued steel", coat(blued, 0.05, 1.6)),
    ]
}

fn metals() -> Vec<Preset> {
    vec![
        ("Aluminum", metal([0.913, 0.922, 0.924], 0.3)),
        ("Silver", metal([0.972, 0.960, 0.915], 0.12)),
        // Its red is 1.022 in the table: out of the range of Rec. 709.
        ("Gold", metal([1.0, 0.782, 0.344], 0.16)),
        ("Copper", metal([0.955, 0.638, 0.538], 0.22)),
        ("Brass", metal([0.910, 0.778, 0.423], 0.25)),
        ("Iron", metal([0.562, 0.565, 0.578], 0.48)),
        ("Chrome", metal([0.549, 0.556, 0.554], 0.03)),
        ("Nickel", metal([0.660, 0.609, 0.526], 0.26)),
        ("Titanium", metal([0.542, 0.497, 0.449], 0.38)),
    ]
}

/// What lets light through.
fn clear() -> Vec<Preset> {
    let glass = |base_color, roughness, geometry_opacity| Material {
        geometry_opacity,
        ..dielectric(base_color, roughness, 1.5)
    };
    let cut = |material: Material, opacity, tile| {
        let mut textures = Textures::triplanar();
        if let Textures::Triplanar { opacity: own, size, sharpness, .. } = &mut textures {
            (*own, *size, *sharpness) = (opacity, tile, 32.0);
        }
        Material { textures, opacity_threshold: 0.5, ..material }
    };
    let bars = OpacityTexture::Bricks { first: 0.0, second: 1.0, scale: 4.0, row: 1.0, joint: 0.3 };
    let moth_eaten = OpacityTexture::Noise { first: 1.0, second: 0.0, scale: 6.0, layers: 4, seed: 2 };
    vec![
        ("Window glass", glass([0.62, 0.74, 0.72], 0.02, 0.12)),
        ("Bottle glass", glass([0.03, 0.22, 0.09], 0.04, 0.45)),
        ("Smoked glass", glass([0.05, 0.045, 0.04], 0.05, 0.6)),
        ("Frosted film", glass([0.80, 0.82, 0.84], 0.6, 0.55)),
        ("Wire mesh", cut(metal([0.562, 0.565, 0.578], 0.35), bars, 0.4)),
        ("Worn cloth", cut(dry([0.32, 0.20, 0.12], 0.9, 0.1), moth_eaten, 1.0)),
    ]
}

fn emitting() -> Vec<Preset> {
    vec![
        ("Lamp", emission([0.8, 0.78, 0.72], [1.0, 0.82, 0.58], 4.0)),
        ("Neon", emission([0.1, 0.02, 0.06], [1.0, 0.09, 0.42], 3.0)),
        ("Ember", emission([0.03, 0.01, 0.008], [1.0, 0.16, 0.015], 1.5)),
        ("Screen", emission([0.01, 0.01, 0.012], [0.32, 0.62, 1.0], 1.0)),
    ]
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::check;

    #[test]
    fn every_preset_is_valid_and_like_no_other() {
        let all: Vec<_> = material_presets().collect();
        assert!(all.len() >= 24, "{}", all.len());
        let names: HashSet<_> = all.iter().map(|material| material.name.as_str()).collect();
        assert_eq!(names.len(), all.len(), "two presets have the same name");
        for (at, material) in all.iter().enumerate() {
            assert!(check::material(material).is_ok(), "{}: {:?}", material.name, check::material(material));
            for other in &all[..at] {
                let renamed = Material { name: other.name.clone(), ..material.clone() };
                assert_ne!(renamed, *other, "{} is {}", material.name, other.name);
            }
        }
    }

    /// Of dielectrics: 2 % to 90 % of the light, as measured surfaces are; metals reflect more than half of some color.
    #[test]
    fn presets_are_as_bright_as_surfaces_are() {
        for material in material_presets() {
            let [r, g, b] = material.base_color;
            let brightest = r.max(g).max(b);
            let is_metal = material.base_metalness == 1.0;
            let range = if is_metal { 0.5..=1.0 } else { 0.01..=0.93 };
            assert!(range.contains(&brightest), "{}: {:?}", material.name, material.base_color);
        }
    }
}
