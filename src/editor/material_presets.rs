//! Ready-made materials.

use isolith_scene::{Material, MaterialId};

/// The ready-made materials, each under its name. Their ids are the same, so a scene gives each a new one.
pub fn material_presets() -> impl Iterator<Item = Material> {
    let of = |name: &str, base_color: [f64; 3], specular_roughness: f64| Material {
        specular_roughness,
        ..Material::new(MaterialId(1), name, base_color)
    };
    let metal =
        |name: &str, color: [f64; 3], roughness: f64| Material { base_metalness: 1.0, ..of(name, color, roughness) };
    [
        of("Clay", [0.62, 0.56, 0.50], 0.7),
        of("Plastic", [0.05, 0.25, 0.60], 0.25),
        of("Rubber", [0.03, 0.03, 0.032], 0.8),
        metal("Gold", [0.94, 0.72, 0.35], 0.2),
        metal("Copper", [0.93, 0.60, 0.47], 0.25),
        metal("Chrome", [0.55, 0.56, 0.56], 0.05),
        Material { coat_weight: 1.0, ..of("Car paint", [0.55, 0.03, 0.03], 0.4) },
        Material { emission_luminance: 1.5, emission_color: [1.0, 0.75, 0.4], ..of("Lamp", [0.8; 3], 0.5) },
    ]
    .into_iter()
}
