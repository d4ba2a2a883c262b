//! How a copy changes the material of its type. Counterpart of `shaders/copy/look.wgsl`.

use glam::DVec3;

use super::eval::nearest_copy;
use super::variation::{CopyMaterial, copy_material};
use crate::mixture::{Mixture, SurfaceMaterial, mixture_of};
use crate::{Component, FlatScene};

/// How the copy at a point of the world differs; `None` for components that are no type of an instancer.
pub fn look_at(flat: &FlatScene, component: &Component, point: DVec3) -> Option<CopyMaterial> {
    let instancer = &flat.instancers[component.instanced?.instancer as usize];
    nearest_copy(flat, component, point).copy.map(|copy| copy_material(instancer, &copy))
}

/// The mixture of a copy: all of one material, if that replaces those of the type.
pub fn look_mixture(look: &CopyMaterial, mixture: Mixture) -> Mixture {
    look.replaced.map_or(mixture, mixture_of)
}

/// The material as the copy shows it.
pub fn look_varied(material: SurfaceMaterial, look: &CopyMaterial) -> SurfaceMaterial {
    SurfaceMaterial {
        base_color: look_color(material.base_color, look.hue, look.saturation, look.value),
        roughness: (material.roughness + look.roughness).clamp(0.0, 1.0),
        emission: material.emission * look.emission,
        ..material
    }
}

/// A color with its hue turned and its saturation and value scaled (hexcone: Smith, "Color Gamut Transform Pairs",
/// 1978).
pub fn look_color(color: DVec3, hue: f64, saturation: f64, value: f64) -> DVec3 {
    let most = color.max_element();
    let chroma = most - color.min_element();
    let sextant = match color {
        _ if chroma <= 0.0 => 0.0,
        DVec3 { x, y, z } if x == most => (y - z) / chroma,
        DVec3 { x, y, z } if y == most => 2.0 + (z - x) / chroma,
        DVec3 { x, y, .. } => 4.0 + (x - y) / chroma,
    };
    let turned = 6.0 * (sextant / 6.0 + hue).rem_euclid(1.0);
    let full = (chroma / most.max(1e-30) * saturation).clamp(0.0, 1.0);
    let k = [5.0, 3.0, 1.0].map(|n: f64| (n + turned) % 6.0);
    let share = DVec3::from_array(k.map(|k| 1.0 - full * k.min(4.0 - k).clamp(0.0, 1.0)));
    (most * value).clamp(0.0, 1.0) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_turn_and_grays_stay() {
        let color = DVec3::new(0.8, 0.3, 0.1);
        assert!(look_color(color, 0.0, 1.0, 1.0).distance(color) < 1e-12);
        assert!(look_color(color, 1.0 / 3.0, 1.0, 1.0).distance(DVec3::new(0.1, 0.8, 0.3)) < 1e-12);
        assert!(look_color(color, 2.0 / 3.0, 1.0, 0.5).distance(DVec3::new(0.15, 0.05, 0.4)) < 1e-12);
        assert!(look_color(color, 0.3, 0.0, 1.0).distance(DVec3::splat(0.8)) < 1e-12);
        assert_eq!(look_color(DVec3::splat(0.25), 0.4, 1.5, 2.0), DVec3::splat(0.5));
        assert_eq!(look_color(DVec3::ZERO, 0.4, 1.5, 2.0), DVec3::ZERO);
    }
}
